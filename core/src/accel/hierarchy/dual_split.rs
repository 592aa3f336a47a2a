//! Dual-split nodes. A node stores the two planes of its split, and the planes of its own box on up to two axes. The
//! builder chooses these axes where they save the most tests.
//!
//! A ray reaches a node with the interval in which it runs through the node's *region*. The region is the part of the
//! scene's box that the planes on the way down have left. A node narrows the region:
//!
//! - Up to two *carves* cut it, on one axis each, to the space between two planes.
//! - A *split* gives one child all below one plane and the other all above another, on one axis. The two can overlap,
//!   or leave a gap.
//!
//! The builder walks the hierarchy with the regions and chooses axes by the tests that they save. The split cuts off
//! the space that the children do not touch, so most sides of a box are never tested. The sign of the ray's direction
//! on the split's axis determines the nearer child, so no intervals are compared.
//!
//! **Culling is conservative and monotone.** The step at which a ray crosses a plane is monotone in the plane's place
//! (`accel::cull`). So the interval of a region is the intersection of the intervals of its planes, whatever was
//! rounded. A box in a region has its interval in the region's. A core that culls with wider intervals keeps this
//! property.
//!
//! [`Scene::from_bytes`](crate::Scene::from_bytes) proves that the box of each primitive lies in the region of its
//! leaf. A hit's `t` lies in the interval of the primitive's own box, or is clamped to it. It also lies between the
//! ray's tmin and the best hit so far. The walk's interval holds both, so the walk visits every node on the way to a
//! hit. A side that no plane bounds costs visits, not hits. A region without primitives can even be empty.

use crate::accel::cull::{Cull, Culling, PairCulling};
use crate::accel::cull_axis::{CullAxis, Interval};
use crate::accel::hierarchy::check::{Path, Tree, check_tree};
use crate::accel::hierarchy::order::Order;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::{Entry, StackView};
use crate::accel::traverse::Traverse;
use crate::format::link::Node;
use crate::format::record::{DualNode, UnitBox};
use crate::format::{
    BlobError, Leaf, Location, NodeWord, Reason, SectionKind, Sections, Structure,
};
use crate::observe::count::Observer;
use crate::observe::event::{Event, NodeId, Sides};
use crate::ray::Ray;
use crate::target::{NARROW_PRODUCTS, SMALL};
use core::hint::black_box;

/// True if a ray's form stays in memory, hidden from the optimizer. Cores that load two words at once and have few
/// registers read the form of an axis faster from there.
const FORM_IN_MEMORY: bool = cfg!(target_arch = "arm") && !NARROW_PRODUCTS;

/// A hierarchy of 16 bytes per node; a ray tests two to six planes per node.
#[derive(Clone, Copy, Debug)]
pub enum DualSplit {}

impl Traverse for DualSplit {
    const STRUCTURE: Structure = Structure::DualSplit;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = Cull;

    #[inline]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Cull,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let nodes = views.0;
        let mut limit = <Cull as PairCulling<N>>::limit(ray.tmax);
        let mut interval = PairCulling::<N>::root(cull, geometry.bounds(), limit);
        let cull = if FORM_IN_MEMORY {
            black_box(cull)
        } else {
            cull
        };
        tested(count, 6, || Event::Tested {
            node: place(0),
            sides: geometry.bounds().0.map(|axis| axis.map(Some)),
            span: Cull::span(interval),
        });
        if interval.near > interval.far {
            return;
        }
        // It is cheaper to fill a full stack from the bottom than to let a stack grow.
        if stack.len() < stack.capacity() {
            let _ = stack.resize_default(stack.capacity());
        }
        let stack = stack.as_mut_slice();
        let (mut node, mut height) = (0, 0);
        loop {
            let Some(record) = nodes.get(node as usize) else {
                return;
            };
            if C::ENABLED {
                count.event(Event::Opened(place(node)));
            }
            match visit(record, node, &mut interval, cull, count) {
                Next::Near(child) => {
                    node = child;
                    continue;
                }
                Next::Both(near, later) => {
                    let Some(free) = stack.get_mut(height) else {
                        return;
                    };
                    *free = later;
                    height += 1;
                    node = near;
                    continue;
                }
                Next::Leaf(number) => {
                    let Some(range) = geometry.leaf(number) else {
                        return;
                    };
                    let Some(tmax) = leaf(range, count) else {
                        return;
                    };
                    limit = <Cull as PairCulling<N>>::limit(tmax);
                }
                Next::Nothing => {}
            }
            loop {
                height = height.wrapping_sub(1);
                let Some(entry) = stack.get(height) else {
                    return;
                };
                if entry.near <= limit {
                    node = entry.node;
                    interval = Interval {
                        near: entry.near,
                        far: entry.far.min(limit),
                    };
                    break;
                }
                if C::ENABLED {
                    count.event(Event::NodeSkipped {
                        node: place(entry.node),
                        enters: <Cull as Culling<N>>::units(entry.near),
                    });
                }
            }
        }
    }
}

/// A node as events report it.
fn place(number: u32) -> NodeId {
    NodeId {
        what: "node",
        number,
    }
}

/// Counts and reports planes that were tested for a node.
#[inline(always)]
fn tested<C: Observer>(count: &mut C, planes: u32, event: impl FnOnce() -> Event) {
    count.planes(planes);
    count.boxes(1);
    if C::ENABLED {
        count.event(event());
    }
}

/// Sides on one axis.
fn sides(axis: usize, [lower, upper]: [Option<i16>; 2]) -> Sides {
    let mut sides = Sides::default();
    if let Some(side) = sides.get_mut(axis) {
        *side = [lower, upper];
    }
    sides
}

/// The next step of a walk after a node.
enum Next {
    Nothing,
    Leaf(u32),
    Near(u32),
    Both(u32, Entry),
}

/// Narrows a ray's interval to a node's and then to that of the next child.
///
/// Compiled for each pair of a first carve's axis and a split's, so that neither is looked up, except where code is
/// optimized for size.
#[inline(always)]
fn visit<C: Observer>(
    record: &DualNode,
    number: u32,
    interval: &mut Interval,
    cull: &Cull,
    count: &mut C,
) -> Next {
    match NodeWord(record.word).kind() {
        _ if SMALL => visit_kind::<ANY, ANY, C>(record, number, interval, cull, count),
        0 => visit_kind::<0, 0, C>(record, number, interval, cull, count),
        1 => visit_kind::<1, 0, C>(record, number, interval, cull, count),
        2 => visit_kind::<2, 0, C>(record, number, interval, cull, count),
        3 => visit_kind::<3, 0, C>(record, number, interval, cull, count),
        4 => visit_kind::<0, 1, C>(record, number, interval, cull, count),
        5 => visit_kind::<1, 1, C>(record, number, interval, cull, count),
        6 => visit_kind::<2, 1, C>(record, number, interval, cull, count),
        7 => visit_kind::<3, 1, C>(record, number, interval, cull, count),
        8 => visit_kind::<0, 2, C>(record, number, interval, cull, count),
        9 => visit_kind::<1, 2, C>(record, number, interval, cull, count),
        10 => visit_kind::<2, 2, C>(record, number, interval, cull, count),
        11 => visit_kind::<3, 2, C>(record, number, interval, cull, count),
        12 => visit_kind::<0, 3, C>(record, number, interval, cull, count),
        13 => visit_kind::<1, 3, C>(record, number, interval, cull, count),
        14 => visit_kind::<2, 3, C>(record, number, interval, cull, count),
        _ => visit_kind::<3, 3, C>(record, number, interval, cull, count),
    }
}

/// Marks an axis that is not known at compile time.
const ANY: usize = 4;

#[inline(always)]
fn visit_kind<const SPLIT: usize, const CARVE: usize, C: Observer>(
    record: &DualNode,
    number: u32,
    interval: &mut Interval,
    cull: &Cull,
    count: &mut C,
) -> Next {
    let word = NodeWord(record.word);
    let first = if CARVE == ANY {
        word.first_carve()
    } else {
        CARVE
    };
    if let Some(form) = cull.axes.get(first) {
        carve_ray(form, first, record.carves[0], number, interval, count);
        if interval.near > interval.far {
            return Next::Nothing;
        }
        let second = word.second_carve();
        if let Some(form) = cull.axes.get(second) {
            carve_ray(form, second, record.carves[1], number, interval, count);
            if interval.near > interval.far {
                return Next::Nothing;
            }
        }
    }
    let axis = if SPLIT == ANY { word.split() } else { SPLIT };
    match cull.axes.get(axis) {
        Some(form) => split(record, interval, form, count),
        None => Next::Leaf(word.number()),
    }
}

/// Narrows a ray's interval to the carve.
#[inline(always)]
fn carve_ray<C: Observer>(
    form: &CullAxis,
    axis: usize,
    planes: u32,
    number: u32,
    interval: &mut Interval,
    count: &mut C,
) {
    *interval = interval.and(form.around(planes));
    tested(count, 2, || Event::Tested {
        node: place(number),
        sides: sides(axis, [Some(planes as i16), Some((planes >> 16) as i16)]),
        span: Cull::span(*interval),
    });
}

/// Chooses among the children of a split.
#[inline(always)]
fn split<C: Observer>(
    record: &DualNode,
    interval: &mut Interval,
    form: &CullAxis,
    count: &mut C,
) -> Next {
    let (planes, word) = (record.split, NodeWord(record.word));
    let first = word.number();
    let Interval {
        near: enter,
        far: leave,
    } = form.around(planes);
    // The rotation is 0 or 16.
    let near = first + (form.rotation >> 4);
    let far = first + (16_u32.wrapping_sub(form.rotation) >> 4);
    let whole = *interval;
    count.planes(2);
    count.boxes(2);
    if C::ENABLED {
        let to_near = [whole.near, whole.far.min(leave)];
        let to_far = [whole.near.max(enter), whole.far];
        for (child, [near, far]) in [(near, to_near), (far, to_far)] {
            let planes = [planes as i16, (planes >> 16) as i16].map(Some);
            let planes = if child == first {
                [None, planes[1]]
            } else {
                [planes[0], None]
            };
            count.event(Event::Tested {
                node: place(child),
                sides: sides(word.split(), planes),
                span: Cull::span(Interval { near, far }),
            });
        }
    }
    if whole.near > leave {
        // Between the two planes, or past the far one: its own planes can be of other axes, or absent.
        interval.near = whole.near.max(enter);
        if interval.near > whole.far {
            return Next::Nothing;
        }
        return Next::Near(far);
    }
    interval.far = whole.far.min(leave);
    if enter > whole.far {
        return Next::Near(near);
    }
    let later = Entry {
        node: far,
        near: whole.near.max(enter),
        far: whole.far,
    };
    Next::Both(near, later)
}

/// The nodes of a scene, breadth first.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a>(&'a [DualNode]);

const SECTION: SectionKind = SectionKind::DualNodes;

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[SECTION];
    const USES_LEAVES: bool = true;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self(sections.records(SECTION)?))
    }

    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        check_tree(*self, geometry, geometry.bounds())
    }
}

impl Views<'_> {
    /// The word of a node. A missing node has the word of a missing leaf.
    fn word(self, number: u32) -> NodeWord {
        let record = self.0.get(number as usize);
        NodeWord(record.map_or(u32::MAX, |record| record.word))
    }
}

impl Tree for Views<'_> {
    const SECTION: SectionKind = SECTION;
    const OUTSIDE: Reason = Reason::PrimitiveOutsideRegion;
    /// A region: the part of the scene's box that the planes on the way down have left.
    type Volume = UnitBox;

    fn order(self, leaves: usize) -> Result<usize, BlobError> {
        check_order(self.0, leaves)
    }

    fn root(self) -> Node {
        Node::pair(0)
    }

    fn leaf(self, node: Node) -> Option<u32> {
        let word = self.word(node.number());
        (word.split() == NodeWord::NONE as usize).then_some(word.number())
    }

    fn child(self, number: u32, side: u32) -> Node {
        Node::pair(self.word(number).number().wrapping_add(side))
    }

    #[inline(always)]
    fn enter_child(self, number: u32, side: u32, region: &mut UnitBox) {
        let Some(record) = self.0.get(number as usize) else {
            return;
        };
        carve(region, record);
        if let Some(sides) = region.0.get_mut(NodeWord(record.word).split()) {
            if side == 0 {
                sides[1] = sides[1].min((record.split >> 16) as i16);
            } else {
                sides[0] = sides[0].max(record.split as i16);
            }
        }
    }

    #[inline(always)]
    fn contains_leaf(
        self,
        geometry: &SceneGeometry<'_>,
        leaf: Leaf,
        node: Node,
        parent: &UnitBox,
        _: &Path,
    ) -> bool {
        let mut region = *parent;
        if let Some(record) = self.0.get(node.number() as usize) {
            carve(&mut region, record);
        }
        geometry.shapes.leaf_inside(leaf, &region)
    }
}

/// Cuts a region down to a node's carves.
fn carve(region: &mut UnitBox, record: &DualNode) {
    for (axis, planes) in NodeWord(record.word)
        .carves()
        .into_iter()
        .zip(record.carves)
    {
        if let Some(sides) = region.0.get_mut(axis) {
            sides[0] = sides[0].max(planes as i16);
            sides[1] = sides[1].min((planes >> 16) as i16);
        }
    }
}

/// Proves breadth-first order, and that all nodes and leaves are reached. Returns the number of levels that have a
/// split.
fn check_order(nodes: &[DualNode], leaves: usize) -> Result<usize, BlobError> {
    let expected = leaves.saturating_mul(2).saturating_sub(1);
    if nodes.len() != expected {
        return Err(BlobError::Count {
            section: SECTION,
            found: nodes.len(),
            expected,
        });
    }
    let mut order = Order::new(SECTION, nodes.len());
    for (index, record) in nodes.iter().enumerate() {
        let word = NodeWord(record.word);
        let [first, second] = word.carves();
        let unused = record.word >> 30 != 0 || first == 3 && second != 3;
        if unused {
            return Err(Location::Record(SECTION, index).invalid(Reason::UnusedBits));
        }
        order.dual(word)?;
    }
    order.levels()
}
