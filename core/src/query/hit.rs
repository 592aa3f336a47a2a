//! Answers of queries: the primitive that a ray hits, the point, and the surface there.

use crate::accel::Number;
use crate::format::Leaf;
use crate::format::instance::Instance;
use crate::format::limits::UNBOUNDED;
use crate::geometry::{LEAVING, flat};
use crate::instances::map::{Map, PlacedSurface};
use crate::observe::event::QueryHit;
use crate::query::candidate::Candidate;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::target::{InstancesOnly, inline_on_hosts};

/// The first primitive that a ray hits, and its t: a hit without its surface.
#[derive(Clone, Copy, Debug)]
pub struct PrimitiveHit<N: Number> {
    /// The place on the ray: a length in units along the ray's major axis (see [`Ray`]).
    pub t: N::Wide,
    /// The primitive, counted in scene-file order over all objects.
    pub primitive: u32,
    pub(super) best: Candidate<N>,
    /// The place in the scene if the primitive is an instance's; `best` is then counted in the part.
    pub(super) placed: InstancesOnly<Option<InInstance<N>>>,
}

/// The place of an instance's hit in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct InInstance<N> {
    pub(super) index: u32,
    /// The t on the scene's ray, counted from its start.
    pub(super) t: N,
}

/// Hits are equal if they are the same crossing at the same t. What a structure keeps beside that for later does not
/// count.
impl<N: Number> PartialEq for PrimitiveHit<N> {
    fn eq(&self, other: &Self) -> bool {
        let crossing = |hit: &Self| (hit.t, hit.primitive, hit.best.t, hit.best.part);
        crossing(self) == crossing(other) && self.placed == other.placed
    }
}

impl<N: Number> PrimitiveHit<N> {
    /// Returns the place of the instance that was hit among the scene's [instances](Scene::instances); `None` for a hit
    /// of the scene's own objects.
    pub fn instance(&self) -> Option<u32> {
        let placed = self.placed.get().copied().flatten()?;
        Some(placed.index)
    }

    /// Returns true if the ray leaves a solid here; always false for triangles and other flat surfaces.
    pub fn leaves(&self) -> bool {
        self.best.part & LEAVING != 0
    }

    /// Returns true if surfaces of the primitive's kind can enclose something: not discs and planes.
    pub fn encloses(&self) -> bool {
        self.best.place.kind.encloses()
    }

    inline_on_hosts!(
        /// Returns the geometric normal of the [whole hit](Self::hit): faster where nothing else of it is needed.
        /// `scene` and `ray` are those of the query.
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
        /// let normal = found.and_then(|found| found.normal(&scene, &down)).expect("a ball");
        /// assert!(normal[1] > 0.0);
        /// # Ok::<(), Box<dyn std::error::Error>>(())
        /// ```
        pub fn normal(&self, scene: &Scene<'_>, ray: &Ray<N>) -> Option<[N; 3]> {
            if self.instance().is_some() {
                return Some(self.hit(scene, ray)?.normal);
            }
            let best = self.best;
            if let Some(normal) = best.normal() {
                return Some(flat::unit_normal(normal));
            }
            let point = ray.at(best.t);
            let shapes = &scene.geometry.shapes;
            let (surface, _) = shapes.surface(best.place, best.part, ray, point)?;
            Some(surface.normal)
        }
    );

    inline_on_hosts!(
        /// Returns the whole hit, with point and surface. `scene` and `ray` are those of the
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
        pub fn hit(&self, scene: &Scene<'_>, ray: &Ray<N>) -> Option<Hit<N>> {
            if let Some(Some(instance)) = self.placed.get() {
                return placed_hit(self, instance, scene, ray);
            }
            let best = self.best;
            let point = ray.at(best.t);
            let (surface, front) = scene
                .geometry
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
                    kind: best.place.kind,
                    first: scene.key(best.place).2,
                    count: 1,
                }
                .to_word(),
                instance: InstancesOnly::new(|| NO_INSTANCE),
            })
        }
    );
}

/// The point where a ray hits a primitive, and the surface there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<N: Number> {
    /// The place on the ray: a length in units along the ray's major axis (see [`Ray`]).
    pub t: N::Wide,
    /// The point of the surface next to the place of `t` on the ray, in units. A plane can be hit up to 2^49 units from
    /// the lattice's middle. Where a coordinate is beyond 2^18 - 16 units in `fixed`, or 2^47 - 16 in `f32` and `f64`,
    /// this is a nearer point of the plane, and only `t` says where the hit is. The 16 units are room for
    /// [`outside`](Self::outside) and [`inside`](Self::inside).
    pub point: [N; 3],
    /// The geometric normal, of length 1: outward from solids, to the side from which a triangle's
    /// corners run counter-clockwise, along a disc's own.
    pub normal: [N; 3],
    /// True if the ray came from the side to which the normal points; for a solid, if the ray enters.
    pub front: bool,
    /// The object, counted in scene-file order.
    pub object: u32,
    /// The primitive, counted in scene-file order over all objects.
    pub primitive: u32,
    /// The surface lies within this length of `point`, measured along the normal. A ray that starts this far away does
    /// not hit it again. With `u` = 2^-24 in `f32` and 2^-53 in `f64`, and `p` the point:
    ///
    /// | surface | bound | in `fixed` |
    /// |---|---|---|
    /// | face of a box; triangle or disc at right angles to an axis | the step from the coordinate on that axis, which is the surface's own, to the next number | 1 sub-step |
    /// | other triangle or disc, of normal `n`, with `r` from `p` to its first corner or center | `16 u sum(abs(n r)) + 4 u sum(abs(n p))` | 4 sub-steps and `2^-28 sum(abs(r))` |
    /// | plane | as of a disc, with `r` from `p` to its point | as of a disc, or four times that where `r` is longer than 2^17 units |
    /// | sphere of radius `r` | `20 u r + 4 u sum(abs(n p))` | 8 sub-steps |
    /// | cylinder, cone, frustum | `16 u` of the largest coordinate of the solid, the point and the ray's start | 8 sub-steps |
    /// | torus | `16 u` of the largest coordinate of the solid; on the axis, where `r` is at least `R`, the way along it to where the surface is that far away | likewise, of 8 sub-steps |
    /// | any of an instance | the part's own bound in the scene's units; `32 u` of the largest coordinate of `p` less the instance's center; `4 u` of the largest coordinate of `p` | the part's own bound and 8 sub-steps of the part, in the scene's units; 20 sub-steps |
    ///
    /// Other objects and the extent of the scene do not affect it.
    pub error: N,
    /// True if `point` lies on the surface exactly.
    is_exact: bool,
    /// The primitive by kind and slot, as a leaf's word, whichever structure found it.
    pub(super) place: u32,
    /// The instance that it is part of.
    instance: InstancesOnly<u32>,
}

/// The instance of a hit of the scene's own objects.
const NO_INSTANCE: u32 = u32::MAX;

impl<N: Number> Hit<N> {
    /// Returns the origin for a ray that continues from here on the normal's side and must not hit this surface again.
    /// It is the point, moved along the normal by the error bound.
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

    /// Returns the origin for a ray that continues from here on the other side. `scene` is that of the query. In a
    /// solid it lies beneath *all* faces by their error bounds, so that the ray leaves the solid again. Where the solid
    /// is thinner than that, it lies halfway between them.
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
        if let Some(instance) = self.instance() {
            return placed_inside(self, instance, scene);
        }
        let surface = [self.point, self.normal];
        match Leaf::from_word(self.place) {
            Some(Leaf { kind, first, .. }) => {
                scene
                    .geometry
                    .shapes
                    .inside(kind, first as usize, surface, self.error)
            }
            None => self.point,
        }
    }

    /// Returns the place of the instance that was hit among the scene's [instances](Scene::instances); `None` for a hit
    /// of the scene's own objects.
    pub fn instance(&self) -> Option<u32> {
        let instance = self.instance.get().copied()?;
        (instance != NO_INSTANCE).then_some(instance)
    }

    /// Returns the origin for a ray that leaves the surface on the normal's side and has a t above 0. It is the point
    /// itself where that lies on the surface exactly.
    pub(crate) fn offset_point(&self) -> [N; 3] {
        if self.is_exact {
            self.point
        } else {
            self.outside()
        }
    }

    /// Returns true if the primitive lies in no structure, so that the hit can be far from the scene's box.
    #[inline(always)]
    pub(crate) fn is_unbounded(&self) -> bool {
        UNBOUNDED && Leaf::from_word(self.place).is_some_and(|leaf| !leaf.kind.is_bounded())
    }

    /// The hit as an event.
    pub(super) fn as_query_hit(&self) -> QueryHit {
        QueryHit {
            t: N::far_to_f64(self.t),
            point: self.point.map(N::length_to_f64),
            normal: self.normal.map(N::ratio_to_f64),
            front: self.front,
            object: self.object,
            primitive: self.primitive,
            instance: self.instance(),
            error: self.error.length_to_f64(),
        }
    }
}

/// An instance by its place, and its part.
pub(super) fn find<'s>(scene: &'s Scene<'_>, index: u32) -> Option<(&'s Instance, &'s Scene<'s>)> {
    let placed = scene.placed.get()?;
    let instance = placed.top.instances.get(index as usize)?;
    Some((instance, placed.part(instance)?.0))
}

/// The whole hit of a primitive of an instance.
#[cold]
#[inline(never)]
fn placed_hit<N: Number>(
    found: &PrimitiveHit<N>,
    placed: &InInstance<N>,
    scene: &Scene<'_>,
    ray: &Ray<N>,
) -> Option<Hit<N>> {
    let (instance, part) = find(scene, placed.index)?;
    let (map, best) = (Map::<N>::new(instance), found.best);
    let mapped = map.ray(part.bounds(), ray, ray.tmax)?;
    let shapes = &part.geometry.shapes;
    let near = mapped.ray.at(best.t);
    let (surface, front) = shapes.surface(best.place, best.part, &mapped.ray, near)?;
    let in_part = PlacedSurface {
        point: surface.point,
        normal: surface.normal,
        error: surface.error,
    };
    let surface = map.surface(ray.at(placed.t), &in_part);
    Some(Hit {
        t: found.t,
        point: surface.point,
        normal: surface.normal,
        front,
        object: scene.object(found.primitive),
        primitive: found.primitive,
        error: surface.error,
        is_exact: false,
        place: Leaf {
            kind: best.place.kind,
            first: part.key(best.place).2,
            count: 1,
        }
        .to_word(),
        instance: InstancesOnly::new(|| placed.index),
    })
}

/// [`Hit::inside`] of an instance: the place is found in its part, at the depth of the hit's error bound.
#[cold]
#[inline(never)]
fn placed_inside<N: Number>(hit: &Hit<N>, index: u32, scene: &Scene<'_>) -> [N; 3] {
    let found = find(scene, index).zip(Leaf::from_word(hit.place));
    let Some(((instance, part), leaf)) = found else {
        return hit.point;
    };
    let map = Map::<N>::new(instance);
    let PlacedSurface {
        point,
        normal,
        error,
    } = map.in_part(&PlacedSurface {
        point: hit.point,
        normal: hit.normal,
        error: hit.error,
    });
    let shapes = &part.geometry.shapes;
    let beneath = shapes.inside(leaf.kind, leaf.first as usize, [point, normal], error);
    let [x, y, z] = beneath;
    let way = map.step([x - point[0], y - point[1], z - point[2]]);
    let axis = |k: usize| hit.point[k] + way[k];
    [axis(0), axis(1), axis(2)]
}

#[cfg(feature = "defmt")]
impl<N: Number + defmt::Format> defmt::Format for PrimitiveHit<N>
where
    N::Wide: defmt::Format,
{
    fn format(&self, to: defmt::Formatter<'_>) {
        let instance = self.instance();
        defmt::write!(
            to,
            "PrimitiveHit {{ t: {}, primitive: {=u32}, instance: {} }}",
            self.t,
            self.primitive,
            instance
        );
    }
}

#[cfg(feature = "defmt")]
impl<N: Number + defmt::Format> defmt::Format for Hit<N>
where
    N::Wide: defmt::Format,
{
    fn format(&self, to: defmt::Formatter<'_>) {
        let instance = self.instance();
        defmt::write!(
            to,
            "Hit {{ t: {}, point: {}, normal: {}, front: {=bool}, object: {=u32}, primitive: {=u32}, error: {}, \
             instance: {} }}",
            self.t,
            self.point,
            self.normal,
            self.front,
            self.object,
            self.primitive,
            self.error,
            instance
        );
    }
}
