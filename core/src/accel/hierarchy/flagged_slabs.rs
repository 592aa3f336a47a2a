//! Slabs without the planes that coincide with the parent's: [`flagged`](crate::accel::hierarchy::flagged) with slabs
//! in place of boxes.

use crate::accel::cull::Cull;
use crate::accel::cull_axis::Interval;
use crate::accel::hierarchy::pairs::Walk;
use crate::accel::hierarchy::slabs::{
    Forms, SlabPair, SlabPairs, forms, in_order, planes, root_interval,
};
use crate::accel::number::Number;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::{Leaf, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;

/// The hierarchy of slabs with two planes per direction and pair.
#[derive(Clone, Copy, Debug)]
pub enum FlaggedSlabs {}

/// The records of a scene.
pub type Views<'a> = SlabPairs<'a, true>;

impl Traverse for FlaggedSlabs {
    const STRUCTURE: Structure = Structure::FlaggedSlabs;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = Cull;

    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Cull,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let pairs = *views;
        let (forms, start) = (forms(ray, pairs.root.len()), cull.start());
        let walk = Walk {
            geometry,
            pairs,
            root: |limit| root_interval(&forms, pairs.root, start, limit),
            root_planes: 2 * pairs.root.len() as u32,
            narrow: |pair, parent, _| flagged(pair, &forms, parent),
        };
        walk.run::<N, Cull, C>(ray.tmax, stack, count, leaf);
    }
}

/// The intervals of children that lack planes, given their parent's.
#[inline(always)]
fn flagged(pair: SlabPair<'_, true>, forms: &Forms, parent: Interval) -> [Interval; 2] {
    let mut children = [parent; 2];
    let (words, [mut owners, _]) = pair.parts();
    for (form, &word) in forms.iter().zip(words) {
        let [lower, upper] = planes(word);
        let (near, far) = in_order(form, (lower, owners & 1), (upper, owners >> 1 & 1));
        let entered = &mut children[(near.1 & 1) as usize];
        entered.near = entered.near.max(form.entry(near.0));
        let left = &mut children[(far.1 & 1) as usize];
        left.far = left.far.min(form.exit(far.0));
        owners >>= 2;
    }
    children
}
