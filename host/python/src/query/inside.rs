//! Points inside of objects.

use super::lists::Lists;
use super::{How, fill};
use crate::rays::Points;
use glam::DVec3;
use gridel_core::accel::DynAccel;
use gridel_core::{Accel, Fixed, Format, Number, Scene, Solid, Structure, Wide, containment_ray};
use std::collections::TryReserveError;
use std::ops::ControlFlow;

/// When a point is inside.
#[derive(Clone, Copy)]
pub enum Inside<'a> {
    /// In one of these objects, of the scene itself, then of its parts, by their numbers.
    Closed(&'a [bool]),
    /// In an object whose surface is crossed an odd number of times.
    Object,
    /// Where all surfaces together are crossed an odd number of times.
    Scene,
}

/// Returns for each point true if it is inside.
pub fn contains(
    scene: &Scene<'_>,
    points: Points<'_>,
    inside: Inside<'_>,
    how: How,
) -> Result<Vec<bool>, TryReserveError> {
    fill(how, points.len(), false, |start, answers| {
        dispatch!(
            how,
            contains_chunk,
            [],
            (scene, points, inside, start, answers)
        );
    })
}

fn contains_chunk<N: Number, A: Accel>(
    scene: &Scene<'_>,
    points: Points<'_>,
    inside: Inside<'_>,
    start: usize,
    answers: &mut [bool],
) {
    let header = scene.header();
    let origin = DVec3::from_array(header.origin);
    let per_unit = f64::powi(2.0, -i32::from(header.unit_exponent));
    let is_closed = |object: u32| match inside {
        Inside::Closed(closed) => closed.get(object as usize).is_some_and(|&closed| closed),
        Inside::Object | Inside::Scene => true,
    };
    let is_single =
        matches!(inside, Inside::Scene) || header.objects == 1 && scene.instances().is_empty();
    // Solids that are crossed an odd number of times so far.
    let mut odd: Vec<Solid> = Vec::new();
    let mut lists = Lists::new(usize::MAX);
    for (number, answer) in (start..).zip(answers) {
        let units = (points.get(number) - origin) * per_unit;
        // A number format may make a number of NaN.
        if !units.is_finite() {
            continue;
        }
        let units = units.to_array().map(N::far_from_f64);
        let Ok(Some(ray)) = containment_ray::<N>(scene, units) else {
            continue;
        };
        odd.clear();
        let mut is_odd = false;
        lists.each::<A>(scene, &ray, |hit| {
            if !hit.encloses() {
                return ControlFlow::Continue(());
            }
            if is_single {
                is_odd = !is_odd;
                return ControlFlow::Continue(());
            }
            let solid = Solid::of_hit(scene, hit);
            if let Some(place) = odd.iter().position(|&it| it == solid) {
                odd.swap_remove(place);
            } else if is_closed(solid.object) {
                odd.push(solid);
            }
            ControlFlow::Continue(())
        });
        *answer = is_odd && is_closed(0) || !odd.is_empty();
    }
}
