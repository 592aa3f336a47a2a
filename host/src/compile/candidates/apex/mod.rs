//! Builds the lists for the rays of the camera's eye and of each light.

mod face;
mod window;

use super::budget::Budget;
use super::lists::{Lists, Plan};
use super::target::Targets;
use crate::compile::section::{Section, section};
use face::{Face, ONE};
use gridel_core::accel::Apex;
use gridel_core::format::SectionKind;
use gridel_core::format::record::{
    ApexDirection, ApexPoint, ApexWindow, Gridels, Light, UnitBox, View,
};
use gridel_core::shared::apex;
use window::{Window, cell_size};

/// Everything that the structure keeps.
#[derive(Debug)]
pub struct Apexes {
    points: Vec<ApexPoint>,
    directions: Vec<ApexDirection>,
    windows: Vec<ApexWindow>,
    pub lists: Lists,
}

impl Apexes {
    /// Returns the apexes and their lists.
    pub fn sections(self) -> Vec<Section> {
        let mut sections = vec![
            section(SectionKind::ApexPoints, &self.points),
            section(SectionKind::ApexWindows, &self.windows),
        ];
        sections.extend(self.lists.sections(apex::LISTS));
        sections.push(section(SectionKind::ApexDirections, &self.directions));
        sections
    }
}

/// Apexes that a blob has room for: more lights than these are left to the hierarchy.
const MOST_POINTS: usize = 64;
/// Ratio of the next try's size to the last one's, if lists exceed the budget.
const COARSER: f64 = 0.85;

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
        let counted = plan.count(budget.on_progress);
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
    let point_lights = lights.iter().filter(|light| light.kind == 0);
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
    for light in lights
        .iter()
        .filter(|light| light.kind == Light::DIRECTIONAL)
    {
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
    // The first of equal ones, as rays choose.
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
