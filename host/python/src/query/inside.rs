//! Points inside of objects.

use super::all_hits::each_hit;
use super::{How, fill};
use crate::rays::Points;
use glam::DVec3;
use gridel_core::accel::DynAccel;
use gridel_core::{Accel, Fixed, Format, Number, Scene, Solid, Structure, Wide, containment_ray};

/// Which objects are closed: of the scene itself, then of its parts, by their numbers.
pub type Closed<'a> = &'a [bool];

/// Returns whether each point lies in a closed object. If `closed` is `None`, any object whose surface is crossed an
/// odd number of times counts.
pub fn contains(
    scene: &Scene<'_>,
    points: Points<'_>,
    closed: Option<Closed<'_>>,
    how: How,
) -> Vec<bool> {
    fill(how, points.len(), false, |start, answers| {
        dispatch!(
            how,
            contains_chunk,
            [],
            (scene, points, closed, start, answers)
        );
    })
}

fn contains_chunk<N: Number, A: Accel>(
    scene: &Scene<'_>,
    points: Points<'_>,
    closed: Option<Closed<'_>>,
    start: usize,
    answers: &mut [bool],
) {
    let header = scene.header();
    let origin = DVec3::from_array(header.origin);
    let per_unit = f64::powi(2.0, -i32::from(header.unit_exponent));
    let is_closed = |object: u32| match closed {
        Some(closed) => closed.get(object as usize).is_some_and(|&closed| closed),
        None => true,
    };
    let is_single = header.objects == 1 && scene.instances().is_empty();
    // Solids that are crossed an odd number of times so far.
    let mut odd: Vec<Solid> = Vec::new();
    for (number, answer) in (start..).zip(answers) {
        let units = ((points.get(number) - origin) * per_unit).to_array();
        let Ok(Some(ray)) = containment_ray::<N>(scene, units.map(N::far_from_f64)) else {
            continue;
        };
        odd.clear();
        let mut is_odd = false;
        each_hit::<N, A>(scene, &ray, |hit| {
            if !hit.encloses() {
                return;
            }
            if is_single {
                is_odd = !is_odd;
                return;
            }
            let solid = Solid::of_hit(scene, hit);
            if let Some(place) = odd.iter().position(|&it| it == solid) {
                odd.swap_remove(place);
            } else if is_closed(solid.object) {
                odd.push(solid);
            }
        });
        *answer = is_odd && is_closed(0) || !odd.is_empty();
    }
}
