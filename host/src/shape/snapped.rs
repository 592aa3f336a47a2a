//! Shapes on the lattice, and their boxes.

use glam::DVec3;
use gridel_core::format::record::UnitBox;

/// Factor that makes a computed displacement an upper bound in spite of rounding.
pub const ROUNDED_UP: f64 = 1.0 + 1e-12;

/// A shape on the lattice.
#[derive(Clone, Copy, Debug)]
pub struct Snapped<T> {
    pub record: T,
    /// Largest distance between the given and the snapped surface, in 1/256 unit.
    pub displacement: f64,
    /// True if its box lies in the range of box coordinates.
    pub fits: bool,
}

pub fn real(point: [i32; 3]) -> DVec3 {
    DVec3::from_array(point.map(f64::from))
}

pub fn integers(point: DVec3) -> [i32; 3] {
    point.to_array().map(|x| x as i32)
}

/// Converts a point from 1/256 unit to units.
pub fn units(fine: [i32; 3]) -> DVec3 {
    real(fine) / 256.0
}

/// Returns the reach of a unit disc with a normal along each axis.
pub fn disc_reach(normal: DVec3) -> DVec3 {
    let normal = (normal / normal.abs().max_element()).normalize();
    (DVec3::ONE - normal * normal)
        .max(DVec3::ZERO)
        .map(f64::sqrt)
}

/// Returns the box around points with a reach along each axis, and whether it lies in the range of
/// box coordinates. The box is rounded outward by more than the error of the reach.
pub fn around(points: &[([i32; 3], DVec3)]) -> (UnitBox, bool) {
    const MOST: f64 = (i16::MAX as i32 * 256) as f64;
    let ends = points.iter().map(|&(center, reach)| {
        let slack = reach * 1e-9;
        (
            (real(center) - reach - slack).floor(),
            (real(center) + reach + slack).ceil(),
        )
    });
    let (lowest, highest) = ends
        .reduce(|(low, high), (other_low, other_high)| (low.min(other_low), high.max(other_high)))
        .unwrap_or_default();
    let fits = lowest.abs().max(highest.abs()).max_element() <= MOST;
    (UnitBox::around(integers(lowest), integers(highest)), fits)
}

/// Returns an upper bound of the distance that a point is moved.
pub fn displacement(given: DVec3, snapped: [i32; 3]) -> f64 {
    given.distance(real(snapped)) * ROUNDED_UP
}
