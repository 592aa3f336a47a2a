//! Cells and lists of candidates.

use super::{Errors, Forgery, LEAF, everything};
use gridel_core::format::record::{ApexDirection, ApexPoint, ApexWindow, GridShape, Gridels};
use gridel_core::format::{Field, Reason, SectionKind};
use gridel_tests::fuzz::Base;

pub(super) fn cells() -> Errors {
    let mut errors = everything();
    let shape = "section grid-shape";
    errors.field(shape, Field::Divisions, |it| {
        it.change(SectionKind::GridShape, 0, |it: &mut GridShape| {
            it.divisions[2] = 0
        })
    });
    errors.reason(shape, Reason::SpareNotZero, |it| {
        it.change(SectionKind::GridShape, 0, |it: &mut GridShape| it.spare = 1)
    });
    errors.field("list 1 of grid", Field::FirstEntry, |it| {
        it.set(SectionKind::GridStarts, 1, u32::MAX)
    });
    let (lists, entries) = (
        errors.base.records(SectionKind::GridStarts) - 1,
        errors.base.records(SectionKind::GridSlots),
    );
    errors.field("section grid-slots", Field::Entries, |it| {
        let stride = it.bytes(SectionKind::GridSlots).len() / entries;
        it.bytes(SectionKind::GridSlots)
            .extend(std::iter::repeat_n(0, stride));
        it.set(SectionKind::GridStarts, lists, entries as u32 + 1);
    });
    errors.field("node 1 of octree", Field::List, |it| {
        it.set(SectionKind::OctreeNodes, 1, LEAF | 99_999)
    });
    errors.field("node 0 of octree", Field::Child, |it| {
        it.set(SectionKind::OctreeNodes, 0, 9)
    });
    // Eight nodes on each of seven levels; the first of each has children.
    errors.field("section octree-nodes", Field::Levels, |it| {
        let mut nodes = vec![1];
        for level in 0..7 {
            let first = if level < 6 { 9 + 8 * level } else { u32::MAX };
            nodes.push(first);
            nodes.extend([u32::MAX; 7]);
        }
        *it.bytes(SectionKind::OctreeNodes) = bytemuck::cast_slice(&nodes).to_vec();
    });
    let slots = errors.base.records(SectionKind::Order) as u32;
    let all = |kind, errors: &Errors| {
        let entries = errors.base.records(kind);
        (0..entries).flat_map(move |index| (0..slots).map(move |slot| (index, slot)))
    };
    let forgeries = all(SectionKind::GridSlots, &errors);
    errors.one_of(Reason::MissingPrimitive, forgeries, |it, index, slot| {
        it.set(SectionKind::GridSlots, index, slot)
    });
    for reason in [Reason::OutsideCell, Reason::SlotOrder] {
        let forgeries = all(SectionKind::OctreeSlots, &errors);
        errors.one_of(reason, forgeries, |it, index, slot| {
            it.set(SectionKind::OctreeSlots, index, slot)
        });
    }
    errors
}

pub(super) fn candidates() -> Errors {
    let mut errors = everything();
    errors.reason("section cylinder-gridels", Reason::WrongPartition, |it| {
        it.change(SectionKind::CylinderGridels, 0, |it: &mut Gridels| {
            it.low[0] += 1
        })
    });
    errors.field("cell 0 of cylinder-cube", Field::List, |it| {
        it.set(SectionKind::CylinderCells, 0, u32::MAX)
    });
    errors.field("list 0 of cylinder-cube-tight", Field::FirstEntry, |it| {
        it.set(SectionKind::TightStarts, 0, 1)
    });
    errors.field("entry 0 of cylinder-cube-entry", Field::Candidate, |it| {
        it.set(SectionKind::EntryNodes, 0, u32::MAX)
    });
    let keys = errors.base.records(SectionKind::TightKeys);
    let pairs = (1..keys).map(|index| (index, 0));
    errors.one_of(Reason::KeyOrder, pairs, |it, index, _| {
        it.set(SectionKind::TightKeys, index - 1, 0xff);
        it.set(SectionKind::TightKeys, index, 0);
    });
    let point = |it: &mut Base, forge: &dyn Fn(&mut ApexPoint)| {
        it.change(SectionKind::ApexPoints, 0, forge)
    };
    errors.field("point 0 of apex", Field::Coordinate, |it| {
        point(it, &|it| it.at[0] = i32::MIN)
    });
    errors.field("point 0 of apex", Field::Window, |it| {
        point(it, &|it| it.windows[3] = 0xfff0)
    });
    let directions: [Forgery<ApexDirection>; 3] = [
        (Field::Plane, &|it| it.plane = i32::MIN),
        (Field::MajorAxis, &|it| it.major = 3),
        (Field::Window, &|it| it.window = 0xffff),
    ];
    for (field, forge) in directions {
        errors.field("direction 0 of apex", field, |it| {
            it.change(SectionKind::ApexDirections, 0, forge)
        });
    }
    let windows: [Forgery<ApexWindow>; 2] = [
        (Field::FirstCell, &|it| it.first_cell = 1),
        (Field::SideCells, &|it| it.cells[1] = 0),
    ];
    for (field, forge) in windows {
        errors.field("window 0 of apex", field, |it| {
            it.change(SectionKind::ApexWindows, 0, forge)
        });
    }
    // A word is a dimension, or 7 for a leaf, and from bit 3 on the first child or the cell.
    let words = [
        (Field::Dimension, 5 | 6 << 3),
        (Field::Child, 99 << 3),
        (Field::Cell, 7 | 99 << 3),
    ];
    for (field, word) in words {
        errors.field("node 0 of ray-classes", field, |it| {
            it.set(SectionKind::ClassNodes, 0, word)
        });
    }
    errors
}
