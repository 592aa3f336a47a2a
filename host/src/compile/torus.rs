//! Tori on the lattice, their boxes, and how far that moves their surfaces.

use super::direction;
use super::displacement::ROUNDED_UP;
use super::lattice::Lattice;
use super::solids::{Snapped, around, disc_reach, real};
use glam::DVec3;
use gridel_core::geometry::torus::Torus;

/// How far a torus with an axis reaches from its centre along each axis of coordinates.
pub fn reach(axis: DVec3, [major, minor]: [f64; 2]) -> DVec3 {
    disc_reach(axis) * major + minor
}

/// `None` if the minor radius is less than half a step. A major radius of less than half a step becomes
/// 0, and the torus a sphere.
pub fn snapped(
    (center, axis): (DVec3, DVec3),
    radii: [f64; 2],
    lattice: &Lattice,
) -> Option<Snapped<Torus>> {
    let snapped_center = lattice.snap(center);
    let snapped_axis = direction::integers(axis);
    let [major_radius, minor_radius] = radii.map(|radius| lattice.snap_length(radius));
    if minor_radius == 0 {
        return None;
    }
    let snapped_radii = [major_radius, minor_radius].map(f64::from);
    let reach = reach(real(snapped_axis), snapped_radii);
    let (bounds, fits) = around(&[(snapped_center, reach)]);
    Some(Snapped {
        record: Torus {
            center: snapped_center,
            axis: snapped_axis,
            major_radius,
            minor_radius,
            bounds,
        },
        displacement: displacement(
            (lattice.in_fine(center), real(snapped_center)),
            (axis, real(snapped_axis)),
            (
                radii.map(|radius| lattice.length_in_fine(radius)),
                snapped_radii,
            ),
        ),
        fits,
    })
}

/// How far two tori are apart at most: as far as their circles and their minor radii. Circles are at most
/// as far apart as their centres, their radii and the ends of their axes, of the smaller radius's length.
///
/// From a point beneath a surface the way outward is as short, unless it comes to the axis before, in the
/// pit of a spindle torus: then it goes on along the axis.
fn displacement(
    (center, other_center): (DVec3, DVec3),
    axes: (DVec3, DVec3),
    radii: ([f64; 2], [f64; 2]),
) -> f64 {
    let ([major, minor], [other_major, other_minor]) = radii;
    let unit = |v: DVec3| (v / v.abs().max_element()).normalize();
    let turned = unit(axes.0).distance(unit(axes.1)) * major.min(other_major);
    let circles = center.distance(other_center) + (major - other_major).abs() + turned;
    let apart = circles + (minor - other_minor).abs();
    let along_axis = |[major, minor]: [f64; 2]| {
        let height = |r: f64| ((r - major).max(0.0) * (r + major)).sqrt();
        height(minor) - height((minor - apart).max(0.0))
    };
    (apart + along_axis(radii.0).max(along_axis(radii.1))) * ROUNDED_UP
}
