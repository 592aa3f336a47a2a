//! Limits of the number of atoms and bonds, so that they fit into memory.

use crate::scene::SceneError;
use crate::scene::size::Size;
use crate::scene::text::Source;

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
