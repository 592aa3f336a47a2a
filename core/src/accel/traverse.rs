//! The walk of a structure.

use crate::accel::cull::Culling;
use crate::accel::number::Number;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::format::{Leaf, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;
use crate::target::SMALL;

/// The walk of a structure.
pub trait Traverse: Send + Sync {
    /// Its name; the list's if it has none.
    const STRUCTURE: Structure;
    /// The form in which its rays cull.
    type Cull<N: Number>: Culling<N>;
    /// Its records in a blob.
    type Views<'a>: Copy;
    /// True if its leaves can be [clusters](crate::format::cluster). Code for clusters is only compiled where this is
    /// true.
    const HAS_CLUSTERS: bool = false;
    /// True if one copy of a query's code serves the closest hit and any hit. That is less code, and costs a branch per
    /// leaf.
    const ONE_COPY: bool = SMALL;

    /// The structure that a blob must hold for the walk.
    fn needs(_: &SceneGeometry<'_>) -> Structure {
        Self::STRUCTURE
    }

    /// Calls `leaf` for every leaf whose box the ray can hit, nearer ones first where the structure knows the order.
    /// `leaf` returns the t beyond which hits are ignored, or `None` to end the walk.
    #[expect(clippy::too_many_arguments, reason = "its arguments stay in registers")]
    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Self::Cull<N>,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    );

    /// Calls `hits` for leaves whose box the ray can hit, in any order, up to the first for which it is true.
    #[expect(clippy::too_many_arguments, reason = "its arguments stay in registers")]
    #[inline(always)]
    fn walk_any<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Self::Cull<N>,
        stack: &mut StackView,
        count: &mut C,
        mut hits: impl FnMut(Leaf, &mut C) -> bool,
    ) {
        let tmax = ray.tmax;
        Self::walk(geometry, views, ray, cull, stack, count, |leaf, count| {
            (!hits(leaf, count)).then_some(tmax)
        });
    }
}
