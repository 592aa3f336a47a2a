//! Builds the regular grid, and chooses its divisions.

use super::estimate::{Rays, ordinary_tests};
use super::{Cells, MOST_BYTES, Range, longest, volume};
use crate::compile::CompileError;
use crate::compile::section::{indices, section};
use gridel_core::Structure;
use gridel_core::format::SectionKind;
use gridel_core::format::record::{GridShape, UnitBox};
use gridel_core::shared::{Divisions, MARGIN, cells_of, divide};

/// Cells that a grid has per primitive by default.
const CELLS_PER_PRIMITIVE: f64 = 4.0;

/// Returns divisions of a grid's axes: `cells` cells in all, as nearly cubes as possible.
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

/// Returns divisions with which rays test fewer primitives than with `counts`, if that is more than in ordinary scenes.
/// Halves or doubles axes as long as that saves tests.
///
/// Long primitives lie in many cells one behind the other, and a ray tests them in each.
fn best_divisions(bounds: &UnitBox, boxes: &[UnitBox], mut counts: [u32; 3]) -> [u32; 3] {
    let rays = Rays::new(boxes, bounds, 0.0);
    let tests = |counts: [u32; 3]| {
        let axes = divide(bounds, counts);
        let ranges = boxes.iter().map(|bounds| cells_of(&axes, bounds, MARGIN));
        let entries: u64 = ranges.map(|range| volume(&range)).sum();
        entries as f64 * rays.share(counts)
    };
    let mut least = tests(counts);
    if least <= ordinary_tests(boxes.len()) {
        return counts;
    }
    loop {
        let change = |axis: usize, how: u32| match how {
            _ if bounds.0[axis][0] == bounds.0[axis][1] => 1,
            0 => counts[axis].div_ceil(2),
            1 => counts[axis],
            _ => (2 * counts[axis]).min(Divisions::MOST),
        };
        let trials = (0..27).map(|trial| {
            let counts = [
                change(0, trial % 3),
                change(1, trial / 3 % 3),
                change(2, trial / 9),
            ];
            (tests(counts), counts)
        });
        match trials.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((tests, changed)) if tests < least => (least, counts) = (tests, changed),
            _ => return counts,
        }
    }
}

/// Builds a grid with the given divisions, or with the usual number of cells. There are fewer where these would exceed
/// [`MOST_BYTES`], or where rays would test the same primitives too often.
///
/// # Errors
/// If the given divisions exceed it.
pub fn build(
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
        if divisions.is_none() {
            counts = best_divisions(bounds, boxes, counts);
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
