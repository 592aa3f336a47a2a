//! `gridel compare`.

use crate::program::{Folder, fixture};

#[test]
fn every_structure_has_a_row_with_the_lists_answers() {
    let folder = Folder::with_quick();
    let report = folder.json(&["compare", "quick.toml", "--size", "32x24", "--repeat", "1"]);
    assert_eq!(report["primitives"], 17);
    assert_eq!(report["rays"]["primary"], 32 * 24);
    let rows = report["rows"].as_array().unwrap();
    assert!(rows.len() >= 3);
    for row in rows {
        assert!(row["wrong"].is_null(), "{row}");
        let primary = &row["work"]["primary"];
        assert_eq!(primary["rays"], 32 * 24);
        assert!(primary["rays_per_second"].as_f64().unwrap() > 0.0, "{row}");
        assert!(row["peak_bytes"].as_u64().unwrap() > 0, "{row}");
    }
    let list = &rows[0];
    assert_eq!(list["structure"], "list");
    assert_eq!(list["own_bytes"], 0);
    assert_eq!(list["work"]["all"]["primitives"], 17.0);
    let findings = report["findings"].as_array().unwrap();
    assert_eq!(findings.len(), rows.len() + 1);
    assert_eq!(
        findings[rows.len()],
        "times were not compared: fewer than 3 repeats"
    );
}

#[test]
fn rows_are_those_asked_for_and_counts_repeat() {
    let folder = Folder::with_quick();
    let compare = ["compare", "quick.toml", "--size", "32x24", "--repeat", "0"];
    let named = [&compare[..], &["--accel", "flagged", "--format", "fixed"]].concat();
    let report = folder.json(&named);
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0]["structure"], "flagged");
    assert!(rows[0]["work"]["all"]["rays_per_second"].is_null());
    assert_eq!(
        report["rows"][0]["work"],
        folder.json(&named)["rows"][0]["work"]
    );
    let text = folder.done(&named);
    for word in ["17 primitives", "32 by 24", "fixed", "equal"] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn charts_are_written_whole() {
    let folder = Folder::with_quick();
    let compare = ["compare", "quick.toml", "--size", "16x12", "--repeat", "1"];
    folder.done(&[&compare[..], &["--plot", "charts"]].concat());
    for chart in [
        "tests",
        "rates",
        "growth-rates",
        "growth-bytes",
        "growth-peak",
        "growth-setup",
    ] {
        let svg = String::from_utf8(folder.read(&format!("charts/{chart}.svg"))).unwrap();
        assert!(
            svg.starts_with("<svg") && svg.contains("flagged"),
            "{chart}"
        );
    }
    // Charts of an earlier run are replaced, and other files are not.
    let again = [&compare[..], &["--accel", "flagged", "--plot", "charts"]].concat();
    folder.done(&again);
    folder.write("charts/growth-peak.svg", b"<svg>my own</svg>");
    folder.fails(2, &again, &["growth-peak.svg", "would be overwritten"]);
    assert_eq!(folder.read("charts/growth-peak.svg"), b"<svg>my own</svg>");
    folder.fails(
        2,
        &[&compare[..], &["--plot", "-"]].concat(),
        &["standard output", "./-"],
    );
    folder.write("file", b"");
    let into_file = [&compare[..], &["--plot", "file"]].concat();
    folder.fails(1, &into_file, &["file cannot be written"]);
}

#[test]
fn too_many_rays_are_rejected() {
    let folder = Folder::with_quick();
    let large = [
        "compare",
        "quick.toml",
        "--size",
        "2048x2048",
        "--repeat",
        "0",
    ];
    // The rays of the camera alone would not be too many.
    folder.fails(1, &large, &["more than", "rays", "--size"]);
}

/// All are compared that can be; one that was asked for and cannot be is a failure.
#[test]
fn structures_that_were_asked_for_and_do_not_fit_are_rejected() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    let compare = [
        "compare",
        "quick.toml",
        "--accel",
        "grid",
        "--grid",
        "1024",
        "--size",
        "8x8",
        "--repeat",
        "0",
    ];
    let run = folder.run(&compare);
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    assert!(run.stdout.contains("the table of grid"), "{}", run.stdout);
    assert!(
        run.stderr.contains("more than its budget"),
        "{}",
        run.stderr
    );
}

#[test]
fn scenes_without_objects_have_a_warning() {
    let folder = Folder::new();
    folder.write("empty.toml", b"ambient = 0.5\n");
    let small = ["empty.toml", "--size", "8x6", "--repeat", "1"];
    for (command, more) in [("compare", &[][..]), ("accuracy", &["-o", "out"])] {
        let run = folder.run(&[&[command], &small[..], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.said().contains("the scene has no object"), "{command}");
    }
}

/// The growth takes parts of meshes; where it fails, the comparison is printed already.
#[test]
fn growth_of_meshes_with_normals_and_coordinates_is_drawn() {
    let folder = Folder::new();
    let mut strip = String::new();
    for place in 0..71 {
        let (u, normal) = (f64::from(place) / 70.0, 0.02 * f64::from(place - 35));
        for y in [0, 1] {
            strip += &format!("v {place} {y} {}\nvt {u} {y}\nvn {} 0 1\n", u * u, -normal);
        }
    }
    for place in 0..70 {
        let [a, b, c, d] = [1, 3, 4, 2].map(|corner| 2 * place + corner);
        strip += &format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c} {d}/{d}/{d}\n");
    }
    folder.write("strip.obj", strip.as_bytes());
    let compare = [
        "compare",
        "strip.obj",
        "--plot",
        "d",
        "--repeat",
        "0",
        "--size",
        "16x16",
        "--accel",
        "bvh",
    ];
    let text = folder.done(&compare);
    assert!(text.contains("140 primitives"), "{text}");
    assert!(folder.path("d/growth-rates.svg").exists());
}

/// Diffuse rays are neither mirrored nor refracted.
#[test]
fn rays_that_surfaces_send_on_are_called_bounced() {
    let folder = Folder::new();
    folder.write(
        "a.toml",
        b"[render]\nbounces = 1\ndepth = 1\n[[light]]\nkind = 'point'\nposition = [3, 3, 3]\n\
          [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
          [[object]]\nkind = 'sphere'\ncenter = [2, 0, 0]\nradius = 1\n",
    );
    let compare = [
        "compare", "a.toml", "--size", "16x12", "--repeat", "0", "--accel", "bvh",
    ];
    let text = folder.done(&compare);
    assert!(text.contains("a bounced ray"), "{text}");
    assert!(
        !text.contains("mirrored") && !text.contains("refracted"),
        "{text}"
    );
}

/// The scene is not even read.
#[test]
fn compare_rejects_pictures_of_too_many_pixels_at_once() {
    let folder = Folder::new();
    let compare = ["compare", "missing.toml", "--size", "65535x65535"];
    let words = ["4,294,836,225 pixels exceed", "4,194,304", "`--size`"];
    folder.fails(2, &compare, &words);
}
