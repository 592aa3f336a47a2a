//! `core/BOARDS.md`, done as it says: its files written, its commands run, its output compared.

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

/// Whether the emulator and the target are there; fails where boards are required.
fn available() -> bool {
    let emulator = Command::new("qemu-system-arm")
        .arg("--version")
        .output()
        .is_ok();
    let library = Command::new("rustc")
        .args([
            "--print",
            "target-libdir",
            "--target",
            "thumbv7em-none-eabihf",
        ])
        .output();
    let library = library.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    let target = library.is_ok_and(|path| Path::new(&path).exists());
    let required = env::var_os("GRIDEL_REQUIRE_BOARDS").is_some_and(|value| value == "1");
    assert!(emulator && target || !required, "no boards can be emulated");
    if !(emulator && target) {
        eprintln!("SKIPPED: firmware needs qemu-system-arm and the target thumbv7em-none-eabihf");
    }
    emulator && target
}

#[cfg(unix)]
#[test]
fn the_page_works_as_it_stands() {
    let page = fs::read_to_string(repository().join("core/BOARDS.md")).expect("the page");
    let folder = tempfile::tempdir().expect("a folder");
    std::os::unix::fs::symlink(repository(), folder.path().join("gridel")).expect("a link");
    let program = Path::new(env!("CARGO_BIN_EXE_gridel"));
    let mut path = vec![program.parent().expect("a folder").to_owned()];
    path.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
    let path = env::join_paths(path).expect("a search path");
    let firmware = available();
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
                    // Cargo tells of what it builds, too.
                    let found = printed.windows(shown.len()).any(|lines| lines == shown);
                    assert!(shown.len() > 10 && found, "{output}");
                }
            }
            _ => {
                assert!(!name.is_empty(), "a block without a name: {content}");
                let file = folder.path().join(name);
                fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
                fs::write(file, content).expect("a file");
            }
        }
    }
    assert!(ran >= 3, "{ran} blocks were run");
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
