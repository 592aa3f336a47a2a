//! Chooses one model and one alternate location of each residue.

use super::parsed::{Atom, Model, Parsed};
use super::residues;
use crate::scene::text::Source;
use crate::scene::{MoleculeOptions, SceneError};
use std::collections::{BTreeSet, HashMap, HashSet};

/// Returns the atoms of the requested model, in file order. A residue with alternate locations
/// keeps the atoms of the requested location. It keeps those of its first location if it lacks that
/// one or none is requested. Atoms without an alternate location are always kept. [`Locations`] says
/// what becomes of an atom that lacks the location of its residue.
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
    let all = parsed.atoms.iter();
    let all: Vec<_> = all.filter(|it| it.model + 1 == options.model).collect();
    let wanted = options.altloc.map(String::from);
    let located = all.iter().filter(|atom| !atom.altloc.is_empty());
    let present: BTreeSet<&str> = located.map(|atom| atom.altloc).collect();
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
    let residues = residues::number(&all);
    let located = || {
        let pairs = all.iter().zip(&residues);
        let pairs = pairs.filter(|(atom, _)| !atom.altloc.is_empty());
        pairs.filter_map(|(atom, residue)| Some((*atom, (*residue)?)))
    };
    let locations = Locations::of(located, wanted.as_deref());
    let keeps = |(atom, residue): (&&Atom<'_>, &Option<u32>)| match residue {
        Some(residue) if !atom.altloc.is_empty() => {
            locations.of_atom.get(&(*residue, atom.name)) == Some(&atom.altloc)
        }
        _ => true,
    };
    let selected = all.iter().zip(&residues).filter(|it| keeps(*it));
    let selected: Vec<_> = selected.map(|(atom, _)| *atom).collect();
    if selected.is_empty() {
        return Err(empty(format!("model {} of the file", options.model)));
    }
    Ok(selected)
}

/// The alternate locations that are drawn.
struct Locations<'a> {
    /// By residue and atom name.
    of_atom: HashMap<(u32, &'a str), &'a str>,
}

impl<'a> Locations<'a> {
    /// Chooses one for each residue, and then for each of its atoms. An atom that lacks the residue's location keeps its
    /// first one, if it is of the same kind of residue. Where a location is wanted, that one is not a rival of it:
    /// another atom of the residue does not have both.
    fn of<'p, I>(located: impl Fn() -> I, wanted: Option<&str>) -> Self
    where
        I: Iterator<Item = (&'p Atom<'a>, u32)>,
        'a: 'p,
    {
        let mut of_residue: HashMap<u32, [&str; 2]> = HashMap::new();
        for (atom, residue) in located() {
            let own = [atom.altloc, atom.residue];
            let choice = of_residue.entry(residue).or_insert(own);
            if wanted == Some(atom.altloc) && choice[0] != atom.altloc {
                *choice = own;
            }
        }
        let is_chosen = |atom: &Atom<'_>, residue| of_residue[&residue][0] == atom.altloc;
        let mut of_atom = HashMap::new();
        let mut rivals: HashSet<(u32, &str)> = HashSet::new();
        for (atom, residue) in located().filter(|(atom, residue)| is_chosen(atom, *residue)) {
            of_atom.insert((residue, atom.name), atom.altloc);
        }
        for (atom, residue) in located().filter(|(atom, _)| Some(atom.altloc) != wanted) {
            let chosen = of_atom.get(&(residue, atom.name)).copied();
            if wanted.is_some() && chosen == wanted {
                rivals.insert((residue, atom.altloc));
            }
        }
        for (atom, residue) in located() {
            let is_of_kind = of_residue[&residue][1] == atom.residue;
            if is_of_kind && !rivals.contains(&(residue, atom.altloc)) {
                of_atom.entry((residue, atom.name)).or_insert(atom.altloc);
            }
        }
        Self { of_atom }
    }
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
