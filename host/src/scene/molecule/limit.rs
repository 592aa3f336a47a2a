//! Limits of the number of atoms and bonds, so that they fit into memory.

use super::parsed::{Atom, Parsed};
use crate::scene::SceneError;
use crate::scene::size::{MOST_BYTES, Size};
use crate::scene::text::Source;
use crate::table::grouped;

/// The most atoms that a file may list, in all of its models. While a list grows, it takes its bytes twice.
const MOST_ATOMS: usize = MOST_BYTES as usize / (2 * size_of::<Atom>());

impl<'a> Parsed<'a> {
    /// Adds an atom, unless the file lists too many. A line is shorter than the memory of its atom.
    pub(in crate::scene) fn add(
        &mut self,
        source: &Source,
        atom: Atom<'a>,
    ) -> Result<(), SceneError> {
        if self.atoms.len() >= MOST_ATOMS {
            let cause = format!(
                "the file lists more than {} atoms, the limit for all of its models",
                grouped(MOST_ATOMS)
            );
            let error = source.error(cause, "leave models out, or parts of the molecule");
            return Err(error.at_line(atom.line));
        }
        self.atoms.push(atom);
        Ok(())
    }
}

/// Rejects atoms so crowded that their bonds fit into no memory.
pub(super) fn check_size(source: &Source, atoms: usize, bonds: usize) -> Result<(), SceneError> {
    // A name has a few words with a few letters each.
    let size = Size {
        objects: (atoms + 2 * bonds) as u64,
        ..Size::default()
    };
    match size.excess() {
        None => Ok(()),
        Some(excess) => Err(source.error(
            format!("{bonds} bonds of {atoms} atoms take {excess}"),
            "use the style space-filling, or check that the coordinates are in angstroms",
        )),
    }
}
