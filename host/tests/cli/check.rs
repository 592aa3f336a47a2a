use crate::program::Folder;
use serde_json::Value;

const MANIFEST: &str = r#"
[[check]]
scene = "quick.toml"
formats = ["fixed", "f32"]
size = [24, 18]
hash = {}   # a line to keep
budget = { blob_bytes = 100, working_bytes = 1000 }
"#;

fn folder() -> Folder {
    let folder = Folder::with_quick();
    folder.write("check.toml", MANIFEST.as_bytes());
    folder
}

#[test]
fn blessing_makes_checks_hold() {
    let folder = folder();
    let first = folder.run(&[
        "check",
        "check.toml",
        "--junit",
        "junit.xml",
        "--diff",
        "shown",
    ]);
    assert_eq!(first.code, Some(1), "{}", first.stderr);
    assert!(
        first.stdout.contains("2 held, 3 broken, 0 not run"),
        "{}",
        first.stdout
    );
    let reason = "quick: blob_bytes is ";
    assert!(first.stdout.contains(reason), "{}", first.stdout);
    let junit = String::from_utf8(folder.read("junit.xml")).unwrap();
    assert!(junit.contains("failures=\"3\""), "{junit}");
    // Nothing was expected yet, so only what was rendered is shown.
    let size = |name: &str| {
        let file = std::fs::File::open(folder.path(name)).unwrap();
        let decoder = png::Decoder::new(std::io::BufReader::new(file));
        let info = decoder.read_info().unwrap().info().clone();
        [info.width, info.height]
    };
    assert_eq!(size("shown/quick-fixed.png"), [24, 18]);
    assert_eq!(size("shown/quick-f32.png"), [24, 18]);
    assert_eq!(folder.read("check.toml"), MANIFEST.as_bytes());

    let blessed = folder.done(&["check", "check.toml", "--bless"]);
    assert!(
        blessed.contains("2 held, 3 recorded, 0 broken, 0 not run") && !blessed.contains("BROKEN"),
        "{blessed}"
    );
    for line in [
        "\n-hash = {}   # a line to keep\n",
        "\n+hash = { fixed = \"",
    ] {
        assert!(blessed.contains(line), "{blessed}");
    }
    let text = String::from_utf8(folder.read("check.toml")).unwrap();
    assert!(text.contains("   # a line to keep\n"), "{text}");
    assert!(text.contains("working_bytes = 1000"), "{text}");

    let report = folder.json(&["check", "check.toml"]);
    assert_eq!(report["held"], 5);
    assert_eq!(report["broken"], 0);
    let finding = &report["findings"][0];
    assert_eq!(finding["check"], "quick");
    assert_eq!(finding["what"], "blob_bytes");
    assert_eq!(finding["outcome"], "held");
    assert_eq!(finding["found"], finding["allowed"]);

    // The scene changes: JSON says why, and the exit code that something is.
    let scene = String::from_utf8(folder.read("quick.toml")).unwrap();
    let (before, after) = scene.split_once("background").unwrap();
    let (_, after) = after.split_once('\n').unwrap();
    folder.write(
        "quick.toml",
        format!("{before}background = 0.7\n{after}").as_bytes(),
    );
    let broken = folder.run(&["check", "check.toml", "--json"]);
    assert_eq!(broken.code, Some(1));
    let report: Value = serde_json::from_str(&broken.stdout).unwrap();
    assert_eq!(report["broken"], 2, "{report}");
    let hash = report["findings"]
        .as_array()
        .unwrap()
        .iter()
        .find(|it| it["what"] == "hash");
    assert_eq!(hash.unwrap()["why"], "the picture is not the recorded one");
}

#[test]
fn mistakes_are_explained() {
    let folder = folder();
    folder.fails(
        1,
        &["check", "missing.toml"],
        &["missing.toml", "cannot be read"],
    );
    folder.fails(
        2,
        &["check", "check.toml", "--junit", "check.toml"],
        &["would be lost"],
    );
    folder.write("typo.toml", b"[[check]]\nsceen = 'a'");
    folder.write("empty.toml", b"");
    folder.fails(1, &["check", "empty.toml"], &["`[[check]]`"]);
    folder.write("idle.toml", b"[[check]]\nscene = 'quick.toml'");
    folder.fails(1, &["check", "idle.toml"], &["expects nothing"]);
    let words = ["typo.toml:2", "no key `sceen`", "did you mean `scene`?"];
    folder.fails(1, &["check", "typo.toml", "--bless"], &words);
}

/// What an importer passes over is told here too.
#[test]
fn warnings_of_importers_are_passed_on() {
    let folder = Folder::new();
    folder.write(
        "one.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nmtllib lost.mtl\n",
    );
    let check = "[[check]]\nscene = \"one.obj\"\nbudget = { blob_bytes = 1_000_000 }\n";
    folder.write(
        "check.toml",
        format!("{check}{check}name = 'again'").as_bytes(),
    );
    let run = folder.run(&["check", "check.toml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert_eq!(run.stderr.matches("lost.mtl").count(), 1, "{}", run.stderr);
}

/// A board that cannot be run is said not to have been run, and fails where boards are required.
#[test]
fn boards_that_are_missing_are_named() {
    let folder = folder();
    let manifest = "[[check]]\nscene = \"quick.gridel\"\n[[check.board]]\nmachine = \"m\"\n\
                    emulator = \"no-such-emulator\"\nelf = \"e\"\nbudget = { loops = 1 }";
    folder.write("check.toml", manifest.as_bytes());
    let run = folder.run(&["check", "check.toml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stderr.contains("NOT RUN: 1"), "{}", run.stderr);
    assert!(
        run.stdout.contains("no-such-emulator is not installed"),
        "{}",
        run.stdout
    );
    let run = folder.run(&["check", "check.toml", "--require-boards"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
}

/// The project's own firmware, on an emulated board.
#[test]
fn firmware_is_built_and_run() {
    let folder = folder();
    let firmware = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/firmware");
    let manifest = format!(
        r#"
[[check]]
scene = "quick.toml"
accel = "dual-split"
size = [24, 18]
[[check.board]]
machine = "mps2-an386"
firmware = '{firmware}'
program = "picture"
target = "thumbv7em-none-eabihf"
features = ["f32", "dual-split", "everything"]
picture = "picture.rgb"
budget = {{ picture-instructions = 40_000_000, load-instructions = 1 }}
"#
    );
    folder.write("check.toml", manifest.as_bytes());
    let output = folder
        .command(&["check", "check.toml", "--json"])
        // Not among the sources.
        .env(
            "CARGO_TARGET_DIR",
            concat!(env!("CARGO_TARGET_TMPDIR"), "/firmware"),
        )
        .output()
        .unwrap();
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    if report["not_run"] != 0 {
        let required = std::env::var_os("GRIDEL_REQUIRE_BOARDS").is_some_and(|value| value == "1");
        assert!(!required, "{report:#}");
        eprintln!("SKIPPED: {}", report["findings"][0]["why"]);
        return;
    }
    // Loading takes more than one instruction; all else is as it should be.
    let outcomes = report["findings"].as_array().unwrap().iter();
    let broken: Vec<_> = outcomes.filter(|it| it["outcome"] != "held").collect();
    assert_eq!(broken.len(), 1, "{report:#}");
    assert_eq!(broken[0]["what"], "load-instructions");
    assert!(broken[0]["found"].as_u64().unwrap() > 1000);
    assert_eq!(output.status.code(), Some(1));
}

/// The exit code says what was found, whoever reads.
#[test]
fn broken_checks_fail_without_a_reader() {
    let folder = folder();
    for json in [&[][..], &["--json"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = folder.command(&[&["check", "check.toml"], json].concat());
        let output = command.stdout(writer).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        assert!(output.stderr.is_empty(), "{output:?}");
    }
}
