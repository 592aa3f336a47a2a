//! Builds the lists for the rays of the camera's eye and of each light.

use super::budget::Budget;
use super::bundle::{Bundle, Ranges, Rays};
use super::lists::{List, Lists, Plan};
use super::target::{Target, Targets};
use glam::DVec3;
use gridel_core::accel::Apex;
use gridel_core::format::record::{
    ApexDirection, ApexPoint, ApexWindow, Gridels, Light, UnitBox, View,
};
use rayon::prelude::*;

/// Everything that the structure keeps.
#[derive(Debug)]
pub struct Apexes {
    pub points: Vec<ApexPoint>,
    pub directions: Vec<ApexDirection>,
    pub windows: Vec<ApexWindow>,
    pub lists: Lists,
}

/// Apexes that a blob has room for: more lights than these are left to the hierarchy.
const MOST_POINTS: usize = 64;
/// How much finer the next try is.
const FINER: f64 = 1.4;
/// How much of a list is left by the next try where it saves next to nothing: lists are then about a
/// seventh longer than for single rays.
const SATURATED: f64 = 0.96;
/// How much less the next try takes, where lists exceed the budget.
const COARSER: f64 = 0.85;
/// Lists by which those of a window are estimated.
const SAMPLES: u64 = 1024;
/// 2^32 divided by the golden ratio: its multiples are spread evenly.
const GOLDEN: u32 = 0x9e37_79b9;
/// How much wider than the picture the camera's window is.
const WIDER: f64 = 1.02;

/// A face of a cube of directions, and what is seen through it.
struct Face {
    bundle: Bundle,
    /// What a window there must hold.
    window: Ranges,
    /// The targets that are seen, the nearest first.
    seen: Vec<Seen>,
}

/// A target that is seen.
#[derive(Clone, Copy)]
struct Seen {
    slot: u32,
    /// The depth at which its box begins, and where it ends.
    depths: [f64; 2],
    /// The rays that can meet it.
    ranges: Ranges,
}

/// Builds the lists of all apexes, which together take at most the budget of each.
pub fn build(targets: &Targets<'_>, view: &View, lights: &[Light], budget: Budget<'_>) -> Apexes {
    // Sizes are chosen by an estimate. Where it falls short, cells are made coarser.
    let mut share = budget.bytes as f64;
    loop {
        let (mut apexes, windows) = windows(targets, view, lights, share);
        let count = apexes.points.len() + apexes.directions.len();
        let cells = windows.last().map_or(0, Window::end);
        let plan = Plan {
            cells: cells.into(),
            end: targets.all().len() as u32 + 1,
            keyed: true,
            list: &|cell, list| {
                let window = windows.partition_point(|window| u64::from(window.end()) <= cell);
                windows[window].list(cell as u32, list);
            },
        };
        let counted = plan.count(budget.tell);
        if count > 0 && counted.figures().bytes > budget.bytes * count as u64 {
            share *= COARSER;
            continue;
        }
        apexes.lists = plan.build(counted);
        apexes.windows = windows.iter().map(|window| window.record).collect();
        return apexes;
    }
}

/// The apexes, and the windows of each within its share of bytes.
fn windows<'t>(
    targets: &'t Targets<'_>,
    view: &View,
    lights: &[Light],
    share: f64,
) -> (Apexes, Vec<Window<'t>>) {
    let mut apexes = Apexes {
        points: Vec::new(),
        directions: Vec::new(),
        windows: Vec::new(),
        lists: Lists::default(),
    };
    let mut windows: Vec<Window<'_>> = Vec::new();
    let mut add = |faces: Vec<Face>| -> Option<Vec<(usize, u16)>> {
        let size = cell_size(&faces, targets.all(), share)?;
        let numbers = faces.iter().map(|face| {
            let direction = 2 * face.bundle.axis + usize::from(face.bundle.up);
            let number = windows.len() as u16;
            let first_cell = windows.last().map_or(0, Window::end);
            windows.push(Window::new(targets.all(), face, size, first_cell));
            (direction, number)
        });
        Some(numbers.collect())
    };
    let eye = std::iter::once((view.eye, Some(view)));
    let point_lights = lights.iter().filter(|light| light.directional == 0);
    for (place, seen_by) in eye.chain(point_lights.map(|light| (light.vector, None))) {
        let Some(at) = within_reach(place) else {
            continue;
        };
        if apexes.points.len() == MOST_POINTS || apexes.points.iter().any(|point| point.at == at) {
            continue;
        }
        let faces = (0..6).filter_map(|face| Face::of_point(targets.all(), at, face, seen_by));
        let Some(numbers) = add(faces.collect()) else {
            continue;
        };
        let mut point = ApexPoint {
            at,
            windows: [Apex::NO_WINDOW; 6],
        };
        for (face, number) in numbers {
            point.windows[face] = number;
        }
        apexes.points.push(point);
    }
    for light in lights.iter().filter(|light| light.directional == 1) {
        let Some(direction) = direction_of(light, &targets.bounds) else {
            continue;
        };
        let known = |other: &ApexDirection| other.slope == direction.slope;
        if apexes.directions.len() == MOST_POINTS || apexes.directions.iter().any(known) {
            continue;
        }
        let face = Face::of_direction(targets.all(), &direction);
        if let Some(&[(_, window)]) = face.and_then(|face| add(vec![face])).as_deref() {
            apexes.directions.push(ApexDirection {
                window,
                ..direction
            });
        }
    }
    (apexes, windows)
}

/// A point in 1/256 unit, unless it lies too far away.
fn within_reach(q13: [i64; 3]) -> Option<[i32; 3]> {
    let most = (Apex::FARTHEST * 256.0) as i64;
    let q8 = q13.map(|x| (x + 16) >> 5);
    q8.iter()
        .all(|x| x.abs() <= most)
        .then(|| q8.map(|x| x as i32))
}

/// The direction in which rays run to a light; `None` for none.
fn direction_of(light: &Light, bounds: &UnitBox) -> Option<ApexDirection> {
    let magnitudes = light.vector.map(i64::unsigned_abs);
    let most = *magnitudes.iter().max()?;
    // Of equal ones the first, as rays choose.
    let major = magnitudes.iter().position(|&it| it == most && most > 0)?;
    let slope = light
        .vector
        .map(|part| (part as f64 / most as f64 * ONE).round() as i32);
    let [low, high] = bounds.0[major].map(i32::from);
    let plane = if slope[major] > 0 {
        high + Gridels::MARGIN
    } else {
        low - Gridels::MARGIN
    };
    Some(ApexDirection {
        slope,
        plane: plane << 8,
        major: major as u16,
        window: Apex::NO_WINDOW,
    })
}

impl Face {
    /// What is seen from a point through a face; `None` for nothing.
    fn of_point(
        targets: &[Target],
        at: [i32; 3],
        face: usize,
        view: Option<&View>,
    ) -> Option<Self> {
        let (axis, up) = (face / 2, face % 2 == 1);
        let picture = match view {
            Some(view) => Some(picture_window(view, axis, up)?),
            None => None,
        };
        let apex = at.map(|q8| f64::from(q8) / 256.0);
        let bundle = Bundle {
            axis,
            up,
            start: apex[axis],
            rays: Rays::Through(Gridels::across(axis).map(|across| apex[across])),
        };
        let face = Self::of(bundle, targets, picture.unwrap_or([[-1.0, 1.0]; 2]))?;
        // All of the picture, so that rays that meet nothing find an empty list.
        let window = picture.unwrap_or(face.window);
        Some(Self { window, ..face })
    }

    /// What is seen from a direction.
    fn of_direction(targets: &[Target], direction: &ApexDirection) -> Option<Self> {
        let axis = usize::from(direction.major);
        let up = direction.slope[axis] < 0;
        // Away from the plane, so the other way round.
        let slope = |across: usize| -f64::from(direction.slope[across]) / ONE;
        let bundle = Bundle {
            axis,
            up,
            start: f64::from(direction.plane) / 256.0,
            rays: Rays::Along(Gridels::across(axis).map(slope)),
        };
        Self::of(bundle, targets, [[f64::NEG_INFINITY, f64::INFINITY]; 2])
    }

    /// What is seen by rays within limits.
    fn of(bundle: Bundle, targets: &[Target], limits: Ranges) -> Option<Self> {
        let mut window = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut seen = Vec::new();
        for (slot, target) in targets.iter().enumerate() {
            let Some(ranges) = bundle.ranges_to(target) else {
                continue;
            };
            let inside = [0, 1].map(|side| {
                let ([low, high], [least, most]) = (ranges[side], limits[side]);
                [low.max(least), high.min(most)]
            });
            if inside.iter().all(|[low, high]| low <= high) {
                for (all, one) in window.iter_mut().zip(inside) {
                    *all = [all[0].min(one[0]), all[1].max(one[1])];
                }
                seen.push(Seen {
                    slot: slot as u32,
                    depths: bundle.depths(target.bounds()),
                    ranges: inside,
                });
            }
        }
        seen.sort_by(|a: &Seen, b| a.depths[0].total_cmp(&b.depths[0]));
        (!seen.is_empty()).then_some(Self {
            bundle,
            window,
            seen,
        })
    }

    /// Cells along each side for cells of a size.
    fn cells(&self, size: f64) -> [u32; 2] {
        self.window.map(|[low, high]| {
            let cells = ((high - low) / size).ceil();
            cells.clamp(1.0, Apex::MOST_CELLS.into()) as u32
        })
    }
}

/// The slopes of a picture's directions on a face; `None` where it has none there.
fn picture_window(view: &View, axis: usize, up: bool) -> Option<Ranges> {
    let vector = |v: [i32; 3]| DVec3::from_array(v.map(f64::from));
    let right = vector(view.right) * f64::from(view.width) / f64::from(view.height) * WIDER;
    let (forward, above) = (vector(view.forward), vector(view.up) * WIDER);
    let mut corners = vec![
        forward - right - above,
        forward + right - above,
        forward + right + above,
        forward - right + above,
    ];
    // Cut to the pyramid of the face: no slope beyond 1.
    let sign = if up { 1.0 } else { -1.0 };
    let across = Gridels::across(axis);
    for other in across {
        for side in [1.0, -1.0] {
            let inside = |v: &DVec3| sign * v[axis] + side * v[other];
            corners = cut(&corners, inside);
        }
    }
    let mut window = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for corner in corners.iter().filter(|corner| sign * corner[axis] > 0.0) {
        for (other, range) in across.into_iter().zip(&mut window) {
            let slope = corner[other] / (sign * corner[axis]);
            *range = [range[0].min(slope), range[1].max(slope)];
        }
    }
    (window[0][0] <= window[0][1]).then_some(window)
}

/// The part of a polygon where a linear function is not negative.
fn cut(corners: &[DVec3], inside: impl Fn(&DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (place, &corner) in corners.iter().enumerate() {
        let next = corners[(place + 1) % corners.len()];
        let (here, there) = (inside(&corner), inside(&next));
        if here >= 0.0 {
            kept.push(corner);
        }
        if (here < 0.0) != (there < 0.0) {
            kept.push(corner + (next - corner) * (here / (here - there)));
        }
    }
    kept
}

/// The size of cells with which an apex takes at most so many bytes, as far as samples tell; `None` if
/// no size does.
fn cell_size(faces: &[Face], targets: &[Target], bytes: f64) -> Option<f64> {
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
        // Nothing is seen, so no size is small enough.
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
        // Where lists hardly get shorter any more, finer cells are only more of them.
        if all > bytes || more > SATURATED * FINER * FINER * now {
            break;
        }
        (size, now) = (finer, more);
    }
    Some(size)
}

/// A window with the targets that are seen through each of its columns.
struct Window<'t> {
    record: ApexWindow,
    bundle: Bundle,
    targets: &'t [Target],
    /// All that is seen through it, the nearest first.
    seen: Vec<Seen>,
    /// For each column those that are seen through it, by their places.
    columns: Vec<Vec<u32>>,
    /// The farthest that anything lies along the axis.
    last: f64,
}

/// 2^30, the ratio 1.
const ONE: f64 = 1_073_741_824.0;

impl<'t> Window<'t> {
    fn new(targets: &'t [Target], face: &Face, size: f64, first_cell: u32) -> Self {
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
        let start = seen
            .iter()
            .map(|it| it.depths[0])
            .fold(f64::INFINITY, f64::min);
        let last = seen.iter().map(|it| it.depths[1]).fold(0.0, f64::max);
        let start = (2.0 * start).floor() as i32;
        let steps = ((2.0 * last).ceil() as u32)
            .saturating_sub(start as u32)
            .max(1);
        let record = ApexWindow {
            low: low.map(|x| x as i32),
            scale,
            cells: cells.map(|cells| cells as u16),
            first_cell,
            start,
            a_step: (u32::from(Apex::LAST_LEVEL) << 24) / steps,
        };
        let mut window = Self {
            record,
            bundle: *bundle,
            targets,
            seen: seen.clone(),
            columns: vec![Vec::new(); cells[0] as usize],
            last,
        };
        let edges: Vec<[f64; 2]> = (0..cells[0])
            .map(|column| window.range(0, column))
            .collect();
        for (place, one) in seen.iter().enumerate() {
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

    /// The number of the cell behind the window's last.
    fn end(&self) -> u32 {
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
    fn list(&self, cell: u32, list: &mut List) {
        let cell = cell - self.record.first_cell;
        let rows = u32::from(self.record.cells[1]);
        let (column, row) = (cell / rows, cell % rows);
        let ranges = [self.range(0, column), self.range(1, row)];
        let shaft = self.bundle.shaft(ranges, self.last);
        let mut sight = Sight::new(&self.bundle, ranges);
        let mut met: Vec<(f64, u32)> = Vec::new();
        // The least depth of what is left out.
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

/// How far some rays of a cell get.
struct Sight {
    /// Where each begins, its direction, and the depth at which it meets something.
    rays: [(DVec3, DVec3, f64); 16],
    /// The depth at which the last of them does.
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

    /// Takes what stands in the way.
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
