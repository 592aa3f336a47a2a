//! Diamond crystals.

use super::carbon;
use crate::scene::{MoleculeStyle, Scene};
use glam::DVec3;

/// The edge of diamond's cubic cell in angstroms, at room temperature.
const LATTICE_CONSTANT: f64 = 3.567;

/// Radii in angstroms of the crystals with about as many atoms.
pub const DIAMOND_2_800: f64 = 15.6;
pub const DIAMOND_27_000: f64 = 33.2;

/// Returns a ball cut out of a diamond crystal around one of its atoms, space-filling; `radius` is in
/// angstroms.
pub fn diamond(radius: f64) -> Scene {
    // All atoms lie at whole quarters of the cell's edge. Where these are even, they form a
    // face-centered lattice. Where they are odd, they form another one, shifted by a quarter of the
    // diagonal.
    let quarter = LATTICE_CONSTANT / 4.0;
    let reach = (radius / quarter).floor() as i64;
    let within = (radius / quarter) * (radius / quarter);
    let mut atoms = Vec::new();
    for z in -reach..=reach {
        for y in -reach..=reach {
            for x in -reach..=reach {
                let parity = x.rem_euclid(2);
                let alike = y.rem_euclid(2) == parity && z.rem_euclid(2) == parity;
                let on_lattice = alike && (x + y + z).rem_euclid(4) == 3 * parity;
                if on_lattice && (x * x + y * y + z * z) as f64 <= within {
                    atoms.push(quarter * DVec3::new(x as f64, y as f64, z as f64));
                }
            }
        }
    }
    carbon(atoms, MoleculeStyle::SpaceFilling)
}
