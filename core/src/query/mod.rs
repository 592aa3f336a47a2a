//! Queries: the first hit of a ray, any hit, and all hits.
//!
//! `search` tests the primitives of a structure's leaves, `clusters` those in leaves of eight, `unbounded` those that
//! lie in no structure. `collect` keeps or lists the hits of a search. `all_hits` lists all hits with the search in
//! `crossings`, `every_hit` visits them in no order, and `contains` counts them. `hit` is the answer, `smooth` its
//! normal for shading, `attributes` its vertex attributes, and `distance` its form for range finders.

mod all_hits;
mod attributes;
mod barycentric;
mod candidate;
mod clusters;
mod collect;
mod contains;
mod crossings;
mod distance;
#[cfg(feature = "all-structures")]
mod dynamic;
#[cfg(feature = "std")]
mod every_hit;
#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
mod four;
mod hit;
mod instances;
mod search;
mod smooth;
pub(crate) mod unbounded;

pub use all_hits::{HitList, all_hits, count_hits};
pub(crate) use attributes::Tangent;
pub use contains::{Solid, containment_ray, contains};
#[cfg(feature = "std")]
pub use every_hit::{OrderedHit, every_hit};
#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
#[doc(hidden)]
pub use four::{FourReadyRays, HitNormals, ReadyRay};
pub use hit::{Hit, PrimitiveHit};

use crate::accel::stack::StackView;
use crate::accel::{Accel, Number};
use crate::format::limits::{INSTANCES, UNBOUNDED};
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::{InstancesOnly, WIDE, inline_on_hosts, inline_on_hosts_hint_on_boards};
use candidate::Candidate;
use instances::{PartSearch, SearchPart};
use search::{search_structure, search_structure_out_of_line};

inline_on_hosts_hint_on_boards!(
    /// Returns the primitive that a ray hits first in its interval, found through the structure `A`.
    ///
    /// At the same t, the hit that comes first in the scene file counts, so the answer is the same for every structure.
    /// Of an instance it is the nearest hit in the part, whose t can be finer than the scene's.
    ///
    /// The stack must be as deep as the blob states, and the blob must [hold](crate::Scene::holds) the structure:
    /// through another one the answer means nothing. A [`Renderer`](crate::Renderer) and modules of `--emit-rust` check
    /// both.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{DualSplit, NoCount, Ray, Scene, Stack, closest_primitive};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
    /// let found = closest_primitive::<f32, DualSplit, _>(&scene, &down, stack.as_view(), &mut NoCount);
    /// let found = found.expect("a ball");
    /// assert_eq!(scene.object(found.primitive), 9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    // Hosts have enough memory for copies; passing a ray through memory would cost them time.
    pub fn closest_primitive<N: Number, A: Accel, C: Observer>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        stack: &mut StackView,
        count: &mut C,
    ) -> Option<PrimitiveHit<N>> {
        search::<N, A, C, false>(scene, ray, stack, count, false)
    }
);

/// The nearest primitive on a ray, or with `any` the first that is found.
// For boards the compiler chooses by itself, which needs less stack and fewer instructions.
#[cfg_attr(all(feature = "wide", not(feature = "small")), inline(always))]
#[cfg_attr(feature = "small", inline(never))]
fn search<N: Number, A: Accel, C: Observer, const ANY: bool>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
    any: bool,
) -> Option<PrimitiveHit<N>> {
    // Known at compile time, unless one copy of the code serves both.
    let any = if A::ONE_COPY { any } else { ANY };
    if C::ENABLED {
        count.event(ray.query(any));
    }
    if INSTANCES && !scene.instances().is_empty() {
        return search_with_instances::<N, A, C, ANY>(scene, ray, stack, count, any);
    }
    search_own::<N, A, C, ANY>(scene, ray, stack, count, any)
}

/// The nearest primitive among the scene's own objects; see [`search`].
#[inline(always)]
fn search_own<N: Number, A: Accel, C: Observer, const ANY: bool>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
    any: bool,
) -> Option<PrimitiveHit<N>> {
    if UNBOUNDED && scene.has_unbounded {
        return search_with_unbounded::<N, A, C, ANY>(scene, ray, stack, count, any);
    }
    let best = if A::ONE_COPY {
        search_structure_out_of_line::<N, A, C, ANY>(scene, ray, None, stack, count, any)
    } else {
        search_structure::<N, A, C, _, ANY>(scene, ray, None, stack, count, any)
    };
    Some(found(scene, ray, best?))
}

/// The hit of a candidate among the scene's own objects.
#[inline(always)]
fn found<N: Number>(scene: &Scene<'_>, ray: &Ray<N>, best: Candidate<N>) -> PrimitiveHit<N> {
    PrimitiveHit {
        t: best.t.widen() + ray.start_t,
        primitive: scene.primitive_at(best.place),
        best,
        placed: InstancesOnly::new(|| None),
    }
}

/// The nearest primitive on a ray in a scene with instances; see [`search`].
#[cold]
#[inline(never)]
fn search_with_instances<N: Number, A: Accel, C: Observer, const ANY: bool>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
    any: bool,
) -> Option<PrimitiveHit<N>> {
    let own = if !scene.has_own() {
        None
    } else if UNBOUNDED && scene.has_unbounded {
        search_with_unbounded::<N, A, C, ANY>(scene, ray, stack, count, any)
    } else {
        let best =
            search_structure_out_of_line::<N, A, C, ANY>(scene, ray, None, stack, count, any);
        best.map(|best| found(scene, ray, best))
    };
    if any && own.is_some() {
        return own;
    }
    let mut search = |part: &Scene<'_>, ray: &Ray<N>, stack: &mut StackView, count: &mut C| {
        search_structure_out_of_line::<N, A, C, ANY>(part, ray, None, stack, count, any)
    };
    if WIDE {
        // Hosts hold one copy for all structures.
        let search: SearchPart<'_, N, C> = &mut search;
        instances::nearest(scene, ray, own, stack, count, PartSearch { any, search })
    } else {
        instances::nearest(scene, ray, own, stack, count, PartSearch { any, search })
    }
}

/// The nearest primitive on a ray in a scene with unbounded shapes; see [`search`].
#[cold]
#[inline(never)]
fn search_with_unbounded<N: Number, A: Accel, C: Observer, const ANY: bool>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
    any: bool,
) -> Option<PrimitiveHit<N>> {
    let far = unbounded::nearest(scene, ray, count);
    let end = far.map_or(*ray, |far| ray.until(far.after_start));
    let first = far.map(|far| Candidate::new((end.tmax, 0), far.place));
    let best = if any && first.is_some() {
        first?
    } else {
        search_structure_out_of_line::<N, A, C, ANY>(scene, &end, first, stack, count, any)?
    };
    let mut hit = found(scene, ray, best);
    if let Some(far) = far
        && far.place == best.place
    {
        hit.t = far.t;
    }
    Some(hit)
}

/// Returns the first hit of a ray in its interval: [`closest_primitive`] with its surface. Needs what that needs:
/// without the structure in the blob, or with a short stack, hits are missed.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{DualSplit, NoCount, Ray, Scene, Stack, closest_hit};
///
/// let scene = Scene::from_bytes(BLOB)?;
/// let mut stack = Stack::<32>::new();
/// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
/// let hit = closest_hit::<f32, DualSplit, _>(&scene, &down, stack.as_view(), &mut NoCount);
/// let hit = hit.expect("a ball");
/// assert!(hit.front && hit.normal[1] > 0.0);
/// assert_eq!(hit.object, 9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn closest_hit<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
) -> Option<Hit<N>> {
    let found = closest_primitive::<N, A, C>(scene, ray, stack, count);
    let hit = found.and_then(|found| found.hit(scene, ray));
    if C::ENABLED {
        count.event(Event::Nearest(hit.map(|hit| hit.as_query_hit())));
    }
    hit
}

inline_on_hosts!(
    /// Returns true if a ray hits anything in its interval, that is, if [`closest_hit`] returns a hit. Needs what
    /// [`closest_primitive`] needs: without the structure in the blob, or with a short stack, hits are missed.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Counters, DualSplit, Ray, Scene, Stack, any_hit};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let (mut stack, mut counters) = (Stack::<32>::new(), Counters::default());
    /// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
    /// assert!(any_hit::<f32, DualSplit, _>(&scene, &down, stack.as_view(), &mut counters));
    /// assert!(counters.primitives > 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    // See above.
    pub fn any_hit<N: Number, A: Accel, C: Observer>(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        stack: &mut StackView,
        count: &mut C,
    ) -> bool {
        let found = if A::ONE_COPY {
            search::<N, A, C, false>(scene, ray, stack, count, true)
        } else {
            search::<N, A, C, true>(scene, ray, stack, count, true)
        };
        let any = found.is_some();
        if C::ENABLED {
            count.event(Event::Any(any));
        }
        any
    }
);
