//! The hierarchy with flagged sides (the paper, section 2.2). Sides that coincide with the parent's are neither
//! stored nor tested.
//!
//! Two children have twelve sides. At least six of them coincide with their parent's, because at least one child
//! touches each of the parent's six sides. The paper flags such sides and does not test them. A pair stores one plane
//! for each side of the parent: that of the child that does *not* touch it. One bit says which child that is (its
//! owner). A ray starts from its interval in the parent and narrows it by six planes instead of twelve.

use crate::accel::cull::{Cull, PairCulling};
use crate::accel::cull_axis::Interval;
use crate::accel::hierarchy::pairs::{BoxPair, Pairs, Walk};
use crate::accel::number::Number;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::link::{Link, Node};
use crate::format::record::{FlaggedPair, UnitBox};
use crate::format::{Leaf, SectionKind, Structure};
use crate::observe::count::Observer;
use crate::observe::event::Sides;
use crate::ray::Ray;

/// The hierarchy with 16 bytes per pair; six planes are tested per pair.
#[derive(Clone, Copy, Debug)]
pub enum Flagged {}

/// The records of a scene.
pub type Views<'a> = Pairs<'a, FlaggedPair>;

impl Traverse for Flagged {
    const STRUCTURE: Structure = Structure::Flagged;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = Cull;

    #[inline]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Cull,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let root = |limit| PairCulling::<N>::root(cull, geometry.bounds(), limit);
        let narrow = |pair: &FlaggedPair, parent, _| narrow(pair, parent, cull);
        let walk = Walk {
            geometry,
            pairs: *views,
            root,
            root_planes: 6,
            narrow,
        };
        walk.run::<N, Cull, C>(ray.tmax, stack, count, leaf);
    }
}

impl BoxPair for FlaggedPair {
    const SECTION: SectionKind = SectionKind::FlaggedPairs;
    const PLANES: u32 = 6;

    #[inline(always)]
    fn child(&self, number: u32, side: u32) -> Node {
        Link(self.link).child(number, side)
    }

    fn sides(&self) -> [Sides; 2] {
        let owners = Link(self.link).owners();
        let mut children = [Sides::default(); 2];
        for (axis, &word) in self.planes.iter().enumerate() {
            children[(owners >> axis & 1) as usize][axis][0] = Some(word as i16);
            children[(owners >> (axis + 3) & 1) as usize][axis][1] = Some((word >> 16) as i16);
        }
        children
    }

    fn boxes(&self, parent: &UnitBox) -> [UnitBox; 2] {
        let owners = Link(self.link).owners();
        let mut children = [*parent; 2];
        for (axis, &word) in self.planes.iter().enumerate() {
            children[(owners >> axis & 1) as usize].0[axis][0] = word as i16;
            children[(owners >> (axis + 3) & 1) as usize].0[axis][1] = (word >> 16) as i16;
        }
        children
    }
}

/// The children's intervals, given their parent's.
#[inline(always)]
fn narrow(pair: &FlaggedPair, parent: Interval, cull: &Cull) -> [Interval; 2] {
    // The child that owns each near and each far plane, as seen by this ray.
    let owners = Link(pair.link).owners();
    let swapped = (owners ^ owners >> 3) & cull.descending();
    let pattern = owners ^ swapped ^ swapped << 3;
    if JUMPS {
        jump(pair, pattern, parent, cull)
    } else {
        select(pair, pattern, parent, cull)
    }
}

/// True where a jump by the owners' pattern is cheap and a conditional move is not: in-order cores without branch
/// prediction.
const JUMPS: bool = cfg!(any(target_arch = "arm", target_arch = "riscv32"));

/// Narrows by conditional moves, for cores with branch mispredictions.
#[inline(always)]
fn select(pair: &FlaggedPair, pattern: u32, parent: Interval, cull: &Cull) -> [Interval; 2] {
    let mut intervals = [parent; 2];
    for (axis, form) in cull.axes.iter().enumerate() {
        let Interval { near, far } = form.around(pair.planes[axis]);
        let right_near = pattern >> axis & 1 != 0;
        let right_far = pattern >> (axis + 3) & 1 != 0;
        let [left, right] = &mut intervals;
        left.near = left.near.max(if right_near { i32::MIN } else { near });
        right.near = right.near.max(if right_near { near } else { i32::MIN });
        left.far = left.far.min(if right_far { i32::MAX } else { far });
        right.far = right.far.min(if right_far { far } else { i32::MAX });
    }
    intervals
}

/// Narrows with one of 64 code paths, chosen by the pattern, so that no test is wasted.
#[inline(always)]
fn jump(pair: &FlaggedPair, pattern: u32, parent: Interval, cull: &Cull) -> [Interval; 2] {
    macro_rules! by_pattern {
        ($($number:literal)*) => {
            match pattern {
                $($number => narrow_by::<$number>(pair, parent, cull),)*
                _ => [parent; 2],
            }
        };
    }
    by_pattern!(
        0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31
        32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61
        62 63
    )
}

/// Narrows for one pattern of owners, known at compile time.
#[inline(always)]
fn narrow_by<const PATTERN: u32>(
    pair: &FlaggedPair,
    parent: Interval,
    cull: &Cull,
) -> [Interval; 2] {
    let mut intervals = [parent; 2];
    for (axis, form) in cull.axes.iter().enumerate() {
        let Interval { near, far } = form.around(pair.planes[axis]);
        let near_owner = &mut intervals[(PATTERN >> axis & 1) as usize];
        near_owner.near = near_owner.near.max(near);
        let far_owner = &mut intervals[(PATTERN >> (axis + 3) & 1) as usize];
        far_owner.far = far_owner.far.min(far);
    }
    intervals
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::cull::Culling;
    use crate::number::Fixed;

    /// Both ways to narrow compute the same function.
    #[test]
    fn jumping_and_selecting_agree() {
        let bounds = UnitBox([[-1000, 1000]; 3]);
        for signs in 0..8 {
            let component =
                |axis: u32| f64::from(axis + 1) * if signs >> axis & 1 == 0 { 1.0 } else { -1.0 };
            let direction = [component(0), component(1), component(2)];
            let ray = Ray::<Fixed>::from_f64(&bounds, [3.0, -7.0, 11.0], direction, 0.0, 1e9);
            let cull = Culling::new(&ray.expect("a ray"));
            let pair = FlaggedPair {
                planes: [0x0123_ff00, 0x0040_ffc0, 0x0300_0100],
                link: 0,
            };
            let parent = Interval {
                near: -40,
                far: 900,
            };
            for pattern in 0..64 {
                assert_eq!(
                    select(&pair, pattern, parent, &cull),
                    jump(&pair, pattern, parent, &cull)
                );
            }
        }
    }
}
