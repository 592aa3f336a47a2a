//! Primitives: where a ray crosses them, and how their surface lies there.
//!
//! One file a primitive. Each kernel gives the *crossing*: where the line of the ray enters and
//! leaves the primitive, behind the origin too. What of that is a hit is decided here, once for
//! all of them, in [`accept`].

#[cfg(feature = "wide")]
mod cluster;
pub(crate) mod cone;
pub(crate) mod cuboid;
pub(crate) mod disc;
mod kind;
#[cfg(feature = "wide")]
pub(crate) mod pack;
pub(crate) mod plane;
pub(crate) mod sphere;
#[cfg(feature = "wide")]
pub(crate) mod strip;
pub(crate) mod triangle;

#[cfg(feature = "wide")]
pub(crate) use cluster::{Clusters, Packs, Packs24, Strips};
pub use kind::Kind;
pub(crate) use kind::{WIDE_INDICES, WIDE_LATTICE};

use crate::accel::Leaf;
use crate::accel::cull::Culling;
use crate::format::record::{
    Cone, Corners, Cuboid, Disc, Sphere, Sphere16, Sphere24, UnitBox, Vertex, Vertex16, Vertex24,
};
use crate::number::Number;
use crate::ray::Ray;

/// Where a blob keeps a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    /// Among the records of its kind.
    Slot(Kind, u32),
    /// In a strip, at a place of it.
    #[cfg(feature = "wide")]
    Strip(u32, u8),
    /// In a pack, in a lane of it.
    #[cfg(feature = "wide")]
    Pack(u32, u8),
}

impl Place {
    /// The kind of the primitive.
    pub(crate) fn kind(self) -> Kind {
        match self {
            Place::Slot(kind, _) => kind,
            #[cfg(feature = "wide")]
            Place::Strip(..) => Kind::Triangle,
            #[cfg(feature = "wide")]
            Place::Pack(..) => Kind::Sphere,
        }
    }
}

/// The part of a primitive's surface that a crossing lies on; each kernel numbers its own.
pub(crate) type Part = u8;

/// Added to the part where a ray leaves a solid.
const LEAVING: Part = 1 << 7;

/// Where a line enters and leaves a primitive; the same place twice for a flat one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing<N> {
    pub(crate) enter: (N, Part),
    pub(crate) leave: (N, Part),
}

impl<N: Copy> Crossing<N> {
    #[inline(always)]
    pub(crate) fn flat(t: N) -> Self {
        Self {
            enter: (t, 0),
            leave: (t, 0),
        }
    }
}

/// How a surface lies where it was hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface<N> {
    /// Outward, or to the front; of length 1.
    pub(crate) normal: [N; 3],
    /// The point of the surface next to the one that the ray's t gives.
    pub(crate) point: [N; 3],
    /// The surface lies within this length of `point`, and what starts so far away along the normal does
    /// not meet it again.
    pub(crate) error: N,
    /// Whether `point` lies on the surface exactly, so that t is 0 for what starts there.
    pub(crate) is_exact: bool,
}

impl<N: Number> Surface<N> {
    /// The normal as a ray sees it that only grazes the surface.
    ///
    /// What a ray enters or leaves is known better than the normal, which the point's rounding turns
    /// where a solid is as thin as an error bound; and a grazing ray's may turn too far by a bit.
    #[cold]
    fn level_with(&self, ray: &Ray<N>) -> [N; 3] {
        let turned = N::wide_scale(N::dot(self.normal, ray.slope), N::recip_norm2(ray.slope));
        let turned = N::from_wide(turned);
        let axis = |k: usize| self.normal[k] - turned * ray.slope[k];
        let (normal, length) = N::normalize([axis(0), axis(1), axis(2)]);
        if length == N::ZERO {
            self.normal.map(|x| -x)
        } else {
            normal
        }
    }
}

/// The hit of a crossing in `tmin <= t <= tmax`, if there is one. A NaN is no hit.
#[inline(always)]
pub(crate) fn accept<N: Number>(ray: &Ray<N>, crossing: Crossing<N>, tmax: N) -> Option<(N, Part)> {
    let Crossing { enter, leave } = crossing;
    if enter.0 >= ray.tmin && enter.0 <= tmax {
        return Some(enter);
    }
    (leave.0 >= ray.tmin && leave.0 <= tmax).then_some((leave.0, leave.1 | LEAVING))
}

/// The same of a crossing that a kernel may have rounded out of the primitive's box.
///
/// `t` is clamped to the interval of the primitive's own box, which holds the true one: that never
/// adds to an error, and makes culling conservative whatever a kernel rounded.
#[inline(always)]
pub(crate) fn accept_in_box<N: Number, K: Culling<N>>(
    ray: &Ray<N>,
    cull: &K,
    crossing: Crossing<N>,
    bounds: UnitBox,
    tmax: N,
) -> Option<(N, Part)> {
    let Crossing { enter, leave } = crossing;
    // What clamping would not change needs no interval.
    if leave.0 >= enter.0 && K::holds(ray, enter.0, &bounds) {
        if enter.0 >= ray.tmin {
            return (enter.0 <= tmax).then_some(enter);
        }
        if leave.0 == enter.0 {
            return None;
        }
        if K::holds(ray, leave.0, &bounds) {
            let is_hit = leave.0 >= ray.tmin && leave.0 <= tmax;
            return is_hit.then_some((leave.0, leave.1 | LEAVING));
        }
    }
    let interval = cull.exact(ray).interval(&bounds);
    if interval.near > interval.far {
        return None;
    }
    let (near, far) = (N::from_cull(interval.near), N::from_cull(interval.far));
    let clamp = |t: N| {
        if t < near {
            near
        } else if t > far {
            far
        } else {
            t
        }
    };
    let clamped = Crossing {
        enter: (clamp(enter.0), enter.1),
        leave: (clamp(leave.0), leave.1),
    };
    accept(ray, clamped, tmax)
}

/// Where a ray crosses a plane through `relative` (a point as seen from the ray's origin) with a normal of
/// any length, of which `approach` is the product with the ray's slope. `None` where the ray runs along
/// the plane.
#[inline(always)]
pub(crate) fn cross_plane<N: Number>(
    normal: [N; 3],
    relative: [N; 3],
    approach: N::Wide,
) -> Option<N> {
    if approach == N::Wide::default() {
        return None;
    }
    Some(N::divide(N::dot(normal, relative), approach))
}

/// The larger of two extents, for error bounds.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn extent<N: Number>(coordinates: [N; 3]) -> N {
    coordinates[0]
        .abs()
        .max(coordinates[1].abs())
        .max(coordinates[2].abs())
}

/// The vertices of all meshes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Vertices<'a> {
    V16(&'a [Vertex16]),
    V24(&'a [Vertex24]),
}

impl Vertices<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Vertices::V16(vertices) => vertices.len(),
            Vertices::V24(vertices) => vertices.len(),
        }
    }

    /// A vertex in 1/256 unit.
    pub(crate) fn position(&self, index: usize) -> Option<[i32; 3]> {
        match self {
            Vertices::V16(vertices) => vertices.get(index).map(Vertex::position),
            Vertices::V24(_) if !WIDE_LATTICE => None,
            Vertices::V24(vertices) => vertices.get(index).map(Vertex::position),
        }
    }
}

/// The triangles of all meshes, as vertex indices.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Triangles<'a> {
    U16(&'a [[u16; 3]]),
    U32(&'a [[u32; 3]]),
}

impl Triangles<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Triangles::U16(triangles) => triangles.len(),
            Triangles::U32(triangles) => triangles.len(),
        }
    }

    pub(crate) fn corners(&self, index: usize) -> Option<[usize; 3]> {
        match self {
            Triangles::U16(triangles) => triangles.get(index).map(Corners::corners),
            Triangles::U32(_) if !WIDE_INDICES => None,
            Triangles::U32(triangles) => triangles.get(index).map(Corners::corners),
        }
    }
}

/// All spheres.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spheres<'a> {
    S16(&'a [Sphere16]),
    S24(&'a [Sphere24]),
}

impl Spheres<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Spheres::S16(spheres) => spheres.len(),
            Spheres::S24(spheres) => spheres.len(),
        }
    }

    pub(crate) fn get(&self, index: usize) -> Option<([i32; 3], i32)> {
        match self {
            Spheres::S16(spheres) => spheres.get(index).map(Sphere::lattice),
            Spheres::S24(_) if !WIDE_LATTICE => None,
            Spheres::S24(spheres) => spheres.get(index).map(Sphere::lattice),
        }
    }
}

/// All primitives of a blob, each kind in an array of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shapes<'a> {
    pub(crate) vertices: Vertices<'a>,
    pub(crate) triangles: Triangles<'a>,
    pub(crate) spheres: Spheres<'a>,
    pub(crate) boxes: &'a [Cuboid],
    pub(crate) discs: &'a [Disc],
    pub(crate) cones: &'a [Cone],
    /// Where there are both, the same triangles and spheres lie in clusters as in the arrays above.
    #[cfg(feature = "wide")]
    pub(crate) clusters: Clusters<'a>,
}

impl Shapes<'_> {
    /// Number of primitives of a kind.
    pub(crate) fn count(&self, kind: Kind) -> usize {
        let records = self.records(kind);
        #[cfg(feature = "wide")]
        if records == 0 {
            return match kind {
                Kind::Triangle => self.clusters.triangles(),
                Kind::Sphere => self.clusters.spheres(),
                _ => 0,
            };
        }
        records
    }

    /// Number of primitives of a kind that have records of their own.
    pub(crate) fn records(&self, kind: Kind) -> usize {
        match kind {
            _ if !kind.is_available() => 0,
            Kind::Triangle => self.triangles.len(),
            Kind::Sphere => self.spheres.len(),
            Kind::Box => self.boxes.len(),
            Kind::Disc => self.discs.len(),
            Kind::Cone => self.cones.len(),
        }
    }

    /// Number of primitives that have records of their own.
    pub(crate) fn total(&self) -> usize {
        self.before(Kind::ALL.len())
    }

    /// Number of clusters of a kind whose primitives lie nowhere else.
    #[cfg(feature = "wide")]
    pub(crate) fn sole_clusters(&self, kind: Kind) -> usize {
        match kind {
            Kind::Triangle if self.triangles.len() == 0 => self.clusters.strips.len(),
            Kind::Sphere if self.spheres.len() == 0 => self.clusters.packs.len(),
            _ => 0,
        }
    }

    /// Where the primitive of a slot lies: triangles and spheres that have no records of their own
    /// are counted in the order of the clusters.
    pub(crate) fn place(&self, kind: Kind, slot: u32) -> Place {
        #[cfg(feature = "wide")]
        if self.records(kind) == 0 {
            let index = slot as usize;
            let found = match kind {
                Kind::Triangle => {
                    let found = self.clusters.find_triangle(index);
                    found.map(|(strip, place)| Place::Strip(strip, place as u8))
                }
                // All packs but the last are full.
                Kind::Sphere => Some(Place::Pack(slot >> 3, (slot & 7) as u8)),
                _ => None,
            };
            return found.unwrap_or(Place::Slot(kind, slot));
        }
        Place::Slot(kind, slot)
    }

    /// The slot of a primitive among those of all kinds that have records of their own.
    pub(crate) fn slot(&self, kind: Kind, index: u32) -> usize {
        self.before(kind as usize).wrapping_add(index as usize)
    }

    /// Number of primitives of the first so many kinds: all of them are records of one slice of
    /// memory, so no sum wraps.
    fn before(&self, kinds: usize) -> usize {
        let kinds = Kind::ALL.iter().take(kinds);
        kinds.fold(0, |sum: usize, &kind| sum.wrapping_add(self.records(kind)))
    }

    /// The primitive of a slot among those of all kinds, as a leaf of its own; an empty leaf beyond
    /// the last.
    #[inline(always)]
    pub(crate) fn single(&self, slot: u32) -> Leaf {
        let mut first = slot;
        for kind in Kind::ALL {
            let count = self.records(kind) as u32;
            if first < count {
                let count = 1;
                return Leaf { kind, first, count };
            }
            first = first.wrapping_sub(count);
        }
        Leaf {
            kind: Kind::Triangle,
            first: 0,
            count: 0,
        }
    }

    /// The corners of a triangle in 1/256 unit, given by its slot.
    pub(crate) fn triangle(&self, slot: usize) -> Option<[[i32; 3]; 3]> {
        match self.place(Kind::Triangle, slot as u32) {
            #[cfg(feature = "wide")]
            Place::Strip(strip, place) => self.clusters.strips.triangle(strip, place.into()),
            _ => self.indexed_triangle(slot),
        }
    }

    pub(crate) fn indexed_triangle(&self, index: usize) -> Option<[[i32; 3]; 3]> {
        let [a, b, c] = self.triangles.corners(index)?;
        let position = |corner| self.vertices.position(corner);
        Some([position(a)?, position(b)?, position(c)?])
    }

    /// The box of a primitive.
    pub(crate) fn bounds(&self, kind: Kind, index: usize) -> Option<UnitBox> {
        Some(match kind {
            _ if !kind.is_available() => return None,
            Kind::Triangle => triangle::bounds(self.triangle(index)?),
            Kind::Sphere => {
                let (center, radius) = match self.place(kind, index as u32) {
                    #[cfg(feature = "wide")]
                    Place::Pack(pack, lane) => self.clusters.packs.sphere(pack, lane.into())?,
                    _ => self.spheres.get(index)?,
                };
                sphere::bounds(center, radius)
            }
            Kind::Box => self.boxes.get(index)?.bounds(),
            Kind::Disc => self.discs.get(index)?.bounds,
            Kind::Cone => self.cones.get(index)?.bounds,
        })
    }

    /// Whether all primitives of a leaf exist and lie in a box.
    pub(crate) fn leaf_inside(&self, leaf: Leaf, outer: &UnitBox) -> bool {
        leaf.slots().all(|index| {
            self.bounds(leaf.kind, index)
                .is_some_and(|bounds| outer.contains(&bounds))
        })
    }

    /// How a primitive's surface lies where a ray hit it, and whether the ray came from the side to
    /// which the normal points.
    #[cfg_attr(feature = "wide", inline(always))]
    pub(crate) fn surface<N: Number>(
        &self,
        place: Place,
        part: Part,
        ray: &Ray<N>,
        point: [N; 3],
    ) -> Option<(Surface<N>, bool)> {
        let leaves = part & LEAVING != 0;
        let part = part & !LEAVING;
        let mut surface = match place {
            #[cfg(feature = "wide")]
            Place::Strip(strip, place) => {
                triangle::surface(self.clusters.strips.triangle(strip, place.into())?, point)
            }
            #[cfg(feature = "wide")]
            Place::Pack(pack, lane) => {
                let (center, radius) = self.clusters.packs.sphere(pack, lane.into())?;
                sphere::surface(center, radius, point)
            }
            Place::Slot(kind, slot) => {
                let toward = if leaves {
                    ray.slope
                } else {
                    ray.slope.map(|x| -x)
                };
                self.surface_in_slot(kind, slot as usize, part, [point, toward])?
            }
        };
        if place.kind() == Kind::Cone {
            // Its point is the ray's, which is off by what all coordinates round.
            let magnitude = extent(ray.origin).max(extent(point));
            surface.error = surface.error.max(N::error_bound(magnitude));
        }
        let against = N::dot(surface.normal, ray.slope) < N::Wide::default();
        let front = match place.kind() {
            Kind::Triangle | Kind::Disc => against,
            Kind::Sphere | Kind::Box | Kind::Cone => !leaves,
        };
        if front != against {
            surface.normal = surface.level_with(ray);
        }
        Some((surface, front))
    }

    /// The surface of a primitive that has a record of its own, at a point, and the way towards where
    /// it is seen from.
    #[cfg_attr(feature = "wide", inline(never))]
    #[cfg_attr(not(feature = "wide"), inline(always))]
    fn surface_in_slot<N: Number>(
        &self,
        kind: Kind,
        index: usize,
        part: Part,
        [point, toward]: [[N; 3]; 2],
    ) -> Option<Surface<N>> {
        Some(match kind {
            _ if !kind.is_available() => return None,
            Kind::Triangle => triangle::surface(self.indexed_triangle(index)?, point),
            Kind::Sphere => {
                let (center, radius) = self.spheres.get(index)?;
                sphere::surface(center, radius, point)
            }
            Kind::Box => self.boxes.get(index)?.surface(part, point),
            Kind::Disc => self.discs.get(index)?.surface(point),
            Kind::Cone => self.cones.get(index)?.surface(part, point, toward),
        })
    }

    /// A point beneath a point of a primitive's surface: `depth` away from it along the normal, and
    /// in solids beneath all other faces by what is their bound, as far as they are thick enough.
    ///
    /// At an edge or a rim the way along the normal alone could lead out again.
    #[inline(never)]
    pub(crate) fn inside<N: Number>(
        &self,
        kind: Kind,
        index: usize,
        [point, normal]: [[N; 3]; 2],
        depth: N,
    ) -> [N; 3] {
        match kind {
            Kind::Box if kind.is_available() => match self.boxes.get(index) {
                Some(cuboid) => cuboid.inside(point),
                None => point,
            },
            Kind::Cone if kind.is_available() => match self.cones.get(index) {
                Some(cone) => cone.inside(point, depth),
                None => point,
            },
            _ => {
                let axis = |k: usize| point[k] - depth * normal[k];
                [axis(0), axis(1), axis(2)]
            }
        }
    }
}

#[cfg(test)]
mod tests;
