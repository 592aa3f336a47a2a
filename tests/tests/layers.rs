//! Imports run one way: from a layer to those below it, and between files without a cycle.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A crate whose imports are checked: its sources, and its top modules from the lowest layer up, in rows of
/// what belongs together.
struct Layers {
    sources: &'static str,
    order: &'static [&'static str],
}

const CORE: Layers = Layers {
    sources: "../core/src",
    order: &[
        "axis target simd format observe",
        "number ray geometry accel scene query shade render selftest",
    ],
};

const HOST: Layers = Layers {
    sources: "../host/src",
    order: &[
        "output simd table blob picture_rays shape",
        "scene sample compile",
        "render trace npy picture merge resolution report",
        "measure emit",
        "accuracy compare verify explain check",
        "cli main",
    ],
};

type Module = Vec<String>;

/// One file without comments, strings and tests.
struct Source {
    file: String,
    text: String,
}

impl Source {
    fn new(file: &str, text: &str) -> Self {
        let text = blank(text);
        let end = text.find("#[cfg(test)]\nmod tests {");
        Self {
            file: file.into(),
            text: text[..end.unwrap_or(text.len())].into(),
        }
    }
}

impl Source {
    /// The modules of other files that are declared for tests.
    fn test_modules(&self) -> Vec<Module> {
        let declared = self.text.split("#[cfg(test)]").skip(1);
        let names = declared.filter_map(|rest| {
            let (name, _) = rest.trim_start().strip_prefix("mod ")?.split_once(';')?;
            name.chars()
                .all(|char| char.is_alphanumeric() || char == '_')
                .then_some(name)
        });
        let module = module(&self.file);
        names
            .map(|name| [&module[..], &[name.into()]].concat())
            .collect()
    }
}

/// The text with comments and what is in quotes as spaces; lines stay where they are.
fn blank(text: &str) -> String {
    let mut blanked = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(char) = rest.chars().next() {
        let hidden = hidden(rest);
        let length = hidden.unwrap_or(char.len_utf8());
        let (token, behind) = rest.split_at(length);
        if hidden.is_some() {
            blanked.extend(
                token
                    .chars()
                    .map(|char| if char == '\n' { '\n' } else { ' ' }),
            );
        } else {
            blanked.push_str(token);
        }
        rest = behind;
    }
    blanked
}

/// The length of the comment, the string or the quotation mark that a text begins with.
fn hidden(text: &str) -> Option<usize> {
    if text.starts_with("//") {
        return Some(text.find('\n').unwrap_or(text.len()));
    }
    if text.starts_with("'\"'") {
        return Some(3);
    }
    if let Some(raw) = text.strip_prefix('r') {
        let hashes = raw.len() - raw.trim_start_matches('#').len();
        if raw[hashes..].starts_with('"') {
            let end = format!("\"{}", &raw[..hashes]);
            let start = hashes + 2;
            let length = text[start..].find(&end).map(|at| start + at + end.len());
            return Some(length.unwrap_or(text.len()));
        }
    }
    let quoted = text.strip_prefix('"')?;
    let mut escaped = false;
    let end = quoted.find(|char| {
        let ends = char == '"' && !escaped;
        escaped = char == '\\' && !escaped;
        ends
    });
    Some(end.map_or(text.len(), |end| end + 2))
}

/// A path as code names it, the module that names it, and the line.
#[derive(Clone, Debug, PartialEq)]
struct Named {
    path: Module,
    line: usize,
    is_public: bool,
    alias: Option<String>,
}

/// All paths that a text imports or names.
fn paths(text: &str) -> Vec<Named> {
    let mut tokens: Vec<(&str, usize)> = Vec::new();
    let mut start = None;
    for (at, char) in text.char_indices().chain([(text.len(), ' ')]) {
        if char.is_alphanumeric() || char == '_' || char == '$' {
            start.get_or_insert(at);
            continue;
        }
        if let Some(start) = start.take() {
            tokens.push((&text[start..at], start));
        }
        if !char.is_whitespace() {
            tokens.push((&text[at..at + char.len_utf8()], at));
        }
    }
    let line = |at: usize| text[..at].matches('\n').count() + 1;
    let mut found = Vec::new();
    let mut index = 0;
    while index < tokens.len() {
        let (token, at) = tokens[index];
        let before = index.checked_sub(1).map(|before| tokens[before].0);
        let follows_path = before == Some(":");
        let captures = tokens.get(index + 1).is_some_and(|&(next, _)| next == "<");
        if token == "use" && !captures {
            let is_public = matches!(before, Some("pub" | ")"));
            index = import(&tokens, index + 1, &[], &mut |path, alias| {
                found.push(Named {
                    path,
                    line: line(at),
                    is_public,
                    alias,
                });
            });
            continue;
        }
        let is_name = token.starts_with(|first: char| first.is_alphabetic());
        if is_name && !follows_path && before != Some("$") {
            let mut path = vec![token.to_string()];
            while let [(":", _), (":", _), (name, _), ..] = tokens[index + 1..] {
                if !name.starts_with(|first: char| first.is_alphanumeric() || first == '_') {
                    break;
                }
                path.push(name.into());
                index += 3;
            }
            if path.len() > 1 {
                let (is_public, alias) = (false, None);
                found.push(Named {
                    path,
                    line: line(at),
                    is_public,
                    alias,
                });
            }
        }
        index += 1;
    }
    found
}

/// Reads one tree of an import from a token on; returns the token behind it.
fn import(
    tokens: &[(&str, usize)],
    mut index: usize,
    prefix: &[String],
    found: &mut dyn FnMut(Module, Option<String>),
) -> usize {
    let mut path = prefix.to_vec();
    while let Some(&(token, _)) = tokens.get(index) {
        index += 1;
        match token {
            ":" => {}
            "{" => {
                while tokens.get(index).is_some_and(|&(token, _)| token != "}") {
                    index = import(tokens, index, &path, found);
                    if tokens.get(index).is_some_and(|&(token, _)| token == ",") {
                        index += 1;
                    }
                }
                return index + 1;
            }
            "as" => {
                found(path, tokens.get(index).map(|&(name, _)| name.into()));
                return index + 1;
            }
            "," | "}" | ";" => {
                found(path, None);
                return index - 1;
            }
            "self" if !path.is_empty() => {}
            name => path.push(name.into()),
        }
    }
    index
}

/// The module of a file.
fn module(file: &str) -> Module {
    let mut module: Module = file
        .trim_end_matches(".rs")
        .split('/')
        .map(Into::into)
        .collect();
    if matches!(module.last().map(String::as_str), Some("mod" | "lib")) {
        module.pop();
    }
    module
}

/// A path from the crate's root; `None` for another crate's.
fn absolute(module: &[String], path: &[String], children: &BTreeSet<Module>) -> Option<Module> {
    let supers = path.iter().take_while(|part| *part == "super").count();
    let first = path.first().map(String::as_str)?;
    let (base, rest) = match first {
        "crate" => (&module[..0], &path[1..]),
        "self" => (module, &path[1..]),
        "super" => (
            &module[..module.len().saturating_sub(supers)],
            &path[supers..],
        ),
        _ => {
            let child = [module, &path[..1]].concat();
            if !children.contains(&child) {
                return None;
            }
            (module, path)
        }
    };
    Some([base, rest].concat())
}

/// What is wrong with the imports of some files.
fn faults(sources: &[Source], order: &[&str]) -> Vec<String> {
    let files: BTreeMap<Module, &Source> = sources
        .iter()
        .map(|source| (module(&source.file), source))
        .collect();
    let modules: BTreeSet<Module> = files.keys().cloned().collect();
    let mut passed_on: BTreeMap<Module, Module> = BTreeMap::new();
    let mut named: Vec<(Module, Module, usize)> = Vec::new();
    for (module, source) in &files {
        for Named {
            path,
            line,
            is_public,
            alias,
        } in paths(&source.text)
        {
            let Some(target) = absolute(module, &path, &modules) else {
                continue;
            };
            let name = alias.or(path.last().cloned()).unwrap_or_default();
            if is_public {
                passed_on.insert([&module[..], &[name]].concat(), target);
            } else if !module.is_empty() {
                named.push((module.clone(), target, line));
            }
        }
    }
    // The file that declares what a path names, through whatever passes it on.
    let declares = |mut path: Module| {
        for _ in 0..modules.len() {
            let mut length = path.len();
            while !modules.contains(&path[..length]) && length > 0 {
                length -= 1;
            }
            let item = path.get(..length + 1).map(<[String]>::to_vec);
            match item.and_then(|item| passed_on.get(&item)) {
                Some(target) => path = [&target[..], &path[length + 1..]].concat(),
                None => return path[..length].to_vec(),
            }
        }
        Module::new()
    };
    let rank = |module: &Module| order.iter().position(|name| *name == module[0]);
    let mut faults = Vec::new();
    let mut edges: BTreeMap<Module, BTreeMap<Module, usize>> = BTreeMap::new();
    for (module, path, line) in named {
        let place = format!("{}:{line}", files[&module].file);
        let target = declares(path.clone());
        if target.is_empty() {
            faults.push(format!("{place}: `{}` is nowhere", path.join("::")));
            continue;
        }
        match (rank(&module), rank(&target)) {
            (Some(from), Some(to)) if from < to => faults.push(format!(
                "{place}: `{}` imports `{}` of a higher layer",
                module.join("::"),
                target.join("::")
            )),
            (Some(_), Some(_)) => {}
            _ => faults.push(format!("{place}: a module is in no layer")),
        }
        if target != module {
            edges
                .entry(module)
                .or_default()
                .entry(target)
                .or_insert(line);
        }
    }
    // Without those that import nothing of the rest, or that nothing of it imports, again and
    // again, cycles are left, and what lies between two of them.
    let mut rest = modules.clone();
    loop {
        let inner: Vec<(&Module, &Module)> = edges
            .iter()
            .flat_map(|(from, to)| to.keys().map(move |to| (from, to)))
            .filter(|(from, to)| rest.contains(*from) && rest.contains(*to))
            .collect();
        let from: BTreeSet<&Module> = inner.iter().map(|&(from, _)| from).collect();
        let to: BTreeSet<&Module> = inner.iter().map(|&(_, to)| to).collect();
        let kept: BTreeSet<Module> = from.intersection(&to).map(|&it| it.clone()).collect();
        if kept.len() == rest.len() {
            break;
        }
        rest = kept;
    }
    for module in &rest {
        for (target, line) in &edges[module] {
            if rest.contains(target) {
                faults.push(format!(
                    "{}:{line}: `{}` is part of a cycle",
                    files[module].file,
                    target.join("::")
                ));
            }
        }
    }
    faults
}

/// All sources below a folder, without those that only tests compile.
fn sources(folder: &Path) -> Vec<Source> {
    let mut found = Vec::new();
    read(folder, "", &mut found);
    let tests: Vec<Module> = found.iter().flat_map(Source::test_modules).collect();
    found.retain(|source| {
        let module = module(&source.file);
        !tests.iter().any(|tests| module.starts_with(tests))
    });
    found
}

/// All sources below a folder.
fn read(folder: &Path, below: &str, found: &mut Vec<Source>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().into_string().expect("a name");
        let file = format!("{below}{name}");
        if entry.path().is_dir() {
            read(&entry.path(), &format!("{file}/"), found);
        } else if name.ends_with(".rs") {
            let text = fs::read_to_string(entry.path()).expect("a source");
            found.push(Source::new(&file, &text));
        }
    }
}

#[track_caller]
fn check(layers: &Layers) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(layers.sources);
    let rows = layers.order.iter();
    let order: Vec<&str> = rows.flat_map(|row| row.split_whitespace()).collect();
    let faults = faults(&sources(&folder), &order);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn core_imports_run_one_way() {
    check(&CORE);
}

#[test]
fn host_imports_run_one_way() {
    check(&HOST);
}

fn made_up(files: &[(&str, &str)]) -> Vec<String> {
    let sources: Vec<Source> = files
        .iter()
        .map(|(file, text)| Source::new(file, text))
        .collect();
    faults(&sources, &["low", "high"])
}

#[test]
fn an_import_of_a_higher_layer_is_found() {
    let low = "// use crate::high::Comment;\n/// [`x`](crate::high::x)\nuse crate::high::Thing;\n";
    let found = made_up(&[("low.rs", low), ("high.rs", "pub struct Thing;")]);
    assert_eq!(found, ["low.rs:3: `low` imports `high` of a higher layer"]);
    let inline = "fn f() -> &str { \"crate::high::text\" }\nfn g() { crate::high::h() }\n";
    let found = made_up(&[("low.rs", inline), ("high.rs", "")]);
    assert_eq!(found, ["low.rs:2: `low` imports `high` of a higher layer"]);
    let passed_on = [
        ("lib.rs", "pub use high::Thing;"),
        ("low.rs", "use crate::Thing as Other;"),
        ("high.rs", ""),
    ];
    let found = made_up(&passed_on);
    assert_eq!(found, ["low.rs:1: `low` imports `high` of a higher layer"]);
}

#[test]
fn a_cycle_within_a_layer_is_found() {
    let files = [
        (
            "low/mod.rs",
            "mod a;\nmod b;\npub use a::A;\npub use b::B;\n",
        ),
        ("low/a.rs", "use std::fmt;\nuse super::{b::{self}, C};\n"),
        ("low/b.rs", "\nuse crate::low::A;\n"),
    ];
    let found = made_up(&files);
    assert_eq!(
        found,
        [
            "low/a.rs:2: `low::b` is part of a cycle",
            "low/b.rs:2: `low::a` is part of a cycle",
        ]
    );
}

#[test]
fn child_that_an_expression_names_is_an_import() {
    let files = [
        ("low/mod.rs", "mod a;\nfn f() { a::g() }\n"),
        (
            "low/a.rs",
            "use super::f;\nuse std::fmt;\npub fn g() { fmt::g() }\n",
        ),
    ];
    assert_eq!(
        made_up(&files),
        [
            "low/mod.rs:2: `low::a` is part of a cycle",
            "low/a.rs:1: `low` is part of a cycle",
        ]
    );
}

#[test]
fn only_cycles_are_reported_and_not_what_leads_to_them() {
    let files = [
        ("low/a.rs", "use super::b::B;\n"),
        ("low/b.rs", "use super::c::C;\n"),
        ("low/c.rs", "use super::b::B;\nuse super::d::D;\n"),
        ("low/d.rs", ""),
    ];
    assert_eq!(
        made_up(&files),
        [
            "low/b.rs:1: `low::c` is part of a cycle",
            "low/c.rs:1: `low::b` is part of a cycle",
        ]
    );
}

#[test]
fn quoted_text_is_blank_and_code_behind_it_is_not() {
    let text = r##"'"' a r#"b "c" d"# e "\"f" g r"\" h // " i"##;
    let words: Vec<_> = blank(text).split_whitespace().map(String::from).collect();
    assert_eq!(words, ["a", "e", "g", "h"]);
}

#[test]
fn modules_that_only_tests_compile_are_found() {
    let text = "#[cfg(test)]\nmod damaged;\nmod kept;\n#[cfg(test)]\nmod tests { fn f() {} }\n";
    let source = Source::new("low/mod.rs", text);
    assert_eq!(source.test_modules(), [["low", "damaged"]]);
}

#[test]
fn imports_downwards_are_no_fault() {
    let files = [
        ("lib.rs", "mod low;\nmod high;\npub use low::Low;"),
        (
            "low/mod.rs",
            "mod a;\npub(crate) use a::A;\npub struct Low;\n",
        ),
        (
            "low/a.rs",
            "use crate::low::Low;\n#[cfg(test)]\nmod tests { use crate::high::H; }\n",
        ),
        ("high.rs", "use crate::low::{A, Low};\nuse crate::low::a;\n"),
    ];
    assert_eq!(made_up(&files), Vec::<String>::new());
}
