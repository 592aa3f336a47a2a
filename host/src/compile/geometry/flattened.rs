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
        && has_thickness(given, &without_backs(given, triangles))
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

/// Returns the triangles without pairs of the same corners: between the sides of a sheet there is no inside.
fn without_backs(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut alone: HashMap<[[u64; 3]; 3], [u32; 3]> = HashMap::new();
    for triangle in triangles {
        // Without the sign of a zero.
        let bits = |vertex: u32| {
            (vertices[vertex as usize] + 0.0)
                .to_array()
                .map(f64::to_bits)
        };
        let mut corners = triangle.map(bits);
        corners.sort_unstable();
        if alone.remove(&corners).is_none() {
            alone.insert(corners, *triangle);
        }
    }
    alone.into_values().collect()
}

/// Returns whether the given vertices of triangles do not lie in one plane, within the rounding of an `f64`.
fn has_thickness(vertices: &[DVec3], triangles: &[[u32; 3]]) -> bool {
    /// Relative to the largest coordinate: what a few turns and moves of a vertex round.
    const ROUNDED: f64 = 32.0 * f64::EPSILON;
    let used = || triangles.iter().flatten().map(|&it| vertices[it as usize]);
    let size = used().fold(0.0, |size: f64, it| size.max(it.abs().max_element()));
    // Scaled, so that products stay in range. The normal is that of a wide triangle between vertices, because the
    // corners of a small one would turn it by their rounding.
    let place = |it: DVec3| it / size;
    let farthest = |far: &dyn Fn(DVec3) -> f64| {
        let places = used().map(place);
        places.max_by(|&a, &b| far(a).total_cmp(&far(b)))
    };
    let Some(first) = used().next().map(place) else {
        return false;
    };
    let second = farthest(&|it| it.distance_squared(first)).unwrap_or(first);
    let along = second - first;
    let third = farthest(&|it| along.cross(it - first).length_squared()).unwrap_or(first);
    let Some(normal) = along.cross(third - first).try_normalize() else {
        return false;
    };
    let heights = used().map(|it| normal.dot(place(it) - first));
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

#[cfg(test)]
mod tests {
    use crate::compile::{CompileError, Options, compile};
    use crate::scene::read;

    fn is_rejected(file: String) -> bool {
        let imported = read("sheet.toml".as_ref(), file.into(), &Default::default());
        let found = compile(&imported.unwrap().scene, &Options::default());
        matches!(found, Err(CompileError::Flattened { .. }))
    }

    #[test]
    fn sheets_with_two_sides_never_had_an_inside() {
        let mut random = crate::random::Random(7);
        for _ in 0..20 {
            let [x, y, z] = [0; 3].map(|_| 360.0 * random.unit());
            let box_ = "kind = 'box'\nmin = [0, 0, 0]\nmax = [1, 0, 1]";
            let turned = format!("[[object]]\n{box_}\nrotate = [{x}, {y}, {z}]");
            assert!(!is_rejected(turned), "a box turned by {x}, {y}, {z}");

            // A sheet that is not level, either: all its faces have backs.
            let corners = [0; 4].map(|_| [0; 3].map(|_| random.unit()));
            let card = format!(
                "[[object]]\nkind = 'mesh'\nvertices = {corners:?}\nfaces = [[0, 1, 2], [2, 1, 0], [1, 2, 3], [3, 2, 1]]"
            );
            assert!(!is_rejected(card), "{corners:?}");
        }
    }

    #[test]
    fn slabs_thinner_than_a_step_are_rejected() {
        for thickness in [1e-12, 1e-10, 1e-8] {
            let slab = format!(
                "[[object]]\nkind = 'mesh'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.3, 0.3, {thickness}]]
                faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]"
            );
            assert!(is_rejected(slab), "{thickness}");
        }
    }
}
