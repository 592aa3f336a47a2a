//! Cuts polygons into triangles: a fan where the polygon is strictly convex, ears otherwise.
//!
//! The polygon is projected along the dominant axis of its normal, which drops a coordinate and rounds nothing. All
//! decisions are signs of exact determinants (Shewchuk's adaptive predicates). So a polygon may have collinear or
//! repeated vertices, and may touch itself. A face with holes does so if a bridge joins its outlines and is walked
//! twice. The triangles cover the polygon exactly, because each is a positively oriented piece of it.

mod cells;

use crate::scene::CauseAndRemedy;
use cells::Cells;
use glam::DVec3;
use robust::{Coord, orient2d};

/// Concave polygons with more vertices are rejected, because clipping ears can take quadratic time. Properties of
/// corners are cached, so that outlines of this size take some milliseconds.
pub(super) const MAX_CONCAVE: usize = 4_096;

/// The triangles of a polygon, as indices into its vertices, in its own winding.
#[derive(Debug, PartialEq)]
pub(super) struct Triangulation {
    pub(super) triangles: Vec<[u32; 3]>,
    /// False where the polygon crosses itself, so that no triangulation covers exactly it.
    pub(super) exact: bool,
}

/// Triangles, and a warning if what they make up crosses itself.
pub(super) type Cut = (Vec<[u32; 3]>, Option<String>);

/// Triangulates a `what`, a face or a polygon, of a file.
///
/// # Errors
/// If it is concave and has more than [`MAX_CONCAVE`] vertices: cause and remedy.
pub(super) fn cut(what: &str, vertices: &[DVec3]) -> Result<Cut, CauseAndRemedy> {
    let count = vertices.len();
    let Some(cut) = triangulate(vertices) else {
        return Err(CauseAndRemedy::new(
            format!("a concave {what} of {count} vertices is too large"),
            format!("split it into {what}s of at most {MAX_CONCAVE} vertices"),
        ));
    };
    let crosses = || format!("a {what} crosses itself; its triangles cover more than it encloses");
    Ok((cut.triangles, (!cut.exact).then(crosses)))
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
    let crossed = crosses_itself(&flat);
    let clipped = Clipper::new(vertices, &flat).run();
    Some(Triangulation {
        exact: clipped.exact && !crossed,
        ..clipped
    })
}

/// Returns whether a polygon has an area, as seen along the dominant axis of its normal. One that crosses
/// itself may have none because its parts cancel out.
pub(super) fn has_area(vertices: &[DVec3]) -> bool {
    project(vertices).is_some()
}

/// The polygon seen along the dominant axis of its normal, counter-clockwise; `None` if it has no
/// area.
fn project(vertices: &[DVec3]) -> Option<Vec<Coord<f64>>> {
    // A power of two changes no sign and keeps products of very large or small coordinates in
    // range.
    let largest = vertices
        .iter()
        .fold(0.0_f64, |m, v| m.max(v.abs().max_element()));
    let scale = libm::ldexp(1.0, -libm::frexp(largest).1);
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

/// Returns whether every corner turns left and the outline goes round once.
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

/// Returns whether two sides cross inside both. Cutting alone does not show it: of a pentagram every corner can
/// be cut off.
fn crosses_itself(flat: &[Coord<f64>]) -> bool {
    let n = flat.len();
    let side = |i: usize| (flat[i], flat[(i + 1) % n]);
    let apart = |(a, b), c, d| {
        let (left, right) = (orient2d(a, b, c), orient2d(a, b, d));
        left > 0.0 && right < 0.0 || left < 0.0 && right > 0.0
    };
    // The ends of each side along both axes.
    let mut sides: Vec<([[f64; 2]; 2], usize)> = (0..n)
        .map(|i| {
            let (a, b) = side(i);
            let ends = [[a.x.min(b.x), a.x.max(b.x)], [a.y.min(b.y), a.y.max(b.y)]];
            (ends, i)
        })
        .collect();
    // How many sides a line across an axis meets, on average.
    let met = |axis: usize| {
        let ends = sides.iter().map(|(ends, _)| ends[axis]);
        let long: f64 = ends.clone().map(|[low, high]| high - low).sum();
        let [low, high] = ends.fold([f64::MAX, f64::MIN], |all, [low, high]| {
            [all[0].min(low), all[1].max(high)]
        });
        long / (high - low)
    };
    let along = usize::from(met(1) < met(0));
    let across = 1 - along;
    sides.sort_by(|a, b| a.0[along][0].total_cmp(&b.0[along][0]));
    sides.iter().enumerate().any(|(place, &(ends, i))| {
        // Those that begin before this one ends.
        sides[place + 1..]
            .iter()
            .take_while(|(other, _)| other[along][0] <= ends[along][1])
            .filter(|(other, _)| {
                other[across][0] <= ends[across][1] && ends[across][0] <= other[across][1]
            })
            .any(|&(_, j)| {
                let (one, other) = (side(i), side(j));
                apart(one, other.0, other.1) && apart(other, one.0, one.1)
            })
    })
}

/// The outline that is left while ears are cut off, as a ring of indices.
struct Clipper<'a> {
    vertices: &'a [DVec3],
    flat: &'a [Coord<f64>],
    next: Vec<usize>,
    previous: Vec<usize>,
    left: usize,
    /// The vertices that are left.
    cells: Cells,
    /// Cached properties of each corner, valid while its neighbors stay.
    corners: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
    /// Number of comparisons of a corner with a vertex.
    #[cfg(test)]
    tested: std::cell::Cell<usize>,
}

/// Cached properties of a corner.
#[derive(Clone, Copy, Default)]
struct Corner {
    /// Twice its signed area.
    turn: Option<f64>,
    /// A vertex inside of it, which keeps it from being cut off until the vertex is cut off itself.
    blocker: Option<u32>,
}

/// The requirements of an ear. Each kind is tried only where the polygon has none of the kind before it.
#[derive(Clone, Copy, PartialEq)]
enum Ear {
    /// A corner that turns left and into which nothing reaches.
    Clear,
    /// A corner without area: a repeated vertex, a spike, or a vertex in the middle of an edge.
    /// It comes after the clear ears, which use vertices on edges, so that neighbors that share
    /// them leave no gap.
    Flat,
    /// Any corner that turns left. Only an outline that crosses itself reaches this kind.
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
            cells: Cells::new(flat),
            corners: vec![Corner::default(); n],
            triangles: Vec::with_capacity(n - 2),
            #[cfg(test)]
            tested: Default::default(),
        }
    }

    fn run(mut self) -> Triangulation {
        Triangulation {
            exact: self.cut_all(),
            triangles: self.triangles,
        }
    }

    /// Cuts all corners off. Returns false where the outline crosses itself.
    fn cut_all(&mut self) -> bool {
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
        exact
    }

    /// The first ear of that kind, going round from `start`.
    fn find(&mut self, kind: Ear, start: usize) -> Option<usize> {
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
    fn turn(&mut self, tip: usize) -> f64 {
        let (before, after) = (self.previous[tip], self.next[tip]);
        let flat = self.flat;
        let turn = || orient2d(flat[before], flat[tip], flat[after]);
        *self.corners[tip].turn.get_or_insert_with(turn)
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
        self.cells.remove(tip);
        self.corners[before] = Corner::default();
        self.corners[after] = Corner::default();
        self.next[after]
    }

    /// Returns whether no part of the outline reaches into the corner at `tip`.
    fn is_clear(&mut self, tip: usize) -> bool {
        if let Some(blocker) = self.corners[tip].blocker
            && self.cells.has(blocker as usize)
        {
            return false;
        }
        let (before, after) = (self.previous[tip], self.next[tip]);
        let [a, b, c] = [before, tip, after].map(|i| self.flat[i]);
        let x = [a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x)];
        let y = [a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y)];
        let blocks = |i: usize| {
            #[cfg(test)]
            self.tested.set(self.tested.get() + 1);
            let p = self.flat[i];
            let near = p.x >= x[0] && p.x <= x[1] && p.y >= y[0] && p.y <= y[1];
            near && ![before, tip, after].contains(&i) && self.blocks(i, a, b, c)
        };
        let found = match self.cells.around([x, y], self.left) {
            Some(mut near) => near.find(|&i| blocks(i)),
            // Most cells are near, or there are few vertices.
            None => std::iter::successors(Some(self.next[after]), |&i| Some(self.next[i]))
                .take_while(|&i| i != before)
                .find(|&i| blocks(i)),
        };
        // Others block only while their own neighbors stay.
        let inside = |&i: &usize| {
            let p = self.flat[i];
            orient2d(a, b, p) > 0.0 && orient2d(b, c, p) > 0.0
        };
        self.corners[tip].blocker = found.filter(inside).map(|i| i as u32);
        found.is_none()
    }

    /// Returns whether the outline at vertex `i` keeps the corner `a b c` from being cut off.
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
            .any(|neighbor| {
                let q = self.flat[neighbor];
                let into_ab = orient2d(a, b, q) > 0.0;
                let into_bc = orient2d(b, c, q) > 0.0;
                (into_ab || ab > 0.0) && (into_bc || bc > 0.0)
            })
    }
}

#[cfg(test)]
mod tests;
