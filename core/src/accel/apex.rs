//! Lists for the rays of one point: an eye, or a light.
//!
//! Where one of the cylinder cube's two gridels shrinks to a point, n^2 lists remain of n^4, and
//! each is short. This is nearer to the light buffer of E. Haines and D. Greenberg ("The Light
//! Buffer: A Shadow-Testing Accelerator", 1986) than to the paper, with a difference: it serves
//! rays that start at the point as well as rays that end there.
//!
//! Around each point, the *apex*, lies a cube of directions. A face of it, the directions with one
//! major axis and sign, has a *window*: a rectangle of slopes cut into cells, each with a list of
//! what the rays of the cell can meet, sorted by where on the way from the apex that may begin. A
//! ray whose line passes an apex closely, and that only looks for hits on one side of it, takes its
//! list from there: rays from the eye, shadow rays to a light. All others walk the hierarchy
//! ([`Bvh`]); so a camera that was moved is noticed by itself, and costs time alone.
//!
//! **No candidate is lost.** Let a line in integers pass the apex, in the plane across its major
//! axis, within four units on each of the other two axes; the ray itself then passes within a
//! little more.
//! The ray's
//! point at a hit lies in the primitive's box widened by 17 units (see
//! [`gridels`](super::gridels)), not more than a unit on the wrong side of that plane, and otherwise
//! in the volume that a rectangle reaching [`Apex::REACH`] units around the apex sweeps when it moves
//! along the major axis while its sides move by the least and the greatest slope of the cell. The
//! builder lists what meets that volume.
//!
//! Memory: 24 bytes an apex, 32 a window, and the lists. Cost: two multiplications for each apex
//! that is tried, four more for the cell, and one to four primitives.

use super::bvh::Bvh;
use super::candidates::{Candidates, ListSections};
use super::line::Line;
use super::{Accel, Leaf, Records, StackView, Structure};
use crate::blob::record::{ApexPoint, ApexWindow, Gridels};
use crate::blob::{BlobError, Scene, SectionKind, Sections};
use crate::count::Count;
use crate::number::{Number, pick};
use crate::ray::Ray;

/// Lists for the rays of the camera and of point lights, and the hierarchy for all others.
#[derive(Clone, Copy, Debug)]
pub enum Apex {}

impl Apex {
    /// Units around an apex within which a line passes it closely, all rounding included.
    pub const REACH: f64 = 6.0;
    /// Units from the lattice's zero to an apex on an axis, at the most.
    pub const FARTHEST: f64 = 2_097_152.0;
    /// What stands for the window of a face that has none.
    pub const NO_WINDOW: u16 = u16::MAX;
    /// Most cells along a side of a window.
    pub const MOST_CELLS: u16 = 1024;
    /// The last of the levels that keys count.
    pub const LAST_LEVEL: u8 = u8::MAX;
    /// Units that a line in integers may pass an apex by, with 8 fraction bits.
    const CLOSE: u32 = 4 << 8;
}

impl Accel for Apex {
    const STRUCTURE: Structure = Structure::Apex;
    type Cull<N: Number> = N::Cull;

    // Once, and not for every set of effects that the ray loop is compiled for.
    #[inline(never)]
    fn walk<N: Number, C: Count>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        cull: &N::Cull,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let Held { lists, .. } = &scene.held.apex;
        let Some(way) = scene.held.apex.way(ray) else {
            return Bvh::walk(scene, ray, cull, stack, count, leaf);
        };
        count.cells(1);
        let mut tmax = ray.tmax;
        let mut end = if way.outward {
            way.level(tmax.to_cull())
        } else {
            way.level(ray.tmin.to_cull())
        };
        lists.ascend(way.cell, end, |slot| {
            let limit = leaf(scene.shapes.single(slot), count)?;
            if way.outward && limit < tmax {
                tmax = limit;
                end = way.level(tmax.to_cull());
            }
            Some(end)
        });
    }
}

/// How a ray lies to an apex.
struct Way<'a> {
    window: &'a ApexWindow,
    cell: u32,
    /// Whether the ray runs away from the apex.
    outward: bool,
    /// The ray's parameter at the apex, in culling steps.
    apex: i32,
}

impl Way<'_> {
    /// A level that is not below that of a place on the ray.
    #[inline(always)]
    fn level(&self, step: i32) -> u8 {
        /// Steps that rounding may move a place by.
        const SLACK: i32 = 4;
        let from_apex = if self.outward {
            step.saturating_sub(self.apex)
        } else {
            self.apex.saturating_sub(step)
        };
        self.window.level(from_apex.saturating_add(SLACK))
    }
}

impl ApexWindow {
    /// The level of a place along the major axis, in culling steps from the apex: 0 where the first
    /// candidate of the window can begin.
    #[inline(always)]
    pub fn level(&self, step: i32) -> u8 {
        let way = step.saturating_sub(self.start).max(0) as u64;
        ((way * u64::from(self.a_step)) >> 24).min(Apex::LAST_LEVEL.into()) as u8
    }

    /// The column or row of a slope, by the side that it is counted along.
    #[inline(always)]
    fn place(&self, side: usize, slope: i32) -> Option<u32> {
        let from_low = i64::from(slope) - i64::from(self.low[side & 1]);
        let place = (u64::try_from(from_low).ok()? * u64::from(self.scale[side & 1])) >> 32;
        (place < self.cells[side & 1].into()).then_some(place as u32)
    }

    /// The first and the last slope of a column or row; exactly what rays are sorted by.
    pub fn extent(&self, side: usize, place: u32) -> [i64; 2] {
        let scale = u64::from(self.scale[side & 1]).max(1);
        let first = |place: u32| {
            i64::from(self.low[side & 1]) + (u64::from(place) << 32).div_ceil(scale) as i64
        };
        [first(place), first(place + 1)]
    }
}

/// The apexes of a scene, and the lists of their windows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held<'a> {
    points: &'a [ApexPoint],
    windows: &'a [ApexWindow],
    lists: Candidates<'a>,
}

impl<'a> Held<'a> {
    /// The apex that a ray starts from or runs to, if its directions have lists there.
    #[inline(always)]
    fn way<N: Number>(&self, ray: &Ray<N>) -> Option<Way<'a>> {
        let line = Line::of(ray);
        let major = line.major;
        let across = Gridels::across(major);
        let rises = line.ascends(major);
        let (tmin, tmax) = (ray.tmin.to_cull(), ray.tmax.to_cull());
        for point in self.points {
            // With 8 fraction bits, so that products fit with a point far away: both have less than
            // 30 bits, and slopes at most 31.
            let far = pick(point.at, major).wrapping_sub(pick(line.origin, major) >> 5);
            let t = if rises { far } else { far.wrapping_neg() };
            let passes = |axis: usize| {
                let rise = (i64::from(pick(line.slope, axis)) * i64::from(t)) >> 30;
                let place = i64::from(pick(line.origin, axis) >> 5) + rise;
                (place - i64::from(pick(point.at, axis))).unsigned_abs() <= Apex::CLOSE.into()
            };
            if !(passes(across[0]) && passes(across[1])) {
                continue;
            }
            let apex = t >> 7;
            let outward = tmin >= apex - 1;
            if !outward && tmax > apex + 1 {
                continue;
            }
            let face = major << 1 | usize::from(rises == outward);
            let number = point.windows.get(face).copied().unwrap_or(Apex::NO_WINDOW);
            let Some(window) = self.windows.get(usize::from(number)) else {
                continue;
            };
            let slope = |axis: usize| {
                let slope = pick(line.slope, axis);
                if outward { slope } else { slope.wrapping_neg() }
            };
            let column = window.place(0, slope(across[0]));
            let row = window.place(1, slope(across[1]));
            if let (Some(column), Some(row)) = (column, row) {
                // One of the table's cells.
                let place = column
                    .wrapping_mul(window.cells[1].into())
                    .wrapping_add(row);
                return Some(Way {
                    window,
                    cell: window.first_cell.wrapping_add(place),
                    outward,
                    apex,
                });
            }
        }
        None
    }
}

const LISTS: ListSections = ListSections {
    cells: SectionKind::ApexCells,
    starts: SectionKind::ApexStarts,
    entries: SectionKind::ApexEntries,
    keys: Some(SectionKind::ApexKeys),
};

impl<'a> Records<'a> for Held<'a> {
    const SECTIONS: &'static [SectionKind] = &[
        SectionKind::ApexPoints,
        SectionKind::ApexWindows,
        LISTS.cells,
        LISTS.starts,
        LISTS.entries,
        SectionKind::ApexKeys,
    ];
    const USES_LEAVES: bool = false;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self {
            points: sections.records(SectionKind::ApexPoints)?,
            windows: sections.records(SectionKind::ApexWindows)?,
            lists: Candidates::read(sections, &LISTS)?,
        })
    }

    /// Proves that points lie within reach, that windows follow each other in the table and fill
    /// it, and the lists; and that the scene holds the hierarchy for all other rays.
    fn check(&self, scene: &Scene<'a>) -> Result<usize, BlobError> {
        Structure::Bvh.needed_by(Structure::Apex, scene)?;
        const MOST: u32 = 1 << 29;
        for (index, point) in self.points.iter().enumerate() {
            let wrong = |what, found: i64, expected: i64| BlobError::Record {
                section: SectionKind::ApexPoints,
                index,
                what,
                found,
                expected,
            };
            for coordinate in point.at {
                if coordinate.unsigned_abs() > MOST {
                    return Err(wrong("coordinate", coordinate.into(), MOST.into()));
                }
            }
            for window in point.windows {
                let exists = usize::from(window) < self.windows.len();
                if !exists && window != Apex::NO_WINDOW {
                    let last = self.windows.len() as i64 - 1;
                    return Err(wrong("window", window.into(), last));
                }
            }
        }
        let mut next: u32 = 0;
        for (index, window) in self.windows.iter().enumerate() {
            let wrong = |what, found: u32, expected: u32| BlobError::Record {
                section: SectionKind::ApexWindows,
                index,
                what,
                found: found.into(),
                expected: expected.into(),
            };
            if window.first_cell != next {
                return Err(wrong("first cell", window.first_cell, next));
            }
            for cells in window.cells {
                if cells == 0 || cells > Apex::MOST_CELLS {
                    let most = Apex::MOST_CELLS.into();
                    return Err(wrong("number of cells along a side", cells.into(), most));
                }
            }
            let cells = u32::from(window.cells[0]) * u32::from(window.cells[1]);
            // A table has fewer cells than a blob bytes.
            next = next.saturating_add(cells);
        }
        let ascend = |before: u8, after: u8| before <= after;
        self.lists
            .check(&LISTS, next.into(), scene.shapes.total(), ascend)?;
        Ok(0)
    }
}
