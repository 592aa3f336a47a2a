//! Traces rays of the user's own through a blob.

mod carry;
mod direction_scale;
#[cfg(target_arch = "x86_64")]
mod four;
mod frame;
mod rejection;
mod unit_ray;

pub use direction_scale::DirectionScale;
#[cfg(target_arch = "x86_64")]
#[doc(hidden)]
pub use four::Four;
pub use frame::Frame;
pub use rejection::{Rejection, Rejections};
pub use unit_ray::UnitRay;

use crate::observed::Observed;
use glam::DVec3;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Bvh, Counters, DualSplit, Fixed, Flagged, Format, NoCount, Number, Observer,
    PrimitiveHit, Ray, RayKind, Scene, Stack, Structure, Wide, any_hit, closest_primitive,
};
use std::ops::Range;

/// A ray in scene units; t counts multiples of the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneRay {
    pub origin: DVec3,
    pub tmin: f64,
    pub direction: DVec3,
    pub tmax: f64,
}

impl SceneRay {
    /// Returns a `t` of the ray, or the end of its interval that is nearest to it. Number formats round `tmin` and
    /// `tmax`, so that a hit can lie outside of the interval as it was given, by that rounding.
    #[inline(always)]
    pub fn within(&self, t: f64) -> f64 {
        if t >= self.tmin {
            if t <= self.tmax { t } else { self.tmax }
        } else {
            self.tmin
        }
    }
}

/// The answer to a ray: a hit, [`SceneHit::MISS`] or [`SceneHit::REJECTED`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneHit {
    pub t: f64,
    pub object: u32,
    pub primitive: u32,
    /// The instance, in scene-file order; `u32::MAX` for the scene's own objects.
    pub instance: u32,
    pub normal: [f32; 3],
}

impl SceneHit {
    /// The answer for a ray that misses.
    pub const MISS: Self = Self {
        t: f64::INFINITY,
        object: u32::MAX,
        primitive: u32::MAX,
        instance: u32::MAX,
        normal: [0.0; 3],
    };

    /// The ray was rejected: its t is NaN.
    pub const REJECTED: Self = Self {
        t: f64::NAN,
        ..Self::MISS
    };

    /// Something was met, where any hit will do.
    const ANY: Self = Self {
        t: 0.0,
        object: 0,
        primitive: 0,
        instance: u32::MAX,
        normal: [0.0; 3],
    };

    /// Returns whether the ray was rejected.
    pub fn is_rejected(&self) -> bool {
        self.t.is_nan()
    }
}

/// Options for tracing.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    pub format: Format,
    pub structure: Structure,
    /// True if any hit suffices; it is reported with t 0 and no normal.
    pub any: bool,
}

/// The blob does not hold the structure through which rays were to be traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the blob does not hold the structure {}", .0.name())]
pub struct MissingStructure(pub Structure);

/// Traces rays one after the other on this thread. Returns which were rejected, and why.
///
/// `t` of a hit is never below `tmin` or above `tmax`. The number format rounds both, so it can find or miss a surface
/// that is as near to one of them as it rounds.
///
/// # Errors
/// If the blob does not hold the structure; then `hits` stays as it was.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use glam::DVec3;
/// use gridel_core::{Format, Structure};
/// use gridel_host::trace::{Query, SceneHit, SceneRay, trace};
///
/// let ray = SceneRay {
///     origin: DVec3::new(0.0, 0.0, 5.0),
///     tmin: 0.0,
///     direction: DVec3::NEG_Z,
///     tmax: f64::INFINITY,
/// };
/// let query = Query {
///     format: Format::F64,
///     structure: Structure::DualSplit,
///     any: false,
/// };
/// let mut hits = [SceneHit::MISS];
/// let rejected = trace(&scene, &[ray], query, &mut hits)?;
/// assert_eq!((hits[0].t, rejected.count), (4.0, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn trace(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    query: Query,
    hits: &mut [SceneHit],
) -> Result<Rejections, MissingStructure> {
    match query.format {
        Format::Fixed => with_format::<Fixed>(scene, rays, query, hits),
        Format::F32 => with_format::<f32>(scene, rays, query, hits),
        Format::F64 => with_format::<f64>(scene, rays, query, hits),
    }
}

/// Traces rays like [`trace`], and counts their tests.
///
/// # Errors
/// As [`trace`].
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::{Counters, Format, Structure};
/// use gridel_host::trace::{Query, SceneHit, SceneRay, trace_counted};
///
/// let down = SceneRay {
///     origin: glam::DVec3::new(0.0, 5.0, 0.0),
///     tmin: 0.0,
///     direction: glam::DVec3::NEG_Y,
///     tmax: f64::INFINITY,
/// };
/// let query = Query {
///     format: Format::Fixed,
///     structure: Structure::List,
///     any: false,
/// };
/// let mut counters = Counters::default();
/// trace_counted(&scene, &[down], query, &mut [SceneHit::MISS], &mut counters)?;
/// assert_eq!(counters.primitives, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn trace_counted(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    query: Query,
    hits: &mut [SceneHit],
    counters: &mut Counters,
) -> Result<Rejections, MissingStructure> {
    let scene = chosen(scene, query.structure)?;
    let any = query.any;
    let mut observed = Observed::default();
    let rejections = match query.format {
        Format::Fixed => through::<Fixed, DynAccel, _>(&scene, rays, any, hits, &mut observed),
        Format::F32 => through::<f32, DynAccel, _>(&scene, rays, any, hits, &mut observed),
        Format::F64 => through::<f64, DynAccel, _>(&scene, rays, any, hits, &mut observed),
    };
    *counters = counters.plus(&observed.counters);
    Ok(rejections)
}

fn with_format<N: Number>(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    query: Query,
    hits: &mut [SceneHit],
) -> Result<Rejections, MissingStructure> {
    let (any, count) = (query.any, &mut NoCount);
    let scene = &chosen(scene, query.structure)?;
    #[cfg(target_arch = "x86_64")]
    if let Some(rejections) = Four::trace(scene, rays, query, hits) {
        return Ok(rejections);
    }
    // Hosts and boards trace with these; the others are for comparison.
    Ok(match query.structure {
        Structure::Bvh => through::<N, Bvh, _>(scene, rays, any, hits, count),
        Structure::Flagged => through::<N, Flagged, _>(scene, rays, any, hits, count),
        Structure::DualSplit => through::<N, DualSplit, _>(scene, rays, any, hits, count),
        Structure::Wide => through::<N, Wide, _>(scene, rays, any, hits, count),
        _ => through::<N, DynAccel, _>(scene, rays, any, hits, count),
    })
}

/// The scene, with a structure chosen for [`DynAccel`].
fn chosen<'a>(scene: &Scene<'a>, structure: Structure) -> Result<Scene<'a>, MissingStructure> {
    scene.choose(structure).ok_or(MissingStructure(structure))
}

fn through<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    any: bool,
    hits: &mut [SceneHit],
    count: &mut C,
) -> Rejections {
    if any {
        any_of_each::<N, A, C>(scene, rays, hits, count)
    } else {
        closest_of_each::<N, A, C>(scene, rays, hits, count)
    }
}

/// Rays whose steps are taken together: those of several rays overlap, where those of one wait for each other.
const BATCH: usize = 16;

/// A ray that is ready to be traced, or why it is not.
type Ready<N> = Result<(Ray<N>, DirectionScale), Rejection>;

/// Finds whether each ray meets anything.
fn any_of_each<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    hits: &mut [SceneHit],
    count: &mut C,
) -> Rejections {
    let frame = Frame::of(scene);
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut rejections = Rejections::default();
    let mut batch: Vec<Ready<N>> = Vec::with_capacity(BATCH);
    for first in (0..rays.len().min(hits.len())).step_by(BATCH) {
        load_ahead(rays, hits, first + BATCH..first + 2 * BATCH);
        let rays = &rays[first..rays.len().min(first + BATCH)];
        frame.fill(&mut batch, scene, rays);
        for (place, (ready, hit)) in batch.iter().zip(&mut hits[first..]).enumerate() {
            let (ray, _) = match ready {
                Ok(ready) => ready,
                Err(why) => {
                    *hit = rejections.add(first + place, *why);
                    continue;
                }
            };
            count.ray(RayKind::Primary, ray);
            *hit = if any_hit::<N, A, C>(scene, ray, stack.as_view(), count) {
                SceneHit::ANY
            } else {
                SceneHit::MISS
            };
        }
    }
    rejections
}

/// Finds what each ray meets first.
fn closest_of_each<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    hits: &mut [SceneHit],
    count: &mut C,
) -> Rejections {
    let frame = Frame::of(scene);
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut rejections = Rejections::default();
    let mut batch: Vec<Ready<N>> = Vec::with_capacity(BATCH);
    let mut met = Vec::with_capacity(BATCH);
    for first in (0..rays.len().min(hits.len())).step_by(BATCH) {
        load_ahead(rays, hits, first + BATCH..first + 2 * BATCH);
        let rays = &rays[first..rays.len().min(first + BATCH)];
        frame.fill(&mut batch, scene, rays);
        met.clear();
        for ready in &batch {
            met.push(ready.as_ref().ok().and_then(|(ray, _)| {
                count.ray(RayKind::Primary, ray);
                closest_primitive::<N, A, C>(scene, ray, stack.as_view(), count)
            }));
        }
        let answers = rays.iter().zip(&batch).zip(&met).zip(&mut hits[first..]);
        for (place, (((scene_ray, ready), met), hit)) in answers.enumerate() {
            let found = ready.as_ref().map_err(|why| *why);
            let found = found.and_then(|(ray, direction_scale)| {
                answer(scene, scene_ray, (ray, direction_scale), *met)
            });
            *hit = found.unwrap_or_else(|why| rejections.add(first + place, why));
        }
    }
    rejections
}

/// The answer to a ray by what it meets first.
// Inlining lets the compiler compute only the values that are used here.
#[inline(always)]
fn answer<N: Number>(
    scene: &Scene<'_>,
    scene_ray: &SceneRay,
    (ray, direction_scale): (&Ray<N>, &DirectionScale),
    met: Option<PrimitiveHit<N>>,
) -> Result<SceneHit, Rejection> {
    let Some((met, normal)) = met.and_then(|met| Some((met, met.normal(scene, ray)?))) else {
        return Ok(SceneHit::MISS);
    };
    let error = || {
        met.hit(scene, ray)
            .map_or(0.0, |hit| hit.error.length_to_f64())
    };
    let t = direction_scale.multiple(N::far_to_f64(met.t), error)?;
    Ok(SceneHit {
        t: scene_ray.within(t),
        object: scene.object(met.primitive),
        primitive: met.primitive,
        instance: met
            .instance()
            .and_then(|index| scene.instances().get(index as usize))
            .map_or(u32::MAX, |instance| instance.number),
        normal: normal.map(|x| x.ratio_to_f64() as f32),
    })
}

/// Starts to load what belongs to the rays of some places. A processor does so by itself too late: tracing a ray
/// keeps it from running ahead.
#[inline(always)]
fn load_ahead(rays: &[SceneRay], hits: &[SceneHit], places: Range<usize>) {
    #[cfg(target_arch = "x86_64")]
    if let (Some(rays), Some(hits)) = (rays.get(places.clone()), hits.get(places)) {
        rays.iter().for_each(gridel_cpu::prefetch);
        hits.iter().for_each(gridel_cpu::prefetch_to_write);
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (rays, hits, places);
}

#[cfg(test)]
mod tests;
