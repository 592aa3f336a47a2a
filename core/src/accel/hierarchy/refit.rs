//! Refit: the boxes of a hierarchy whose leaves moved.

use crate::format::link::Node;
use crate::format::record::{Pair, UnitBox};

/// Computes the boxes of all pairs again, given those of leaves by their numbers.
///
/// Nodes lie breadth first, so every pair comes after its parent. So one pass from the last pair to the first needs
/// neither a stack nor marks. A leaf without a box keeps the one that it has.
pub(crate) fn refit(pairs: &mut [Pair], mut leaf: impl FnMut(u32) -> Option<UnitBox>) {
    for index in (0..pairs.len()).rev() {
        let Some(children) = pairs.get(index).map(|pair| pair.children) else {
            return;
        };
        for (side, child) in children.map(Node).into_iter().enumerate() {
            let number = child.number();
            let bounds = if child.is_leaf() {
                leaf(number)
            } else {
                pairs.get(number as usize).map(Pair::bounds)
            };
            if let (Some(bounds), Some(pair)) = (bounds, pairs.get_mut(index)) {
                for (planes, [low, high]) in pair.planes.iter_mut().zip(bounds.0) {
                    planes[0][side & 1] = low;
                    planes[1][side & 1] = high;
                }
            }
        }
    }
}
