//! The proofs of a pose, and its boxes.

use crate::accel::hierarchy::refit;
use crate::deform::DeformError;
use crate::format::record::{Pair, UnitBox};
use crate::format::width::{Corners, Vertex};
use crate::format::{Kind, Leaf};
use crate::geometry::triangle::Triangles;
use crate::number::fixed::halves::product;
use crate::scene::Scene;
use core::marker::PhantomData;

/// The box that limits vertices, in steps.
pub(super) struct Room<V> {
    sides: [[i32; 2]; 3],
    vertex: PhantomData<V>,
}

impl<V: Vertex> Room<V> {
    pub(super) fn of(bounds: &UnitBox) -> Self {
        let sides = bounds
            .0
            .map(|side| side.map(|x| i32::from(x) << V::STEP_BITS));
        Self {
            sides,
            vertex: PhantomData,
        }
    }

    /// Returns true if a place lies in the box, faces included.
    #[inline(always)]
    pub(super) fn holds(&self, steps: [i32; 3]) -> bool {
        let mut axes = self.sides.iter().zip(steps);
        axes.all(|(&[low, high], x)| low <= x && x <= high)
    }
}

fn steps<V: Vertex>(vertex: &V) -> [i32; 3] {
    [vertex.steps(0), vertex.steps(1), vertex.steps(2)]
}

/// Proves that vertices lie in the scene's box.
pub(super) fn check_room<V: Vertex>(scene: &Scene<'_>, vertices: &[V]) -> Result<(), DeformError> {
    let room = Room::<V>::of(scene.bounds());
    match vertices.iter().position(|it| !room.holds(steps(it))) {
        Some(vertex) => Err(DeformError::OutsideRoom { vertex }),
        None => Ok(()),
    }
}

/// Returns true if corners are three different places on a line.
///
/// For most triangles, the lower half of one component of the normal is enough to return false.
#[inline(always)]
fn is_needle<V: Vertex>(a: &V, b: &V, c: &V) -> bool {
    let edge = |to: &V, k: usize| to.steps(k).wrapping_sub(a.steps(k));
    let one = edge(b, 1).wrapping_mul(edge(c, 2));
    one == edge(b, 2).wrapping_mul(edge(c, 1)) && lie_on_a_line(a, b, c)
}

/// Decides [`is_needle`] with the exact normal.
#[cold]
#[inline(never)]
fn lie_on_a_line<V: Vertex>(a: &V, b: &V, c: &V) -> bool {
    let [a, b, c] = [a, b, c].map(steps);
    let edge = |to: [i32; 3], k: usize| to[k].wrapping_sub(a[k]);
    // Edges have 25 bits and a sign, so the products have 51.
    let across =
        |i: usize, j: usize| product(edge(b, i), edge(c, j)) != product(edge(b, j), edge(c, i));
    if across(1, 2) || across(2, 0) || across(0, 1) {
        return false;
    }
    a != b && b != c && c != a
}

/// Computes the boxes of a pose again, and proves that no triangle is a needle.
pub(super) fn refit<V: Vertex>(
    scene: &Scene<'_>,
    vertices: &[V],
    pairs: &mut [Pair],
) -> Result<(), DeformError> {
    let needle = match &scene.geometry.shapes.triangles {
        Triangles::U16(triangles) => fit(scene, vertices, triangles, pairs),
        Triangles::U32(triangles) => fit(scene, vertices, triangles, pairs),
    };
    match needle {
        Some(slot) => Err(DeformError::Collapsed {
            primitive: scene.primitive(Kind::Triangle, slot),
        }),
        None => Ok(()),
    }
}

/// Computes the boxes; returns the slot of a triangle that is a needle.
fn fit<V: Vertex, I: Corners>(
    scene: &Scene<'_>,
    vertices: &[V],
    triangles: &[I],
    pairs: &mut [Pair],
) -> Option<u32> {
    let geometry = &scene.geometry;
    let mut needle = None;
    if pairs.is_empty() {
        // One leaf, or only the list.
        around(vertices, triangles, 0, &mut needle);
    }
    refit::refit(pairs, |number| {
        let leaf = geometry.leaf(number)?;
        if leaf.kind != Kind::Triangle {
            return others(scene, leaf);
        }
        let triangles = triangles.get(leaf.slots())?;
        around(vertices, triangles, leaf.first, &mut needle)
    });
    needle
}

/// The box around triangles, of which the first has this slot.
#[inline(always)]
fn around<V: Vertex, I: Corners>(
    vertices: &[V],
    triangles: &[I],
    first: u32,
    needle: &mut Option<u32>,
) -> Option<UnitBox> {
    let (mut lowest, mut highest) = ([i32::MAX; 3], [i32::MIN; 3]);
    for (triangle, slot) in triangles.iter().zip(first..) {
        let [a, b, c] = triangle.corners();
        let (a, b, c) = (vertices.get(a)?, vertices.get(b)?, vertices.get(c)?);
        if is_needle(a, b, c) {
            *needle = Some(slot);
        }
        for k in 0..3 {
            let [a, b, c] = [a.steps(k), b.steps(k), c.steps(k)];
            lowest[k] = lowest[k].min(a).min(b).min(c);
            highest[k] = highest[k].max(a).max(b).max(c);
        }
    }
    // Rounded as `UnitBox::around` does.
    let less = (1_i32 << V::STEP_BITS) - 1;
    let axis = |k: usize| {
        [
            (lowest[k] >> V::STEP_BITS) as i16,
            (highest[k].wrapping_add(less) >> V::STEP_BITS) as i16,
        ]
    };
    Some(UnitBox([axis(0), axis(1), axis(2)]))
}

/// The box of a leaf whose primitives have no vertices.
#[cold]
#[inline(never)]
fn others(scene: &Scene<'_>, leaf: Leaf) -> Option<UnitBox> {
    let shapes = &scene.geometry.shapes;
    let boxes = leaf
        .slots()
        .filter_map(|slot| shapes.bounds(leaf.kind, slot));
    boxes.reduce(|a, b| a.union(&b))
}

#[cfg(test)]
mod tests {
    use crate::format::record::Vertex24;

    #[test]
    fn needles_are_three_places_on_a_line() {
        let is_needle = |corners: [[i32; 3]; 3]| {
            let [a, b, c] = corners.map(Vertex24);
            super::is_needle(&a, &b, &c)
        };
        let [a, b, c] = [[-9, 4, 7], [-8, 6, 10], [-6, 10, 16]];
        assert!(is_needle([a, b, c]) && is_needle([b, a, c]) && is_needle([c, b, a]));
        // If two corners coincide, the neighbors share an edge.
        assert!(!is_needle([a, a, c]) && !is_needle([a, c, a]) && !is_needle([c, c, c]));
        for k in 0..3 {
            let mut aside = b;
            aside[k] += 1;
            assert!(!is_needle([a, aside, c]));
        }
        let far = (1 << 23) - 256;
        assert!(is_needle([[-far; 3], [far; 3], [0; 3]]));
        assert!(!is_needle([[-far; 3], [far; 3], [0, 0, 1]]));
        // The lower halves of products agree.
        assert!(!is_needle([[0; 3], [0, 1 << 16, 0], [0, 0, 1 << 16]]));
    }
}
