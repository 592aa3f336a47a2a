//! `gridel compare` and `gridel accuracy` of scenes with instances, kept and copied.

use crate::program::{Folder, fixture};
use gridel_host::table::grouped;
use serde_json::{Value, json};

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("arm.toml", &fixture("robot-arm"));
    folder
}

/// Bytes of the blob of the arm that `build` writes without names.
fn built(folder: &Folder, instances: &[&str]) -> u64 {
    let build = ["build", "arm.toml", "-o", "arm.gridel", "--strip-names"];
    folder.done(&[&build[..], instances].concat());
    folder.read("arm.gridel").len() as u64
}

const FLATTEN: [&str; 2] = ["--instances", "flatten"];

const COMPARE: [&str; 8] = [
    "compare",
    "arm.toml",
    "--size",
    "32x24",
    "--repeat",
    "0",
    "--gridels",
    "1",
];

/// Rows of the arm, all of which must be right.
fn compared(folder: &Folder, options: &[&str]) -> Value {
    let report = folder.json(&[&COMPARE[..], options].concat());
    for row in report["rows"].as_array().unwrap() {
        assert!(row["wrong"].is_null(), "{row}");
    }
    report
}

fn row<'r>(report: &'r Value, structure: &str) -> &'r Value {
    let mut rows = report["rows"].as_array().unwrap().iter();
    rows.find(|row| row["structure"] == structure).unwrap()
}

#[test]
fn compare_keeps_instances_or_copies_them() {
    let folder = folder();
    let kept = compared(&folder, &[]);
    assert_eq!(kept["rows"].as_array().unwrap().len(), 15);
    assert_eq!(kept["rejected"], json!([]));
    let expected = json!({
        "choice": "keep", "instances": 6, "parts": 4, "stored_primitives": 9, "placed_primitives": 12
    });
    assert_eq!(
        (&kept["instances"], &kept["primitives"]),
        (&expected, &json!(9))
    );
    assert_eq!(kept["warnings"], json!([]));
    assert_eq!(row(&kept, "dual-split")["blob_bytes"], built(&folder, &[]));
    let explicit = compared(
        &folder,
        &["--instances", "keep", "--accel", "cylinder-cube"],
    );
    let cube = row(&kept, "cylinder-cube");
    assert_eq!(row(&explicit, "cylinder-cube")["work"], cube["work"]);

    let flat = compared(&folder, &FLATTEN);
    let expected = json!({
        "choice": "flatten", "instances": 6, "stored_primitives": 12, "placed_primitives": 12
    });
    assert_eq!(
        (&flat["instances"], &flat["primitives"]),
        (&expected, &json!(12))
    );
    let dual_split = row(&flat, "dual-split");
    assert_eq!(dual_split["blob_bytes"], built(&folder, &FLATTEN));
    assert!(dual_split["work"]["all"].get("instances").is_none());
    assert!(flat["warnings"][0].as_str().unwrap().contains("at rest"));
    // Both show one picture, whose rays hardly differ.
    assert_eq!(kept["rays"]["primary"], flat["rays"]["primary"]);
    let shadow = [&kept, &flat].map(|it| it["rays"]["shadow"].as_u64().unwrap());
    assert!(shadow[0].abs_diff(shadow[1]) < 5, "{shadow:?}");

    let text = folder.done(&[&COMPARE[..6], &["--accel", "bvh"]].concat());
    for words in [
        "6 instances of 4 parts kept: 9 primitives stored, 12 placed",
        "primitives  instances  M rays/s",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let text = folder.done(&[&COMPARE[..6], &["--accel", "bvh"], &FLATTEN[..]].concat());
    assert!(
        text.contains("6 instances copied: 12 primitives stored"),
        "{text}"
    );
    assert!(text.contains("primitives  M rays/s"), "{text}");
}

/// The tests of all rays together are those of the picture that `render` draws.
#[test]
fn compare_counts_what_render_does() {
    let folder = folder();
    for (format, instances) in [("f32", &[][..]), ("fixed", &[]), ("f32", &FLATTEN)] {
        for structure in ["list", "dual-split", "wide"] {
            let with = ["--accel", structure, "--format", format];
            let options = [&with[..], instances].concat();
            let report = folder.json(&[&COMPARE[..6], &options].concat());
            let all = &row(&report, structure)["work"]["all"];
            let render = [
                "render",
                "arm.toml",
                "--size",
                "32x24",
                "--samples",
                "1",
                "--stats",
                "-o",
                "a.png",
            ];
            let stats = &folder.json(&[&render[..], &options].concat())["stats"];
            assert_eq!(all["rays"], stats["rays"]);
            for count in ["planes", "boxes", "cells", "primitives"] {
                let counted = all[count].as_f64().unwrap() * all["rays"].as_f64().unwrap();
                assert_eq!(
                    counted.round(),
                    stats[count].as_f64().unwrap(),
                    "{count} of {structure} in {format}, {instances:?}"
                );
            }
        }
    }
}

/// A scene grows by single primitives, which need copies.
#[test]
fn compare_draws_growth_of_copies() {
    let folder = folder();
    let plot = ["--accel", "flagged", "--plot", "charts"];
    let report = folder.json(&[&COMPARE[..6], &plot].concat());
    assert_eq!(report["instances"]["choice"], "keep");
    assert_eq!(report["growth"]["instances"], "flatten");
    assert_eq!(report["growth"]["steps"][0]["primitives"], 12);
    let chart = |name: &str| String::from_utf8(folder.read(&format!("charts/{name}.svg"))).unwrap();
    assert!(chart("growth-rates").contains("instances copied"));
    assert!(chart("tests").contains("instances entered"));
    let flat = folder.json(&[&COMPARE[..6], &plot, &FLATTEN].concat());
    assert!(flat["growth"].get("instances").is_none());
}

/// Too many to be copied can be compared, and no growth of them be drawn.
#[test]
fn compare_rejects_growth_of_too_many_copies() {
    let folder = Folder::new();
    let mut mesh = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n");
    for _ in 0..10_000 {
        mesh += "f 1 2 3\nf 1 2 4\n";
    }
    folder.write("mesh.obj", mesh.as_bytes());
    let mut scene = String::from(
        "[[part]]\nname = 'mesh'\nobject = [{ kind = 'import', file = 'mesh.obj' }]\n",
    );
    for number in 0..1000 {
        scene += &format!("[[instance]]\npart = 'mesh'\ntranslate = [{number}, 0, 0]\n");
    }
    folder.write("many.toml", scene.as_bytes());
    std::fs::create_dir(folder.path("charts")).unwrap();
    let compare = ["compare", "many.toml", "--accel", "bvh", "--repeat", "0"];
    let words = [
        "growth charts need copies",
        "20,000,000 primitives",
        "leave `--plot` out",
    ];
    folder.fails(1, &[&compare[..], &["--plot", "charts"]].concat(), &words);
}

const ACCURACY: [&str; 8] = [
    "accuracy",
    "arm.toml",
    "--size",
    "16x12",
    "--repeat",
    "1",
    "--reference-samples",
    "128",
];

/// The pixels of a picture.
fn pixels(folder: &Folder, name: &str) -> Vec<u8> {
    let file = folder.read(name);
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    pixels
}

#[test]
fn accuracy_measures_the_picture_that_render_draws() {
    let folder = folder();
    let base = "f32-24bit-2spp-5deep-0.001953125";
    for (choice, option, to) in [("keep", &[][..], "kept"), ("flatten", &FLATTEN, "flat")] {
        let bound = ["--max-error", "0.9", "-o", to];
        let report = folder.json(&[&ACCURACY[..], option, &bound].concat());
        assert_eq!(report["instances"]["choice"], choice);
        assert_eq!(report["instances"]["instances"], 6);
        let cost = &report["points"][0]["cost"];
        assert_eq!(cost["blob_bytes"], built(&folder, option));
        let render = [
            "render",
            "arm.toml",
            "--size",
            "16x12",
            "--accel",
            "dual-split",
            "--stats",
            "-o",
            "render.png",
        ];
        let stats = &folder.json(&[&render[..], option].concat())["stats"];
        let count = |name: &str| stats[name].as_u64().unwrap();
        assert_eq!(cost["rays"], stats["rays"]);
        assert_eq!(cost["tests"], count("boxes") + count("primitives"));
        let measured = pixels(&folder, &format!("{to}/pictures/{base}.png"));
        assert!(measured == pixels(&folder, "render.png"), "{choice}");
        // All objects of the reference are met, and none for another one.
        for point in report["points"].as_array().unwrap() {
            let others = point["errors"]["other_objects"].as_u64().unwrap();
            assert!(others <= 4, "{point}");
        }
        let build = report["chosen"]["build"].as_str().unwrap();
        assert_eq!(build.contains("--instances flatten"), choice == "flatten");
        let page = String::from_utf8(folder.read(&format!("{to}/page.html"))).unwrap();
        let words = match choice {
            "keep" => "6 instances of 4 parts kept: 9 primitives stored, 12 placed",
            _ => "6 instances copied: 12 primitives stored",
        };
        assert!(page.contains(words), "{words}");
        let views = "views of 4 parts take at most";
        assert_eq!(page.contains(views), choice == "keep");
    }
    // Results of kept instances are not continued with copies.
    let other = [&ACCURACY[..], &FLATTEN, &["-o", "kept"]].concat();
    folder.fails(2, &other, &["would be overwritten"]);
    let text = folder.done(&[&ACCURACY[..], &["-o", "kept"]].concat());
    assert!(text.contains("6 instances of 4 parts kept"), "{text}");
}

/// One sphere in many places: each is stored in fewer bytes than an instance has.
#[test]
fn build_states_the_bytes_of_instances_and_of_copies() {
    let folder = Folder::new();
    let part =
        "[[part]]\nname = 'p'\nobject = [{ kind = 'sphere', center = [0, 0, 0], radius = 1 }]\n";
    let place = |n: u32| {
        let [x, y] = [n % 16, n / 16].map(|it| 3 * it);
        format!("[[instance]]\npart = 'p'\ntranslate = [{x}, {y}, 0]\n")
    };
    let places: String = (0..256).map(place).collect();
    folder.write("a.toml", format!("{part}{places}").as_bytes());
    let build = |choice: &str| {
        let options = [
            "build",
            "a.toml",
            "-o",
            "a.gridel",
            "--strip-names",
            "--instances",
            choice,
        ];
        let report = folder.json(&options);
        [&report["bytes"], &report["bytes_otherwise"]].map(|it| it.as_u64().unwrap())
    };
    let [kept, as_copies] = build("keep");
    assert_eq!(build("flatten"), [as_copies, kept]);
    assert!(as_copies < kept);
    let text = folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    assert!(
        text.contains("`--instances flatten` copies them, in"),
        "{text}"
    );
    let most = ["build", "a.toml", "-o", "b.gridel", "--max-bytes", "1K"];
    let advice = format!("`--instances flatten` saves {}", grouped(kept - as_copies));
    folder.fails(3, &most, &[&advice]);
}

#[test]
fn verify_says_how_many_closed_meshes_rays_start_in() {
    let folder = Folder::new();
    let mut scene = String::from(
        "[[part]]\nname = 'p'\n[[part.object]]\nkind = 'mesh'\n\
         vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]\n\
         faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]\n",
    );
    let instance = |x: u32| format!("[[instance]]\npart = 'p'\ntranslate = [{x}, 0, 0]\n");
    scene.extend((0..100).map(|it| instance(2 * it)));
    folder.write("many.toml", scene.as_bytes());
    let verify = ["verify", "many.toml", "--accel", "bvh", "--rays", "500"];
    let text = folder.done(&verify);
    assert!(
        text.contains("as many from inside 50 of 100 closed meshes"),
        "{text}"
    );
    let report = folder.json(&verify);
    assert_eq!(
        (
            &report["closed_meshes"],
            &report["closed_meshes_aimed_from"]
        ),
        (&100.into(), &50.into())
    );
    folder.write(
        "ball.toml",
        b"[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    let text = folder.done(&["verify", "ball.toml", "--accel", "bvh", "--rays", "500"]);
    assert!(!text.contains("from inside"), "{text}");
}

#[test]
fn verify_limits_the_closed_meshes_of_the_scene_and_counts_those_with_a_ray() {
    let folder = Folder::new();
    let mesh = |x: u32| {
        let [a, b] = [2 * x, 2 * x + 1];
        format!(
            "[[object]]\nkind = 'mesh'\nvertices = [[{a}, 0, 0], [{b}, 0, 0], [{a}, 1, 0], [{a}, 0, 1]]\n\
             faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]\n"
        )
    };
    let scene: String = (0..70).map(mesh).collect();
    folder.write("many.toml", scene.as_bytes());
    for (rays, aimed_from) in [("500", 35), ("5", 5)] {
        let report = folder.json(&["verify", "many.toml", "--accel", "bvh", "--rays", rays]);
        assert_eq!(report["closed_meshes"], 70);
        assert_eq!(report["closed_meshes_aimed_from"], aimed_from);
    }
}

#[test]
fn verify_lists_rays_only_where_a_t_is_off() {
    let folder = Folder::new();
    folder.write("empty.toml", b"background = [1, 1, 1]\n");
    let text = folder.done(&["verify", "empty.toml", "--accel", "bvh", "--rays", "50"]);
    assert!(!text.contains("largest errors"), "{text}");
}
