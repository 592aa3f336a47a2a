//! Scene coordinates as integers, and their conversion from the scene file's coordinates to the lattice's.

use crate::accel::Number;
use crate::format::limits::{FARTHEST, MAX_COORDINATE_SHIFT};
use crate::format::record::{Header, LENGTH_BITS, exponent_of_step};
use crate::ray::{Ray, RayError};
use crate::scene::Scene;

/// A place in scene coordinates, in coordinate steps of 2 to the power of [`Scene::coordinate_exponent`] scene units.
///
/// Coordinates are counted from the scene file's own origin. Where a scene lies too far from it for 32 bits, they are
/// counted from the [lattice's](crate::format::record::Header::origin); `gridel inspect` reports that. They reach at
/// least 4 times as far as the scene, its eye and its lights, or to [`FARTHEST`](crate::format::limits::FARTHEST) where
/// that is nearer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Position(pub [i32; 3]);

/// Returns a length of `numerator / denominator` scene units in coordinate steps of 2 to the power of `exponent` scene
/// units, rounded towards 0. `None` if it is beyond 32 bits, or the denominator is 0.
///
/// It is meant for constants: at run time it divides numbers of 128 bits.
///
/// ```
/// use gridel_core::scene::coordinate_steps;
///
/// // A quarter of a unit, where a step is 2^-25 units.
/// const QUARTER: Option<i32> = coordinate_steps(-25, 1, 4);
/// assert_eq!(QUARTER, Some(1 << 23));
/// assert_eq!(coordinate_steps(-25, 64, 1), None);
/// ```
pub const fn coordinate_steps(exponent: i32, numerator: i64, denominator: i64) -> Option<i32> {
    if denominator == 0 {
        return None;
    }
    let (mut rest, mut divisor) = (numerator as i128, denominator as i128);
    if exponent > 63 {
        return Some(0);
    }
    if exponent > 0 {
        divisor <<= exponent;
    }
    let mut steps = rest / divisor;
    rest %= divisor;
    // Each further bit of the quotient; something that is not 0 is soon beyond 32 bits.
    let mut bits = exponent;
    while bits < 0 && (steps != 0 || rest != 0) && steps as i32 as i128 == steps {
        rest *= 2;
        steps = 2 * steps + rest / divisor;
        rest %= divisor;
        bits += 1;
    }
    if steps as i32 as i128 == steps {
        Some(steps as i32)
    } else {
        None
    }
}

impl Scene<'_> {
    /// Returns the exponent of a coordinate step: a step is 2 to this power scene units.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// // Coordinates are multiples of 2^-25 scene units here.
    /// assert_eq!(scene.coordinate_exponent(), -25);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn coordinate_exponent(&self) -> i32 {
        self.header().coordinate_exponent()
    }

    /// Returns a place on the scene's lattice, in units with 13 fraction bits. Records hold this form, and
    /// [`far`](crate::number::Products::far) reads it. A place beyond [`FARTHEST`](crate::format::limits::FARTHEST) is
    /// moved there.
    pub fn on_lattice(&self, position: Position) -> [i64; 3] {
        self.header().on_lattice(position)
    }

    /// Returns the nearest place in scene coordinates to one on the lattice, in units with 13 fraction bits. A place
    /// out of their range is moved to its end.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::Position;
    ///
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// // A copy: the record lies in the blob, where no reference to its field may lead.
    /// let eye = scene.view().eye;
    /// assert_eq!(scene.on_lattice(scene.position(eye)), eye);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn position(&self, q13: [i64; 3]) -> Position {
        self.header().position(q13)
    }

    /// Returns the ray without end from a place in a direction of any length but 0. Its `t` are units along the
    /// direction's largest component: see [`Ray`].
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{DualSplit, Fixed, NoCount, Position, Scene, Stack, closest_hit};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// // Straight down from 4 scene units above the origin.
    /// let ray = scene.ray_from::<Fixed>(Position([0, 4 << 25, 0]), [0, -1, 0])?;
    /// let mut stack = Stack::<32>::new();
    /// let hit = closest_hit::<_, DualSplit, _>(&scene, &ray, stack.as_view(), &mut NoCount);
    /// assert!(hit.is_some());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the direction is zero, or the place is [`FARTHEST`](crate::format::limits::FARTHEST) or farther from the
    /// lattice's origin.
    pub fn ray_from<N: Number>(
        &self,
        position: Position,
        direction: [i32; 3],
    ) -> Result<Ray<N>, RayError> {
        let origin = self.start_of_ray(position)?.map(N::far);
        let direction = direction.map(|component| N::far(component.into()));
        let [start, end] = [N::far(0), N::far(i64::MAX)];
        Ray::new(self.bounds(), origin, direction, start, end)
    }

    /// Returns a place on the lattice, unless it would be moved.
    pub(crate) fn start_of_ray(&self, position: Position) -> Result<[i64; 3], RayError> {
        let place = self.on_lattice(position);
        match place.iter().all(|coordinate| coordinate.abs() < FARTHEST) {
            true => Ok(place),
            false => Err(RayError::Distance),
        }
    }
}

impl Header {
    /// Returns the exponent of a coordinate step: a step is 2 to this power scene units.
    pub fn coordinate_exponent(&self) -> i32 {
        exponent_of_step(self.unit_exponent, self.coordinate_shift)
    }

    /// Returns the place in scene units from which scene coordinates are counted: the scene file's origin, or the
    /// lattice's where that is too far away.
    pub fn coordinate_origin(&self) -> [f64; 3] {
        if self.counted_from == 0 {
            self.origin
        } else {
            [0.0; 3]
        }
    }

    /// Returns a place on the lattice: units with 13 fraction bits, at most [`FARTHEST`] in magnitude.
    pub fn on_lattice(&self, position: Position) -> [i64; 3] {
        let shift = self.coordinate_shift.min(MAX_COORDINATE_SHIFT);
        let coordinate = |coordinate: i32, origin: f64| {
            let steps = i64::from(coordinate).wrapping_shl(shift.into());
            let place = steps.saturating_sub(self.origin_on_lattice(origin));
            place.clamp(-FARTHEST, FARTHEST)
        };
        let ([x, y, z], [origin_x, origin_y, origin_z]) = (position.0, self.origin);
        [
            coordinate(x, origin_x),
            coordinate(y, origin_y),
            coordinate(z, origin_z),
        ]
    }

    /// The lattice's origin in scene coordinates, in units with 13 fraction bits.
    pub(in crate::scene) fn lattice_origin(&self) -> [i64; 3] {
        let [x, y, z] = self.origin;
        [
            self.origin_on_lattice(x),
            self.origin_on_lattice(y),
            self.origin_on_lattice(z),
        ]
    }

    /// The nearest place in scene coordinates to one on the lattice.
    fn position(&self, q13: [i64; 3]) -> Position {
        let shift = self.coordinate_shift.min(MAX_COORDINATE_SHIFT);
        let half = (1_i64 << shift) >> 1;
        let coordinate = |place: i64, origin: f64| {
            let from_origin = place.saturating_add(self.origin_on_lattice(origin));
            let steps = from_origin.saturating_add(half).wrapping_shr(shift.into());
            steps.clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        let ([x, y, z], [origin_x, origin_y, origin_z]) = (q13, self.origin);
        Position([
            coordinate(x, origin_x),
            coordinate(y, origin_y),
            coordinate(z, origin_z),
        ])
    }

    /// A coordinate of the lattice's origin, a multiple of a step, in scene coordinates: in units with 13 fraction
    /// bits. It is computed from the number's bits, so that no floating-point code is needed. Out of range, it is moved
    /// to the range's end.
    fn origin_on_lattice(&self, origin: f64) -> i64 {
        if self.counted_from == 0 {
            return 0;
        }
        const FRACTION: u32 = f64::MANTISSA_DIGITS - 1;
        let bits = origin.to_bits();
        let exponent = (bits >> FRACTION) as i32 & 0x7ff;
        if exponent == 0 {
            // Zero, or too small to be a step.
            return 0;
        }
        let mantissa = (bits & ((1 << FRACTION) - 1)) | 1 << FRACTION;
        let up = exponent - 1075 + LENGTH_BITS - i32::from(self.unit_exponent);
        let magnitude = match up {
            ..=-64 => 0,
            -63..=-1 => mantissa.wrapping_shr(up.unsigned_abs()),
            0..=10 => mantissa.wrapping_shl(up.unsigned_abs()),
            _ => i64::MAX as u64,
        };
        let magnitude = magnitude as i64;
        if bits >> 63 == 1 {
            magnitude.wrapping_neg()
        } else {
            magnitude
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;

    fn header(unit_exponent: i16, coordinate_shift: u8, origin: f64) -> Header {
        Header {
            unit_exponent,
            coordinate_shift,
            counted_from: 1,
            origin: [origin; 3],
            ..Header::zeroed()
        }
    }

    #[test]
    fn places_are_counted_from_the_scenes_origin() {
        for (unit_exponent, shift, origin) in [
            (0, 0, 0.0),
            (0, 0, 12.0),
            (0, 5, -12.0),
            (-15, 0, 1.5),
            (-15, 3, -1_000_000.25),
            (300, 0, f64::powi(2.0, 310)),
            (-900, 0, -f64::powi(2.0, -890)),
        ] {
            let header = header(unit_exponent, shift, origin);
            let step = f64::powi(2.0, header.coordinate_exponent());
            let length = f64::powi(2.0, i32::from(unit_exponent) - LENGTH_BITS);
            for position in [0, 1, -1, 123_456_789, i32::MIN, i32::MAX] {
                let expected = (f64::from(position) * step - origin) / length;
                let expected = expected.clamp(-(FARTHEST as f64), FARTHEST as f64);
                let found = header.on_lattice(Position([position; 3]));
                assert_eq!(found, [expected as i64; 3], "{position} from {origin}");
                if expected.abs() < FARTHEST as f64 {
                    assert_eq!(header.position(found), Position([position; 3]));
                }
            }
        }
    }

    #[test]
    fn lengths_are_converted_exactly() {
        for (exponent, numerator, denominator, steps) in [
            (0, 7, 2, Some(3)),
            (0, -7, 2, Some(-3)),
            (0, 7, -2, Some(-3)),
            (-25, 9, 1, Some(9 << 25)),
            (-25, -64, 1, Some(i32::MIN)),
            (-25, 64, 1, None),
            (-33, 1, 1, None),
            (-33, 1, 1000, Some(8_589_934)),
            (14, 100_000, 1, Some(6)),
            (62, i64::MAX, 1, Some(1)),
            (63, i64::MAX, 1, Some(0)),
            (63, i64::MIN, 1, Some(-1)),
            (63, i64::MIN, i64::MIN, Some(0)),
            (1000, i64::MIN, 1, Some(0)),
            (-93, 1, i64::MAX, Some(1 << 30)),
            (-94, 1, i64::MAX, None),
            (-1000, 1, i64::MIN, None),
            (i32::MIN, 0, 1, Some(0)),
            (i32::MIN, 1, 1, None),
            (i32::MAX, i64::MAX, 1, Some(0)),
            (0, 1, 0, None),
        ] {
            let found = coordinate_steps(exponent, numerator, denominator);
            assert_eq!(found, steps, "{numerator} / {denominator} at 2^{exponent}");
        }
    }

    #[test]
    fn no_header_makes_a_place_leave_its_range() {
        for origin in [f64::MAX, f64::MIN, f64::NAN, f64::INFINITY, 5e-324, -0.0] {
            for unit_exponent in [i16::MIN, -1000, 0, 1000, i16::MAX] {
                for shift in [0, MAX_COORDINATE_SHIFT, u8::MAX] {
                    let header = header(unit_exponent, shift, origin);
                    for position in [i32::MIN, 0, i32::MAX] {
                        let found = header.on_lattice(Position([position; 3]));
                        assert!(found.iter().all(|x| x.abs() <= FARTHEST));
                    }
                }
            }
        }
        let header = header(-15, MAX_COORDINATE_SHIFT, 0.0);
        assert_eq!(header.on_lattice(Position([i32::MIN; 3])), [-FARTHEST; 3]);
    }
}
