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
        first.stdout.contains("2 passed, 3 failed, 0 skipped"),
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

    let recorded = folder.done(&["check", "check.toml", "--bless"]);
    assert!(
        recorded.contains("2 passed, 3 recorded, 0 failed, 0 skipped")
            && !recorded.contains("FAILED"),
        "{recorded}"
    );
    for line in [
        "\n-hash = {}   # a line to keep\n",
        "\n+hash = { fixed = \"",
    ] {
        assert!(recorded.contains(line), "{recorded}");
    }
    let text = String::from_utf8(folder.read("check.toml")).unwrap();
    assert!(text.contains("   # a line to keep\n"), "{text}");
    assert!(text.contains("working_bytes = 1000"), "{text}");

    let report = folder.json(&["check", "check.toml"]);
    assert_eq!(report["passed"], 5);
    assert_eq!(report["failed"], 0);
    let finding = &report["findings"][0];
    assert_eq!(finding["check"], "quick");
    assert_eq!(finding["what"], "blob_bytes");
    assert_eq!(finding["outcome"], "passed");
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
    assert_eq!(report["failed"], 2, "{report}");
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
        &["× missing.toml cannot be read: "],
    );
    std::fs::create_dir(folder.path("sub")).unwrap();
    let words = ["× sub cannot be read: it is not a file"];
    folder.fails(1, &["check", "sub"], &words);
    let words = ["`-` is standard input", "a manifest is read from a file"];
    folder.fails(2, &["check", "-"], &words);
    folder.fails(
        2,
        &["check", "check.toml", "--junit", "check.toml"],
        &["would be lost"],
    );
    folder.write("typo.toml", b"[[check]]\nsceen = 'a'");
    folder.write("empty.toml", b"");
    folder.fails(1, &["check", "empty.toml"], &["`[[check]]`"]);
    folder.write("idle.toml", b"[[check]]\nscene = 'quick.toml'");
    folder.fails(
        1,
        &["check", "idle.toml"],
        &["tests nothing", "`certified`", "`max_proved_error`"],
    );
    let words = ["typo.toml:2", "no key `sceen`", "did you mean `scene`?"];
    folder.fails(1, &["check", "typo.toml", "--bless"], &words);
}

/// The importer's warnings are printed here too.
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

/// The compiler's warnings are those of `build`.
#[test]
fn warnings_of_the_compiler_are_passed_on() {
    let folder = Folder::new();
    let scene = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n\
        [[object]]\nname = 'wall'\nkind = 'plane'\npoint = [0, 0, 0]\nnormal = [1, 0, 0]\n";
    folder.write("in.toml", scene.as_bytes());
    let check =
        "[[check]]\nscene = \"in.toml\"\nsize = [4, 4]\nbudget = { blob_bytes = 1_000_000 }\n";
    folder.write("check.toml", check.as_bytes());
    for command in [
        &["check", "check.toml"][..],
        &["build", "in.toml", "-o", "in.gridel"],
    ] {
        let run = folder.run(command);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let times = run.said().matches("lies in the plane wall").count();
        assert_eq!(times, 1, "{}", run.stderr);
    }
}

/// A board that cannot run is skipped, and fails where boards are required.
#[test]
fn boards_that_are_missing_are_named() {
    let folder = folder();
    let manifest = "[[check]]\nscene = \"quick.gridel\"\n[[check.board]]\nmachine = \"m\"\n\
                    emulator = \"no-such-emulator\"\nelf = \"e\"\nbudget = { loops = 1 }";
    folder.write("check.toml", manifest.as_bytes());
    let run = folder.run(&["check", "check.toml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        run.stderr.contains("skipped 1 figure on boards"),
        "{}",
        run.stderr
    );
    assert!(
        run.stdout.contains("no-such-emulator is not installed"),
        "{}",
        run.stdout
    );
    let run = folder.run(&["check", "check.toml", "--require-boards"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
}

/// Files that the manifest reads are never overwritten, by whatever path they are reached.
#[test]
fn files_that_are_read_stay() {
    let folder = folder();
    folder.write("program.elf", b"\x7fELF");
    folder.write("quick-f32.png", b"a picture");
    std::fs::create_dir(folder.path("sub")).unwrap();
    let manifest = "[[check]]\nscene = \"quick.toml\"\nreference = \"quick-f32.png\"\n\
                    [[check]]\nname = \"blob\"\nscene = \"quick.gridel\"\n\
                    reference = \"sub/blob-f32.png\"\n\
                    [[check.board]]\nmachine = \"m\"\nelf = \"program.elf\"\nbudget = { loops = 1 }\n";
    folder.write("check.toml", manifest.as_bytes());
    let read = [
        "check.toml",
        "quick.toml",
        "quick.gridel",
        "program.elf",
        "quick-f32.png",
        // To be recorded.
        "blob-f32.png",
    ];
    for name in read {
        let path = match name {
            "blob-f32.png" => format!("./sub/{name}"),
            _ => format!("sub/../{name}"),
        };
        let words = ["is a file that the checks read", "another name"];
        folder.fails(2, &["check", "check.toml", "--junit", &path], &words);
    }
    for shown in [".", "sub"] {
        let words = ["-f32.png is a file that the checks read", "another name"];
        folder.fails(2, &["check", "check.toml", "--diff", shown], &words);
    }
    assert!(!folder.path("sub/blob-f32.png").exists());
}

/// Recording makes a reference or replaces a picture, and destroys nothing else.
#[test]
fn only_pictures_become_references() {
    let folder = folder();
    let check = |reference: &str| {
        format!(
            "[[check]]\nscene = \"quick.toml\"\nsize = [4, 4]\nreference = \"{reference}\"\n\
             [[check]]\nname = \"blob\"\nscene = \"quick.gridel\"\nbudget = {{ blob_bytes = 1_000_000 }}\n"
        )
    };
    for name in ["check.toml", "quick.toml", "quick.gridel"] {
        folder.write("check.toml", check(name).as_bytes());
        folder.fails(
            1,
            &["check", "check.toml", "--bless"],
            &["check.toml:4", "would be written over it", "another name"],
        );
    }
    folder.write("notes.png", b"to be kept");
    folder.write("check.toml", check("notes.png").as_bytes());
    let run = folder.run(&["check", "check.toml", "--bless"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for word in [
        "check.toml:4: notes.png cannot be read",
        "write the path of an RGB or gray PNG",
        "0 recorded, 1 failed",
    ] {
        assert!(run.stdout.contains(word), "{}", run.stdout);
    }
    assert!(run.stderr.contains("quick: reference cannot be recorded"));
    assert_eq!(folder.read("notes.png"), b"to be kept");

    folder.write("check.toml", check("new.png").as_bytes());
    let run = folder.run(&["check", "check.toml"]);
    for word in ["check.toml:4: new.png cannot be read", "check --bless"] {
        assert!(run.stdout.contains(word), "{}", run.stdout);
    }
    folder.done(&["check", "check.toml", "--bless"]);
    // A picture of another size is one, too.
    folder.write(
        "check.toml",
        check("new.png").replace("[4, 4]", "[5, 4]").as_bytes(),
    );
    folder.run(&["check", "check.toml", "--bless"]);
    folder.done(&["check", "check.toml"]);
}

/// Names that would be equal as those of files get a number.
#[test]
fn every_broken_picture_is_shown() {
    let folder = folder();
    let check = |name: &str, size: &str| {
        format!(
            "[[check]]\nname = \"{name}\"\nscene = \"quick.toml\"\nsize = {size}\nhash = {{}}\n"
        )
    };
    let manifest = check("a/b", "[4, 4]") + &check("a b", "[5, 4]");
    folder.write("check.toml", manifest.as_bytes());
    let run = folder.run(&["check", "check.toml", "--diff", "shown"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    let [first, second] = ["shown/a-b-f32.png", "shown/a-b-f32-2.png"].map(|it| folder.read(it));
    assert_ne!(first, second);
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

/// Outputs that cannot be written are reported before any work, or else after the findings.
#[test]
fn findings_are_not_lost_with_a_report() {
    let folder = folder();
    let bless = ["check", "check.toml", "--bless"];
    folder.fails(
        1,
        &[&bless[..], &["--junit", "nodir/x.xml"]].concat(),
        &["nodir/x.xml cannot be written", "create the folder first"],
    );
    folder.fails(
        1,
        &[&bless[..], &["--diff", "quick.toml"]].concat(),
        &["quick.toml cannot be written", "name a folder"],
    );
    // A folder where the picture belongs.
    std::fs::create_dir_all(folder.path("shown/quick-f32.png")).unwrap();
    let run = folder.run(&[&bless[..], &["--diff", "shown", "--junit", "x.xml"]].concat());
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stderr.contains("quick-f32.png"), "{}", run.stderr);
    for word in ["2 passed, 3 recorded, 0 failed", "\n+hash = { fixed = \""] {
        assert!(run.stdout.contains(word), "{}", run.stdout);
    }
    assert!(folder.path("x.xml").is_file());
    folder.done(&["check", "check.toml"]);
}

/// A reference without a folder stays a failure; all else is recorded.
#[test]
fn a_reference_needs_a_folder() {
    let folder = folder();
    let manifest = format!("{MANIFEST}reference = \"nodir/quick.png\"\n");
    folder.write("check.toml", manifest.as_bytes());
    let run = folder.run(&["check", "check.toml", "--bless"]);
    assert_eq!(run.code, Some(1));
    for words in [
        "or create its folder, and let `gridel check --bless` record",
        "2 passed, 3 recorded, 2 failed",
    ] {
        assert!(run.stdout.contains(words), "{}", run.stdout);
    }
    assert!(folder.read("check.toml") != manifest.as_bytes());
    std::fs::create_dir(folder.path("nodir")).unwrap();
    folder.done(&["check", "check.toml", "--bless"]);
    folder.done(&["check", "check.toml"]);
}

/// Where a file cannot be written, nothing is recorded.
#[test]
#[cfg(target_os = "linux")]
fn all_is_recorded_or_nothing() {
    let folder = folder();
    let manifest = format!("{MANIFEST}reference = \"/proc/quick.png\"\n");
    folder.write("check.toml", manifest.as_bytes());
    let run = folder.run(&["check", "check.toml", "--bless"]);
    assert_eq!(run.code, Some(1));
    assert!(run.stderr.contains("/proc/quick.png"), "{}", run.stderr);
    assert!(
        run.stdout.contains("2 passed, 0 recorded, 5 failed"),
        "{}",
        run.stdout
    );
    assert_eq!(folder.read("check.toml"), manifest.as_bytes());
}

/// A fault of a file is reported where the manifest names it.
#[test]
fn files_that_are_missing_have_a_place_and_a_remedy() {
    let folder = folder();
    // A program that is everywhere, in place of the emulator.
    let manifest = r#"
[[check]]
scene = "nope.toml"
hash = {}
[[check]]
scene = "quick.gridel"
[[check.board]]
machine = "m"
emulator = "cargo"
elf = "quick.toml"
budget = { loops = 1 }
[[check.board]]
machine = "n"
emulator = "cargo"
firmware = "firmwarex"
program = "p"
target = "t"
budget = { loops = 1 }
"#;
    folder.write("check.toml", manifest.as_bytes());
    let run = folder.run(&["check", "check.toml"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for word in [
        "nope: check.toml:3: nope.toml cannot be read: ",
        "; write the path of a scene file or of a blob",
        "quick on m: check.toml:10: quick.toml is not an ELF file",
        "; write the path of the program",
        "quick on n: check.toml:15: firmwarex is not a folder",
        "; write the path of a Cargo package's folder",
    ] {
        assert!(run.stdout.contains(word), "no {word:?} in {}", run.stdout);
    }
    folder.write("none.toml", b"check = []");
    folder.fails(
        1,
        &["check", "none.toml"],
        &["has no `[[check]]`", "add a line"],
    );
    folder.write("folder.toml", b"[[check]]\nscene = '.'\nhash = {}");
    folder.fails(
        1,
        &["check", "folder.toml"],
        &["folder.toml:2", "is a folder, and no scene"],
    );
}

#[test]
fn reports_for_programs_do_not_share_standard_output() {
    let folder = folder();
    let run = folder.run(&["check", "check.toml", "--json", "--junit", "-"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{run:?}");
    assert!(
        run.said().contains("cannot both go to standard output"),
        "{run:?}"
    );
}

#[test]
fn xml_on_standard_output_is_alone_there() {
    let folder = folder();
    let run = folder.run(&["check", "check.toml", "--junit", "-"]);
    assert!(run.stdout.starts_with("<?xml"), "{run:?}");
    assert!(run.stdout.trim_end().ends_with("</testsuites>"), "{run:?}");
    assert!(run.stderr.contains("3 failed"), "{run:?}");
}

#[test]
fn manifests_with_a_byte_order_mark_are_recorded_and_keep_it() {
    for ends in ["\n", "\r\n"] {
        let folder = folder();
        let manifest = format!("\u{feff}{}", MANIFEST.replace('\n', ends));
        folder.write("check.toml", manifest.as_bytes());
        folder.done(&["check", "check.toml", "--bless"]);
        let recorded = String::from_utf8(folder.read("check.toml")).unwrap();
        let text = recorded.strip_prefix('\u{feff}').unwrap();
        assert!(!text.contains('\u{feff}') && recorded != manifest);
        assert_eq!(
            text.matches("\r\n").count(),
            manifest.matches("\r\n").count()
        );
        folder.done(&["check", "check.toml"]);
    }
}

/// One check that cannot run leaves the others.
#[test]
fn sizes_beyond_memory_fail_one_check() {
    let folder = folder();
    let hostile = "[[check]]\nname = 'large'\nscene = 'quick.toml'\nsize = [65535, 65535]\nhash = {}\n\
        [[check]]\nname = 'blob'\nscene = 'quick.gridel'\nallow_outside = true\nhash = {}\n";
    let manifest = format!("{MANIFEST}\n{hostile}");
    folder.write("check.toml", manifest.as_bytes());
    let run = folder.run(&["check", "check.toml"]);
    assert_eq!(run.code, Some(1), "{run:?}");
    for words in [
        "4,294,836,225 pixels exceed",
        "choose a smaller `size`",
        "`allow_outside` is for scene files",
    ] {
        assert!(run.stdout.contains(words), "{words}: {run:?}");
    }
    assert!(run.stdout.contains("skipped\n"), "{run:?}");
}
