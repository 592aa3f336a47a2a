//! The map of an instance: rays into the part, hits back into the scene.
//!
//! All numbers of a map are integers that every format holds exactly; only the mapped values are rounded. The power of
//! two stays apart, so that ratios are ratios.

use crate::format::instance::{Instance, MATRIX_BITS};
use crate::format::record::UnitBox;
use crate::number::{Arithmetic, extent, far_extent};
use crate::observe::event::Event;
use crate::ray::Ray;

/// The map of an instance, in a number format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Map<N> {
    rows: [[N; 3]; 3],
    center: [N; 3],
    exponent: i32,
}

/// A ray in the units of a part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedRay<N: Arithmetic> {
    pub(crate) ray: Ray<N>,
    /// The factor by which t is longer in the part, without the map's power of two: a product of two ratios, above 1/4.
    stretch: N::Wide,
    exponent: i32,
}

impl<N: Arithmetic> Map<N> {
    #[inline(always)]
    pub(crate) fn new(instance: &Instance) -> Self {
        let entry = |steps: i32| N::ratio(steps.wrapping_shl(30 - MATRIX_BITS));
        let row = |[x, y, z]: [i32; 3]| [entry(x), entry(y), entry(z)];
        let [first, second, third] = instance.matrix;
        let [x, y, z] = instance.center;
        Self {
            rows: [row(first), row(second), row(third)],
            center: [N::from_lattice(x), N::from_lattice(y), N::from_lattice(z)],
            exponent: instance.exponent.into(),
        }
    }

    #[inline(always)]
    fn rotate(&self, v: [N; 3]) -> [N::Wide; 3] {
        let [x, y, z] = self.rows;
        [N::dot(x, v), N::dot(y, v), N::dot(z, v)]
    }

    /// A place as seen from the center.
    #[inline(always)]
    fn apart(&self, [x, y, z]: [N; 3]) -> [N; 3] {
        let [a, b, c] = self.center;
        [x - a, y - b, z - c]
    }

    /// A place of the scene in the part.
    #[inline(always)]
    pub(crate) fn point(&self, place: [N; 3]) -> [N::Wide; 3] {
        let [x, y, z] = self.rotate(self.apart(place));
        let far = |product: N::Wide| N::far_of_product(product, self.exponent);
        [far(x), far(y), far(z)]
    }

    /// Returns a ray of the scene in the part, whose box is given. It has hits up to a t that is counted from the ray's
    /// start. `None` if it misses the part's surroundings.
    #[inline(always)]
    pub(crate) fn ray(&self, bounds: &UnitBox, ray: &Ray<N>, tmax: N) -> Option<PlacedRay<N>> {
        let direction = self.rotate(ray.slope);
        let stretch = far_extent::<N>(direction);
        let exponent = self.exponent;
        let into = |t: N| {
            let scaled = N::wide_scale(t.widen(), N::from_wide(stretch));
            N::far_times_power(scaled, exponent)
        };
        // A ray that starts outside a surface stays outside.
        let tmin = if ray.tmin > N::ZERO {
            let (mapped, beside) = (into(ray.tmin), N::step_beside(N::ZERO).widen());
            if mapped > beside { mapped } else { beside }
        } else {
            N::Wide::default()
        };
        let origin = self.point(ray.origin);
        let ray = Ray::new(bounds, origin, direction, tmin, into(tmax)).ok()?;
        Some(PlacedRay {
            ray,
            stretch,
            exponent,
        })
    }

    /// A normal of the part in the scene, and the part's units per unit along it, without the map's power of two.
    #[inline(always)]
    pub(crate) fn normal(&self, normal: [N; 3]) -> ([N; 3], N) {
        let column = |k: usize| [self.rows[0][k], self.rows[1][k], self.rows[2][k]];
        let component = |k: usize| N::from_wide(N::dot(column(k), normal));
        N::normalize([component(0), component(1), component(2)])
    }

    /// A length of the part in the scene, along a normal.
    #[inline(always)]
    fn length(&self, length: N, along: N) -> N {
        let length = length.div(along).widen();
        N::narrow(N::far_times_power(length, self.exponent.wrapping_neg()))
    }

    /// Returns the surface in the scene of a surface of the part: point, normal and error bound. `near` is the place on
    /// the scene's ray at the hit's t.
    ///
    /// The point is the one of the mapped tangent plane next to `near`. So the part's rounding and the way there count,
    /// but not the precision of the inverse map.
    ///
    /// **Error bound**, in addition to the part's own. Mapping a place rounds each coordinate by 4 u of three products,
    /// 12 u of its distance from the center in all. That happens once here and once for the next ray. The point and the
    /// start of that ray are rounded by 2 u of a coordinate each. In `fixed` a mapped coordinate is rounded to a
    /// sub-step of the part.
    pub(crate) fn surface(&self, near: [N; 3], surface: &PlacedSurface<N>) -> PlacedSurface<N> {
        let (normal, along) = self.normal(surface.normal);
        let there = self.point(near).map(N::narrow);
        let [x, y, z] = surface.point;
        let gap = [x - there[0], y - there[1], z - there[2]];
        let gap = self.length(N::from_wide(N::dot(gap, surface.normal)), along);
        let step = |k: usize| near[k] + gap * normal[k];
        let point = [step(0), step(1), step(2)];
        let mapped = N::error_bound(extent(self.apart(near)));
        let beside = N::step_beside(extent(point));
        let beside = beside + beside;
        let own = self.length(surface.error + N::ABSOLUTE_ERROR, along);
        PlacedSurface {
            point,
            normal,
            error: own + mapped + mapped + beside + beside,
        }
    }

    /// The inverse of [`surface`](Self::surface) for a place of the scene on it: that place, the normal and a length
    /// along it, in the part.
    pub(crate) fn in_part(&self, surface: &PlacedSurface<N>) -> PlacedSurface<N> {
        let point = self.point(surface.point).map(N::narrow);
        let mapped = self.rotate(surface.normal).map(N::from_wide);
        let (normal, along) = N::normalize(mapped);
        let error = N::far_times_power((surface.error * along).widen(), self.exponent);
        PlacedSurface {
            point,
            normal,
            error: N::narrow(error),
        }
    }

    /// Returns a way of the part in the scene. It is less than a few error bounds long, so the transposed matrix is
    /// used as its inverse.
    pub(crate) fn step(&self, way: [N; 3]) -> [N; 3] {
        let (direction, length) = N::normalize(way);
        let (direction, along) = self.normal(direction);
        let length = self.length(length, along);
        direction.map(|component| length * component)
    }
}

/// A place on a surface, the normal there, and a length along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedSurface<N> {
    pub(crate) point: [N; 3],
    pub(crate) normal: [N; 3],
    pub(crate) error: N,
}

impl<N: Arithmetic> PlacedRay<N> {
    /// The event that a ray enters an instance, whose part's first primitive is given.
    pub(crate) fn entered(&self, index: u32, first_primitive: u32) -> Event {
        let ray = &self.ray;
        let stretch = N::from_wide(self.stretch).ratio_to_f64();
        // 2 to a power far from the ends of the range.
        let power = (1023 - i64::from(self.exponent)).cast_unsigned() << 52;
        Event::InstanceEntered {
            index,
            first_primitive,
            origin: ray.origin.map(N::length_to_f64),
            slope: ray.slope.map(N::ratio_to_f64),
            interval: [ray.tmin, ray.tmax].map(N::length_to_f64),
            start_t: N::far_to_f64(ray.start_t),
            scale: f64::from_bits(power) / stretch,
        }
    }

    /// A t of the part, counted from the mapped start, as one of the scene's ray, counted from its start.
    #[inline(always)]
    pub(crate) fn t_in_scene(&self, t: N::Wide) -> N {
        let up = if self.exponent < 0 {
            N::far_times_power(t, self.exponent.wrapping_neg())
        } else {
            t
        };
        let over = N::far_over(up, self.stretch);
        N::narrow(if self.exponent < 0 {
            over
        } else {
            N::far_times_power(over, self.exponent.wrapping_neg())
        })
    }
}

/// Returns the end of the search in a part for hits with a t of at most this one in the scene. It lies beyond that t by
/// more than the rounding of mapping a t to the part and back.
#[inline(always)]
pub(crate) fn beyond<N: Arithmetic>(t: N) -> N {
    let rounded = N::wide_over(t.widen(), 1 << 16) + N::far(4);
    N::narrow(t.widen() + rounded)
}
