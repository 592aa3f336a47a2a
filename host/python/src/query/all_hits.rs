//! All hits of rays.

use super::lists::Lists;
use super::{
    BATCH, Closest, FirstHit, Hit, How, NONE, Nearest, Question, ask_some, chunks_of, each_chunk,
};
use crate::rays::{Rays, Ready};
#[cfg(target_arch = "x86_64")]
use gridel_core::SimdLevel;
use gridel_core::accel::DynAccel;
use gridel_core::{Accel, Fixed, Format, Number, Scene, Structure, Wide};
#[cfg(target_arch = "x86_64")]
use gridel_host::simd;
use gridel_host::trace::{Frame, SceneRay};
use std::collections::TryReserveError;
use std::ops::{ControlFlow, Range};

/// All hits, ray by ray in order, each with the number of its ray, and with its normal if that is needed.
pub fn all(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    needs_normals: bool,
) -> Result<Vec<(usize, Hit)>, TryReserveError> {
    let chunks = each_chunk(how, chunks_of(rays.len()), |numbers| {
        let numbers = (numbers, usize::MAX);
        if needs_normals {
            all_of::<Closest>(scene, rays, how, numbers)
        } else {
            all_of::<Nearest>(scene, rays, how, numbers)
        }
    });
    let chunks = chunks.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut all = Vec::new();
    all.try_reserve_exact(chunks.iter().map(Vec::len).sum())?;
    chunks.iter().for_each(|chunk| all.extend_from_slice(chunk));
    Ok(all)
}

/// All hits of some rays, or as many of the first hits of each.
fn all_of<Q: Question<Answer = Hit>>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    (numbers, most): (Range<usize>, usize),
) -> Result<Vec<(usize, Hit)>, TryReserveError> {
    #[cfg(target_arch = "x86_64")]
    if let (Format::F32, Structure::Wide, SimdLevel::Avx2(avx2)) =
        (how.format, how.structure, simd::level())
    {
        return avx2.call(
            #[inline(always)]
            |_, scene, rays, numbers, most, ()| {
                all_inline::<f32, Wide, Q>(scene, rays, numbers, most)
            },
            (scene, rays, numbers, most, ()),
        );
    }
    dispatch!(how, all_chunk, [Q], (scene, rays, numbers, most))
}

fn all_chunk<N: Number, A: Accel, Q: Question<Answer = Hit>>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    numbers: Range<usize>,
    most: usize,
) -> Result<Vec<(usize, Hit)>, TryReserveError> {
    all_inline::<N, A, Q>(scene, rays, numbers, most)
}

#[inline(always)]
fn all_inline<N: Number, A: Accel, Q: Question<Answer = Hit>>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    numbers: Range<usize>,
    most: usize,
) -> Result<Vec<(usize, Hit)>, TryReserveError> {
    let frame = Frame::of(scene);
    let mut all = Vec::new();
    all.try_reserve(2 * numbers.len())?;
    let mut reserved = Ok(());
    let mut lists = Lists::new(most);
    let mut ready: Vec<Ready<N>> = Vec::with_capacity(BATCH);
    for first in numbers.clone().step_by(BATCH) {
        let batch = first..numbers.end.min(first + BATCH);
        rays.fill((scene, &frame), batch.clone(), &mut ready);
        for (number, ready) in batch.zip(&ready) {
            let Ok((ray, scale)) = ready else { continue };
            let mut of_ray = 0;
            lists.each::<A>(scene, ray, |hit| {
                if of_ray == most || reserved.is_err() {
                    return ControlFlow::Break(());
                }
                let hit = Some(hit);
                let first = FirstHit {
                    scene,
                    ray,
                    scale,
                    hit,
                };
                let hit = Q::hit(first);
                // Without one where the t of a plane leaves double precision.
                if hit.primitive != NONE {
                    reserved = all.try_reserve(1);
                    if reserved.is_ok() {
                        all.push((number, hit));
                        of_ray += 1;
                    }
                }
                ControlFlow::Continue(())
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
    place: impl Fn(&SceneRay, &Hit) -> (f64, [f64; 3]) + Sync,
) -> Result<Vec<Locations>, TryReserveError> {
    let most = max_hits.unwrap_or(usize::MAX);
    let chunks = each_chunk(how, chunks_of(rays.len()), |numbers| {
        let mut hits = Vec::new();
        if multiple_hits {
            hits = all_of::<Nearest>(scene, rays, how, (numbers, most))?;
        } else {
            let mut first = vec![Hit::MISS; numbers.len()];
            ask_some::<Nearest>(scene, rays, how, (numbers.start, &mut first));
            let met = numbers.zip(first);
            hits.extend(met.filter(|(_, hit)| hit.primitive != NONE && most > 0));
        }
        let mut locations = Locations::default();
        locations.0.try_reserve_exact(hits.len())?;
        locations.1.try_reserve_exact(hits.len())?;
        locations.2.try_reserve_exact(hits.len())?;
        let mut last = usize::MAX;
        let mut farthest = (f64::NEG_INFINITY, [0.0; 3]);
        for (number, hit) in &hits {
            let met = place(&rays.searched(*number), hit);
            if *number != last || met.0 > farthest.0 {
                farthest = met;
            }
            last = *number;
            locations.0.push(farthest.1);
            locations.1.push(*number as i64);
            locations.2.push(hit.primitive.into());
        }
        Ok(locations)
    });
    chunks.into_iter().collect()
}
