//! Makes nodes of eight children out of a binary tree, at the least cost that its boxes allow.
//!
//! Dynamic programming by Ylitie, Karras and Laine ("Efficient Incoherent Ray Traversal on GPUs
//! Through Compressed Wide BVHs", 2017). The least cost of each subtree as a forest of one to seven
//! trees follows from its children's. A node takes a forest of eight.

use super::tree::Tree;
use gridel_core::format::cluster::LANES;

/// Most trees of a forest that costs are kept for.
const FORESTS: usize = LANES - 1;
/// The cost of a leaf's test; that of a node's is 1.
const LEAF_COST: f64 = 1.0;

/// The cuts of each subtree into forests.
pub struct Forests {
    /// For 1 to 7 trees: the least cost, the root's area being left as it is.
    costs: Vec<[f64; FORESTS]>,
    /// For 2 to 8 trees: the number of them that are the left child's; 0 where fewer trees cost no more.
    lefts: Vec<[u8; FORESTS]>,
}

impl Forests {
    /// Finds the cheapest forests of every subtree.
    pub fn of(tree: &Tree) -> Self {
        let order = tree.bottom_up();
        let mut forests = Self {
            costs: vec![[0.0; FORESTS]; order.len()],
            lefts: vec![[0; FORESTS]; order.len()],
        };
        for node in order {
            let area = tree.area(node) as f64;
            let Some([left, right]) = tree.children(node) else {
                forests.costs[node as usize] = [area * LEAF_COST; FORESTS];
                continue;
            };
            let (left, right) = (forests.costs[left as usize], forests.costs[right as usize]);
            // The best distribution of 2 to 8 trees.
            let shared: [(f64, u8); FORESTS] = std::array::from_fn(|index| {
                let trees = index + 2;
                (1..trees)
                    .filter(|&count| count <= FORESTS && trees - count <= FORESTS)
                    .map(|count| (left[count - 1] + right[trees - count - 1], count as u8))
                    .min_by(|a, b| a.0.total_cmp(&b.0))
                    .unwrap_or((f64::INFINITY, 1))
            });
            let costs = &mut forests.costs[node as usize];
            costs[0] = area + shared[FORESTS - 1].0;
            for trees in 2..=FORESTS {
                let (cost, count) = shared[trees - 2];
                let fewer = costs[trees - 2];
                let worth_it = cost < fewer;
                costs[trees - 1] = if worth_it { cost } else { fewer };
                forests.lefts[node as usize][trees - 2] = if worth_it { count } else { 0 };
            }
            forests.lefts[node as usize][FORESTS - 1] = shared[FORESTS - 1].1;
        }
        forests
    }

    /// Returns the children of the wide node at a node of the tree; an item is its own and only one.
    pub fn children(&self, tree: &Tree, node: u32) -> Vec<u32> {
        let mut children = Vec::with_capacity(LANES);
        self.cut(tree, node, LANES, &mut children);
        children
    }

    fn cut(&self, tree: &Tree, node: u32, trees: usize, out: &mut Vec<u32>) {
        match tree.children(node) {
            Some([left, right]) if trees > 1 => {
                match usize::from(self.lefts[node as usize][trees - 2]) {
                    0 => self.cut(tree, node, trees - 1, out),
                    count => {
                        self.cut(tree, left, count, out);
                        self.cut(tree, right, trees - count, out);
                    }
                }
            }
            _ => out.push(node),
        }
    }
}
