//! Triangles: watertight, with t from the triangle's plane.
//!
//! A vertex is projected along the ray onto the plane of the two minor axes, by arithmetic that
//! depends on the vertex and the ray alone; so every triangle at a vertex computes the same point.
//! The signs of the edge tests on those points are exact ([`Number::surround`]). Whatever the
//! projection rounded, the projected mesh is a mesh, and no ray slips between two triangles of it
//! (after Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013). `t` is not
//! interpolated, which goes wrong on stretched triangles, but taken from the plane, whose normal is
//! computed in integers without any rounding and is the same in every number format.

use super::{Crossing, Surface, cross_plane, extent};
use crate::blob::record::{UnitBox, Vertex};
use crate::number::Number;
use crate::ray::Ray;

/// The projection along a ray: its origin, and how far it strays for each unit of depth, with the
/// axes in the order of their roles (the two minor ones, then the major one).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection<N> {
    pub(super) origin: [N; 3],
    pub(super) shear: [N; 2],
}

impl<N: Number> Projection<N> {
    /// The projection along a ray whose major axis is `MAJOR`, in the measure of vertices `V`.
    #[inline(always)]
    pub(crate) fn of<const MAJOR: usize, V: Vertex>(ray: &Ray<N>) -> Self {
        let role = |role: usize| (MAJOR + 1 + role) % 3;
        let origin = |axis: usize| V::to_measure(ray.origin[axis]);
        let forward = ray.slope[MAJOR] > N::ZERO;
        let shear = |axis: usize| {
            if forward {
                ray.slope[axis]
            } else {
                -ray.slope[axis]
            }
        };
        Self {
            origin: [origin(role(0)), origin(role(1)), origin(MAJOR)],
            shear: [shear(role(0)), shear(role(1))],
        }
    }

    /// A vertex, projected.
    #[inline(always)]
    fn project<const MAJOR: usize, V: Vertex>(&self, vertex: &V) -> [N; 2] {
        let depth = vertex.measure::<N>(MAJOR) - self.origin[2];
        let across = |role: usize| {
            let coordinate = vertex.measure::<N>((MAJOR + 1 + role) % 3);
            coordinate - self.origin[role] - depth * self.shear[role]
        };
        [across(0), across(1)]
    }

    /// Whether a ray whose major axis is `MAJOR` meets a triangle, edges included; not if it is
    /// seen edge on.
    ///
    /// Cost: 9 loads and some 30 multiplications and additions.
    #[inline(always)]
    pub(crate) fn meets<const MAJOR: usize, V: Vertex>(&self, a: &V, b: &V, c: &V) -> bool {
        let a = self.project::<MAJOR, V>(a);
        let b = self.project::<MAJOR, V>(b);
        let c = self.project::<MAJOR, V>(c);
        N::surround(a, b, c)
    }
}

/// The crossing of a ray with the plane of a triangle that it meets.
#[inline(always)]
pub(crate) fn cross<N: Number>(ray: &Ray<N>, corners: [[i32; 3]; 3]) -> Option<Crossing<N>> {
    let relative = |axis: usize| N::from_lattice(corners[0][axis]) - ray.origin[axis];
    let relative = [relative(0), relative(1), relative(2)];
    cross_plane(ray, normal(corners), relative).map(Crossing::flat)
}

/// The normal, of any length: exact but for one rounding a component.
#[inline(always)]
fn normal<N: Number>([a, b, c]: [[i32; 3]; 3]) -> [N; 3] {
    let edge = |from: [i32; 3], to: [i32; 3]| {
        let axis = |k: usize| to[k].wrapping_sub(from[k]) as i64;
        [axis(0), axis(1), axis(2)]
    };
    let (p, q) = (edge(a, b), edge(a, c));
    // Edges have 25 bits and a sign, so the products have 51.
    let component = |i: usize, j: usize| {
        p[i].wrapping_mul(q[j])
            .wrapping_sub(p[j].wrapping_mul(q[i]))
    };
    N::direction([component(1, 2), component(2, 0), component(0, 1)])
}

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

/// The front is where the corners run counter-clockwise.
pub(crate) fn surface<N: Number>(corners: [[i32; 3]; 3]) -> Surface<N> {
    let extents = corners.map(|corner| extent(corner.map(N::from_lattice)));
    Surface {
        normal: N::normalize(normal(corners)).0,
        extent: extents[0].max(extents[1]).max(extents[2]),
    }
}
