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
    let report = folder.json(&["merge", "a.png", "b.png", "c.png", "-o", "new.png"]);
    assert_eq!(report["parts"], 3);
    assert_eq!([&report["width"], &report["height"]], [48, 36]);
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let folder = Folder::with_quick();
    render(&folder, "a.png", Some("0..20"));
    render(&folder, "b.png", Some("20..36"));
    render(&folder, "a.ppm", Some("0..20"));
    render(&folder, "whole.png", None);
    let other = ["render", "quick.gridel", "-o"];
    let size = ["--size", "48x40", "--rows", "20..36"];
    folder.done(&[&other[..], &["size.png"], &size].concat());
    let dark = ["--size", "48x36", "--rows", "10..36", "--depth", "0"];
    folder.done(&[&other[..], &["dark.png"], &dark].concat());
    folder.write("broken.png", &folder.read("a.png")[..200]);
    folder.write("lies.ppm", b"P6\n# rows 0..2 of 3\n1 1\n255\nabc");
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
        &["a.png", "dark.png", "-o", "x.png"],
        &["dark.png", "different pixels in row"],
    );
    fails(
        1,
        &["a.png", "whole.png", "-o", "x.png"],
        &["whole.png", "which rows"],
    );
    fails(1, &["broken.png", "-o", "x.png"], &["broken.png"]);
    fails(1, &["lies.ppm", "-o", "x.ppm"], &["rows 0..2 of 3"]);
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
