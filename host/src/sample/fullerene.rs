//! Buckminsterfullerene, C60.

use super::carbon;
use crate::scene::{MoleculeStyle, Scene};
use glam::DVec3;

/// Bond lengths in angstroms between two hexagons and between a hexagon and a pentagon, as
/// electron diffraction finds them (K. Hedberg et al., *Science* 254 (1991) 410).
const HEXAGON_HEXAGON: f64 = 1.40;
const HEXAGON_PENTAGON: f64 = 1.46;

/// Returns the football of 60 atoms and 90 bonds, as balls and sticks.
///
/// It is a truncated icosahedron. On each of its edges two atoms remain, and the atoms around a
/// corner form a pentagon. The pentagon's edges are as long as the cut-off pieces, since the faces
/// are equilateral.
pub fn c60() -> Scene {
    let edge = HEXAGON_HEXAGON + 2.0 * HEXAGON_PENTAGON;
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut corners = Vec::new();
    for (one, other) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        // The edges of this icosahedron are 2 long.
        let (short, long) = (one * edge / 2.0, other * golden * edge / 2.0);
        corners.extend([
            DVec3::new(0.0, short, long),
            DVec3::new(short, long, 0.0),
            DVec3::new(long, 0.0, short),
        ]);
    }
    let mut atoms = Vec::new();
    for &corner in &corners {
        // The next nearest corners are farther by the golden ratio.
        let neighbors = corners
            .iter()
            .filter(|&&other| other != corner && other.distance(corner) < 1.3 * edge);
        atoms.extend(neighbors.map(|&other| corner.lerp(other, HEXAGON_PENTAGON / edge)));
    }
    carbon(atoms, MoleculeStyle::BallAndStick)
}
