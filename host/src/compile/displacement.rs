//! How far snapping moves a surface: bounds of the distance from any point of either surface, the
//! given and the snapped one, to the other.
//!
//! All shapes are convex, and so the surfaces are as far apart as the solids. For a box that is at
//! most the distance of its corners. A cone is what lies between its two discs, so it is as far from
//! another as the farther pair of discs. Two discs are at most as far apart as their centres, the
//! difference of their radii, and the smaller radius times the sine of the angle between them.

use glam::DVec3;

/// More than the arithmetic here is off, relative.
pub(super) const ROUNDED_UP: f64 = 1.0 + 1e-12;

/// A disc; the normal has any length.
#[derive(Clone, Copy, Debug)]
pub struct FlatDisc {
    pub center: DVec3,
    pub normal: DVec3,
    pub radius: f64,
}

impl FlatDisc {
    pub fn displacement(&self, other: &Self) -> f64 {
        // Scaled, so that squares stay in range.
        let [n, m] = [self.normal, other.normal].map(|it| it / it.abs().max_element());
        let sine = n.cross(m).length() / (n.length() * m.length());
        let turned = sine * self.radius.min(other.radius);
        let round = self.center.distance(other.center) + (self.radius - other.radius).abs();
        (round + turned) * ROUNDED_UP
    }
}

/// A cone between two discs; `ends` are base and apex, each with its radius.
#[derive(Clone, Copy, Debug)]
pub struct Frustum {
    pub ends: [(DVec3, f64); 2],
}

impl Frustum {
    pub fn displacement(&self, other: &Self) -> f64 {
        let discs = |frustum: &Self| {
            let [base, apex] = frustum.ends;
            let normal = apex.0 - base.0;
            frustum.ends.map(|(center, radius)| FlatDisc {
                center,
                normal,
                radius,
            })
        };
        let (these, others) = (discs(self), discs(other));
        these[0]
            .displacement(&others[0])
            .max(these[1].displacement(&others[1]))
    }
}

pub fn sphere(given: (DVec3, f64), snapped: (DVec3, f64)) -> f64 {
    (given.0.distance(snapped.0) + (given.1 - snapped.1).abs()) * ROUNDED_UP
}

/// Of boxes, given by their lowest and highest corners.
pub fn cuboid(given: [DVec3; 2], snapped: [DVec3; 2]) -> f64 {
    let [low, high] = [0, 1].map(|side: usize| (given[side] - snapped[side]).abs());
    low.max(high).length() * ROUNDED_UP
}

/// Of a point, or of a triangle's corner.
pub fn point(given: DVec3, snapped: [i32; 3]) -> f64 {
    given.distance(DVec3::from_array(snapped.map(f64::from))) * ROUNDED_UP
}
