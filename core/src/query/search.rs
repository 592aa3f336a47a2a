//! The search for hits: it tests the primitives of one leaf after the other, and keeps the best hit.

use crate::accel::clamp::accept_in_box;
use crate::accel::cull::Culling;
use crate::accel::{Accel, Number, StackView};
use crate::format::kind::shapes;
use crate::format::limits::{WIDE_INDICES, WIDE_LATTICE};
use crate::format::record::UnitBox;
use crate::format::width::{Corners, Sphere, Vertex};
use crate::format::{Kind, Leaf};
use crate::geometry::primitive::Primitive;
use crate::geometry::sphere::{self, Spheres};
use crate::geometry::strip::StripRay;
use crate::geometry::triangle::{self, PlaneCrossing, Triangles, Vertices};
use crate::geometry::{Crossing, Part, PrimitiveId, accept};
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::query::candidate::Candidate;
use crate::query::collect::Collect;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::{SMALL, WideOnly, inline_on_boards, wide_only};

/// The search for hits, one leaf at a time: for the best of them, or for the hits that `F` collects.
pub(super) struct Search<'s, 'a, N: Number, K, F> {
    pub(super) scene: &'s Scene<'a>,
    pub(super) ray: &'s Ray<N>,
    pub(super) cull: &'s K,
    pub(super) recip_norm2: N,
    /// The ray in the form in which strips are tested.
    pub(super) strip_ray: WideOnly<StripRay<N>>,
    /// No hit beyond this t counts.
    pub(super) tmax: N,
    pub(super) found: F,
}

impl<'s, 'a, N: Number, K: Culling<N>, F: Collect<N>> Search<'s, 'a, N, K, F> {
    #[inline(always)]
    pub(super) fn new(scene: &'s Scene<'a>, ray: &'s Ray<N>, cull: &'s K, found: F) -> Self {
        let strip_ray = wide_only(
            #[inline(always)]
            || StripRay::new(ray, &scene.geometry.shapes.clusters().strips),
        );
        Self::with_strip_ray(scene, ray, cull, found, strip_ray)
    }

    /// A search with a ray that is already in the form in which strips are tested.
    #[inline(always)]
    pub(super) fn with_strip_ray(
        scene: &'s Scene<'a>,
        ray: &'s Ray<N>,
        cull: &'s K,
        found: F,
        strip_ray: WideOnly<StripRay<N>>,
    ) -> Self {
        Self {
            scene,
            ray,
            cull,
            recip_norm2: if scene.needs_norm {
                N::recip_norm2(ray.slope)
            } else {
                N::ZERO
            },
            strip_ray,
            tmax: ray.tmax,
            found,
        }
    }

    /// Considers a crossing; it is committed if it beats the best hit: a smaller t, or the same t of an earlier
    /// primitive.
    #[inline(always)]
    pub(super) fn consider(&mut self, crossing: Crossing<N>, place: PrimitiveId) {
        if F::ALL {
            return self.consider_both(crossing, place);
        }
        if let Some(hit) = accept(self.ray, crossing, self.tmax) {
            self.commit(hit, place);
        }
    }

    /// Considers a crossing that rounding can have moved out of the primitive's box.
    #[cfg_attr(not(feature = "small"), inline(always))]
    #[cfg_attr(feature = "small", inline(never))]
    pub(super) fn consider_in_box(
        &mut self,
        crossing: Crossing<N>,
        bounds: UnitBox,
        place: PrimitiveId,
    ) {
        if F::ALL {
            return self.consider_both_in_box(crossing, bounds, place);
        }
        if let Some(hit) = accept_in_box(self.ray, self.cull, crossing, bounds, self.tmax) {
            self.commit(hit, place);
        }
    }

    /// Considers such a crossing out of line, because few of the tested primitives need it.
    #[cfg_attr(not(feature = "small"), inline(never))]
    fn consider_out_of_line(&mut self, crossing: Crossing<N>, bounds: UnitBox, place: PrimitiveId) {
        self.consider_in_box(crossing, bounds, place);
    }

    inline_on_boards!(
        /// Commits a hit in the remaining interval.
        // Out of line on hosts, where many places call this and few rays need it.
        pub(super) fn commit(&mut self, hit: (N, Part), place: PrimitiveId) {
            if let Some(tmax) = self.found.commit(self.scene, hit, place) {
                self.tmax = tmax;
            }
        }
    );

    /// Reports a primitive after its test, and after it was considered if it was hit.
    #[inline(always)]
    pub(super) fn observe<C: Observer>(
        &self,
        place: PrimitiveId,
        crossing: Option<&Crossing<N>>,
        count: &mut C,
    ) {
        if C::ENABLED {
            count.event(Event::Candidate {
                kind: place.kind,
                primitive: self.scene.primitive_at(place),
                crossing: crossing.map(|c| [c.enter.0, c.leave.0].map(N::length_to_f64)),
                nearest: self.found.is_at(place),
            });
        }
    }

    /// Tests the primitives of a leaf, or, if `ANY` hit is enough, of a pack only until one is hit.
    #[inline(always)]
    pub(super) fn leaf<A: Accel, C: Observer, const ANY: bool>(
        &mut self,
        leaf: Leaf,
        count: &mut C,
    ) {
        if A::HAS_CLUSTERS && leaf.count == 0 {
            return self.cluster::<_, ANY>(leaf, count);
        }
        count.primitives(leaf.count);
        self.slots(leaf, count);
    }

    /// Tests the primitives of a range of slots.
    #[inline(always)]
    fn slots<C: Observer>(&mut self, leaf: Leaf, count: &mut C) {
        let slots = leaf.slots();
        let shapes = &self.scene.geometry.shapes;
        macro_rules! by_kind {
            (
                forms { $($form:tt)* }
                records { $(
                    $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal,
                    [$field:ident: $module:ident::$record:ident], $section:tt;
                )* }
            ) => {
                match leaf.kind {
                    // Code that this build lacks, and that no blob here needs.
                    kind if !kind.is_available() => (),
                    Kind::Triangle => self.indexed_triangles(leaf, count),
                    Kind::Sphere => match shapes.spheres {
                        Spheres::S16(spheres) => self.spheres(spheres.get(slots), leaf, count),
                        Spheres::S24(_) if !WIDE_LATTICE => (),
                        Spheres::S24(spheres) => self.spheres(spheres.get(slots), leaf, count),
                    },
                    $(Kind::$kind if Kind::$kind.is_available() && Kind::$kind.is_bounded() => {
                        self.records(shapes.$field.get(slots), leaf, count)
                    })*
                    // No structure holds shapes without bounds.
                    _ => (),
                }
            };
        }
        shapes!(by_kind);
    }

    /// Tests the triangles of a range of slots.
    #[inline(always)]
    fn indexed_triangles<C: Observer>(&mut self, leaf: Leaf, count: &mut C) {
        let slots = leaf.slots();
        let shapes = &self.scene.geometry.shapes;
        match (&shapes.vertices, &shapes.triangles) {
            (Vertices::V16(v), Triangles::U16(t)) => self.triangles(v, t.get(slots), leaf, count),
            (_, Triangles::U32(_)) if !WIDE_INDICES => (),
            (Vertices::V24(_), _) if !WIDE_LATTICE => (),
            (Vertices::V16(v), Triangles::U32(t)) => self.triangles(v, t.get(slots), leaf, count),
            (Vertices::V24(v), Triangles::U16(t)) => self.triangles(v, t.get(slots), leaf, count),
            (Vertices::V24(v), Triangles::U32(t)) => self.triangles(v, t.get(slots), leaf, count),
        }
    }

    /// Tests the records of a shape.
    #[inline(always)]
    fn records<T: Primitive, C: Observer>(
        &mut self,
        records: Option<&[T]>,
        leaf: Leaf,
        count: &mut C,
    ) {
        self.solids(
            records,
            leaf,
            count,
            |search, record| {
                if T::TESTS_BOX && K::misses(search.ray, search.tmax, &record.bounds()) {
                    return None;
                }
                record.cross(search.ray, search.recip_norm2)
            },
            |search, crossing, record, place| {
                if T::CLAMPS {
                    search.consider_out_of_line(crossing, record.bounds(), place);
                } else {
                    search.consider(crossing, place);
                }
                if F::ALL {
                    search.consider_later(crossing, record, place);
                }
            },
        );
    }

    /// Tests records one after the other, and considers those that the ray hits.
    #[inline(always)]
    fn solids<T, C: Observer>(
        &mut self,
        records: Option<&[T]>,
        leaf: Leaf,
        count: &mut C,
        cross: impl Fn(&Self, &T) -> Option<Crossing<N>>,
        consider: impl Fn(&mut Self, Crossing<N>, &T, PrimitiveId),
    ) {
        for (index, record) in numbered(leaf, records) {
            let crossing = cross(self, record);
            let place = PrimitiveId::in_slot(leaf.kind, index);
            if let Some(crossing) = crossing {
                consider(self, crossing, record, place);
            }
            self.observe(place, crossing.as_ref(), count);
        }
    }

    #[inline(always)]
    fn spheres<S: Sphere, C: Observer>(
        &mut self,
        spheres: Option<&[S]>,
        leaf: Leaf,
        count: &mut C,
    ) {
        let cross = |search: &Self, record: &S| {
            let (center, radius) = record.lattice();
            sphere::cross(search.ray, search.recip_norm2, center, radius)
        };
        let consider = |search: &mut Self, crossing, _: &S, place| search.consider(crossing, place);
        self.solids(spheres, leaf, count, cross, consider);
    }

    /// Chooses the copy of the triangle test for the ray's major axis, where there is one for each.
    #[inline(always)]
    fn triangles<V: Vertex, I: Corners, C: Observer>(
        &mut self,
        vertices: &&[V],
        triangles: Option<&[I]>,
        leaf: Leaf,
        count: &mut C,
    ) {
        let Some(triangles) = triangles else { return };
        let end = leaf.first.wrapping_add(leaf.count);
        match self.ray.major {
            _ if SMALL => {
                self.triangles_along::<{ triangle::ANY }, V, I, C>(vertices, triangles, end, count)
            }
            0 => self.triangles_along::<0, V, I, C>(vertices, triangles, end, count),
            1 => self.triangles_along::<1, V, I, C>(vertices, triangles, end, count),
            _ => self.triangles_along::<2, V, I, C>(vertices, triangles, end, count),
        }
    }

    /// Tests the triangles of the slots before `end`.
    ///
    /// Slots are counted only where a hit needs its number, and vertices are read through the borrowed slice. So few
    /// values stay in registers.
    // Out of line, the walk and the test each have more of the few registers of small cores.
    #[cfg_attr(not(feature = "wide"), inline(never))]
    fn triangles_along<const MAJOR: usize, V: Vertex, I: Corners, C: Observer>(
        &mut self,
        vertices: &&[V],
        mut triangles: &[I],
        end: u32,
        count: &mut C,
    ) {
        let projection = triangle::Projection::of::<MAJOR, V>(self.ray);
        while let [record, rest @ ..] = triangles {
            let index = end.wrapping_sub(triangles.len() as u32);
            triangles = rest;
            let [a, b, c] = record.corners();
            let corners = (vertices.get(a), vertices.get(b), vertices.get(c));
            let (Some(a), Some(b), Some(c)) = corners else {
                continue;
            };
            if projection.meets::<MAJOR, V>(a, b, c) {
                self.triangle_in_slot(vertices, record, index, count);
            } else {
                self.observe(PrimitiveId::in_slot(Kind::Triangle, index), None, count);
            }
        }
    }

    /// Considers a triangle with a record of its own that the line of the ray hits.
    ///
    /// Its corners are read again, because passing them on would use memory for triangles that the ray misses.
    #[inline(never)]
    fn triangle_in_slot<V: Vertex, I: Corners, C: Observer>(
        &mut self,
        vertices: &&[V],
        record: &I,
        index: u32,
        count: &mut C,
    ) {
        let [a, b, c] = record.corners();
        let corners = (vertices.get(a), vertices.get(b), vertices.get(c));
        if let (Some(a), Some(b), Some(c)) = corners {
            let corners = [a, b, c].map(Vertex::position);
            self.triangle(corners, PrimitiveId::in_slot(Kind::Triangle, index), count);
        }
    }

    /// Considers a triangle that the line of the ray hits.
    #[inline(always)]
    pub(super) fn triangle<C: Observer>(
        &mut self,
        corners: [[i32; 3]; 3],
        place: PrimitiveId,
        count: &mut C,
    ) {
        let crossing = triangle::cross(self.ray, corners);
        if F::ALL {
            self.triangle_half_open(corners, crossing, place);
        } else if let Some(PlaneCrossing {
            t,
            is_steep,
            normal,
        }) = crossing
        {
            let crossing = Crossing::flat(t);
            if is_steep {
                self.consider(crossing, place);
            } else {
                self.consider_in_box(crossing, triangle::bounds(corners), place);
            }
            self.found.keep_normal(place, normal);
        }
        let crossing = crossing.map(|crossing| Crossing::flat(crossing.t));
        self.observe(place, crossing.as_ref(), count);
    }
}

/// The best hit among the primitives of a structure and those that were found before, or the hits that `F` collects.
// With instances several places search for it: boards hold it once.
#[cfg_attr(feature = "wide", inline(always))]
#[cfg_attr(all(feature = "instances", not(feature = "wide")), inline(never))]
pub(super) fn search_structure<N: Number, A: Accel, C: Observer, F: Collect<N>, const ANY: bool>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    found: F,
    stack: &mut StackView,
    count: &mut C,
    any: bool,
) -> F {
    let views = A::views(&scene.structures);
    let cull = A::Cull::<N>::new(ray);
    let mut search = Search::new(scene, ray, &cull, found);
    if ANY {
        A::walk_any(
            &scene.geometry,
            views,
            ray,
            &cull,
            stack,
            count,
            |leaf, count| {
                search.leaf::<A, C, ANY>(leaf, count);
                search.found.is_any()
            },
        );
    } else {
        A::walk(
            &scene.geometry,
            views,
            ray,
            &cull,
            stack,
            count,
            |leaf, count| {
                search.leaf::<A, C, ANY>(leaf, count);
                let found = A::ONE_COPY && any && search.found.is_any();
                (!found).then_some(search.tmax)
            },
        );
    }
    search.found
}

inline_on_boards!(
    /// [`search_structure`] for scenes with instances or unbounded shapes, which search in several places: hosts hold
    /// it once for all of those.
    pub(super) fn search_structure_out_of_line<
        N: Number,
        A: Accel,
        C: Observer,
        const ANY: bool,
    >(
        scene: &Scene<'_>,
        ray: &Ray<N>,
        first: Option<Candidate<N>>,
        stack: &mut StackView,
        count: &mut C,
        any: bool,
    ) -> Option<Candidate<N>> {
        search_structure::<N, A, C, _, ANY>(scene, ray, first, stack, count, any)
    }
);

/// The records of a leaf's slots, with the slots.
#[inline(always)]
fn numbered<T>(leaf: Leaf, records: Option<&[T]>) -> impl Iterator<Item = (u32, &T)> {
    let mut next = leaf.first;
    records.unwrap_or_default().iter().map(move |record| {
        let slot = next;
        next = slot.wrapping_add(1);
        (slot, record)
    })
}
