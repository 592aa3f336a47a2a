//! A binary tree over primitives, in an arena, and how it becomes a hierarchy.

use crate::compile::hierarchy::node::{Node, Primitive, area};
use crate::compile::hierarchy::sah::{LEAF_SIZE, STEP_COST, build_halved, halvings};
use gridel_core::format::limits::MAX_LEVELS;
use gridel_core::format::record::UnitBox;

/// A node of a [`Tree`].
#[derive(Clone, Debug)]
pub struct TreeNode {
    pub bounds: UnitBox,
    pub parent: usize,
    pub below: Below,
}

/// The subtree below a node.
#[derive(Clone, Debug)]
pub enum Below {
    Children([usize; 2]),
    /// Places of primitives.
    Primitives(Vec<usize>),
}

/// A binary tree; nodes refer to each other by number.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    pub nodes: Vec<TreeNode>,
    pub root: usize,
}

impl Tree {
    /// Adds a leaf, and returns its number.
    pub fn leaf(&mut self, bounds: UnitBox, primitives: Vec<usize>) -> usize {
        self.add(bounds, Below::Primitives(primitives))
    }

    /// Adds a node above two others, and returns its number.
    pub fn join(&mut self, children: [usize; 2]) -> usize {
        let [left, right] = children.map(|child| self.nodes[child].bounds);
        let number = self.add(left.union(&right), Below::Children(children));
        for child in children {
            self.nodes[child].parent = number;
        }
        number
    }

    /// Adds a node without a parent.
    fn add(&mut self, bounds: UnitBox, below: Below) -> usize {
        self.nodes.push(TreeNode {
            bounds,
            parent: usize::MAX,
            below,
        });
        self.nodes.len() - 1
    }

    /// Nodes below the root, the root included, parents first.
    pub fn parents_first(&self) -> Vec<usize> {
        let mut order = vec![self.root];
        let mut next = 0;
        while let Some(&number) = order.get(next) {
            if let Below::Children(children) = &self.nodes[number].below {
                order.extend(children);
            }
            next += 1;
        }
        order
    }

    /// Returns the hierarchy, and the primitives in the order of its leaves.
    ///
    /// Few primitives of one kind become one leaf where the surface area heuristic says so. Ranges
    /// that would lie too deep are halved.
    pub fn finish(&self, primitives: &mut [Primitive]) -> Node {
        let mut facts = vec![Facts::default(); self.nodes.len()];
        for &number in self.parents_first().iter().rev() {
            let node = &self.nodes[number];
            facts[number] = match &node.below {
                Below::Primitives(places) => {
                    let tests = places.iter().map(|&p| primitives[p].test_cost()).sum();
                    Facts {
                        count: places.len(),
                        tests,
                        cost: area(&node.bounds) * tests,
                        // A range with more than a leaf's primitives is halved.
                        height: if places.len() > LEAF_SIZE {
                            halvings(places.len())
                        } else {
                            0
                        },
                        one_kind: places
                            .iter()
                            .all(|&p| primitives[p].kind == primitives[places[0]].kind),
                        is_leaf: false,
                    }
                }
                Below::Children(children) => {
                    let [left, right] = children.map(|child| facts[child]);
                    let kind = |child| primitives[self.first(child)].kind;
                    Facts {
                        count: left.count + right.count,
                        tests: left.tests + right.tests,
                        cost: STEP_COST * area(&node.bounds) + left.cost + right.cost,
                        height: 1 + left.height.max(right.height),
                        one_kind: left.one_kind
                            && right.one_kind
                            && kind(children[0]) == kind(children[1]),
                        is_leaf: false,
                    }
                }
            };
            let fact = &mut facts[number];
            let as_leaf = area(&node.bounds) * fact.tests;
            fact.is_leaf = fact.one_kind && fact.count <= LEAF_SIZE && as_leaf <= fact.cost;
            if fact.is_leaf {
                (fact.cost, fact.height) = (as_leaf, 0);
            }
        }
        let old = primitives.to_vec();
        let mut next = 0;
        let mut finish = Finish {
            tree: self,
            facts: &facts,
            old: &old,
            new: primitives,
        };
        finish.node(self.root, MAX_LEVELS, &mut next)
    }

    /// A primitive below a node.
    fn first(&self, mut number: usize) -> usize {
        loop {
            match &self.nodes[number].below {
                Below::Children([left, _]) => number = *left,
                Below::Primitives(places) => return places[0],
            }
        }
    }

    /// All primitives below a node.
    fn gather(&self, number: usize) -> Vec<usize> {
        let mut waiting = vec![number];
        let mut places = Vec::new();
        while let Some(number) = waiting.pop() {
            match &self.nodes[number].below {
                Below::Children([left, right]) => waiting.extend([right, left]),
                Below::Primitives(some) => places.extend(some),
            }
        }
        places
    }
}

/// Figures of a subtree.
#[derive(Clone, Copy, Default)]
struct Facts {
    count: usize,
    /// The cost of the tests of its primitives.
    tests: f64,
    /// The cost by the surface area heuristic.
    cost: f64,
    /// Levels of inner nodes.
    height: usize,
    one_kind: bool,
    is_leaf: bool,
}

struct Finish<'f> {
    tree: &'f Tree,
    facts: &'f [Facts],
    old: &'f [Primitive],
    new: &'f mut [Primitive],
}

impl Finish<'_> {
    /// Recurses at most as deep as hierarchies may be.
    fn node(&mut self, number: usize, levels: usize, next: &mut usize) -> Node {
        let fact = self.facts[number];
        let node = &self.tree.nodes[number];
        let too_deep = fact.height > levels && levels <= halvings(fact.count) + 1;
        match &node.below {
            Below::Children([left, right]) if !fact.is_leaf && !too_deep => Node::Inner {
                bounds: node.bounds,
                children: Box::new([
                    self.node(*left, levels - 1, next),
                    self.node(*right, levels - 1, next),
                ]),
            },
            below => {
                let first = *next;
                let places = self.tree.gather(number);
                *next += places.len();
                let (old, new) = (self.old, &mut self.new[first..*next]);
                for (new, place) in new.iter_mut().zip(places) {
                    *new = old[place];
                }
                let single =
                    matches!(below, Below::Primitives(places) if places.len() <= LEAF_SIZE);
                if fact.is_leaf || single && fact.one_kind {
                    Node::Leaf {
                        bounds: node.bounds,
                        first,
                        count: new.len(),
                        tests: fact.tests,
                    }
                } else {
                    build_halved(new, first, levels)
                }
            }
        }
    }
}
