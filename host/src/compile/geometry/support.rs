//! The farthest point of many shapes in a direction, found without looking at all of them.

use crate::scene::Shape;
use glam::DVec3;

/// Items of a leaf.
const LEAF: usize = 8;

/// Shapes and vertices in a tree of boxes.
#[derive(Debug)]
pub struct SupportTree<'s> {
    /// Ordered so that each node has a range of them.
    items: Vec<Item<'s>>,
    /// Each node's left child follows it.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
enum Item<'s> {
    Point(DVec3),
    Shape(&'s Shape),
}

#[derive(Debug)]
struct Node {
    bounds: [DVec3; 2],
    first: u32,
    end: u32,
    /// 0 for a leaf.
    right: u32,
}

impl Item<'_> {
    fn support(&self, direction: DVec3) -> f64 {
        match self {
            Self::Point(point) => point.dot(direction),
            Self::Shape(shape) => shape.support(direction),
        }
    }

    fn bounds(&self) -> [DVec3; 2] {
        match self {
            Self::Point(point) => [*point; 2],
            Self::Shape(shape) => shape.bounds(),
        }
    }
}

impl<'s> SupportTree<'s> {
    /// Returns the tree of shapes that have boxes. Vertices of no triangle do not count.
    pub fn of(shapes: impl Iterator<Item = &'s Shape>) -> Self {
        let mut items = Vec::new();
        for shape in shapes {
            let Shape::Mesh {
                vertices,
                triangles,
            } = shape
            else {
                items.push(Item::Shape(shape));
                continue;
            };
            let mut used = vec![false; vertices.len()];
            for &corner in triangles.iter().flatten() {
                used[corner as usize] = true;
            }
            let points = vertices.iter().zip(used).filter(|(_, used)| *used);
            items.extend(points.map(|(point, _)| Item::Point(*point)));
        }
        let mut tree = Self {
            items,
            nodes: Vec::new(),
        };
        tree.build();
        tree
    }

    fn build(&mut self) {
        // Ranges of items, and the node whose right child each is.
        let mut waiting = vec![(0, self.items.len(), None)];
        while let Some((first, end, parent)) = waiting.pop() {
            if first == end {
                continue;
            }
            let items = &mut self.items[first..end];
            let boxes = items.iter().map(Item::bounds);
            let bounds = boxes.reduce(|[a, b], [low, high]| [a.min(low), b.max(high)]);
            let bounds = bounds.unwrap_or([DVec3::ZERO; 2]);
            let number = self.nodes.len() as u32;
            if let Some(parent) = parent {
                let parent: &mut Node = &mut self.nodes[parent as usize];
                parent.right = number;
            }
            self.nodes.push(Node {
                bounds,
                first: first as u32,
                end: end as u32,
                right: 0,
            });
            if items.len() > LEAF {
                let axis = (bounds[1] - bounds[0]).max_position();
                let middle = |item: &Item<'_>| {
                    let [low, high] = item.bounds();
                    low[axis] + high[axis]
                };
                let half = items.len() / 2;
                items.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
                waiting.push((first + half, end, Some(number)));
                waiting.push((first, first + half, None));
            }
        }
    }

    /// Returns the largest `point.dot(direction)` over all points; negative infinity without any.
    pub fn support(&self, direction: DVec3) -> f64 {
        // More than the sums round.
        const ROUNDED: f64 = 16.0 * f64::EPSILON;
        let mut largest = f64::NEG_INFINITY;
        let bound = |node: &Node| {
            let [low, high] = node.bounds;
            let sum = (low * direction).max(high * direction).element_sum();
            let size = low.abs().max(high.abs()).dot(direction.abs());
            sum + ROUNDED * size
        };
        let mut waiting = vec![0];
        while let Some(number) = waiting.pop() {
            let Some(node) = self.nodes.get(number as usize) else {
                break;
            };
            if bound(node) < largest {
                continue;
            }
            if node.right == 0 {
                let items = &self.items[node.first as usize..node.end as usize];
                let supports = items.iter().map(|item| item.support(direction));
                largest = supports.fold(largest, f64::max);
                continue;
            }
            // The child that reaches farther is next.
            let children = [number + 1, node.right];
            let [left, right] = children.map(|child| bound(&self.nodes[child as usize]));
            let [left_child, right_child] = children;
            waiting.extend(match left < right {
                true => [left_child, right_child],
                false => [right_child, left_child],
            });
        }
        largest
    }
}
