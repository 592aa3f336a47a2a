//! Queries of many rays and points, spread over threads.

use crate::rays::{Points, Rays, Ready};
use glam::DVec3;
#[cfg(target_arch = "x86_64")]
use gridel_core::SimdLevel;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Fixed, Format, HitList, NoCount, Number, PrimitiveHit, Ray, Scene, Solid, Stack,
    Structure, Wide, all_hits, any_hit, closest_primitive, containment_ray,
};
#[cfg(target_arch = "x86_64")]
use gridel_host::simd;
use gridel_host::trace::{DirectionScale, Frame, SceneRay};
use rayon::prelude::*;
use std::ops::Range;

/// Rays whose steps are taken together, as `gridel trace` takes them.
const BATCH: usize = 16;

/// Rays or points that a thread takes at a time.
const CHUNK: usize = 2048;

/// Hits that are listed at a time.
const LISTED: usize = 16;

/// What is not there.
pub const NONE: u32 = u32::MAX;

/// How to ask.
#[derive(Clone, Copy)]
pub struct How {
    pub format: Format,
    pub structure: Structure,
    /// 0 for one per core.
    pub threads: usize,
}

/// A hit.
#[derive(Clone, Copy)]
pub struct Found {
    /// In multiples of the direction; infinite on a miss, NaN for a ray that is rejected.
    pub t: f64,
    pub object: u32,
    pub primitive: u32,
    pub instance: u32,
    /// Whether the ray leaves a solid.
    pub leaves: bool,
    pub normal: [f32; 3],
}

impl Found {
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

/// Calls a function with all threads, or in a pool of so many.
pub fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    if threads == 0 {
        return work();
    }
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(work),
        // Without threads of its own it runs on those that there are.
        Err(_) => work(),
    }
}

/// Fills an array with one answer per ray or point, in chunks.
fn fill<T: Send + Clone>(
    how: How,
    length: usize,
    empty: T,
    chunk: impl Fn(usize, &mut [T]) + Sync,
) -> Vec<T> {
    let mut answers = vec![empty; length];
    if how.threads == 1 || length <= CHUNK {
        let chunks = answers.chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(number, answers)| chunk(number * CHUNK, answers));
    } else {
        with_threads(how.threads, || {
            let chunks = answers.par_chunks_mut(CHUNK).enumerate();
            chunks.for_each(|(number, answers)| chunk(number * CHUNK, answers));
        });
    }
    answers
}

/// What is asked about each ray, and what the answers are.
pub trait Question: Sync {
    type Answer: Send + Sync + Clone;
    /// Whether any hit will do.
    const ANY: bool = false;
    const MISS: Self::Answer;
    /// Of a ray that is none.
    const REJECTED: Self::Answer;
    /// The answer of a hit; `None` for any hit.
    fn hit<N: Number>(met: Met<'_, '_, N>) -> Self::Answer;
}

/// A first hit, where the first hit was asked for.
pub struct Met<'m, 'a, N: Number> {
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
    fn hit<N: Number>(met: Met<'_, '_, N>) -> i32 {
        met.hit.map_or(-1, |hit| hit.primitive as i32)
    }
}

/// Whether there is any hit.
pub struct Any;

impl Question for Any {
    type Answer = bool;
    const ANY: bool = true;
    const MISS: bool = false;
    const REJECTED: bool = false;

    #[inline(always)]
    fn hit<N: Number>(_: Met<'_, '_, N>) -> bool {
        true
    }
}

/// The first hit.
pub struct Closest;

impl Question for Closest {
    type Answer = Found;
    const MISS: Found = Found::MISS;
    const REJECTED: Found = Found {
        t: f64::NAN,
        ..Found::MISS
    };

    #[inline(always)]
    fn hit<N: Number>(met: Met<'_, '_, N>) -> Found {
        match met.hit {
            Some(hit) => found(met.scene, (met.ray, met.scale), hit),
            None => Found::MISS,
        }
    }
}

/// The first hit without its normal.
pub struct Nearest;

impl Question for Nearest {
    type Answer = Found;
    const MISS: Found = Found::MISS;
    const REJECTED: Found = Closest::REJECTED;

    #[inline(always)]
    fn hit<N: Number>(met: Met<'_, '_, N>) -> Found {
        match met.hit {
            Some(hit) => bare(met.scene, (met.ray, met.scale), hit),
            None => Found::MISS,
        }
    }
}

/// A hit as arrays hold it, without its normal: for less.
#[inline(always)]
fn bare<N: Number>(
    scene: &Scene<'_>,
    (ray, scale): (&Ray<N>, &DirectionScale),
    hit: &PrimitiveHit<N>,
) -> Found {
    let error = || {
        let whole = hit.hit(scene, ray);
        whole.map_or(0.0, |whole| whole.error.length_to_f64())
    };
    let Ok(t) = scale.multiple(N::far_to_f64(hit.t), error) else {
        return Closest::REJECTED;
    };
    let instance = hit.instance();
    let instance = instance.and_then(|index| scene.instances().get(index as usize));
    Found {
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
fn found<N: Number>(
    scene: &Scene<'_>,
    (ray, scale): (&Ray<N>, &DirectionScale),
    hit: &PrimitiveHit<N>,
) -> Found {
    let Some(whole) = hit.hit(scene, ray) else {
        return Found::MISS;
    };
    let mut found = bare(scene, (ray, scale), hit);
    if found.primitive != NONE {
        found.normal = whole.normal.map(|x| x.ratio_to_f64() as f32);
    }
    found
}

/// Answers a question about each ray.
pub fn ask<Q: Question>(scene: &Scene<'_>, rays: Rays<'_>, how: How) -> Vec<Q::Answer> {
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
    // What most ask, with the instructions of newer processors all along.
    #[cfg(target_arch = "x86_64")]
    if let (Format::F32, Structure::Wide, SimdLevel::Avx2(avx2)) =
        (how.format, how.structure, simd::level())
    {
        return avx2.call(
            #[inline(always)]
            |_, scene, rays, start, answers, ()| {
                ask_inline::<f32, Wide, Q>(scene, rays, start, answers);
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
                    *answer = Q::hit(Met {
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
                        *answer = Q::hit(Met {
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

/// The first hits of some rays, as arrays hold them.
pub struct Columns<'c, T> {
    pub t: &'c mut [T],
    pub object: &'c mut [u32],
    pub primitive: &'c mut [u32],
    /// Empty where nobody asks.
    pub instance: &'c mut [u32],
    pub normal: &'c mut [[f32; 3]],
    pub uv: &'c mut [[f32; 2]],
}

impl<'c, T> Columns<'c, T> {
    /// The first so many rows, and the others.
    fn split(self, at: usize) -> (Self, Self) {
        let (t, more_t) = self.t.split_at_mut(at);
        let (object, more_objects) = self.object.split_at_mut(at);
        let (primitive, more_primitives) = self.primitive.split_at_mut(at);
        let instances = at.min(self.instance.len());
        let (instance, more_instances) = self.instance.split_at_mut(instances);
        let (normal, more_normals) = self.normal.split_at_mut(at);
        let (uv, more_uvs) = self.uv.split_at_mut(at);
        let first = Self {
            t,
            object,
            primitive,
            instance,
            normal,
            uv,
        };
        let rest = Self {
            t: more_t,
            object: more_objects,
            primitive: more_primitives,
            instance: more_instances,
            normal: more_normals,
            uv: more_uvs,
        };
        (first, rest)
    }
}

/// Rays whose hits are found before they are written: as many as a processor's nearest memory holds.
const WRITTEN: usize = 256;

/// Finds the first hit of each ray and writes it to arrays of as many rows.
///
/// `place` gives the t and the weights of corners of a hit, and `number` its t and its primitive as the arrays have them.
pub fn cast<T: Send + Copy>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    mut columns: Columns<'_, T>,
    place: impl Fn(&SceneRay, &Found) -> (f64, [f32; 2]) + Sync,
    number: impl Fn(&Found) -> (T, u32) + Sync,
) {
    let mut chunks = Vec::with_capacity(rays.len().div_ceil(CHUNK));
    for start in (0..rays.len()).step_by(CHUNK) {
        let (chunk, rest) = columns.split(CHUNK.min(rays.len() - start));
        chunks.push((start, chunk));
        columns = rest;
    }
    let write = |(start, mut columns): (usize, Columns<'_, T>)| {
        let mut hits = [Found::MISS; WRITTEN];
        let mut start = start;
        while !columns.t.is_empty() {
            let count = WRITTEN.min(columns.t.len());
            let (rows, rest) = columns.split(count);
            let hits = &mut hits[..count];
            hits.fill(Found::MISS);
            ask_some::<Closest>(scene, rays, how, (start, hits));
            for (row, hit) in hits.iter_mut().enumerate() {
                if hit.primitive != NONE {
                    (hit.t, rows.uv[row]) = place(&rays.get(start + row), hit);
                }
                (rows.t[row], rows.primitive[row]) = number(hit);
                rows.object[row] = hit.object;
                rows.normal[row] = hit.normal;
                if let Some(instance) = rows.instance.get_mut(row) {
                    *instance = hit.instance;
                }
            }
            start += WRITTEN;
            columns = rest;
        }
    };
    if how.threads == 1 || chunks.len() <= 1 {
        chunks.into_iter().for_each(write);
    } else {
        with_threads(how.threads, || chunks.into_par_iter().for_each(write));
    }
}

/// The number of hits of each ray; 0 of a ray that is none.
pub fn count(scene: &Scene<'_>, rays: Rays<'_>, how: How) -> Vec<u32> {
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
        if let Ok((ray, _)) = frame.ray::<N>(scene, &rays.get(number)) {
            each_hit::<N, A>(scene, &ray, |_| *answer += 1);
        }
    }
}

/// Calls a function with all hits of a ray.
#[inline(always)]
fn each_hit<N: Number, A: Accel>(
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
pub fn all(scene: &Scene<'_>, rays: Rays<'_>, how: How) -> Vec<Vec<(usize, Found)>> {
    let chunks = rays.len().div_ceil(CHUNK);
    let chunk = |number: usize| {
        let numbers = number * CHUNK..rays.len().min((number + 1) * CHUNK);
        all_of::<Closest>(scene, rays, how, numbers)
    };
    if how.threads == 1 || chunks == 1 {
        return (0..chunks).map(chunk).collect();
    }
    with_threads(how.threads, || {
        (0..chunks).into_par_iter().map(chunk).collect()
    })
}

/// All hits of some rays.
fn all_of<Q: Question<Answer = Found>>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    numbers: Range<usize>,
) -> Vec<(usize, Found)> {
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
) -> Vec<(usize, Found)> {
    all_inline::<N, A, Q>(scene, rays, numbers)
}

#[inline(always)]
fn all_inline<N: Number, A: Accel, Q: Question<Answer = Found>>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    numbers: Range<usize>,
) -> Vec<(usize, Found)> {
    let frame = Frame::of(scene);
    let mut all = Vec::with_capacity(2 * numbers.len());
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
                all.push((number, Q::hit(met)));
            });
        }
    }
    all
}

/// Which objects are closed: of the scene itself, then of its parts, by their numbers.
pub type Closed<'a> = &'a [bool];

/// Whether each point lies in a closed object; in any object whose surface is crossed an odd number of times, if
/// `closed` is `None`.
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

/// Places, numbers of rays and triangles.
pub type Locations = (Vec<[f64; 3]>, Vec<i64>, Vec<i64>);

/// Where rays meet triangles: at most so many of each ray, or the first alone. Chunk by chunk.
pub fn locations(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    multiple_hits: bool,
    max_hits: Option<usize>,
    place: impl Fn(&SceneRay, &Found) -> [f64; 3] + Sync,
) -> Vec<Locations> {
    let most = max_hits.unwrap_or(usize::MAX);
    let one = |start: usize| -> Locations {
        let numbers = start..rays.len().min(start + CHUNK);
        let mut hits = Vec::with_capacity(2 * CHUNK);
        if multiple_hits {
            hits = all_of::<Nearest>(scene, rays, how, numbers);
        } else {
            let mut first = vec![Found::MISS; numbers.len()];
            ask_some::<Nearest>(scene, rays, how, (start, &mut first));
            let met = numbers.zip(first);
            hits.extend(met.filter(|(_, hit)| hit.primitive != NONE));
        }
        let mut locations = Locations::default();
        let (mut last, mut of_ray) = (usize::MAX, 0);
        for (number, hit) in &hits {
            of_ray = if *number == last { of_ray + 1 } else { 1 };
            last = *number;
            if of_ray > most {
                continue;
            }
            locations.0.push(place(&rays.get(*number), hit));
            locations.1.push(*number as i64);
            locations.2.push(hit.primitive.into());
        }
        locations
    };
    let starts: Vec<usize> = (0..rays.len()).step_by(CHUNK).collect();
    if how.threads == 1 || starts.len() <= 1 {
        starts.into_iter().map(one).collect()
    } else {
        with_threads(how.threads, || starts.into_par_iter().map(one).collect())
    }
}
