//! Queries of rays that are set up four at once, in `f32` through [`Wide`] with AVX2.

use super::candidate::Candidate;
use super::found;
use super::hit::PrimitiveHit;
use super::search::Search;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::accel::wide::cull::WideLanes;
use crate::accel::{Accel, Wide};
use crate::format::Kind;
use crate::geometry::pack::normals::{LaneNormals, MetSpheres};
use crate::geometry::strip::StripRay;
use crate::observe::count::NoCount;
use crate::ray::{FourGivenRays, FourRays, Ray};
use crate::scene::Scene;
use crate::simd::{Avx2, SimdLevel};
use crate::target::wide_only;

/// A ray with all that a query needs of it, in a scene that [suits](FourReadyRays::suit).
#[derive(Clone, Copy, Debug)]
pub struct ReadyRay {
    ray: Ray<f32>,
    cull: WideLanes,
    strip_ray: StripRay<f32>,
}

/// Four rays with all that queries need of them.
#[derive(Clone, Copy, Debug)]
pub struct FourReadyRays {
    ready: u32,
    rays: [ReadyRay; 4],
}

/// Normals of up to eight hits, of which spheres are computed all at once.
#[derive(Clone, Copy, Debug, Default)]
pub struct HitNormals {
    spheres: MetSpheres,
    normals: LaneNormals,
}

impl HitNormals {
    /// Forgets all hits.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.spheres.clear();
    }

    /// Adds a hit, in a scene that [suits](FourReadyRays::suit).
    #[inline(always)]
    pub fn add(&mut self, lane: usize, scene: &Scene<'_>, ray: &ReadyRay, hit: &PrimitiveHit<f32>) {
        let place = hit.best.place;
        if place.kind == Kind::Sphere
            && let Some(sphere) = scene.geometry.shapes.sphere_at(place)
        {
            let at = (&ray.ray, hit.best.t);
            self.spheres.add(lane, sphere, at, hit.leaves());
        }
    }

    /// Computes the normals of the hits that were added.
    #[inline(always)]
    pub fn compute(&mut self, avx2: Avx2) {
        self.normals = self.spheres.normals(avx2);
    }

    /// Returns [`PrimitiveHit::normal`] of a hit.
    #[inline(always)]
    pub fn get(
        &self,
        lane: usize,
        scene: &Scene<'_>,
        ray: &ReadyRay,
        hit: &PrimitiveHit<f32>,
    ) -> Option<[f32; 3]> {
        let normal = self.normals.get(lane);
        normal.or_else(|| hit.normal(scene, &ray.ray))
    }
}

impl FourReadyRays {
    /// Returns the proof of the instructions if rays of a scene can be set up in fours: queries of it use AVX2, and it
    /// has no instances and no shapes without bounds.
    pub fn suit(scene: &Scene<'_>) -> Option<Avx2> {
        match scene.geometry.simd() {
            SimdLevel::Avx2(avx2) if scene.instances().is_empty() && !scene.has_unbounded => {
                Some(avx2)
            }
            _ => None,
        }
    }

    /// Rays that are to be set up.
    pub fn empty() -> Self {
        let ray = ReadyRay {
            ray: Ray::unwritten(),
            cull: WideLanes::default(),
            strip_ray: StripRay::unwritten(),
        };
        Self {
            ready: 0,
            rays: [ray; 4],
        }
    }

    /// Sets up four rays. Their bits are those of [`Ray::from_f64`].
    // In place, because copies of what was just written in parts are slow.
    #[inline(always)]
    pub fn set_up(&mut self, avx2: Avx2, scene: &Scene<'_>, given: &FourGivenRays) {
        let rays = FourRays::new(avx2, scene.bounds(), given);
        self.ready = rays.ready;
        let [a, b, c, d] = &mut self.rays;
        let cull = [&mut a.cull, &mut b.cull, &mut c.cull, &mut d.cull];
        WideLanes::write_four(&rays, cull);
        let strips = &scene.geometry.shapes.clusters().strips;
        if strips.len() > 0 {
            let strip_rays = [
                &mut a.strip_ray,
                &mut b.strip_ray,
                &mut c.strip_ray,
                &mut d.strip_ray,
            ];
            StripRay::write_four(&rays, strips, strip_rays);
        }
        for (lane, ready) in self.rays.iter_mut().enumerate() {
            rays.write(lane, &mut ready.ray);
        }
    }

    /// Returns a ray; `None` if [`Ray::from_f64`] must set it up, or reject it.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Option<&ReadyRay> {
        let is_ready = self.ready >> (lane & 3) & 1 != 0;
        is_ready.then_some(&self.rays[lane & 3])
    }
}

impl ReadyRay {
    /// Returns the ray.
    #[inline(always)]
    pub fn ray(&self) -> &Ray<f32> {
        &self.ray
    }

    /// [`closest_primitive`](crate::closest_primitive) of the ray.
    #[inline(always)]
    pub fn closest_primitive(
        &self,
        scene: &Scene<'_>,
        stack: &mut StackView,
    ) -> Option<PrimitiveHit<f32>> {
        self.search::<false>(scene, stack)
    }

    /// [`any_hit`](crate::any_hit) of the ray.
    #[inline(always)]
    pub fn any_hit(&self, scene: &Scene<'_>, stack: &mut StackView) -> bool {
        self.search::<true>(scene, stack).is_some()
    }

    #[inline(always)]
    fn search<const ANY: bool>(
        &self,
        scene: &Scene<'_>,
        stack: &mut StackView,
    ) -> Option<PrimitiveHit<f32>> {
        let (ray, cull, count) = (&self.ray, &self.cull, &mut NoCount);
        let none: Option<Candidate<f32>> = None;
        let strip_ray = wide_only(|| self.strip_ray);
        let mut search = Search::with_strip_ray(scene, ray, cull, none, strip_ray);
        let (geometry, views) = (&scene.geometry, Wide::views(&scene.structures));
        if ANY {
            Wide::walk_any(
                geometry,
                views,
                ray,
                cull,
                stack,
                count,
                #[inline(always)]
                |leaf, count| {
                    search.leaf::<Wide, _, ANY>(leaf, count);
                    search.found.is_some()
                },
            );
        } else {
            Wide::walk(
                geometry,
                views,
                ray,
                cull,
                stack,
                count,
                #[inline(always)]
                |leaf, count| {
                    search.leaf::<Wide, _, ANY>(leaf, count);
                    Some(search.tmax)
                },
            );
        }
        Some(found(scene, ray, search.found?))
    }
}
