//! The residues that have alternate locations.

use super::parsed::Atom;
use std::collections::{HashMap, HashSet};

/// An atom of a residue: its name and its alternate location.
type Within<'a> = [&'a str; 2];

/// The residue of each atom, by a number, where the residue has alternate locations.
pub(super) fn number<'a>(atoms: &[&Atom<'a>]) -> Vec<Option<u32>> {
    let located = atoms.iter().filter(|atom| !atom.altloc.is_empty());
    let located: HashSet<[&str; 4]> = located.map(|atom| key(atom)).collect();
    let mut open: HashMap<[&str; 4], (u32, HashSet<Within<'a>>)> = HashMap::new();
    let mut count = 0;
    let mut next = || {
        count += 1;
        count - 1
    };
    let residue = |atom: &&Atom<'a>| {
        let key = key(atom);
        located.contains(&key).then(|| {
            let (number, seen) = open.entry(key).or_insert_with(|| (next(), HashSet::new()));
            // Waters without a number follow each other, and numbers of long chains begin again.
            if !seen.insert([atom.name, atom.altloc]) {
                *number = next();
                *seen = [[atom.name, atom.altloc]].into();
            }
            *number
        })
    };
    atoms.iter().map(residue).collect()
}

/// Returns the key that distinguishes residues of a model.
fn key<'a>(atom: &Atom<'a>) -> [&'a str; 4] {
    [atom.chain, atom.number, atom.insertion, atom.segment]
}
