//! `gridel.h` declares what the C library defines. cbindgen writes it; without cbindgen at hand, this compares both.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

fn library() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/c")
}

fn header() -> String {
    fs::read_to_string(library().join("include/gridel.h")).expect("the header")
}

/// The library's declarations, in one text.
fn source() -> String {
    let files = [
        "status", "types", "load", "camera", "cast", "render", "version",
    ];
    let read = |name: &&str| fs::read_to_string(library().join(format!("src/{name}.rs")));
    files
        .iter()
        .map(|name| read(name).expect("a file"))
        .collect()
}

/// Returns the names of a function's parameters, from the text in its parentheses.
fn parameters(list: &str, name: impl Fn(&str) -> Option<String>) -> Vec<String> {
    list.split(',').filter_map(|one| name(one.trim())).collect()
}

#[test]
fn header_declares_the_functions_of_the_library() {
    let source = source();
    let mut defined = BTreeMap::new();
    for (_, after) in source
        .match_indices("extern \"C\" fn ")
        .map(|(at, it)| (at, &source[at + it.len()..]))
    {
        let (name, rest) = after.split_once('(').expect("parameters");
        let (list, rest) = rest.split_once(')').expect("an end");
        let names = parameters(list, |one| one.split_once(':').map(|(name, _)| name.into()));
        assert!(
            rest.starts_with(" -> gridel_status")
                || ["gridel_text", "gridel_version"].contains(&name),
            "{name}"
        );
        defined.insert(String::from(name), names);
    }
    let header = header();
    let mut declared = BTreeMap::new();
    let starts = header
        .lines()
        .filter(|line| !line.starts_with([' ', '/', '#']) && line.contains("gridel_"));
    for start in starts.filter(|line| line.contains('(')) {
        let at = header.find(start).expect("a line of it");
        let (before, rest) = header[at..].split_once('(').expect("parameters");
        let (list, _) = rest.split_once(')').expect("an end");
        let name = before.rsplit([' ', '*']).next().expect("a name");
        let name_of = |one: &str| one.rsplit([' ', '*']).next().map(String::from);
        let names = parameters(list, |one| name_of(one).filter(|_| one != "void"));
        let before = declared.insert(String::from(name), names);
        assert_eq!(before, None, "{name} is declared twice");
    }
    assert_eq!(defined, declared);
    assert!(defined.len() > 15);
}

#[test]
fn header_has_the_codes_of_the_library() {
    let source = source();
    let (_, codes) = source
        .split_once("pub enum gridel_status {")
        .expect("the codes");
    let (codes, _) = codes.split_once("\n}").expect("an end");
    let header = header();
    let mut count = 0;
    for line in codes
        .lines()
        .map(str::trim)
        .filter(|line| !line.starts_with("//"))
    {
        let Some((name, value)) = line.trim_end_matches(',').split_once(" = ") else {
            continue;
        };
        let mut constant = String::from("GRIDEL_STATUS");
        for letter in name.chars() {
            if letter.is_uppercase() {
                constant.push('_');
            }
            constant.extend(letter.to_uppercase());
        }
        assert!(
            header.contains(&format!("  {constant} = {value},\n")),
            "{constant}"
        );
        assert!(
            source.contains(&format!("        {value} => c\"")),
            "{name} has no text"
        );
        count += 1;
    }
    assert_eq!(header.matches("  GRIDEL_STATUS_").count(), count);
}

#[test]
fn header_has_the_fields_of_the_library() {
    let (source, header) = (source(), header());
    let mut structs = BTreeSet::new();
    for (_, after) in source
        .match_indices("pub struct gridel_")
        .map(|(at, it)| (at, &source[at + it.len()..]))
    {
        let (name, rest) = after.split_once(" {").expect("fields");
        let (fields, _) = rest.split_once("\n}").expect("an end");
        let fields = fields
            .lines()
            .map(str::trim)
            .filter(|line| !line.starts_with("//"));
        let fields = fields.filter_map(|line| {
            let line = line
                .trim_start_matches("pub(crate) ")
                .trim_start_matches("pub ");
            let (name, kind) = line.trim_end_matches(',').split_once(": ")?;
            Some(field(name, kind))
        });
        let start = format!("typedef struct gridel_{name} {{");
        let (_, rest) = header
            .split_once(&start)
            .unwrap_or_else(|| panic!("{start}"));
        let (declared, _) = rest.split_once('}').expect("an end");
        let declared = declared.lines().map(str::trim);
        let declared = declared.filter(|line| !line.is_empty() && !line.starts_with("//"));
        assert_eq!(
            fields.collect::<Vec<_>>(),
            declared.collect::<Vec<_>>(),
            "{name}"
        );
        structs.insert(name);
    }
    assert_eq!(header.matches("typedef struct").count(), structs.len());
}

/// The stacks of a constant depth are those that the library uses.
#[test]
fn header_has_the_stacks_of_the_library() {
    let memory = fs::read_to_string(library().join("src/memory.rs")).expect("a file");
    let numbers = |text: &str| -> Vec<u32> {
        let words = text.split(|letter: char| !letter.is_ascii_digit());
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let (_, own) = memory.split_once("with_least!($depth, ").expect("a list");
    let own = numbers(own.split_once('\n').expect("an end").0);
    let header = header();
    let (_, declared) = header
        .split_once("#define GRIDEL_STACK_ENTRIES(depth)")
        .expect("a list");
    let declared = numbers(declared.split_once("\n\n").expect("an end").0);
    // The last one has no condition.
    let (last, rest) = declared.split_last().expect("a stack");
    let mut stacks = Vec::new();
    for pair in rest.chunks(2) {
        assert_eq!(pair[0], pair[1], "a depth, and the entries for it");
        stacks.push(pair[0]);
    }
    stacks.push(*last);
    assert_eq!(stacks, own);
    assert!(own.len() > 5);
}

/// A field as C declares it.
fn field(name: &str, kind: &str) -> String {
    let array = kind.strip_prefix('[').and_then(|it| it.strip_suffix(']'));
    if let Some((kind, count)) = array.and_then(|it| it.split_once("; ")) {
        return field(&format!("{name}[{count}]"), kind);
    }
    let kind = match kind {
        "i32" => "int32_t ",
        "i64" => "int64_t ",
        "u16" => "uint16_t ",
        "u32" => "uint32_t ",
        "u64" => "uint64_t ",
        "f32" => "float ",
        "f64" => "double ",
        "usize" => "size_t ",
        "*mut c_void" => "void *",
        other => panic!("{other} is not known here"),
    };
    format!("{kind}{name};")
}
