//! Spheres, boxes, discs and cones on the lattice, and how far that moves their surfaces.

use super::direction;
use super::displacement::{self, FlatDisc, Frustum};
use super::lattice::Lattice;
use glam::DVec3;
use gridel_core::format::record::UnitBox;
use gridel_core::geometry::{cone::Cone, cuboid::Cuboid, disc::Disc};

/// Steps that the surface of a cone may be moved before a better axis is searched for: what rounds
/// its points and radii, and some lean.
const GOOD: f64 = 2.0;

/// A sphere in 1/256 unit.
#[derive(Clone, Copy, Debug)]
pub struct SnappedSphere {
    pub center: [i32; 3],
    pub radius: i32,
}

/// A shape on the lattice.
#[derive(Clone, Copy, Debug)]
pub struct Snapped<T> {
    pub record: T,
    /// How far apart the given and the snapped surface are at most, in 1/256 unit.
    pub displacement: f64,
    /// Whether its box lies in the range of box coordinates.
    pub fits: bool,
}

pub(super) fn real(point: [i32; 3]) -> DVec3 {
    DVec3::from_array(point.map(f64::from))
}

fn integers(point: DVec3) -> [i32; 3] {
    point.to_array().map(|x| x as i32)
}

/// How far a unit disc with a normal reaches along each axis.
pub fn disc_reach(normal: DVec3) -> DVec3 {
    let normal = (normal / normal.abs().max_element()).normalize();
    (DVec3::ONE - normal * normal)
        .max(DVec3::ZERO)
        .map(f64::sqrt)
}

/// `None` if the radius is less than half a step.
pub fn sphere(center: DVec3, radius: f64, lattice: &Lattice) -> Option<Snapped<SnappedSphere>> {
    let given = (lattice.in_fine(center), lattice.length_in_fine(radius));
    let record = SnappedSphere {
        center: lattice.snap(center),
        radius: lattice.snap_length(radius),
    };
    (record.radius > 0).then(|| Snapped {
        record,
        displacement: displacement::sphere(given, (real(record.center), record.radius.into())),
        fits: true,
    })
}

pub fn cuboid(corners: [DVec3; 2], lattice: &Lattice) -> Snapped<Cuboid> {
    let [lowest, highest] = corners.map(|corner| lattice.snap(corner));
    Snapped {
        record: Cuboid { lowest, highest },
        displacement: displacement::cuboid(
            corners.map(|corner| lattice.in_fine(corner)),
            [lowest, highest].map(real),
        ),
        fits: true,
    }
}

/// `None` if the radius is less than half a step.
pub fn disc(center: DVec3, normal: DVec3, radius: f64, lattice: &Lattice) -> Option<Snapped<Disc>> {
    let given = FlatDisc {
        center: lattice.in_fine(center),
        normal,
        radius: lattice.length_in_fine(radius),
    };
    let center = lattice.snap(center);
    let normal = direction::integers(normal);
    let radius = lattice.snap_length(radius);
    if radius == 0 {
        return None;
    }
    let snapped = FlatDisc {
        center: real(center),
        normal: real(normal),
        radius: radius.into(),
    };
    let reach = disc_reach(snapped.normal);
    let (bounds, fits) = around(&[(center, reach * snapped.radius)]);
    Some(Snapped {
        record: Disc {
            center,
            normal,
            radius,
            bounds,
        },
        displacement: given.displacement(&snapped),
        fits,
    })
}

/// `None` if both ends are rounded to one point, or both radii to 0.
///
/// `ends` are base and apex, each with its radius. Where rounding both ends to the lattice moves the
/// surface by more than [`GOOD`] steps, because a short axis leans, the ends are those 1/256 units
/// that move it least, whatever the lattice's step.
pub fn cone(ends: [(DVec3, f64); 2], lattice: &Lattice) -> Option<Snapped<Cone>> {
    let given = Frustum {
        ends: ends.map(|(point, radius)| (lattice.in_fine(point), lattice.length_in_fine(radius))),
    };
    let [base, apex] = ends.map(|(point, radius)| Frustum::end(lattice, point, radius));
    if base.0 == apex.0 || base.1 + apex.1 == 0.0 {
        return None;
    }
    let mut snapped = Frustum { ends: [base, apex] };
    let mut displacement = given.displacement(&snapped);
    if displacement > GOOD * lattice.fine_steps() {
        (snapped, displacement) = straightest(&given, (snapped, displacement));
    }
    let [(base, base_radius), (apex, apex_radius)] = snapped.ends;
    let reach = disc_reach(apex - base);
    let [base, apex] = [base, apex].map(integers);
    let (bounds, fits) = around(&[(base, reach * base_radius), (apex, reach * apex_radius)]);
    Some(Snapped {
        record: Cone {
            base,
            apex,
            base_radius: base_radius as i32,
            apex_radius: apex_radius as i32,
            bounds,
        },
        displacement,
        fits,
    })
}

impl Frustum {
    /// A point and a radius, rounded to the lattice, in 1/256 unit.
    fn end(lattice: &Lattice, point: DVec3, radius: f64) -> (DVec3, f64) {
        (
            real(lattice.snap(point)),
            lattice.snap_length(radius).into(),
        )
    }
}

/// The frustum with ends and radii in 1/256 unit that is the least displaced from the given one, or
/// `best` if that is better.
///
/// Tries axes of all lengths along the major axis of the given one, from its own length on, and
/// rounds the other two components: a longer axis leans less, and moves the caps. So a length needs
/// no trial once the caps alone are moved by more than in the best one so far. For a coin of radius
/// r that bounds the number of trials by some multiple of the root of r, below 10,000.
fn straightest(given: &Frustum, mut best: (Frustum, f64)) -> (Frustum, f64) {
    let [(base, base_radius), (apex, apex_radius)] = given.ends;
    let (axis, middle) = (apex - base, (base + apex) * 0.5);
    let (height, length) = (axis.length(), axis.abs().max_element());
    let first = length.round().max(1.0);
    let longer = std::iter::successors(Some(first), |length| Some(length + 1.0));
    let shorter = std::iter::successors(Some(first - 1.0), |length| Some(length - 1.0));
    let mut try_all = |lengths: &mut dyn Iterator<Item = f64>| {
        for trial in lengths.take_while(|&trial| trial >= 1.0) {
            let scale = trial / length;
            // Rounding adds less than 1 to the axis.
            if ((scale - 1.0).abs() * height - 1.0) * 0.5 >= best.1 {
                return;
            }
            let axis = (axis * scale).round();
            let base = (middle - axis * 0.5).round();
            let trial = Frustum {
                ends: [
                    (base, base_radius.round()),
                    (base + axis, apex_radius.round()),
                ],
            };
            let displacement = given.displacement(&trial);
            if displacement < best.1 {
                best = (trial, displacement);
            }
        }
    };
    try_all(&mut longer.into_iter());
    try_all(&mut shorter.into_iter());
    best
}

/// The box around points with a reach along each axis, rounded outward by more than the reach can
/// be off, and whether it lies in the range of box coordinates.
pub(super) fn around(points: &[([i32; 3], DVec3)]) -> (UnitBox, bool) {
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
