//! Builds the lists for the rays of one point: the camera's eye, and each point light.

use super::Budget;
use super::lists::{List, Lists, Plan};
use super::shaft::Shaft;
use super::target::{Target, Targets};
use glam::DVec3;
use gridel_core::accel::Apex;
use gridel_core::blob::record::{ApexPoint, ApexWindow, Gridels, Light, View};

/// Everything that the structure keeps.
#[derive(Debug)]
pub struct Apexes {
    pub points: Vec<ApexPoint>,
    pub windows: Vec<ApexWindow>,
    pub lists: Lists,
}

/// Apexes that a blob has room for: more lights than these are left to the hierarchy.
const MOST_POINTS: usize = 64;
/// How much finer the next try is.
const FINER: f64 = 1.25;
/// The part of what finer cells could save at which they save next to nothing: lists are then about
/// a quarter longer than for single rays.
const SATURATED: f64 = 0.95;
/// How much wider than the picture the camera's window is.
const WIDER: f64 = 1.02;

/// A face of a cube of directions, and what is seen through it.
struct Face {
    axis: usize,
    up: bool,
    /// The least and the greatest slope of a window's sides.
    window: [[f64; 2]; 2],
    /// The targets that are seen, each with its own slopes.
    seen: Vec<(u32, [[f64; 2]; 2])>,
}

/// Builds the lists of all apexes, each with its share of the budget.
pub fn build(targets: &Targets<'_>, view: &View, lights: &[Light], budget: Budget<'_>) -> Apexes {
    let mut apexes = Apexes {
        points: Vec::new(),
        windows: Vec::new(),
        lists: Lists::default(),
    };
    let mut windows: Vec<Window<'_>> = Vec::new();
    let eye = std::iter::once((view.eye, Some(view)));
    let point_lights = lights.iter().filter(|light| light.directional == 0);
    for (place, seen_by) in eye.chain(point_lights.map(|light| (light.vector, None))) {
        let Some(at) = within_reach(place) else {
            continue;
        };
        if apexes.points.len() == MOST_POINTS || apexes.points.iter().any(|point| point.at == at) {
            continue;
        }
        let apex = at.map(|q8| f64::from(q8) / 256.0);
        let faces: Vec<Face> = (0..6)
            .filter_map(|face| Face::of(targets.all(), apex, face, seen_by))
            .collect();
        let Some(size) = cell_size(&faces, targets.all().len(), budget.bytes) else {
            continue;
        };
        let mut point = ApexPoint {
            at,
            windows: [Apex::NO_WINDOW; 6],
        };
        for face in faces {
            let number = 2 * face.axis + usize::from(face.up);
            point.windows[number] = windows.len() as u16;
            let first_cell = windows.last().map_or(0, Window::end);
            windows.push(Window::new(targets.all(), apex, face, size, first_cell));
        }
        apexes.points.push(point);
    }
    let cells = windows.last().map_or(0, Window::end);
    let plan = Plan {
        cells: cells.into(),
        end: targets.all().len() as u32,
        keyed: true,
        list: &|cell, list| {
            let window = windows.partition_point(|window| u64::from(window.end()) <= cell);
            windows[window].list(cell as u32, list);
        },
    };
    apexes.lists = plan.build(plan.count(budget.tell));
    apexes.windows = windows.iter().map(|window| window.record).collect();
    apexes
}

/// A point in 1/256 unit, unless it lies too far away.
fn within_reach(q13: [i64; 3]) -> Option<[i32; 3]> {
    let most = (Apex::FARTHEST * 256.0) as i64;
    let q8 = q13.map(|x| (x + 16) >> 5);
    q8.iter()
        .all(|x| x.abs() <= most)
        .then(|| q8.map(|x| x as i32))
}

impl Face {
    /// What is seen through a face; `None` for nothing.
    fn of(targets: &[Target], apex: [f64; 3], face: usize, view: Option<&View>) -> Option<Self> {
        let (axis, up) = (face / 2, face % 2 == 1);
        let limits = match view {
            Some(view) => picture_window(view, axis, up)?,
            None => [[-1.0, 1.0]; 2],
        };
        let mut window = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut seen = Vec::new();
        for (slot, target) in targets.iter().enumerate() {
            let Some(slopes) = slopes_to(target, apex, axis, up) else {
                continue;
            };
            let inside = [0, 1].map(|side| {
                let ([low, high], [least, most]) = (slopes[side], limits[side]);
                [low.max(least), high.min(most)]
            });
            if inside.iter().all(|[low, high]| low <= high) {
                for (all, one) in window.iter_mut().zip(inside) {
                    *all = [all[0].min(one[0]), all[1].max(one[1])];
                }
                seen.push((slot as u32, inside));
            }
        }
        (!seen.is_empty()).then_some(Self {
            axis,
            up,
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

    /// About how many entries the lists have: those of the rectangles around the targets.
    fn entries(&self, size: f64) -> f64 {
        let cells = self.cells(size);
        let each = self.seen.iter().map(|(_, slopes)| {
            let side = |side: usize| {
                let width = self.window[side][1] - self.window[side][0];
                let step = (width / f64::from(cells[side])).max(f64::MIN_POSITIVE);
                let first = ((slopes[side][0] - self.window[side][0]) / step).floor();
                let last = ((slopes[side][1] - self.window[side][0]) / step).floor();
                (last.min(f64::from(cells[side]) - 1.0) - first + 1.0).max(1.0)
            };
            side(0) * side(1)
        });
        each.sum()
    }
}

/// The slopes at which rays that pass an apex closely can meet a target, on a face; `None` for none.
fn slopes_to(target: &Target, apex: [f64; 3], axis: usize, up: bool) -> Option<[[f64; 2]; 2]> {
    let bounds = target.bounds();
    let [near, far] = depths(bounds, apex, axis, up);
    if far < 0.0 {
        return None;
    }
    let mut slopes = [[0.0; 2]; 2];
    for (across, slopes) in Gridels::across(axis).into_iter().zip(&mut slopes) {
        let low = bounds[across][0] - apex[across] - Apex::REACH;
        let high = bounds[across][1] - apex[across] + Apex::REACH;
        // A quotient by nothing is without bounds.
        let least = if low < 0.0 { low / near } else { low / far };
        let most = if high > 0.0 { high / near } else { high / far };
        *slopes = [least.max(-1.0), most.min(1.0)];
        if slopes[0] > slopes[1] {
            return None;
        }
    }
    Some(slopes)
}

/// How far along a face's axis a box begins and ends, seen from an apex and not behind it.
fn depths(bounds: &[[f64; 2]; 3], apex: [f64; 3], axis: usize, up: bool) -> [f64; 2] {
    let [low, high] = bounds[axis].map(|side| side - apex[axis]);
    let (near, far) = if up { (low, high) } else { (-high, -low) };
    [near.max(0.0), far]
}

/// The slopes of a picture's directions on a face; `None` where it has none there.
fn picture_window(view: &View, axis: usize, up: bool) -> Option<[[f64; 2]; 2]> {
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

/// The size of cells with which an apex takes at most its budget; `None` if no size does.
fn cell_size(faces: &[Face], targets: usize, bytes: u64) -> Option<f64> {
    let entry = if targets <= 256 { 2.0 } else { 3.0 };
    let entries = |size: f64| faces.iter().map(|face| face.entries(size)).sum::<f64>();
    let fits = |size: f64, entries: f64| {
        let cells = faces.iter().map(|face| {
            let [columns, rows] = face.cells(size);
            u64::from(columns) * u64::from(rows)
        });
        // A list for each cell: its number and its first entry.
        cells.sum::<u64>() as f64 * 6.0 + entries * entry <= bytes as f64
    };
    let sides = faces.iter().flat_map(|face| face.window);
    let widest = sides.map(|[low, high]| high - low).fold(0.0, f64::max);
    if widest < f64::MIN_POSITIVE {
        // Nothing is seen, so no size is small enough.
        return None;
    }
    let mut size = widest;
    let mut now = entries(size);
    if !fits(size, now) {
        return None;
    }
    while size > widest / f64::from(Apex::MOST_CELLS) {
        let (finer, more) = (size / FINER, entries(size / FINER));
        // Where lists hardly get shorter any more, finer cells are only more of them.
        if !fits(finer, more) || more > SATURATED * FINER * FINER * now {
            break;
        }
        (size, now) = (finer, more);
    }
    Some(size)
}

/// A window with the targets that are seen through each of its columns.
struct Window<'t> {
    record: ApexWindow,
    apex: [f64; 3],
    axis: usize,
    up: bool,
    targets: &'t [Target],
    /// For each column its targets, with the slopes of their rows.
    columns: Vec<Vec<(u32, [f64; 2])>>,
    /// The farthest that anything lies along the axis.
    last: f64,
}

/// 2^30, the ratio 1.
const ONE: f64 = 1_073_741_824.0;

impl<'t> Window<'t> {
    fn new(targets: &'t [Target], apex: [f64; 3], face: Face, size: f64, first_cell: u32) -> Self {
        let cells = face.cells(size);
        let low = [0, 1].map(|side| (face.window[side][0] * ONE).floor());
        let scale = [0, 1].map(|side| {
            // Cells cover the window and at least one step each.
            let width = (face.window[side][1] * ONE).ceil() - low[side] + 1.0;
            let steps = width.max(f64::from(cells[side]) + 1.0);
            (f64::from(cells[side]) * 4_294_967_296.0 / steps).min(f64::from(u32::MAX)) as u32
        });
        let (mut start, mut last) = (f64::INFINITY, 0.0_f64);
        for &(slot, _) in &face.seen {
            let [near, far] = depths(targets[slot as usize].bounds(), apex, face.axis, face.up);
            start = start.min(near);
            last = last.max(far);
        }
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
            apex,
            axis: face.axis,
            up: face.up,
            targets,
            columns: vec![Vec::new(); cells[0] as usize],
            last,
        };
        let edges: Vec<[f64; 2]> = (0..cells[0])
            .map(|column| window.slopes(0, column))
            .collect();
        for &(slot, [across, along]) in &face.seen {
            let first = edges.partition_point(|&[_, end]| end < across[0]);
            for (column, edge) in window.columns.iter_mut().zip(&edges).skip(first) {
                if edge[0] > across[1] {
                    break;
                }
                column.push((slot, along));
            }
        }
        window
    }

    /// The number of the cell behind the window's last.
    fn end(&self) -> u32 {
        let [columns, rows] = self.record.cells.map(u32::from);
        self.record.first_cell + columns * rows
    }

    /// The slopes of a column or row, widened by the rounding of a ray's.
    fn slopes(&self, side: usize, place: u32) -> [f64; 2] {
        let [low, high] = self.record.extent(side, place);
        [(low as f64 - 1.0) / ONE, (high as f64 + 1.0) / ONE]
    }

    /// Fills the list of a cell, sorted by where its targets can begin.
    fn list(&self, cell: u32, list: &mut List) {
        let cell = cell - self.record.first_cell;
        let rows = u32::from(self.record.cells[1]);
        let (column, row) = (cell / rows, cell % rows);
        let slopes = [self.slopes(0, column), self.slopes(1, row)];
        let mut shaft = Shaft {
            low: self.apex,
            high: self.apex,
            low_rate: [0.0; 3],
            high_rate: [0.0; 3],
            last: self.last,
        };
        let sign = if self.up { 1.0 } else { -1.0 };
        (shaft.low_rate[self.axis], shaft.high_rate[self.axis]) = (sign, sign);
        for (across, slopes) in Gridels::across(self.axis).into_iter().zip(slopes) {
            shaft.low[across] -= Apex::REACH;
            shaft.high[across] += Apex::REACH;
            [shaft.low_rate[across], shaft.high_rate[across]] = slopes;
        }
        let mut met: Vec<(f64, u32)> = Vec::new();
        for &(slot, along) in &self.columns[column as usize] {
            if along[0] <= slopes[1][1] && along[1] >= slopes[1][0] {
                let span = self.targets[slot as usize].met_by(&shaft);
                met.extend(span.map(|[from, _]| (from, slot)));
            }
        }
        met.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        list.extend(met.iter().map(|&(from, slot)| {
            // Half units, rounded down by more than arithmetic can be off.
            let step = (2.0 * from - 1e-3).floor();
            (slot, self.record.level(step as i32))
        }));
    }
}
