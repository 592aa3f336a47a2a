//! Queries of many rays and points, spread over threads.

use crate::rays::{EXACT, Rays, Ready};
use crate::threads::in_pool;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Fixed, Format, NoCount, Number, PrimitiveHit, Ray, Scene, Stack, Structure, Wide,
    any_hit, closest_primitive,
};
#[cfg(target_arch = "x86_64")]
use gridel_core::{FourReadyRays, SimdLevel};
#[cfg(target_arch = "x86_64")]
use gridel_host::simd;
use gridel_host::trace::{DirectionScale, Frame};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::collections::TryReserveError;
use std::ops::Range;

/// Rays whose steps are taken together, as `gridel trace` takes them.
const BATCH: usize = 16;

/// Rays or points that a thread takes at a time.
const CHUNK: usize = 2048;

/// The number of a missing item.
pub const NONE: u32 = u32::MAX;

/// The settings of a query.
#[derive(Clone, Copy)]
pub struct How {
    pub format: Format,
    pub structure: Structure,
    /// 0 for one per core.
    pub threads: usize,
}

/// A hit.
#[derive(Clone, Copy)]
pub struct Hit {
    /// In multiples of the direction; infinite on a miss, NaN for a ray that is rejected.
    pub t: f64,
    pub object: u32,
    pub primitive: u32,
    pub instance: u32,
    /// True if the ray leaves a solid.
    pub leaves: bool,
    pub normal: [f32; 3],
}

impl Hit {
    const MISS: Self = Self {
        t: f64::INFINITY,
        object: NONE,
        primitive: NONE,
        instance: NONE,
        leaves: false,
        normal: [0.0; 3],
    };
}

/// Runs a function that is generic over number format and structure. What few use shares code.
macro_rules! dispatch {
    ($how:expr, $function:ident, [$($type:ty),*], ($($argument:expr),* $(,)?)) => {
        match ($how.format, $how.structure) {
            (Format::F32, Structure::Wide) => $function::<f32, Wide, $($type),*>($($argument),*),
            (Format::F64, Structure::Wide) => $function::<f64, Wide, $($type),*>($($argument),*),
            (Format::Fixed, _) => $function::<Fixed, DynAccel, $($type),*>($($argument),*),
            (Format::F32, _) => $function::<f32, DynAccel, $($type),*>($($argument),*),
            (Format::F64, _) => $function::<f64, DynAccel, $($type),*>($($argument),*),
        }
    };
}

mod all_hits;
mod columns;
#[cfg(target_arch = "x86_64")]
mod fours;
mod inside;
mod limits;
mod lists;

pub use all_hits::{all, locations};
pub use columns::{Columns, Placed, Rows, cast};
pub use inside::{Inside, contains};
pub use limits::{any, count};

/// Calls a function that asks about so many rays or points, without the GIL, where there are the threads that it needs.
pub fn detach<T: Send>(
    py: Python<'_>,
    how: How,
    length: usize,
    query: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let chunks = length.div_ceil(CHUNK);
    if how.threads == 1 || chunks <= 1 {
        return Ok(py.detach(query));
    }
    in_pool(py, how.threads.min(chunks), query)
}

/// Works on chunks, by the threads that [`detach`] prepares.
fn each_chunk<C: Send, T: Send>(
    how: How,
    chunks: Vec<C>,
    work: impl Fn(C) -> T + Sync + Send,
) -> Vec<T> {
    if how.threads == 1 || chunks.len() <= 1 {
        chunks.into_iter().map(work).collect()
    } else {
        chunks.into_par_iter().map(work).collect()
    }
}

/// The numbers of rays in chunks.
fn chunks_of(length: usize) -> Vec<Range<usize>> {
    let starts = (0..length).step_by(CHUNK);
    starts
        .map(|start| start..length.min(start + CHUNK))
        .collect()
}

/// Fills an array with one answer per ray or point, in chunks.
fn fill<T: Send + Clone>(
    how: How,
    length: usize,
    empty: T,
    chunk: impl Fn(usize, &mut [T]) + Sync,
) -> Result<Vec<T>, TryReserveError> {
    let mut answers = Vec::new();
    answers.try_reserve_exact(length)?;
    answers.resize(length, empty);
    let chunks = answers.chunks_mut(CHUNK).enumerate().collect();
    each_chunk(how, chunks, |(number, answers)| {
        chunk(number * CHUNK, answers)
    });
    Ok(answers)
}

/// A query for each ray, and its answers.
pub trait Question: Sync {
    type Answer: Send + Sync + Clone;
    /// True if any hit suffices.
    const ANY: bool = false;
    const MISS: Self::Answer;
    /// The answer for an invalid ray.
    const REJECTED: Self::Answer;
    /// The answer of a hit; `None` for any hit.
    fn hit<N: Number>(first: FirstHit<'_, '_, N>) -> Self::Answer;
}

/// A first hit, where the query is for the first hit.
pub struct FirstHit<'m, 'a, N: Number> {
    scene: &'m Scene<'a>,
    ray: &'m Ray<N>,
    scale: &'m DirectionScale,
    hit: Option<&'m PrimitiveHit<N>>,
}

/// The first primitive; -1 for none.
pub struct FirstPrimitive;

impl Question for FirstPrimitive {
    type Answer = i32;
    const MISS: i32 = -1;
    const REJECTED: i32 = -1;

    #[inline(always)]
    fn hit<N: Number>(first: FirstHit<'_, '_, N>) -> i32 {
        first.hit.map_or(-1, |hit| hit.primitive as i32)
    }
}

/// The query whether there is any hit.
pub struct Any;

impl Question for Any {
    type Answer = bool;
    const ANY: bool = true;
    const MISS: bool = false;
    const REJECTED: bool = false;

    #[inline(always)]
    fn hit<N: Number>(_: FirstHit<'_, '_, N>) -> bool {
        true
    }
}

/// The first hit.
pub struct Closest;

impl Question for Closest {
    type Answer = Hit;
    const MISS: Hit = Hit::MISS;
    const REJECTED: Hit = Hit {
        t: f64::NAN,
        ..Hit::MISS
    };

    #[inline(always)]
    fn hit<N: Number>(first: FirstHit<'_, '_, N>) -> Hit {
        match first.hit {
            Some(hit) => with_normal(first.scene, (first.ray, first.scale), hit),
            None => Hit::MISS,
        }
    }
}

/// The first hit without its normal.
pub struct Nearest;

impl Question for Nearest {
    type Answer = Hit;
    const MISS: Hit = Hit::MISS;
    const REJECTED: Hit = Closest::REJECTED;

    #[inline(always)]
    fn hit<N: Number>(first: FirstHit<'_, '_, N>) -> Hit {
        match first.hit {
            Some(hit) => bare(first.scene, (first.ray, first.scale), hit),
            None => Hit::MISS,
        }
    }
}

/// A hit as arrays hold it, without its normal: for less.
#[inline(always)]
fn bare<N: Number>(
    scene: &Scene<'_>,
    (ray, scale): (&Ray<N>, &DirectionScale),
    hit: &PrimitiveHit<N>,
) -> Hit {
    let error = || {
        let whole = hit.hit(scene, ray);
        let error = whole.map_or(0.0, |whole| whole.error.length_to_f64());
        // No hit of a ray that is valid is lost for a t that is rounded more than its format rounds.
        error.max(EXACT)
    };
    let Ok(t) = scale.multiple(N::far_to_f64(hit.t), error) else {
        return Closest::REJECTED;
    };
    let instance = hit.instance();
    let instance = instance.and_then(|index| scene.instances().get(index as usize));
    Hit {
        t,
        object: scene.object(hit.primitive),
        primitive: hit.primitive,
        instance: instance.map_or(NONE, |instance| instance.number),
        leaves: hit.leaves(),
        normal: [0.0; 3],
    }
}

/// A hit as arrays hold it.
#[inline(always)]
fn with_normal<N: Number>(
    scene: &Scene<'_>,
    (ray, scale): (&Ray<N>, &DirectionScale),
    hit: &PrimitiveHit<N>,
) -> Hit {
    let Some(normal) = hit.normal(scene, ray) else {
        return Hit::MISS;
    };
    let mut answer = bare(scene, (ray, scale), hit);
    if answer.primitive != NONE {
        answer.normal = normal.map(|x| x.ratio_to_f64() as f32);
    }
    answer
}

/// Answers a question about each ray.
pub fn ask<Q: Question>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
) -> Result<Vec<Q::Answer>, TryReserveError> {
    fill(how, rays.len(), Q::MISS, |start, answers| {
        ask_some::<Q>(scene, rays, how, (start, answers));
    })
}

/// Answers a question about some rays, given the number of the first and room for the answers.
fn ask_some<Q: Question>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    (start, answers): (usize, &mut [Q::Answer]),
) {
    #[cfg(target_arch = "x86_64")]
    if let (Format::F32, Structure::Wide, SimdLevel::Avx2(avx2)) =
        (how.format, how.structure, simd::level())
    {
        return avx2.call(
            #[inline(always)]
            |_, scene, rays, start, answers, ()| match FourReadyRays::suit(scene) {
                Some(avx2) => fours::ask::<Q>(avx2, scene, rays, start, answers),
                None => ask_inline::<f32, Wide, Q>(scene, rays, start, answers),
            },
            (scene, rays, start, answers, ()),
        );
    }
    dispatch!(how, ask_chunk, [Q], (scene, rays, start, answers));
}

fn ask_chunk<N: Number, A: Accel, Q: Question>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    start: usize,
    answers: &mut [Q::Answer],
) {
    ask_inline::<N, A, Q>(scene, rays, start, answers);
}

#[inline(always)]
fn ask_inline<N: Number, A: Accel, Q: Question>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    start: usize,
    answers: &mut [Q::Answer],
) {
    let frame = Frame::of(scene);
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut ready: Vec<Ready<N>> = Vec::with_capacity(BATCH);
    let mut met = Vec::with_capacity(BATCH);
    for (batch, answers) in answers.chunks_mut(BATCH).enumerate() {
        let first = start + batch * BATCH;
        rays.fill((scene, &frame), first..first + answers.len(), &mut ready);
        if Q::ANY {
            for (ready, answer) in ready.iter().zip(answers) {
                let Ok((ray, scale)) = ready else {
                    *answer = Q::REJECTED;
                    continue;
                };
                if any_hit::<N, A, _>(scene, ray, stack.as_view(), &mut NoCount) {
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
        met.clear();
        // A loop, not `extend`, which is not inlined and then is not compiled for this processor.
        for ready in &ready {
            met.push(match ready {
                Ok((ray, _)) => {
                    closest_primitive::<N, A, _>(scene, ray, stack.as_view(), &mut NoCount)
                }
                Err(_) => None,
            });
        }
        for ((ready, met), answer) in ready.iter().zip(&met).zip(answers) {
            match ready {
                Ok((ray, scale)) => {
                    if let Some(hit) = met {
                        let hit = Some(hit);
                        *answer = Q::hit(FirstHit {
                            scene,
                            ray,
                            scale,
                            hit,
                        });
                    }
                }
                Err(_) => *answer = Q::REJECTED,
            }
        }
    }
}
