//! Paths that a source imports or names.

use super::source::Module;
use std::collections::BTreeSet;

/// A path as code names it, the module that names it, and the line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Named {
    pub(super) path: Module,
    pub(super) line: usize,
    pub(super) is_public: bool,
    pub(super) alias: Option<String>,
}

/// All paths that a text imports or names.
pub(super) fn paths(text: &str) -> Vec<Named> {
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

/// A path from the crate's root; `None` for another crate's.
pub(super) fn absolute(
    module: &[String],
    path: &[String],
    children: &BTreeSet<Module>,
) -> Option<Module> {
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
