//! Primitives and nodes of a hierarchy that is built, with their boxes.

use crate::shape::test_cost;
use gridel_core::Kind;
use gridel_core::format::record::UnitBox;

/// A primitive for the builder.
#[derive(Clone, Copy, Debug)]
pub struct Primitive {
    pub bounds: UnitBox,
    pub kind: Kind,
    /// Its place among the compiler's primitives.
    pub index: u32,
}

impl Primitive {
    /// Returns the cost of its test; a triangle's is 1. Where tests are expensive, leaves are small.
    pub const fn test_cost(&self) -> f64 {
        test_cost(self.kind)
    }

    /// Twice the box's center.
    pub fn centroid(&self, axis: usize) -> i32 {
        let [low, high] = self.bounds.0[axis];
        i32::from(low) + i32::from(high)
    }
}

/// A node: a leaf's range of the (reordered) primitives, or two children.
#[derive(Debug)]
pub enum Node {
    Leaf {
        bounds: UnitBox,
        first: usize,
        count: usize,
        /// The cost of the tests of its primitives.
        tests: f64,
    },
    Inner {
        bounds: UnitBox,
        children: Box<[Node; 2]>,
    },
}

impl Node {
    pub fn bounds(&self) -> &UnitBox {
        match self {
            Node::Leaf { bounds, .. } | Node::Inner { bounds, .. } => bounds,
        }
    }
}

/// Returns the box of all primitives; `None` without any.
pub fn bounds(primitives: &[Primitive]) -> Option<UnitBox> {
    (!primitives.is_empty()).then(|| union(primitives))
}

/// Returns the box of primitives, of which there is at least one.
pub fn union(primitives: &[Primitive]) -> UnitBox {
    primitives
        .iter()
        .fold(primitives[0].bounds, |bounds, p| bounds.union(&p.bounds))
}

/// Half the surface area in units.
pub fn area(bounds: &UnitBox) -> f64 {
    let side = |axis: usize| f64::from(i32::from(bounds.0[axis][1]) - i32::from(bounds.0[axis][0]));
    let (x, y, z) = (side(0), side(1), side(2));
    x * y + y * z + z * x
}
