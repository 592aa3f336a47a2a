//! Bonds: those that a file states, and those that distances imply.

use super::bonds::perceive;
use super::parsed::{Atom, Bond, End, Parsed, Site};
use crate::scene::text::{Source, Warnings};
use crate::table::shortened;
use std::collections::{HashMap, HashSet};

/// Warns of bonds to atoms that no model of the file has.
pub(super) fn missing_ends(source: &Source, parsed: &Parsed<'_>, warnings: &mut Warnings) {
    if parsed.bonds.is_empty() {
        return;
    }
    let mut missing: HashSet<&End<'_>> = named_ends(parsed).collect();
    for end in parsed.atoms.iter().flat_map(ends_of) {
        missing.remove(&end);
    }
    warn(
        source,
        parsed,
        |end| missing.contains(end),
        "which the file lacks",
        warnings,
    );
}

/// Warns of the bonds that have an end which is `left_out`.
fn warn<'a>(
    source: &Source,
    parsed: &Parsed<'a>,
    left_out: impl Fn(&End<'a>) -> bool,
    why: &str,
    warnings: &mut Warnings,
) {
    let mut all = parsed.bonds.iter().filter_map(|bond| {
        let end = bond.ends.iter().find(|end| left_out(end))?;
        Some((bond, end))
    });
    let Some((bond, first)) = all.next() else {
        return;
    };
    let sentence = format!(
        "{} names the atom {}, {why}; the bond is left out",
        bond.record,
        in_words(first)
    );
    warnings.add_times(source.place(bond.line), 1 + all.count(), sentence);
}

/// An end of a bond, as its record names it.
fn in_words(end: &End<'_>) -> String {
    let (atom, altloc) = match *end {
        End::Serial(serial) => return serial.to_owned(),
        End::Name([chain, number, _, name, altloc]) | End::Label([chain, number, name, altloc]) => {
            ([chain, number, name], altloc)
        }
    };
    let atom = atom.map(shortened).join("/");
    match altloc {
        "" => atom,
        _ => format!("{atom} at the alternate location {}", shortened(altloc)),
    }
}

/// Returns the names of an atom in bonds.
fn ends_of<'a>(atom: &Atom<'a>) -> [End<'a>; 5] {
    let name = |altloc| [atom.chain, atom.number, atom.insertion, atom.name, altloc];
    let label = |altloc| [atom.asym, atom.label, atom.name, altloc];
    [
        End::Serial(atom.serial),
        End::Name(name(atom.altloc)),
        End::Name(name("")),
        End::Label(label(atom.altloc)),
        End::Label(label("")),
    ]
}

/// The ends that bonds name: far fewer than atoms have.
fn named_ends<'p, 'a>(parsed: &'p Parsed<'a>) -> impl Iterator<Item = &'p End<'a>> {
    parsed.bonds.iter().flat_map(|bond| &bond.ends)
}

/// The atoms that an end of a bond names.
#[derive(Clone, Copy, PartialEq)]
enum Named {
    /// It may be in another model or at an alternate location.
    None,
    One(u32),
    Several,
}

/// The bonds between the chosen atoms: those of the file, and those that distances imply.
pub(super) fn find_bonds(
    source: &Source,
    parsed: &Parsed<'_>,
    atoms: &[&Atom<'_>],
    warnings: &mut Warnings,
) -> Vec<[u32; 2]> {
    let mut ends: HashMap<&End<'_>, Named> = HashMap::new();
    ends.extend(named_ends(parsed).map(|end| (end, Named::None)));
    if !ends.is_empty() {
        for (atom, index) in atoms.iter().zip(0..) {
            for end in ends_of(atom) {
                if let Some(named) = ends.get_mut(&end) {
                    *named = match *named {
                        Named::None => Named::One(index),
                        Named::One(first) if first == index => Named::One(first),
                        Named::One(_) | Named::Several => Named::Several,
                    };
                }
            }
        }
    }
    warn(
        source,
        parsed,
        |end| ends[end] == Named::Several,
        "but several atoms have this name",
        warnings,
    );
    let stated =
        parsed
            .bonds
            .iter()
            .filter_map(|Bond { ends: [a, b], .. }| match [ends[a], ends[b]] {
                [Named::One(a), Named::One(b)] => Some([a, b]),
                _ => None,
            });
    let sites: Vec<Site> = atoms.iter().map(|atom| atom.site).collect();
    let (perceived, crowded) = perceive(&sites);
    if let Some(&first) = crowded.first() {
        let sentence = format!(
            "{} atoms are crowded as in no molecule; no bonds are guessed among them",
            crowded.len()
        );
        warnings.add(source, atoms[first as usize].line, sentence);
    }
    let mut bonds: Vec<[u32; 2]> = stated.chain(perceived).filter(|[a, b]| a != b).collect();
    for bond in &mut bonds {
        bond.sort_unstable();
    }
    bonds.sort_unstable();
    bonds.dedup();
    bonds
}
