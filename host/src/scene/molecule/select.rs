//! Chooses one model and one alternate location of each residue.

use super::parsed::{Atom, Model, Parsed};
use crate::scene::text::Source;
use crate::scene::{MoleculeOptions, SceneError};
use std::collections::{BTreeSet, HashMap};

/// Returns the atoms of the requested model, in file order. A residue with alternate locations
/// keeps the atoms of the requested location. It keeps those of its first location if it lacks that
/// one or none is requested. Atoms without an alternate location are always kept.
pub(super) fn select<'p, 'a>(
    source: &Source,
    parsed: &'p Parsed<'a>,
    options: &MoleculeOptions,
) -> Result<Vec<&'p Atom<'a>>, SceneError> {
    let count = parsed.models.len();
    let empty = |what: String| {
        source.error(
            format!("{what} has no atoms"),
            "check that the file is complete, and that its extension names its format",
        )
    };
    if count == 0 {
        return Err(empty(String::from("the file")));
    }
    if !(1..=count).contains(&options.model) {
        return Err(source.error(
            format!(
                "there is no model {}, since the file has {count}",
                options.model
            ),
            format!(
                "choose a model from 1 to {count}, counted in file order{}",
                own_numbers(&parsed.models)
            ),
        ));
    }
    let of_model = || {
        parsed
            .atoms
            .iter()
            .filter(|atom| atom.model + 1 == options.model)
    };

    let wanted = options.altloc.map(String::from);
    let mut chosen: HashMap<[&str; 3], &str> = HashMap::new();
    let mut present = BTreeSet::new();
    for atom in of_model().filter(|atom| !atom.altloc.is_empty()) {
        present.insert(atom.altloc);
        let choice = chosen.entry(atom.residue_key()).or_insert(atom.altloc);
        if wanted.as_deref() == Some(atom.altloc) {
            *choice = atom.altloc;
        }
    }
    if let Some(wanted) = &wanted
        && !present.contains(wanted.as_str())
    {
        let remedy = if present.is_empty() {
            "leave the option out, since the model has no alternate locations".to_owned()
        } else {
            format!(
                "choose one of {}",
                present.into_iter().collect::<Vec<_>>().join(", ")
            )
        };
        let cause = format!("model {} has no alternate location {wanted}", options.model);
        return Err(source.error(cause, remedy));
    }
    let selected: Vec<_> = of_model()
        .filter(|atom| {
            atom.altloc.is_empty() || chosen.get(&atom.residue_key()) == Some(&atom.altloc)
        })
        .collect();
    if selected.is_empty() {
        return Err(empty(format!("model {} of the file", options.model)));
    }
    Ok(selected)
}

/// Returns a text with a file's own numbers of its models, for files that number them.
fn own_numbers(models: &[Model<'_>]) -> String {
    const NAMED: usize = 20;
    let numbers = models.iter().take(NAMED).map(|model| model.number);
    let numbers = numbers.collect::<Vec<_>>().join(", ");
    let more = if models.len() > NAMED { " ..." } else { "" };
    if models.iter().all(|model| model.number.is_empty()) {
        return String::new();
    }
    format!(" (the file itself numbers them {numbers}{more})")
}
