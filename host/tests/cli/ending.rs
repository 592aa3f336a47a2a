//! How the program ends: exit codes, closed pipes, full devices, interrupts.

use crate::program::Folder;
use std::process::Stdio;

const COMMANDS: [&str; 5] = ["build", "inspect", "render", "trace", "sample"];

#[test]
fn help_lists_the_exit_codes() {
    let folder = Folder::new();
    let help = folder.done(&["--help"]);
    for command in COMMANDS {
        assert!(help.contains(&format!("\n  {command}")), "{help}");
        let help = folder.done(&[command, "--help"]);
        assert!(help.contains("3    the scene does not fit"), "{help}");
    }
    assert!(folder.done(&["--version"]).starts_with("gridel "));
}

#[test]
fn a_wrong_command_line_is_2() {
    let folder = Folder::new();
    folder.fails(2, &[], &["Usage: gridel"]);
    folder.fails(2, &["bild"], &["build"]);
    for command in &COMMANDS[..4] {
        folder.fails(2, &[command], &["required"]);
        folder.fails(2, &[command, "--nonsense"], &["--nonsense"]);
    }
}

/// A reader that has seen enough is no error, and nothing is said about it.
#[test]
fn a_closed_pipe_is_quiet() {
    let folder = Folder::with_quick();
    for arguments in [
        &["inspect", "quick.gridel"][..],
        &["inspect", "quick.gridel", "--json"],
        &["build", "quick.toml", "-o", "a.gridel"],
        &["sample"],
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = folder.command(arguments).stdout(writer).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(output.stderr.is_empty(), "{output:?}");
    }
    assert!(folder.path("a.gridel").is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn a_report_that_cannot_be_written_is_an_error() {
    let folder = Folder::with_quick();
    let full = std::fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let mut command = folder.command(&["build", "quick.toml", "-o", "a.gridel"]);
    let output = command.stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(!output.stderr.is_empty());
    assert!(folder.path("a.gridel").is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn a_version_or_help_that_cannot_be_written_is_an_error() {
    let folder = Folder::new();
    for arguments in [&["--version"][..], &["--help"], &["build", "--help"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full");
        let mut command = folder.command(arguments);
        let output = command.stdout(full.unwrap()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(
            message.contains("standard output cannot be written"),
            "{message}"
        );
    }
}

/// The program under a limit of the shell's.
#[cfg(target_os = "linux")]
fn limited(folder: &Folder, limit: &str, arguments: &[&str]) -> std::process::Output {
    let program = folder.command(&[]).get_program().to_owned();
    let script = format!("ulimit {limit} && exec \"$@\"");
    let mut shell = std::process::Command::new("sh");
    shell
        .args(["-c", &script, "sh"])
        .arg(program)
        .args(arguments);
    shell.current_dir(folder.path("")).output().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn too_little_memory_is_an_error() {
    let folder = Folder::with_quick();
    let cube = [
        "--accel",
        "cylinder-cube",
        "--gridels",
        "64",
        "--budget",
        "100G",
    ];
    let build = [&["build", "quick.toml", "-o", "a.gridel"][..], &cube].concat();
    let names = folder.names();
    let output = limited(&folder, "-v 1000000", &build);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.contains("there is not enough memory: "),
        "{message}"
    );
    assert!(message.contains("help: "), "{message}");
    assert_eq!(folder.names(), names);
}

#[cfg(target_os = "linux")]
#[test]
fn too_small_a_limit_of_files_is_an_error() {
    let folder = Folder::with_quick();
    folder.write("a.png", b"old");
    let names = folder.names();
    let render = ["render", "quick.toml", "-o", "a.png", "--size", "400x400"];
    let output = limited(&folder, "-f 4", &render);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("a.png cannot be written"), "{message}");
    assert_eq!(folder.read("a.png"), b"old");
    assert_eq!(folder.names(), names);
}

#[test]
fn control_characters_of_names_are_escaped() {
    let folder = Folder::new();
    let scene = "[[object]]\nkind = 'import'\nfile = \"\\u001b[31mX.obj\"\n";
    folder.write("a.toml", scene.as_bytes());
    folder.fails(
        1,
        &["inspect", "a.toml"],
        &["\\u{1b}[31mX.obj cannot be read"],
    );
    folder.fails(
        1,
        &["inspect", "\u{1b}[31m.toml"],
        &["\\u{1b}[31m.toml cannot be read"],
    );
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_the_old_file_and_nothing_else() {
    let folder = Folder::with_quick();
    folder.write("a.png", b"old");
    let names = folder.names();
    // More than a minute's work.
    let slow = [
        "render",
        "quick.toml",
        "-o",
        "a.png",
        "--size",
        "8000x8000",
        "--samples",
        "64",
    ];
    let mut command = folder.command(&slow);
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(1));
    let kill = format!("kill -INT {}", child.id());
    let sent = std::process::Command::new("sh")
        .args(["-c", &kill])
        .status();
    assert!(sent.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(folder.read("a.png"), b"old");
    assert_eq!(folder.names(), names);
}

/// Writes a manifest whose emulator is a script, and a blob for it.
#[cfg(unix)]
fn with_emulator(script: &str, seconds: u32) -> Folder {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::with_quick();
    folder.write("emulator", format!("#!/bin/sh\n{script}\n").as_bytes());
    let executable = PermissionsExt::from_mode(0o755);
    std::fs::set_permissions(folder.path("emulator"), executable).unwrap();
    folder.write("program.elf", b"\x7fELF");
    let manifest = format!(
        "[[check]]\nscene = \"quick.gridel\"\n[[check.board]]\nmachine = \"m\"\n\
         emulator = \"./emulator\"\nelf = \"program.elf\"\nbudget = {{ loops = 1 }}\n\
         seconds = {seconds}\n"
    );
    folder.write("check.toml", manifest.as_bytes());
    folder
}

/// A part of a script: a child that writes a letter to `$ALIVE` again and again, for half a minute.
#[cfg(unix)]
const CHILD: &str =
    "i=0; while [ $i -lt 600 ]; do echo a >>\"$ALIVE\"; i=$((i+1)); sleep 0.05; done & ";

/// Asserts that nothing writes to `$ALIVE` any longer.
#[cfg(unix)]
fn assert_dead(folder: &Folder, context: &str) {
    let written = || std::fs::metadata(folder.path("alive")).map_or(0, |it| it.len());
    let pause = || std::thread::sleep(std::time::Duration::from_millis(300));
    pause();
    let before = written();
    pause();
    assert_eq!(written(), before, "{context}");
}

#[cfg(unix)]
#[test]
fn nothing_that_an_emulator_started_runs_after_the_check() {
    for (rest, code, words) in [
        ("echo loops 1", 0, "1 passed"),
        ("wait", 1, "has not ended after 1 s"),
        ("yes a & wait", 1, "prints more than 4,194,304 bytes"),
    ] {
        let folder = with_emulator(&format!("{CHILD}{rest}"), 1);
        let mut command = folder.command(&["check", "check.toml"]);
        let output = command.env("ALIVE", folder.path("alive")).output();
        let output = output.unwrap();
        let printed = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(code), "{rest}: {printed}");
        assert!(printed.contains(words), "{rest}: {printed}");
        assert_dead(&folder, rest);
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_the_emulator_and_what_it_started() {
    let script = format!(
        "if [ \"$1\" = --version ]; then exit 0; fi\n{CHILD}\n\
         echo $$ >\"$STARTED.new\"; mv \"$STARTED.new\" \"$STARTED\"; wait"
    );
    let folder = with_emulator(&script, 600);
    std::fs::create_dir(folder.path("temporary")).unwrap();
    let mut child = folder
        .command(&["check", "check.toml"])
        .env("STARTED", folder.path("started"))
        .env("ALIVE", folder.path("alive"))
        .env("TMPDIR", folder.path("temporary"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !folder.path("started").exists() {
        assert_eq!(child.try_wait().unwrap(), None);
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let emulator = String::from_utf8(folder.read("started")).unwrap();
    let sh = |line: &str| {
        let mut sh = std::process::Command::new("sh");
        sh.args(["-c", line]).stderr(Stdio::null());
        sh.status().unwrap().success()
    };
    assert!(sh(&format!("kill -0 {emulator}")));
    assert!(sh(&format!("kill -INT {}", child.id())));
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(!sh(&format!("kill -0 {emulator}")));
    assert_dead(&folder, "interrupted");
    let left = std::fs::read_dir(folder.path("temporary")).unwrap();
    assert_eq!(left.count(), 0);
}
