//! `gridel merge`.

use crate::program::Folder;

/// Renders rows of a picture of 48 by 36 pixels; all of them without a range.
fn render(folder: &Folder, output: &str, rows: Option<&str>) {
    let mut arguments = vec!["render", "quick.gridel", "-o", output, "--size", "48x36"];
    arguments.extend(rows.map(|rows| ["--rows", rows]).into_iter().flatten());
    folder.done(&arguments);
}

#[test]
fn parts_become_the_bytes_of_the_whole() {
    let folder = Folder::with_quick();
    for kind in ["png", "ppm"] {
        let name = |part: &str| format!("{part}.{kind}");
        render(&folder, &name("whole"), None);
        for (part, rows) in [("a", "0..7"), ("b", "7..30"), ("c", "25..36")] {
            render(&folder, &name(part), Some(rows));
        }
        // In any order, with rows that two parts have.
        let (a, b, c, out) = (name("a"), name("b"), name("c"), name("merged"));
        folder.done(&["merge", &c, &a, &b, "-o", &out]);
        assert!(folder.read(&out) == folder.read(&name("whole")), "{kind}");
    }
    // A picture that is split into one part is a part.
    render(&folder, "all.png", Some("0..36"));
    let text = folder.done(&["merge", "all.png", "-o", "one.png"]);
    assert!(text.contains("from 1 part\n"), "{text}");
    assert!(folder.read("one.png") == folder.read("whole.png"));
    let report = folder.json(&["merge", "a.png", "b.png", "c.png", "-o", "new.png"]);
    assert_eq!(report["parts"], 3);
    assert_eq!([&report["width"], &report["height"]], [48, 36]);
}

/// Rows are of one picture only if nothing that decides pixels differs, and all that does is named.
#[test]
fn parts_of_pictures_that_differ_are_rejected() {
    let folder = Folder::with_quick();
    folder.done(&[
        "build",
        "quick.toml",
        "-o",
        "coarse.gridel",
        "--lattice-bits",
        "10",
    ]);
    let part = |blob: &str, output: &str, options: &[&str]| {
        let render = ["render", blob, "-o", output, "--size", "48x36"];
        folder.done(&[&render[..], options].concat());
    };
    for kind in ["png", "ppm"] {
        let (upper, lower) = (format!("upper.{kind}"), format!("lower.{kind}"));
        part("quick.gridel", &upper, &["--rows", "0..20"]);
        for (blob, options, words) in [
            (
                "quick.gridel",
                &["--format", "fixed"][..],
                ["format f32", "format fixed"],
            ),
            (
                "quick.gridel",
                &["--samples", "2"],
                ["samples 1", "samples 2"],
            ),
            ("quick.gridel", &["--depth", "3"], ["depth 6", "depth 3"]),
            ("quick.gridel", &["--dither"], ["dither off", "dither on"]),
            (
                "quick.gridel",
                &["--fov", "30"],
                ["with view", "the other with view"],
            ),
            (
                "quick.gridel",
                &["--light", "0.color=1,0,0"],
                ["with view", "the other with view"],
            ),
            ("coarse.gridel", &[], ["with blob", "the other with blob"]),
        ] {
            part(blob, &lower, &[&["--rows", "20..36"], options].concat());
            let out = format!("x.{kind}");
            let words = [&["upper", "lower"][..], &words[..]].concat();
            folder.fails(1, &["merge", &upper, &lower, "-o", &out], &words);
        }
        // What decides nothing may differ.
        let options = [
            "--rows",
            "20..36",
            "--accel",
            "list",
            "--threads",
            "2",
            "--stats",
        ];
        part("quick.gridel", &lower, &options);
        folder.done(&["merge", &upper, &lower, "-o", &format!("merged.{kind}")]);
    }
    // What does not say how it was made could be of any picture.
    folder.write("upper.ppm", b"P6\n# rows 0..1 of 2\n1 1\n255\nabc");
    folder.fails(
        1,
        &["merge", "upper.ppm", "-o", "x.ppm"],
        &["how they were rendered"],
    );
}

#[test]
fn parts_that_do_not_fit_are_rejected() {
    let folder = Folder::with_quick();
    render(&folder, "a.png", Some("0..20"));
    render(&folder, "b.png", Some("20..36"));
    render(&folder, "a.ppm", Some("0..20"));
    render(&folder, "whole.png", None);
    let other = ["render", "quick.gridel", "-o"];
    let size = ["--size", "48x40", "--rows", "20..36"];
    folder.done(&[&other[..], &["size.png"], &size].concat());
    // One pixel of rows 10 to 19 is another.
    let rows = ["--size", "48x36", "--rows", "10..36"];
    folder.done(&[&other[..], &["dark.ppm"], &rows].concat());
    let mut dark = folder.read("dark.ppm");
    let pixels = dark.len() - 26 * 48 * 3;
    dark[pixels + 5 * 48 * 3] ^= 1;
    folder.write("dark.ppm", &dark);
    folder.write("broken.png", &folder.read("a.png")[..200]);
    let whole = folder.read("a.ppm");
    folder.write("cut.ppm", &whole[..whole.len() - 5]);
    folder.write("long.ppm", &[&whole[..], b"x"].concat());
    folder.write("header.ppm", &whole[..30]);
    folder.write("gray.ppm", b"P5\n# rows 0..1 of 1; depth 1\n1 1\n255\na");
    folder.write("lies.ppm", b"P6\n# rows 0..2 of 3; depth 1\n1 1\n255\nabc");
    let fails = |code: i32, arguments: &[&str], words: &[&str]| {
        folder.fails(code, &[&["merge"], arguments].concat(), words);
    };
    fails(
        1,
        &["a.png", "-o", "x.png"],
        &["rows 20..36", "--rows 20..36"],
    );
    fails(
        1,
        &["a.png", "size.png", "-o", "x.png"],
        &["48x36", "48x40"],
    );
    fails(
        1,
        &["a.ppm", "dark.ppm", "-o", "x.ppm"],
        &["dark.ppm", "different pixels in row 15"],
    );
    fails(
        1,
        &["a.png", "whole.png", "-o", "x.png"],
        &["whole.png", "which rows"],
    );
    fails(1, &["broken.png", "-o", "x.png"], &["broken.png"]);
    fails(
        1,
        &["lies.ppm", "-o", "x.ppm"],
        &["the rows 0..2, but it has 1"],
    );
    for (name, words) in [
        (
            "cut.ppm",
            "its pixels take 2,880 bytes, and it has 2,875 of them",
        ),
        ("long.ppm", "it has more than the 2,880 bytes of its pixels"),
        ("header.ppm", "it ends within its header"),
        ("gray.ppm", "it is not a PPM picture (P6)"),
    ] {
        let words = format!("{name} cannot be merged: {words}");
        fails(1, &[name, "-o", "x.ppm"], &[&words]);
    }
    fails(1, &["nowhere.png", "-o", "x.png"], &["nowhere.png"]);
    fails(
        2,
        &["a.png", "a.ppm", "-o", "x.png"],
        &["a.ppm", "one format"],
    );
    fails(2, &["a.png", "b.png", "-o", "a.png"], &["would be lost"]);
    fails(2, &["a.rgb565", "-o", "x.rgb565"], &["cat"]);
    fails(2, &["a.png", "-o", "x.jpg"], &[".png or .ppm"]);
}
