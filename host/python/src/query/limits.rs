//! Limits of rays, which hold for the t that is returned.
//!
//! The t of a triangle of arrays is computed from its vertices as they were given; the search knows it as the lattice
//! moved it. So rays are searched a little beyond their limits, and what is found is compared with them.

use super::lists::Lists;
use super::{Any, Hit, How, NONE, Nearest, ask, ask_some, bare, fill, with_normal};
use crate::rays::{Rays, prepare};
use gridel_core::accel::DynAccel;
use gridel_core::{Accel, Fixed, Format, Number, Scene, Structure, Wide};
use gridel_host::trace::{Frame, SceneRay};
use std::collections::TryReserveError;
use std::ops::ControlFlow;

/// Gives the t of a hit, from the ray as it is searched.
pub type Place<'p> = dyn Fn(&SceneRay, &Hit) -> f64 + Sync + 'p;

/// Rays whose hits are found before they are compared.
const COMPARED: usize = 256;

/// Returns whether each ray hits anything within its limits.
pub fn any(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    place: &Place<'_>,
) -> Result<Vec<bool>, TryReserveError> {
    if !rays.have_limits() {
        return ask::<Any>(scene, rays, how);
    }
    fill(how, rays.len(), false, |start, answers| {
        for (batch, answers) in answers.chunks_mut(COMPARED).enumerate() {
            let start = start + batch * COMPARED;
            let mut numbers = start..start + answers.len();
            if numbers.all(|number| rays.is_endless(number)) {
                ask_some::<Any>(scene, rays, how, (start, answers));
                continue;
            }
            let hits = &mut [Hit::MISS; COMPARED][..answers.len()];
            ask_some::<Nearest>(scene, rays, how, (start, hits));
            for ((number, hit), answer) in (start..).zip(hits).zip(answers) {
                let ray = rays.searched(number);
                let mut is_within = |hit: &Hit| rays.holds(number, place(&ray, hit));
                *answer = hit.primitive != NONE
                    && (is_within(hit) || first_accepted(scene, rays, how, number, &mut is_within));
            }
        }
    })
}

/// Passes the crossings of a ray to a function, in order, until it accepts one. Returns whether it did.
#[cold]
#[inline(never)]
pub(super) fn first_accepted(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    number: usize,
    accepts: &mut dyn FnMut(&Hit) -> bool,
) -> bool {
    dispatch!(how, accepted_of, [], (scene, rays, number, accepts))
}

fn accepted_of<N: Number, A: Accel>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    number: usize,
    accepts: &mut dyn FnMut(&Hit) -> bool,
) -> bool {
    let ready = prepare::<N>(scene, &Frame::of(scene), &rays.searched(number));
    let Ok((ray, scale)) = ready else {
        return false;
    };
    let mut accepted = false;
    Lists::new(usize::MAX).each::<A>(scene, &ray, |hit| {
        let hit = with_normal(scene, (&ray, &scale), hit);
        accepted = hit.primitive != NONE && accepts(&hit);
        match accepted {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    });
    accepted
}

/// Returns the number of hits of each ray within its limits; 0 for an invalid ray.
pub fn count(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    place: &Place<'_>,
) -> Result<Vec<u32>, TryReserveError> {
    fill(how, rays.len(), 0, |start, answers| {
        dispatch!(how, count_chunk, [], (scene, rays, place, start, answers));
    })
}

fn count_chunk<N: Number, A: Accel>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    place: &Place<'_>,
    start: usize,
    answers: &mut [u32],
) {
    let frame = Frame::of(scene);
    let mut lists = Lists::new(usize::MAX);
    for (number, answer) in (start..).zip(answers) {
        let searched = rays.searched(number);
        let Ok((ray, scale)) = prepare::<N>(scene, &frame, &searched) else {
            continue;
        };
        lists.each::<A>(scene, &ray, |hit| {
            let hit = bare(scene, (&ray, &scale), hit);
            // Without one where the t of a plane leaves double precision.
            let counts = hit.primitive != NONE
                && (!rays.have_limits() || rays.holds(number, place(&searched, &hit)));
            *answer += u32::from(counts);
            ControlFlow::Continue(())
        });
    }
}
