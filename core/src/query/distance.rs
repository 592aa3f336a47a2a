//! Rays and hits in scene coordinates, for range finders: integers from the place of the sensor to the distance of the
//! hit.
//!
//! In [`Fixed`](crate::Fixed) this needs no floating-point code.

use crate::accel::Number;
use crate::format::limits::MAX_COORDINATE_SHIFT;
use crate::number::Format;
use crate::query::Hit;
use crate::ray::{Ray, RayError};
use crate::scene::{Position, Scene};

/// The largest coordinate at which a hit's point is the place of its t, whatever was hit: 2^17 units, with 13 fraction
/// bits.
const NEAR: u64 = 1 << 30;

impl Scene<'_> {
    /// Returns the ray from a place in a direction of any length but 0, limited to the interval between two distances.
    /// Distances are straight lines, in steps of [`coordinate_exponent`](Self::coordinate_exponent). `u64::MAX` is
    /// endless.
    ///
    /// Both limits are exact to two sub-steps of 2^-13 unit and to one part in 2^28 of themselves in `fixed`. In `f32`
    /// the relative error is one part in 2^21, and in `f64` one in 2^50. `f32` also rounds the place, by one part in 2^24
    /// of each coordinate, counted from the lattice's origin: from far away it can find a surface beyond a near limit.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{DualSplit, Fixed, NoCount, Position, Scene, Stack, closest_hit};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// // A scene unit in steps.
    /// const UNIT: i32 = 1 << 25;
    /// assert_eq!(scene.coordinate_exponent(), -25);
    /// // Down from 4 units above the origin, and no farther than 8 units.
    /// let ray = scene.ray_within::<Fixed>(Position([0, 4 * UNIT, 0]), [0, -1, 0], [0, 8 * UNIT as u64])?;
    /// let hit = closest_hit::<_, DualSplit, _>(&scene, &ray, stack.as_view(), &mut NoCount).expect("a ball");
    /// let distance = scene.distance(&ray, &hit);
    /// assert!(distance < 8 * UNIT as u64);
    /// // Nothing is as near as half of that.
    /// let short = scene.ray_within::<Fixed>(Position([0, 4 * UNIT, 0]), [0, -1, 0], [0, distance / 2])?;
    /// assert!(closest_hit::<_, DualSplit, _>(&scene, &short, stack.as_view(), &mut NoCount).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the direction is zero, or the first distance is greater than the second. Also if the place is
    /// [`FARTHEST`](crate::format::limits::FARTHEST) or farther from the lattice's origin.
    pub fn ray_within<N: Number>(
        &self,
        position: Position,
        direction: [i32; 3],
        [nearest, farthest]: [u64; 2],
    ) -> Result<Ray<N>, RayError> {
        if nearest > farthest {
            return Err(RayError::Interval);
        }
        let origin = self.start_of_ray(position)?.map(N::far);
        let direction = direction.map(|component| N::far(component.into()));
        let (slope, _) = N::slopes(direction).ok_or(RayError::Direction)?;
        let (_, norm) = N::normalize(slope);
        let ratios = norm.wide(N::ONE);
        // Along the ray's major axis a length is shorter by the norm of its slopes.
        let limit = |steps: u64| match self.sub_steps(steps) {
            Some(q13) => N::far_over(N::far(q13), ratios),
            None => N::far(i64::MAX),
        };
        Ray::new(
            self.bounds(),
            origin,
            direction,
            limit(nearest),
            limit(farthest),
        )
    }

    /// Returns the distance of a hit from the origin of its ray: a straight line, in steps of
    /// [`coordinate_exponent`](Self::coordinate_exponent), rounded to nearest.
    ///
    /// Before rounding, it is that of the hit's t, exact to two sub-steps of 2^-13 unit and to one part in 2^28 of itself
    /// in `fixed`. In `f32` the relative error is one part in 2^21, and in `f64` one in 2^50. The t has an error of its
    /// own: where a ray meets a surface straight on, 8 sub-steps in `fixed`, and in `f32` and `f64` 8 parts in 2^24 or
    /// 2^53 of the largest coordinate; at an angle, that over the cosine between ray and normal. `ACCURACY.md` has it
    /// for every shape. Slopes are rounded, in `fixed` to 2^-30 of the way. In `f32` the origin is rounded by one part
    /// in 2^24 of each coordinate, counted from the lattice's origin.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{DualSplit, Fixed, NoCount, Position, Scene, Stack, closest_hit};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// let place = Position([0, 4 << 25, 0]);
    /// let ray = scene.ray_from::<Fixed>(place, [0, -1, 0])?;
    /// let hit = closest_hit::<_, DualSplit, _>(&scene, &ray, stack.as_view(), &mut NoCount).expect("a ball");
    /// let found = scene.hit_position(&ray, &hit);
    /// // Straight down: the distance is the difference of the heights, but for the rounding of the point.
    /// let fallen = (place.0[1] - found.0[1]) as u64;
    /// assert!(scene.distance(&ray, &hit).abs_diff(fallen) <= 8 << 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn distance<N: Number>(&self, ray: &Ray<N>, hit: &Hit<N>) -> u64 {
        self.distance_at(ray, hit.t)
    }

    /// Returns the distance of a t from the origin of its ray, as [`distance`](Self::distance) does: that of a
    /// [`PrimitiveHit`](crate::PrimitiveHit), which takes fewer instructions and less stack than a whole hit.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{DualSplit, Fixed, NoCount, Position, Scene, Stack, closest_hit, closest_primitive};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// let ray = scene.ray_from::<Fixed>(Position([0, 4 << 25, 0]), [0, -1, 0])?;
    /// let found = closest_primitive::<_, DualSplit, _>(&scene, &ray, stack.as_view(), &mut NoCount);
    /// let hit = closest_hit::<_, DualSplit, _>(&scene, &ray, stack.as_view(), &mut NoCount).expect("a ball");
    /// assert_eq!(found.map(|found| scene.distance_at(&ray, found.t)), Some(scene.distance(&ray, &hit)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn distance_at<N: Number>(&self, ray: &Ray<N>, t: N::Wide) -> u64 {
        let (_, norm) = N::normalize(ray.slope());
        let (distance, shift) = (N::wide_scale(t, norm), self.step_bits());
        if N::FORMAT != Format::Fixed {
            // Rounded once: a float over a power of two is exact.
            let steps = N::wide_over(distance, 1 << shift);
            return N::far_to_q13(steps).unsigned_abs();
        }
        let half = (1_u64 << shift) >> 1;
        N::far_to_q13(distance).unsigned_abs().saturating_add(half) >> shift
    }

    /// Returns the place of a hit in scene coordinates, rounded to a step: that of [`Hit::point`], or on a plane far from
    /// the scene's box the place of `t` on the ray. Coordinates beyond the range of [`Position`] are its ends. `ray` is
    /// that of the query.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Fixed, Position, Scene, Stack};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let ray = scene.ray_from::<Fixed>(Position([0, 4 << 25, 0]), [0, -1, 0])?;
    /// let mut stack = Stack::<32>::new();
    /// let hit = scene.closest_hit(&ray, stack.as_view()).expect("a ball");
    /// assert_eq!(scene.hit_position(&ray, &hit).0[0], 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn hit_position<N: Number>(&self, ray: &Ray<N>, hit: &Hit<N>) -> Position {
        if hit.is_unbounded()
            && let Some(place) = ray.far_point(hit.t)
        {
            let place = place.map(N::far_to_q13);
            if place.iter().any(|x| x.unsigned_abs() > NEAR) {
                return self.position(place);
            }
        }
        self.position(hit.point.map(|component| component.to_q13().into()))
    }

    /// Steps of scene coordinates in units with 13 fraction bits; `None` where they do not fit.
    fn sub_steps(&self, steps: u64) -> Option<i64> {
        let q13 = steps.checked_mul(1_u64 << self.step_bits())?;
        i64::try_from(q13).ok()
    }

    /// A step is 2 to this power sub-steps of 2^-13 unit.
    fn step_bits(&self) -> u32 {
        self.header()
            .coordinate_shift
            .min(MAX_COORDINATE_SHIFT)
            .into()
    }
}
