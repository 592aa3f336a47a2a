//! Builds the regular grid and the octree: which primitives reach into which cells.

use super::CompileError;
use super::pairs::Flat;
use super::writer::{Section, indices, section};
use gridel_core::Structure;
use gridel_core::accel::cells::{Divisions, cells_of, divide};
use gridel_core::accel::grid::MARGIN;
use gridel_core::accel::octree::{MOST_LEVELS, OctreeNode};
use gridel_core::blob::SectionKind;
use gridel_core::blob::record::{GridShape, UnitBox};

/// Most bytes that a grid or an octree may take while it is built, its part of the blob included.
const MOST_BYTES: u64 = 256 << 20;
/// Cells that a grid has for each primitive, where no other number is asked for.
const CELLS_PER_PRIMITIVE: f64 = 4.0;
/// Primitives in a cell of an octree that are not worth a split.
const FEW: usize = 6;

/// A grid or an octree as a blob holds it.
#[derive(Debug, Default)]
pub struct Cells {
    pub sections: Vec<Section>,
    /// Entries that a walk's stack must hold.
    pub stack_depth: usize,
    /// Primitives of the fullest cell.
    pub longest_list: usize,
}

/// The longest of the lists that begin where one's start is and end where the next one begins.
fn longest(starts: &[u32]) -> usize {
    let lengths = starts.windows(2).map(|pair| pair[1] - pair[0]);
    lengths.max().unwrap_or(0) as usize
}

/// Divisions of a grid's axes: cells as nearly cubes as can be, so many in all.
fn usual_divisions(bounds: &UnitBox, cells: f64) -> [u32; 3] {
    let extents = bounds
        .0
        .map(|[low, high]| f64::from(i32::from(high) - i32::from(low)));
    // Axes without extent take no part.
    let wide = extents.iter().filter(|&&extent| extent > 0.0);
    let (dimensions, volume) = wide.fold((0, 1.0), |(n, volume), &extent| (n + 1, volume * extent));
    let a_unit = libm::pow(cells / volume, 1.0 / f64::from(dimensions.max(1)));
    extents.map(|extent| {
        (extent * a_unit)
            .round()
            .clamp(1.0, f64::from(Divisions::MOST)) as u32
    })
}

/// The boxes of the primitives in the order of their slots.
pub fn slot_boxes(flat: &Flat, boxes: &[super::hierarchy::Primitive]) -> Vec<UnitBox> {
    let mut of_kind = [const { Vec::new() }; 5];
    for primitive in boxes {
        let known: &mut Vec<UnitBox> = &mut of_kind[primitive.kind as usize];
        let place = primitive.index as usize;
        if known.len() <= place {
            known.resize(place + 1, primitive.bounds);
        }
        known[place] = primitive.bounds;
    }
    let slots = flat.slots.iter().zip(&of_kind);
    slots
        .flat_map(|(slots, boxes)| slots.iter().map(|&index| boxes[index as usize]))
        .collect()
}

/// Builds a grid, with as many divisions as are asked for or as many cells as are usual; with fewer
/// where these would exceed [`MOST_BYTES`].
///
/// # Errors
/// If the divisions that are asked for exceed it.
pub fn grid(
    bounds: &UnitBox,
    boxes: &[UnitBox],
    divisions: Option<[u32; 3]>,
) -> Result<Cells, CompileError> {
    if boxes.is_empty() {
        return Ok(Cells::default());
    }
    let mut usual = CELLS_PER_PRIMITIVE * boxes.len() as f64;
    loop {
        let mut counts = divisions.unwrap_or_else(|| usual_divisions(bounds, usual));
        for (count, [low, high]) in counts.iter_mut().zip(bounds.0) {
            *count = if low == high {
                1
            } else {
                (*count).clamp(1, Divisions::MOST)
            };
        }
        let axes = divide(bounds, counts);
        let ranges = || boxes.iter().map(|bounds| cells_of(&axes, bounds, MARGIN));
        let entries: u64 = ranges().map(|range| volume(&range)).sum();
        let cells: u64 = counts.iter().map(|&count| u64::from(count)).product();
        // Starts twice while cells are filled, and slots; then both once more in the blob.
        let needed = 12 * cells + 8 * entries;
        if needed <= MOST_BYTES {
            return Ok(fill(counts, entries, ranges));
        }
        if divisions.is_some() || cells == 1 {
            let [x, y, z] = counts;
            return Err(CompileError::OverBudget {
                structure: Structure::Grid.name(),
                size: format!(" with {x} by {y} by {z} cells"),
                needed,
                at_least: "",
                budget: MOST_BYTES,
                remedy: "ask for fewer cells with `--grid`, or leave it out",
            });
        }
        usual /= 2.0;
    }
}

/// Lists in each cell of a grid the primitives that reach into it.
fn fill<R: Iterator<Item = Range>>(
    counts: [u32; 3],
    entries: u64,
    ranges: impl Fn() -> R,
) -> Cells {
    let [x, y, z] = counts.map(|count| count as usize);
    let cells = x * y * z;
    let number = |[x0, y0, z0]: [u32; 3]| (z0 as usize * y + y0 as usize) * x + x0 as usize;
    let mut starts = vec![0_u32; cells + 1];
    for range in ranges() {
        for_each(&range, |cell| starts[number(cell) + 1] += 1);
    }
    for cell in 0..cells {
        starts[cell + 1] += starts[cell];
    }
    let mut next = starts.clone();
    let mut slots = vec![0; entries as usize];
    for (slot, range) in ranges().enumerate() {
        for_each(&range, |cell| {
            let place = &mut next[number(cell)];
            slots[*place as usize] = slot as u32;
            *place += 1;
        });
    }
    let shape = GridShape {
        divisions: counts.map(|count| count as u16),
        spare: 0,
    };
    Cells {
        sections: vec![
            section(SectionKind::GridShape, &[shape]),
            indices(SectionKind::GridStarts, &starts, 1),
            indices(SectionKind::GridSlots, &slots, 1),
        ],
        stack_depth: 0,
        longest_list: longest(&starts),
    }
}

/// Most bytes that are needed for each entry of an octree's finest cells while it is built: an inner
/// node has more than [`FEW`] entries, so that there is hardly a child more than there are entries in
/// its level, and arrays that grow may be twice as long as they are full.
const OCTREE_ENTRY_BYTES: u64 = 192;

/// Builds an octree.
///
/// # Errors
/// If not even an octree of one cell keeps to [`MOST_BYTES`].
pub fn octree(bounds: &UnitBox, boxes: &[UnitBox]) -> Result<Cells, CompileError> {
    // Twice as fine as an octree of even leaves, and no finer than memory allows.
    let mut levels = MOST_LEVELS.min((boxes.len().max(1).ilog2() / 3) + 2);
    loop {
        let axes = divide(bounds, [1 << levels; 3]);
        let ranges: Vec<_> = boxes
            .iter()
            .map(|bounds| cells_of(&axes, bounds, 0))
            .collect();
        let entries: u64 = ranges.iter().map(volume).sum();
        let needed = size_of_val(&ranges[..]) as u64 + OCTREE_ENTRY_BYTES * entries;
        if needed > MOST_BYTES {
            if levels > 0 {
                levels -= 1;
                continue;
            }
            return Err(CompileError::OverBudget {
                structure: Structure::Octree.name(),
                size: String::new(),
                needed,
                at_least: "at least ",
                budget: MOST_BYTES,
                remedy: "ask for another structure",
            });
        }
        let octree = Nodes::build(&ranges, levels);
        // The planes depend on the number of levels, so the deepest leaf decides it.
        if octree.levels < levels {
            levels = octree.levels;
            continue;
        }
        return Ok(Cells {
            sections: octree.sections(),
            stack_depth: 7 * levels as usize + usize::from(levels > 0),
            longest_list: longest(&octree.starts),
        });
    }
}

/// Cells along each axis, the first and the last.
type Range = [[u32; 2]; 3];

fn volume(range: &Range) -> u64 {
    range
        .iter()
        .map(|[first, last]| u64::from(last - first) + 1)
        .product()
}

fn for_each(range: &Range, mut cell: impl FnMut([u32; 3])) {
    let [[x0, x1], [y0, y1], [z0, z1]] = *range;
    for z in z0..=z1 {
        for y in y0..=y1 {
            for x in x0..=x1 {
                cell([x, y, z]);
            }
        }
    }
}

/// An octree, level by level.
#[derive(Default)]
struct Nodes {
    nodes: Vec<u32>,
    starts: Vec<u32>,
    slots: Vec<u32>,
    levels: u32,
}

impl Nodes {
    /// Builds an octree of at most so many levels over primitives that reach into ranges of the
    /// finest cells.
    fn build(ranges: &[Range], most_levels: u32) -> Self {
        let mut octree = Self::default();
        octree.starts.push(0);
        if ranges.is_empty() {
            return octree;
        }
        let all: Vec<u32> = (0..ranges.len() as u32).collect();
        let mut level = vec![([0; 3], all)];
        let mut size = 1 << most_levels;
        while !level.is_empty() {
            let mut below = Vec::new();
            let next_level = octree.nodes.len() + level.len();
            for (corner, slots) in level {
                octree.nodes.push(if slots.is_empty() {
                    OctreeNode::EMPTY.0
                } else if slots.len() <= FEW || size == 1 {
                    octree.slots.extend(&slots);
                    octree.starts.push(octree.slots.len() as u32);
                    OctreeNode::leaf(octree.starts.len() as u32 - 2).0
                } else {
                    let first = next_level + below.len();
                    below.extend(split(corner, size / 2, &slots, ranges));
                    first as u32
                });
            }
            octree.levels += u32::from(!below.is_empty());
            level = below;
            size /= 2;
        }
        octree
    }

    fn sections(&self) -> Vec<Section> {
        let some = !self.nodes.is_empty();
        let starts = if some { &self.starts[..] } else { &[] };
        vec![
            section(SectionKind::OctreeNodes, &self.nodes),
            indices(SectionKind::OctreeStarts, starts, 1),
            indices(SectionKind::OctreeSlots, &self.slots, 1),
        ]
    }
}

/// The eight children of a node: their corners, and what reaches into them.
fn split(
    corner: [u32; 3],
    half: u32,
    slots: &[u32],
    ranges: &[Range],
) -> [([u32; 3], Vec<u32>); 8] {
    std::array::from_fn(|sides| {
        let corner = [0, 1, 2].map(|axis: usize| corner[axis] + half * (sides as u32 >> axis & 1));
        let reaches = |slot: &&u32| {
            let range = &ranges[**slot as usize];
            let sides = range.iter().zip(corner);
            sides
                .into_iter()
                .all(|([first, last], corner)| *first < corner + half && *last >= corner)
        };
        (corner, slots.iter().filter(reaches).copied().collect())
    })
}
