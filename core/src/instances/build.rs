//! The hierarchy above instances in RAM, built in place.
//!
//! Top down: the instances of a pair are divided in halves along the axis on which their centers spread most. Bisection
//! of the coordinate's interval finds the middle. So `n` instances take at most `24 n` steps per level, and there are
//! `log2 n` levels, rounded up. Then the boxes follow, from the last pair to the first. This needs only the hierarchy's
//! own memory and a word per instance.

use crate::format::instance::Instance;
use crate::format::link::Node;
use crate::format::record::{Pair, UnitBox};
use crate::format::{BlobError, Location, Reason, SectionKind};

/// Builds the hierarchy above instances, with one pair fewer than instances. `around` is the box of an instance, and
/// `scene` that of the scene, which holds all of them. `order` has one word per instance.
///
/// # Errors
/// If an instance lies outside the scene's box.
pub(crate) fn build(
    instances: &[Instance],
    order: &mut [u32],
    pairs: &mut [Pair],
    scene: &UnitBox,
    around: impl Fn(&Instance) -> Option<UnitBox>,
) -> Result<(), BlobError> {
    for (number, place) in (0..).zip(order.iter_mut()) {
        *place = number;
    }
    divide(instances, order, pairs);
    let bounds = |index: u32| {
        let instance = instances.get(index as usize);
        let bounds = instance.and_then(&around);
        let inside = bounds.filter(|bounds| scene.contains(bounds));
        // The number that the program knows it by.
        let number = instance.map_or(index, |instance| instance.number);
        let record = Location::Record(SectionKind::Instances, number as usize);
        inside.ok_or(record.invalid(Reason::OutsideScene))
    };
    if pairs.is_empty() && !instances.is_empty() {
        bounds(0)?;
    }
    for index in (0..pairs.len()).rev() {
        let Some(&Pair { children, .. }) = pairs.get(index) else {
            break;
        };
        let below = |child: u32| {
            let node = Node(child);
            if node.is_leaf() {
                return bounds(node.number());
            }
            let pair = pairs.get(node.number() as usize);
            Ok(pair.map_or(*scene, Pair::bounds))
        };
        let [left, right] = children;
        let (left, right) = (below(left)?, below(right)?);
        if let Some(pair) = pairs.get_mut(index) {
            *pair = with_boxes(children, &left, &right);
        }
    }
    Ok(())
}

/// A pair with these boxes.
fn with_boxes(children: [u32; 2], UnitBox(left): &UnitBox, UnitBox(right): &UnitBox) -> Pair {
    let planes = |axis: usize| [0, 1].map(|side| [left[axis][side], right[axis][side]]);
    Pair {
        planes: [planes(0), planes(1), planes(2)],
        children,
    }
}

/// Names the children of all pairs, in breadth-first order. Until its turn comes, a pair holds the first and the last of
/// its instances' places in the order.
fn divide(instances: &[Instance], order: &mut [u32], pairs: &mut [Pair]) {
    if let Some(root) = pairs.first_mut() {
        root.children = [0, order.len() as u32];
    }
    let mut next = 1_u32;
    for index in 0..pairs.len() {
        let Some(&Pair { children, .. }) = pairs.get(index) else {
            break;
        };
        let [first, end] = children;
        let Some(range) = order.get_mut(first as usize..end as usize) else {
            break;
        };
        let middle = range.len() / 2;
        if range.len() > 2 {
            halve(instances, range, middle);
        }
        let middle = first.wrapping_add(middle as u32);
        let halves = [[first, middle], [middle, end]];
        let children = halves.map(|[first, end]| {
            if end.wrapping_sub(first) == 1 {
                let instance = order.get(first as usize).copied();
                return Node::leaf(instance.unwrap_or(0)).0;
            }
            let number = next;
            next = next.wrapping_add(1);
            if let Some(pair) = pairs.get_mut(number as usize) {
                pair.children = [first, end];
            }
            Node::pair(number).0
        });
        if let Some(pair) = pairs.get_mut(index) {
            pair.children = children;
        }
    }
}

/// Moves this many instances to the front: those whose centers are least along the axis on which centers spread most.
fn halve(instances: &[Instance], order: &mut [u32], front: usize) {
    let spread = |axis: usize| {
        let (least, greatest) = extremes(instances, order, axis);
        greatest.wrapping_sub(least)
    };
    let (x, y, z) = (spread(0), spread(1), spread(2));
    let axis = if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    };
    let (mut order, mut front) = (order, front);
    loop {
        let (least, greatest) = extremes(instances, order, axis);
        if least == greatest {
            return;
        }
        // Below the greatest, however it is rounded.
        let middle = least.midpoint(greatest).min(greatest.wrapping_sub(1));
        let below = partition(instances, order, axis, middle);
        let (low, high) = order.split_at_mut_checked(below).unwrap_or_default();
        match front.checked_sub(below) {
            None => order = low,
            Some(0) => return,
            Some(rest) => (order, front) = (high, rest),
        }
    }
}

/// The coordinate of an instance's center.
#[inline(always)]
fn center(instances: &[Instance], number: u32, axis: usize) -> i32 {
    let instance = instances.get(number as usize);
    instance
        .and_then(|it| it.center.get(axis).copied())
        .unwrap_or(0)
}

/// The least and the greatest coordinate of centers.
fn extremes(instances: &[Instance], order: &[u32], axis: usize) -> (i32, i32) {
    order
        .iter()
        .fold((i32::MAX, i32::MIN), |(least, greatest), &number| {
            let center = center(instances, number, axis);
            (least.min(center), greatest.max(center))
        })
}

/// Moves those to the front whose coordinate is at most `most`; returns their number.
fn partition(instances: &[Instance], order: &mut [u32], axis: usize, most: i32) -> usize {
    let mut below = 0;
    for place in 0..order.len() {
        let Some(&number) = order.get(place) else {
            break;
        };
        if center(instances, number, axis) <= most {
            if let Some(other) = order.get_mut(below) {
                let moved = core::mem::replace(other, number);
                if let Some(place) = order.get_mut(place) {
                    *place = moved;
                }
            }
            below = below.wrapping_add(1);
        }
    }
    below
}
