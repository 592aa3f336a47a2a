//! Cuts polygons into triangles: a fan where the polygon is strictly convex, ears otherwise.
//!
//! The polygon is looked at along the dominant axis of its normal, which drops a coordinate and
//! rounds nothing, and all decisions are signs of exact determinants (Shewchuk's adaptive
//! predicates). So a polygon may have collinear or repeated vertices, and may touch itself, as a
//! face with holes does whose outlines are joined by a bridge that is walked twice: the triangles
//! cover it exactly, because every one of them is a positively oriented piece of it.

use glam::DVec3;
use robust::{Coord, orient2d};

/// Concave polygons beyond this many vertices are refused: clipping ears takes quadratic time,
/// and at this size it takes about a second.
pub(super) const MAX_CONCAVE: usize = 16_384;

/// The triangles of a polygon, as indices into its vertices, in its own winding.
#[derive(Debug, PartialEq)]
pub(super) struct Triangulation {
    pub(super) triangles: Vec<[u32; 3]>,
    /// False where the polygon crosses itself, so that no triangulation covers exactly it.
    pub(super) exact: bool,
}

/// Triangulates a polygon of at least three finite vertices; `None` if it is concave and has more
/// than [`MAX_CONCAVE`].
///
/// A triangle is returned as it is, and a polygon without area as a fan, so that zero-area faces
/// are still there to be reported.
pub(super) fn triangulate(vertices: &[DVec3]) -> Option<Triangulation> {
    let fan = || {
        (2..vertices.len() as u32)
            .map(|i| [0, i - 1, i])
            .collect::<Vec<_>>()
    };
    if vertices.len() == 3 {
        return Some(Triangulation {
            triangles: fan(),
            exact: true,
        });
    }
    let Some(flat) = project(vertices) else {
        // Without area along every axis: either all vertices lie on a line, or parts cancel out.
        let exact = fan().iter().all(|&[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|i| vertices[i as usize]);
            (b - a).cross(c - a) == DVec3::ZERO
        });
        return Some(Triangulation {
            triangles: fan(),
            exact,
        });
    };
    if is_strictly_convex(&flat) {
        return Some(Triangulation {
            triangles: fan(),
            exact: true,
        });
    }
    if vertices.len() > MAX_CONCAVE {
        return None;
    }
    Some(Clipper::new(vertices, &flat).run())
}

/// The polygon seen along the dominant axis of its normal, counter-clockwise; `None` if it has no
/// area.
fn project(vertices: &[DVec3]) -> Option<Vec<Coord<f64>>> {
    // A power of two changes no sign and keeps products of very large or small coordinates in
    // range.
    let largest = vertices
        .iter()
        .fold(0.0_f64, |m, v| m.max(v.abs().max_element()));
    let scale = if largest > 0.0 {
        (-largest.log2().floor()).clamp(-1022.0, 1022.0).exp2()
    } else {
        1.0
    };
    let first = vertices[0] * scale;
    let normal = vertices.windows(2).fold(DVec3::ZERO, |sum, pair| {
        sum + (pair[0] * scale - first).cross(pair[1] * scale - first)
    });
    let size = normal.abs();
    let (axis, dominant) = if size.x >= size.y && size.x >= size.z {
        (0, normal.x)
    } else if size.y >= size.z {
        (1, normal.y)
    } else {
        (2, normal.z)
    };
    if dominant == 0.0 {
        return None;
    }
    Some(
        vertices
            .iter()
            .map(|v| {
                let v = (*v * scale).to_array();
                let (x, y) = (v[(axis + 1) % 3], v[(axis + 2) % 3]);
                if dominant > 0.0 {
                    Coord { x, y }
                } else {
                    Coord { x: y, y: x }
                }
            })
            .collect(),
    )
}

/// Whether every corner turns left and the outline goes round once.
fn is_strictly_convex(flat: &[Coord<f64>]) -> bool {
    let n = flat.len();
    let turns_left = (0..n).all(|i| orient2d(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) > 0.0);
    // A convex outline goes right once and left once; a pentagram does so twice.
    let goes_right = |i: usize| flat[(i + 1) % n].x > flat[i % n].x;
    turns_left
        && (0..n)
            .filter(|&i| goes_right(i) && !goes_right(i + 1))
            .count()
            == 1
}

/// The outline that is left while ears are cut off, as a ring of indices.
struct Clipper<'a> {
    vertices: &'a [DVec3],
    flat: &'a [Coord<f64>],
    next: Vec<usize>,
    previous: Vec<usize>,
    left: usize,
    triangles: Vec<[u32; 3]>,
}

/// How much is asked of an ear. Each kind is tried only where the polygon has none of the kind
/// before it.
#[derive(Clone, Copy, PartialEq)]
enum Ear {
    /// A corner that turns left and into which nothing reaches.
    Clear,
    /// A corner without area: a repeated vertex, a spike, or a vertex in the middle of an edge.
    /// It comes after the clear ears, which use vertices on edges, so that neighbours that share
    /// them leave no gap.
    Flat,
    /// Any corner that turns left; only an outline that crosses itself comes to this.
    Convex,
    /// Any corner.
    Any,
}

impl<'a> Clipper<'a> {
    fn new(vertices: &'a [DVec3], flat: &'a [Coord<f64>]) -> Self {
        let n = flat.len();
        Self {
            vertices,
            flat,
            next: (0..n).map(|i| (i + 1) % n).collect(),
            previous: (0..n).map(|i| (i + n - 1) % n).collect(),
            left: n,
            triangles: Vec::with_capacity(n - 2),
        }
    }

    fn run(mut self) -> Triangulation {
        let mut tip = 0;
        let mut exact = true;
        while self.left > 3 {
            let kinds = [Ear::Clear, Ear::Flat, Ear::Convex, Ear::Any];
            let found = kinds
                .into_iter()
                .find_map(|kind| Some((self.find(kind, tip)?, kind)));
            let Some((ear, kind)) = found else { break };
            exact &= matches!(kind, Ear::Clear | Ear::Flat);
            tip = self.cut(ear);
        }
        exact &= self.turn(tip) >= 0.0;
        self.cut(tip);
        Triangulation {
            triangles: self.triangles,
            exact,
        }
    }

    /// The first ear of that kind, going round from `start`.
    fn find(&self, kind: Ear, start: usize) -> Option<usize> {
        let mut tip = start;
        for _ in 0..self.left {
            let turn = self.turn(tip);
            let fits = match kind {
                Ear::Clear => turn > 0.0 && self.is_clear(tip),
                Ear::Flat => turn == 0.0,
                Ear::Convex => turn > 0.0,
                Ear::Any => true,
            };
            if fits {
                return Some(tip);
            }
            tip = self.next[tip];
        }
        None
    }

    /// Twice the signed area of the corner at `tip`.
    fn turn(&self, tip: usize) -> f64 {
        orient2d(
            self.flat[self.previous[tip]],
            self.flat[tip],
            self.flat[self.next[tip]],
        )
    }

    /// Takes `tip` out of the outline and returns the corner to go on with. It skips one, which
    /// avoids fans of slivers.
    fn cut(&mut self, tip: usize) -> usize {
        let (before, after) = (self.previous[tip], self.next[tip]);
        // A corner that is flat as seen along the axis still has area where the polygon is bent.
        let [a, b, c] = [before, tip, after].map(|i| self.vertices[i]);
        if self.turn(tip) != 0.0 || (b - a).cross(c - a) != DVec3::ZERO {
            self.triangles
                .push([before as u32, tip as u32, after as u32]);
        }
        self.next[before] = after;
        self.previous[after] = before;
        self.left -= 1;
        self.next[after]
    }

    /// Whether no part of the outline reaches into the corner at `tip`.
    fn is_clear(&self, tip: usize) -> bool {
        let (before, after) = (self.previous[tip], self.next[tip]);
        let [a, b, c] = [before, tip, after].map(|i| self.flat[i]);
        let (min_x, max_x) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (min_y, max_y) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        let mut i = self.next[after];
        while i != before {
            let p = self.flat[i];
            let near = p.x >= min_x && p.x <= max_x && p.y >= min_y && p.y <= max_y;
            if near && self.blocks(i, a, b, c) {
                return false;
            }
            i = self.next[i];
        }
        true
    }

    /// Whether the outline at vertex `i` keeps the corner `a b c` from being cut off.
    fn blocks(&self, i: usize, a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> bool {
        let p = self.flat[i];
        if p == a || p == c {
            // An edge from here into the corner ends inside, where its other vertex blocks, or
            // crosses another edge.
            return false;
        }
        let (ab, bc, ca) = (orient2d(a, b, p), orient2d(b, c, p), orient2d(c, a, p));
        if ab < 0.0 || bc < 0.0 || ca < 0.0 {
            return false;
        }
        if ab > 0.0 && bc > 0.0 {
            return true;
        }
        // The outline touches the two edges at `tip` from the other side, unless it goes on into
        // the corner.
        [self.previous[i], self.next[i]]
            .into_iter()
            .any(|neighbour| {
                let q = self.flat[neighbour];
                let into_ab = orient2d(a, b, q) > 0.0;
                let into_bc = orient2d(b, c, q) > 0.0;
                (into_ab || ab > 0.0) && (into_bc || bc > 0.0)
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<DVec3> {
        points
            .iter()
            .map(|&(x, y)| DVec3::new(x, y, 0.25 * x - 0.5 * y))
            .collect()
    }

    fn area(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        let cross = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| vertices[i as usize]);
            (b - a).cross(c - a).length() / 2.0
        };
        triangles.iter().map(cross).sum()
    }

    fn outline_area(vertices: &[DVec3]) -> f64 {
        let n = vertices.len();
        (0..n)
            .fold(DVec3::ZERO, |s, i| {
                s + vertices[i].cross(vertices[(i + 1) % n])
            })
            .length()
            / 2.0
    }

    /// In every rotation and both windings: exact, without loss of area, all facing one way.
    fn check(points: &[(f64, f64)], triangles: usize) {
        for start in 0..points.len() {
            let mut turned = points.to_vec();
            turned.rotate_left(start);
            for _ in 0..2 {
                turned.reverse();
                let vertices = polygon(&turned);
                let result = triangulate(&vertices).unwrap();
                assert!(result.exact, "{turned:?}");
                assert_eq!(result.triangles.len(), triangles, "{turned:?}");
                let (found, expected) =
                    (area(&vertices, &result.triangles), outline_area(&vertices));
                assert!(
                    (found - expected).abs() < 1e-12 * expected,
                    "{found} for {expected} in {turned:?}"
                );
            }
        }
    }

    #[test]
    fn convex_is_a_fan() {
        let square = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert_eq!(
            triangulate(&square).unwrap().triangles,
            [[0, 1, 2], [0, 2, 3]]
        );
    }

    #[test]
    fn concave_arrow() {
        check(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)], 2);
    }

    #[test]
    fn collinear_and_repeated_vertices() {
        check(
            &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)],
            3,
        );
        check(
            &[(0.0, 0.0), (2.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 1.0)],
            2,
        );
    }

    #[test]
    fn a_hole_joined_by_a_bridge() {
        let outline = [
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 4.0),
            (0.0, 4.0),
            (0.0, 0.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (3.0, 3.0),
            (3.0, 1.0),
            (1.0, 1.0),
        ];
        check(&outline, 8);
    }

    #[test]
    fn a_hole_that_touches_the_outline() {
        check(
            &[
                (0.0, 0.0),
                (4.0, 0.0),
                (4.0, 4.0),
                (0.0, 4.0),
                (0.0, 0.0),
                (1.0, 2.0),
                (2.0, 1.0),
            ],
            5,
        );
    }

    #[test]
    fn a_bow_tie_is_not_exact() {
        let tie = polygon(&[(0.0, 0.0), (3.0, 2.0), (3.0, 0.0), (0.0, 1.0)]);
        assert!(!triangulate(&tie).unwrap().exact);
        let even = polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
        assert!(!triangulate(&even).unwrap().exact);
    }

    #[test]
    fn a_line_keeps_its_empty_triangles() {
        let line = polygon(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)]);
        let result = triangulate(&line).unwrap();
        assert_eq!((result.triangles.len(), result.exact), (2, true));
    }

    #[test]
    fn extreme_coordinates() {
        for scale in [1e-300, 1e-160, 1e160, 1e307] {
            let arrow = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)];
            let vertices: Vec<DVec3> = polygon(&arrow).into_iter().map(|v| v * scale).collect();
            let result = triangulate(&vertices).unwrap();
            assert_eq!((result.triangles.len(), result.exact), (2, true), "{scale}");
        }
    }

    #[test]
    fn too_many_concave_vertices_are_refused() {
        let star = |n: usize| -> Vec<DVec3> {
            let point = |i: usize| {
                let (sin, cos) = (i as f64 * std::f64::consts::TAU / n as f64).sin_cos();
                DVec3::new(cos, sin, 0.0) * if i.is_multiple_of(2) { 1.0 } else { 0.9 }
            };
            (0..n).map(point).collect()
        };
        assert!(triangulate(&star(MAX_CONCAVE + 2)).is_none());
        let vertices = star(1000);
        let result = triangulate(&vertices).unwrap();
        assert!(result.exact);
        assert!((area(&vertices, &result.triangles) - outline_area(&vertices)).abs() < 1e-12);
    }
}
