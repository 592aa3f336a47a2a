//! Questions about rays in `f32` through `wide` with AVX2: four are made ready at once, and everything is compiled for
//! AVX2.

use super::{BATCH, FirstHit, Question, ask_chunk};
use crate::rays::Rays;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{Scene, Stack, Wide};
use gridel_cpu::Avx2;
use gridel_host::trace::{Four, Frame};
use std::array;

/// Answers a question about some rays, as [`ask_chunk`] does.
#[inline(always)]
pub fn ask<Q: Question>(
    avx2: Avx2,
    scene: &Scene<'_>,
    rays: Rays<'_>,
    start: usize,
    answers: &mut [Q::Answer],
) {
    let frame = &Frame::of(scene);
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut batch: [Four; BATCH / 4] = array::from_fn(|_| Four::empty());
    let mut met = [None; BATCH];
    for (number, answers) in answers.chunks_mut(BATCH).enumerate() {
        let first = start + number * BATCH;
        let last = first + answers.len() - 1;
        for (four, ready) in batch.iter_mut().enumerate() {
            // Where there are less than four, the last stands for those that lack.
            let ray = |lane: usize| rays.searched((first + 4 * four + lane).min(last));
            let four = [ray(0), ray(1), ray(2), ray(3)];
            let [a, b, c, d] = &four;
            ready.set_up(avx2, scene, frame, [a, b, c, d]);
        }
        let ready = |place: usize| batch[place / 4].get(place % 4);
        if Q::ANY {
            for (place, answer) in answers.iter_mut().enumerate() {
                let Some((ray, scale)) = ready(place) else {
                    one::<Q>(scene, rays, first + place, answer);
                    continue;
                };
                if ray.any_hit(scene, stack.as_view()) {
                    let (ray, scale) = (ray.ray(), &scale);
                    let hit = None;
                    *answer = Q::hit(FirstHit {
                        scene,
                        ray,
                        scale,
                        hit,
                    });
                }
            }
            continue;
        }
        for (place, met) in met[..answers.len()].iter_mut().enumerate() {
            *met = match ready(place) {
                Some((ray, _)) => ray.closest_primitive(scene, stack.as_view()),
                None => None,
            };
        }
        for (place, answer) in answers.iter_mut().enumerate() {
            let Some((ray, scale)) = ready(place) else {
                one::<Q>(scene, rays, first + place, answer);
                continue;
            };
            if let Some(hit) = &met[place] {
                let (ray, scale, hit) = (ray.ray(), &scale, Some(hit));
                *answer = Q::hit(FirstHit {
                    scene,
                    ray,
                    scale,
                    hit,
                });
            }
        }
    }
}

/// Answers a question about one ray of any kind.
#[cold]
#[inline(never)]
fn one<Q: Question>(scene: &Scene<'_>, rays: Rays<'_>, number: usize, answer: &mut Q::Answer) {
    ask_chunk::<f32, Wide, Q>(scene, rays, number, std::slice::from_mut(answer));
}
