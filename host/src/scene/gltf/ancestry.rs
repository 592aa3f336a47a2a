//! The nodes above each node, and whether they move.

use gltf::Document;

/// The trees of a file's nodes, which [`Importer::check`](super::Importer::check) has proved to be trees.
#[derive(Default)]
pub(super) struct Ancestry {
    /// The node above each node.
    parents: Vec<Option<usize>>,
    /// All nodes, each behind the one above it.
    order: Vec<usize>,
    /// For each node, the number of nodes from it to the uppermost, both counted.
    depths: Vec<usize>,
    /// For each node, whether it or one above it moves.
    moving: Vec<bool>,
}

impl Ancestry {
    pub(super) fn of(document: &Document) -> Self {
        let count = document.nodes().len();
        let mut parents = vec![None; count];
        for node in document.nodes() {
            for child in node.children() {
                parents[child.index()] = Some(node.index());
            }
        }
        let roots = document
            .nodes()
            .filter(|node| parents[node.index()].is_none());
        let mut open: Vec<_> = roots.map(|node| (node, 1)).collect();
        let mut order = Vec::with_capacity(count);
        let mut depths = vec![0; count];
        while let Some((node, depth)) = open.pop() {
            order.push(node.index());
            depths[node.index()] = depth;
            open.extend(node.children().map(|child| (child, depth + 1)));
        }
        Self {
            moving: vec![false; count],
            parents,
            order,
            depths,
        }
    }

    /// Notes which nodes move themselves. Takes time in proportion to the number of nodes.
    pub(super) fn mark(&mut self, moves_itself: impl Fn(usize) -> bool) {
        for &node in &self.order {
            let above = self.parents[node].is_some_and(|above| self.moving[above]);
            self.moving[node] = above || moves_itself(node);
        }
    }

    /// The node above a node.
    pub(super) fn parent(&self, node: usize) -> Option<usize> {
        self.parents[node]
    }

    /// The number of nodes from a node to the uppermost, both counted.
    pub(super) fn depth(&self, node: usize) -> usize {
        self.depths[node]
    }

    /// Returns whether a node, or one above it, moves.
    pub(super) fn moves(&self, node: usize) -> bool {
        self.moving[node]
    }

    /// A node and those above it, from below.
    pub(super) fn chain(&self, node: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(node), |&node| self.parents[node])
    }
}
