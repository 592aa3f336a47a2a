//! Constants for what has a name in a scene.

use crate::compile::Names;
use crate::table::grouped;
use gridel_core::Scene;
use std::collections::BTreeMap;

/// Constants of one kind at most: beyond that, names are data and not handles for a program.
const MOST: usize = 1_000;

/// Names and groups of names that comments list at most.
const LISTED: usize = 8;

/// A kind of named things: the module of its constants, what they number, and their type.
type Kind<'n> = (&'static str, &'static str, &'static str, &'n [String]);

/// Returns modules of constants, one for each kind that has names; nothing for a scene without names.
///
/// Names that give the same identifier, or none, have no constant. A comment says so.
pub(super) fn constants(scene: &Scene<'_>, names: &Names) -> String {
    // Instances that were copied into the scene have no number any more.
    let placed = &names.instances[..names.instances.len().min(scene.instances().len())];
    let kinds: [Kind<'_>; 4] = [
        (
            "objects",
            "objects, as `Hit::object` counts",
            "u32",
            &names.objects,
        ),
        (
            "materials",
            "materials, as `Scene::materials` has them",
            "usize",
            &names.materials,
        ),
        (
            "lights",
            "lights, as `Scene::lights` has them",
            "usize",
            &names.lights,
        ),
        (
            "instances",
            "instances, as `PosesView::place` counts",
            "u32",
            placed,
        ),
    ];
    kinds.into_iter().filter_map(module).collect()
}

fn module((module, what, number, names): Kind<'_>) -> Option<String> {
    let mut numbers = BTreeMap::<String, Vec<usize>>::new();
    let mut nameless = Vec::new();
    for (place, name) in names.iter().enumerate() {
        match identifier(name) {
            Some(identifier) => numbers.entry(identifier).or_default().push(place),
            None if name.is_empty() => {}
            None => nameless.push(format!("{}: no letter or digit of ASCII", quoted(name))),
        }
    }
    // In the order of the numbers, as the scene file has them.
    let mut constants = Vec::new();
    let mut without = Vec::new();
    for (identifier, places) in numbers {
        match places[..] {
            [place] => constants.push((place, identifier)),
            _ => {
                let names = list(places.iter().map(|&place| quoted(&names[place])));
                without.push((places[0], format!("{names}: all would be `{identifier}`")));
            }
        }
    }
    constants.sort_unstable();
    without.sort_unstable();
    let without = without.into_iter().map(|(_, why)| why).chain(nameless);
    let mut comments: Vec<_> = without.collect();
    if constants.len() > MOST {
        comments = vec![format!(
            "all {}: more than {} names",
            grouped(constants.len()),
            grouped(MOST)
        )];
        constants.clear();
    }
    if constants.is_empty() && comments.is_empty() {
        return None;
    }
    let mut text = format!(
        "/// Numbers of the scene's {what}, by name. They hold for this blob: write both again together.\n\
         #[allow(dead_code)]\npub mod {module} {{\n"
    );
    for (place, identifier) in constants {
        let name = quoted(&names[place]);
        text += &format!("    /// {name}\n    pub const {identifier}: {number} = {place};\n");
    }
    if !comments.is_empty() {
        text += "    // Without a constant:\n";
    }
    for comment in shortened(&comments) {
        text += &format!("    // - {comment}\n");
    }
    text += "}\n";
    Some(text)
}

/// A name as it can stand in a comment.
fn quoted(name: &str) -> String {
    format!("`{}`", name.escape_debug())
}

/// The first of many texts, and how many there are more.
fn shortened(texts: &[String]) -> impl Iterator<Item = String> {
    let more = texts.len().saturating_sub(LISTED);
    let more = (more > 0).then(|| format!("{} more", grouped(more)));
    texts.iter().take(LISTED).cloned().chain(more)
}

fn list(names: impl Iterator<Item = String>) -> String {
    shortened(&names.collect::<Vec<_>>())
        .collect::<Vec<_>>()
        .join(", ")
}

/// Returns a name as the identifier of a constant: capital letters, digits and single underscores. `None` if the name
/// has no ASCII letter or digit.
fn identifier(name: &str) -> Option<String> {
    let mut identifier = String::new();
    let mut last = ' ';
    for character in name.chars() {
        let starts_word = character.is_ascii_uppercase() && last.is_ascii_lowercase();
        let is_gap = !character.is_ascii_alphanumeric();
        if (starts_word || is_gap) && !identifier.is_empty() && !identifier.ends_with('_') {
            identifier.push('_');
        }
        if !is_gap {
            identifier.push(character.to_ascii_uppercase());
        }
        last = character;
    }
    identifier.truncate(identifier.trim_end_matches('_').len());
    if identifier.starts_with(|first: char| first.is_ascii_digit()) {
        identifier.insert(0, '_');
    }
    (!identifier.is_empty()).then_some(identifier)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};

    #[test]
    fn names_become_identifiers() {
        for (name, expected) in [
            ("floor", Some("FLOOR")),
            ("left arm.001", Some("LEFT_ARM_001")),
            ("leftArm", Some("LEFT_ARM")),
            ("  --x--  ", Some("X")),
            ("1CRN", Some("_1CRN")),
            ("größe", Some("GR_E")),
            ("球", None),
            ("", None),
        ] {
            assert_eq!(identifier(name).as_deref(), expected, "{name}");
        }
    }

    #[test]
    fn ambiguous_names_have_no_constant() {
        let list = |names: &[&str]| names.iter().map(|&it| it.to_owned()).collect();
        let sphere = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1";
        let read = crate::scene::read("ball.toml".as_ref(), sphere.into(), &Default::default());
        let compiled = compile(&read.unwrap().scene, &Options::default()).unwrap();
        let scene = compiled.blob.scene().unwrap();
        let names = Names {
            objects: list(&["ball", "", "a ball", "a-ball", "球"]),
            lights: list(&["", "sun"]),
            instances: list(&["copied"]),
            ..Names::default()
        };
        let text = constants(&scene, &names);
        assert!(text.contains("pub const BALL: u32 = 0;"), "{text}");
        assert!(text.contains("pub const SUN: usize = 1;"), "{text}");
        let why = "`a ball`, `a-ball`: all would be `A_BALL`\n";
        assert!(
            text.contains(&format!("    // Without a constant:\n    // - {why}")),
            "{text}"
        );
        assert!(
            text.contains("// - `球`: no letter or digit of ASCII"),
            "{text}"
        );
        for absent in ["const A_BALL", "COPIED", "materials"] {
            assert!(!text.contains(absent), "{text}");
        }
        let many = Names {
            objects: (0..=MOST).map(|number| format!("atom {number}")).collect(),
            ..Names::default()
        };
        let text = constants(&scene, &many);
        assert!(
            text.contains("// - all 1,001: more than 1,000 names"),
            "{text}"
        );
        assert!(!text.contains("const "), "{text}");
    }
}
