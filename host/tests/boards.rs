//! Tests on emulated boards: `core/BOARDS.md`, done as it says (its files written, its commands run,
//! its output compared), and `gridel check` with the project's firmware. Ignored where the emulator or
//! the target is missing, unless `GRIDEL_REQUIRE_BOARDS` is 1.

#[allow(dead_code)]
#[path = "cli/program.rs"]
mod program;

use libtest_mimic::{Arguments, Failed, Trial};
use program::Folder;
use serde_json::Value;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A fenced block: its language, the rest of its first line, and its lines.
struct Block<'p> {
    language: &'p str,
    name: &'p str,
    content: &'p str,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let fenced = page.split("```").skip(1).step_by(2);
    fenced
        .map(|block| {
            let (first, content) = block.split_once('\n').expect("a line with the language");
            let (language, name) = first.split_once(' ').unwrap_or((first, ""));
            Block {
                language,
                name,
                content,
            }
        })
        .collect()
}

fn repository() -> PathBuf {
    let host = Path::new(env!("CARGO_MANIFEST_DIR"));
    host.parent()
        .expect("the package lies in the repository")
        .to_owned()
}

/// Returns whether the emulator and the target are there.
fn is_available() -> bool {
    let emulator = Command::new("qemu-system-arm").arg("--version").output();
    let library = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", TARGET])
        .output();
    let library = library.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    emulator.is_ok() && library.is_ok_and(|path| Path::new(&path).exists())
}

/// The target of the page's board.
const TARGET: &str = "thumbv7em-none-eabihf";

fn main() {
    // The page's shell commands are those of Unix.
    let mut trials = Vec::new();
    if cfg!(unix) {
        trials.push(Trial::test("the_pages_commands_for_the_host_work", || {
            the_page_works(false);
            Ok(())
        }));
        trials.push(on_a_board("the_page_works_as_it_stands", || {
            the_page_works(true);
        }));
    }
    trials.push(on_a_board(
        "check_builds_and_runs_firmware",
        check_builds_and_runs_firmware,
    ));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// A test that is ignored where no board can be emulated, or fails there where boards are required.
fn on_a_board(name: &str, test: fn()) -> Trial {
    let is_missing = !is_available();
    let required = env::var_os("GRIDEL_REQUIRE_BOARDS").is_some_and(|value| value == "1");
    let needs = format!("needs qemu-system-arm and {TARGET}");
    let kind = if is_missing { &*needs } else { "" }.to_owned();
    let trial = Trial::test(name, move || {
        if is_missing {
            return Err(Failed::from(needs));
        }
        test();
        Ok(())
    });
    trial
        .with_kind(kind)
        .with_ignored_flag(is_missing && !required)
}

/// The project's own firmware, on an emulated board.
fn check_builds_and_runs_firmware() {
    let folder = Folder::with_quick();
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
target = "{TARGET}"
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
        .expect("the program runs");
    let report: Value = serde_json::from_slice(&output.stdout).expect("a report");
    assert_eq!(report["not_run"], 0, "{report:#}");
    // Loading takes more than one instruction; all else is as it should be.
    let outcomes = report["findings"].as_array().expect("findings").iter();
    let broken: Vec<_> = outcomes.filter(|it| it["outcome"] != "passed").collect();
    assert_eq!(broken.len(), 1, "{report:#}");
    assert_eq!(broken[0]["what"], "load-instructions");
    assert!(broken[0]["found"].as_u64() > Some(1000), "{report:#}");
    assert_eq!(output.status.code(), Some(1));
}

/// Does what the page says; with `firmware`, what needs a board, too.
fn the_page_works(firmware: bool) {
    let page = fs::read_to_string(repository().join("core/BOARDS.md")).expect("the page");
    let folder = tempfile::tempdir().expect("a folder");
    #[cfg(unix)]
    std::os::unix::fs::symlink(repository(), folder.path().join("gridel")).expect("a link");
    let program = Path::new(env!("CARGO_BIN_EXE_gridel"));
    let mut path = vec![program.parent().expect("a folder").to_owned()];
    path.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
    let path = env::join_paths(path).expect("a search path");
    let (mut ran, mut output) = (0, String::new());
    for Block {
        language,
        name,
        content,
    } in blocks(&page)
    {
        match (language, name) {
            // What is there already, in a test.
            ("sh", "setup") => {}
            ("sh", _) if !firmware && content.contains("cargo") => {}
            ("sh", _) => {
                let mut shell = Command::new("bash");
                shell
                    .args(["-euo", "pipefail", "-c", content])
                    .current_dir(folder.path());
                for (variable, _) in env::vars_os() {
                    let name = variable.to_string_lossy();
                    if name.ends_with("RUSTFLAGS") || name == "CARGO_BUILD_TARGET" {
                        shell.env_remove(&variable);
                    }
                }
                shell.env("PATH", &path);
                let target = concat!(env!("CARGO_TARGET_TMPDIR"), "/boards-page");
                let result = shell
                    .env("CARGO_TARGET_DIR", target)
                    .output()
                    .expect("a shell");
                let said = String::from_utf8_lossy(&result.stderr);
                assert!(result.status.success(), "{content}{said}");
                output = String::from_utf8_lossy(&result.stdout).into_owned() + &said;
                ran += 1;
            }
            ("text", "output") => {
                let lines = |text: &str| -> Vec<String> {
                    let lines = text.lines().map(|line| line.trim_end().to_owned());
                    lines.filter(|line| !line.is_empty()).collect()
                };
                let (printed, shown) = (lines(&output), lines(content));
                if firmware {
                    // Cargo reports what it builds, too.
                    let found = printed.windows(shown.len()).any(|lines| lines == shown);
                    assert!(shown.len() > 10 && found, "{output}");
                }
            }
            // The core's documentation compiles and runs it.
            ("rust", "example") => {}
            _ => {
                assert!(!name.is_empty(), "a block without a name: {content}");
                let file = folder.path().join(name);
                fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
                fs::write(file, content).expect("a file");
            }
        }
    }
    assert!(ran >= if firmware { 3 } else { 2 }, "{ran} blocks were run");
    // What the page's table says of the blob.
    let inspected = Command::new(program)
        .args(["inspect", "lamp.gridel"])
        .current_dir(folder.path())
        .output()
        .expect("the program runs");
    let inspected = String::from_utf8_lossy(&inspected.stdout).into_owned();
    let line = |start: &str| {
        let mut lines = inspected.lines();
        let found = lines
            .find(|line| line.starts_with(start))
            .unwrap_or_else(|| panic!("{inspected}"));
        found
            .split_whitespace()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(line("stack depth").last().map(String::as_str), Some("1"));
    assert_eq!(
        line("32-bit board           f32")
            .last()
            .map(String::as_str),
        Some("20")
    );
}
