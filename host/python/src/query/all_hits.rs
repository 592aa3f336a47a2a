//! All hits of rays.

use super::{
    BATCH, Closest, Found, How, Met, NONE, Nearest, Question, ask_some, chunks_of, each_chunk, fill,
};
use crate::rays::{Rays, Ready, prepare};
#[cfg(target_arch = "x86_64")]
use gridel_core::SimdLevel;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Fixed, Format, HitList, NoCount, Number, PrimitiveHit, Ray, Scene, Stack, Structure,
    Wide, all_hits,
};
#[cfg(target_arch = "x86_64")]
use gridel_host::simd;
use gridel_host::trace::{Frame, SceneRay};
use std::collections::TryReserveError;
use std::ops::Range;

/// Hits that are listed at a time.
const LISTED: usize = 16;

/// Returns the number of hits of each ray; 0 for an invalid ray.
pub fn count(scene: &Scene<'_>, rays: Rays<'_>, how: How) -> Result<Vec<u32>, TryReserveError> {
    fill(how, rays.len(), 0, |start, answers| {
        dispatch!(how, count_chunk, [], (scene, rays, start, answers));
    })
}

fn count_chunk<N: Number, A: Accel>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    start: usize,
    answers: &mut [u32],
) {
    let frame = Frame::of(scene);
    for (number, answer) in (start..).zip(answers) {
        if let Ok((ray, _)) = prepare::<N>(scene, &frame, &rays.get(number)) {
            each_hit::<N, A>(scene, &ray, |_| *answer += 1);
        }
    }
}

/// Calls a function with all hits of a ray.
#[inline(always)]
pub(super) fn each_hit<N: Number, A: Accel>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    mut hit: impl FnMut(&PrimitiveHit<N>),
) {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut list = HitList::<N, LISTED>::new();
    loop {
        let more =
            all_hits::<N, A, _, LISTED>(scene, ray, stack.as_view(), &mut list, &mut NoCount);
        list.iter().for_each(&mut hit);
        if !more {
            return;
        }
    }
}

/// All hits, ray by ray in order, each with the number of its ray.
pub fn all(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
) -> Result<Vec<(usize, Found)>, TryReserveError> {
    let chunks = each_chunk(how, chunks_of(rays.len()), |numbers| {
        all_of::<Closest>(scene, rays, how, numbers)
    });
    let chunks = chunks.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut all = Vec::new();
    all.try_reserve_exact(chunks.iter().map(Vec::len).sum())?;
    chunks.iter().for_each(|chunk| all.extend_from_slice(chunk));
    Ok(all)
}

/// All hits of some rays.
fn all_of<Q: Question<Answer = Found>>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    numbers: Range<usize>,
) -> Result<Vec<(usize, Found)>, TryReserveError> {
    #[cfg(target_arch = "x86_64")]
    if let (Format::F32, Structure::Wide, SimdLevel::Avx2(avx2)) =
        (how.format, how.structure, simd::level())
    {
        return avx2.call(
            #[inline(always)]
            |_, scene, rays, numbers, (), ()| all_inline::<f32, Wide, Q>(scene, rays, numbers),
            (scene, rays, numbers, (), ()),
        );
    }
    dispatch!(how, all_chunk, [Q], (scene, rays, numbers))
}

fn all_chunk<N: Number, A: Accel, Q: Question<Answer = Found>>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    numbers: Range<usize>,
) -> Result<Vec<(usize, Found)>, TryReserveError> {
    all_inline::<N, A, Q>(scene, rays, numbers)
}

#[inline(always)]
fn all_inline<N: Number, A: Accel, Q: Question<Answer = Found>>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    numbers: Range<usize>,
) -> Result<Vec<(usize, Found)>, TryReserveError> {
    let frame = Frame::of(scene);
    let mut all = Vec::new();
    all.try_reserve(2 * numbers.len())?;
    let mut reserved = Ok(());
    let mut ready: Vec<Ready<N>> = Vec::with_capacity(BATCH);
    for first in numbers.clone().step_by(BATCH) {
        let batch = first..numbers.end.min(first + BATCH);
        rays.fill((scene, &frame), batch.clone(), &mut ready);
        for (number, ready) in batch.zip(&ready) {
            let Ok((ray, scale)) = ready else { continue };
            each_hit::<N, A>(scene, ray, |hit| {
                let hit = Some(hit);
                let met = Met {
                    scene,
                    ray,
                    scale,
                    hit,
                };
                let hit = Q::hit(met);
                // Without one where the t of a plane leaves double precision.
                if hit.primitive != NONE && reserved.is_ok() {
                    reserved = all.try_reserve(1);
                    if reserved.is_ok() {
                        all.push((number, hit));
                    }
                }
            });
        }
        reserved.clone()?;
    }
    Ok(all)
}

/// Places, numbers of rays and triangles.
pub type Locations = (Vec<[f64; 3]>, Vec<i64>, Vec<i64>);

/// Where rays meet triangles: at most so many of each ray, or the first alone. Chunk by chunk.
///
/// `place` gives the t and the place of a hit. A triangle that would come before the one that is hit before it, because
/// the lattice moved both, is met in the same place.
pub fn locations(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    multiple_hits: bool,
    max_hits: Option<usize>,
    place: impl Fn(&SceneRay, &Found) -> (f64, [f64; 3]) + Sync,
) -> Result<Vec<Locations>, TryReserveError> {
    let most = max_hits.unwrap_or(usize::MAX);
    let chunks = each_chunk(how, chunks_of(rays.len()), |numbers| {
        let mut hits = Vec::new();
        if multiple_hits {
            hits = all_of::<Nearest>(scene, rays, how, numbers)?;
        } else {
            let mut first = vec![Found::MISS; numbers.len()];
            ask_some::<Nearest>(scene, rays, how, (numbers.start, &mut first));
            let met = numbers.zip(first);
            hits.extend(met.filter(|(_, hit)| hit.primitive != NONE));
        }
        let mut locations = Locations::default();
        locations.0.try_reserve_exact(hits.len())?;
        locations.1.try_reserve_exact(hits.len())?;
        locations.2.try_reserve_exact(hits.len())?;
        let (mut last, mut of_ray) = (usize::MAX, 0);
        let mut farthest = (f64::NEG_INFINITY, [0.0; 3]);
        for (number, hit) in &hits {
            of_ray = if *number == last { of_ray + 1 } else { 1 };
            last = *number;
            if of_ray > most {
                continue;
            }
            let met = place(&rays.get(*number), hit);
            if of_ray == 1 || met.0 > farthest.0 {
                farthest = met;
            }
            locations.0.push(farthest.1);
            locations.1.push(*number as i64);
            locations.2.push(hit.primitive.into());
        }
        Ok(locations)
    });
    chunks.into_iter().collect()
}
