//! Boards in an emulator, with a program in place of it.

use super::*;
use std::os::unix::fs::PermissionsExt;

/// A program in place of the emulator.
fn emulator(folder: &Folder, script: &str) -> String {
    let path = folder.path("emulator");
    fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(&path, PermissionsExt::from_mode(0o755)).unwrap();
    path.display().to_string()
}

fn board(emulator: &str, rest: &str) -> String {
    format!(
        "[[check]]\nscene = \"ball.toml\"\n[[check.board]]\nmachine = \"toy\"\n\
         emulator = \"{emulator}\"\nelf = \"program.elf\"\n{rest}\n"
    )
}

#[test]
fn figures_are_held_and_recorded() {
    let folder = Folder::new();
    fs::write(folder.path("program.elf"), "\x7fELF").unwrap();
    let toy = emulator(
        &folder,
        "echo noise; echo loops 12; echo bytes 500; printf abc >p",
    );
    let text = board(
        &toy,
        "budget = { loops = 12, bytes = 400, lost = 1 } # all\npicture = \"p\"",
    );
    let (manifest, report) = folder.run(&text);
    assert_eq!(
        (report.passed(), report.failed(), report.not_run()),
        (1, 3, 0)
    );
    let whys: Vec<_> = report.findings.iter().map(why).collect();
    assert!(
        whys[0].contains("bytes is 500, and at most 400"),
        "{whys:?}"
    );
    assert!(
        whys[2].contains("does not print the figure \"lost\""),
        "{whys:?}"
    );
    assert!(
        whys[3].contains("has 3 bytes and the host's 576"),
        "{whys:?}"
    );
    let recorded = record(&manifest, &report);
    assert_eq!(recorded.left, ["ball: lost", "ball: picture"]);
    keep(&recorded);
    let recorded = "budget = { loops = 12, bytes = 500, lost = 1 } # all";
    assert!(folder.text().contains(recorded), "{}", folder.text());
}

#[test]
fn figures_that_are_no_whole_numbers_are_shown() {
    let folder = Folder::new();
    fs::write(folder.path("program.elf"), "\x7fELF").unwrap();
    let toy = emulator(
        &folder,
        "echo a 18446744073709551616; echo b -1; echo loops are counted; echo loops 12",
    );
    let text = board(&toy, "budget = { a = 1, b = 1, loops = 12 }");
    let (_, report) = folder.run(&text);
    let whys: Vec<_> = report.findings.iter().map(why).collect();
    for (why, text) in whys.iter().zip([
        "\"18446744073709551616\" as the figure \"a\"",
        "\"-1\" as the figure \"b\"",
    ]) {
        assert!(why.contains(text), "{whys:?}");
    }
    assert_eq!((report.passed(), report.failed()), (1, 2), "{whys:?}");
}

#[test]
fn emulators_that_never_end_are_ended() {
    let folder = Folder::new();
    fs::write(folder.path("program.elf"), "\x7fELF").unwrap();
    let toy = emulator(&folder, "while true; do sleep 0.1; done");
    let (_, report) = folder.run(&board(&toy, "budget = { loops = 1 }\nseconds = 1"));
    let why = why(&report.findings[0]);
    assert!(why.contains("has not ended after 1 s"), "{why}");
}

#[test]
fn failures_are_broken_and_what_is_missing_is_not_run() {
    let folder = Folder::new();
    let first = |text: &str| folder.run(text).1.findings.remove(0);
    let budget = "budget = { loops = 1 }\nseconds = 1";
    let toy = emulator(&folder, "echo no luck >&2; exit 3");
    let missing = first(&board(&toy, budget));
    assert!(matches!(&missing.outcome, Outcome::NotRun(why) if why.contains("program.elf")));
    fs::write(folder.path("program.elf"), "\x7fELF").unwrap();
    let missing = first(&board("no-such-emulator", budget));
    assert!(matches!(&missing.outcome, Outcome::NotRun(why) if why.contains("not installed")));
    fs::write(folder.path("program.elf"), BALL).unwrap();
    let text = first(&board(&toy, budget));
    assert!(matches!(&text.outcome, Outcome::Failed(why) if why.contains("is not an ELF file")));
    fs::write(folder.path("program.elf"), "\x7fELF").unwrap();
    let twice = emulator(&folder, "echo loops 9; echo loops 1 >&2");
    let twice = first(&board(&twice, budget));
    assert!(
        matches!(&twice.outcome, Outcome::Failed(why) if why.contains("\"loops\" twice: 9 and 1"))
    );
    // A path is the manifest's, wherever the program is called.
    emulator(&folder, "echo loops 1");
    let found = first(&board("./emulator", budget));
    assert_eq!(found.outcome, Outcome::Passed);
    let toy = emulator(&folder, "echo no luck >&2; exit 3");
    let failed = first(&board(&toy, budget));
    assert!(matches!(&failed.outcome, Outcome::Failed(why) if why.contains("no luck")));
    let toy = emulator(&folder, "exec yes");
    let loud = first(&board(&toy, "budget = { loops = 1 }\nseconds = 60"));
    let too_much = "prints more than 4,194,304 bytes";
    assert!(matches!(&loud.outcome, Outcome::Failed(why) if why.contains(too_much)));
    let toy = emulator(&folder, "exec sleep 60");
    let endless = first(&board(&toy, budget));
    assert!(matches!(&endless.outcome, Outcome::Failed(why) if why.contains("after 1 s")));
}
