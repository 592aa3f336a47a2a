//! Sources without comments, strings and tests.

use std::fs;
use std::path::Path;

pub(super) type Module = Vec<String>;

/// One file without comments, strings and tests.
pub(super) struct Source {
    pub(super) file: String,
    pub(super) text: String,
}

impl Source {
    pub(super) fn new(file: &str, text: &str) -> Self {
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
    pub(super) fn test_modules(&self) -> Vec<Module> {
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

/// Returns the text with comments and quoted text as spaces; lines stay where they are.
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

/// The module of a file.
pub(super) fn module(file: &str) -> Module {
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

/// All sources below a folder, without those that only tests compile.
pub(super) fn sources(folder: &Path) -> Vec<Source> {
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
