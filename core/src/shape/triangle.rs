//! Triangles: watertight, with t from the triangle's plane.
//!
//! A vertex is projected along the ray onto the plane of the two minor axes, by arithmetic that
//! depends on the vertex and the ray alone; so every triangle at a vertex computes the same point.
//! The signs of the edge tests on those points are exact ([`Number::cross2`]). Whatever the
//! projection rounded, the projected mesh is a mesh, and no ray slips between two triangles of it
//! (after Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013). `t` is not
//! interpolated, which goes wrong on stretched triangles, but taken from the plane, whose normal is
//! computed in integers without any rounding and is the same in every number format.

use super::{Crossing, Surface, cross_plane, extent};
use crate::blob::record::{UnitBox, Vertex};
use crate::number::Number;
use crate::ray::Ray;

/// The crossing of a ray whose major axis is `MAJOR` with a triangle, both sides alike.
///
/// Cost: 9 loads, 15 multiplications and additions to reject; 40 more and a division to accept.
#[inline(always)]
pub(crate) fn cross<const MAJOR: usize, N: Number, V: Vertex>(
    ray: &Ray<N>,
    corners: [&V; 3],
) -> Option<Crossing<N>> {
    let (x, y) = ((MAJOR + 1) % 3, (MAJOR + 2) % 3);
    let forward = ray.slope[MAJOR] > N::ZERO;
    let shear = |axis: usize| {
        if forward {
            ray.slope[axis]
        } else {
            -ray.slope[axis]
        }
    };
    let (shear_x, shear_y) = (shear(x), shear(y));
    let project = |vertex: &V| {
        let depth = vertex.length::<N>(MAJOR) - ray.origin[MAJOR];
        [
            vertex.length::<N>(x) - ray.origin[x] - depth * shear_x,
            vertex.length::<N>(y) - ray.origin[y] - depth * shear_y,
        ]
    };
    // Not by `map`, which is not inlined on all targets and then checks indices.
    let (a, b, c) = (
        project(corners[0]),
        project(corners[1]),
        project(corners[2]),
    );
    let zero = N::Wide::default();
    let (u, v) = (N::cross2(b, c), N::cross2(c, a));
    if u < zero && v > zero || u > zero && v < zero {
        return None;
    }
    let w = N::cross2(a, b);
    let negative = u < zero || v < zero || w < zero;
    let positive = u > zero || v > zero || w > zero;
    if negative == positive {
        // Outside, or seen edge on.
        return None;
    }
    let corners = corners.map(Vertex::position);
    let relative = |axis: usize| N::from_lattice(corners[0][axis]) - ray.origin[axis];
    cross_plane(
        ray,
        normal(corners),
        [relative(0), relative(1), relative(2)],
    )
    .map(Crossing::flat)
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
