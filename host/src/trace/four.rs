//! Rays in `f32` through `wide` with AVX2: four are made ready at once, and everything is compiled for AVX2.
//!
//! The operations on each ray are those of [`Frame::ray`], without branches. A ray that needs others is traced by the
//! code of all formats.

use super::{
    BATCH, DirectionScale, Frame, Query, Rejections, SceneHit, SceneRay, carry, load_ahead, through,
};
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Format, FourGivenRays, FourReadyRays, HitNormals, NoCount, ReadyRay, Scene, Stack, Structure,
    Wide,
};
use gridel_cpu::{Avx2, F64x4};
use std::{array, slice};

/// Four rays that are ready for queries, or some of them.
pub struct Four {
    rays: FourReadyRays,
    factors: [f64; 4],
    is_ordinary: u32,
}

/// The rays of a batch.
type Batch = [Four; BATCH / 4];

impl Four {
    /// Rays that are to be made ready.
    pub fn empty() -> Self {
        Self {
            rays: FourReadyRays::empty(),
            factors: [0.0; 4],
            is_ordinary: 0,
        }
    }

    /// Makes four rays ready.
    #[inline(always)]
    pub fn set_up(&mut self, avx2: Avx2, scene: &Scene<'_>, frame: &Frame, rays: [&SceneRay; 4]) {
        let [a, b, c, d] = rays;
        macro_rules! row {
            ($($field:tt)*) => {
                F64x4::new(avx2, [a.$($field)*, b.$($field)*, c.$($field)*, d.$($field)*])
            };
        }
        let number = |value: f64| F64x4::splat(avx2, value);
        let per_unit = number(frame.per_unit);
        let origin = [
            (row!(origin.x) - number(frame.origin.x)) * per_unit,
            (row!(origin.y) - number(frame.origin.y)) * per_unit,
            (row!(origin.z) - number(frame.origin.z)) * per_unit,
        ];
        let direction = [row!(direction.x), row!(direction.y), row!(direction.z)];
        let [x, y, z] = direction.map(F64x4::abs);
        let largest = x.max(y).max(z);
        let factor = largest * per_unit;
        let [x, y, z] = origin.map(F64x4::abs);
        let far = number(carry::FAR);
        let ordinary = DirectionScale::ORDINARY;
        let (start, end) = (number(ordinary.start), number(ordinary.end));
        let is_ordinary = start.at_most(factor)
            & factor.below(end)
            & start.at_most(largest)
            & largest.below(end)
            & x.max(y).max(z).at_most(far);
        let length = |t: F64x4| t * factor + number(0.0);
        let given = FourGivenRays {
            origin,
            direction,
            tmin: length(row!(tmin)),
            tmax: length(row!(tmax)),
        };
        self.rays.set_up(avx2, scene, &given);
        self.factors = factor.to_array();
        self.is_ordinary = is_ordinary.bits();
    }

    /// Returns a ray, and by how much its t is larger than in the scene. `None` if [`Frame::ray`] must make it ready.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Option<(&ReadyRay, DirectionScale)> {
        if self.is_ordinary >> lane & 1 == 0 {
            return None;
        }
        let ray = self.rays.get(lane)?;
        Some((ray, DirectionScale::of_factor(self.factors[lane & 3])))
    }

    /// Traces rays, as [`trace`](super::trace) does. `None` if this code does not suit the query or the scene.
    pub(super) fn trace(
        scene: &Scene<'_>,
        rays: &[SceneRay],
        query: Query,
        hits: &mut [SceneHit],
    ) -> Option<Rejections> {
        if (query.format, query.structure) != (Format::F32, Structure::Wide) {
            return None;
        }
        let avx2 = FourReadyRays::suit(scene)?;
        let arguments = (scene, rays, hits, (), ());
        Some(if query.any {
            avx2.call(
                #[inline(always)]
                |avx2, scene, rays, hits, (), ()| any_of_each(avx2, scene, rays, hits),
                arguments,
            )
        } else {
            avx2.call(
                #[inline(always)]
                |avx2, scene, rays, hits, (), ()| closest_of_each(avx2, scene, rays, hits),
                arguments,
            )
        })
    }
}

/// Makes a batch of rays ready. Where there are less than four, the last stands for those that lack.
#[inline(always)]
fn fill(avx2: Avx2, batch: &mut Batch, scene: &Scene<'_>, frame: &Frame, rays: &[SceneRay]) {
    for (four, ready) in rays.chunks(4).zip(batch) {
        let last = &four[four.len() - 1];
        let ray = |lane: usize| four.get(lane).unwrap_or(last);
        let four = [ray(0), ray(1), ray(2), ray(3)];
        ready.set_up(avx2, scene, frame, four);
    }
}

#[inline(always)]
fn any_of_each(
    avx2: Avx2,
    scene: &Scene<'_>,
    rays: &[SceneRay],
    hits: &mut [SceneHit],
) -> Rejections {
    let frame = &Frame::of(scene);
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut rejections = Rejections::default();
    let mut batch: Batch = array::from_fn(|_| Four::empty());
    for first in (0..rays.len().min(hits.len())).step_by(BATCH) {
        load_ahead(rays, hits, first + BATCH..first + 2 * BATCH);
        let rays = &rays[first..rays.len().min(first + BATCH)];
        fill(avx2, &mut batch, scene, frame, rays);
        for (place, (ray, hit)) in rays.iter().zip(&mut hits[first..]).enumerate() {
            let Some((ready, _)) = batch[place / 4].get(place % 4) else {
                rejections = rejections.followed_by(first + place, one(scene, ray, true, hit));
                continue;
            };
            *hit = if ready.any_hit(scene, stack.as_view()) {
                SceneHit::ANY
            } else {
                SceneHit::MISS
            };
        }
    }
    rejections
}

#[inline(always)]
fn closest_of_each(
    avx2: Avx2,
    scene: &Scene<'_>,
    rays: &[SceneRay],
    hits: &mut [SceneHit],
) -> Rejections {
    let frame = &Frame::of(scene);
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut rejections = Rejections::default();
    let mut batch: Batch = array::from_fn(|_| Four::empty());
    let mut met = [None; BATCH];
    let mut normals = [HitNormals::default(); BATCH / 8];
    for first in (0..rays.len().min(hits.len())).step_by(BATCH) {
        load_ahead(rays, hits, first + BATCH..first + 2 * BATCH);
        let rays = &rays[first..rays.len().min(first + BATCH)];
        fill(avx2, &mut batch, scene, frame, rays);
        normals.iter_mut().for_each(HitNormals::clear);
        for (place, met) in met[..rays.len()].iter_mut().enumerate() {
            *met = match batch[place / 4].get(place % 4) {
                Some((ray, _)) => ray.closest_primitive(scene, stack.as_view()),
                None => None,
            };
            if let (Some(met), Some((ray, _))) = (met, batch[place / 4].get(place % 4)) {
                normals[place / 8].add(place % 8, scene, ray, met);
            }
        }
        for normals in &mut normals {
            normals.compute(avx2);
        }
        for (place, (scene_ray, hit)) in rays.iter().zip(&mut hits[first..]).enumerate() {
            let Some((ray, scale)) = batch[place / 4].get(place % 4) else {
                rejections =
                    rejections.followed_by(first + place, one(scene, scene_ray, false, hit));
                continue;
            };
            let Some(met) = &met[place] else {
                *hit = SceneHit::MISS;
                continue;
            };
            let Some(normal) = normals[place / 8].get(place % 8, scene, ray, met) else {
                *hit = SceneHit::MISS;
                continue;
            };
            // One by one, because copies of what was just written in parts are slow.
            hit.t = scene_ray.within(scale.ordinary_multiple(met.t.into()));
            hit.object = scene.object(met.primitive);
            hit.primitive = met.primitive;
            hit.instance = u32::MAX;
            hit.normal = normal;
        }
    }
    rejections
}

/// Traces one ray of any kind.
#[cold]
#[inline(never)]
fn one(scene: &Scene<'_>, ray: &SceneRay, any: bool, hit: &mut SceneHit) -> Rejections {
    let (ray, hit) = (slice::from_ref(ray), slice::from_mut(hit));
    through::<f32, Wide, _>(scene, ray, any, hit, &mut NoCount)
}
