//! The reach of a primitive: the points at which a hit on it can be reported.
//!
//! Volumes other than boxes must hold these points, not only the primitive. A hit's t lies in the culling interval of
//! the primitive's box, clamped to it if needed (see `accept_in_box` in `accel::clamp`). That interval is wider than the
//! box. The rule of [`cull`](crate::accel::cull) limits the distance of a hit from the box on each axis. It is 4 units
//! where the ray's slope is 2^-12 or more. On the others, of which there are at most two, it is 16.3 units.
//!
//! A sphere's own test is sharper: the point of a hit lies within a unit of the sphere. The reason is that rounding
//! changes the half chord along the ray by its effect on the chord's square. The error of a square counts by the
//! radius.

use crate::accel::hierarchy::direction::Direction;
use crate::format::Kind;
use crate::format::record::UnitBox;
use crate::geometry::Shapes;

/// The points at which a hit can be reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// About a sphere: center and radius in 1/256 unit.
    Sphere([i32; 3], i32),
    /// About the box of anything else.
    Box(UnitBox),
}

/// Units by which a slab is wider than a sphere, in the slab's own units.
const SLAB_ABOUT_SPHERE: i64 = 1;
/// Units by which a slab is wider than a box. On the steepest directions two axes reach 16.3 units each and count by
/// half.
const SLAB_ABOUT_BOX: i64 = 17;
/// The margin of a bounding sphere around its primitives: a unit for the hit and one for the sphere's test.
const BOUNDING_SPHERE_ABOUT_SPHERE: i64 = 2;
/// The diagonal of 16.3, 16.3 and 4 units, and one unit for the sphere's test.
const BOUNDING_SPHERE_ABOUT_BOX: i64 = 25;

/// Returns the smallest integer whose square is at least this.
fn root_above(square: u64) -> i64 {
    let root = square.isqrt();
    (root + u64::from(root * root < square)) as i64
}

impl Reach {
    /// Returns the reach of a primitive in a blob.
    pub(crate) fn of(shapes: &Shapes<'_>, kind: Kind, index: usize) -> Option<Self> {
        if kind == Kind::Sphere {
            let (center, radius) = shapes.spheres.get(index)?;
            return Some(Self::Sphere(center, radius));
        }
        Some(Self::Box(shapes.bounds(kind, index)?))
    }

    /// Returns the smallest slab of a direction, in its units; on the axes, the sides of the box.
    pub fn slab(&self, direction: Direction) -> [i16; 2] {
        // One unit of the slab in 1/256 unit.
        let unit = 256_i64 << direction.halvings;
        let (low, high, slack) = match *self {
            Self::Sphere(center, radius) => {
                let middle = direction.dot(center.map(i64::from));
                let square = direction.signs.iter().filter(|&&sign| sign != 0).count() as u64;
                let radius = radius.unsigned_abs() as u64;
                let reach = root_above(square * radius * radius);
                (middle - reach, middle + reach, SLAB_ABOUT_SPHERE)
            }
            Self::Box(bounds) => {
                let along = |side: usize| {
                    let corner = [0, 1, 2].map(|k: usize| {
                        let other = direction.signs[k] < 0;
                        i64::from(bounds.0[k][side ^ usize::from(other)]) << 8
                    });
                    direction.dot(corner)
                };
                (along(0), along(1), SLAB_ABOUT_BOX)
            }
        };
        let slack = if direction.halvings == 0 { 0 } else { slack };
        let within = |plane: i64| plane.clamp(i64::from(i16::MIN), i64::from(i16::MAX)) as i16;
        [
            within(low.div_euclid(unit) - slack),
            within(-(-high).div_euclid(unit) + slack),
        ]
    }

    /// Returns true if a sphere, given by center and radius in units, contains the whole reach.
    pub fn in_sphere(&self, center: [i16; 3], radius: u16) -> bool {
        let radius = i64::from(radius) << 8;
        let squared = |apart: [i64; 3]| apart.iter().map(|x| x * x).sum::<i64>();
        let center = center.map(|x| i64::from(x) << 8);
        match *self {
            Self::Sphere(middle, reach) => {
                let room = radius - i64::from(reach) - (BOUNDING_SPHERE_ABOUT_SPHERE << 8);
                let apart = [0, 1, 2].map(|k: usize| i64::from(middle[k]) - center[k]);
                room >= 0 && squared(apart) <= room * room
            }
            Self::Box(bounds) => {
                let room = radius - (BOUNDING_SPHERE_ABOUT_BOX << 8);
                let apart = [0, 1, 2].map(|k: usize| {
                    let [low, high] = bounds.0[k].map(|side| i64::from(side) << 8);
                    (center[k] - low).max(high - center[k])
                });
                room >= 0 && squared(apart) <= room * room
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::hierarchy::direction::DIRECTIONS;

    #[test]
    fn slabs_hold_corners_and_spheres() {
        let bounds = UnitBox([[-300, 40], [7, 900], [-32_767, 32_767]]);
        let sphere = Reach::Sphere([1000, -77_000, 512], 300_001);
        for direction in DIRECTIONS {
            let unit = 256_i64 << direction.halvings;
            let [low, high] = Reach::Box(bounds).slab(direction).map(i64::from);
            for corner in 0..8 {
                let corner = [0, 1, 2].map(|k| i64::from(bounds.0[k][corner >> k & 1]) << 8);
                let place = direction.dot(corner);
                assert!(low * unit <= place && place <= high * unit, "{direction:?}");
            }
            let [low, high] = sphere.slab(direction).map(i64::from);
            let length = f64::sqrt(direction.signs.iter().map(|s| f64::from(s * s)).sum());
            let middle = direction.dot([1000, -77_000, 512]) as f64;
            assert!((low * unit) as f64 <= middle - length * 300_001.0);
            assert!((high * unit) as f64 >= middle + length * 300_001.0);
            let width = ((high - low) * unit) as f64;
            assert!(width <= 2.0 * length * 300_001.0 + 4.0 * unit as f64);
        }
    }

    #[test]
    fn spheres_contain_primitives_with_a_margin() {
        let sphere = Reach::Sphere([256, 512, -768], 256 * 100);
        assert!(sphere.in_sphere([1, 2, -3], 102));
        assert!(!sphere.in_sphere([1, 2, -3], 101));
        assert!(!sphere.in_sphere([1, 2, 9], 102));
        let bounds = Reach::Box(UnitBox([[-30, 30], [-40, 40], [0, 0]]));
        assert!(bounds.in_sphere([0; 3], 75));
        assert!(!bounds.in_sphere([0; 3], 74));
    }
}
