//! All hits of a ray, in order, as many at a time as the caller's list can hold.
//!
//! Hits are ordered by t, then by instance and primitive; of a solid the entry comes before the exit. A walk through
//! the structure keeps the first hits behind the last one of the previous list. So nothing is listed twice, even where
//! a structure lists a primitive in several cells, and nothing is lost between two lists.

use crate::accel::{Accel, Number, StackView};
use crate::format::limits::{INSTANCES, UNBOUNDED};
use crate::geometry::{LATER, LEAVING, Part, PrimitiveId};
use crate::instances::map::PlacedRay;
#[cfg(feature = "std")]
use crate::observe::count::NoCount;
use crate::observe::count::Observer;
use crate::query::candidate::Candidate;
use crate::query::collect::Collect;
use crate::query::hit::{InInstance, PrimitiveHit};
use crate::query::instances;
use crate::query::search::search_structure;
use crate::query::unbounded;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::InstancesOnly;
use heapless::{Vec, VecView};

/// The order of hits: first by t as counted from the ray's start, then by t as the caller counts it. Then by instance
/// (none first), primitive, and end of a solid.
type Order<N> = (
    N,
    <N as crate::number::Scalar>::Wide,
    [u32; 2],
    (u32, u8, u32),
    u8,
);

/// A hit with its place in the order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<N: Number> {
    pub(super) order: Order<N>,
    pub(super) hit: PrimitiveHit<N>,
}

/// A list for some of the hits of a ray, in order. [`all_hits`] fills it and continues from it.
///
/// `SIZE` is at least 1. An entry takes at most 88 bytes in `f32`, 96 in `fixed` and 128 in `f64`. A list of `k` entries
/// that is filled once holds the nearest `k` hits.
///
/// A list goes on behind its last hit, whatever the ray: [`clear`](Self::clear) it before another ray, and before the
/// same ray in a scene that has moved.
#[derive(Debug)]
pub struct HitList<N: Number, const SIZE: usize> {
    entries: Vec<Entry<N>, SIZE>,
    last: Option<Order<N>>,
    is_done: bool,
}

impl<N: Number, const SIZE: usize> Default for HitList<N, SIZE> {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Number, const SIZE: usize> HitList<N, SIZE> {
    /// Returns an empty list, to begin with a ray's first hit.
    pub const fn new() -> Self {
        const { assert!(SIZE > 0, "a list of hits has at least one entry") };
        Self {
            entries: Vec::new(),
            last: None,
            is_done: false,
        }
    }

    /// Empties the list, to begin with the first hit of another ray.
    pub fn clear(&mut self) {
        *self = Self::new();
    }

    /// Number of hits that were listed last.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns true if no hit was listed last.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Returns the hits that were listed last, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &PrimitiveHit<N>> {
        self.entries.iter().map(|entry| &entry.hit)
    }
}

/// Lists the hits of a ray in its interval: the first ones, and at each later call with the list, those behind them.
/// Returns true if more hits are possible, because the list is full.
///
/// Hits are ordered by t, counted from where the ray enters the scene's box: from far away that is finer than the t
/// which is returned. At the same t those of the scene's own objects come first, then those of instances in scene-file
/// order. Then the primitive that comes first in the scene file counts, and the entry into a solid before the exit. All
/// structures return this order and the same bits.
///
/// Every crossing is a hit. Spheres, boxes and other solids have an entry and an exit, even if both have the same t; a
/// torus has up to four crossings. Triangles follow the half-open rule. A ray through an edge or a vertex of a closed
/// mesh hits as many triangles as a ray next to it. So the number of hits of a whole line is even.
///
/// [`closest_hit`](crate::closest_hit) follows the closed rule instead. It can report an edge that the ray only
/// touches, at a silhouette or the border of an open mesh, where this function lists nothing. A hit that both report
/// has the same bits. Only `closest_hit` can miss a hit in the plane where the scene's box begins, because of rounding.
/// A ray that lies in the plane of a triangle does not hit it in the closed rule. Where rounding turns the ray out of the
/// plane, this function can list the triangle, at a t within its box that can be far off: the number of hits of a closed
/// mesh stays even with it. Of two hits of one instance at the same t, the primitive that comes first counts here, and
/// for `closest_hit` the one that is nearer in the part.
///
/// `stack` needs [`stack_depth`](Scene::stack_depth) entries. Each call walks through the structure once, so each list
/// costs as much as a ray without end. Clear a list before it serves another ray.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{DualSplit, HitList, NoCount, Ray, Scene, Stack, all_hits};
///
/// let scene = Scene::from_bytes(BLOB)?;
/// let mut stack = Stack::<32>::new();
/// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
/// let (mut list, mut ts) = (HitList::<f32, 2>::new(), Vec::new());
/// loop {
///     let more = all_hits::<f32, DualSplit, _, 2>(&scene, &down, stack.as_view(), &mut list, &mut NoCount);
///     ts.extend(list.iter().map(|hit| hit.t));
///     if !more {
///         break;
///     }
/// }
/// // Into a ball and out of it, and whatever lies below.
/// assert!(ts.len() >= 2 && ts.is_sorted());
/// // The nearest two of another ray.
/// list.clear();
/// let up = Ray::<f32>::from_f64(scene.bounds(), [0.0, -1e6, 0.0], [0.0, 1.0, 0.0], 0.0, 1e9)?;
/// all_hits::<f32, DualSplit, _, 2>(&scene, &up, stack.as_view(), &mut list, &mut NoCount);
/// assert_eq!(list.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn all_hits<N: Number, A: Accel, C: Observer, const SIZE: usize>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    list: &mut HitList<N, SIZE>,
    count: &mut C,
) -> bool {
    list.entries.clear();
    if list.is_done {
        return false;
    }
    let mut collector = Collector {
        entries: list.entries.as_mut_view(),
        after: list.last,
        start_t: ray.start_t,
        placed: None,
        #[cfg(feature = "std")]
        every: None,
    };
    collect::<N, A, C>(scene, ray, &mut collector, stack, count);
    list.last = list.entries.last().map(|entry| entry.order);
    list.is_done = !list.entries.is_full();
    !list.is_done
}

/// Entries of the lists with which hits are counted.
pub(super) const COUNTED: usize = 16;

/// Returns the number of hits of a ray in its interval, as [`all_hits`] lists them.
///
/// For a closed mesh, a whole line has an even number of hits. A ray has an odd number if it begins inside and ends
/// outside. `stack` needs [`stack_depth`](Scene::stack_depth) entries. The cost is that of a ray without end, for every
/// 16 hits. A list of as many lies on the call stack, which takes up to 1.8 KiB more in `fixed` and `f32` than for a
/// closest hit, and 2.3 KiB in a build with all features.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{DualSplit, NoCount, Ray, Scene, Stack, count_hits};
///
/// let scene = Scene::from_bytes(BLOB)?;
/// let mut stack = Stack::<32>::new();
/// let up = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, 1.0, 0.0], 0.0, 1e9)?;
/// assert_eq!(count_hits::<f32, DualSplit, _>(&scene, &up, stack.as_view(), &mut NoCount), 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn count_hits<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
) -> u32 {
    let mut list = HitList::<N, COUNTED>::new();
    let mut hits = 0_u32;
    loop {
        let more = all_hits::<N, A, C, COUNTED>(scene, ray, stack, &mut list, count);
        hits = hits.saturating_add(list.len() as u32);
        if !more {
            return hits;
        }
    }
}

/// Lists hits behind the last one.
struct Collector<'l, N: Number> {
    entries: &'l mut VecView<Entry<N>>,
    /// The last hit that was listed before.
    after: Option<Order<N>>,
    /// The t of the ray's start.
    start_t: N::Wide,
    /// The instance that is searched; none for the scene's own objects.
    placed: Option<PlacedSearch<N>>,
    /// Takes all hits, in any order, in place of the list.
    #[cfg(feature = "std")]
    every: Option<&'l mut dyn FnMut(Entry<N>)>,
}

/// The instance that is searched.
#[derive(Clone, Copy)]
struct PlacedSearch<N: Number> {
    mapped: PlacedRay<N>,
    index: u32,
    number: u32,
    first_primitive: u32,
    /// The interval of the scene's ray.
    interval: [N; 2],
}

impl<N: Number> Collector<'_, N> {
    /// Inserts a hit in order, unless it was listed before.
    fn insert(&mut self, order: Order<N>, hit: PrimitiveHit<N>) {
        #[cfg(feature = "std")]
        if let Some(every) = &mut self.every {
            every(Entry { order, hit });
            return;
        }
        if self.after.as_ref().is_some_and(|after| order <= *after) {
            return;
        }
        let before = |entry: &&Entry<N>| order <= entry.order;
        let behind = self.entries.iter().rev().take_while(before).count();
        let place = self.entries.len().saturating_sub(behind);
        let next = self.entries.get(place);
        if next.is_some_and(|next| next.order == order) {
            return;
        }
        if self.entries.is_full() {
            if behind == 0 {
                return;
            }
            self.entries.pop();
        }
        let inserted = self.entries.insert(place, Entry { order, hit });
        debug_assert!(inserted.is_ok(), "there is room");
    }

    /// The t beyond which hits are ignored; `None` while the list is not full.
    fn limit(&self) -> Option<N> {
        let last = self.entries.last().filter(|_| self.entries.is_full());
        last.map(|last| last.order.0)
    }
}

impl<N: Number> Collect<N> for &mut Collector<'_, N> {
    const ALL: bool = true;

    fn is_any(&self) -> bool {
        !self.entries.is_empty()
    }

    fn is_at(&self, place: PrimitiveId) -> bool {
        let mut entries = self.entries.iter();
        entries.any(|entry| entry.hit.best.place == place)
    }

    fn commit(&mut self, scene: &Scene<'_>, (t, part): (N, Part), place: PrimitiveId) -> Option<N> {
        let best = Candidate::new((t, part), place);
        let key = scene.key(place);
        // In first, out, in again, out.
        let end = u8::from(part & LATER != 0) << 1 | u8::from(part & LEAVING != 0);
        let Some(placed) = self.placed else {
            let far = t.widen() + self.start_t;
            let hit = PrimitiveHit {
                t: far,
                primitive: key.0,
                best,
                placed: InstancesOnly::new(|| None),
            };
            self.insert((t, far, [0; 2], key, end), hit);
            return self.limit();
        };
        let [tmin, tmax] = placed.interval;
        let in_scene = placed
            .mapped
            .t_in_scene(t.widen() + placed.mapped.ray.start_t);
        let t = tmax.min(tmin.max(in_scene));
        let far = t.widen() + self.start_t;
        let index = placed.index;
        let hit = PrimitiveHit {
            t: far,
            primitive: placed.first_primitive.wrapping_add(key.0),
            best,
            placed: InstancesOnly::new(|| Some(InInstance { index, t })),
        };
        let instance = [placed.number.wrapping_add(1), index];
        self.insert((t, far, instance, key, end), hit);
        // That of the part's ray stays.
        None
    }
}

/// Finds all hits of a ray in one walk, in any order. A hit can come more than once.
#[cfg(feature = "std")]
pub(super) fn collect_every<N: Number, A: Accel>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    every: &mut dyn FnMut(Entry<N>),
) {
    // Empty, it sets no limit to the search.
    let mut unused = Vec::<_, 1>::new();
    let mut collector = Collector {
        entries: unused.as_mut_view(),
        after: None,
        start_t: ray.start_t,
        placed: None,
        every: Some(every),
    };
    collect::<N, A, _>(scene, ray, &mut collector, stack, &mut NoCount);
}

/// Finds the hits of a ray.
#[inline(never)]
fn collect<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    collector: &mut Collector<'_, N>,
    stack: &mut StackView,
    count: &mut C,
) {
    if C::ENABLED {
        count.event(ray.query(false));
    }
    if UNBOUNDED && scene.has_unbounded {
        unbounded::each(scene, ray, count, |far| {
            let unbounded::FarHit {
                after_start,
                t,
                place,
            } = far;
            // Farther than kernels count, the t that the caller counts decides.
            let near = ray.tmax.min(after_start);
            let best = Candidate::new((near, 0), place);
            let key = scene.key(place);
            let hit = PrimitiveHit {
                t,
                primitive: key.0,
                best,
                placed: InstancesOnly::new(|| None),
            };
            collector.insert((near, t, [0; 2], key, 0), hit);
            false
        });
    }
    if scene.has_own() {
        search_structure::<N, A, C, _, false>(scene, ray, &mut *collector, stack, count, false);
    }
    if INSTANCES && !scene.instances().is_empty() {
        let tmax = collector.limit();
        instances::each(scene, ray, tmax, count, |entered, count| {
            let instances::Entered {
                part,
                mapped,
                index,
                number,
                first_primitive,
            } = entered;
            collector.placed = Some(PlacedSearch {
                mapped,
                index,
                number,
                first_primitive,
                interval: [ray.tmin, ray.tmax],
            });
            search_structure::<N, A, C, _, false>(
                part,
                &mapped.ray,
                &mut *collector,
                stack,
                count,
                false,
            );
            collector.limit()
        });
        collector.placed = None;
    }
}
