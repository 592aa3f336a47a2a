//! All hits of a ray, in no order, for callers whose memory grows: one walk, whatever their number.

use crate::accel::{Accel, Number, StackView};
use crate::query::all_hits::{Entry, collect_every};
use crate::query::hit::PrimitiveHit;
use crate::ray::Ray;
use crate::scene::Scene;
use core::cmp::Ordering;

/// A hit that compares by its place in the order of all hits of its ray.
#[derive(Clone, Copy, Debug)]
pub struct OrderedHit<N: Number>(Entry<N>);

impl<N: Number> OrderedHit<N> {
    /// Returns the hit.
    pub fn hit(&self) -> &PrimitiveHit<N> {
        &self.0.hit
    }
}

impl<N: Number> PartialEq for OrderedHit<N> {
    fn eq(&self, other: &Self) -> bool {
        self.0.order == other.0.order
    }
}

impl<N: Number> PartialOrd for OrderedHit<N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.order.partial_cmp(&other.0.order)
    }
}

/// Calls a function with all hits of a ray in its interval, in no order. Some structures list a primitive in several
/// cells, and such a hit can come more than once. Only with the feature `std`.
///
/// Costs one walk without end, where [`all_hits`](crate::all_hits) costs less for the first few hits, and a walk for
/// every list of the others. `stack` needs [`stack_depth`](Scene::stack_depth) entries.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{DualSplit, HitList, NoCount, OrderedHit, Ray, Scene, Stack, all_hits, every_hit};
///
/// let scene = Scene::from_bytes(BLOB)?;
/// let mut stack = Stack::<32>::new();
/// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
/// let mut hits = Vec::new();
/// every_hit::<f32, DualSplit>(&scene, &down, stack.as_view(), &mut |hit| hits.push(hit));
/// hits.sort_by(|a, b| a.partial_cmp(b).expect("t is a number"));
/// hits.dedup();
/// let mut list = HitList::<f32, 64>::new();
/// all_hits::<f32, DualSplit, _, 64>(&scene, &down, stack.as_view(), &mut list, &mut NoCount);
/// assert!(hits.iter().map(OrderedHit::hit).eq(list.iter()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn every_hit<N: Number, A: Accel>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    visit: &mut dyn FnMut(OrderedHit<N>),
) {
    collect_every::<N, A>(scene, ray, stack, &mut |entry| visit(OrderedHit(entry)));
}
