//! The commands of README.md work as they stand there, one after the other, in an empty folder.

use crate::program::Folder;
use std::path::Path;

/// The first block of a language behind a heading.
fn block(page: &str, heading: &str, language: &str) -> String {
    let (_, section) = page.split_once(heading).unwrap();
    let (_, block) = section.split_once(&format!("```{language}\n")).unwrap();
    block.split_once("```").unwrap().0.to_owned()
}

/// Runs the lines of a block, which are commands of the program and comments.
fn run(folder: &Folder, block: &str) -> usize {
    let lines = block.lines().map(|line| line.split('#').next().unwrap());
    let commands: Vec<Vec<&str>> = lines
        .map(|line| line.split_whitespace().collect())
        .collect();
    for command in &commands {
        assert_eq!(command[0], "gridel");
        folder.done(&command[1..]);
    }
    commands.len()
}

#[test]
fn readme_commands_work_line_by_line() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let page = std::fs::read_to_string(root.join("README.md")).unwrap();
    let folder = Folder::new();
    let heading = "## In 60 seconds";
    assert!(run(&folder, &block(&page, heading, "sh")) >= 5);
    folder.write("check.toml", block(&page, heading, "toml").as_bytes());
    assert!(page.contains("`gridel check check.toml --bless`"));
    folder.done(&["check", "check.toml", "--bless"]);
    folder.done(&["check", "check.toml"]);
}

#[test]
fn page_of_the_package_has_commands_that_work() {
    let page = include_str!("../../README.md");
    let (_, commands) = page.split_once("cargo install gridel-host\n").unwrap();
    let commands = commands.split_once("```").unwrap().0;
    assert!(run(&Folder::new(), commands) >= 4);
}
