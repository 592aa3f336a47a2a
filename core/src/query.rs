//! Queries: what does a ray meet first, does it meet anything at all?

use crate::accel::clamp::accept_in_box;
use crate::accel::cull::Culling;
use crate::accel::stack::StackView;
use crate::accel::{Accel, Number};
#[cfg(feature = "wide")]
use crate::format::cluster::{LANES, Pack, Strip};
use crate::format::kind::shapes;
use crate::format::limits::{UNBOUNDED, WIDE_INDICES, WIDE_LATTICE};
use crate::format::record::{Corners, Sphere, UnitBox, Vertex};
use crate::format::{Kind, Leaf};
use crate::geometry::primitive::Primitive;
use crate::geometry::sphere::{self, Spheres};
#[cfg(feature = "wide")]
use crate::geometry::strip::StripRay;
use crate::geometry::triangle::{self, Triangles, Vertices};
use crate::geometry::{Crossing, Part, PrimitiveId, accept};
#[cfg(feature = "wide")]
use crate::geometry::{Packs, Strips, pack};
#[cfg(feature = "wide")]
use crate::number::Format;
use crate::observe::count::Observer;
use crate::observe::event::{Event, Met};
use crate::ray::Ray;
use crate::scene::Scene;
#[cfg(feature = "wide")]
use crate::simd::{Portable, Simd, SimdLevel, with_simd};
use crate::target::SMALL;

mod unbounded;

/// What a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<N: Number> {
    /// Where on the ray: a length in units along the ray's major axis (see [`Ray`]).
    pub t: N::Wide,
    /// The point of the surface next to where `t` lies on the ray, in units.
    pub point: [N; 3],
    /// The geometric normal, of length 1: outward from solids, to the side from which a triangle's
    /// corners run counter-clockwise, along a disc's own.
    pub normal: [N; 3],
    /// Whether the ray came from the side to which the normal points; of a solid, whether it enters.
    pub front: bool,
    /// The object, counted in scene-file order.
    pub object: u32,
    /// The primitive, counted in scene-file order over all objects.
    pub primitive: u32,
    /// The surface lies within this length of `point`, measured along the normal, and a ray that starts so
    /// far away does not meet it again. With `u` = 2^-24 in `f32` and 2^-53 in `f64`, and `p` the point:
    ///
    /// | surface | bound | in `fixed` |
    /// |---|---|---|
    /// | face of a box; triangle or disc at right angles to an axis | the step from the coordinate on that axis, which is the surface's own, to the next number | 1 sub-step |
    /// | other triangle or disc, of normal `n`, with `r` from `p` to its first corner or centre | `16 u sum(abs(n r)) + 4 u sum(abs(n p))` | 4 sub-steps and `2^-28 sum(abs(r))` |
    /// | plane | as of a disc, with `r` from `p` to its point | as of a disc, or four times that where `r` is longer than 2^17 units |
    /// | sphere of radius `r` | `20 u r + 4 u sum(abs(n p))` | 8 sub-steps |
    /// | cylinder, cone, frustum | `16 u` of the largest coordinate of the solid, the point and the ray's start | 8 sub-steps |
    /// | torus | `16 u` of the largest coordinate of the solid; on the axis, where `r` is at least `R`, the way along it to where the surface is that far away | likewise, of 8 sub-steps |
    ///
    /// No other object and no extent of the scene counts.
    pub error: N,
    /// Whether `point` lies on the surface exactly.
    is_exact: bool,
    /// The primitive by kind and slot, as a leaf's word, whichever structure found it.
    place: u32,
}

/// The best hit so far.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate<N> {
    t: N,
    place: PrimitiveId,
    part: Part,
}

/// The search for hits, one leaf at a time.
struct Search<'s, 'a, N: Number, K> {
    scene: &'s Scene<'a>,
    ray: &'s Ray<N>,
    cull: &'s K,
    recip_norm2: N,
    /// The ray as strips are tested with it.
    #[cfg(feature = "wide")]
    strip_ray: StripRay<N>,
    /// No hit beyond this counts.
    tmax: N,
    best: Option<Candidate<N>>,
}

impl<'s, 'a, N: Number, K: Culling<N>> Search<'s, 'a, N, K> {
    #[inline(always)]
    fn new(scene: &'s Scene<'a>, ray: &'s Ray<N>, cull: &'s K) -> Self {
        Self {
            scene,
            ray,
            cull,
            recip_norm2: if scene.needs_norm {
                N::recip_norm2(ray.slope)
            } else {
                N::ZERO
            },
            #[cfg(feature = "wide")]
            strip_ray: StripRay::new(ray, &scene.space.shapes.clusters.strips),
            tmax: ray.tmax,
            best: None,
        }
    }

    /// Considers a crossing; it is committed if it beats the best hit: a smaller t, or the same t of an earlier primitive.
    #[inline(always)]
    fn consider(&mut self, crossing: Crossing<N>, place: PrimitiveId) {
        if let Some(hit) = accept(self.ray, crossing, self.tmax) {
            self.commit(hit, place);
        }
    }

    /// The same of a primitive whose crossing may have been rounded out of its box.
    #[cfg_attr(not(feature = "small"), inline(always))]
    #[cfg_attr(feature = "small", inline(never))]
    fn consider_in_box(&mut self, crossing: Crossing<N>, bounds: UnitBox, place: PrimitiveId) {
        if let Some(hit) = accept_in_box(self.ray, self.cull, crossing, bounds, self.tmax) {
            self.commit(hit, place);
        }
    }

    /// The same, out of line, because few of the primitives that are tested come this far.
    #[cfg_attr(not(feature = "small"), inline(never))]
    fn consider_out_of_line(&mut self, crossing: Crossing<N>, bounds: UnitBox, place: PrimitiveId) {
        self.consider_in_box(crossing, bounds, place);
    }

    /// Commits a hit in the interval that is left, unless an earlier primitive is met at the same t.
    // Out of line on hosts, where many places come here and few rays.
    #[cfg_attr(feature = "wide", inline(never))]
    #[cfg_attr(not(feature = "wide"), inline(always))]
    fn commit(&mut self, (t, part): (N, Part), place: PrimitiveId) {
        // No hit lies beyond the best one, so this one is nearer, or as near.
        let tie = self.best.filter(|best| t >= best.t);
        if tie.is_some_and(|best| self.scene.key(best.place) <= self.scene.key(place)) {
            return;
        }
        self.tmax = t;
        self.best = Some(Candidate { t, place, part });
    }

    /// Tells of a primitive that was just tested, and considered if it was met.
    #[inline(always)]
    fn observe<C: Observer>(
        &self,
        place: PrimitiveId,
        crossing: Option<&Crossing<N>>,
        count: &mut C,
    ) {
        if C::ENABLED {
            count.event(Event::Candidate {
                kind: place.kind(),
                primitive: self.scene.primitive_at(place),
                crossing: crossing.map(|c| [c.enter.0, c.leave.0].map(N::length_to_f64)),
                nearest: self.best.is_some_and(|best| best.place == place),
            });
        }
    }

    /// Tells of those primitives of a cluster that lanes rejected.
    #[cfg(feature = "wide")]
    #[inline(always)]
    fn observe_missed<C: Observer>(
        &self,
        missed: u32,
        place: impl Fn(u8) -> PrimitiveId,
        count: &mut C,
    ) {
        if C::ENABLED {
            for lane in (0..8).filter(|&lane| missed >> lane & 1 != 0) {
                self.observe(place(lane), None, count);
            }
        }
    }

    /// Tests the primitives of a leaf, or, where `ANY` hit will do, of a pack only until one is hit.
    #[inline(always)]
    fn leaf<A: Accel, C: Observer, const ANY: bool>(&mut self, leaf: Leaf, count: &mut C) {
        #[cfg(feature = "wide")]
        if A::HAS_CLUSTERS && leaf.count == 0 {
            let clusters = &self.scene.space.shapes.clusters;
            return match (leaf.kind, clusters.strips, clusters.packs) {
                (Kind::Triangle, Strips::S16(strips), _) => self.strip(strips, leaf.first, count),
                (Kind::Triangle, Strips::S24(strips), _) => self.strip(strips, leaf.first, count),
                (_, _, Packs::P16(packs)) => {
                    self.pack::<_, _, ANY>(packs.get(leaf.first as usize), leaf.first, count)
                }
                (_, _, Packs::P24(packs)) => {
                    self.pack::<_, _, ANY>(packs.get(leaf.first).as_ref(), leaf.first, count)
                }
            };
        }
        count.objects(leaf.count);
        self.slots(leaf, count);
    }

    /// Tests the triangles of a strip.
    #[cfg(feature = "wide")]
    #[inline(always)]
    fn strip<S: Strip, C: Observer>(&mut self, strips: &[S], number: u32, count: &mut C) {
        let Some(strip) = strips.get(number as usize) else {
            return;
        };
        count.objects(strip.members().count());
        let mut met = self.strip_met(strip);
        let missed = strip.members().places() & !met;
        self.observe_missed(missed, |place| PrimitiveId::Strip(number, place), count);
        while met != 0 {
            let place = met.trailing_zeros();
            met &= met - 1;
            self.triangle_in_strip(strip, PrimitiveId::Strip(number, place as u8), count);
        }
    }

    /// The places of a strip whose triangles the ray meets.
    #[cfg(feature = "wide")]
    #[inline(always)]
    fn strip_met<S: Strip>(&self, strip: &S) -> u32 {
        match self.scene.space.simd {
            SimdLevel::Portable => self.strip_ray.met(Portable, strip),
            #[cfg(all(feature = "avx2", target_arch = "x86_64"))]
            SimdLevel::Avx2(avx2) => avx2.call(
                #[inline(always)]
                |avx2, ray: &StripRay<N>, strip: &S, (), (), ()| ray.met(avx2, strip),
                (&self.strip_ray, strip, (), (), ()),
            ),
        }
    }

    /// Takes a triangle of a strip that the ray meets somewhere on its line.
    #[cfg(feature = "wide")]
    #[inline(never)]
    fn triangle_in_strip<S: Strip, C: Observer>(
        &mut self,
        strip: &S,
        place: PrimitiveId,
        count: &mut C,
    ) {
        if let PrimitiveId::Strip(_, number) = place
            && let Some(corners) = strip.triangle(number.into())
        {
            self.triangle(corners, place, count);
        }
    }

    /// Tests the spheres of a pack.
    #[cfg(feature = "wide")]
    #[inline(always)]
    fn pack<P: Pack, C: Observer, const ANY: bool>(
        &mut self,
        pack: Option<&P>,
        number: u32,
        count: &mut C,
    ) {
        let Some(pack) = pack else { return };
        let place = |lane: u32| PrimitiveId::Pack(number, lane as u8);
        count.objects(pack.lanes().count_ones());
        if N::FORMAT != Format::F32 {
            for lane in 0..LANES as u32 {
                self.sphere_in_pack(pack, lane, place(lane), count);
            }
            return;
        }
        let met = with_simd!(self.scene.space.simd, |simd| simd.call(
            #[inline(always)]
            |simd, ray, recip_norm2, pack, (), ()| pack::met(simd, ray, recip_norm2, pack),
            (self.ray, self.recip_norm2, pack, (), ()),
        ));
        let missed = pack.lanes() & !met.lanes;
        self.observe_missed(missed, |lane| place(lane.into()), count);
        let mut lanes = met.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros();
            lanes &= lanes - 1;
            let crossing = met.crossing(self.recip_norm2, lane as usize);
            self.consider(crossing, place(lane));
            self.observe(place(lane), Some(&crossing), count);
            // Lanes have tested the others, too, so all of them are told.
            if ANY && !C::ENABLED && self.best.is_some() {
                return;
            }
        }
    }

    /// Tests a sphere of a pack, in formats without lanes.
    #[cfg(feature = "wide")]
    #[inline(never)]
    fn sphere_in_pack<P: Pack, C: Observer>(
        &mut self,
        pack: &P,
        lane: u32,
        place: PrimitiveId,
        count: &mut C,
    ) {
        let Some((center, radius)) = pack.sphere(lane) else {
            return;
        };
        let crossing = sphere::cross(self.ray, self.recip_norm2, center, radius);
        if let Some(crossing) = crossing {
            self.consider(crossing, place);
        }
        self.observe(place, crossing.as_ref(), count);
    }

    /// Tests the primitives of a range of slots.
    #[inline(always)]
    fn slots<C: Observer>(&mut self, leaf: Leaf, count: &mut C) {
        let slots = leaf.slots();
        let shapes = &self.scene.space.shapes;
        macro_rules! by_kind {
            (
                forms { $($form:tt)* }
                records { $(
                    $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal,
                    [$field:ident: $module:ident::$record:ident], $section:tt;
                )* }
            ) => {
                match leaf.kind {
                    // Code that was left out, and that no blob here leads to.
                    kind if !kind.is_available() => (),
                    Kind::Triangle => self.indexed_triangles(leaf, count),
                    Kind::Sphere => match shapes.spheres {
                        Spheres::S16(spheres) => self.spheres(spheres.get(slots), leaf, count),
                        Spheres::S24(_) if !WIDE_LATTICE => (),
                        Spheres::S24(spheres) => self.spheres(spheres.get(slots), leaf, count),
                    },
                    // No structure leads to them.
                    kind if !kind.is_bounded() => (),
                    $(Kind::$kind => self.records(shapes.$field.get(slots), leaf, count),)*
                }
            };
        }
        shapes!(by_kind);
    }

    /// Tests the triangles of a range of slots.
    #[inline(always)]
    fn indexed_triangles<C: Observer>(&mut self, leaf: Leaf, count: &mut C) {
        let slots = leaf.slots();
        let shapes = &self.scene.space.shapes;
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
            },
        );
    }

    /// Tests records one after the other, and takes those that are met.
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
            let place = PrimitiveId::Slot(leaf.kind, index);
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
    /// A slot is counted only where it is asked for, and the vertices lie where they are borrowed
    /// from: what is handed on and kept is little.
    // Apart from the walk both keep more of what they need in the few registers of small cores.
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
                self.observe(PrimitiveId::Slot(Kind::Triangle, index), None, count);
            }
        }
    }

    /// Takes a triangle of its own record that the ray meets somewhere on its line.
    ///
    /// Its corners are read again: handed on, they would take up memory for those that are not met.
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
            self.triangle(corners, PrimitiveId::Slot(Kind::Triangle, index), count);
        }
    }

    /// Takes a triangle that the ray meets somewhere on its line.
    #[inline(always)]
    fn triangle<C: Observer>(&mut self, corners: [[i32; 3]; 3], place: PrimitiveId, count: &mut C) {
        let crossing = triangle::cross(self.ray, corners);
        if let Some((t, steeply)) = crossing {
            let crossing = Crossing::flat(t);
            if steeply {
                self.consider(crossing, place);
            } else {
                self.consider_in_box(crossing, triangle::bounds(corners), place);
            }
        }
        let crossing = crossing.map(|(t, _)| Crossing::flat(t));
        self.observe(place, crossing.as_ref(), count);
    }
}

/// Which primitive a ray meets first, and where: all of a hit but its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<N: Number> {
    /// Where on the ray: a length in units along the ray's major axis (see [`Ray`]).
    pub t: N::Wide,
    /// The primitive, counted in scene-file order over all objects.
    pub primitive: u32,
    best: Candidate<N>,
}

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

/// The primitive that a ray meets first in its interval, found through the structure `A`.
///
/// Of hits at the same t the one that comes first in the scene file counts, so the answer is the
/// same whatever the structure. The stack must be as deep as the blob says.
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
// Hosts have the room; a ray that goes through memory is waited for.
#[cfg_attr(feature = "wide", inline(always))]
#[cfg_attr(not(feature = "wide"), inline)]
pub fn closest_primitive<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
) -> Option<Found<N>> {
    search::<N, A, C, false>(scene, ray, stack, count, false)
}

/// The nearest primitive on a ray, or with `any` the first that is found.
// For boards the compiler chooses by itself: less stack, and fewer instructions.
#[cfg_attr(all(feature = "wide", not(feature = "small")), inline(always))]
#[cfg_attr(feature = "small", inline(never))]
fn search<N: Number, A: Accel, C: Observer, const ANY: bool>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
    any: bool,
) -> Option<Found<N>> {
    // Known when the code is compiled, unless one copy of it is to serve both.
    let any = if A::ONE_COPY { any } else { ANY };
    let views = A::views(&scene.structures);
    let cull = A::Cull::<N>::new(ray);
    let mut search = Search::new(scene, ray, &cull);
    if C::ENABLED {
        count.event(ray.query(any));
    }
    let far = if UNBOUNDED && scene.has_unbounded {
        unbounded::nearest(scene, ray, count)
    } else {
        None
    };
    let shorter;
    if let Some((t, place)) = far {
        shorter = ray.until(t);
        (search.ray, search.tmax) = (&shorter, shorter.tmax);
        let (t, part) = (shorter.tmax, 0);
        search.best = Some(Candidate { t, place, part });
    }
    let ray = if UNBOUNDED { search.ray } else { ray };
    if any && far.is_some() {
        // One is enough.
    } else if ANY {
        A::walk_any(
            &scene.space,
            views,
            ray,
            &cull,
            stack,
            count,
            |leaf, count| {
                search.leaf::<A, C, ANY>(leaf, count);
                search.best.is_some()
            },
        );
    } else if A::ONE_COPY {
        A::walk(
            &scene.space,
            views,
            ray,
            &cull,
            stack,
            count,
            |leaf, count| {
                search.leaf::<A, C, ANY>(leaf, count);
                (!any || search.best.is_none()).then_some(search.tmax)
            },
        );
    } else {
        A::walk(
            &scene.space,
            views,
            ray,
            &cull,
            stack,
            count,
            |leaf, count| {
                search.leaf::<A, C, ANY>(leaf, count);
                Some(search.tmax)
            },
        );
    }
    let best = search.best?;
    let t = match far {
        Some((t, place)) if place == best.place => t,
        _ => best.t.widen() + ray.moved,
    };
    Some(Found {
        t,
        primitive: scene.primitive_at(best.place),
        best,
    })
}

impl<N: Number> Found<N> {
    /// The whole hit: the point and how the surface lies there. `scene` and `ray` are those of the
    /// query.
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
    /// let hit = found.and_then(|found| found.hit(&scene, &down)).expect("a ball");
    /// assert_eq!(hit.primitive, 9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[cfg_attr(feature = "wide", inline(always))]
    pub fn hit(&self, scene: &Scene<'_>, ray: &Ray<N>) -> Option<Hit<N>> {
        let best = self.best;
        let point = ray.at(best.t);
        let (surface, front) = scene
            .space
            .shapes
            .surface(best.place, best.part, ray, point)?;
        Some(Hit {
            t: self.t,
            point: surface.point,
            normal: surface.normal,
            front,
            object: scene.object(self.primitive),
            primitive: self.primitive,
            error: surface.error,
            is_exact: surface.is_exact,
            place: Leaf {
                kind: best.place.kind(),
                first: scene.key(best.place).2,
                count: 1,
            }
            .to_word(),
        })
    }
}

impl<N: Number> Hit<N> {
    /// Where a ray starts that goes on from here on the normal's side, so that it does not meet
    /// what it leaves: beside the surface by the hit's error bound.
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
    /// assert!(hit.outside()[1] > hit.point[1]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn outside(&self) -> [N; 3] {
        let axis = |k: usize| self.point[k] + self.error * self.normal[k];
        [axis(0), axis(1), axis(2)]
    }

    /// Where a ray starts that goes on from here on the other side, `scene` being the one that was
    /// asked. Of a solid that is beneath *all* of its faces by their error bounds, so that the ray
    /// leaves the solid again; where the solid is thinner, halfway between them.
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
    /// assert!(hit.inside(&scene)[1] < hit.point[1]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn inside(&self, scene: &Scene<'_>) -> [N; 3] {
        let surface = [self.point, self.normal];
        match Leaf::from_word(self.place) {
            Some(Leaf { kind, first, .. }) => {
                scene
                    .space
                    .shapes
                    .inside(kind, first as usize, surface, self.error)
            }
            None => self.point,
        }
    }

    /// Where a ray starts on the normal's side that leads away from the surface and has a t above 0: without
    /// any step where the point lies on the surface exactly.
    pub(crate) fn beside(&self) -> [N; 3] {
        if self.is_exact {
            self.point
        } else {
            self.outside()
        }
    }

    /// Whether the primitive lies in no structure, and the hit perhaps far from the scene's box.
    #[inline(always)]
    pub(crate) fn is_unbounded(&self) -> bool {
        UNBOUNDED && Leaf::from_word(self.place).is_some_and(|leaf| !leaf.kind.is_bounded())
    }

    /// The hit as events tell it.
    fn met(&self) -> Met {
        Met {
            t: N::far_to_f64(self.t),
            point: self.point.map(N::length_to_f64),
            normal: self.normal.map(N::ratio_to_f64),
            front: self.front,
            object: self.object,
            primitive: self.primitive,
            error: self.error.length_to_f64(),
        }
    }
}

/// The first hit of a ray in its interval: [`closest_primitive`] with its surface.
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
        count.event(Event::Nearest(hit.map(|hit| hit.met())));
    }
    hit
}

/// Whether a ray meets anything in its interval: whether [`closest_hit`] would find something.
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
/// assert!(counters.objects > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
// As above.
#[cfg_attr(feature = "wide", inline(always))]
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
