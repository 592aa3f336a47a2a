//! Rays.
//!
//! In steps of scene coordinates there is no floating point in `fixed`, and rays and hits are those of
//! `Scene::ray_within` and `Scene::distance`. In scene units a ray is brought to the scene in double precision and then
//! rounded to the number format, as `gridel trace` does. The bits are the same for origins within 16 times the width of
//! the scene.

use crate::load::{read, status};
use crate::memory::{output, scene, stack};
use crate::{
    Accel, GRIDEL_NONE, gridel_buffer, gridel_hit, gridel_hit_f32, gridel_hit_f64, gridel_ray,
    gridel_ray_f32, gridel_ray_f64, gridel_scene, gridel_status,
};
use gridel_core::{
    Fixed, Hit, NoCount, Number, Position, Ray, RayError, Scene, StackView, any_hit, closest_hit,
};

/// Finds the first hit of a ray, in integers. `stack` is memory of `gridel_stack_bytes` bytes.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_cast_fixed(
    loaded: *const gridel_scene,
    ray: *const gridel_ray,
    stack: gridel_buffer,
    hit: *mut gridel_hit,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { cast_steps::<Fixed>(loaded, ray, stack, hit) })
}

/// Finds the first hit of a ray in steps, in single precision.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_cast_steps_f32(
    loaded: *const gridel_scene,
    ray: *const gridel_ray,
    stack: gridel_buffer,
    hit: *mut gridel_hit,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { cast_steps::<f32>(loaded, ray, stack, hit) })
}

/// Finds the first hit of a ray in scene units, in single precision.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_cast_f32(
    loaded: *const gridel_scene,
    ray: *const gridel_ray_f32,
    stack: gridel_buffer,
    hit: *mut gridel_hit_f32,
) -> gridel_status {
    let cast = || {
        // SAFETY: the caller's promise.
        let (ray, hit) = unsafe { (read(ray)?, output(hit)?) };
        // SAFETY: the caller's promise.
        let found = unsafe { cast_units::<f32>(loaded, &ray.into(), stack) }?;
        let t = found.t as f32;
        // Beyond the range of single precision, or rounded to fewer digits than it has.
        if found.t.is_finite() && found.t != 0.0 && !t.is_normal() {
            return Err(gridel_status::RayDirection);
        }
        let point = found.point.map(|x| x as f32);
        if !point.iter().all(|x| x.is_finite()) {
            return Err(gridel_status::RayDistance);
        }
        hit.write(gridel_hit_f32 {
            t,
            point,
            normal: found.normal.map(|x| x as f32),
            object: found.object,
            primitive: found.primitive,
            instance: found.instance,
            front: found.front,
        });
        Ok(())
    };
    status(cast())
}

/// Finds the first hit of a ray in scene units, in double precision.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_cast_f64(
    loaded: *const gridel_scene,
    ray: *const gridel_ray_f64,
    stack: gridel_buffer,
    hit: *mut gridel_hit_f64,
) -> gridel_status {
    let cast = || {
        // SAFETY: the caller's promise.
        let (ray, hit) = unsafe { (read(ray)?, output(hit)?) };
        // SAFETY: the caller's promise.
        hit.write(unsafe { cast_units::<f64>(loaded, &ray, stack) }?);
        Ok(())
    };
    status(cast())
}

/// Writes 1 if a ray hits anything, else 0: in integers. Takes less time than `gridel_cast_fixed`.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_any_fixed(
    loaded: *const gridel_scene,
    ray: *const gridel_ray,
    stack: gridel_buffer,
    any: *mut u32,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { any_steps::<Fixed>(loaded, ray, stack, any) })
}

/// Writes 1 if a ray in steps hits anything, else 0: in single precision.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_any_steps_f32(
    loaded: *const gridel_scene,
    ray: *const gridel_ray,
    stack: gridel_buffer,
    any: *mut u32,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { any_steps::<f32>(loaded, ray, stack, any) })
}

/// Writes 1 if a ray in scene units hits anything, else 0: in single precision.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_any_f32(
    loaded: *const gridel_scene,
    ray: *const gridel_ray_f32,
    stack: gridel_buffer,
    any: *mut u32,
) -> gridel_status {
    let cast = || {
        // SAFETY: the caller's promise.
        let ray = unsafe { read(ray) }?;
        // SAFETY: the caller's promise.
        unsafe { any_units::<f32>(loaded, &ray.into(), stack, any) }
    };
    status(cast())
}

/// Writes 1 if a ray in scene units hits anything, else 0: in double precision.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_any_f64(
    loaded: *const gridel_scene,
    ray: *const gridel_ray_f64,
    stack: gridel_buffer,
    any: *mut u32,
) -> gridel_status {
    let cast = || {
        // SAFETY: the caller's promise.
        let ray = unsafe { read(ray) }?;
        // SAFETY: the caller's promise.
        unsafe { any_units::<f64>(loaded, &ray, stack, any) }
    };
    status(cast())
}

/// # Safety
/// Each pointer is null, or points to what its type states.
unsafe fn cast_steps<N: Number>(
    loaded: *const gridel_scene,
    ray: *const gridel_ray,
    memory: gridel_buffer,
    to: *mut gridel_hit,
) -> Result<(), gridel_status> {
    // SAFETY: the caller's promise.
    let (scene, ray, to) = unsafe { (scene(loaded)?, read(ray)?, output(to)?) };
    // SAFETY: the caller's promise.
    let stack = unsafe { stack(scene, memory) }?;
    let ray = ready::<N>(scene, &ray)?;
    let Some(hit) = closest_hit::<N, Accel, _>(scene, &ray, stack, &mut NoCount) else {
        to.write(gridel_hit {
            distance: u64::MAX,
            position: [0; 3],
            normal: [0; 3],
            object: GRIDEL_NONE,
            primitive: GRIDEL_NONE,
            instance: GRIDEL_NONE,
            front: 0,
        });
        return Ok(());
    };
    to.write(gridel_hit {
        distance: scene.distance(&ray, &hit),
        position: scene.hit_position(&ray, &hit).0,
        normal: hit.normal.map(N::to_q30),
        object: hit.object,
        primitive: hit.primitive,
        instance: instance(scene, &hit),
        front: hit.front.into(),
    });
    Ok(())
}

/// # Safety
/// Each pointer is null, or points to what its type states.
unsafe fn any_steps<N: Number>(
    loaded: *const gridel_scene,
    ray: *const gridel_ray,
    memory: gridel_buffer,
    to: *mut u32,
) -> Result<(), gridel_status> {
    // SAFETY: the caller's promise.
    let (scene, ray, to) = unsafe { (scene(loaded)?, read(ray)?, output(to)?) };
    // SAFETY: the caller's promise.
    let stack = unsafe { stack(scene, memory) }?;
    let ray = ready::<N>(scene, &ray)?;
    to.write(any_hit::<N, Accel, _>(scene, &ray, stack, &mut NoCount).into());
    Ok(())
}

fn ready<N: Number>(scene: &Scene<'_>, ray: &gridel_ray) -> Result<Ray<N>, gridel_status> {
    let interval = [ray.nearest, ray.farthest];
    Ok(scene.ray_within(Position(ray.position), ray.direction, interval)?)
}

/// # Safety
/// Each pointer is null, or points to what its type states.
unsafe fn cast_units<N: Number>(
    loaded: *const gridel_scene,
    ray: &gridel_ray_f64,
    memory: gridel_buffer,
) -> Result<gridel_hit_f64, gridel_status> {
    // SAFETY: the caller's promise.
    let scene = unsafe { scene(loaded) }?;
    // SAFETY: the caller's promise.
    let stack: &mut StackView = unsafe { stack(scene, memory) }?;
    let units = Units::of(scene);
    let given = ray;
    let (ray, scale) = units.ray::<N>(scene, given)?;
    let Some(hit) = closest_hit::<N, Accel, _>(scene, &ray, stack, &mut NoCount) else {
        return Ok(gridel_hit_f64 {
            t: f64::INFINITY,
            point: [0.0; 3],
            normal: [0.0; 3],
            object: GRIDEL_NONE,
            primitive: GRIDEL_NONE,
            instance: GRIDEL_NONE,
            front: 0,
        });
    };
    let t = scale.multiple(N::far_to_f64(hit.t))?;
    let point = hit.point.map(N::length_to_f64);
    // A point of a plane that can stand for one that is farther away than a point of the core can be.
    let is_far = point.iter().any(|x| x.abs() > SURELY_HELD);
    let on_ray = |axis: usize| given.origin[axis] + t * given.direction[axis];
    Ok(gridel_hit_f64 {
        t,
        point: match is_far {
            true => [on_ray(0), on_ray(1), on_ray(2)],
            false => units.place(point),
        },
        normal: hit.normal.map(N::ratio_to_f64),
        object: hit.object,
        primitive: hit.primitive,
        instance: instance(scene, &hit),
        front: hit.front.into(),
    })
}

/// # Safety
/// Each pointer is null, or points to what its type states.
unsafe fn any_units<N: Number>(
    loaded: *const gridel_scene,
    ray: &gridel_ray_f64,
    memory: gridel_buffer,
    to: *mut u32,
) -> Result<(), gridel_status> {
    // SAFETY: the caller's promise.
    let (scene, to) = unsafe { (scene(loaded)?, output(to)?) };
    // SAFETY: the caller's promise.
    let stack = unsafe { stack(scene, memory) }?;
    let (ray, _) = Units::of(scene).ray::<N>(scene, ray)?;
    to.write(any_hit::<N, Accel, _>(scene, &ray, stack, &mut NoCount).into());
    Ok(())
}

/// The instance of a hit, in scene-file order.
fn instance<N: Number>(scene: &Scene<'_>, hit: &Hit<N>) -> u32 {
    let index = hit.instance().map(|index| index as usize);
    let instance = index.and_then(|index| scene.instances().get(index));
    instance.map_or(GRIDEL_NONE, |instance| instance.number)
}

impl From<gridel_ray_f32> for gridel_ray_f64 {
    fn from(ray: gridel_ray_f32) -> Self {
        Self {
            origin: ray.origin.map(f64::from),
            direction: ray.direction.map(f64::from),
            t_min: ray.t_min.into(),
            t_max: ray.t_max.into(),
        }
    }
}

/// Units up to which a hit's point is the place that is hit, in the number formats of casts in scene units. A point that
/// stands for a farther one lies half way between one beyond 2^46 units and the plane's own.
const SURELY_HELD: f64 = (1_u64 << 44) as f64;

/// The relation of scene units to the core's.
struct Units {
    origin: [f64; 3],
    /// A power of two.
    unit: f64,
    per_unit: f64,
}

/// Limits of a direction's length, in units of either kind, within which every product is in the range of numbers.
const ORDINARY: core::ops::Range<f64> = 1.0 / (1_u128 << 100) as f64..(1_u128 << 100) as f64;

/// The largest component of a direction in the core's units, by which t is larger there: a factor and a power of two.
struct DirectionScale {
    factor: f64,
    exponent: i32,
}

impl DirectionScale {
    /// A length in units, from multiples of the direction; infinite beyond all numbers.
    fn length(&self, t: f64) -> f64 {
        match self.exponent {
            _ if t == 0.0 => 0.0,
            0 => t * self.factor,
            exponent => libm::scalbn(t * self.factor, exponent),
        }
    }

    /// Multiples of the direction, from a length in units.
    fn multiple(&self, length: f64) -> Result<f64, gridel_status> {
        if self.exponent == 0 {
            return Ok(length / self.factor);
        }
        let t = libm::scalbn(length / self.factor, -self.exponent);
        // Beyond the range of double precision, or rounded to fewer digits than it has.
        if t.is_normal() || length == 0.0 {
            Ok(t)
        } else {
            Err(gridel_status::RayDirection)
        }
    }
}

impl Units {
    fn of(scene: &Scene<'_>) -> Self {
        let header = scene.header();
        // Its magnitude is at most 1,000.
        let power = |exponent: i64| f64::from_bits(((1023 + exponent) as u64) << 52);
        let exponent = i64::from(header.unit_exponent).clamp(-1000, 1000);
        Self {
            origin: header.origin,
            unit: power(exponent),
            per_unit: power(-exponent),
        }
    }

    /// A place in scene units.
    fn place(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.origin;
        [a + x * self.unit, b + y * self.unit, c + z * self.unit]
    }

    /// A ray in the core's form, and the scale of its t.
    fn ray<N: Number>(
        &self,
        scene: &Scene<'_>,
        ray: &gridel_ray_f64,
    ) -> Result<(Ray<N>, DirectionScale), gridel_status> {
        let larger = |a: f64, b: f64| if a < b { b } else { a };
        let [x, y, z] = ray.direction.map(|x| if x < 0.0 { -x } else { x });
        let largest = larger(larger(x, y), z);
        if largest == 0.0 || !ray.direction.iter().all(|x| x.is_finite()) {
            return Err(gridel_status::RayDirection);
        }
        // As lengths, both ends can be infinite.
        if ray.t_min.is_nan() || ray.t_max.is_nan() || ray.t_min > ray.t_max {
            return Err(gridel_status::RayInterval);
        }
        let factor = largest * self.per_unit;
        let (direction, scale) = if ORDINARY.contains(&largest) && ORDINARY.contains(&factor) {
            let exponent = 0;
            (ray.direction, DirectionScale { factor, exponent })
        } else {
            let (factor, exponent) = libm::frexp(largest);
            let direction = ray.direction.map(|x| libm::scalbn(x, -exponent));
            // A unit is a power of two, which is half of two to its exponent.
            let (_, unit) = libm::frexp(self.unit);
            let exponent = exponent.saturating_sub(unit.saturating_sub(1));
            (direction, DirectionScale { factor, exponent })
        };
        let ([x, y, z], [a, b, c]) = (ray.origin, self.origin);
        let origin = [x - a, y - b, z - c].map(|x| x * self.per_unit);
        let (t_min, t_max) = (scale.length(ray.t_min), scale.length(ray.t_max));
        let ready = Ray::from_f64(scene.bounds(), origin, direction, t_min, t_max);
        let ready = ready.map_err(|error| match error {
            // Infinite in units alone.
            RayError::Origin if ray.origin.iter().all(|x| x.is_finite()) => RayError::Distance,
            error => error,
        })?;
        Ok((ready, scale))
    }
}
