//! Tables of files at the heads of modules list every module.

use super::{repository, sources};
use std::fs;
use std::path::{Path, PathBuf};

/// The table of files at the head of a source; empty where there is none.
fn table(source: &str) -> Vec<&str> {
    let rows = source.lines().filter_map(|line| line.strip_prefix("//! |"));
    let mut rows = rows.skip_while(|row| !row.split('|').any(|cell| cell.trim() == "file"));
    rows.next();
    rows.collect()
}

/// The modules of other files that a source declares, without those of tests.
fn modules(source: &str) -> Vec<&str> {
    let lines = [""].into_iter().chain(source.lines());
    let declared = lines.zip(source.lines()).filter_map(|(before, line)| {
        let (visibility, name) = line.strip_suffix(';')?.split_once("mod ")?;
        let is_visible = visibility.is_empty() || visibility.starts_with("pub");
        (is_visible && before != "#[cfg(test)]").then_some(name)
    });
    declared.collect()
}

/// Names of files in backticks.
fn files<'t>(rows: &[&'t str]) -> Vec<&'t str> {
    let quoted = rows
        .iter()
        .flat_map(|row| row.split('`').skip(1).step_by(2));
    let is_file = |name: &&str| name.ends_with(".rs") || name.ends_with('/');
    quoted.filter(is_file).collect()
}

/// Returns what a table of files lacks, and what it lists that is not there.
fn faults(path: &Path, source: &str) -> Vec<String> {
    let rows = table(source);
    let files = files(&rows);
    let lacks = |name: &&str| {
        let is_own = |file: &&str| file.trim_end_matches(".rs").trim_end_matches('/') == *name;
        !rows.is_empty() && !files.iter().any(is_own)
    };
    let missing = modules(source).into_iter().filter(lacks);
    let missing = missing.map(|name| format!("{}: lacks {name}", path.display()));
    let here = path.parent().expect("a folder");
    let stale = files.iter().filter(|file| !here.join(file).exists());
    let stale = stale.map(|file| format!("{}: there is no {file}", path.display()));
    missing.chain(stale).collect()
}

#[test]
fn tables_of_files_list_every_module() {
    let mut tables = 0;
    let mut faults_of_all = Vec::new();
    // The commands have their names in the program's help.
    let commands = Path::new("host/src/cli/mod.rs");
    for folder in ["core", "host", "tests"] {
        let sources = sources(&repository().join(folder)).into_iter();
        for path in sources.filter(|path| !path.ends_with(commands)) {
            let source = fs::read_to_string(&path).expect("a source");
            tables += usize::from(!table(&source).is_empty());
            faults_of_all.extend(faults(&path, &source));
        }
    }
    assert!(faults_of_all.is_empty(), "{}", faults_of_all.join("\n"));
    assert!(tables > 10, "{tables}");
}

#[test]
fn modules_with_modules_are_in_their_folders() {
    let tops = ["core", "host", "tests"].map(|top| sources(&repository().join(top)));
    // Programs of tests have theirs by paths.
    let is_program = |path: &PathBuf| path.parent().is_some_and(|it| it.ends_with("host/tests"));
    let mut folders = 0;
    for path in tops.into_iter().flatten().filter(|path| !is_program(path)) {
        let Ok(files) = fs::read_dir(path.with_extension("")) else {
            continue;
        };
        folders += 1;
        for file in files {
            let name = file.expect("a file").file_name();
            let is_test = name == "tests.rs" || name == "tests";
            assert!(is_test, "{}: {}", path.display(), name.display());
        }
    }
    assert!(folders > 10, "{folders}");
}

#[test]
fn tables_of_files_show_what_they_lack() {
    let source = "//! | file | what |\n//! |---|---|\n//! | `gone.rs` | old |\n\nmod new;\n#[cfg(test)]\nmod tests;\n";
    let found = faults(Path::new("a/mod.rs"), source);
    assert_eq!(
        found,
        ["a/mod.rs: lacks new", "a/mod.rs: there is no gone.rs"]
    );
    assert!(faults(Path::new("a/mod.rs"), "mod new;").is_empty());
}
