//! The regular grid, walked cell by cell (the structure with which the paper compares the cylinder cube).
//!
//! On every axis the ray crosses plane `p` at the step at which culling lets it enter a box that begins there:
//! `p * inverse + near` (see `accel::cull`). So the cell at a step follows from comparisons of integers. These are
//! computed anew for every plane, so no error accumulates. No direction is special: along an axis on which the ray does
//! not move, all planes always lie behind it or always before it. A walk has at most `x + y + z` cells.
//!
//! **No primitive is skipped.** Let a hit be at step `t`, on a primitive whose box is \[`low`, `high`\] on some axis.
//! The hit lies in the box's culling interval, so `step(low) + near <= t <= step(high) + far` where the ray rises along
//! the axis. The walk's cell at step `t` is the last one whose lower plane `p` has `step(p) + near <= t`. Steps are
//! monotone, so `low` does not lie beyond that cell, and `step(p) <= step(high) + far - near`.
//!
//! `far - near` is twice the margin of culling. That is a half unit and seven steps, with roundings, at the least
//! steepness of two steps per unit: less than 5 units. Slopes below 2^-12 add 2^17 steps at 2^13 per unit: 16 units. So
//! `p < high + 17`. Where the ray falls along the axis, the proof is mirrored.
//!
//! A primitive is listed in every cell that its box reaches when it is widened by [`MARGIN`]. So it is tested at the
//! latest in the cell that the ray is in at the hit. The walk ends only where the next cell begins beyond the best hit.

use crate::accel::candidates::lists::look_up;
use crate::accel::cells::lists::{Divisions, Lists, Tester, check_complete, divide, reach};
use crate::accel::cull::{Cull, PairCulling};
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::range::At;
use crate::format::record::GridShape;
use crate::format::{BlobError, Field, Leaf, Location, Reason, SectionKind, Sections, Structure};
use crate::observe::count::Observer;
use crate::observe::event::{Event, NodeId};
use crate::ray::Ray;

/// Units by which primitives' boxes are widened before they are listed.
pub const MARGIN: i32 = 18;

/// The regular grid; needs no stack.
#[derive(Clone, Copy, Debug)]
pub enum Grid {}

/// The grid of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a> {
    shape: Option<&'a GridShape>,
    lists: Lists<'a>,
}

impl Traverse for Grid {
    const STRUCTURE: Structure = Structure::Grid;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = Cull;

    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Cull,
        _: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let Some(shape) = views.shape else { return };
        count.planes(6);
        count.boxes(1);
        let limit = <Cull as PairCulling<N>>::limit;
        let root = PairCulling::<N>::root(cull, geometry.bounds(), limit(ray.tmax));
        if C::ENABLED {
            count.event(Event::Tested {
                node: NodeId {
                    what: "grid",
                    number: 0,
                },
                sides: geometry.bounds().0.map(|axis| axis.map(Some)),
                span: Cull::span(root),
            });
        }
        if root.near > root.far {
            return;
        }
        let mut end = root.far;
        let mut tester = Tester::new(geometry, views.lists, leaf);
        let mut steps = Steps::new(cull, divide(geometry.bounds(), shape.counts()), root.near);
        loop {
            let cell = steps.cell();
            look_up(cell, count);
            match tester.list::<N, C>(cell as usize, count) {
                Ok(None) => {}
                Ok(Some(tmax)) => end = end.min(limit(tmax)),
                Err(()) => return,
            }
            count.planes(1);
            if !steps.advance(end) {
                return;
            }
        }
    }
}

/// The cells along a ray.
struct Steps<'c> {
    cull: &'c Cull,
    divisions: [Divisions; 3],
    /// The cell's division on each axis.
    place: [u32; 3],
    /// The step at which the ray leaves it on each axis.
    exit: [i32; 3],
}

impl<'c> Steps<'c> {
    /// Begins in the cell of the ray at a step.
    #[inline(always)]
    fn new(cull: &'c Cull, divisions: [Divisions; 3], start: i32) -> Self {
        let mut steps = Self {
            cull,
            divisions,
            place: [0; 3],
            exit: [i32::MAX; 3],
        };
        for (axis, divisions) in divisions.iter().enumerate() {
            let descends = cull.descends(axis);
            steps.place[axis] = divisions.last(|plane| {
                // The last plane that the ray has reached if it rises, or the first that it has not if it falls.
                (cull.enters(axis, plane) <= start) != descends
            });
            steps.exit[axis] = steps.next(axis);
        }
        steps
    }

    /// The cell's number.
    #[inline(always)]
    fn cell(&self) -> u32 {
        let [x, y, z] = self.place;
        let row = z.wrapping_mul(self.divisions[1].count()).wrapping_add(y);
        row.wrapping_mul(self.divisions[0].count()).wrapping_add(x)
    }

    /// Returns the step at which the ray leaves its cell along an axis; the last step if it never does.
    #[inline(always)]
    fn next(&self, axis: usize) -> i32 {
        let (place, divisions) = (self.place[axis], &self.divisions[axis]);
        if self.cull.descends(axis) {
            if place == 0 {
                return i32::MAX;
            }
            self.cull.enters(axis, divisions.plane(place))
        } else {
            let next = place.wrapping_add(1);
            if next >= divisions.count() {
                return i32::MAX;
            }
            self.cull.enters(axis, divisions.plane(next))
        }
    }

    /// Moves to the next cell, if it begins no later than at a step.
    #[inline(always)]
    fn advance(&mut self, end: i32) -> bool {
        let [x, y, z] = self.exit;
        let axis = if x <= y && x <= z {
            0
        } else if y <= z {
            1
        } else {
            2
        };
        let exit = self.exit[axis];
        if exit > end || exit == i32::MAX {
            return false;
        }
        let place = &mut self.place[axis];
        *place = if self.cull.descends(axis) {
            place.wrapping_sub(1)
        } else {
            place.wrapping_add(1)
        };
        self.exit[axis] = self.next(axis);
        true
    }
}

impl Views<'_> {
    /// Proves that every primitive is in the lists of all cells that it reaches. The number of entries is then exact,
    /// so there are no others. Each entry of a list is found by search, which proves that entries ascend.
    fn check_lists(&self, geometry: &SceneGeometry<'_>, counts: [u32; 3]) -> Result<(), BlobError> {
        let slots = geometry.shapes.bounded();
        let reach = reach(geometry, divide(geometry.bounds(), counts), MARGIN);
        let listed = self.lists.entries() as u64;
        // First, because it bounds the work.
        check_complete(listed, slots, &reach, SectionKind::GridSlots)?;
        for (slot, [xs, ys, zs]) in (0..slots).filter_map(|slot| Some((slot, reach(slot)?))) {
            for (z, y) in (zs[0]..=zs[1]).flat_map(|z| (ys[0]..=ys[1]).map(move |y| (z, y))) {
                let row = z.wrapping_mul(counts[1]).wrapping_add(y);
                for x in xs[0]..=xs[1] {
                    let list = row.wrapping_mul(counts[0]).wrapping_add(x) as usize;
                    let is_listed = self.lists.holds(list, slot as u32);
                    Location::Record(SectionKind::GridStarts, list)
                        .ensure(is_listed, Reason::MissingPrimitive)?;
                }
            }
        }
        Ok(())
    }
}

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[
        SectionKind::GridShape,
        SectionKind::GridStarts,
        SectionKind::GridSlots,
    ];
    const USES_LEAVES: bool = false;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        let section = SectionKind::GridShape;
        let shapes: &[GridShape] = sections.records(section)?;
        if shapes.len() > 1 {
            return Err(BlobError::Count {
                section,
                found: shapes.len(),
                expected: 1,
            });
        }
        Ok(Self {
            shape: shapes.first(),
            lists: Lists::read(sections, [SectionKind::GridStarts, SectionKind::GridSlots])?,
        })
    }

    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        let slots = geometry.shapes.bounded();
        let Some(shape) = self.shape else {
            if slots == 0 {
                return Ok(0);
            }
            let (section, found, expected) = (SectionKind::GridShape, 0, 1);
            return Err(BlobError::Count {
                section,
                found,
                expected,
            });
        };
        for (axis, count) in shape.counts().into_iter().enumerate() {
            let [low, high] = geometry.bounds().0[axis];
            let most = if low == high { 1 } else { Divisions::MOST };
            let section = SectionKind::GridShape;
            At { section, index: 0 }.within(Field::Divisions, count.into(), 1, most.into())?;
        }
        Location::Section(SectionKind::GridShape).ensure(shape.spare == 0, Reason::SpareNotZero)?;
        let counts = shape.counts();
        // At most 2^30.
        let expected = counts.into_iter().fold(1, u32::wrapping_mul) as usize;
        if self.lists.len() != expected {
            return Err(BlobError::Count {
                section: SectionKind::GridStarts,
                found: self.lists.len(),
                expected,
            });
        }
        self.lists.check(SectionKind::GridStarts)?;
        self.check_lists(geometry, counts)?;
        Ok(0)
    }
}
