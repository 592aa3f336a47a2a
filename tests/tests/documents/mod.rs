//! Documents show the project as it is: examples and dumps cannot fall behind.

mod accuracy;
mod boards;
mod changelog;
mod contributing;
mod features;
mod keys;
mod limits;
mod memory;
mod modules;
mod paper;
mod peers;
mod pictures;
mod records;
mod summaries;
mod tables;
mod times;
mod variables;

use gridel_core::Structure;
use gridel_host::compile::{Options, compile};
use gridel_tests::bounds::{CROSSING, NORMAL, markdown};
use gridel_tests::scenes;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn text(path: &str) -> String {
    fs::read_to_string(repository().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The paths of all Rust sources below a folder, without those of builds.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let found = paths.flat_map(|path| match path.is_dir() {
        true if path.ends_with("target") => Vec::new(),
        true => sources(&path),
        false if path.extension().is_some_and(|it| it == "rs") => vec![path],
        false => Vec::new(),
    });
    found.collect()
}

/// The first block of a language behind a heading.
fn block<'d>(document: &'d str, heading: &str, language: &str) -> &'d str {
    let (_, section) = document.split_once(heading).expect("the heading");
    let (_, block) = section
        .split_once(&format!("```{language}\n"))
        .expect("a block");
    block.split_once("```").expect("its end").0
}

#[test]
fn readme_shows_a_part_of_the_firmware_that_is_built() {
    let readme = text("README.md");
    let shown = block(&readme, "## On a board", "rust");
    assert!(shown.lines().count() >= 10);
    assert!(text("tests/firmware/src/bin/example.rs").contains(shown));
}

#[test]
fn the_formats_dump_is_what_the_compiler_writes() {
    let heading = "## Example: the bytes of a blob";
    let format = text("core/FORMAT.md");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("documents");
    fs::create_dir_all(&folder).expect("the target folder can be written to");
    let path = folder.join("sphere.toml");
    fs::write(&path, block(&format, heading, "toml")).expect("the file can be written to");
    let options = Options {
        lattice_bits: 16,
        structures: vec![Structure::Flagged],
        ..Options::default()
    };
    let compiled = compile(&scenes::read(&path), &options).expect("compiles");
    // An address, a colon, up to sixteen bytes in hexadecimal, and words about them.
    let dump = block(&format, heading, "text").lines().flat_map(|line| {
        let bytes = line.get(10..57).expect("a line of a dump");
        bytes
            .split_whitespace()
            .map(|byte| u8::from_str_radix(byte, 16).expect("a byte"))
    });
    assert!(dump.eq(compiled.blob.bytes().iter().copied()));
}

/// `GRIDEL_BLESS=1` writes the tables again.
#[test]
fn the_accuracy_page_prints_the_bounds_that_tests_hold() {
    let path = "core/ACCURACY.md";
    let mut page = text(path);
    for (name, table) in [("crossing", &CROSSING), ("normal", &NORMAL)] {
        let start = format!("<!-- {name} -->\n");
        let (before, rest) = page.split_once(&start).expect("the table's place");
        let (_, after) = rest.split_once("<!-- end -->").expect("its end");
        page = format!("{before}{start}{}<!-- end -->{after}", markdown(table));
    }
    if std::env::var_os("GRIDEL_BLESS").is_some() {
        fs::write(repository().join(path), &page).expect("the page can be written to");
    }
    assert!(
        text(path) == page,
        "{path} is behind tests/src/bounds.rs: run with GRIDEL_BLESS=1"
    );
}

/// Every hard case is listed, and every test that the list names is there.
#[test]
fn every_hard_case_has_its_test() {
    let page = text("tests/CASES.md");
    let chapters = [
        ('A', 15),
        ('B', 9),
        ('C', 8),
        ('D', 17),
        ('E', 9),
        ('F', 14),
        ('G', 7),
        ('H', 7),
    ];
    for (chapter, last) in chapters {
        for number in 1..=last {
            let row = format!("| {chapter}{number} ");
            assert_eq!(page.matches(&row).count(), 1, "{row}");
        }
    }
    for row in ["| D18 to D23 ", "| D24 ", "| D25 "] {
        assert!(page.contains(row), "{row}");
    }
    let mut tests = 0;
    for name in page.split('`').filter(|name| name.contains(".rs::")) {
        let (path, function) = name.split_once("::").expect("a file and a function");
        let source = text(path);
        assert!(source.contains(&format!("fn {function}(")), "{name}");
        tests += 1;
    }
    assert!(tests > 75, "{tests}");
    for path in page.split('`').filter(|name| name.ends_with(".rs")) {
        assert!(repository().join(path).is_file(), "{path}");
    }
}

/// Compares a generated table of a document with the measured one; `GRIDEL_BLESS=1` writes it.
fn holds_table(document: &str, mark: &str, table: &str) {
    static DOCUMENTS: Mutex<()> = Mutex::new(());
    // Tests that write it run at the same time; a failed one reports its own failure.
    let _one_at_a_time = DOCUMENTS
        .lock()
        .unwrap_or_else(|poison| poison.into_inner());
    let page = text(document);
    let mark = format!("<!-- {mark} -->\n");
    let (before, rest) = page.split_once(&mark).expect("a mark");
    let (shown, after) = rest.split_once("<!-- end -->").expect("its end");
    if std::env::var_os("GRIDEL_BLESS").is_some_and(|value| value == "1") {
        let new = format!("{before}{mark}{table}<!-- end -->{after}");
        fs::write(repository().join(document), new).expect("the document can be written to");
        return;
    }
    assert_eq!(shown, table, "{document}: GRIDEL_BLESS=1 writes the table");
}

const FORMAT: &str = "core/FORMAT.md";
const README: &str = "README.md";
const BENCHMARKS: &str = "host/docs/BENCHMARKS.md";
const MEMORY: &str = "host/docs/MEMORY.md";
const PAPER: &str = "host/docs/PAPER.md";
const STRUCTURES: &str = "host/docs/STRUCTURES.md";
