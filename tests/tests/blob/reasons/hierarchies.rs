//! Nodes, leaves, strips and packs of the hierarchies.

use super::{Errors, LEAF, alone, balls, everything};
use gridel_core::Structure;
use gridel_core::format::record::{DualNode, FlaggedPair, Pair, WideNode};
use gridel_core::format::{Child, Field, Kind, Leaf, Link, Reason, SectionKind};
use gridel_tests::fuzz::Base;
use gridel_tests::scenes;

pub(super) fn hierarchies() -> Errors {
    let mut errors = everything();
    let pairs = errors.base.records(SectionKind::Pairs);
    let mut base = errors.base.clone();
    let mut pair = |number| base.record::<Pair>(SectionKind::Pairs, number);
    let change = |it: &mut Base, number: usize, forge: &dyn Fn(&mut Pair)| {
        it.change(SectionKind::Pairs, number, forge)
    };
    errors.field("pair 0 of bvh", Field::Child, |it| {
        change(it, 0, &|it| it.children[0] = 9)
    });
    errors.field("pair 0 of bvh", Field::Leaf, |it| {
        change(it, 0, &|it| it.children[0] = LEAF | 9)
    });
    errors.reason("pair 1 of bvh", Reason::NotReached, |it| {
        change(it, 0, &|it| it.children = [LEAF, LEAF | 1])
    });
    let last = pairs - 1;
    let [left, _] = pair(last).children;
    let place = format!("pair {last} of bvh");
    errors.reason(&place, Reason::BeyondLast, |it| {
        change(it, last, &|it| it.children = [pairs as u32, left])
    });
    for (side, reason) in [Reason::LeftOutside, Reason::RightOutside]
        .into_iter()
        .enumerate()
    {
        errors.reason("pair 0 of bvh", reason, |it| {
            change(it, 0, &|it| it.planes[0][0][side] = -i16::MAX)
        });
    }
    errors.reason("pair 0 of flagged", Reason::RightOutside, |it| {
        it.change(SectionKind::FlaggedPairs, 0, |it: &mut FlaggedPair| {
            it.link = Link(it.link).with_owners(1).0;
            it.planes[0] = it.planes[0] & 0xffff_0000 | 0x8001;
        })
    });
    let above = (0..pairs).find(|&number| pair(number).children[0] & LEAF != 0);
    let above = above.expect("a leaf");
    let place = format!("pair {above} of bvh");
    errors.reason(&place, Reason::PrimitiveOutside, |it| {
        change(it, above, &|it| {
            for [low, high] in &mut it.planes {
                high[0] = low[0];
            }
        })
    });
    let dual = |it: &mut Base, number: usize, forge: &dyn Fn(&mut DualNode)| {
        it.change(SectionKind::DualNodes, number, forge)
    };
    errors.reason("node 0 of dual-split", Reason::UnusedBits, |it| {
        dual(it, 0, &|it| it.word |= 1 << 30)
    });
    let nodes = errors.base.records(SectionKind::DualNodes);
    let mut base = errors.base.clone();
    let mut node = |number| base.record::<DualNode>(SectionKind::DualNodes, number);
    let leaf = (0..nodes).find(|&number| node(number).word >> 24 & 3 == 3);
    let leaf = leaf.expect("a leaf");
    let place = format!("node {leaf} of dual-split");
    errors.reason(&place, Reason::PrimitiveOutsideRegion, |it| {
        dual(it, leaf, &|it| {
            // Cut down to nothing on the x axis.
            it.word &= !(15 << 26);
            it.word |= 3 << 28;
            it.carves[0] = 0x8000_7fff;
        })
    });
    errors
}

/// Returns a hierarchy of 49 levels with a leaf at each.
pub(super) fn deep_hierarchy() -> Errors {
    const LEAVES: u32 = 50;
    let mut errors = alone(&scenes::of(balls(LEAVES)), Structure::Bvh, 24);
    let leaves = (0..LEAVES).map(|first| {
        let (kind, count) = (Kind::Sphere, 1);
        Leaf { kind, first, count }.to_word()
    });
    let pair = errors.base.record::<Pair>(SectionKind::Pairs, 0);
    let pairs = (0..LEAVES - 1).map(|number| Pair {
        children: match number {
            number if number + 2 < LEAVES => [LEAF | number, number + 1],
            number => [LEAF | number, LEAF | (number + 1)],
        },
        ..pair
    });
    let leaves: Vec<u32> = leaves.collect();
    let pairs: Vec<Pair> = pairs.collect();
    errors.field("section pairs", Field::Levels, |it| {
        it.header().longest_leaf = 1;
        *it.bytes(SectionKind::Leaves) = bytemuck::cast_slice(&leaves).to_vec();
        *it.bytes(SectionKind::Pairs) = bytemuck::cast_slice(&pairs).to_vec();
    });
    errors
}

/// Returns a hierarchy of one leaf, without pairs, whose width is that of the directions.
pub(super) fn slabs() -> Errors {
    let mut errors = alone(&scenes::of(balls(1)), Structure::Slabs, 24);
    errors.reason("section slab-root", Reason::DirectionCount, |it| {
        it.bytes(SectionKind::SlabRoot).truncate(8)
    });
    errors
}

pub(super) fn wide_hierarchies() -> Errors {
    let shapes = balls(12).chain([scenes::sheet(7)]);
    let mut errors = alone(&scenes::of(shapes), Structure::Wide, 16);
    let byte = |it: &mut Base, kind, place: usize, forge: &dyn Fn(u8) -> u8| {
        let bytes = it.section(kind);
        bytes[place] = forge(bytes[place]);
    };
    errors.field("strip 0 of wide", Field::FirstMember, |it| {
        byte(it, SectionKind::Strips, 48, &|first| first + 1)
    });
    errors.reason("strip 0 of wide", Reason::UnknownArrangement, |it| {
        byte(it, SectionKind::Strips, 51, &|corners| corners | 7)
    });
    // Eight spheres in the first pack and four in the second; a radius takes two bytes.
    assert_eq!(errors.base.records(SectionKind::Packs), 2);
    let radii = |it: &mut Base, pack: usize, places: std::ops::Range<usize>, value: u8| {
        let start = 64 * pack + 48;
        it.section(SectionKind::Packs)[start..start + 16][places].fill(value);
    };
    errors.field("pack 0 of wide", Field::Radius, |it| {
        radii(it, 0, 0..2, 0xff)
    });
    errors.reason("pack 1 of wide", Reason::EmptyPack, |it| {
        radii(it, 1, 0..16, 0)
    });
    errors.reason("pack 0 of wide", Reason::PartialPack, |it| {
        radii(it, 0, 14..16, 0)
    });
    errors.reason("pack 1 of wide", Reason::RadiusAfterLast, |it| {
        radii(it, 1, 14..16, 1)
    });
    errors.field("member 0 of wide", Field::Primitive, |it| {
        it.set(SectionKind::Members, 0, u32::MAX)
    });
    let nodes = errors.base.records(SectionKind::WideNodes);
    let node = |it: &mut Base, number: usize, forge: &dyn Fn(&mut WideNode)| {
        it.change(SectionKind::WideNodes, number, forge)
    };
    let root = "node 0 of wide";
    let cluster = |kind, first, count| Leaf { kind, first, count }.to_word();
    errors.field(root, Field::Child, |it| {
        node(it, 0, &|it| it.children[0] = Child::node(9).0)
    });
    errors.field(root, Field::Leaf, |it| {
        let leaf = cluster(Kind::Triangle, 9, 0);
        node(it, 0, &|it| it.children[0] = leaf)
    });
    errors.field(root, Field::LeafKind, |it| {
        node(it, 0, &|it| it.children[0] = 6 << 29)
    });
    for (kind, count) in [(Kind::Triangle, 1), (Kind::Box, 0), (Kind::Box, 2)] {
        let leaf = cluster(kind, 0, count);
        errors.field(root, Field::LeafSlots, |it| {
            node(it, 0, &|it| it.children[0] = leaf)
        });
    }
    errors.reason(root, Reason::NoChild, |it| {
        node(it, 0, &|it| it.children[0] = Child::NONE.0)
    });
    errors.reason(root, Reason::ChildOutside, |it| {
        node(it, 0, &|it| it.planes[0][0][0] = -i16::MAX)
    });
    let mut base = errors.base.clone();
    let mut read = |number| base.record::<WideNode>(SectionKind::WideNodes, number);
    let is_none = |child: &u32| *child == Child::NONE.0;
    let with_gap = (0..nodes).find(|&number| read(number).children.iter().any(is_none));
    let with_gap = with_gap.expect("a node of fewer than eight children");
    let first_gap = read(with_gap).children.iter().position(is_none);
    let first_gap = first_gap.expect("a lane without a child");
    let place = format!("node {with_gap} of wide");
    errors.reason(&place, Reason::LaneNotEmpty, |it| {
        node(it, with_gap, &|it| it.planes[1][0][first_gap] = 0)
    });
    let crowded = (0..nodes).find(|&number| read(number).children[2] != Child::NONE.0);
    let crowded = crowded.expect("a node of three children");
    let place = format!("node {crowded} of wide");
    errors.reason(&place, Reason::ChildAfterGap, |it| {
        node(it, crowded, &|it| {
            it.children[1] = Child::NONE.0;
            for [low, high] in &mut it.planes {
                (low[1], high[1]) = (i16::MAX, i16::MIN);
            }
        })
    });
    let last = nodes - 1;
    let place = format!("node {last} of wide");
    let children = read(last).children;
    let end = children.iter().position(is_none).unwrap_or(8) - 1;
    errors.reason(&place, Reason::BeyondLast, |it| {
        node(it, last, &|it| {
            it.children[end] = Child::node(nodes as u32).0
        })
    });
    let mut shared = everything();
    shared.reason("slot location 0 of wide", Reason::WrongSlotLocation, |it| {
        it.set(SectionKind::SlotLocations, 0, u32::MAX)
    });
    errors.reasons.append(&mut shared.reasons);
    errors.failures.append(&mut shared.failures);
    errors
}
