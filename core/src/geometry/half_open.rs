//! The half-open rule, which counts crossings: a point of the plane lies in exactly one of the triangles that surround
//! it. That holds even on their edges and at their vertices.
//!
//! The point is moved by `(e, e^2)`, with `e` above 0 and smaller than any number. So it lies on no edge, and each edge
//! leaves it on one side. The exact product gives that side; where the product is 0, it is the side from which the
//! point was moved away. Two triangles that share an edge see it run the other way, and the sign changes exactly. So
//! every line crosses a closed mesh an even number of times, whichever vertices and edges the line leads through.
//! (After Edelsbrunner and Muecke, "Simulation of Simplicity", ACM Transactions on Graphics, 1990.)
//!
//! Closest hits follow the closed rule: edges and vertices are parts of all triangles that share them. The two rules
//! differ where a ray touches an edge from outside, at a silhouette or at the border of an open mesh. There is a
//! closest hit then. This rule counts none, or two at the same t, or at a border perhaps one.

use crate::geometry::Project;
use core::cmp::Ordering;

/// The side of the moved origin on which an edge runs; `Equal` only for an edge without length.
fn side<N: Project>(p: [N; 2], q: [N; 2]) -> Ordering {
    let compare = |a: N, b: N| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
    N::side(p, q)
        .then_with(|| compare(p[1], q[1]))
        .then_with(|| compare(q[0], p[0]))
}

/// Returns true if a triangle encloses the moved origin. The orientation of the triangle does not matter.
pub(crate) fn encloses_origin<N: Project>(a: [N; 2], b: [N; 2], c: [N; 2]) -> bool {
    let first = side(b, c);
    first != Ordering::Equal && side(c, a) == first && side(a, b) == first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Fixed;

    /// Triangles of a fan around a vertex that enclose a place.
    fn fan<N: Project>(at: [i16; 2]) -> usize {
        let ring = [
            [3, 0],
            [2, 2],
            [0, 3],
            [-2, 2],
            [-3, 0],
            [-2, -2],
            [0, -3],
            [2, -2],
        ];
        let place = |[x, y]: [i16; 2]| [N::from_unit(x - at[0]), N::from_unit(y - at[1])];
        let triangles = (0..8).map(|k| [[0, 0], ring[k], ring[(k + 1) % 8]]);
        let enclosing = triangles.filter(|corners| {
            let [a, b, c] = corners.map(place);
            let encloses = encloses_origin(a, b, c);
            assert_eq!(encloses_origin(c, b, a), encloses);
            assert_eq!(encloses_origin(b, c, a), encloses);
            encloses
        });
        enclosing.count()
    }

    fn fans<N: Project>() {
        // The vertex, places on edges, and places in triangles.
        for x in -1..=1 {
            for y in -1..=1 {
                assert_eq!(fan::<N>([x, y]), 1, "{x} {y}");
            }
        }
        // Points of the border belong to the side to which the rule moves them.
        assert_eq!(fan::<N>([-3, 0]), 1);
        assert_eq!(fan::<N>([3, 0]), 0);
        assert_eq!(fan::<N>([4, 4]), 0);
    }

    #[test]
    fn every_point_of_a_fan_is_in_one_triangle() {
        fans::<Fixed>();
        fans::<f32>();
        fans::<f64>();
    }

    #[test]
    fn triangles_without_area_enclose_nothing() {
        let [a, b, c] = [[-1.0, -1.0], [0.0, 0.0], [2.0, 2.0]];
        assert!(!encloses_origin::<f64>(a, b, c));
        assert!(!encloses_origin::<f64>(a, a, c));
        assert!(!encloses_origin::<f64>(b, b, b));
    }
}
