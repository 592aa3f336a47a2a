//! Messages about scene files that hold more than is drawn, name files elsewhere, or stand for more
//! than memory holds.

use crate::program::Folder;
use std::fmt::Write;

const COLORS: &str = "v 0 0 0\nv 1 0 0 1 1 1\nv 0 1 0 1 0 0\nf 1 2 3\n";

#[test]
fn ignored_data_are_in_the_json_of_every_command() {
    let folder = Folder::new();
    folder.write("a.obj", COLORS.as_bytes());
    let warning = "a.obj:2: vertices before the first with a color are white";
    let small = ["--size", "16x12"];
    for arguments in [
        &["build", "a.obj", "-o", "a.gridel"][..],
        &[&["render", "a.obj", "-o", "a.png"], &small[..]].concat(),
        &["inspect", "a.obj"],
        &["verify", "a.obj", "--rays", "1000"],
        &[&["explain", "a.obj", "--pixel", "1,1"], &small[..]].concat(),
        &[
            &["compare", "a.obj", "--accel", "bvh", "--repeat", "0"],
            &small[..],
        ]
        .concat(),
    ] {
        let report = folder.json(arguments);
        assert_eq!(
            report["warnings"],
            serde_json::json!([warning]),
            "{arguments:?}"
        );
        let run = folder.run(arguments);
        assert!(
            run.stderr.contains(&format!("warning: {warning}")),
            "{}",
            run.stderr
        );
    }
    let check = "[[check]]\nscene = \"a.obj\"\nbudget = { blob_bytes = 1_000_000 }\n";
    folder.write("check.toml", check.as_bytes());
    let report = folder.json(&["check", "check.toml"]).to_string();
    assert!(report.contains("vertices before the first"), "{report}");
}

#[test]
fn files_outside_of_the_folder_need_a_flag_in_every_command() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    folder.write("out.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let import = "[[object]]\nkind = \"import\"\nfile = \"../out.obj\"\n";
    folder.write("in/a.toml", import.as_bytes());
    let words = ["in/a.toml:3", "../out.obj", "outside", "--allow-outside"];
    let small = ["--size", "16x12"];
    for arguments in [
        &["build", "in/a.toml", "-o", "a.gridel"][..],
        &[&["render", "in/a.toml", "-o", "a.png"], &small[..]].concat(),
        &["inspect", "in/a.toml"],
        &["verify", "in/a.toml", "--rays", "1000"],
        &[&["explain", "in/a.toml", "--pixel", "1,1"], &small[..]].concat(),
        &[
            &["compare", "in/a.toml", "--accel", "bvh", "--repeat", "0"],
            &small[..],
        ]
        .concat(),
    ] {
        folder.fails(1, arguments, &words);
        folder.done(&[arguments, &["--allow-outside"]].concat());
    }
    for command in ["trace", "accuracy"] {
        assert!(
            folder
                .done(&[command, "--help"])
                .contains("--allow-outside"),
            "{command}"
        );
    }
    let check = "[[check]]\nscene = \"in/a.toml\"\nbudget = { blob_bytes = 1_000_000 }\n";
    folder.write("check.toml", check.as_bytes());
    let run = folder.run(&["check", "check.toml"]);
    assert_eq!(run.code, Some(1), "{}", run.stdout);
    assert!(run.stdout.contains("outside"), "{}", run.stdout);
    folder.write(
        "check.toml",
        format!("{check}allow_outside = true\n").as_bytes(),
    );
    folder.done(&["check", "check.toml"]);
    // A blob names no files.
    folder.fails(
        2,
        &["inspect", "a.gridel", "--allow-outside"],
        &["--allow-outside is for scene files"],
    );
}

/// A file of 2 KB that stands for 2^23 spheres, where there are 4 GB.
#[cfg(target_os = "linux")]
#[test]
fn two_to_the_23_instances_are_rejected_under_4_gb() {
    let folder = Folder::new();
    let dot = "{ kind = \"sphere\", center = [0, 0, 0], radius = 1 },";
    let mut text = format!("[group.g0]\nobject = [{dot}]\n");
    for floor in 1..=23 {
        let instance = format!("{{ kind = \"instance\", group = \"g{}\" }},", floor - 1);
        writeln!(text, "[group.g{floor}]\nobject = [{instance}{instance}]").unwrap();
    }
    text.push_str("[[object]]\nkind = \"instance\"\ngroup = \"g23\"\n");
    folder.write("many.toml", text.as_bytes());
    let capped = "ulimit -v 4000000; exec \"$0\" build many.toml -o many.gridel";
    let output = std::process::Command::new("sh")
        .args(["-c", capped, env!("CARGO_BIN_EXE_gridel")])
        .current_dir(folder.path(""))
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    let said = said
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
        .replace("│ ", "");
    assert_eq!(output.status.code(), Some(1), "{said}");
    for words in [
        "GB of memory, for",
        "the limit is 3.8 GB",
        "use fewer instances",
    ] {
        assert!(said.contains(words), "no {words:?} in {said}");
    }
}

/// A part with two instances.
const CART: &str = "[[part]]\nname = 'wheel'\n[[part.object]]\nkind = 'sphere'\n\
    center = [0, 0, 0]\nradius = 1\nname = 'hub'\n\
    [[instance]]\npart = 'wheel'\nname = 'left'\n\
    [[instance]]\npart = 'wheel'\nname = 'right'\ntranslate = [3, 0, 0]\n";

#[test]
fn instances_are_kept_or_flattened() {
    let folder = Folder::new();
    folder.write("cart.toml", CART.as_bytes());
    for choice in ["keep", "flatten"] {
        let picture = format!("{choice}.png");
        folder.done(&[
            "render",
            "cart.toml",
            "--instances",
            choice,
            "--size",
            "20x15",
            "-o",
            &picture,
        ]);
    }
    folder.done(&[
        "build",
        "cart.toml",
        "--instances",
        "flatten",
        "-o",
        "flat.gridel",
    ]);
    let names = folder.done(&["trace", "--help"]);
    assert!(names.contains("--instances"), "{names}");
    folder.fails(
        2,
        &["inspect", "flat.gridel", "--instances", "flatten"],
        &["--instances is for scene files"],
    );
    folder.fails(
        2,
        &[
            "build",
            "cart.toml",
            "--instances",
            "copy",
            "-o",
            "a.gridel",
        ],
        &["possible values: keep, flatten"],
    );
}

#[test]
fn assembly_is_chosen_by_its_number() {
    let folder = Folder::new();
    folder.write("cart.toml", CART.as_bytes());
    let pdb = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n\
REMARK 350   BIOMT1   1 -1.000000  0.000000  0.000000        0.00000\n\
REMARK 350   BIOMT2   1  0.000000 -1.000000  0.000000        0.00000\n\
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n\
ATOM      1  CA  CYS A   3      11.000   2.000   3.000  1.00  0.00           C\n";
    folder.write("a.pdb", pdb.as_bytes());
    folder.done(&["build", "a.pdb", "--assembly", "1", "-o", "a.gridel"]);
    folder.fails(
        1,
        &["build", "a.pdb", "--assembly", "2", "-o", "b.gridel"],
        &["there is no assembly", "choose one of 1"],
    );
    folder.fails(
        2,
        &["build", "cart.toml", "--assembly", "1", "-o", "b.gridel"],
        &["--assembly is for PDB and mmCIF files"],
    );
    folder.fails(
        2,
        &["inspect", "a.gridel", "--assembly", "1"],
        &["--assembly is for scene files"],
    );
}

/// A key later than the last tick is an error that names the way to do without.
#[test]
fn animations_beyond_a_limit_can_be_left_out() {
    let folder = Folder::new();
    let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let times = [0.0, 1.0, 50_000.0];
    let numbers: Vec<f32> = corners.into_iter().chain(times).chain(corners).collect();
    let bytes: Vec<u8> = numbers.iter().flat_map(|it| it.to_le_bytes()).collect();
    folder.write("late.bin", &bytes);
    let accessor = |view: u32, kind: &str| {
        serde_json::json!({"bufferView": view, "componentType": 5126, "count": 3, "type": kind,
            "min": [0, 0, 0], "max": [1, 1, 0]})
    };
    let mut time = accessor(1, "SCALAR");
    (time["min"], time["max"]) = (serde_json::json!([0]), serde_json::json!([50_000]));
    let document = serde_json::json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"uri": "late.bin", "byteLength": 84}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 12},
            {"buffer": 0, "byteOffset": 48, "byteLength": 36},
        ],
        "accessors": [accessor(0, "VEC3"), time, accessor(2, "VEC3")],
        "animations": [{
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": 1, "output": 2}],
        }],
    });
    folder.write("late.gltf", document.to_string().as_bytes());
    let render = ["render", "late.gltf", "-o", "late.png", "--size", "8x6"];
    folder.fails(
        1,
        &render,
        &["50000", "beyond 44739 seconds", "`--animation none`"],
    );
    folder.done(&[&render[..], &["--animation", "none"]].concat());
}
