//! Lays a hierarchy out with volumes other than boxes: slabs and spheres.

use super::node::{Node, Primitive};
use super::pairs::Flat;
use crate::compile::geometry::primitives::Primitives;
use crate::compile::section::{Section, section};
use glam::DVec3;
use gridel_core::Kind;
use gridel_core::format::record::{BoundingSphere, SpherePair, plane_word};
use gridel_core::format::{Link, SectionKind};
use gridel_core::shared::DIRECTIONS;
use gridel_core::shared::Reach;
use gridel_core::shared::Volume;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::ops::Range;

/// A hierarchy, and what its volumes must hold.
pub struct Tree<'t> {
    root: &'t Node,
    flat: &'t Flat,
    /// In the order of the leaves.
    reaches: Vec<Reach>,
}

impl<'t> Tree<'t> {
    /// Returns the hierarchy that was laid out as `flat`, over primitives in the order of its leaves.
    pub fn new(root: &'t Node, flat: &'t Flat, order: &[Primitive], snapped: &Primitives) -> Self {
        let reach = |primitive: &Primitive| match primitive.kind {
            Kind::Sphere => {
                let sphere = snapped.records.spheres[primitive.index as usize];
                Reach::Sphere(sphere.center, sphere.radius)
            }
            _ => Reach::Box(primitive.bounds),
        };
        Self {
            root,
            flat,
            reaches: order.iter().map(reach).collect(),
        }
    }

    /// The children of all pairs, in the order of the pairs.
    fn pairs(&self) -> Vec<&'t [Node; 2]> {
        let mut waiting = VecDeque::from([self.root]);
        let mut pairs = Vec::new();
        while let Some(node) = waiting.pop_front() {
            if let Node::Inner { children, .. } = node {
                pairs.push(&**children);
                waiting.extend(children.iter());
            }
        }
        pairs
    }

    /// Slabs of some of the directions: a word a direction for the root, and the pairs' words.
    pub fn slabs(&self, directions: usize, flagged: bool) -> Vec<Section> {
        let extents: Vec<Volume> = self
            .reaches
            .iter()
            .map(|reach| DIRECTIONS.map(|direction| reach.slab(direction)))
            .collect();
        let volume = |range: Range<usize>| {
            let all = extents[range].iter().copied();
            all.reduce(|a, b| std::array::from_fn(|k| [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])]))
                .unwrap_or([[0; 2]; DIRECTIONS.len()])
        };
        let root = volume(0..extents.len());
        let root_words: Vec<u32> = root[..directions]
            .iter()
            .map(|&sides| plane_word(sides))
            .collect();
        let mut words = Vec::new();
        for (number, children) in self.pairs().into_iter().enumerate() {
            let [left, right] = children.each_ref().map(|child| volume(range(child)));
            let sides = (0..directions).map(|k| (left[k], right[k]));
            if flagged {
                let mut owners = 0;
                for (k, (left, right)) in sides.enumerate() {
                    // The child that lies farther in owns the plane; the other's is the parent's.
                    let lower_right = right[0] > left[0];
                    let upper_right = right[1] < left[1];
                    words.push(plane_word([left[0].max(right[0]), left[1].min(right[1])]));
                    owners |= (u32::from(lower_right) | u32::from(upper_right) << 1) << (2 * k);
                }
                let link = Link(self.flat.flagged[number].link).with_owners(0).0;
                words.extend([owners, link]);
            } else {
                for (left, right) in sides {
                    words.extend([0, 1].map(|side| plane_word([left[side], right[side]])));
                }
                words.extend(self.flat.pairs[number].children);
            }
        }
        let kinds = if flagged {
            [SectionKind::FlaggedSlabRoot, SectionKind::FlaggedSlabPairs]
        } else {
            [SectionKind::SlabRoot, SectionKind::SlabPairs]
        };
        let mut pairs = section(kinds[1], &words);
        pairs.stride *= 2 + if flagged { directions } else { 2 * directions };
        vec![section(kinds[0], &root_words), pairs]
    }

    /// Bounding spheres.
    pub fn spheres(&self) -> Section {
        let pairs: Vec<SpherePair> = self
            .pairs()
            .into_par_iter()
            .zip(&self.flat.pairs)
            .map(|(children, pair)| SpherePair {
                spheres: children
                    .each_ref()
                    .map(|child| enclosing(&self.reaches[range(child)])),
                children: pair.children,
            })
            .collect();
        section(SectionKind::SpherePairs, &pairs)
    }
}

/// The primitives below a node.
fn range(node: &Node) -> Range<usize> {
    match node {
        Node::Leaf { first, count, .. } => *first..first + count,
        Node::Inner { children, .. } => {
            // Whichever of them comes first: laying out dual-split nodes may have swapped them.
            let [one, other] = children.each_ref().map(range);
            one.start.min(other.start)..one.end.max(other.end)
        }
    }
}

/// Steps towards the farthest primitive. After this many the radius is within some percent of the
/// least (Badoiu and Clarkson, "Smaller core-sets for balls", 2003).
const STEPS: usize = 24;

/// A small ball that holds all of some primitives' reach.
fn enclosing(reaches: &[Reach]) -> BoundingSphere {
    // How far the farthest point of a primitive is, and where it is.
    let farthest = |center: DVec3, reach: &Reach| match *reach {
        Reach::Sphere(middle, radius) => {
            let middle = DVec3::from_array(middle.map(f64::from)) / 256.0;
            let apart = middle - center;
            let outward = apart.try_normalize().unwrap_or(DVec3::X);
            let point = middle + outward * (f64::from(radius) / 256.0);
            (point.distance(center), point)
        }
        Reach::Box(bounds) => {
            let corner = DVec3::from_array(std::array::from_fn(|k| {
                let [low, high] = bounds.0[k].map(f64::from);
                if high - center[k] > center[k] - low {
                    high
                } else {
                    low
                }
            }));
            (corner.distance(center), corner)
        }
    };
    let most = |center: DVec3| {
        let all = reaches.iter().map(|reach| farthest(center, reach));
        all.max_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((0.0, center))
    };
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for reach in reaches {
        let (lowest, highest) = match *reach {
            Reach::Sphere(middle, radius) => {
                let middle = DVec3::from_array(middle.map(f64::from));
                let radius = f64::from(radius);
                ((middle - radius) / 256.0, (middle + radius) / 256.0)
            }
            Reach::Box(bounds) => (
                DVec3::from_array(bounds.0.map(|side| side[0].into())),
                DVec3::from_array(bounds.0.map(|side| side[1].into())),
            ),
        };
        (low, high) = (low.min(lowest), high.max(highest));
    }
    let mut center = low.midpoint(high);
    let (mut best, mut best_center) = (most(center).0, center);
    for step in 1..=STEPS {
        let (_, point) = most(center);
        center += (point - center) / (step + 1) as f64;
        let (distance, _) = most(center);
        if distance < best {
            (best, best_center) = (distance, center);
        }
    }
    let center = best_center.round().to_array().map(|x| x as i16);
    // From below the required radius up to it. The proof's own comparison decides.
    let mut radius = best.floor().clamp(0.0, f64::from(u16::MAX)) as u16;
    while radius < u16::MAX && !reaches.iter().all(|reach| reach.in_sphere(center, radius)) {
        radius += 1;
    }
    BoundingSphere { center, radius }
}
