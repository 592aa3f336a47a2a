//! Lists for the rays of one point, an eye or a light, or of one direction, a light's far away.
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
//! ([`Bvh`]). So pictures stay right when a program moves the camera; they only take longer.
//!
//! A directional light is an apex infinitely far away. Its rays differ by where they pass a *plane*
//! across their major axis that lies beyond the space, and its one window is a rectangle of that
//! plane.
//!
//! **No candidate is lost.** Let a line in integers pass the apex, in the plane across its major
//! axis, within four units on each of the other two axes; the ray itself then passes within a
//! little more.
//! The ray's
//! point at a hit lies in the primitive's box widened by 17 units (see
//! `accel::candidates::gridels`), not more than a unit on the wrong side of that plane, and otherwise
//! in the volume that a rectangle reaching [`Apex::REACH`] units around the apex sweeps when it moves
//! along the major axis while its sides move by the least and the greatest slope of the cell. The
//! builder lists what meets that volume.
//!
//! A line whose slopes lie within 2^-19 of a direction's moves away from it by less than an eighth
//! of a unit between the plane and the scene's far end. So its points lie within a unit of the volume
//! that the cell, a rectangle of the plane widened by [`Apex::REACH`], sweeps when it moves along the
//! direction itself.
//!
//! **Lists may be cut.** Most primitives of a full list lie behind others and are rarely needed. A last entry that is
//! no slot stands for all primitives that begin at its key or later: a ray that comes to it goes on in the
//! hierarchy. So the place of the cut does not change an answer.
//!
//! Memory: 24 bytes per apex, 20 per direction, 32 per window, and the lists. Cost: three comparisons for
//! each direction and two multiplications for each apex that is tried, two to four more for the
//! cell, and one to four primitives.

use crate::accel::candidates::line::Line;
use crate::accel::candidates::lists::{Candidates, ListSections, look_up};
use crate::accel::cull::{Culling, NoBoxCulling};
use crate::accel::hierarchy::bvh::Bvh;
use crate::accel::hierarchy::pairs::Pairs;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::space::Space;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::axis::pick;
use crate::format::range::{At, Ranges};
use crate::format::record::{ApexDirection, ApexPoint, ApexWindow, Gridels, Pair};
use crate::format::{BlobError, Field, Leaf, SectionKind, Sections, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;

/// Lists for the rays of the camera and of lights, and the hierarchy for all others.
#[derive(Clone, Copy, Debug)]
pub enum Apex {}

impl Apex {
    /// Units around an apex within which a line passes it closely, all rounding included.
    pub const REACH: f64 = 6.0;
    /// Units from the lattice's zero to an apex on an axis, at the most.
    pub const FARTHEST: f64 = 2_097_152.0;
    /// Stands for the window of a face that has none.
    pub const NO_WINDOW: u16 = u16::MAX;
    /// Most cells along a side of a window.
    pub const MOST_CELLS: u16 = ApexWindow::MOST_CELLS;
    /// The last of the levels that keys count.
    pub const LAST_LEVEL: u8 = u8::MAX;
    /// Units that a line in integers may pass an apex by, with 8 fraction bits.
    const CLOSE: u32 = 4 << 8;
    /// How far a line's slopes may lie from a direction's, with 30 fraction bits.
    const PARALLEL: u32 = 1 << 11;
}

impl Traverse for Apex {
    const STRUCTURE: Structure = Structure::Apex;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = NoBoxCulling;

    // Once, and not for every set of effects that the ray loop is compiled for.
    #[inline(never)]
    fn walk<N: Number, C: Observer>(
        space: &Space<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        _: &NoBoxCulling,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let mut tmax = ray.tmax;
        if let Some(window) = views.look_up_window(ray) {
            look_up(window.cell, count);
            let mut end = if window.outward {
                window.level(tmax.to_cull())
            } else {
                window.level(ray.tmin.to_cull())
            };
            let mut cut = false;
            views.lists.ascend(window.cell, end, |slot| {
                let single = space.shapes.single(slot);
                if single.count == 0 {
                    cut = true;
                    return None;
                }
                let limit = leaf(single, count)?;
                if limit < tmax {
                    tmax = limit;
                    if window.outward {
                        end = window.level(tmax.to_cull());
                    }
                }
                Some(end)
            });
            if !cut {
                return;
            }
        }
        let rest = Ray { tmax, ..*ray };
        let cull = Culling::new(&rest);
        Bvh::walk(space, &views.fallback, &rest, &cull, stack, count, leaf);
    }
}

/// How a ray lies to an apex.
struct WindowLookup<'a> {
    window: &'a ApexWindow,
    cell: u32,
    /// Whether the ray runs away from the apex.
    outward: bool,
    /// The ray's parameter at the apex, in culling steps.
    apex: i32,
}

impl WindowLookup<'_> {
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

    /// The column or row of a slope or place, by the side that it is counted along.
    #[inline(always)]
    fn column(&self, side: usize, value: i32) -> Option<u32> {
        let low = self.low[side & 1];
        if value < low {
            return None;
        }
        let from_low = u64::from(value.wrapping_sub(low).cast_unsigned());
        let column = ((from_low * u64::from(self.scale[side & 1])) >> 32) as u32;
        (column < self.cells[side & 1].into()).then_some(column)
    }

    /// The cell of a ray by what it is sorted by; `None` beside the window.
    #[inline(always)]
    fn cell(&self, values: [i32; 2]) -> Option<u32> {
        let (column, row) = (self.column(0, values[0])?, self.column(1, values[1])?);
        let number = column.wrapping_mul(self.cells[1].into()).wrapping_add(row);
        // One of the table's cells.
        Some(self.first_cell.wrapping_add(number))
    }

    /// The first and the last slope or place of a column or row; exactly what rays are sorted by.
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
pub struct Views<'a> {
    points: &'a [ApexPoint],
    directions: &'a [ApexDirection],
    windows: &'a [ApexWindow],
    lists: Candidates<'a>,
    /// The hierarchy for rays without a list.
    fallback: Pairs<'a, Pair>,
}

impl<'a> Views<'a> {
    /// The apex that a ray starts from or runs to, if it has a list there.
    #[inline(always)]
    fn look_up_window<N: Number>(&self, ray: &Ray<N>) -> Option<WindowLookup<'a>> {
        let line = Line::of(ray);
        self.look_up_direction(&line)
            .or_else(|| self.look_up_point(ray, &line))
    }

    /// The direction in which a ray runs.
    #[inline(always)]
    fn look_up_direction(&self, line: &Line) -> Option<WindowLookup<'a>> {
        let along = |direction: &&ApexDirection| {
            let near = |axis: usize| {
                let beside = pick(line.slope, axis).wrapping_sub(pick(direction.slope, axis));
                beside.unsigned_abs() <= Apex::PARALLEL
            };
            near(0) && near(1) && near(2) && line.major == usize::from(direction.major)
        };
        let direction = self.directions.iter().find(along)?;
        let window = self.windows.get(usize::from(direction.window))?;
        let t = line.reach(direction.plane << 5);
        // Within 2^19 units.
        let at = |axis: usize| (line.at(axis, t) >> 5) as i32;
        let [first, second] = Gridels::across(line.major);
        Some(WindowLookup {
            window,
            cell: window.cell([at(first), at(second)])?,
            outward: false,
            apex: t >> 12,
        })
    }

    /// The point that a ray starts from or runs to.
    #[inline(always)]
    fn look_up_point<N: Number>(&self, ray: &Ray<N>, line: &Line) -> Option<WindowLookup<'a>> {
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
            if let Some(cell) = window.cell([slope(across[0]), slope(across[1])]) {
                return Some(WindowLookup {
                    window,
                    cell,
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

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[
        SectionKind::ApexPoints,
        SectionKind::ApexWindows,
        LISTS.cells,
        LISTS.starts,
        LISTS.entries,
        SectionKind::ApexKeys,
        SectionKind::ApexDirections,
    ];
    const USES_LEAVES: bool = false;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self {
            points: sections.records(SectionKind::ApexPoints)?,
            directions: sections.records(SectionKind::ApexDirections)?,
            windows: sections.records(SectionKind::ApexWindows)?,
            lists: Candidates::read(sections, &LISTS)?,
            fallback: Pairs::read(sections)?,
        })
    }

    /// Proves that points and planes lie within reach, that windows follow each other in the table and
    /// fill it, and the lists; and that the scene holds the hierarchy for all other rays.
    fn check(&self, space: &Space<'a>) -> Result<usize, BlobError> {
        space.require(Structure::Bvh, Structure::Apex)?;
        let last = self.windows.len() as i64 - 1;
        for (index, point) in self.points.iter().enumerate() {
            let section = SectionKind::ApexPoints;
            let at = At { section, index };
            point.check_ranges(at.location())?;
            for window in point.windows {
                if window != Apex::NO_WINDOW {
                    at.within(Field::Window, window.into(), 0, last)?;
                }
            }
        }
        for (index, direction) in self.directions.iter().enumerate() {
            let section = SectionKind::ApexDirections;
            let at = At { section, index };
            direction.check_ranges(at.location())?;
            at.within(Field::Window, direction.window.into(), 0, last)?;
        }
        let mut next: u32 = 0;
        for (index, window) in self.windows.iter().enumerate() {
            let section = SectionKind::ApexWindows;
            let at = At { section, index };
            let first = next.into();
            at.within(Field::FirstCell, window.first_cell.into(), first, first)?;
            window.check_ranges(at.location())?;
            let cells = u32::from(window.cells[0]) * u32::from(window.cells[1]);
            // A table has fewer cells than a blob bytes.
            next = next.saturating_add(cells);
        }
        let ascend = |before: u8, after: u8| before <= after;
        // One more than there are slots, for where a list is cut.
        let end = space.shapes.bounded().saturating_add(1);
        self.lists.check(&LISTS, next.into(), end, ascend)?;
        Ok(0)
    }
}
