//! Builds the eight-wide hierarchy: clusters first, then a tree over them.
//!
//! Clusters are found in the mesh and among the spheres directly, not in the leaves of a tree. So
//! strips are long and packs full, and the tree is built over a fifth of the objects. The tree is
//! swept by the surface area heuristic on all three axes, and improved by reinsertion. Dynamic
//! programming then collapses it to eight children per node. All of it gives the same bytes with
//! any number of threads. Memory is linear: some 100 bytes per triangle.

mod collapse;
mod hull;
mod packs;
mod strips;
mod tree;

use super::CompileError;
use super::geometry::primitives::Primitives;
use super::hierarchy::node::Primitive;
use super::hierarchy::pairs::Flat;
use super::section::{Section, indices, section};
use clap::ValueEnum;
use collapse::Forests;
use gridel_core::Kind;
use gridel_core::format::cluster::{
    LANES, Pack16, Pack24, RADII, Rows16, Rows24, Strip16, Strip24, StripMembers, high_bytes,
};
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::format::record::WideNode;
use gridel_core::format::{Child, Leaf, SectionKind};
use hull::Hull;
use packs::Pack;
use strips::Strip;
use tree::{Tree, inverse};

/// The time that the builder takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Quality {
    /// No reinsertion.
    Fast,
    /// Three passes of reinsertion.
    #[default]
    Good,
    /// Reinsertion until it gains nothing more, but at most 24 passes.
    Best,
}

impl Quality {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Good, Self::Best];

    /// Returns its name, which the option `--quality` takes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Good => "good",
            Self::Best => "best",
        }
    }

    fn passes(self) -> usize {
        match self {
            Quality::Fast => 0,
            Quality::Good => 3,
            Quality::Best => 24,
        }
    }
}

/// The hierarchy of a scene.
#[derive(Debug, Default)]
pub struct Wide {
    nodes: Vec<WideNode>,
    /// In the order in which the nodes lead to them.
    strips: Vec<Strip>,
    packs: Vec<Pack>,
    /// The primitives that are in no cluster, in the order of their slots, kind by kind.
    pub slots: [Vec<u32>; Kind::ALL.len()],
    /// If other structures share the primitives: for each slot, its place in the hierarchy.
    locations: Vec<u32>,
    /// If other structures share the primitives: for each kind, the slot of each primitive.
    shared: Option<[Vec<u32>; Kind::ALL.len()]>,
    pub stack_depth: usize,
}

/// The items that the tree is built over.
enum Item {
    Strip(usize),
    Pack(usize),
    Single(Kind, u32),
}

impl Wide {
    /// Builds the hierarchy. `shared` are the slots of primitives that are in no cluster, where
    /// other structures share them.
    ///
    /// # Errors
    /// If the hierarchy is too deep for any stack.
    pub fn build(
        primitives: &Primitives,
        boxes: &[Primitive],
        quality: Quality,
        shared: Option<&Flat>,
    ) -> Result<Self, CompileError> {
        let of_kind = |kind: Kind| boxes.iter().filter(move |it| it.kind == kind).copied();
        let (strips, packs) = rayon::join(
            || strips::find(&primitives.vertices, &primitives.triangles),
            || packs::find(of_kind(Kind::Sphere).collect()),
        );
        let mut items: Vec<(Hull, Item)> = Vec::new();
        items.extend(
            (0..)
                .zip(&strips)
                .map(|(n, it)| (it.bounds, Item::Strip(n))),
        );
        items.extend((0..).zip(&packs).map(|(n, it)| (it.bounds, Item::Pack(n))));
        for kind in Kind::ALL.into_iter().filter(|kind| !kind.is_clustered()) {
            items.extend(of_kind(kind).map(|it| (it.bounds.into(), Item::Single(kind, it.index))));
        }
        let bounds: Vec<Hull> = items.iter().map(|item| item.0).collect();
        for balanced in [false, true] {
            let Some(mut tree) = Tree::build(&bounds, balanced) else {
                return Ok(Self::default());
            };
            let passes = if balanced { 0 } else { quality.passes() };
            for _ in 0..passes {
                if !tree.reinsert() {
                    break;
                }
            }
            let wide = Self::flatten(&tree, &items, (&strips, &packs), shared);
            if wide.stack_depth <= MAX_STACK_DEPTH {
                return Ok(wide);
            }
        }
        Err(CompileError::TooMany {
            what: "clusters",
            count: items.len(),
            most: 1 << 20,
        })
    }

    /// Numbers nodes and clusters breadth first.
    fn flatten(
        tree: &Tree,
        items: &[(Hull, Item)],
        (strips, packs): (&[Strip], &[Pack]),
        shared: Option<&Flat>,
    ) -> Self {
        let forests = Forests::of(tree);
        let mut wide = Self {
            shared: shared.map(|flat| flat.slots.each_ref().map(|slots| inverse(slots))),
            ..Self::default()
        };
        // Nodes of the tree that become wide ones, and how many children wait before them.
        let mut queue = vec![(tree.root, 0)];
        while let Some(&(node, before)) = queue.get(wide.nodes.len()) {
            let children = forests.children(tree, node);
            let waiting = before + children.len() - 1;
            wide.stack_depth = wide.stack_depth.max(waiting);
            let mut record = WideNode {
                planes: WideNode::EMPTY
                    .0
                    .map(|[low, high]| [[low; LANES], [high; LANES]]),
                children: [Child::NONE.0; LANES],
            };
            for (lane, &child) in children.iter().enumerate() {
                for (axis, [low, high]) in tree.bounds(child).0.into_iter().enumerate() {
                    record.planes[axis][0][lane] = low;
                    record.planes[axis][1][lane] = high;
                }
                let child = if tree.children(child).is_some() {
                    queue.push((child, waiting));
                    Child::node(queue.len() as u32 - 1)
                } else {
                    let item = &items[child as usize].1;
                    Child::leaf(wide.leaf(item, strips, packs))
                };
                record.children[lane] = child.0;
            }
            wide.nodes.push(record);
        }
        wide.packs
            .extend(packs.iter().find(|it| !it.is_full()).cloned());
        wide
    }

    fn leaf(&mut self, item: &Item, strips: &[Strip], packs: &[Pack]) -> Leaf {
        let cluster = |kind, number: usize| Leaf {
            kind,
            first: number as u32,
            count: 0,
        };
        match *item {
            Item::Strip(number) => {
                for (place, triangle) in strips[number].triangles.iter().enumerate() {
                    if let &Some(triangle) = triangle {
                        let location = self.strips.len() << 3 | place;
                        self.set_location(Kind::Triangle, triangle, location);
                    }
                }
                self.strips.push(strips[number].clone());
                cluster(Kind::Triangle, self.strips.len() - 1)
            }
            Item::Pack(number) => {
                let pack = &packs[number];
                // The one that is not full comes last.
                let number = if pack.is_full() {
                    self.packs.push(pack.clone());
                    self.packs.len() - 1
                } else {
                    packs.len() - 1
                };
                for (lane, &sphere) in pack.spheres.iter().enumerate() {
                    self.set_location(Kind::Sphere, sphere, number << 3 | lane);
                }
                cluster(Kind::Sphere, number)
            }
            Item::Single(kind, index) => {
                let slots = &mut self.slots[kind as usize];
                slots.push(index);
                let own = slots.len() as u32 - 1;
                let first = self.slot(kind, index).unwrap_or(own);
                self.set_location(kind, index, self.nodes.len());
                Leaf {
                    kind,
                    first,
                    count: 1,
                }
            }
        }
    }

    /// The slot of a primitive, where other structures share it.
    fn slot(&self, kind: Kind, index: u32) -> Option<u32> {
        let shared = self.shared.as_ref()?;
        Some(shared[kind as usize][index as usize])
    }

    fn set_location(&mut self, kind: Kind, index: u32, location: usize) {
        let (Some(shared), Some(slot)) = (&self.shared, self.slot(kind, index)) else {
            return;
        };
        let before = shared[..kind as usize].iter().map(Vec::len);
        let place = before.sum::<usize>() + slot as usize;
        let all = shared.iter().map(Vec::len).sum();
        self.locations.resize(all, 0);
        self.locations[place] = location as u32;
    }

    /// Primitives of the fullest cluster or leaf.
    pub fn longest_list(&self) -> usize {
        let strips = self
            .strips
            .iter()
            .map(|it| it.triangles.iter().flatten().count());
        let packs = self.packs.iter().map(|it| it.spheres.len());
        let singles = usize::from(self.slots.iter().any(|slots| !slots.is_empty()));
        strips.chain(packs).max().unwrap_or(0).max(singles)
    }

    /// Returns the hierarchy's sections in a blob.
    pub fn sections(&self, primitives: &Primitives, lattice_bits: u8) -> Vec<Section> {
        let (strips, packs) = (self.strip_rows(primitives), self.pack_rows(primitives));
        let (strips, packs, radii) = if lattice_bits <= 16 {
            let strips: Vec<_> = strips
                .map(|(points, members)| Strip16 {
                    rows: rows_16(&points),
                    members,
                })
                .collect();
            let packs: Vec<_> = packs
                .map(|(points, radii)| Pack16 {
                    rows: rows_16(&points),
                    radii: radii.map(|radius| (radius >> 8) as u16),
                })
                .collect();
            (
                section(SectionKind::Strips, &strips),
                section(SectionKind::Packs, &packs),
                Vec::new(),
            )
        } else {
            let strips: Vec<_> = strips
                .map(|(points, members)| Strip24 {
                    rows: rows_24(&points),
                    members,
                })
                .collect();
            let (points, radii): (Vec<_>, Vec<_>) = packs.unzip();
            let (numbers, radii) = windows(&radii);
            let packs: Vec<_> = points
                .iter()
                .zip(numbers)
                .map(|(points, radii)| Pack24 {
                    rows: rows_24(points),
                    radii,
                })
                .collect();
            (
                section(SectionKind::Strips, &strips),
                section(SectionKind::Packs, &packs),
                radii,
            )
        };
        let number = |kind: Kind, index: u32| {
            let slot = self.slot(kind, index);
            slot.unwrap_or_else(|| primitives.numbers[kind as usize][index as usize])
        };
        let triangles = self
            .strips
            .iter()
            .flat_map(|strip| &strip.triangles)
            .flatten();
        let spheres = self.packs.iter().flat_map(|pack| &pack.spheres);
        let members: Vec<u32> = triangles
            .map(|&index| number(Kind::Triangle, index))
            .chain(spheres.map(|&index| number(Kind::Sphere, index)))
            .collect();
        vec![
            section(SectionKind::WideNodes, &self.nodes),
            strips,
            packs,
            indices(SectionKind::Members, &members, 2),
            section(SectionKind::SlotLocations, &self.locations),
            section(SectionKind::Radii, &radii),
        ]
    }

    /// Vertices and members of every strip; lanes that are not needed repeat the last vertex.
    fn strip_rows(
        &self,
        primitives: &Primitives,
    ) -> impl Iterator<Item = ([[i32; 3]; LANES], StripMembers)> {
        self.strips.iter().scan(0, |first, strip| {
            let members = StripMembers::new(*first, strip.arrangements(&primitives.triangles));
            *first += members.count();
            let points = lanes(&strip.vertices).map(|it| primitives.vertices[it as usize]);
            Some((points, members))
        })
    }

    /// Centers and radii of every pack; lanes that are not needed repeat the last center, with no
    /// radius.
    fn pack_rows(
        &self,
        primitives: &Primitives,
    ) -> impl Iterator<Item = ([[i32; 3]; LANES], [i32; LANES])> {
        self.packs.iter().map(|pack| {
            let spheres = lanes(&pack.spheres).map(|it| primitives.records.spheres[it as usize]);
            let mut radii = spheres.map(|it| it.radius);
            radii[pack.spheres.len()..].fill(0);
            (spheres.map(|it| it.center), radii)
        })
    }
}

/// Returns the numbers of the radii of every pack, four bits each, and the windows that they index.
/// There is one window for all packs if it holds all radii. Otherwise each pack has its own, which
/// overlaps the next.
fn windows(packs: &[[i32; LANES]]) -> (Vec<[u8; LANES / 2]>, Vec<i32>) {
    let mut distinct: Vec<i32> = packs.iter().flatten().copied().collect();
    distinct.sort_unstable();
    distinct.dedup();
    let is_shared = distinct.len() <= RADII;
    let radii = match packs.len() {
        0 => Vec::new(),
        _ if is_shared => {
            distinct.resize(RADII, 0);
            distinct.clone()
        }
        _ => packs
            .iter()
            .chain([&[0; LANES]])
            .flatten()
            .copied()
            .collect(),
    };
    let numbers = |pack: &[i32; LANES]| {
        let number = |lane: usize| {
            let shared = || distinct.iter().position(|&it| it == pack[lane]);
            is_shared.then(shared).flatten().unwrap_or(lane) as u8
        };
        std::array::from_fn(|pair| number(2 * pair) | number(2 * pair + 1) << 4)
    };
    (packs.iter().map(numbers).collect(), radii)
}

/// Up to eight values, the last repeated.
fn lanes(values: &[u32]) -> [u32; LANES] {
    std::array::from_fn(|lane| values[lane.min(values.len() - 1)])
}

fn rows_16(points: &[[i32; 3]; LANES]) -> Rows16 {
    Rows16([0, 1, 2].map(|axis: usize| points.map(|point| (point[axis] >> 8) as i16)))
}

fn rows_24(points: &[[i32; 3]; LANES]) -> Rows24 {
    Rows24 {
        low: [0, 1, 2].map(|axis: usize| points.map(|point| point[axis] as u16)),
        high: [0, 1, 2]
            .map(|axis: usize| high_bytes(points.map(|point| (point[axis] >> 16) as u8))),
    }
}
