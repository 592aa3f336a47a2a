//! What the host asks of a primitive and of a shape.

use super::direction::integers;
use super::exact::{Line, Real, Vector};
use super::keys::Keys;
use super::lattice::Lattice;
use super::random::Random;
use super::snapped::{Snapped, real};
use super::transform::{Mesh, Misfit, similarity, turned};
use glam::{DAffine3, DVec3};
use gridel_core::format::record::UnitBox;
use std::cell::Cell;

/// A normal, and what an error of it is proportional to.
pub struct Normal {
    pub exact: Vector,
    /// How often coordinates are larger than the length that the direction is taken from.
    pub condition: f64,
    /// The length that the angle of a cone is taken from, half of its slanted side.
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

/// Where the surface of a primitive lies.
#[derive(Clone, Copy, Debug)]
pub enum Surface {
    /// On the sides of its box.
    Box,
    /// In a plane.
    Plane { normal: DVec3, point: DVec3 },
    /// On all of a sphere.
    Sphere { center: DVec3, radius: f64 },
    /// Somewhere in its box.
    Curved,
}

/// The geometry of a primitive: of a triangle, or of a shape.
///
/// Crossings can be asked of a primitive that is larger or smaller by a length on all sides. That is how
/// errors are judged: an answer is off by no more than a length if some primitive that differs by no more
/// than that length gives it. So a ray that barely touches is judged as fairly as one that strikes head on.
pub trait Geometric {
    /// Whether it encloses nothing.
    fn is_flat(&self) -> bool {
        false
    }

    /// Whether no line enters it twice.
    fn is_convex(&self) -> bool {
        true
    }

    /// Two balls with a box around them that holds all of it; their centres have its middle between them.
    fn ends(&self) -> [(DVec3, f64); 2];

    fn surface(&self) -> Surface {
        Surface::Curved
    }

    /// Its smallest feature; of a triangle, none of its own.
    fn feature(&self) -> Option<f64>;

    /// Its middle.
    fn middle(&self) -> DVec3 {
        let [(first, _), (last, _)] = self.ends();
        first.midpoint(last)
    }

    /// About how large it is.
    fn size(&self) -> f64 {
        let [(first, first_radius), (last, last_radius)] = self.ends();
        first.distance(last).max(first_radius).max(last_radius)
    }

    /// The largest magnitude of a coordinate.
    fn extent(&self) -> f64 {
        let [(first, first_radius), (last, last_radius)] = self.ends();
        first.abs().max(last.abs()).max_element() + first_radius.max(last_radius)
    }

    /// A point of it, in about a direction from its middle.
    fn point(&self, direction: DVec3, random: &mut Random) -> DVec3;

    /// The crossings of a line with it, moved outward by a length (inward by a negative one), in order.
    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)>;

    /// By how much it would have to grow for a point to be on its surface. Of what is flat, its plane alone.
    fn excess(&self, point: [f64; 3]) -> f64;

    /// The outward (or front) normals at a point, one for each face that it may be on.
    fn normals(&self, point: [f64; 3]) -> Vec<Normal>;

    /// The normals at a place where the surface meets itself, if that is as near to a point as it may be
    /// off by.
    fn normals_within(&self, _point: [f64; 3], _off: f64) -> Option<Vec<Normal>> {
        None
    }

    /// The normal on the side of a direction, where a point is as near to an axis as it may be off by: there
    /// the side is not to be told, and at a tip every normal of the mantle supports the solid.
    fn normal_towards(&self, _direction: [f64; 3], _point: [f64; 3], _off: f64) -> Option<Normal> {
        None
    }
}

/// A function of points, one of directions and one of lengths.
pub struct Map<'m> {
    pub point: &'m dyn Fn(DVec3) -> DVec3,
    pub direction: &'m dyn Fn(DVec3) -> DVec3,
    pub length: &'m dyn Fn(f64) -> f64,
}

/// A shape that some numbers describe: all that the host knows of it.
///
/// The registry of shapes in the core names every record, and so every implementation of this. In scene
/// files, and up to the lattice, a shape is in scene units; as a primitive of a blob it is in units.
pub trait Analytic: Geometric + Sized {
    /// What its test costs, a triangle's being 1: about what boards pay, with and without floats.
    const TEST_COST: f64;

    /// The kinds of objects in scene files that are this shape, with their keys.
    const KINDS: &[(&str, &[&str])];

    /// The shape on the lattice.
    type Record;

    /// Reads a kind of [`KINDS`](Self::KINDS).
    fn read<K: Keys>(kind: &str, keys: &K) -> Result<Self, K::Error>;

    /// What people call it.
    fn kind(&self) -> &'static str {
        Self::KINDS[0].0
    }

    /// The shape of other numbers.
    fn map(&self, by: &Map<'_>) -> Self;

    /// Whether all numbers are finite.
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

    /// Whether there is something of it.
    fn has_extent(&self) -> bool;

    /// Its box.
    fn bounds(&self) -> [DVec3; 2];

    /// The normals of what is flat, as long as twice its area.
    fn faces(&self) -> Vec<DVec3> {
        Vec::new()
    }

    /// The shape after a transform, unless it is another then.
    fn transformed(&self, by: &DAffine3) -> Result<Self, Misfit> {
        let scale = similarity(by.matrix3)?;
        Ok(self.map(&Map {
            point: &|point| by.transform_point3(point),
            direction: &|direction| turned(by.matrix3, direction),
            length: &|length| length * scale,
        }))
    }

    /// Vertices and triangles of the same surface, for transforms after which the shape is another.
    fn as_mesh(&self) -> Option<Mesh> {
        None
    }

    /// How far two of these shapes are apart at most.
    fn displacement(&self, other: &Self) -> f64;

    /// The shape in 1/256 unit that lies on the lattice next to a given one, better than that whose numbers
    /// are all rounded, and how far they are apart.
    fn settled(&self, rounded: Self, _lattice: &Lattice) -> (Self, f64) {
        let displacement = self.displacement(&rounded);
        (rounded, displacement)
    }

    /// The record of integers of 1/256 unit, and whether its box lies in the range of box coordinates.
    fn record(&self) -> (Self::Record, bool);

    /// The shape on the lattice, or `None` if the lattice leaves nothing of it.
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

    /// The box of a record.
    fn record_bounds(record: &Self::Record) -> UnitBox;

    /// A record's shape, in 1/256 unit.
    fn of_record(record: &Self::Record) -> Self;

    /// A record's shape, in units.
    fn in_units(record: &Self::Record) -> Self {
        Self::of_record(record).map(&Map {
            point: &|point| point / 256.0,
            direction: &|direction| direction,
            length: &|length| length / 256.0,
        })
    }
}
