//! Lists for the rays of one point, an eye or a light, or of one direction, a light's far away.
//!
//! Where one of the cylinder cube's two gridels shrinks to a point, n^2 lists remain of n^4, and each is short. This
//! structure is nearer to the light buffer of E. Haines and D. Greenberg ("The Light Buffer: A Shadow-Testing
//! Accelerator", 1986) than to the paper. The difference: it serves rays that start at the point as well as rays that
//! end there.
//!
//! A cube of directions lies around each point, the *apex*. A face of the cube holds the directions with one major axis
//! and sign. It has a *window*: a rectangle of slopes cut into cells. Each cell has a list of the primitives that its
//! rays can hit. The list is sorted by where on the way from the apex each primitive can begin.
//!
//! A ray takes its list from an apex if its line passes closely and it only looks for hits on one side. Such rays are
//! rays from the eye and shadow rays to a light. All others walk the hierarchy ([`Bvh`]). So pictures stay right when a
//! program moves the camera; they only take longer.
//!
//! A directional light is an apex infinitely far away. Its rays differ by where they pass a *plane* across their major
//! axis that lies beyond the space. Its one window is a rectangle of that plane.
//!
//! **No candidate is lost.** Let a line in integers pass the apex, in the plane across its major axis, within four
//! units on each of the other two axes. The ray itself then passes within a little more. The ray's point at a hit lies
//! in the primitive's box widened by 17 units (see `accel::candidates::gridels`). The point either lies at most a unit
//! on the wrong side of that plane, or in a swept volume. That volume is swept by a rectangle that reaches
//! [`Apex::REACH`] units around the apex. The rectangle moves along the major axis, while its sides move by the least
//! and the greatest slope of the cell. The builder lists the primitives that intersect that volume.
//!
//! A line whose slopes lie within 2^-19 of a direction's moves away from it by less than an eighth of a unit. That
//! holds between the plane and the scene's far end. The cell, a rectangle of the plane widened by [`Apex::REACH`],
//! sweeps a volume when it moves along the direction itself. So the line's points lie within a unit of that volume.
//!
//! **Lists can be cut.** Most primitives of a full list lie behind others and are rarely needed. A last entry that is
//! no slot represents all primitives that begin at its key or later. A ray that reaches this entry continues in the
//! hierarchy. So the place of the cut does not change an answer.
//!
//! Memory: 24 bytes per apex, 20 per direction, 32 per window, and the lists.
//!
//! Cost: three comparisons per direction and two multiplications per apex that is tried. Two to four more find the
//! cell, and one to four primitives are tested.

use crate::accel::candidates::line::Line;
use crate::accel::candidates::lists::{Candidates, ListSections, look_up};
use crate::accel::cull::{Culling, NoBoxCulling};
use crate::accel::hierarchy::bvh::Bvh;
use crate::accel::hierarchy::pairs::Pairs;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
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
    /// Maximum units from the lattice's zero to an apex on an axis.
    pub const FARTHEST: f64 = 2_097_152.0;
    /// Marks a face without a window.
    pub const NO_WINDOW: u16 = u16::MAX;
    /// Maximum number of cells along a side of a window.
    pub const MOST_CELLS: u16 = ApexWindow::MOST_CELLS;
    /// The last of the levels that keys count.
    pub const LAST_LEVEL: u8 = u8::MAX;
    /// Maximum distance between a line in integers and its apex, in units with 8 fraction bits.
    const CLOSE: u32 = 4 << 8;
    /// Maximum difference between a line's slopes and a direction's, with 30 fraction bits.
    const PARALLEL: u32 = 1 << 11;
}

impl Traverse for Apex {
    const STRUCTURE: Structure = Structure::Apex;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = NoBoxCulling;

    // Compiled once, and not for every set of effects of the ray loop.
    #[inline(never)]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
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
                let single = geometry.shapes.single(slot);
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
        Bvh::walk(geometry, &views.fallback, &rest, &cull, stack, count, leaf);
    }
}

/// The relation between a ray and an apex.
struct WindowLookup<'a> {
    window: &'a ApexWindow,
    cell: u32,
    /// True if the ray runs away from the apex.
    outward: bool,
    /// The ray's parameter at the apex, in culling steps.
    apex: i32,
}

impl WindowLookup<'_> {
    /// Returns a level that is not below the level of a place on the ray.
    #[inline(always)]
    fn level(&self, step: i32) -> u8 {
        /// Maximum steps that rounding moves a place.
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
    /// Returns the level of a place along the major axis, in culling steps from the apex. Level 0 is where the first
    /// candidate of the window can begin.
    #[inline(always)]
    pub fn level(&self, step: i32) -> u8 {
        let way = step.saturating_sub(self.start).max(0) as u64;
        ((way * u64::from(self.levels_per_step)) >> 24).min(Apex::LAST_LEVEL.into()) as u8
    }

    /// Returns the column or row of a slope or place, by the side along which it is counted.
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

    /// Returns the cell of a ray by its slopes or its place on the plane; `None` outside the window.
    #[inline(always)]
    fn cell(&self, values: [i32; 2]) -> Option<u32> {
        let (column, row) = (self.column(0, values[0])?, self.column(1, values[1])?);
        let number = column.wrapping_mul(self.cells[1].into()).wrapping_add(row);
        // One of the table's cells.
        Some(self.first_cell.wrapping_add(number))
    }

    /// Returns the first and the last slope or place of a column or row. They are exactly those of the rays that are
    /// sorted into it.
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
    /// Returns the apex that a ray starts from or runs to, if it has a list there.
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
            // With 8 fraction bits, products with a far point fit: both factors have less than 30 bits, and slopes at
            // most 31.
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

/// The sections of the lists.
pub const LISTS: ListSections = ListSections {
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

    /// Proves that points and planes are in range, that windows follow each other in the table and fill it, and that
    /// lists are valid. Proves also that the scene holds the hierarchy for all other rays.
    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        geometry.require(Structure::Bvh, Structure::Apex)?;
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
            // A table has fewer cells than a blob has bytes.
            next = next.saturating_add(cells);
        }
        let ascend = |before: u8, after: u8| before <= after;
        // One more than there are slots, for the entry that cuts a list.
        let end = geometry.shapes.bounded().saturating_add(1);
        self.lists.check(&LISTS, next.into(), end, ascend)?;
        Ok(0)
    }
}
