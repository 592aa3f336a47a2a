//! Queries: what does a ray meet first, does it meet anything at all?

use crate::accel::cull::Culling;
use crate::accel::{Accel, Leaf, StackView};
use crate::blob::Scene;
use crate::blob::record::{Corners, Cuboid, Sphere, UnitBox, Vertex};
use crate::count::Count;
use crate::number::Number;
use crate::ray::Ray;
use crate::shape::sphere;
use crate::shape::triangle::{self, Projection};
use crate::shape::{Crossing, Kind, Part, Spheres, Triangles, Vertices, accept, extent};

/// What a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<N: Number> {
    /// Where on the ray: a length in units along the ray's major axis (see [`Ray`]).
    pub t: N::Wide,
    /// The point, in units.
    pub point: [N; 3],
    /// The geometric normal, of length 1: outward from solids, to the side from which a triangle's
    /// corners run counter-clockwise, along a disc's own.
    pub normal: [N; 3],
    /// Whether the ray came from the side to which the normal points.
    pub front: bool,
    /// The object, counted in scene-file order.
    pub object: u32,
    /// The primitive, counted in scene-file order over all objects.
    pub primitive: u32,
    /// The surface lies within this length of `point`, measured along the normal.
    pub error: N,
}

/// The best hit so far.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Best<N> {
    t: N,
    /// The primitive in scene-file order.
    primitive: u32,
    kind: Kind,
    index: u32,
    part: Part,
}

/// The search for hits, one leaf at a time.
struct Search<'s, 'a, N: Number, K> {
    scene: &'s Scene<'a>,
    ray: &'s Ray<N>,
    cull: &'s K,
    recip_norm2: N,
    projection: Projection<N>,
    /// No hit beyond this counts.
    tmax: N,
    best: Option<Best<N>>,
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
            projection: Projection::of(ray),
            tmax: ray.tmax,
            best: None,
        }
    }

    /// Takes a crossing that beats the best hit: a smaller t, or the same t of an earlier primitive.
    ///
    /// Out of line, because few of the primitives that are tested come this far.
    #[inline(never)]
    fn consider(&mut self, crossing: Crossing<N>, bounds: UnitBox, kind: Kind, index: u32) {
        let Some((t, part)) = accept(self.ray, self.cull, crossing, bounds, self.tmax) else {
            return;
        };
        let primitive = self.scene.primitive(kind, index);
        if self
            .best
            .is_none_or(|best| t < best.t || primitive < best.primitive)
        {
            self.best = Some(Best {
                t,
                primitive,
                kind,
                index,
                part,
            });
            self.tmax = t;
        }
    }

    /// Tests the primitives of a leaf.
    #[inline(always)]
    fn leaf(&mut self, leaf: Leaf) {
        let (first, end) = (leaf.first as usize, (leaf.first + leaf.count) as usize);
        let shapes = &self.scene.shapes;
        match leaf.kind {
            Kind::Triangle => match (shapes.vertices, shapes.triangles) {
                (Vertices::V16(v), Triangles::U16(t)) => self.triangles(v, t.get(first..end), leaf),
                (Vertices::V16(v), Triangles::U32(t)) => self.triangles(v, t.get(first..end), leaf),
                (Vertices::V24(v), Triangles::U16(t)) => self.triangles(v, t.get(first..end), leaf),
                (Vertices::V24(v), Triangles::U32(t)) => self.triangles(v, t.get(first..end), leaf),
            },
            Kind::Sphere => match shapes.spheres {
                Spheres::S16(spheres) => self.spheres(spheres.get(first..end), leaf),
                Spheres::S24(spheres) => self.spheres(spheres.get(first..end), leaf),
            },
            Kind::Box => self.solids(
                shapes.boxes.get(first..end),
                leaf,
                |search, cuboid| cuboid.cross(search.ray),
                Cuboid::bounds,
            ),
            Kind::Disc => self.solids(
                shapes.discs.get(first..end),
                leaf,
                |search, disc| disc.cross(search.ray),
                |disc| disc.bounds,
            ),
            Kind::Cone => self.solids(
                shapes.cones.get(first..end),
                leaf,
                |search, cone| cone.cross(search.ray, search.recip_norm2),
                |cone| cone.bounds,
            ),
        }
    }

    /// Tests records one after the other; `bounds` is asked for the boxes of those that are met.
    #[inline(always)]
    fn solids<T>(
        &mut self,
        records: Option<&[T]>,
        leaf: Leaf,
        cross: impl Fn(&Self, &T) -> Option<Crossing<N>>,
        bounds: impl Fn(&T) -> UnitBox,
    ) {
        for (index, record) in (leaf.first..).zip(records.unwrap_or_default()) {
            if let Some(crossing) = cross(self, record) {
                self.consider(crossing, bounds(record), leaf.kind, index);
            }
        }
    }

    #[inline(always)]
    fn spheres<S: Sphere>(&mut self, spheres: Option<&[S]>, leaf: Leaf) {
        let cross = |search: &Self, record: &S| {
            let (center, radius) = record.lattice();
            sphere::cross(search.ray, search.recip_norm2, center, radius)
        };
        let bounds = |record: &S| {
            let (center, radius) = record.lattice();
            sphere::bounds(center, radius)
        };
        self.solids(spheres, leaf, cross, bounds);
    }

    /// Chooses the copy of the triangle test for the ray's major axis.
    #[inline(always)]
    fn triangles<V: Vertex, I: Corners>(
        &mut self,
        vertices: &[V],
        triangles: Option<&[I]>,
        leaf: Leaf,
    ) {
        match self.ray.major {
            0 => self.triangles_along::<0, V, I>(vertices, triangles, leaf),
            1 => self.triangles_along::<1, V, I>(vertices, triangles, leaf),
            _ => self.triangles_along::<2, V, I>(vertices, triangles, leaf),
        }
    }

    fn triangles_along<const MAJOR: usize, V: Vertex, I: Corners>(
        &mut self,
        vertices: &[V],
        triangles: Option<&[I]>,
        leaf: Leaf,
    ) {
        let projection = self.projection;
        for (index, record) in (leaf.first..).zip(triangles.unwrap_or_default()) {
            let [a, b, c] = record.corners();
            let corners = (vertices.get(a), vertices.get(b), vertices.get(c));
            let (Some(a), Some(b), Some(c)) = corners else {
                continue;
            };
            if projection.meets::<MAJOR, V>(a, b, c) {
                self.triangle([a.position(), b.position(), c.position()], index);
            }
        }
    }

    /// Takes a triangle that the ray meets somewhere on its line.
    #[inline(never)]
    fn triangle(&mut self, corners: [[i32; 3]; 3], index: u32) {
        if let Some(crossing) = triangle::cross(self.ray, corners) {
            let bounds = triangle::bounds(corners);
            self.consider(crossing, bounds, Kind::Triangle, index);
        }
    }
}

/// Which primitive a ray meets first, and where: all of a hit but its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<N: Number> {
    /// Where on the ray: a length in units along the ray's major axis (see [`Ray`]).
    pub t: N::Wide,
    /// The primitive, counted in scene-file order over all objects.
    pub primitive: u32,
    best: Best<N>,
}

/// The primitive that a ray meets first in its interval, found through the structure `A`.
///
/// Of hits at the same t the one that comes first in the scene file counts, so the answer is the
/// same whatever the structure. The stack must be as deep as the blob says.
#[inline]
pub fn closest_primitive<N: Number, A: Accel, C: Count>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
) -> Option<Found<N>> {
    let cull = A::Cull::<N>::new(ray);
    let mut search = Search::new(scene, ray, &cull);
    A::walk(scene, ray, &cull, stack, count, |leaf, count| {
        count.objects(leaf.count);
        search.leaf(leaf);
        Some(search.tmax)
    });
    let best = search.best?;
    Some(Found {
        t: best.t.widen() + ray.moved,
        primitive: best.primitive,
        best,
    })
}

impl<N: Number> Found<N> {
    /// The whole hit: the point and how the surface lies there. `scene` and `ray` are those of the
    /// query.
    pub fn hit(&self, scene: &Scene<'_>, ray: &Ray<N>) -> Option<Hit<N>> {
        let best = self.best;
        let point = ray.at(best.t);
        let index = best.index as usize;
        let surface = scene.shapes.surface(best.kind, index, best.part, point)?;
        let scale = extent(ray.origin).max(extent(point)).max(surface.extent);
        Some(Hit {
            t: self.t,
            point,
            normal: surface.normal,
            front: N::dot(surface.normal, ray.slope) < N::Wide::default(),
            object: scene.object(best.primitive),
            primitive: best.primitive,
            error: N::error_bound(scale),
        })
    }
}

/// The first hit of a ray in its interval: [`closest_primitive`] with its surface.
pub fn closest_hit<N: Number, A: Accel, C: Count>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
) -> Option<Hit<N>> {
    closest_primitive::<N, A, C>(scene, ray, stack, count)?.hit(scene, ray)
}

/// Whether a ray meets anything in its interval: whether [`closest_hit`] would find something.
pub fn any_hit<N: Number, A: Accel, C: Count>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    stack: &mut StackView,
    count: &mut C,
) -> bool {
    let cull = A::Cull::<N>::new(ray);
    let mut search = Search::new(scene, ray, &cull);
    A::walk(scene, ray, &cull, stack, count, |leaf, count| {
        count.objects(leaf.count);
        search.leaf(leaf);
        search.best.is_none().then_some(search.tmax)
    });
    search.best.is_some()
}
