//! Triangles: watertight, with t from the triangle's plane.
//!
//! A vertex is projected along the ray onto the plane of the two minor axes. The arithmetic depends only on the vertex
//! and the ray, so every triangle at a vertex computes the same point. The signs of the edge tests on those points are
//! exact ([`Project::surrounds_origin`](crate::geometry::Project::surrounds_origin)). So the projected mesh is a mesh,
//! however the projection was rounded. No ray slips between two triangles of it (after Woop, Benthin, Wald, "Watertight
//! Ray/Triangle Intersection", JCGT 2013).
//!
//! `t` is not interpolated, because interpolation fails on stretched triangles. It comes from the plane, whose normal
//! is computed in integers without any rounding and is the same in every number format.

use crate::axis::pick;
use crate::format::limits::{WIDE_INDICES, WIDE_LATTICE};
use crate::format::range::At;
use crate::format::record::{UnitBox, Vertex16, Vertex24};
use crate::format::width::{Corners, Vertex};
use crate::format::{BlobError, Field, Kind, SectionKind, Sections};
use crate::geometry::Project;
use crate::geometry::primitive::InScene;
use crate::geometry::project::AxisProjection;
use crate::geometry::{Surface, cross_plane, flat, half_open};
use crate::number::Arithmetic;
use crate::number::fixed::halves::product;
use crate::ray::Ray;
use crate::target::{inline_on_hosts, inline_unless_small};

/// The vertices of all meshes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Vertices<'a> {
    V16(&'a [Vertex16]),
    V24(&'a [Vertex24]),
}

impl<'a> Vertices<'a> {
    pub(crate) fn read(sections: &Sections<'a>, short: bool) -> Result<Self, BlobError> {
        let section = SectionKind::Vertices;
        Ok(if short {
            Vertices::V16(sections.records(section)?)
        } else {
            Vertices::V24(sections.records(section)?)
        })
    }

    /// Proves that all vertices lie in the scene's box. Returns how many there are.
    pub(crate) fn validate(&self, bounds: &UnitBox) -> Result<usize, BlobError> {
        let section = SectionKind::Vertices;
        let count = if Kind::Triangle.is_available() {
            self.len()
        } else {
            0
        };
        for index in 0..count {
            let at = At { section, index };
            InScene { at, bounds }
                .point(Field::Coordinate, self.position(index).unwrap_or_default())?;
        }
        Ok(count)
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Vertices::V16(vertices) => vertices.len(),
            Vertices::V24(vertices) => vertices.len(),
        }
    }

    /// Returns all vertices as stored; `None` if they have another type.
    pub(crate) fn stored<V: Vertex>(&self) -> Option<&'a [V]> {
        match self {
            Vertices::V16(vertices) if V::STEP_BITS == Vertex16::STEP_BITS => {
                bytemuck::try_cast_slice(vertices).ok()
            }
            Vertices::V24(vertices) if V::STEP_BITS == Vertex24::STEP_BITS => {
                bytemuck::try_cast_slice(vertices).ok()
            }
            _ => None,
        }
    }

    /// Replaces the vertices by others of the same type.
    pub(crate) fn replace<V: Vertex>(&mut self, others: &'a [V]) {
        match self {
            Vertices::V16(vertices) => {
                *vertices = bytemuck::try_cast_slice(others).unwrap_or_default();
            }
            Vertices::V24(vertices) => {
                *vertices = bytemuck::try_cast_slice(others).unwrap_or_default();
            }
        }
    }

    /// A vertex in 1/256 unit.
    pub(crate) fn position(&self, index: usize) -> Option<[i32; 3]> {
        match self {
            Vertices::V16(vertices) => vertices.get(index).map(Vertex::position),
            Vertices::V24(_) if !WIDE_LATTICE => None,
            Vertices::V24(vertices) => vertices.get(index).map(Vertex::position),
        }
    }
}

/// The triangles of all meshes, as vertex indices.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Triangles<'a> {
    U16(&'a [[u16; 3]]),
    U32(&'a [[u32; 3]]),
}

impl<'a> Triangles<'a> {
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        let section = SectionKind::Triangles;
        Ok(if is_narrow(sections) || sections.len(section) == 0 {
            Triangles::U16(sections.records(section)?)
        } else {
            Triangles::U32(sections.records(section)?)
        })
    }

    /// Proves that the first triangles have vertices.
    pub(crate) fn validate(&self, count: usize, vertices: usize) -> Result<(), BlobError> {
        let section = SectionKind::Triangles;
        (0..count).try_for_each(|index| {
            let corners = self.corners(index).unwrap_or_default();
            let corners = corners.map(|corner| corner as i64);
            At { section, index }.all_within(Field::Vertex, &corners, 0, vertices as i64 - 1)
        })
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Triangles::U16(triangles) => triangles.len(),
            Triangles::U32(triangles) => triangles.len(),
        }
    }

    pub(crate) fn corners(&self, index: usize) -> Option<[usize; 3]> {
        match self {
            Triangles::U16(triangles) => triangles.get(index).map(Corners::corners),
            Triangles::U32(_) if !WIDE_INDICES => None,
            Triangles::U32(triangles) => triangles.get(index).map(Corners::corners),
        }
    }
}

/// Returns true if the vertex indices of a blob have 16 bits.
pub(crate) fn is_narrow(sections: &Sections<'_>) -> bool {
    sections.get(SectionKind::Triangles).stride == size_of::<[u16; 3]>()
}

/// The projection along a ray. It holds how its origin sees coordinates on the axes in the order of their roles (the
/// two minor ones, then the major one). It also holds how far the ray moves on them per step of depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection<N> {
    pub(crate) axes: [AxisProjection<N>; 3],
    pub(crate) shear: [N; 2],
    pub(in crate::geometry) major: usize,
}

/// Marks a major axis that is not known at compile time.
pub(crate) const ANY: usize = 3;

/// The axis of a role, by a major axis as a constant, or else by the ray's own.
#[inline(always)]
fn axis<const MAJOR: usize>(major: usize, role: usize) -> usize {
    let major = if MAJOR == ANY { major } else { MAJOR };
    match major {
        0 => pick([1, 2, 0], role),
        1 => pick([2, 0, 1], role),
        _ => role,
    }
}

impl<N: Project> Projection<N> {
    /// The projection of vertices `V` along a ray whose major axis is `MAJOR`, or [`ANY`].
    #[inline(always)]
    pub(crate) fn of<const MAJOR: usize, V: Vertex>(ray: &Ray<N>) -> Self {
        let slope = |role: usize| pick(ray.slope, axis::<MAJOR>(ray.major, role));
        let origin = |role: usize| pick(ray.origin, axis::<MAJOR>(ray.major, role));
        let axis = |role: usize| N::axis_projection(origin(role), slope(role), V::STEP_BITS);
        let depth = N::depth_projection(origin(2), slope(2), V::STEP_BITS);
        let shear = |role: usize| N::shear(slope(role), slope(2));
        Self {
            axes: [axis(0), axis(1), depth],
            shear: [shear(0), shear(1)],
            major: ray.major,
        }
    }

    inline_unless_small!(
        /// Returns true if a ray whose major axis is `MAJOR` hits a triangle, edges included. Returns false if the
        /// triangle is seen edge on.
        ///
        /// Cost: 9 loads and some 30 multiplications and additions.
        pub(crate) fn meets<const MAJOR: usize, V: Vertex>(&self, a: &V, b: &V, c: &V) -> bool {
            let seen = |vertex: &V, role: usize| {
                let coordinate = vertex.steps(axis::<MAJOR>(self.major, role));
                N::project(coordinate, &pick(self.axes, role))
            };
            let depth = [seen(a, 2), seen(b, 2), seen(c, 2)];
            let across = |role: usize| {
                let shear = if role == 0 {
                    self.shear[0]
                } else {
                    self.shear[1]
                };
                [
                    seen(a, role) + N::shear_by(depth[0], shear),
                    seen(b, role) + N::shear_by(depth[1], shear),
                    seen(c, role) + N::shear_by(depth[2], shear),
                ]
            };
            let x = across(0);
            if N::same_sign(x) {
                return false;
            }
            let y = across(1);
            if N::same_sign(y) {
                return false;
            }
            N::surrounds_origin([x[0], y[0]], [x[1], y[1]], [x[2], y[2]])
        }
    );
}

/// Returns true if a ray passes through a triangle by the [half-open rule](crate::geometry::half_open). Where two
/// triangles share an edge, the ray passes through one of them there. If both lie on one side of it, it passes through
/// both or neither.
#[inline(never)]
pub(crate) fn passes<N: Project>(ray: &Ray<N>, corners: [[i32; 3]; 3]) -> bool {
    // Projected like coarser coordinates: their steps differ by a power of two.
    let Projection { axes, shear, major } = Projection::<N>::of::<ANY, Vertex24>(ray);
    let corner = |corner: [i32; 3]| {
        let seen = |role: usize| {
            let coordinate = pick(corner, axis::<ANY>(major, role));
            N::project(coordinate, &pick(axes, role))
        };
        let depth = seen(2);
        [
            seen(0) + N::shear_by(depth, shear[0]),
            seen(1) + N::shear_by(depth, shear[1]),
        ]
    };
    let [a, b, c] = corners;
    half_open::encloses_origin(corner(a), corner(b), corner(c))
}

/// The point at which a ray crosses the plane of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaneCrossing<N> {
    pub(crate) t: N,
    /// True if `t` needs no clamping: see [`cross`].
    pub(crate) is_steep: bool,
    /// The triangle's normal, of any length.
    pub(crate) normal: [N; 3],
}

/// Returns where a ray crosses the plane of a triangle that it [hits](Projection::meets). Returns `None` where the ray
/// runs along the plane.
///
/// A steep hit needs no clamping of t to the interval of the triangle's box, because t already lies in it. Let `q` be
/// the point of the triangle that is seen where the ray is, and `t'` its depth. Its lateral distance from the ray is
/// the rounding of the projection ([`Project::shear_by`](crate::geometry::Project::shear_by)). `n . q` differs from its
/// value for the plane through the first corner by the rounding of the normal `n`. That is less than a step per
/// component, over the triangle's extent of less than 2^16 units.
///
/// In [`Fixed`](crate::number::Fixed), `n` has 30 fraction bits and a projected coordinate is off by less than 2^-13
/// unit. So `|n . d| |t - t'|` is below `(3 * 2^16 + 2 * 2^30 * 2^-13) / 2^30 < 2^-11` units. Where `|n . d|` is at
/// least 2^-8, the hit lies within 1/8 unit of `q`. A point within 1/4 unit of a box has a t in its interval (see
/// [`cull`](crate::accel)).
#[inline(always)]
pub(crate) fn cross<N: Project>(ray: &Ray<N>, corners: [[i32; 3]; 3]) -> Option<PlaneCrossing<N>> {
    let relative = |axis: usize| N::from_lattice(corners[0][axis]) - ray.origin[axis];
    let relative = [relative(0), relative(1), relative(2)];
    let normal = normal(corners);
    let approach = N::dot(normal, ray.slope);
    let t = cross_plane(normal, relative, approach)?;
    Some(PlaneCrossing {
        t,
        is_steep: N::is_steep(approach),
        normal,
    })
}

inline_unless_small!(
    /// Returns the normal, of any length: exact except for one rounding per component.
    fn normal<N: Arithmetic>([a, b, c]: [[i32; 3]; 3]) -> [N; 3] {
        let edge = |from: [i32; 3], to: [i32; 3]| {
            let axis = |k: usize| to[k].wrapping_sub(from[k]);
            [axis(0), axis(1), axis(2)]
        };
        let (p, q) = (edge(a, b), edge(a, c));
        // Edges have 25 bits and a sign, so the products have 51.
        let component = |i: usize, j: usize| product(p[i], q[j]).wrapping_sub(product(p[j], q[i]));
        N::direction([component(1, 2), component(2, 0), component(0, 1)])
    }
);

/// The box of a triangle.
#[inline(always)]
pub(crate) fn bounds([a, b, c]: [[i32; 3]; 3]) -> UnitBox {
    let lowest = |k: usize| a[k].min(b[k]).min(c[k]);
    let highest = |k: usize| a[k].max(b[k]).max(c[k]);
    UnitBox::around(
        [lowest(0), lowest(1), lowest(2)],
        [highest(0), highest(1), highest(2)],
    )
}

inline_on_hosts!(
    /// The front is the side from which the corners run counter-clockwise.
    pub(crate) fn surface<N: Arithmetic>(corners: [[i32; 3]; 3], point: [N; 3]) -> Surface<N> {
        flat::surface(normal(corners), corners[0], point)
    }
);
