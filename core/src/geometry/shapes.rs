//! All primitives of a blob, each kind in an array of its own.

use crate::format::limits::{WIDE_INDICES, WIDE_LATTICE};
use crate::format::record::{
    Cone, Corners, Cuboid, Disc, Sphere, Sphere16, Sphere24, UnitBox, Vertex, Vertex16, Vertex24,
};
use crate::format::{Kind, Leaf};
#[cfg(feature = "wide")]
use crate::geometry::Clusters;
use crate::geometry::{LEAVING, Part, PrimitiveId, Surface, sphere, triangle};
use crate::number::Arithmetic;
use crate::number::extent;
use crate::ray::Ray;

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
    pub(crate) fn place(&self, kind: Kind, slot: u32) -> PrimitiveId {
        #[cfg(feature = "wide")]
        if self.records(kind) == 0 {
            let index = slot as usize;
            let found = match kind {
                Kind::Triangle => {
                    let found = self.clusters.find_triangle(index);
                    found.map(|(strip, place)| PrimitiveId::Strip(strip, place as u8))
                }
                // All packs but the last are full.
                Kind::Sphere => Some(PrimitiveId::Pack(slot >> 3, (slot & 7) as u8)),
                _ => None,
            };
            return found.unwrap_or(PrimitiveId::Slot(kind, slot));
        }
        PrimitiveId::Slot(kind, slot)
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
            PrimitiveId::Strip(strip, place) => self.clusters.strips.triangle(strip, place.into()),
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
                    PrimitiveId::Pack(pack, lane) => {
                        self.clusters.packs.sphere(pack, lane.into())?
                    }
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
    pub(crate) fn surface<N: Arithmetic>(
        &self,
        place: PrimitiveId,
        part: Part,
        ray: &Ray<N>,
        point: [N; 3],
    ) -> Option<(Surface<N>, bool)> {
        let leaves = part & LEAVING != 0;
        let part = part & !LEAVING;
        let mut surface = match place {
            #[cfg(feature = "wide")]
            PrimitiveId::Strip(strip, place) => {
                triangle::surface(self.clusters.strips.triangle(strip, place.into())?, point)
            }
            #[cfg(feature = "wide")]
            PrimitiveId::Pack(pack, lane) => {
                let (center, radius) = self.clusters.packs.sphere(pack, lane.into())?;
                sphere::surface(center, radius, point)
            }
            PrimitiveId::Slot(kind, slot) => {
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
    fn surface_in_slot<N: Arithmetic>(
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
    pub(crate) fn inside<N: Arithmetic>(
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

/// A primitive of any kind, in 1/256 unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Geometry {
    /// Its corners, counter-clockwise as seen from the front.
    Triangle([[i32; 3]; 3]),
    /// A sphere.
    Sphere {
        /// Its centre.
        center: [i32; 3],
        /// Its radius.
        radius: i32,
    },
    /// A box.
    Box(Cuboid),
    /// A disc.
    Disc(Disc),
    /// A cylinder, cone or frustum.
    Cone(Cone),
}
