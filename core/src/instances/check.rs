//! The proof that instances are where their boxes are, and that the hierarchy above leads to each of them.

use crate::accel::hierarchy::order::Order;
use crate::format::instance::Instance;
use crate::format::limits::{MAX_INSTANCE_LEVELS, MAX_INSTANCES};
use crate::format::link::Node;
use crate::format::range::{At, Ranges};
use crate::format::record::{Pair, UnitBox};
use crate::format::{BlobError, Field, Location, Reason, SectionKind};
use crate::instances::bounds::{around, check_rotation};
use crate::instances::top::Top;

/// Proves an instance of a part whose box is given.
pub(crate) fn check_instance(
    index: usize,
    instance: &Instance,
    part: &UnitBox,
) -> Result<(), BlobError> {
    let section = SectionKind::Instances;
    let at = At { section, index };
    instance.check_ranges(at.location())?;
    check_rotation(&instance.matrix).map_err(|reason| at.location().invalid(reason))?;
    let holds = around(instance, part).is_some_and(|inner| instance.bounds.contains(&inner));
    at.ensure(holds, Reason::BoxTooSmall)
}

/// Proves the hierarchy: nodes in breadth-first order, every instance reached once, boxes inside their parents' and
/// inside the scene's.
pub(crate) fn check_top(top: &Top<'_>, scene: &UnitBox) -> Result<(), BlobError> {
    let section = SectionKind::InstancePairs;
    let instances = top.instances.len();
    let expected = instances.saturating_sub(1);
    if top.pairs.len() != expected || instances > MAX_INSTANCES {
        let found = top.pairs.len();
        return Err(BlobError::Count {
            section,
            found,
            expected: expected.min(MAX_INSTANCES),
        });
    }
    let mut order = Order::new(section, top.pairs.len());
    for (index, pair) in top.pairs.iter().enumerate() {
        order.pair(pair.children.map(Node))?;
        let at = At { section, index };
        for (side, reason) in [Reason::LeftOutside, Reason::RightOutside]
            .into_iter()
            .enumerate()
        {
            let inside = top
                .around(Node(pair.children[side]))
                .is_some_and(|inner| inner.iter().all(|inner| sides(pair, side).contains(inner)));
            at.ensure(inside, reason)?;
        }
    }
    let levels = order.levels()?;
    if levels > MAX_INSTANCE_LEVELS {
        let range = [0, MAX_INSTANCE_LEVELS as i64];
        return Err(Location::Section(section).out_of_range(Field::Levels, levels as i64, range));
    }
    let root = match top.pairs.first() {
        Some(pair) => [sides(pair, 0), sides(pair, 1)],
        None => match top.instances.first() {
            Some(instance) => [instance.bounds; 2],
            None => return Ok(()),
        },
    };
    Location::Section(section).ensure(
        root.iter().all(|it| scene.contains(it)),
        Reason::OutsideScene,
    )
}

/// The box of a pair's left (0) or right (1) child.
fn sides(pair: &Pair, child: usize) -> UnitBox {
    UnitBox(
        pair.planes
            .map(|[low, high]| [low[child & 1], high[child & 1]]),
    )
}

impl Top<'_> {
    /// Two boxes that hold what is below a node.
    fn around(&self, node: Node) -> Option<[UnitBox; 2]> {
        let number = node.number() as usize;
        if node.is_leaf() {
            let instance = self.instances.get(number)?;
            return Some([instance.bounds; 2]);
        }
        let pair = self.pairs.get(number)?;
        Some([sides(pair, 0), sides(pair, 1)])
    }
}
