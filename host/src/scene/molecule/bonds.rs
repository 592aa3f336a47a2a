//! Finds bonds by distance.

use super::parsed::Site;
use glam::DVec3;
use std::collections::HashMap;

/// Two atoms are bonded if their distance exceeds the sum of their covalent radii by at most this,
/// in angstroms, and is at least [`CLOSEST`]. From E. C. Meng and R. A. Lewis, *J. Comput. Chem.*
/// 12 (1991) 891; also the rule of Open Babel.
const SLACK: f64 = 0.45;

/// Atoms closer than this are copies of each other, not neighbors: no bond is so short (H-H is
/// 0.74).
const CLOSEST: f64 = 0.4;

/// The most atoms that a cell can hold. A cell is at most 4.6 angstroms wide (for lanthanum). Even
/// in hydrogen as dense as in Jupiter's core an atom takes more than 0.1 cubic angstroms. Files in
/// which all atoms lie in one point exist, and must not take quadratic time.
const MOST_IN_CELL: usize = 1000;

/// The most bonds that are collected; their sticks would fit into no memory.
const MOST_BONDS: usize = 1 << 24;

/// Returns the bonds between sites, each pair once with the lower index first. Also returns the
/// sites that are so crowded that their bonds are not searched for.
///
/// The sites are sorted into cells as wide as the longest possible bond, so that the cost is
/// linear in their number.
pub(crate) fn perceive(sites: &[Site]) -> (Vec<[u32; 2]>, Vec<u32>) {
    let radius = |index: u32| sites[index as usize].element.covalent();
    let bonding = || (0..sites.len() as u32).filter(|&index| radius(index).is_some());
    let longest = 2.0 * bonding().filter_map(radius).fold(0.0, f64::max) + SLACK;
    let cell = |position: DVec3| (position / longest).floor().to_array().map(|c| c as i64);

    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for index in bonding() {
        cells
            .entry(cell(sites[index as usize].position))
            .or_default()
            .push(index);
    }
    let mut crowded: Vec<u32> = cells
        .values()
        .filter(|cell| cell.len() > MOST_IN_CELL)
        .flatten()
        .copied()
        .collect();
    crowded.sort_unstable();
    cells.retain(|_, cell| cell.len() <= MOST_IN_CELL);

    let mut bonds = Vec::new();
    for a in bonding() {
        let site = sites[a as usize];
        let own = cell(site.position);
        if !cells.contains_key(&own) {
            continue;
        }
        if bonds.len() > MOST_BONDS {
            break;
        }
        for offset in 0..27 {
            let step = [offset % 3 - 1, offset / 3 % 3 - 1, offset / 9 - 1];
            let beside = std::array::from_fn(|axis| own[axis].saturating_add(step[axis]));
            let Some(near) = cells.get(&beside) else {
                continue;
            };
            for &b in near.iter().filter(|&&b| b > a) {
                let (Some(r), Some(s)) = (radius(a), radius(b)) else {
                    continue;
                };
                let distance = site.position.distance(sites[b as usize].position);
                if (CLOSEST..=r + s + SLACK).contains(&distance) {
                    bonds.push([a, b]);
                }
            }
        }
    }
    bonds.sort_unstable();
    // At coordinates beyond the range of cells several steps lead to the same cell.
    bonds.dedup();
    (bonds, crowded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::molecule::Element;

    fn site(symbol: &str, x: f64, y: f64, z: f64) -> Site {
        Site {
            element: Element::from_symbol(symbol).unwrap(),
            position: DVec3::new(x, y, z),
        }
    }

    #[test]
    fn hydrogens_bond_to_oxygens_and_an_ion_to_nothing() {
        let sites = [
            site("O", 0.0, 0.0, 0.0),
            site("H", 0.9572, 0.0, 0.0),
            site("H", -0.24, 0.9266, 0.0),
            site("Na", 0.0, 0.0, 2.4),
            site("O", 0.0, 0.0, 0.1),
        ];
        let (bonds, crowded) = perceive(&sites);
        assert_eq!(bonds, [[0, 1], [0, 2], [1, 4], [2, 4]]);
        assert!(crowded.is_empty());
    }

    #[test]
    fn bonds_cross_cells_and_signs() {
        for shift in [-1e6, -2.0, -1.3, 0.0, 0.7, 1e6] {
            let sites = [
                site("C", shift, 0.0, 0.0),
                site("C", shift + 1.54, 0.0, 0.0),
            ];
            assert_eq!(perceive(&sites).0, [[0, 1]], "{shift}");
        }
    }

    #[test]
    fn a_heap_of_atoms_takes_no_quadratic_time() {
        let sites = vec![site("C", 0.0, 0.0, 0.0); 200_000];
        let (bonds, crowded) = perceive(&sites);
        assert_eq!((bonds.len(), crowded.len()), (0, 200_000));
    }

    #[test]
    fn only_near_atoms_at_places_without_bound_are_bonded() {
        let sites = [
            site("C", 1e300, 0.0, 0.0),
            site("C", -1e300, 1e308, 0.0),
            site("C", 1e300, 0.0, 1.5),
        ];
        assert_eq!(perceive(&sites).0, [[0, 2]]);
    }
}
