//! The bounding volume hierarchy with ordinary traversal: all planes of both children are tested.

use super::cull::{Cull, Interval};
use super::pairs::{PairRecord, walk};
use super::{Accel, Leaf, Link, StackView, Structure};
use crate::blob::record::{Pair, UnitBox};
use crate::blob::{Scene, SectionKind};
use crate::count::Count;

/// The hierarchy with 28 bytes a pair; twelve planes are tested a pair.
#[derive(Clone, Copy, Debug)]
pub enum Bvh {}

impl Accel for Bvh {
    const STRUCTURE: Structure = Structure::Bvh;

    #[inline]
    fn walk<C: Count>(
        scene: &Scene<'_>,
        cull: &Cull,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> i32,
    ) {
        walk(scene, scene.pairs, cull, stack, count, leaf);
    }
}

impl PairRecord for Pair {
    const SECTION: SectionKind = SectionKind::Pairs;
    const PLANES: u32 = 12;

    #[inline(always)]
    fn link(&self) -> Link {
        Link(self.link)
    }

    fn boxes(&self, _: &UnitBox) -> [UnitBox; 2] {
        self.planes.map(|words| UnitBox(words.map(|word| [word as i16, (word >> 16) as i16])))
    }

    #[inline(always)]
    fn narrow(&self, _: Interval, cull: &Cull, limit: i32) -> [Interval; 2] {
        [
            cull.clip(&self.planes[0], cull.start, limit),
            cull.clip(&self.planes[1], cull.start, limit),
        ]
    }
}
