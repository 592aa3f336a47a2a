//! All hits of a ray, in a list as long as they need.

use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, HitList, NoCount, Number, OrderedHit, PrimitiveHit, Ray, Scene, Stack, all_hits,
    every_hit,
};
use std::cmp::Ordering;
use std::ops::ControlFlow;

/// Hits of most rays. A walk through the scene that fills this list ends early.
const FEW: usize = 16;

/// Hits up to which such a walk takes less time than one that finds all.
const MANY: usize = 64;

/// Lists hits of ray after ray. All of a ray are found in one walk where they are more than a few, so that its time is
/// nearly linear in their number.
pub struct Lists<N: Number> {
    stack: Stack<MAX_STACK_DEPTH>,
    many: HitList<N, MANY>,
    every: Vec<OrderedHit<N>>,
    /// Hits of a ray that are needed.
    most: usize,
}

impl<N: Number> Lists<N> {
    /// Room for the hits of a ray, of which at most so many are needed.
    pub fn new(most: usize) -> Box<Self> {
        Box::new(Self {
            stack: Stack::new(),
            many: HitList::new(),
            every: Vec::new(),
            most,
        })
    }

    /// Calls a function with the hits of a ray in order, until it breaks off.
    #[inline(always)]
    pub fn each<A: Accel>(
        &mut self,
        scene: &Scene<'_>,
        ray: &Ray<N>,
        mut hit: impl FnMut(&PrimitiveHit<N>) -> ControlFlow<()>,
    ) {
        let mut few = HitList::<N, FEW>::new();
        let stack = self.stack.as_view();
        let more = all_hits::<N, A, _, FEW>(scene, ray, stack, &mut few, &mut NoCount);
        if few.iter().try_for_each(&mut hit).is_continue() && more {
            self.each_behind::<A>(scene, ray, &mut hit);
        }
    }

    /// Calls a function with the hits behind the first few.
    #[cold]
    #[inline(never)]
    fn each_behind<A: Accel>(
        &mut self,
        scene: &Scene<'_>,
        ray: &Ray<N>,
        hit: &mut dyn FnMut(&PrimitiveHit<N>) -> ControlFlow<()>,
    ) {
        if self.most <= FEW {
            return;
        }
        let stack = self.stack.as_view();
        let _ = if self.most <= MANY {
            self.many.clear();
            all_hits::<N, A, _, MANY>(scene, ray, stack, &mut self.many, &mut NoCount);
            self.many.iter().skip(FEW).try_for_each(hit)
        } else {
            let every = &mut self.every;
            every.clear();
            every_hit::<N, A>(scene, ray, stack, &mut |hit| every.push(hit));
            every.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
            // A structure can list a primitive in several cells.
            every.dedup();
            let mut behind = every.iter().skip(FEW);
            behind.try_for_each(|found| hit(found.hit()))
        };
    }
}
