//! Traces rays of the user's own through a blob.

use glam::DVec3;
use gridel_core::accel::{Chosen, MAX_STACK_DEPTH};
use gridel_core::{
    Accel, Bvh, Count, Counters, DualSplit, Fixed, Flagged, Format, NoCount, Number, Ray, RayKind,
    Scene, Stack, Structure, Wide, any_hit, closest_primitive,
};

/// A ray in scene units; t counts multiples of the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneRay {
    pub origin: DVec3,
    pub tmin: f64,
    pub direction: DVec3,
    pub tmax: f64,
}

/// What a ray met; [`SceneHit::MISS`] for nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneHit {
    pub t: f64,
    pub object: u32,
    pub primitive: u32,
    pub normal: [f32; 3],
}

impl SceneHit {
    /// Nothing was met, or the ray was none: its direction was zero, infinite or NaN, its origin
    /// infinite or NaN, or its tmin greater than its tmax.
    pub const MISS: Self = Self {
        t: f64::INFINITY,
        object: u32::MAX,
        primitive: u32::MAX,
        normal: [0.0; 3],
    };

    /// Something was met, where any hit will do.
    const ANY: Self = Self {
        t: 0.0,
        object: 0,
        primitive: 0,
        normal: [0.0; 3],
    };
}

/// How to trace.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    pub format: Format,
    pub structure: Structure,
    /// Whether any hit will do; it is reported with t 0 and no normal.
    pub any: bool,
}

/// Traces rays one after the other on this thread.
pub fn trace(scene: &Scene<'_>, rays: &[SceneRay], query: Query, hits: &mut [SceneHit]) {
    match query.format {
        Format::Fixed => with_format::<Fixed>(scene, rays, query, hits),
        Format::F32 => with_format::<f32>(scene, rays, query, hits),
        Format::F64 => with_format::<f64>(scene, rays, query, hits),
    }
}

/// Traces rays like [`trace`], and counts what is tested for them.
pub fn trace_counted(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    query: Query,
    hits: &mut [SceneHit],
    counters: &mut Counters,
) {
    let Some(scene) = scene.choose(query.structure) else {
        return hits.fill(SceneHit::MISS);
    };
    let any = query.any;
    match query.format {
        Format::Fixed => through::<Fixed, Chosen, _>(&scene, rays, any, hits, counters),
        Format::F32 => through::<f32, Chosen, _>(&scene, rays, any, hits, counters),
        Format::F64 => through::<f64, Chosen, _>(&scene, rays, any, hits, counters),
    }
}

fn with_format<N: Number>(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    query: Query,
    hits: &mut [SceneHit],
) {
    let (any, count) = (query.any, &mut NoCount);
    // What hosts and boards trace with; the others are there to be compared.
    match query.structure {
        Structure::Bvh => through::<N, Bvh, _>(scene, rays, any, hits, count),
        Structure::Flagged => through::<N, Flagged, _>(scene, rays, any, hits, count),
        Structure::DualSplit => through::<N, DualSplit, _>(scene, rays, any, hits, count),
        Structure::Wide => through::<N, Wide, _>(scene, rays, any, hits, count),
        other => match scene.choose(other) {
            Some(scene) => through::<N, Chosen, _>(&scene, rays, any, hits, count),
            None => hits.fill(SceneHit::MISS),
        },
    }
}

fn through<N: Number, A: Accel, C: Count>(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    any: bool,
    hits: &mut [SceneHit],
    count: &mut C,
) {
    if any {
        any_of_each::<N, A, C>(scene, rays, hits, count);
    } else {
        closest_of_each::<N, A, C>(scene, rays, hits, count);
    }
}

/// Finds whether each ray meets anything.
fn any_of_each<N: Number, A: Accel, C: Count>(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    hits: &mut [SceneHit],
    count: &mut C,
) {
    let frame = Frame::of(scene);
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    for number in 0..rays.len().min(hits.len()) {
        load_ahead(rays, hits, number);
        let (ray, hit) = (&rays[number], &mut hits[number]);
        let is_hit = frame.ray::<N>(scene, ray).is_some_and(|(ray, _)| {
            count.ray(RayKind::Primary, &ray);
            any_hit::<N, A, C>(scene, &ray, stack.as_view(), count)
        });
        *hit = if is_hit {
            SceneHit::ANY
        } else {
            SceneHit::MISS
        };
    }
}

/// Finds what each ray meets first.
fn closest_of_each<N: Number, A: Accel, C: Count>(
    scene: &Scene<'_>,
    rays: &[SceneRay],
    hits: &mut [SceneHit],
    count: &mut C,
) {
    let frame = Frame::of(scene);
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    for number in 0..rays.len().min(hits.len()) {
        load_ahead(rays, hits, number);
        let (ray, hit) = (&rays[number], &mut hits[number]);
        // Each hit is written where it is known, and not put together elsewhere first.
        let Some((ray, scale)) = frame.ray::<N>(scene, ray) else {
            *hit = SceneHit::MISS;
            continue;
        };
        count.ray(RayKind::Primary, &ray);
        let found = closest_primitive::<N, A, C>(scene, &ray, stack.as_view(), count);
        // Inlined, so that nothing of the hit is computed but what is used here.
        let Some(found) = found.and_then(|found| found.hit(scene, &ray)) else {
            *hit = SceneHit::MISS;
            continue;
        };
        *hit = SceneHit {
            t: N::far_to_f64(found.t) / scale,
            object: found.object,
            primitive: found.primitive,
            normal: found.normal.map(|x| x.ratio_to_f64() as f32),
        };
    }
}

/// Starts to load what comes some rays after the one of a number. A ray and a hit are 96 bytes, which a
/// processor loads ahead by itself too late: tracing a ray keeps it from running ahead.
#[inline(always)]
fn load_ahead(rays: &[SceneRay], hits: &[SceneHit], number: usize) {
    #[cfg(target_arch = "x86_64")]
    if let (Some(ray), Some(hit)) = (rays.get(number + 20), hits.get(number + 20)) {
        gridel_x86::prefetch(ray);
        gridel_x86::prefetch_to_write(hit);
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (rays, hits, number);
}

/// How a scene's coordinates relate to the core's.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    origin: DVec3,
    unit: f64,
}

impl Frame {
    /// The frame of a blob.
    pub fn of(scene: &Scene<'_>) -> Self {
        let header = scene.header();
        Self {
            origin: DVec3::from_array(header.origin),
            unit: f64::powi(2.0, header.unit_exponent.into()),
        }
    }

    /// A point in scene coordinates, from units.
    pub fn place(&self, units: [f64; 3]) -> DVec3 {
        self.origin + DVec3::from_array(units) * self.unit
    }

    /// A length in scene units, from units.
    pub fn length(&self, units: f64) -> f64 {
        units * self.unit
    }

    /// A ray in scene units, from one in units.
    pub fn scene_ray(&self, ray: &crate::verify::UnitRay) -> SceneRay {
        let direction = DVec3::from_array(ray.direction);
        let scale = direction.abs().max_element() / self.unit;
        let along = |t: f64| if t == 0.0 { 0.0 } else { t / scale };
        SceneRay {
            origin: self.place(ray.origin),
            tmin: along(ray.tmin),
            direction,
            tmax: along(ray.tmax),
        }
    }

    /// A ray in the core's form, and by how much its t is larger: `None` for what is no ray.
    #[inline(always)]
    pub fn ray<N: Number>(&self, scene: &Scene<'_>, ray: &SceneRay) -> Option<(Ray<N>, f64)> {
        // Multiples of the direction become lengths along its largest component.
        let scale = ray.direction.abs().max_element() / self.unit;
        let along = |t: f64| if t == 0.0 { 0.0 } else { t * scale };
        let origin = (ray.origin - self.origin) / self.unit;
        let ray = Ray::from_f64(
            scene.bounds(),
            origin.to_array(),
            ray.direction.to_array(),
            along(ray.tmin),
            along(ray.tmax),
        );
        Some((ray.ok()?, scale))
    }
}
