//! Biological assemblies: chains, and the operators that copy them.
//!
//! Files state all of them, and one is drawn, so operators are read when an assembly is chosen.

use super::limit::check_size;
use super::operators::{MOST_INSTANCES, Operator};
use super::parsed::{Atom, Parsed};
use crate::scene::text::{Source, Warnings};
use crate::scene::{Placement, SceneError};
use crate::table::shortened;
use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Number of names that a message lists.
const LISTED: usize = 20;

/// The name of the assembly of the atoms in the file and the copies that its operators generate.
pub(super) const GENERATED: &str = "generated";

/// Atoms that are copied together.
pub(super) struct Copied {
    /// Indices of atoms in file order.
    pub(super) atoms: Vec<u32>,
    /// The chains in words.
    pub(super) name: String,
    pub(super) line: usize,
    /// Their placements, with names.
    pub(super) places: Vec<(String, Placement)>,
}

impl Copied {
    /// Returns whether they stand only where the file has them.
    pub(super) fn is_single(&self) -> bool {
        matches!(&self.places[..], [(_, place)] if *place == Placement::IDENTITY)
    }
}

/// Chains, and the operators that apply to them.
struct Chains<'a> {
    /// `None` for all.
    names: Option<BTreeSet<&'a str>>,
    operators: Vec<Operator>,
    line: usize,
}

/// The atoms of an assembly and their places.
///
/// # Errors
/// If there is no such assembly, an operator is missing or no rotation, or there are too many instances.
pub(super) fn assemble(
    source: &Source,
    parsed: &Parsed<'_>,
    atoms: &[&Atom<'_>],
    wanted: &str,
    warnings: &mut Warnings,
) -> Result<Vec<Copied>, SceneError> {
    let chosen = || {
        parsed
            .groups
            .iter()
            .filter(|it| it.assemblies.contains(&wanted))
    };
    if chosen().next().is_none() {
        return Err(unknown(source, parsed, wanted));
    }
    let mut all: Vec<Chains<'_>> = Vec::new();
    let mut numbers: HashMap<Option<BTreeSet<&str>>, usize> = HashMap::new();
    let mut count = 0_u64;
    for group in chosen() {
        let made = group.operators.count(source, parsed, group.line)?;
        count = count.saturating_add(made);
        if count > MOST_INSTANCES {
            let cause = format!("assembly {wanted} has more than {MOST_INSTANCES} operators");
            let remedy = "choose another assembly, or repair its list of operators";
            return Err(source.error(cause, remedy).at_line(group.line));
        }
        let operators = group.operators.read(source, parsed, group.line)?;
        let names = group.chains.as_ref();
        let names: Option<BTreeSet<&str>> = names.map(|it| it.iter().copied().collect());
        if let Some(&known) = numbers.get(&names) {
            all[known].operators.extend(operators);
            continue;
        }
        numbers.insert(names.clone(), all.len());
        all.push(Chains {
            names,
            operators,
            line: group.line,
        });
    }
    let mut by_chain: HashMap<&str, Vec<u32>> = HashMap::new();
    for (atom, at) in atoms.iter().zip(0..) {
        by_chain.entry(atom.asym).or_default().push(at);
    }
    let mut copied = Vec::new();
    let mut total = 0;
    for chains in joined(all) {
        warn_of_missing(source, &chains, &by_chain, warnings);
        let found: Vec<&Vec<u32>> = match &chains.names {
            Some(names) => names.iter().filter_map(|it| by_chain.get(it)).collect(),
            None => by_chain.values().collect(),
        };
        // Many groups can name the same chains, so they are weighed before they are made.
        total += found.iter().map(|it| it.len()).sum::<usize>();
        check_size(source, total, 0)?;
        let mut atoms: Vec<u32> = found.into_iter().flatten().copied().collect();
        atoms.sort_unstable();
        if !atoms.is_empty() && !chains.operators.is_empty() {
            let operators = chains.operators.iter();
            copied.push(Copied {
                atoms,
                name: in_words(&chains),
                line: chains.line,
                places: operators
                    .map(|it| (it.name.clone(), it.placement))
                    .collect(),
            });
        }
    }
    if copied.is_empty() {
        return Err(source.error(
            format!("assembly {wanted} places no atoms"),
            "leave `--assembly` out, or check that the file is complete",
        ));
    }
    Ok(copied)
}

/// Warns of chains that have no atoms.
fn warn_of_missing(
    source: &Source,
    chains: &Chains<'_>,
    by_chain: &HashMap<&str, Vec<u32>>,
    warnings: &mut Warnings,
) {
    let names = chains.names.iter().flatten();
    let mut missing = names.filter(|it| !by_chain.contains_key(*it));
    if let Some(first) = missing.next() {
        let sentence = match missing.count() {
            0 => format!(
                "the assembly names the chain {first:?}, which has no atoms",
                first = shortened(first)
            ),
            more => format!(
                "the assembly names {} chains without atoms, such as {first:?}",
                more + 1,
                first = shortened(first)
            ),
        };
        warnings.add(source, chains.line, sentence);
    }
}

/// Joins chains with the same operators: bonds between them stay.
fn joined(all: Vec<Chains<'_>>) -> Vec<Chains<'_>> {
    let mut joined: Vec<Chains<'_>> = Vec::new();
    let mut known: HashMap<Vec<u64>, usize> = HashMap::new();
    for chains in all {
        let places = chains.operators.iter().map(|it| it.placement);
        let numbers = places.flat_map(|it| {
            let turn = it.rotation.to_array();
            turn.into_iter().chain(it.translation.to_array())
        });
        match known.entry(numbers.map(f64::to_bits).collect()) {
            Entry::Occupied(entry) => {
                let same = &mut joined[*entry.get()];
                same.names = same
                    .names
                    .take()
                    .zip(chains.names)
                    .map(|(mut names, more)| {
                        names.extend(more);
                        names
                    });
            }
            Entry::Vacant(entry) => {
                entry.insert(joined.len());
                joined.push(chains);
            }
        }
    }
    joined
}

/// The chains, or the first few of many.
fn in_words(chains: &Chains<'_>) -> String {
    const FEW: usize = 4;
    let Some(names) = &chains.names else {
        return String::from("all chains");
    };
    let few: Vec<_> = names.iter().take(FEW).map(|it| shortened(it)).collect();
    let word = if names.len() == 1 { "chain" } else { "chains" };
    let more = if names.len() > FEW { " ..." } else { "" };
    format!("{word} {}{more}", few.join(" "))
}

fn unknown(source: &Source, parsed: &Parsed<'_>, wanted: &str) -> SceneError {
    let mut names: Vec<&str> = Vec::new();
    let mut seen = HashSet::new();
    for &name in parsed.groups.iter().flat_map(|it| &*it.assemblies) {
        if seen.insert(name) {
            names.push(name);
        }
    }
    if names.is_empty() {
        return source.error(
            format!(
                "there is no assembly {wanted:?}: the file states none",
                wanted = shortened(wanted)
            ),
            "leave `--assembly` out; the atoms of the file are drawn as they stand",
        );
    }
    let more = if names.len() > LISTED { " ..." } else { "" };
    let names: Vec<_> = names.iter().take(LISTED).map(|it| shortened(it)).collect();
    source.error(
        format!(
            "there is no assembly {wanted:?}",
            wanted = shortened(wanted)
        ),
        format!("choose one of {}{more}", names.join(", ")),
    )
}
