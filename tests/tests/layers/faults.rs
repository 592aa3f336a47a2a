//! Imports of higher layers, and cycles.

use super::paths::{Named, absolute, paths};
use super::source::{Module, Source, module};
use std::collections::{BTreeMap, BTreeSet};

/// Returns the faults of the imports of some files.
pub(super) fn faults(sources: &[Source], order: &[&str]) -> Vec<String> {
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
            // A module passes on what its own files declare without importing anything.
            let is_own = is_public && target.starts_with(module);
            if !module.is_empty() && !is_own {
                named.push((module.clone(), target.clone(), line));
            }
            if is_public {
                passed_on.insert([&module[..], &[name]].concat(), target);
            }
        }
    }
    // Finds the file that declares the item of a path, through all re-exports.
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
    // Modules that import nothing of the rest, or that nothing of it imports, are removed again and
    // again. Cycles remain, and modules between two of them.
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
fn re_export_of_a_higher_layer_is_found() {
    for re_export in [
        "pub use crate::high::Thing;\n",
        "pub(crate) use super::high::{self, Thing as Other};\n",
    ] {
        let found = made_up(&[("low.rs", re_export), ("high.rs", "pub struct Thing;")]);
        let expected = "low.rs:1: `low` imports `high` of a higher layer";
        assert!(
            !found.is_empty() && found.iter().all(|it| it == expected),
            "{found:?}"
        );
    }
}

#[test]
fn cycle_through_a_re_export_is_found() {
    let files = [
        ("low/a.rs", "pub use super::b::B;\npub struct A;\n"),
        ("low/b.rs", "use super::a::A;\npub struct B;\n"),
    ];
    assert_eq!(
        made_up(&files),
        [
            "low/a.rs:1: `low::b` is part of a cycle",
            "low/b.rs:1: `low::a` is part of a cycle",
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
