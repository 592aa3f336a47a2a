//! The two traits of shapes on the host: [`Geometric`] for all primitives, [`Analytic`] for shapes with a record.

use super::direction::integers;
use super::exact::{Line, Real, Vector};
use super::keys::Keys;
use super::lattice::Lattice;
use super::snapped::{Snapped, real};
use super::transform::{Mesh, Misfit, similarity, turned};
use crate::random::Random;
use glam::{DAffine3, DVec3};
use gridel_core::format::record::UnitBox;
use std::cell::Cell;

/// A normal, and the figures that its error bound is proportional to.
pub struct Normal {
    pub exact: Vector,
    /// The ratio of the largest coordinate to the length from which the direction is computed.
    pub condition: f64,
    /// Half of a cone's slant height, from which its angle is computed; infinite for other surfaces.
    pub size: f64,
}

impl Normal {
    pub(super) fn flat(exact: Vector) -> Self {
        Self {
            exact,
            condition: 1.0,
            size: f64::INFINITY,
        }
    }
}

/// The kind of surface that a primitive has.
#[derive(Clone, Copy, Debug)]
pub enum Surface {
    /// The sides of its box.
    Box,
    /// Part of a plane.
    Plane { normal: DVec3, point: DVec3 },
    /// A whole sphere.
    Sphere { center: DVec3, radius: f64 },
    /// Any other surface inside its box.
    Curved,
}

/// The geometry of a primitive: of a triangle, or of a shape.
///
/// A crossing can be computed for the primitive grown or shrunk by a length on all sides. `verify` judges
/// errors so: an answer is within a length if a primitive that differs by at most that length gives the
/// same answer. Grazing rays need no other rule.
pub trait Geometric {
    /// Returns whether the primitive has no inside.
    fn is_flat(&self) -> bool {
        false
    }

    /// Returns whether no line enters the primitive twice.
    fn is_convex(&self) -> bool {
        true
    }

    /// Returns two spheres, as centers and radii. Their common box holds the primitive, and its middle lies
    /// halfway between the centers.
    fn ends(&self) -> [(DVec3, f64); 2];

    /// Returns the kind of surface.
    fn surface(&self) -> Surface {
        Surface::Curved
    }

    /// Returns the size of its smallest feature. A triangle has none of its own: its mesh has.
    fn feature(&self) -> Option<f64>;

    /// Returns the middle.
    fn middle(&self) -> DVec3 {
        let [(first, _), (last, _)] = self.ends();
        first.midpoint(last)
    }

    /// Returns its approximate size.
    fn size(&self) -> f64 {
        let [(first, first_radius), (last, last_radius)] = self.ends();
        first.distance(last).max(first_radius).max(last_radius)
    }

    /// Returns the largest magnitude of a coordinate.
    fn extent(&self) -> f64 {
        let [(first, first_radius), (last, last_radius)] = self.ends();
        first.abs().max(last.abs()).max_element() + first_radius.max(last_radius)
    }

    /// Returns a point inside or on it, roughly in a direction from its middle.
    fn point(&self, direction: DVec3, random: &mut Random) -> DVec3;

    /// Returns the intervals of a line inside the primitive, in order. `grow` moves the surface outward; a
    /// negative one moves it inward.
    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)>;

    /// Returns how far the surface would have to grow to hold a point. For flat primitives, counts their plane only.
    fn excess(&self, point: [f64; 3]) -> f64;

    /// Returns the outward (or front) normals at a point, one for each face that can hold it.
    fn normals(&self, point: [f64; 3]) -> Vec<Normal>;

    /// Returns the normals at a place where the surface meets itself, if a point is within `off` of it.
    fn normals_within(&self, _point: [f64; 3], _off: f64) -> Option<Vec<Normal>> {
        None
    }

    /// Returns the normal on the side of a direction, for a point within `off` of the axis. So near to the axis
    /// every side is possible, and at a tip every normal of the mantle is one.
    fn normal_towards(&self, _direction: [f64; 3], _point: [f64; 3], _off: f64) -> Option<Normal> {
        None
    }
}

/// A change of a shape's numbers: functions of points, directions and lengths.
pub struct Map<'m> {
    pub point: &'m dyn Fn(DVec3) -> DVec3,
    pub direction: &'m dyn Fn(DVec3) -> DVec3,
    pub length: &'m dyn Fn(f64) -> f64,
}

/// A shape with a record of its own: reading, transforms, snapping to the lattice.
///
/// The registry of shapes in the core names every record, and so every implementation of this. In scene
/// files, and up to the lattice, a shape is in scene units; as a primitive of a blob it is in units.
pub trait Analytic: Geometric + Sized {
    /// The cost of an intersection test, relative to a triangle's: about the mean of boards with and without
    /// floating-point units.
    const TEST_COST: f64;

    /// The values of `kind` in scene files that mean this shape, with their keys.
    const KINDS: &[(&str, &[&str])];

    /// The record of the core.
    type Record;

    /// Reads a kind of [`KINDS`](Self::KINDS).
    fn read<K: Keys>(kind: &str, keys: &K) -> Result<Self, K::Error>;

    /// Returns the name that reports use.
    fn kind(&self) -> &'static str {
        Self::KINDS[0].0
    }

    /// Returns the shape with all numbers changed.
    fn map(&self, by: &Map<'_>) -> Self;

    /// Returns whether all numbers are finite.
    fn is_finite(&self) -> bool {
        let all = Cell::new(true);
        let vector = |v: DVec3| {
            all.set(all.get() && v.is_finite());
            v
        };
        self.map(&Map {
            point: &vector,
            direction: &vector,
            length: &|x| {
                all.set(all.get() && x.is_finite());
                x
            },
        });
        all.get()
    }

    /// Returns `false` for an empty shape, such as a sphere of radius 0.
    fn has_extent(&self) -> bool;

    /// Returns the box, as its lowest and its highest corner.
    fn bounds(&self) -> [DVec3; 2];

    /// Returns the largest `point.dot(direction)` over all points of the shape: its support function. An unbounded
    /// shape counts as its point.
    fn support(&self, direction: DVec3) -> f64;

    /// Returns the normals of flat parts, with lengths of twice their areas.
    fn faces(&self) -> Vec<DVec3> {
        Vec::new()
    }

    /// Returns the transformed shape.
    ///
    /// # Errors
    /// If the result is not this kind of shape.
    fn transformed(&self, by: &DAffine3) -> Result<Self, Misfit> {
        let scale = similarity(by.matrix3)?;
        Ok(self.map(&Map {
            point: &|point| by.transform_point3(point),
            direction: &|direction| turned(by.matrix3, direction),
            length: &|length| length * scale,
        }))
    }

    /// Returns the surface as a mesh, for transforms that `transformed` rejects.
    fn as_mesh(&self) -> Option<Mesh> {
        None
    }

    /// Returns the largest distance between the surfaces of two such shapes.
    fn displacement(&self, other: &Self) -> f64;

    /// Returns the shape on the lattice, in 1/256 unit, that is nearest to this one, and their distance. By
    /// default this is the shape with all numbers rounded.
    fn settled(&self, rounded: Self, _lattice: &Lattice) -> (Self, f64) {
        let displacement = self.displacement(&rounded);
        (rounded, displacement)
    }

    /// Returns the record, and whether its box is in the range of box coordinates. `self` is in 1/256 unit.
    fn record(&self) -> (Self::Record, bool);

    /// Snaps the shape to the lattice. Returns `None` if it collapses.
    fn snapped(&self, lattice: &Lattice) -> Option<Snapped<Self::Record>> {
        if !self.has_extent() {
            return None;
        }
        let rounded = self.map(&Map {
            point: &|point| real(lattice.snap(point)),
            direction: &|direction| real(integers(direction)),
            length: &|length| lattice.snap_length(length).into(),
        });
        if !rounded.has_extent() {
            return None;
        }
        let given = self.map(&Map {
            point: &|point| lattice.in_fine(point),
            direction: &|direction| direction,
            length: &|length| lattice.length_in_fine(length),
        });
        let (settled, displacement) = given.settled(rounded, lattice);
        let (record, fits) = settled.record();
        Some(Snapped {
            record,
            displacement,
            fits,
        })
    }

    /// Returns the box of a record.
    fn record_bounds(record: &Self::Record) -> UnitBox;

    /// Returns the shape of a record, in 1/256 unit.
    fn of_record(record: &Self::Record) -> Self;

    /// Returns the shape of a record, in units.
    fn in_units(record: &Self::Record) -> Self {
        Self::of_record(record).map(&Map {
            point: &|point| point / 256.0,
            direction: &|direction| direction,
            length: &|length| length / 256.0,
        })
    }
}
