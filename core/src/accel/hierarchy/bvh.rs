//! The bounding volume hierarchy with ordinary traversal: all planes of both children are tested.

use crate::accel::cull::PairCulling;
use crate::accel::hierarchy::pairs::{BoxPair, Pairs, Walk};
use crate::accel::number::Number;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::link::Node;
use crate::format::record::{Pair, UnitBox};
use crate::format::{Leaf, SectionKind, Structure};
use crate::observe::count::Observer;
use crate::observe::event::Sides;
use crate::ray::Ray;

/// The hierarchy with 32 bytes per pair; twelve planes are tested per pair.
#[derive(Clone, Copy, Debug)]
pub enum Bvh {}

/// The records of a scene.
pub type Views<'a> = Pairs<'a, Pair>;

impl Traverse for Bvh {
    const STRUCTURE: Structure = Structure::Bvh;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = N::Cull;

    #[inline]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &N::Cull,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        walk(geometry, views, ray, cull, stack, count, leaf);
    }
}

/// [`Bvh`]'s walk with any form of culling. Where floats cull in SIMD registers, the margins of
/// [`Cull`](crate::accel::cull::Cull) are those of the flagged hierarchy. Only equal margins allow a comparison of the
/// two, plane for plane.
#[doc(hidden)]
#[expect(clippy::too_many_arguments, reason = "its arguments stay in registers")]
#[inline]
pub fn walk<N: Number, K: PairCulling<N>, C: Observer>(
    geometry: &SceneGeometry<'_>,
    pairs: &Pairs<'_, Pair>,
    ray: &Ray<N>,
    cull: &K,
    stack: &mut StackView,
    count: &mut C,
    leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
) {
    let walk = Walk {
        geometry,
        pairs: *pairs,
        root: |limit| cull.root(geometry.bounds(), limit),
        root_planes: 6,
        narrow: |pair: &Pair, _, limit| cull.children(pair, limit),
    };
    walk.run::<N, K, C>(ray.tmax, stack, count, leaf);
}

impl BoxPair for Pair {
    const SECTION: SectionKind = SectionKind::Pairs;
    const PLANES: u32 = 12;

    #[inline(always)]
    fn child(&self, _: u32, side: u32) -> Node {
        Node(self.children[(side & 1) as usize])
    }

    fn sides(&self) -> [Sides; 2] {
        [0, 1].map(|child| self.planes.map(|axis| axis.map(|side| Some(side[child]))))
    }

    fn boxes(&self, _: &UnitBox) -> [UnitBox; 2] {
        [self.child_box(0), self.child_box(1)]
    }
}
