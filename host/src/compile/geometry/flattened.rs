//! Finds closed meshes that have no inside on the lattice.

use glam::DVec3;
use std::collections::HashMap;

type Point = [i32; 3];

/// Returns whether a closed mesh with an inside lies in one plane once it is snapped. `vertices` are the
/// given and the snapped ones.
///
/// A ray from within such a mesh meets nothing.
pub fn is_flattened(vertices: (&[DVec3], &[Point]), triangles: &[[u32; 3]]) -> bool {
    let (given, snapped) = vertices;
    let corners = |triangle: &[u32; 3]| triangle.map(|vertex| snapped[vertex as usize]);
    let mut kept = triangles
        .iter()
        .map(corners)
        .filter(|&corners| !is_degenerate(corners));
    let Some(first) = kept.next() else {
        return false;
    };
    let normal = normal(first);
    let height = |point: Point| {
        let axis = |k: usize| normal[k] * (i128::from(point[k]) - i128::from(first[0][k]));
        axis(0) + axis(1) + axis(2)
    };
    let is_flat = kept.all(|corners| corners.into_iter().all(|corner| height(corner) == 0));
    is_flat
        && is_closed(triangles.iter().map(corners))
        && has_thickness(given, triangles, normal.map(|x| x as f64).into())
}

/// Normal to a triangle, exactly.
fn normal([a, b, c]: [Point; 3]) -> [i128; 3] {
    let edge = |to: Point| [0, 1, 2].map(|k: usize| i128::from(to[k]) - i128::from(a[k]));
    let (p, q) = (edge(b), edge(c));
    [0, 1, 2].map(|k: usize| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        p[i] * q[j] - p[j] * q[i]
    })
}

/// Returns whether an even number of triangles meet at every edge.
fn is_closed(triangles: impl Iterator<Item = [Point; 3]>) -> bool {
    let mut odd: HashMap<[Point; 2], bool> = HashMap::new();
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if from != to {
                let is_odd = odd.entry([from.min(to), from.max(to)]).or_default();
                *is_odd = !*is_odd;
            }
        }
    }
    odd.into_values().all(|is_odd| !is_odd)
}

/// Returns whether the given vertices of triangles do not lie in one plane, within the rounding of an `f64`.
fn has_thickness(vertices: &[DVec3], triangles: &[[u32; 3]], normal: DVec3) -> bool {
    /// Relative to the largest coordinate.
    const ROUNDED: f64 = 16.0 * f64::EPSILON;
    let used = || triangles.iter().flatten().map(|&it| vertices[it as usize]);
    let size = used().fold(0.0, |size: f64, it| size.max(it.abs().max_element()));
    // Scaled, so that products stay in range.
    let normal = (normal / normal.abs().max_element()).normalize();
    let heights = used().map(|it| normal.dot(it / size));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| {
        (low.min(it), high.max(it))
    });
    high - low > ROUNDED
}

/// Returns whether the corners lie on a line, exactly.
pub fn is_degenerate([a, b, c]: [[i32; 3]; 3]) -> bool {
    let edge = |to: [i32; 3]| [0, 1, 2].map(|k| i64::from(to[k]) - i64::from(a[k]));
    let (p, q) = (edge(b), edge(c));
    (0..3).all(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        p[i] * q[j] == p[j] * q[i]
    })
}
