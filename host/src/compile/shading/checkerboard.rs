//! Cells of checkerboards in the range of their records.

use crate::scene::{Diffuse, Material};
use crate::shape::Lattice;

/// The largest cell of a checkerboard in units, twice as wide as a scene's box.
pub(super) const LARGEST_CELL: f64 = 131_071.0;

/// Returns whether a material has a checkerboard whose cells are larger than a record holds.
pub(super) fn has_large_cells(material: &Material, lattice: &Lattice) -> bool {
    matches!(material.diffuse, Diffuse::Checker { size, .. } if size > LARGEST_CELL * lattice.unit())
}

/// A corner of a checkerboard's cells on one axis, in units, no farther than [`LARGEST_CELL`] from the lattice's middle.
/// The pattern is that of the given corner: everywhere, or, where cells are larger than that, in the scene's box.
///
/// A corner that is near enough is kept, because cells of another one would be off by roundings. A face that lies
/// between two layers of cells, as the ground often does, must stay there.
pub(super) fn checker_origin(corner: f64, size: f64) -> f64 {
    if size <= LARGEST_CELL {
        if corner.abs() <= LARGEST_CELL {
            return corner;
        }
        // It repeats after two cells.
        let first = corner.rem_euclid(2.0 * size);
        return if first > LARGEST_CELL {
            first - 2.0 * size
        } else {
            first
        };
    }
    // The cell around the middle, in which it takes turns with its neighbors.
    let cell = (-corner / size).floor();
    let low = corner + cell * size;
    let high = low + size;
    let is_even = cell.rem_euclid(2.0) == 0.0;
    // The nearer of its sides is kept, or lies beyond the box; the other is beyond it, too.
    let edge = LARGEST_CELL / 2.0;
    if -low <= high {
        let side = low.max(-edge);
        if is_even { side } else { side + LARGEST_CELL }
    } else {
        let side = high.min(edge);
        if is_even { side - LARGEST_CELL } else { side }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of the cell that holds a place, counted from a corner.
    fn parity(place: f64, corner: f64, size: f64) -> bool {
        ((place - corner) / size).floor().rem_euclid(2.0) == 1.0
    }

    #[test]
    fn checkerboards_of_every_size_keep_their_pattern_in_the_scenes_box() {
        let sizes = [
            1.0, 1e3, 40_000.0, 70_000.0, 131_000.0, 131_072.0, 2e5, 3e6, 1e12,
        ];
        for size in sizes {
            for step in -40..=40 {
                let corner = f64::from(step) * 0.0625 * size + 0.3;
                let found = checker_origin(corner, size);
                assert!(found.abs() <= LARGEST_CELL, "{found}");
                for place in (-32_768..=32_768).step_by(512) {
                    let place = f64::from(place) + 0.1;
                    let expected = parity(place, corner, size);
                    let found = parity(place, found, size.min(LARGEST_CELL));
                    assert_eq!(found, expected, "{place} in cells of {size} from {corner}");
                }
            }
        }
    }
}
