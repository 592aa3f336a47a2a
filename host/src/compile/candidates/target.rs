//! Primitives as the builders of candidate lists see them, and the search for those that a shaft
//! meets.

use super::shaft::Shaft;
use crate::compile::geometry::primitives::Primitives;
use crate::compile::hierarchy::pairs::Flat;
use crate::shape;
use glam::DVec3;
use gridel_core::Kind;
use gridel_core::format::Leaf;
use gridel_core::format::record::{Gridels, Pair, UnitBox};

/// Units by which the surface of a primitive is widened where the primitive itself is tested. Kernels are off by less
/// than a quarter.
const SURFACE_SPARE: f64 = 2.0;

/// A primitive in units, widened so that it contains every hit that a kernel accepts.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    bounds: [[f64; 2]; 3],
    surface: Surface,
}

/// The geometry of a primitive beyond its box.
#[derive(Clone, Copy, Debug)]
enum Surface {
    Box,
    Sphere {
        center: [f64; 3],
        radius2: f64,
    },
    /// Within a distance of a plane, both scaled by the normal's length.
    Flat {
        normal: [f64; 3],
        range: [f64; 2],
    },
}

impl Target {
    /// Returns the interval along a shaft in which the primitive can be met; `None` if it cannot.
    #[inline]
    pub fn met_by(&self, shaft: &Shaft) -> Option<[f64; 2]> {
        let span = shaft.meets(&self.bounds)?;
        let met = match self.surface {
            Surface::Box => true,
            Surface::Sphere { center, radius2 } => shaft.distance2(center, span) <= radius2,
            Surface::Flat { normal, range } => {
                let [low, high] = shaft.along(normal);
                low <= range[1] && high >= range[0]
            }
        };
        met.then_some(span)
    }

    /// Returns the multiple of its way after which a ray enters the primitive, if that is a sphere before it.
    pub fn entered_by(&self, from: DVec3, way: DVec3) -> Option<f64> {
        let Surface::Sphere { center, radius2 } = self.surface else {
            return None;
        };
        let to_center = DVec3::from_array(center) - from;
        let (middle, length2) = (to_center.dot(way), way.length_squared());
        let room = middle * middle - length2 * (to_center.length_squared() - radius2);
        (room >= 0.0 && middle > 0.0).then(|| (middle - room.sqrt()) / length2)
    }

    /// Returns the widened box.
    pub fn bounds(&self) -> &[[f64; 2]; 3] {
        &self.bounds
    }

    /// Returns the sphere around the primitive: its own, or that of its box.
    pub fn bounding_sphere(&self) -> ([f64; 3], f64) {
        if let Surface::Sphere { center, radius2 } = self.surface {
            return (center, radius2.sqrt() + Gridels::SPARE);
        }
        let center = self.bounds.map(|[low, high]| 0.5 * (low + high));
        let half = DVec3::from_array(self.bounds.map(|[low, high]| 0.5 * (high - low)));
        (center, half.length() * (1.0 + 1e-12))
    }
}

/// Widens a box so that it holds its hits.
fn widened(bounds: &UnitBox) -> [[f64; 2]; 3] {
    bounds.0.map(|[low, high]| {
        [
            f64::from(low) - Gridels::SPARE,
            f64::from(high) + Gridels::SPARE,
        ]
    })
}

/// All primitives in the order of their slots, and the hierarchy over them.
#[derive(Debug)]
pub struct Targets<'f> {
    pub bounds: UnitBox,
    targets: Vec<Target>,
    /// The first slot of each kind.
    first: [usize; Kind::ALL.len()],
    flat: &'f Flat,
}

/// A node of the hierarchy as its records name it: a pair, or with bit 31 a leaf.
pub type Node = u32;
const LEAF: Node = 1 << 31;

impl<'f> Targets<'f> {
    pub fn new(primitives: &Primitives, flat: &'f Flat, bounds: UnitBox) -> Self {
        let boxes = primitives.boxes();
        let mut first = [0; Kind::ALL.len()];
        let mut box_first = [0; Kind::ALL.len()];
        let (mut slots, mut numbers) = (0, 0);
        let bounded = Kind::ALL.into_iter().filter(|kind| kind.is_bounded());
        for kind in bounded.clone() {
            first[kind as usize] = slots;
            box_first[kind as usize] = numbers;
            slots += flat.slots[kind as usize].len();
            numbers += boxes.iter().filter(|it| it.kind == kind).count();
        }
        let targets = bounded.flat_map(|kind| {
            let indices = &flat.slots[kind as usize];
            let boxes = &boxes[box_first[kind as usize]..];
            indices.iter().map(move |&index| Target {
                bounds: widened(&boxes[index as usize].bounds),
                surface: surface(primitives, kind, index as usize),
            })
        });
        Self {
            bounds,
            targets: targets.collect(),
            first,
            flat,
        }
    }

    pub fn all(&self) -> &[Target] {
        &self.targets
    }

    /// Calls `found` for every primitive that a shaft meets, with its slot and where.
    pub fn search(&self, shaft: &Shaft, found: &mut impl FnMut(u32, [f64; 2])) {
        if let Some(root) = self.root() {
            self.search_below(root, shaft, found);
        }
    }

    /// Returns the root of the hierarchy; none without primitives.
    pub fn root(&self) -> Option<Node> {
        match (self.flat.pairs.is_empty(), self.flat.leaves.is_empty()) {
            (true, true) => None,
            (true, false) => Some(LEAF),
            (false, _) => Some(0),
        }
    }

    /// Calls `found` for every primitive below a node that a shaft meets.
    pub fn search_below(&self, node: Node, shaft: &Shaft, found: &mut impl FnMut(u32, [f64; 2])) {
        match self.children(node) {
            Some(children) => {
                for (child, bounds) in children {
                    if shaft.meets(&bounds).is_some() {
                        self.search_below(child, shaft, found);
                    }
                }
            }
            None => {
                for slot in self.slots(node) {
                    if let Some(span) = self.targets[slot].met_by(shaft) {
                        found(slot as u32, span);
                    }
                }
            }
        }
    }

    /// Returns the children of a node with their boxes, widened; `None` for a leaf.
    pub fn children(&self, node: Node) -> Option<[(Node, [[f64; 2]; 3]); 2]> {
        if node & LEAF != 0 {
            return None;
        }
        let Pair { planes, children } = self.flat.pairs[node as usize];
        let bounds = |child: usize| {
            widened(&UnitBox(
                planes.map(|[low, high]| [low[child], high[child]]),
            ))
        };
        Some([(children[0], bounds(0)), (children[1], bounds(1))])
    }

    /// Returns the slots of a leaf.
    pub fn slots(&self, node: Node) -> std::ops::Range<usize> {
        let leaf = Leaf::from_word(self.flat.leaves[(node & !LEAF) as usize]);
        leaf.map_or(0..0, |leaf| {
            let first = self.first[leaf.kind as usize] + leaf.first as usize;
            first..first + leaf.count as usize
        })
    }

    /// Nodes of the hierarchy, as numbers for lists: pairs first, then leaves.
    pub fn node_count(&self) -> u32 {
        (self.flat.pairs.len() + self.flat.leaves.len()) as u32
    }

    /// Returns a node's number.
    pub fn node_number(&self, node: Node) -> u32 {
        match node & LEAF {
            0 => node,
            _ => self.flat.pairs.len() as u32 + (node & !LEAF),
        }
    }
}

fn surface(primitives: &Primitives, kind: Kind, index: usize) -> Surface {
    match primitives.solid(kind, index).surface() {
        shape::Surface::Sphere { center, radius } => {
            let radius = radius + SURFACE_SPARE;
            Surface::Sphere {
                center: center.to_array(),
                radius2: radius * radius,
            }
        }
        shape::Surface::Plane { normal, point } => flat(normal, point),
        shape::Surface::Box | shape::Surface::Curved => Surface::Box,
    }
}

fn flat(normal: DVec3, point: DVec3) -> Surface {
    let normal = normal.normalize_or_zero();
    let middle = normal.dot(point);
    // The rounding of this computation is far below the spare.
    let spare = SURFACE_SPARE;
    Surface::Flat {
        normal: normal.to_array(),
        range: [middle - spare, middle + spare],
    }
}
