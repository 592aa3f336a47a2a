//! Carbon nanotubes.

use super::carbon;
use crate::scene::{MoleculeStyle, Scene};
use glam::DVec3;
use std::f64::consts::TAU;

/// The bond length of graphene in angstroms.
const BOND: f64 = 1.421;

/// Returns a single-walled tube of graphene, open at its ends, along the z axis, space-filling.
/// `(n, n)` is an armchair tube, `(n, 0)` a zigzag tube, all others are chiral. `length` is in
/// angstroms. The tube (10, 10) has 16.3 atoms per angstrom, so 172 angstroms are about 2,800
/// objects.
///
/// Bond lengths are those of the flat sheet, measured along the wall.
///
/// A tube `(m, n)` is the mirror image of `(n, m)`; the one whose first index is the larger is
/// made. That index is at least 3, or there would be no room for a tube; a smaller one is raised.
pub fn nanotube(n: u32, m: u32, length: f64) -> Scene {
    let (n, m) = (i64::from(n.max(m).max(3)), i64::from(n.min(m)));
    // The tube rolls up the sheet along the chiral vector c = n a + m b. The lattice vectors a and
    // b are at 60 degrees. Lengths are in units of a from here on.
    let lattice = BOND * 3.0_f64.sqrt();
    let square = n * n + n * m + m * m;
    let circumference = (square as f64).sqrt();
    // The sheet's cell along the tube: -(n + 2m) a + (2n + m) b, which is sqrt(3) |c| long.
    let cells = length / lattice / (3.0_f64.sqrt() * circumference);
    let end = [-((n + 2 * m) as f64) * cells, (2 * n + m) as f64 * cells];
    let reach = |axis: usize, along: i64| {
        let corners = [0.0, along as f64, end[axis], along as f64 + end[axis]];
        let low = corners.iter().fold(0.0_f64, |low, &c| low.min(c)).floor() as i64;
        let high = corners.iter().fold(0.0_f64, |high, &c| high.max(c)).ceil() as i64;
        low - 1..=high + 1
    };
    let mut atoms = Vec::new();
    for i in reach(0, n) {
        for j in reach(1, m) {
            // Two atoms per cell, a third of its diagonal apart; integers count thirds.
            for (i, j) in [(3 * i, 3 * j), (3 * i + 1, 3 * j + 1)] {
                let around = i * (2 * n + m) + j * (n + 2 * m);
                let along = n * j - m * i;
                let z = along as f64 * 3.0_f64.sqrt() / 6.0 / circumference * lattice;
                // Exact, so that no atom is there twice where the sheet closes.
                if (0..6 * square).contains(&around) && (0.0..length).contains(&z) {
                    atoms.push((along, around, z));
                }
            }
        }
    }
    atoms.sort_unstable_by_key(|&(along, around, _)| (along, around));
    let radius = circumference * lattice / TAU;
    let on_tube = |(_, around, z): (i64, i64, f64)| {
        let (sin, cos) = libm::sincos(TAU * around as f64 / (6 * square) as f64);
        DVec3::new(radius * cos, radius * sin, z)
    };
    carbon(
        atoms.into_iter().map(on_tube).collect(),
        MoleculeStyle::SpaceFilling,
    )
}
