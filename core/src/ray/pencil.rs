//! All rays from one point.

use crate::axis::pick;
use crate::format::record::UnitBox;
use crate::number::Arithmetic;
use crate::ray::Ray;
use crate::ray::error::RayError;
use crate::ray::given::given;
use crate::ray::start::{
    check_origin, distance_to_box, far_start, far_start_along, is_near, near_start,
};

/// All rays without end from one point. Their common set-up is computed once.
///
/// Returns the same rays as [`Ray::new`], bit for bit. They cost half as much or less if the point is not much farther
/// from the scene's box than the box is wide.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<N: Arithmetic>(Origin<N>);

/// The origin of a pencil's rays.
#[derive(Clone, Copy, Debug)]
enum Origin<N: Arithmetic> {
    /// [Near](is_near) the scene, in whichever direction a ray is moved.
    Near {
        origin: [N; 3],
        /// The lengths by which rays are moved to the box: `[axis][0 down it, 1 up it]`.
        start_t: [[N; 2]; 3],
    },
    Far {
        origin: [N::Wide; 3],
        bounds: UnitBox,
    },
}

impl<N: Arithmetic> Pencil<N> {
    /// Returns the rays from a point, with all `t` that are not negative: see [`Ray::new`].
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Pencil, Scene};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let pencil = Pencil::<f64>::new(scene.bounds(), [0.0; 3])?;
    /// let ray = pencil.ray([3.0, -4.0, 0.0])?;
    /// assert_eq!(ray.slope(), [0.75, -1.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the origin is infinite or NaN, or farther than [`FARTHEST`](crate::format::limits::FARTHEST).
    pub fn new(bounds: &UnitBox, origin: [N::Wide; 3]) -> Result<Self, RayError> {
        let [x, y, z] = origin;
        check_origin::<N>(x, y, z)?;
        Ok(Self::of(bounds, origin))
    }

    /// The rays from a point that is no farther than [`FARTHEST`](crate::format::limits::FARTHEST).
    pub(crate) fn of(bounds: &UnitBox, origin: [N::Wide; 3]) -> Self {
        let zero = N::Wide::default();
        let start_t = [0, 1, 2].map(|axis| {
            [false, true].map(|forward| {
                distance_to_box::<N>(bounds, pick(origin, axis), (axis, forward), zero)
            })
        });
        let single = (
            origin.map(N::narrow),
            start_t.map(|ways| ways.map(N::narrow)),
        );
        let near = |axis: usize| {
            let [down, up] = pick(single.1, axis);
            is_near(single.0, axis, down) && is_near(single.0, axis, up)
        };
        Self(if near(0) && near(1) && near(2) {
            let (origin, start_t) = single;
            Origin::Near { origin, start_t }
        } else {
            Origin::Far {
                origin,
                bounds: *bounds,
            }
        })
    }

    /// Returns the ray in a direction of any length.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Pencil, Ray, Scene};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let pencil = Pencil::<f64>::new(scene.bounds(), [0.0; 3])?;
    /// let ray = pencil.ray([1.0, 0.5, 0.0])?;
    /// let alone = Ray::<f64>::new(scene.bounds(), [0.0; 3], [1.0, 0.5, 0.0], 0.0, f64::INFINITY)?;
    /// assert_eq!(ray.slope(), alone.slope());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the direction is zero, infinite or NaN.
    #[inline(always)]
    pub fn ray(&self, direction: [N::Wide; 3]) -> Result<Ray<N>, RayError> {
        let (slope, major) = N::slopes(direction).ok_or(RayError::Direction)?;
        let toward = |bounds: &UnitBox, origin: &[N::Wide; 3], start_t: N::Wide| {
            far_start::<N, false>(bounds, *origin, direction, (slope, major), start_t)
        };
        Ok(self.ray_from(slope, major, toward))
    }

    /// The ray along slopes, given with their major axis.
    #[inline(always)]
    pub(crate) fn ray_along(&self, slope: [N; 3], major: usize) -> Ray<N> {
        let along = |bounds: &UnitBox, origin: &[N::Wide; 3], start_t: N::Wide| {
            far_start_along(bounds, *origin, (slope, major), start_t)
        };
        self.ray_from(slope, major, along)
    }

    /// Returns the ray along slopes; a function finds the start if it is far.
    #[inline(always)]
    fn ray_from(
        &self,
        slope: [N; 3],
        major: usize,
        far: impl Fn(&UnitBox, &[N::Wide; 3], N::Wide) -> ([N; 3], N::Wide, bool),
    ) -> Ray<N> {
        let forward = pick(slope, major) > N::ZERO;
        let zero = N::Wide::default();
        let (start, start_t, within) = match &self.0 {
            Origin::Near { origin, start_t } => {
                let [down, up] = pick(*start_t, major);
                let start_t = if forward { up } else { down };
                (near_start(*origin, start_t, slope), start_t.widen(), true)
            }
            Origin::Far { origin, bounds } => {
                let start_t =
                    distance_to_box::<N>(bounds, pick(*origin, major), (major, forward), zero);
                far(bounds, origin, start_t)
            }
        };
        let origin = || match &self.0 {
            Origin::Near { origin, .. } => origin.map(N::widen),
            Origin::Far { origin, .. } => *origin,
        };
        Ray {
            origin: start,
            slope,
            major,
            start_t,
            tmin: N::ZERO,
            tmax: if within { N::FAR } else { -N::ONE },
            given: given(origin, [zero, N::far(i64::MAX)], within),
        }
    }
}
