//! A scene's coordinates and those of the core, and rays in both.

use super::carry;
use super::{DirectionScale, Ready, Rejection, SceneRay, UnitRay};
use glam::DVec3;
use gridel_core::{Number, Ray, RayError, Scene};

/// The relation of a scene's coordinates to the core's.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub(super) origin: DVec3,
    /// A power of two, whose exponent is at most 1,000 in magnitude.
    unit: f64,
    /// One over the unit: a product with it has the bits of the quotient, and takes less time.
    pub(super) per_unit: f64,
}

impl Frame {
    /// Returns the frame of a blob.
    pub fn of(scene: &Scene<'_>) -> Self {
        let header = scene.header();
        let exponent = i32::from(header.unit_exponent);
        Self {
            origin: DVec3::from_array(header.origin),
            unit: f64::powi(2.0, exponent),
            per_unit: f64::powi(2.0, -exponent),
        }
    }

    /// Converts a point from units to scene coordinates.
    pub fn place(&self, units: [f64; 3]) -> DVec3 {
        self.origin + DVec3::from_array(units) * self.unit
    }

    /// Converts a length from units to scene units.
    pub fn length(&self, units: f64) -> f64 {
        units * self.unit
    }

    /// Converts a ray from units to scene units.
    pub fn scene_ray(&self, ray: &UnitRay) -> SceneRay {
        let direction = DVec3::from_array(ray.direction);
        let (direction_scale, _) = DirectionScale::of(direction, self.unit, self.per_unit);
        let along = |t: f64| {
            if t == 0.0 {
                0.0
            } else {
                direction_scale.nearest(t)
            }
        };
        SceneRay {
            origin: self.place(ray.origin),
            tmin: along(ray.tmin),
            direction,
            tmax: along(ray.tmax),
        }
    }

    /// Makes a batch of rays ready.
    #[inline(always)]
    pub(super) fn fill<N: Number>(
        &self,
        batch: &mut Vec<Ready<N>>,
        scene: &Scene<'_>,
        rays: &[SceneRay],
    ) {
        batch.clear();
        batch.extend(rays.iter().map(
            #[inline(always)]
            |ray| self.ray(scene, ray),
        ));
    }

    /// Returns a ray in the core's form, and by how much its t is larger.
    ///
    /// # Errors
    /// As [`Ray::from_f64`].
    #[inline(always)]
    pub fn ray<N: Number>(
        &self,
        scene: &Scene<'_>,
        ray: &SceneRay,
    ) -> Result<(Ray<N>, DirectionScale), Rejection> {
        let origin = (ray.origin - self.origin) * self.per_unit;
        let direction_scale = DirectionScale::of_ordinary(ray.direction, self.per_unit);
        // NaN and infinity are not ordinary. Apart from the others, few values wait in memory.
        let Some(direction_scale) = direction_scale.filter(|_| is_near(origin)) else {
            return self.extreme_ray(scene, ray);
        };
        let start = Start {
            origin,
            tmin: direction_scale.length(ray.tmin),
            tmax: direction_scale.length(ray.tmax),
            begin: 0.0,
        };
        Ok((start.ray(scene, ray.direction)?, direction_scale))
    }

    /// A ray whose direction is very long or short, or none, or whose origin is far from the scene.
    #[cold]
    #[inline(never)]
    fn extreme_ray<N: Number>(
        &self,
        scene: &Scene<'_>,
        ray: &SceneRay,
    ) -> Result<(Ray<N>, DirectionScale), Rejection> {
        // Multiples of the direction become lengths along its largest component.
        let (mut direction_scale, direction) =
            DirectionScale::of(ray.direction, self.unit, self.per_unit);
        let mut start = Start {
            origin: (ray.origin - self.origin) * self.per_unit,
            tmin: direction_scale.length(ray.tmin),
            tmax: direction_scale.length(ray.tmax),
            begin: 0.0,
        };
        if !is_near(start.origin) {
            start = self.far_start::<N>(scene, ray, start, direction)?;
            direction_scale.begin_at(start.begin);
        }
        Ok((start.ray(scene, direction)?, direction_scale))
    }

    /// The start of a ray from an origin far from the scene.
    fn far_start<N: Number>(
        &self,
        scene: &Scene<'_>,
        ray: &SceneRay,
        start: Start,
        direction: DVec3,
    ) -> Result<Start, Rejection> {
        match start.ray::<N>(scene, direction) {
            Ok(_) => (),
            // Infinite in units alone.
            Err(RayError::Origin) if ray.origin.is_finite() => {
                return Err(RayError::Distance.into());
            }
            Err(why) => return Err(why.into()),
        }
        let ends = [ray.origin, self.origin];
        let Some((place, along)) = carry::carry(ends, self.unit, direction) else {
            return Ok(start);
        };
        let carried = Start {
            origin: DVec3::from_array(place),
            tmin: start.tmin - along,
            tmax: start.tmax - along,
            begin: along,
        };
        // Else it passes by the scene so far away that its origin is not representable.
        let is_ray = carried.ray::<N>(scene, direction).is_ok();
        Ok(if is_ray { carried } else { start })
    }
}

/// Returns whether an origin in units is near the scene; one with NaN need not be.
#[inline(always)]
fn is_near(origin: DVec3) -> bool {
    origin.abs().max_element() <= carry::FAR
}

/// The start of a ray, and its interval, in units.
#[derive(Clone, Copy, Debug)]
struct Start {
    origin: DVec3,
    tmin: f64,
    tmax: f64,
    /// The length at which the interval counts 0.
    begin: f64,
}

impl Start {
    #[inline(always)]
    fn ray<N: Number>(&self, scene: &Scene<'_>, direction: DVec3) -> Result<Ray<N>, RayError> {
        let (origin, direction) = (self.origin.to_array(), direction.to_array());
        Ray::from_f64(scene.bounds(), origin, direction, self.tmin, self.tmax)
    }
}
