//! `gridel accuracy`.

use crate::program::Folder;

const SMALL: [&str; 8] = [
    "accuracy",
    "ball.toml",
    "--size",
    "12x9",
    "--repeat",
    "1",
    "-o",
    "out",
];

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write(
        "ball.toml",
        b"object = [{ kind = \"sphere\", center = [0, 0, 0], radius = 1 }]\n",
    );
    folder
}

#[test]
fn single_repeat_reports_no_spread() {
    let folder = folder();
    let text = folder.done(&SMALL);
    let line = text
        .lines()
        .find(|line| line.contains("f32-24bit-1spp"))
        .unwrap();
    let columns: Vec<_> = line.split_whitespace().collect();
    let name = columns
        .iter()
        .position(|it| it.starts_with("f32-"))
        .unwrap();
    assert_eq!(columns[name + 2], "-", "{line}");
    let page = String::from_utf8(folder.read("out/page.html")).unwrap();
    assert!(
        page.contains("cutoff 2<sup>-14</sup>, 256 samples per pixel"),
        "no samples"
    );
    let (body, _) = page.split_once("<script").unwrap();
    assert!(body.contains("<code>fixed</code>") && !body.contains('`'));
    assert!(page.contains("<td>-</td>"));
    assert!(folder.path("out/rmse.svg").exists());
}

#[test]
fn the_reference_is_better_than_what_it_measures() {
    let folder = folder();
    let few = [&SMALL[..], &["--reference-samples", "127"]].concat();
    folder.fails(2, &few, &["127 samples", "at least 128"]);
    folder.done(&[&SMALL[..], &["--reference-samples", "128"]].concat());
}

/// Many samples are measured against twice as many; a reference has at most 4,096.
#[test]
fn references_of_many_samples_have_twice_as_many() {
    let folder = Folder::new();
    let scene = |samples: u16| {
        format!(
            "[render]\nwidth = 8\nheight = 8\nsamples = {samples}\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n"
        )
    };
    folder.write("a.toml", scene(300).as_bytes());
    let command = [
        "accuracy", "a.toml", "-o", "out", "--size", "2x2", "--repeat", "1",
    ];
    let few = [&command[..], &["--reference-samples", "512"]].concat();
    folder.fails(2, &few, &["512 samples", "at least 600"]);
    folder.done(&command);
    folder.write("a.toml", scene(4000).as_bytes());
    let command = [
        "accuracy", "a.toml", "-o", "most", "--size", "1x1", "--repeat", "1",
    ];
    let report = folder.json(&command);
    let warnings = report["warnings"].to_string();
    assert!(
        warnings.contains("4,000 samples per pixel are measured as 2048"),
        "{warnings}"
    );
}

#[test]
fn damaged_results_are_said_to_be_so() {
    let folder = folder();
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.write("out/results.json", b"{\"key\": 1");
    folder.fails(2, &SMALL, &["holds no results"]);
}

/// A bound that nothing keeps is an error, behind the table that shows it.
#[test]
fn a_bound_that_is_too_tight_still_shows_the_table() {
    let folder = folder();
    let run = folder.run(&[&SMALL[..], &["--max-error", "0"]].concat());
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stdout.contains("RMSE") && run.stdout.contains("page.html"));
    assert!(
        run.stderr.contains("allow a larger error"),
        "{}",
        run.stderr
    );
    // Boards have the names that `build --target` gives them.
    for board in ["cortex-m3", "mps2-an385"] {
        let bound = ["--max-error", "0.9", "--board", board];
        let report = folder.json(&[&SMALL[..], &bound].concat());
        let name = report["chosen"]["name"].as_str().unwrap();
        assert!(name.starts_with("fixed-"), "{name}");
        let build = report["chosen"]["build"].as_str().unwrap();
        assert!(build.contains("--accel dual-split"), "{build}");
    }
}

/// Other files are not replaced, and results that an interrupted run has lost are made again.
#[test]
fn only_the_same_run_goes_on_in_its_folder() {
    let folder = folder();
    std::fs::create_dir(folder.path("out")).unwrap();
    for own in ["page.html", "results.csv", "results.json"] {
        let own = format!("out/{own}");
        folder.write(&own, b"my own");
        folder.fails(2, &SMALL, &[&own, "would be overwritten", "another folder"]);
        assert_eq!(folder.read(&own), b"my own");
        assert!(!folder.path("out/pictures").exists());
        std::fs::remove_file(folder.path(&own)).unwrap();
    }
    folder.done(&SMALL);
    let other = [&SMALL[..3], &["10x8"], &SMALL[4..]].concat();
    folder.fails(2, &other, &["results.json", "would be overwritten"]);
    // Nor does another build go on, whose times are others.
    let own = folder.read("out/results.json");
    let text = String::from_utf8(own.clone()).unwrap();
    let (before, number) = text.split_once(" build ").unwrap();
    let of_another = format!("{before} build {:08x}{}", 1, &number[8..]);
    folder.write("out/results.json", of_another.as_bytes());
    folder.fails(2, &SMALL, &["another build", "would be overwritten"]);
    folder.write("out/results.json", &own);
    let pictures = || {
        std::fs::read_dir(folder.path("out/pictures"))
            .unwrap()
            .count()
    };
    let made = pictures();
    std::fs::remove_dir_all(folder.path("out/pictures")).unwrap();
    folder.done(&SMALL);
    assert_eq!(pictures(), made);
    // A picture of another size is not taken for that of a setting.
    let one = std::fs::read_dir(folder.path("out/pictures"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .find(|path| !path.display().to_string().contains("difference"));
    let one = one.unwrap();
    folder.done(&["render", "ball.toml", "--size", "4x3", "-o", "small.png"]);
    std::fs::copy(folder.path("small.png"), &one).unwrap();
    let run = folder.run(&SMALL);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.said().contains("4 x 3 pixels"), "{}", run.stderr);
    std::fs::remove_dir_all(folder.path("out")).unwrap();
    // Nor is a picture begun that no memory holds.
    let huge = [&SMALL[..3], &["65535x65535"], &SMALL[4..6], &["-o", "huge"]].concat();
    folder.fails(2, &huge, &["4,294,836,225 pixels", "smaller `--size`"]);
    assert!(!folder.path("huge").exists());
    let large = [&SMALL[..3], &["1025x1024"], &SMALL[4..6], &["-o", "huge"]].concat();
    folder.fails(2, &large, &["1,048,576", "about 1 GB of memory"]);
}

/// A mirror calls for cutoffs, of which one is 0: the reference traces more rays than any setting.
#[test]
fn cutoffs_that_differ_in_the_fourth_digit_have_pictures_of_their_own() {
    let folder = Folder::new();
    folder.write(
        "a.toml",
        b"[material.m]\nmirror = 0.5\n\
          [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n",
    );
    let run = [
        "accuracy", "a.toml", "--size", "4x3", "--repeat", "1", "-o", "out", "--cutoff", "0.00195",
    ];
    let report = folder.json(&run);
    let names: Vec<_> = report["points"]
        .as_array()
        .unwrap()
        .iter()
        .map(|point| point["name"].as_str().unwrap().to_owned())
        .collect();
    for cutoff in ["0.00195", "0.001953125"] {
        let ends = |name: &&String| name.ends_with(&format!("deep-{cutoff}"));
        assert!(names.iter().any(|name| ends(&name)), "{names:?}");
    }
    for name in &names {
        assert!(folder.path(&format!("out/pictures/{name}.png")).exists());
    }
    let mut distinct = names.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(distinct.len(), names.len());
    assert_eq!(report["reference_cutoff"], f64::powi(2.0, -20));
    let page = String::from_utf8(folder.read("out/page.html")).unwrap();
    assert!(page.contains("cutoff 2<sup>-20</sup>"), "no cutoff");
}

/// `-` is standard input, and no folder.
#[test]
fn standard_input_has_a_folder_of_its_own_name() {
    let folder = Folder::new();
    let ball = b"object = [{ kind = \"sphere\", center = [0, 0, 0], radius = 1 }]\n";
    for (command, page) in [("accuracy", "page.html"), ("certify", "certify.html")] {
        let small = [command, "-", "--size", "4x3"];
        let (run, _) = folder.piped(&small, ball);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(folder.path(&format!("{command}-stdin/{page}")).exists());
        let (run, _) = folder.piped(&[&small[..], &["-o", "-"]].concat(), ball);
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(
            run.said().contains("`-` is standard output"),
            "{}",
            run.stderr
        );
        assert!(!folder.path("-").exists());
    }
}

/// The commands that are printed make what was measured.
#[test]
fn the_choice_is_written_with_all_options() {
    let folder = Folder::new();
    let c60 = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/c60.pdb");
    std::fs::copy(c60, folder.path("my c60.pdb")).unwrap();
    let run = [
        "accuracy",
        "my c60.pdb",
        "--size",
        "8x6",
        "--repeat",
        "1",
        "--style",
        "ball-and-stick",
        "--accel",
        "wide",
        "--quality",
        "fast",
        "--cutoff",
        "0.25",
        "--max-error",
        "0.9",
        "-o",
        "o",
    ];
    let text = folder.done(&run);
    for part in [
        "gridel build 'my c60.pdb' --style ball-and-stick",
        " -o 'my c60.gridel' --accel wide --quality fast",
        " --cutoff 0.25",
        "gridel render 'my c60.gridel' -o 'my c60.png'",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn effects_are_left_out_and_priced() {
    let folder = folder();
    let report = folder.json(&[&SMALL[..], &["--max-rays", "1000"]].concat());
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1);
    assert_eq!(effects[0]["effect"], "shadow");
    assert!(effects[0]["rays"].as_f64().unwrap() > 0.0);
    assert!(report["answers"].as_array().unwrap().len() >= 2);
    assert!(report["points"][0]["parts"]["sampling"].is_number());
    let csv = String::from_utf8(folder.read("out/results.csv")).unwrap();
    let columns: Vec<_> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(
        columns.iter().all(|&count| count == columns[0]),
        "{columns:?}"
    );
    // A limit that nothing keeps, and one that is none.
    let run = folder.run(&[&SMALL[..], &["--max-rays", "0.25"]].concat());
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.said().contains("the fewest are"), "{}", run.stderr);
    folder.fails(
        2,
        &[&SMALL[..], &["--max-rays", "0"]].concat(),
        &["a number above 0"],
    );
}

/// A blob without effects is that of a scene that does not call for them.
#[test]
fn build_leaves_effects_out_and_says_what_is_lost() {
    let folder = Folder::with_quick();
    let build = ["build", "quick.toml", "-o", "without.gridel", "--without"];
    let run = folder.run(&[&build[..], &["glass,mirror"]].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let said = run.said();
    for part in [
        "without glass",
        "glass is opaque",
        "without mirror",
        "diffuse color",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let inspection = folder.json(&["inspect", "without.gridel"]);
    let effects = inspection["effects"].to_string();
    assert!(effects.contains("shadow"), "{effects}");
    assert!(
        !effects.contains("glass") && !effects.contains("mirror"),
        "{effects}"
    );
    // What is left has a price on a board.
    let board = [
        "build",
        "quick.toml",
        "-o",
        "b.gridel",
        "--target",
        "mps2-an386",
    ];
    let report = folder.json(&board);
    let mut effects = report["effects"].as_array().unwrap().iter();
    assert!(
        effects.all(|it| it["code"].as_u64().is_some_and(|bytes| bytes > 0)),
        "{report}"
    );
    // Unknown names are rejected with the list, and blobs hold what they hold.
    folder.fails(
        2,
        &[&build[..], &["glas"]].concat(),
        &["glas", "glass", "shadow", "smooth"],
    );
    let render = [
        "render",
        "quick.gridel",
        "-o",
        "out.png",
        "--without",
        "glass",
    ];
    folder.fails(2, &render, &["--without", "is for scene files"]);
    let run = folder.run(&[&build[..], &["smooth"]].concat());
    assert!(
        run.said().contains("does not call for smooth"),
        "{}",
        run.stderr
    );
}

/// Against exact pictures `f64` has an error of its own, and sampling and arithmetic stand apart.
#[test]
fn the_exact_picture_is_a_reference() {
    let folder = folder();
    let run = [
        &SMALL[..],
        &["--reference", "exact", "--reference-samples", "128"],
    ]
    .concat();
    let report = folder.json(&run);
    assert_eq!(report["reference"], "exact");
    assert_eq!(report["reference_open"], 0);
    let points = report["points"].as_array().unwrap();
    let part = |point: &serde_json::Value, part: &str| point["parts"][part].as_f64().unwrap();
    // What sampling does is the same for every format: that of the exact pictures.
    let of = |name: &str| {
        points
            .iter()
            .find(|it| it["setting"]["format"] == name)
            .unwrap()
    };
    assert_eq!(part(of("fixed"), "sampling"), part(of("f32"), "sampling"));
    assert!(part(of("f64"), "arithmetic") <= part(of("f32"), "arithmetic"));
    assert!(part(of("f32"), "arithmetic") < 0.01);
    let page = String::from_utf8(folder.read("out/page.html")).unwrap();
    assert!(page.contains("the exact picture that"), "no exact picture");
    assert!(!page.contains("the picture of <code>f64</code>"));
    // The measurements of one reference are not continued with another one.
    let other = [&SMALL[..], &["--reference-samples", "128"]].concat();
    folder.fails(2, &other, &["would be overwritten"]);
    let wrong = [&SMALL[..], &["--reference", "fixed"]].concat();
    folder.fails(2, &wrong, &["fixed"]);
}
