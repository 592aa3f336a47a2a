//! The proof that instances lie in their boxes, and that the hierarchy above leads to each of them.

use crate::accel::hierarchy::order::Order;
use crate::format::instance::Instance;
use crate::format::limits::{MAX_INSTANCE_LEVELS, MAX_INSTANCES};
use crate::format::link::Node;
use crate::format::range::{At, Ranges};
use crate::format::record::{Pair, UnitBox};
use crate::format::{BlobError, Field, Location, Reason, SectionKind};
use crate::instances::bounds::check_rotation;
use crate::instances::top::Top;

/// Proves the map of an instance.
pub(crate) fn check_instance(index: usize, instance: &Instance) -> Result<(), BlobError> {
    let section = SectionKind::Instances;
    let at = At { section, index };
    instance.check_ranges(at.location())?;
    check_rotation(&instance.matrix).map_err(|reason| at.location().invalid(reason))
}

/// Proves the hierarchy: nodes lie in breadth-first order, every instance is reached once, and every box holds
/// everything below it. `around` is the box of an instance. The scene's box holds all.
pub(crate) fn check_top(
    top: &Top<'_>,
    scene: &UnitBox,
    around: impl Fn(&Instance) -> Option<UnitBox>,
) -> Result<(), BlobError> {
    let section = SectionKind::InstancePairs;
    let instances = top.instances.len();
    if instances > MAX_INSTANCES {
        return Err(BlobError::TooMany {
            section: SectionKind::Instances,
            found: instances,
            most: MAX_INSTANCES,
        });
    }
    let expected = instances.saturating_sub(1);
    if top.pairs.len() != expected {
        return Err(BlobError::Count {
            section,
            found: top.pairs.len(),
            expected,
        });
    }
    // Two boxes that hold everything below a node.
    let below = |node: Node| {
        let number = node.number() as usize;
        if node.is_leaf() {
            return Some([around(top.instances.get(number)?)?; 2]);
        }
        let pair = top.pairs.get(number)?;
        Some([pair.child_box(0), pair.child_box(1)])
    };
    let holds = |outer: &UnitBox, node: Node| {
        below(node).is_some_and(|inner| inner.iter().all(|inner| outer.contains(inner)))
    };
    let mut order = Order::new(section, top.pairs.len());
    for (index, pair) in top.pairs.iter().enumerate() {
        let [left, right] = pair.children.map(Node);
        order.pair([left, right])?;
        let at = At { section, index };
        at.ensure(holds(&pair.child_box(0), left), Reason::LeftOutside)?;
        at.ensure(holds(&pair.child_box(1), right), Reason::RightOutside)?;
    }
    let levels = order.levels()?;
    if levels > MAX_INSTANCE_LEVELS {
        let range = [0, MAX_INSTANCE_LEVELS as i64];
        return Err(Location::Section(section).out_of_range(Field::Levels, levels as i64, range));
    }
    let inside = instances == 0 || holds(scene, top.root());
    Location::Section(SectionKind::Instances).ensure(inside, Reason::OutsideScene)
}

const _: () = assert!(size_of::<Pair>() == 32 && size_of::<Instance>() <= 64);
