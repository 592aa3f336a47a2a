//! Rays from inside of closed meshes, which none can leave without a hit.

use super::ask::ask;
use super::closed::ClosedMesh;
use super::judge::Judge;
use super::property::{Fault, Property};
use super::rounded::RoundedRay;
use crate::random::Random;
use crate::shape::rounding::step;
use glam::DVec3;
use gridel_core::{Accel, Format, List, Number, Ray, Scene};

/// A place inside of a closed mesh, in units.
#[derive(Clone, Copy)]
pub(super) struct Inside {
    place: [f64; 3],
    /// Distance from the faces before and behind it.
    clearance: f64,
}

/// A ray from the inside of a closed mesh, in units.
pub(super) struct Aim<'m> {
    pub(super) mesh: &'m ClosedMesh,
    pub(super) origin: [f64; 3],
    pub(super) direction: [f64; 3],
    clearance: f64,
}

impl Aim<'_> {
    /// Returns whether the ray starts inside in a format, too. Where a mesh is thinner than the bound of its faces, the
    /// format has no place inside to start from.
    pub(super) fn is_inside(&self, format: Format) -> bool {
        let magnitude = DVec3::from_array(self.origin).abs().max_element();
        self.clearance > 16.0 * step(format, magnitude)
    }
}

/// Returns a ray at a vertex, along an edge or at a face of one of the meshes, from the point inside of it. All
/// triangles take their turn, then all again with other targets.
pub(super) fn aim<'m>(
    inside: &[(&'m ClosedMesh, Inside)],
    number: u64,
    random: &mut Random,
) -> Option<Aim<'m>> {
    let number = number as usize;
    let &(
        mesh,
        Inside {
            place: origin,
            clearance,
        },
    ) = inside.get(number.checked_rem(inside.len())?)?;
    let turn = number / inside.len();
    let [a, b, c] = mesh.triangle(turn % mesh.count());
    let mix = |a: [f64; 3], b: [f64; 3], part: f64| {
        [0, 1, 2].map(|axis| a[axis] + part * (b[axis] - a[axis]))
    };
    let target = match (turn / mesh.count() + turn) % 4 {
        0 => a,
        1 => mix(a, b, 0.5),
        2 => mix(b, c, random.unit()),
        _ => mix(a, mix(b, c, random.unit()), random.unit()),
    };
    let direction = [0, 1, 2].map(|axis| target[axis] - origin[axis]);
    (direction != [0.0; 3]).then_some(Aim {
        mesh,
        origin,
        direction,
        clearance,
    })
}

/// Returns a place inside of a closed mesh: halfway from a face to the opposite one.
pub(super) fn inside(scene: &Scene<'_>, mesh: &ClosedMesh) -> Option<Inside> {
    const TRIED: usize = 64;
    let step = mesh.count().div_ceil(TRIED);
    let places = (0..mesh.count()).step_by(step).filter_map(|index| {
        let [a, b, c] = mesh.triangle(index).map(DVec3::from_array);
        let middle = (a + b + c) / 3.0;
        let inward = -(b - a).cross(c - a);
        let ray = |tmin| {
            Ray::<f64>::from_f64(
                scene.bounds(),
                middle.to_array(),
                inward.to_array(),
                tmin,
                f64::INFINITY,
            )
        };
        // Past the face itself, and past surfaces of other objects.
        let mut tmin = 1.0 / 1024.0;
        for _ in 0..64 {
            let hit = ask::<f64, List>(scene, &ray(tmin).ok()?).hit?;
            if mesh.holds(&hit) {
                let depth = 0.5 * hit.t / inward.abs().max_element();
                let found = Inside {
                    place: (middle + inward * depth).to_array(),
                    clearance: (inward * depth).length(),
                };
                return (!hit.front).then_some((hit.t, found));
            }
            tmin = hit.t + 1.0 / 1024.0;
        }
        None
    });
    places
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, found)| found)
}

/// Follows a ray that starts inside of a closed mesh until it hits the mesh. A ray that never does is a fault.
pub fn sealed<N: Number, A: Accel>(
    scene: &Scene<'_>,
    judge: &Judge,
    mesh: &ClosedMesh,
    origin: [f64; 3],
    direction: [f64; 3],
) -> Option<Fault> {
    /// Surfaces of other objects that a ray is followed through.
    const MOST: usize = 256;
    let mut tmin = 0.0;
    // Where, and how far the ray was moved on.
    let mut passed: Vec<(f64, f64)> = Vec::new();
    let whole = Ray::<N>::from_f64(scene.bounds(), origin, direction, 0.0, f64::INFINITY).ok()?;
    let rounded = RoundedRay::of(&whole);
    for _ in 0..MOST {
        let ray =
            Ray::<N>::from_f64(scene.bounds(), origin, direction, tmin, f64::INFINITY).ok()?;
        let Some(hit) = ask::<N, A>(scene, &ray).hit else {
            // Where surfaces coincide, only one of them was reported.
            let crosses = |&(t, moved_on): &(f64, f64)| {
                let t = t - rounded.moved;
                mesh.hits(scene)
                    .any(|hit| judge.crosses(N::FORMAT, hit, &rounded, t, moved_on))
            };
            let hidden = passed.iter().any(crosses);
            let what = format!("leaves the closed mesh of {mesh} without a hit");
            return (!hidden).then(|| Fault::of::<N>(Property::Leaks, A::STRUCTURE, what));
        };
        if mesh.holds(&hit) {
            return None;
        }
        let t = N::far_to_f64(hit.t);
        let on = 4.0 * step(N::FORMAT, t.abs().max(1.0)).max(hit.error.length_to_f64());
        passed.push((t, on));
        tmin = t + on;
    }
    None
}
