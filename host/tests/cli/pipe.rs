//! Standard input and output in place of files, written `-`.

use crate::program::{Folder, fixture};
use crate::trace::{npy, rows};
use gridel_host::scene::IMPORTERS;
use serde_json::Value;

/// A run that must succeed: the bytes of standard output, and what standard error says.
fn done(folder: &Folder, arguments: &[&str], input: &[u8]) -> (Vec<u8>, String) {
    let (run, bytes) = folder.piped(arguments, input);
    assert_eq!(run.code, Some(0), "{arguments:?}: {}", run.stderr);
    (bytes, run.stderr)
}

#[test]
fn build_reads_and_writes_streams_as_files() {
    let folder = Folder::with_quick();
    folder.done(&["build", "quick.toml", "-o", "a.gridel"]);
    let expected = folder.read("a.gridel");
    let before = folder.names();
    let (blob, report) = done(&folder, &["build", "-", "-o", "-"], &fixture("quick"));
    assert!(blob == expected);
    assert!(report.contains("structures  list, dual-split"), "{report}");
    let (blob, report) = done(&folder, &["build", "quick.toml", "-o", "-", "--json"], b"");
    assert!(blob == expected);
    let report: Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["bytes"], expected.len());
    assert_eq!(folder.names(), before);
    let (text, _) = done(
        &folder,
        &["build", "-", "-o", "b.gridel"],
        &fixture("quick"),
    );
    assert!(String::from_utf8(text).unwrap().contains("b.gridel"));
    assert!(folder.read("b.gridel") == expected);
}

#[test]
fn render_and_inspect_take_scenes_and_blobs_from_streams() {
    let folder = Folder::with_quick();
    let small = ["--size", "48x36"];
    folder.done(&[&["render", "quick.gridel", "-o", "a.png"], &small[..]].concat());
    let expected = folder.read("a.png");
    let render = [&["render", "-", "-o", "-"], &small[..]].concat();
    for input in [folder.read("quick.gridel"), fixture("quick")] {
        let (picture, report) = done(&folder, &render, &input);
        assert!(picture == expected);
        assert!(report.contains("48 x 36"), "{report}");
    }
    let inspected = folder.done(&["inspect", "quick.gridel"]);
    let (text, _) = done(&folder, &["inspect", "-"], &folder.read("quick.gridel"));
    assert_eq!(String::from_utf8(text).unwrap(), inspected);
}

#[test]
fn every_format_is_recognised_on_standard_input() {
    let folder = Folder::new();
    for importer in IMPORTERS {
        let name = format!("a.{}", importer.extensions[0]);
        folder.write(&name, importer.example.as_bytes());
        // Some formats name their object after the file.
        folder.done(&["build", &name, "-o", "a.gridel", "--strip-names"]);
        let build = ["build", "-", "-o", "-", "--strip-names"];
        let (found, _) = done(&folder, &build, importer.example.as_bytes());
        assert!(found == folder.read("a.gridel"), "{name}");
    }
    // Editors may put a mark of the encoding before the text.
    let quick = String::from_utf8(fixture("quick")).unwrap();
    let build = ["build", "-", "-o", "-", "--strip-names"];
    let [(plain, _), (marked, _)] =
        ["", "\u{feff}"].map(|mark| done(&folder, &build, format!("{mark}{quick}").as_bytes()));
    assert!(marked == plain);
}

#[test]
fn trace_reads_scene_or_rays_from_a_stream_and_writes_hits_to_one() {
    let folder = Folder::with_quick();
    let rays = npy("<f8", &rows(500));
    folder.write("rays.npy", &rays);
    folder.done(&[
        "trace",
        "quick.gridel",
        "--rays",
        "rays.npy",
        "-o",
        "hits.npy",
    ]);
    let expected = folder.read("hits.npy");
    for (arguments, input) in [
        (
            ["trace", "-", "--rays", "rays.npy", "-o", "-"],
            folder.read("quick.gridel"),
        ),
        (
            ["trace", "quick.gridel", "--rays", "-", "-o", "-"],
            rays.clone(),
        ),
    ] {
        let (hits, report) = done(&folder, &arguments, &input);
        assert!(hits == expected);
        assert!(report.contains("500 rays"), "{report}");
    }
    let both = ["trace", "-", "--rays", "-", "-o", "hits.npy"];
    folder.fails(2, &both, &["both to come from standard input"]);
    let (run, _) = folder.piped(&["trace", "quick.gridel", "--rays", "-", "-o", "-"], b"no");
    assert_eq!(run.code, Some(1));
    assert!(
        run.said().contains("<stdin> cannot be used"),
        "{}",
        run.stderr
    );
}

#[test]
fn errors_of_standard_input_name_stdin() {
    let folder = Folder::with_quick();
    folder.write("near.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let import = |file: &str| format!("[[object]]\nkind = \"import\"\nfile = \"{file}\"\n");
    let blob = folder.read("quick.gridel");
    for (input, words) in [
        (
            b"".to_vec(),
            &["<stdin>: the content is of no scene format", ".toml, .obj"][..],
        ),
        (
            b"v 0 0 0\nv 1 a 0\nf 1 1 1\n".to_vec(),
            &["<stdin>:2: the y coordinate"],
        ),
        (
            import("../out.obj").into_bytes(),
            &["<stdin>:3", "outside", "--allow-outside"],
        ),
        (
            import("none.obj").into_bytes(),
            &["<stdin>:3", "none.obj cannot be read"],
        ),
        (blob[..blob.len() - 1].to_vec(), &["<stdin>: "]),
    ] {
        let (run, bytes) = folder.piped(&["inspect", "-"], &input);
        assert_eq!((run.code, bytes.len()), (Some(1), 0), "{}", run.stderr);
        for word in words {
            assert!(run.said().contains(word), "no {word:?} in {}", run.said());
        }
    }
    // What a scene from there names lies in the current folder.
    done(&folder, &["inspect", "-"], import("near.obj").as_bytes());
    let (run, _) = folder.piped(&["render", "-", "-o", "-", "--lattice-bits", "16"], &blob);
    assert_eq!(run.code, Some(2));
    assert!(run.said().contains("<stdin> is a blob"), "{}", run.stderr);
}

/// `script` runs a command in a terminal of its own.
#[cfg(target_os = "linux")]
#[test]
fn terminals_are_neither_read_nor_sent_binary_bytes() {
    let folder = Folder::with_quick();
    for (arguments, words) in [
        ("build quick.toml -o -", "standard output is a terminal"),
        ("render quick.gridel -o -", "standard output is a terminal"),
        ("inspect -", "standard input is a terminal"),
    ] {
        let command = format!("{} {arguments}", env!("CARGO_BIN_EXE_gridel"));
        let mut script = std::process::Command::new("script");
        script.args(["-qec", &command, "/dev/null"]);
        let output = script.current_dir(folder.path("")).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(text.contains(words), "{text}");
    }
}
