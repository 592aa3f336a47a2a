//! A window: the cells on a face of an apex, and their lists.

use super::super::bundle::{Bundle, Ranges};
use super::super::lists::List;
use super::super::target::Target;
use super::face::{Face, Seen};
use glam::DVec3;
use gridel_core::accel::Apex;
use gridel_core::format::record::ApexWindow;
use rayon::prelude::*;

/// Ratio by which the next try is finer.
const FINER: f64 = 1.4;
/// The part of a list that remains after the next try where it saves next to nothing. Lists are then about a seventh
/// longer than for single rays.
const SATURATED: f64 = 0.96;
/// Lists by which those of a window are estimated.
const SAMPLES: u64 = 1024;
/// 2^32 divided by the golden ratio: its multiples are spread evenly.
const GOLDEN: u32 = 0x9e37_79b9;

/// Returns the size of cells with which an apex takes at most `bytes`, estimated from samples; `None` if no size does.
pub(super) fn cell_size(faces: &[Face], targets: &[Target], bytes: f64) -> Option<f64> {
    let entry = if targets.len() < 256 { 2.0 } else { 3.0 };
    // Entries of the lists, and all bytes: a list for each cell, its number and its first entry.
    let taken = |size: f64| {
        let windows = faces.iter().map(|face| Window::new(targets, face, size, 0));
        let (cells, entries) = windows
            .map(|window| (f64::from(window.end()), window.entries()))
            .fold((0.0, 0.0), |all, one| (all.0 + one.0, all.1 + one.1));
        (entries, cells * 6.0 + entries * entry)
    };
    let sides = faces.iter().flat_map(|face| face.window);
    let widest = sides.map(|[low, high]| high - low).fold(0.0, f64::max);
    if widest < f64::MIN_POSITIVE {
        // No target is visible, so no size is small enough.
        return None;
    }
    let mut size = widest;
    let (mut now, all) = taken(size);
    if all > bytes {
        return None;
    }
    while size > widest / f64::from(Apex::MOST_CELLS) {
        let finer = size / FINER;
        let (more, all) = taken(finer);
        // Where lists hardly get shorter, finer cells only add lists.
        if all > bytes || more > SATURATED * FINER * FINER * now {
            break;
        }
        (size, now) = (finer, more);
    }
    Some(size)
}

/// A window with the targets that are visible through each of its columns.
pub(super) struct Window<'t> {
    pub(super) record: ApexWindow,
    bundle: Bundle,
    targets: &'t [Target],
    /// All targets visible through it, the nearest first.
    seen: Vec<Seen>,
    /// For each column the targets visible through it, by their places.
    columns: Vec<Vec<u32>>,
    /// The farthest that anything lies along the axis.
    last: f64,
}

impl<'t> Window<'t> {
    pub(super) fn new(targets: &'t [Target], face: &Face, size: f64, first_cell: u32) -> Self {
        let Face {
            bundle,
            window: ranges,
            seen,
        } = face;
        let (cells, one) = (face.cells(size), bundle.one());
        let low = ranges.map(|[low, _]| (low * one).floor());
        let scale = [0, 1].map(|side| {
            // Cells cover the window and at least one step each.
            let width = (ranges[side][1] * one).ceil() - low[side] + 1.0;
            let steps = width.max(f64::from(cells[side]) + 1.0);
            (f64::from(cells[side]) * 4_294_967_296.0 / steps).min(f64::from(u32::MAX)) as u32
        });
        let record = ApexWindow {
            low: low.map(|x| x as i32),
            scale,
            cells: cells.map(|cells| cells as u16),
            first_cell,
            start: 0,
            levels_per_step: 0,
        };
        let mut window = Self {
            record,
            bundle: *bundle,
            targets,
            seen: Vec::new(),
            columns: vec![Vec::new(); cells[0] as usize],
            last: 0.0,
        };
        // The scale is rounded down, so the last cells reach beyond the face's window: all that is seen through them
        // counts.
        let sides = [0, 1].map(|side| {
            let last = window.range(side, cells[side] - 1);
            [window.range(side, 0)[0], last[1]]
        });
        let seen = seen.iter().filter(|it| it.is_within(sides)).copied();
        window.seen = seen.collect();
        window.count_depths();
        let edges: Vec<[f64; 2]> = (0..cells[0])
            .map(|column| window.range(0, column))
            .collect();
        for (place, one) in window.seen.iter().enumerate() {
            let across = one.ranges[0];
            let first = edges.partition_point(|&[_, end]| end < across[0]);
            for (column, edge) in window.columns.iter_mut().zip(&edges).skip(first) {
                if edge[0] > across[1] {
                    break;
                }
                column.push(place as u32);
            }
        }
        window
    }

    /// Counts levels from where the first target begins to where the last one ends.
    fn count_depths(&mut self) {
        let depths = self.seen.iter().map(|it| it.depths);
        let [start, last] = depths.fold([f64::INFINITY, 0.0], |[start, last], one| {
            [start.min(one[0]), last.max(one[1])]
        });
        self.last = last;
        self.record.start = (2.0 * start).floor() as i32;
        let steps = ((2.0 * last).ceil() as u32).saturating_sub(self.record.start as u32);
        self.record.levels_per_step = (u32::from(Apex::LAST_LEVEL) << 24) / steps.max(1);
    }

    /// The number of the cell behind the window's last.
    pub(super) fn end(&self) -> u32 {
        let [columns, rows] = self.record.cells.map(u32::from);
        self.record.first_cell + columns * rows
    }

    /// The rays of a column or row, widened by the rounding of a ray's.
    fn range(&self, side: usize, place: u32) -> [f64; 2] {
        let [low, high] = self.record.extent(side, place);
        [low as f64 - 1.0, high as f64 + 1.0].map(|end| end / self.bundle.one())
    }

    /// About how many entries the lists have, by some of them.
    fn entries(&self) -> f64 {
        let cells = u64::from(self.end() - self.record.first_cell);
        let samples = cells.min(SAMPLES);
        let entries = (0..samples).into_par_iter().map(|sample| {
            // All of them, or some that are spread evenly.
            let cell = match cells <= SAMPLES {
                true => sample,
                false => (u64::from((sample as u32).wrapping_mul(GOLDEN)) * cells) >> 32,
            };
            let mut list = List::new();
            self.list(self.record.first_cell + cell as u32, &mut list);
            list.len()
        });
        entries.sum::<usize>() as f64 * cells as f64 / samples as f64
    }

    /// Fills the list of a cell, sorted by where its targets can begin, up to where hardly any ray
    /// gets.
    pub(super) fn list(&self, cell: u32, list: &mut List) {
        let cell = cell - self.record.first_cell;
        let rows = u32::from(self.record.cells[1]);
        let (column, row) = (cell / rows, cell % rows);
        let ranges = [self.range(0, column), self.range(1, row)];
        let shaft = self.bundle.shaft(ranges, self.last);
        let mut sight = Sight::new(&self.bundle, ranges);
        let mut met: Vec<(f64, u32)> = Vec::new();
        // The least depth of the omitted candidates.
        let mut cut = f64::INFINITY;
        for &place in &self.columns[column as usize] {
            let one = &self.seen[place as usize];
            if one.depths[0] > sight.end {
                cut = one.depths[0];
                break;
            }
            let [first, last] = one.ranges[1];
            let target = &self.targets[one.slot as usize];
            if first <= ranges[1][1]
                && last >= ranges[1][0]
                && let Some([from, _]) = target.met_by(&shaft)
            {
                met.push((from, one.slot));
                sight.meet(target);
            }
        }
        met.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let kept = met.partition_point(|&(from, _)| from <= sight.end);
        if let Some(&(from, _)) = met.get(kept) {
            cut = cut.min(from);
        }
        met.truncate(kept);
        if cut.is_finite() {
            met.push((cut, self.targets.len() as u32));
        }
        list.extend(met.iter().map(|&(from, slot)| {
            // Half units, rounded down by more than arithmetic can be off.
            let step = (2.0 * from - 1e-3).floor();
            (slot, self.record.level(step as i32))
        }));
    }
}

/// The depths that some rays of a cell reach.
struct Sight {
    /// The origin of each, its direction, and the depth of its hit.
    rays: [(DVec3, DVec3, f64); 16],
    /// The greatest of these depths.
    end: f64,
}

impl Sight {
    fn new(bundle: &Bundle, ranges: Ranges) -> Self {
        // From side to side, four by four.
        let part = |side: usize, step: usize| {
            let [low, high] = ranges[side];
            low + (high - low) * step as f64 / 3.0
        };
        Self {
            rays: std::array::from_fn(|number| {
                let (from, way) = bundle.ray([part(0, number % 4), part(1, number / 4)]);
                (from, way, f64::INFINITY)
            }),
            end: f64::INFINITY,
        }
    }

    /// Records a target in the way of the rays.
    fn meet(&mut self, target: &Target) {
        for (from, way, met) in &mut self.rays {
            if let Some(depth) = target.entered_by(*from, *way) {
                *met = met.min(depth);
            }
        }
        let depths = self.rays.iter().map(|&(_, _, met)| met);
        self.end = depths.fold(0.0, f64::max);
    }
}
