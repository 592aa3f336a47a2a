//! The proof that a blob's eight-wide hierarchy is valid.

use crate::accel::scene_geometry::SceneGeometry;
use crate::format::cluster::{LANES, RADII};
use crate::format::limits::MAX_STACK_DEPTH;
use crate::format::range::At;
use crate::format::record::{UnitBox, WideNode};
use crate::format::{BlobError, Child, Field, Kind, Leaf, Location, Reason, SectionKind};
use crate::geometry::{Clusters, Packs, Packs24};
use heapless::Vec;

/// Proves the hierarchy, and returns the stack that a walk needs. Nodes and clusters are numbered
/// breadth first, so each is reached once and every walk ends. Boxes lie inside their parents',
/// clusters lie inside their boxes, and the hierarchy holds all primitives.
///
/// Linear; uses [`MAX_STACK_DEPTH`] times 20 bytes of stack.
pub(super) fn check(nodes: &[WideNode], geometry: &SceneGeometry<'_>) -> Result<usize, BlobError> {
    check_members(geometry)?;
    check_order(nodes, geometry)?;
    check_slot_locations(nodes, geometry)?;
    check_boxes(nodes, geometry)
}

/// The error at a record.
#[cold]
fn wrong(section: SectionKind, index: usize, reason: Reason) -> BlobError {
    Location::Record(section, index).invalid(reason)
}

/// Proves that a number of a record is the next in order.
fn follows(
    section: SectionKind,
    index: usize,
    field: Field,
    found: usize,
    next: usize,
) -> Result<(), BlobError> {
    At { section, index }.within(field, found as i64, next as i64, next as i64)
}

/// Proves that members ascend from cluster to cluster, and that their number is the number of
/// primitives.
fn check_members(geometry: &SceneGeometry<'_>) -> Result<(), BlobError> {
    let clusters = geometry.shapes.clusters();
    let mut next = 0;
    for strip in 0..clusters.strips.len() {
        let section = SectionKind::Strips;
        let Some(members) = clusters.strips.members(strip as u32) else {
            continue;
        };
        let first = members.first() as usize;
        follows(section, strip, Field::FirstMember, first, next)?;
        let mut places = (0..8).filter(|place| members.lanes() >> place & 1 != 0);
        if places.any(|place| members.corners(place).is_none()) {
            return Err(wrong(section, strip, Reason::UnknownArrangement));
        }
        next += members.count() as usize;
    }
    let triangles = next;
    next = 0;
    check_radii(&clusters.packs)?;
    for pack in 0..clusters.packs.len() {
        let lanes = clusters.packs.lanes(pack as u32);
        let count = lanes.trailing_ones() as usize;
        let is_last = pack + 1 == clusters.packs.len();
        let section = SectionKind::Packs;
        if count == 0 {
            return Err(wrong(section, pack, Reason::EmptyPack));
        }
        if !is_last && count < LANES {
            return Err(wrong(section, pack, Reason::PartialPack));
        }
        if lanes >> count != 0 {
            return Err(wrong(section, pack, Reason::RadiusAfterLast));
        }
        next += count;
    }
    let section = SectionKind::Members;
    let most = geometry.header.primitives as usize;
    if triangles + next > most {
        return Err(BlobError::TooMany {
            section,
            found: triangles + next,
            most,
        });
    }
    for (found, expected) in [
        (clusters.members.len(), triangles + next),
        (geometry.shapes.count(Kind::Triangle), triangles),
        (geometry.shapes.count(Kind::Sphere), next),
    ] {
        if found != expected {
            return Err(BlobError::Count {
                section,
                found,
                expected,
            });
        }
    }
    // Slot locations lead to members, if there are any.
    let own = clusters.locations.is_empty();
    let members = if own { clusters.members.len() } else { 0 };
    for index in 0..members {
        let primitive = clusters.members.get(index).unwrap_or(u32::MAX).into();
        At { section, index }.within(Field::Primitive, primitive, 0, most as i64 - 1)?;
    }
    Ok(())
}

/// Proves that every pack has a window of radii, and that these are in range or 0.
fn check_radii(packs: &Packs<'_>) -> Result<(), BlobError> {
    let within = |section, index, radius: i32, most: i32| {
        At { section, index }.within(Field::Radius, radius.into(), 0, most.into())
    };
    const MOST: i32 = (i16::MAX as i32) << 1;
    match packs {
        Packs::P16(packs) => {
            for (index, pack) in packs.iter().enumerate() {
                for radius in pack.radii {
                    within(SectionKind::Packs, index, radius.into(), MOST)?;
                }
            }
        }
        Packs::P24(Packs24 { packs, radii }) => {
            let section = SectionKind::Radii;
            let expected = match packs.len() {
                0 => 0,
                _ if radii.len() == RADII => RADII,
                count => (count + 1) * LANES,
            };
            if radii.len() != expected {
                return Err(BlobError::Count {
                    section,
                    found: radii.len(),
                    expected,
                });
            }
            for (index, &radius) in radii.iter().enumerate() {
                within(section, index, radius, MOST << 8)?;
            }
        }
    }
    Ok(())
}

/// Proves that triangles and spheres have records of their own, which all structures except the
/// list and this one use.
pub(crate) fn check_records(geometry: &SceneGeometry<'_>) -> Result<(), BlobError> {
    for (section, kind) in [
        (SectionKind::Triangles, Kind::Triangle),
        (SectionKind::Spheres, Kind::Sphere),
    ] {
        let (found, expected) = (geometry.shapes.records(kind), geometry.shapes.count(kind));
        if found != expected {
            return Err(BlobError::Count {
                section,
                found,
                expected,
            });
        }
    }
    Ok(())
}

/// Proves breadth-first order.
fn check_order(nodes: &[WideNode], geometry: &SceneGeometry<'_>) -> Result<(), BlobError> {
    let section = SectionKind::WideNodes;
    let mut order = Order::new(geometry);
    for (index, node) in nodes.iter().enumerate() {
        let mut ended = false;
        for lane in 0..LANES {
            let child = node.child(lane);
            if child == Child::NONE {
                let empty = node.child_box(lane) == WideNode::EMPTY;
                if lane == 0 {
                    return Err(wrong(section, index, Reason::NoChild));
                }
                if !empty {
                    return Err(wrong(section, index, Reason::LaneNotEmpty));
                }
                ended = true;
                continue;
            }
            if ended {
                return Err(wrong(section, index, Reason::ChildAfterGap));
            }
            order.check_child(index, child)?;
        }
        if order.next_node <= index + 1 && index + 1 < nodes.len() {
            return Err(wrong(section, index + 1, Reason::NotReached));
        }
        if order.next_node > nodes.len() {
            return Err(wrong(section, index, Reason::BeyondLast));
        }
    }
    order.check_ends()
}

/// The numbers that come next in breadth-first order.
struct Order<'g, 'a> {
    geometry: &'g SceneGeometry<'a>,
    next_node: usize,
    next_strip: usize,
    next_pack: usize,
    /// Number of packs before the last that is full. One that is not comes behind it, wherever the hierarchy refers to
    /// it.
    full_packs: usize,
    next_sparse: usize,
    /// The next slots of the kinds that are not in clusters.
    next_slots: [usize; Kind::ALL.len()],
}

impl<'g, 'a> Order<'g, 'a> {
    fn new(geometry: &'g SceneGeometry<'a>) -> Self {
        let packs = geometry.shapes.clusters().packs;
        let full = (0..packs.len()).rposition(|pack| packs.lanes(pack as u32).count_ones() == 8);
        let full_packs = full.map_or(0, |last| last + 1);
        Self {
            geometry,
            next_node: 1,
            next_strip: 0,
            next_pack: 0,
            full_packs,
            next_sparse: full_packs,
            next_slots: [0; Kind::ALL.len()],
        }
    }

    /// Proves that a child of a node is the next of its kind.
    fn check_child(&mut self, index: usize, child: Child) -> Result<(), BlobError> {
        let section = SectionKind::WideNodes;
        let node = Location::Record(section, index);
        if let Some(number) = child.as_node() {
            return follow(index, Field::Child, number, &mut self.next_node);
        }
        let leaf = Leaf::from_word(child.0).filter(|leaf| leaf.kind.is_bounded());
        let Some(leaf) = leaf else {
            let kinds = [0, Kind::LAST_BOUNDED as i64];
            return Err(node.out_of_range(Field::LeafKind, (child.0 >> 29).into(), kinds));
        };
        let next = match (leaf.kind, leaf.count) {
            (Kind::Triangle, 0) => &mut self.next_strip,
            (Kind::Sphere, 0) if leaf.first as usize >= self.full_packs => &mut self.next_sparse,
            (Kind::Sphere, 0) => &mut self.next_pack,
            (kind, 1) if !kind.is_clustered() => {
                let shapes = &self.geometry.shapes;
                let next = &mut self.next_slots[kind as usize];
                // Where other structures share the slots, the slots are in the order of those structures.
                let own_order = shapes.clusters().locations.is_empty();
                if !own_order && (leaf.first as usize) < shapes.count(kind) {
                    *next += 1;
                    return Ok(());
                }
                next
            }
            (kind, count) => {
                let slots = [i64::from(!kind.is_clustered()); 2];
                return Err(node.out_of_range(Field::LeafSlots, count.into(), slots));
            }
        };
        follow(index, Field::Leaf, leaf.first, next)
    }

    /// Proves that all strips, packs and slots were reached.
    fn check_ends(&self) -> Result<(), BlobError> {
        let shapes = &self.geometry.shapes;
        let Clusters { strips, packs, .. } = shapes.clusters();
        let clusters = [
            (self.next_strip, strips.len()),
            (self.next_pack, self.full_packs),
            (self.next_sparse, packs.len()),
        ];
        let kinds = Kind::ALL
            .into_iter()
            .filter(|kind| !kind.is_clustered() && kind.is_bounded());
        let others = kinds.map(|kind| (self.next_slots[kind as usize], shapes.count(kind)));
        for (found, expected) in clusters.into_iter().chain(others) {
            if found != expected {
                return Err(BlobError::Count {
                    section: SectionKind::WideNodes,
                    found,
                    expected,
                });
            }
        }
        Ok(())
    }
}

/// Proves that a number of a node's child is the next in order, and counts on.
fn follow(index: usize, field: Field, found: u32, next: &mut usize) -> Result<(), BlobError> {
    follows(SectionKind::WideNodes, index, field, found as usize, *next)?;
    *next += 1;
    Ok(())
}

/// Proves, where other structures share the primitives, that the hierarchy holds each of them once.
/// Every slot has a location that leads back to it, and there are as many locations as places.
fn check_slot_locations(nodes: &[WideNode], geometry: &SceneGeometry<'_>) -> Result<(), BlobError> {
    let section = SectionKind::SlotLocations;
    let (shapes, clusters) = (&geometry.shapes, geometry.shapes.clusters());
    let locations = clusters.locations;
    if locations.is_empty() {
        // Then the clusters hold the only triangles and spheres.
        for (section, kind) in [
            (SectionKind::Triangles, Kind::Triangle),
            (SectionKind::Spheres, Kind::Sphere),
        ] {
            let found = shapes.records(kind);
            if found > 0 {
                return Err(BlobError::Count {
                    section,
                    found,
                    expected: 0,
                });
            }
        }
        return Ok(());
    }
    check_records(geometry)?;
    let bounded = || Kind::ALL.into_iter().filter(|kind| kind.is_bounded());
    let slots = bounded().map(|kind| shapes.records(kind)).sum();
    if locations.len() != slots {
        return Err(BlobError::Count {
            section,
            found: locations.len(),
            expected: slots,
        });
    }
    let mut rest = locations.iter().enumerate();
    for kind in bounded() {
        for (slot, (index, &location)) in (0..shapes.records(kind) as u32).zip(rest.by_ref()) {
            let (cluster, lane) = (location >> 3, location & 7);
            let leads_back = match kind {
                Kind::Triangle => {
                    let members = clusters.strips.members(cluster);
                    members.is_some_and(|it| it.lanes() >> lane & 1 != 0)
                        && clusters.triangle_member(cluster, lane) == Some(slot)
                        && clusters.strips.triangle(cluster, lane) == shapes.triangle(slot as usize)
                }
                Kind::Sphere => {
                    let sphere = clusters.packs.sphere(cluster, lane);
                    clusters.sphere_member(cluster, lane) == Some(slot)
                        && sphere == shapes.spheres.get(slot as usize)
                        && sphere.is_some()
                }
                _ => {
                    let leaf = Leaf {
                        kind,
                        first: slot,
                        count: 1,
                    };
                    let node = nodes.get(location as usize);
                    node.is_some_and(|node| node.children.contains(&leaf.to_word()))
                }
            };
            if !leads_back {
                return Err(wrong(section, index, Reason::WrongSlotLocation));
            }
        }
    }
    Ok(())
}

/// Proves that boxes hold everything below them, and returns the maximum number of waiting entries
/// of a walk.
fn check_boxes(nodes: &[WideNode], geometry: &SceneGeometry<'_>) -> Result<usize, BlobError> {
    let section = SectionKind::WideNodes;
    let clusters = geometry.shapes.clusters();
    let mut deepest = 0;
    if nodes.is_empty() {
        return Ok(0);
    }
    // Waiting children, their boxes, and the number of entries that wait before they are reached.
    let mut waiting: Vec<(u32, UnitBox, u16), { MAX_STACK_DEPTH + 1 }> = Vec::new();
    let mut current = Some((0, *geometry.bounds(), 0));
    while let Some((number, parent, before)) = current {
        let index = number as usize;
        if let Some(node) = nodes.get(index) {
            let count = (0..LANES).filter(|&lane| node.child(lane) != Child::NONE);
            let after = before + count.count().saturating_sub(1) as u16;
            deepest = deepest.max(after.into());
            if deepest > MAX_STACK_DEPTH {
                let range = [0, MAX_STACK_DEPTH as i64];
                let location = Location::Section(section);
                return Err(location.out_of_range(Field::StackDepth, deepest as i64, range));
            }
            for lane in 0..LANES {
                let child = node.child(lane);
                if child == Child::NONE {
                    break;
                }
                let bounds = node.child_box(lane);
                let within = match (child.as_node(), Leaf::from_word(child.0)) {
                    (Some(number), _) => {
                        // It fits: no more entries wait here than in a walk, which was proved
                        // above.
                        let _ = waiting.push((number, bounds, after));
                        true
                    }
                    (None, Some(leaf)) if leaf.count == 0 => {
                        clusters.inside(leaf.kind, leaf.first, &bounds)
                    }
                    (None, Some(leaf)) => geometry.shapes.leaf_inside(leaf, &bounds),
                    (None, None) => false,
                };
                if !within || !parent.contains(&bounds) {
                    return Err(wrong(section, index, Reason::ChildOutside));
                }
            }
        }
        current = waiting.pop();
    }
    Ok(deepest)
}
