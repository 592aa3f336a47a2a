//! Keeps closed meshes closed where triangles collapse on the lattice.
//!
//! A triangle whose corners a, b, c are rounded onto a line, b between a and c, is left out. Its neighbor across the
//! edge a-c then meets those across a-b and b-c, and has no vertex at b. That is a T-junction. Rays slip through it,
//! because only an edge that two triangles share is watertight. So the neighbor is cut at b into two triangles. b lies
//! on the edge exactly, so the surface is the same.
//!
//! Slivers that share edges form a cluster, which lies on one line. Its edges that other triangles have, too, are its
//! border. Each edge of the border is cut at all ends of others that lie on it. The slivers of a closed mesh are
//! surrounded by cycles of such edges. So each part of an edge between neighboring points occurs an even number of
//! times, and the mesh is closed again. Layers in one place may share slivers: each is cut at the ends of all.

use std::collections::HashMap;
use std::ops::Range;

/// The corners of a triangle on a line, in 1/256 unit.
pub type Sliver = [Point; 3];

/// A point in 1/256 unit. On a line, points lie in their order as arrays.
type Point = [i32; 3];

/// An edge, the lower end first.
type Edge = [Point; 2];

fn edge(a: Point, b: Point) -> Edge {
    [a.min(b), a.max(b)]
}

fn edges([a, b, c]: [Point; 3]) -> impl Iterator<Item = Edge> {
    let edges = [edge(a, b), edge(b, c), edge(c, a)];
    edges.into_iter().filter(|[low, high]| low < high)
}

/// The points at which edges are cut.
#[derive(Debug, Default)]
pub struct Cuts {
    /// The ends of the edges of each cluster's border, in ascending order.
    ends: Vec<Point>,
    /// For edges that are cut, the range of the ends between their own. The points themselves would take memory by the
    /// square of a cluster's slivers.
    between: HashMap<Edge, Range<usize>>,
}

impl Cuts {
    /// Returns the cuts that slivers make necessary in other triangles.
    pub fn around(slivers: &[Sliver], others: impl Iterator<Item = [Point; 3]>) -> Self {
        // For each edge, one of its slivers, and whether another triangle has it.
        let mut shared: HashMap<Edge, (usize, bool)> = HashMap::new();
        let mut clusters = Clusters::new(slivers.len());
        for (number, &sliver) in slivers.iter().enumerate() {
            for edge in edges(sliver) {
                let (first, _) = shared.entry(edge).or_insert((number, false));
                clusters.join(*first, number);
            }
        }
        if shared.is_empty() {
            return Self::default();
        }
        for edge in others.flat_map(edges) {
            if let Some((_, is_border)) = shared.get_mut(&edge) {
                *is_border = true;
            }
        }
        let mut border: Vec<(usize, Edge)> = shared
            .into_iter()
            .filter(|&(_, (_, is_border))| is_border)
            .map(|(edge, (sliver, _))| (clusters.of(sliver), edge))
            .collect();
        border.sort_unstable();
        let mut cuts = Self::default();
        for cluster in border.chunk_by(|a, b| a.0 == b.0) {
            let mut ends: Vec<Point> = cluster.iter().flat_map(|(_, edge)| *edge).collect();
            ends.sort_unstable();
            ends.dedup();
            let before = cuts.ends.len();
            for &(_, edge) in cluster {
                let [low, high] = edge;
                let first = ends.partition_point(|end| *end <= low);
                let last = ends.partition_point(|end| *end < high);
                if first < last {
                    cuts.between.insert(edge, before + first..before + last);
                }
            }
            cuts.ends.append(&mut ends);
        }
        cuts
    }

    pub fn is_empty(&self) -> bool {
        self.between.is_empty()
    }

    /// Returns the points at which an edge is cut, in ascending order.
    fn of_edge(&self, a: Point, b: Point) -> &[Point] {
        let range = self.between.get(&edge(a, b)).cloned();
        &self.ends[range.unwrap_or_default()]
    }

    /// Returns the number of pieces that a triangle is cut into.
    pub fn count(&self, [a, b, c]: [Point; 3]) -> usize {
        let edges = [[a, b], [b, c], [c, a]].into_iter();
        1 + edges.map(|[a, b]| self.of_edge(a, b).len()).sum::<usize>()
    }

    /// Returns the pieces that a triangle is cut into, wound as it is. It is the triangle alone where no edge is cut.
    pub fn pieces(&self, corners: [Point; 3]) -> Vec<[Point; 3]> {
        let cut_edges = [0, 1, 2].map(|side: usize| {
            let (from, to) = (corners[side], corners[(side + 1) % 3]);
            let mut points = self.of_edge(from, to).to_vec();
            if from > to {
                points.reverse();
            }
            points
        });
        let mut pieces = Vec::new();
        divide(corners, cut_edges, &mut pieces);
        pieces
    }
}

/// Cuts a triangle at points of its edges, which are those from each corner to the next one.
fn divide([a, b, c]: [Point; 3], [mut ab, bc, ca]: [Vec<Point>; 3], pieces: &mut Vec<[Point; 3]>) {
    if ab.is_empty() {
        if bc.is_empty() && ca.is_empty() {
            pieces.push([a, b, c]);
        } else {
            divide([b, c, a], [bc, ca, ab], pieces);
        }
        return;
    }
    // In the middle, so that the pieces are few deep.
    let behind = ab.split_off(ab.len() / 2);
    let (middle, behind) = (behind[0], behind[1..].to_vec());
    divide([a, middle, c], [ab, Vec::new(), ca], pieces);
    divide([middle, b, c], [behind, bc, Vec::new()], pieces);
}

/// Slivers that share edges, one with the next.
struct Clusters {
    /// For each sliver another one of its cluster, or itself.
    leads_to: Vec<usize>,
}

impl Clusters {
    fn new(slivers: usize) -> Self {
        Self {
            leads_to: (0..slivers).collect(),
        }
    }

    /// Returns the first sliver of a sliver's cluster, which represents it.
    fn of(&mut self, mut sliver: usize) -> usize {
        while self.leads_to[sliver] != sliver {
            self.leads_to[sliver] = self.leads_to[self.leads_to[sliver]];
            sliver = self.leads_to[sliver];
        }
        sliver
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.leads_to[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slivers_that_share_an_edge_take_little_memory() {
        let point = |x: usize| [x as i32, 0, 0];
        let count = 2000;
        let slivers: Vec<Sliver> = (2..count).map(|x| [point(0), point(1), point(x)]).collect();
        let beside = |x: usize, y: usize| [point(x), point(y), [0, 1, 0]];
        let others = (2..count).map(|x| beside(0, x)).chain([beside(0, 1)]);
        let cuts = Cuts::around(&slivers, others);
        // Each edge from 0 is cut where the others end.
        let far = beside(0, count - 1);
        assert_eq!(cuts.count(far), count - 1);
        assert_eq!(cuts.pieces(far).len(), count - 1);
        assert_eq!(cuts.ends.len(), count);
    }

    #[test]
    fn layers_with_the_same_sliver_are_cut() {
        let [a, b, c] = [0, 1, 2].map(|x| [x, 0, 0]);
        let layer = [[a, c, [0, 1, 0]], [a, b, [0, 0, 1]], [b, c, [0, 0, 1]]];
        for layers in 1..4 {
            let others = (0..layers).flat_map(|_| layer);
            let cuts = Cuts::around(&vec![[a, b, c]; layers], others);
            assert_eq!(layer.map(|it| cuts.count(it)), [2, 1, 1], "{layers}");
        }
    }
}
