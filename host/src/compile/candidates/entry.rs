//! Chooses the nodes at which a ray between two gridels enters the hierarchy.
//!
//! A node is replaced by its children that lead to candidates, as long as that lowers the estimated cost. It saves the
//! test of their boxes, and costs the rays that each child's box would have culled. A few sample rays of the pair
//! estimate how often rays miss a child's box.

use super::cylinder_cube::{Form, Pair, sorted};
use super::lists::List;
use super::shaft::Shaft;
use super::target::{Node, Targets};
use gridel_core::Structure;
use gridel_core::accel::CylinderCubeEntry;
use gridel_core::format::record::Gridels;
use std::cell::OnceCell;

/// The form whose lists hold nodes.
pub struct EntryNodes<'t>(pub &'t Targets<'t>);

/// Rays tried for a pair, each from a place of one gridel to a place of the other.
const SAMPLES: usize = 16;

impl Form for EntryNodes<'_> {
    const STRUCTURE: Structure = Structure::CylinderCubeEntry;
    const KEYED: bool = true;
    const MOST: u32 = Gridels::MOST;

    fn end(&self) -> u32 {
        self.0.node_count()
    }

    fn list(&self, pair: &Pair, list: &mut List) {
        let shaft = Shaft::between(pair.0[0], pair.0[1]);
        let whole = self.0.bounds.0.map(|side| side.map(f64::from));
        let root = self.0.root().filter(|&root| self.leads_on(root, &shaft));
        let Some(root) = root else {
            return;
        };
        let samples = Samples::of(pair);
        let mut waiting = vec![(root, whole)];
        let mut chosen = Vec::new();
        while let Some((node, bounds)) = waiting.pop() {
            let Some(children) = self.0.children(node) else {
                chosen.push((node, bounds));
                continue;
            };
            let mut met = children;
            let leading = |&(child, bounds): &(Node, [[f64; 2]; 3])| {
                shaft.meets(&bounds).is_some() && self.leads_on(child, &shaft)
            };
            let count = match children.each_ref().map(leading) {
                [true, true] => 2,
                [first, _] => {
                    met[0] = children[usize::from(!first)];
                    1
                }
            };
            let met = &met[..count];
            let room = waiting.len() + chosen.len() + count <= CylinderCubeEntry::MOST_NODES;
            // One pair for another costs nothing more.
            let free = count == 1 && self.0.children(met[0].0).is_some();
            let wasted = || {
                let each = met
                    .iter()
                    .map(|&(child, bounds)| (1.0 - samples.chance(&bounds)) * self.tests(child));
                each.sum::<f64>()
            };
            if room && (free || wasted() < 1.0) {
                waiting.extend_from_slice(met);
            } else {
                chosen.push((node, bounds));
            }
        }
        let met = chosen.into_iter().filter_map(|(node, bounds)| {
            let span = shaft.meets(&bounds)?;
            Some((self.0.node_number(node), span))
        });
        sorted(met.collect(), list);
    }
}

impl EntryNodes<'_> {
    /// Returns the first tests of a ray that enters at a node: two boxes, which count as one
    /// test, or all primitives of a leaf.
    fn tests(&self, node: Node) -> f64 {
        match self.0.children(node) {
            Some(_) => 1.0,
            None => self.0.slots(node).count() as f64,
        }
    }

    /// Returns whether a shaft meets a primitive below a node.
    fn leads_on(&self, node: Node, shaft: &Shaft) -> bool {
        match self.0.children(node) {
            Some(children) => children.iter().any(|(child, bounds)| {
                shaft.meets(bounds).is_some() && self.leads_on(*child, shaft)
            }),
            None => {
                let mut slots = self.0.slots(node);
                slots.any(|slot| self.0.all()[slot].met_by(shaft).is_some())
            }
        }
    }
}

/// A few rays of a pair of gridels, made when they are needed.
struct Samples<'p> {
    pair: &'p Pair,
    rays: OnceCell<[Shaft; SAMPLES]>,
}

impl<'p> Samples<'p> {
    fn of(pair: &'p Pair) -> Self {
        let rays = OnceCell::new();
        Self { pair, rays }
    }

    /// Returns the part of the rays that hit a box.
    fn chance(&self, bounds: &[[f64; 2]; 3]) -> f64 {
        let rays = self
            .rays
            .get_or_init(|| std::array::from_fn(|it| self.ray(it)));
        let met = rays.iter().filter(|ray| ray.meets(bounds).is_some());
        met.count() as f64 / SAMPLES as f64
    }

    fn ray(&self, number: usize) -> Shaft {
        // Four by four places of a gridel; those of the other are the same in another order.
        let place = |number: usize, sides: &[[f64; 2]; 3]| {
            let mut part = [number % 4, number / 4].into_iter().cycle();
            sides.map(|[low, high]| {
                if low == high {
                    return [low; 2];
                }
                let part = (part.next().unwrap_or(0) as f64 + 0.5) / 4.0;
                [low + part * (high - low); 2]
            })
        };
        let from = place(number, &self.pair.0[0]);
        let to = place((number * 7 + 3) % SAMPLES, &self.pair.0[1]);
        Shaft::between(from, to)
    }
}
