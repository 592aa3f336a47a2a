//! All primitives of a blob, each kind in an array of its own.

use crate::format::kind::shapes;
use crate::format::limits::{SMOOTH, UNBOUNDED, WIDE_INDICES, WIDE_LATTICE};
use crate::format::range::{At, at_most};
use crate::format::record::{Header, UnitBox};
use crate::format::{BlobError, Field, Kind, Leaf, SectionKind, Sections};
use crate::geometry::Clusters;
use crate::geometry::attributes::{Coordinates, at_most_vertices};
use crate::geometry::primitive::{InScene, Primitive, offset_inward};
use crate::geometry::smooth::{self, SmoothTriangle};
use crate::geometry::sphere::{self, Spheres};
use crate::geometry::triangle::{self, Triangles, Vertices};
use crate::geometry::{LEAVING, Part, PrimitiveId, Surface};
use crate::number::Arithmetic;
use crate::ray::Ray;
use crate::target::{
    SmoothOnly, TEXTURE, TextureOnly, VERTEX_COLORS, VertexColorsOnly, WIDE, WideOnly,
    inline_on_boards, inline_on_hosts,
};

macro_rules! registry {
    (
        forms { $($form:tt)* }
        records { $(
            $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal,
            [$field:ident: $module:ident::$record:ident], [$section:ident = $id:literal, $section_name:literal];
        )* }
    ) => {
        /// All primitives of a blob, each kind in an array of its own.
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct Shapes<'a> {
            pub(crate) vertices: Vertices<'a>,
            pub(crate) triangles: Triangles<'a>,
            pub(crate) spheres: Spheres<'a>,
            $(pub(crate) $field: &'a [super::$module::$record],)*
            /// Triangles and spheres in clusters. If the arrays above are present too, both hold the same primitives.
            clusters: WideOnly<Clusters<'a>>,
            /// Normals of the first vertices.
            normals: SmoothOnly<&'a [[i16; 2]]>,
            /// Colors of the first vertices.
            colors: VertexColorsOnly<&'a [[u8; 4]]>,
            /// Texture coordinates of the first vertices.
            coordinates: TextureOnly<Coordinates<'a>>,
        }

        /// A primitive of any kind, in 1/256 unit.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Geometry {
            /// Its corners, counter-clockwise as seen from the front.
            Triangle([[i32; 3]; 3]),
            /// A sphere.
            Sphere {
                /// Its center.
                center: [i32; 3],
                /// Its radius.
                radius: i32,
            },
            $($(#[doc = $doc])* $kind(super::$module::$record),)*
        }

        impl Kind {
            /// Returns true if surfaces of this kind can enclose something: not discs and planes.
            pub const fn encloses(self) -> bool {
                matches!(self, Kind::Triangle) || !is_flat(self)
            }
        }

        /// Returns true if a shape has no inside: its front is the side to which its normal points.
        #[inline(always)]
        pub(crate) const fn is_flat(kind: Kind) -> bool {
            match kind {
                Kind::Triangle => true,
                Kind::Sphere => false,
                $(Kind::$kind => super::$module::$record::FLAT,)*
            }
        }

        /// Returns true if a shape's normal is made perpendicular to the ray where it points to the wrong side.
        #[inline(always)]
        const fn is_leveled(kind: Kind) -> bool {
            match kind {
                Kind::Triangle | Kind::Sphere => true,
                $(Kind::$kind => super::$module::$record::LEVELED,)*
            }
        }

        impl Kind {
            /// Returns true if primitives of the kind have a box. Those without a box are in no structure: every query
            /// tests them first. In builds without code for such kinds it is always true.
            #[inline(always)]
            pub const fn is_bounded(self) -> bool {
                match self {
                    _ if !UNBOUNDED => true,
                    Kind::Triangle | Kind::Sphere => true,
                    $(Kind::$kind => super::$module::$record::BOUNDED,)*
                }
            }

            /// The last kind that leaves hold. Kinds without boxes come behind it, so that the others have the first slots.
            pub(crate) const LAST_BOUNDED: Kind = {
                let mut last = 0;
                while last + 1 < Kind::ALL.len() && Kind::ALL[last + 1].is_bounded() {
                    last += 1;
                }
                Kind::ALL[last]
            };
        }

        impl<'a> Shapes<'a> {
            /// Finds the records of a blob, or says which code for them this build lacks.
            pub(crate) fn read(sections: &Sections<'a>, header: &Header) -> Result<Self, BlobError> {
                let short = header.storage_bits == 16;
                let holds = |section| sections.len(section) > 0;
                let (triangles, spheres) = (holds(SectionKind::Triangles), holds(SectionKind::Spheres));
                let sole = holds(SectionKind::Strips) && !triangles
                    || holds(SectionKind::Packs) && !spheres;
                let wide_indices = triangles && !triangle::is_narrow(sections);
                let lacks = |is_held: bool, is_available: bool, missing| match is_held && !is_available {
                    true => Err(BlobError::MissingPart { missing }),
                    false => Ok(()),
                };
                lacks(sole, WIDE, "wide")?;
                lacks(triangles, Kind::Triangle.is_available(), Kind::Triangle.name())?;
                lacks(spheres, Kind::Sphere.is_available(), Kind::Sphere.name())?;
                $(lacks(holds(SectionKind::$section), Kind::$kind.is_available(), $name)?;)*
                lacks(!short, WIDE_LATTICE, "wide-lattice")?;
                lacks(wide_indices, WIDE_INDICES, "wide-indices")?;
                let normals = match SMOOTH {
                    true => sections.records(SectionKind::Normals)?,
                    false => &[],
                };
                let colors = match VERTEX_COLORS {
                    true => sections.records(SectionKind::VertexColors)?,
                    false => &[],
                };
                let coordinates = match TEXTURE {
                    true => Coordinates::read(sections)?,
                    false => Coordinates::default(),
                };
                let clusters = match WIDE {
                    true => Clusters::read(sections, short)?,
                    false => Clusters::NONE,
                };
                Ok(Self {
                    vertices: Vertices::read(sections, short)?,
                    triangles: Triangles::read(sections)?,
                    spheres: Spheres::read(sections, short)?,
                    // Without the code there are none: see above.
                    $($field: if Kind::$kind.is_available() {
                        sections.records(SectionKind::$section)?
                    } else {
                        &[]
                    },)*
                    clusters: WideOnly::new(|| clusters),
                    normals: SmoothOnly::new(|| normals),
                    colors: VertexColorsOnly::new(|| colors),
                    coordinates: TextureOnly::new(|| coordinates),
                })
            }

            /// Proves that all records lie in the scene's box and that their fields are in range.
            pub(crate) fn validate(&self, header: &Header) -> Result<(), BlobError> {
                let slots = self.total() as u32;
                at_most(Field::Slots, slots, header.primitives)?;
                let bounds = &header.bounds;
                let vertices = self.vertices.validate(bounds)?;
                self.triangles.validate(self.records(Kind::Triangle), vertices)?;
                if SMOOTH {
                    smooth::validate(self.normals(), vertices)?;
                }
                at_most_vertices(SectionKind::VertexColors, self.colors().len(), vertices)?;
                let coordinates = self.coordinates().len();
                at_most_vertices(SectionKind::TextureCoordinates, coordinates, vertices)?;
                self.spheres.validate(self.records(Kind::Sphere), bounds)?;
                $(if Kind::$kind.is_available() {
                    validate(self.$field, SectionKind::$section, bounds)?;
                })*
                Ok(())
            }

            /// Number of primitives of a kind that have records of their own.
            pub(crate) fn records(&self, kind: Kind) -> usize {
                match kind {
                    _ if !kind.is_available() => 0,
                    Kind::Triangle => self.triangles.len(),
                    Kind::Sphere => self.spheres.len(),
                    $(Kind::$kind => self.$field.len(),)*
                }
            }

            /// Returns true if any primitive's test needs the norm of the ray's direction.
            pub(crate) fn needs_norm(&self) -> bool {
                self.count(Kind::Sphere) > 0
                    $(|| super::$module::$record::NEEDS_NORM && self.count(Kind::$kind) > 0)*
            }

            /// Returns true if any primitive has no box.
            pub(crate) fn has_unbounded(&self) -> bool {
                UNBOUNDED
                    && Kind::ALL.into_iter().any(|kind| !kind.is_bounded() && self.records(kind) > 0)
            }

            /// The box of a primitive; `None` where it has none.
            pub(crate) fn bounds(&self, kind: Kind, index: usize) -> Option<UnitBox> {
                Some(match kind {
                    _ if !kind.is_available() => return None,
                    Kind::Triangle => triangle::bounds(self.triangle(index)?),
                    Kind::Sphere => self.sphere_bounds(index)?,
                    $(Kind::$kind if Kind::$kind.is_available() && Kind::$kind.is_bounded() => {
                        Primitive::bounds(self.$field.get(index)?)
                    })*
                    _ => return None,
                })
            }

            /// A primitive as it lies on the lattice.
            pub(crate) fn geometry(&self, kind: Kind, index: usize) -> Option<Geometry> {
                Some(match kind {
                    Kind::Triangle => Geometry::Triangle(self.triangle(index)?),
                    Kind::Sphere => {
                        let (center, radius) = self.sphere(index)?;
                        Geometry::Sphere { center, radius }
                    }
                    $(Kind::$kind => Geometry::$kind(*self.$field.get(index)?),)*
                })
            }

            inline_on_boards!(
                /// The surface of a primitive that has a record of its own, where a ray meets it.
                fn surface_in_slot<N: Arithmetic>(
                    &self,
                    kind: Kind,
                    index: usize,
                    ray: &Ray<N>,
                    part: Part,
                    point: [N; 3],
                ) -> Option<Surface<N>> {
                    Some(match kind {
                        _ if !kind.is_available() => return None,
                        Kind::Triangle => triangle::surface(self.indexed_triangle(index)?, point),
                        Kind::Sphere => {
                            let (center, radius) = self.spheres.get(index)?;
                            sphere::surface(center, radius, point)
                        }
                        // The optimizer needs this guard to leave out the shapes that a build lacks.
                        $(Kind::$kind if !UNBOUNDED || Kind::$kind.is_available() => {
                            self.$field.get(index)?.surface(ray, part, point)
                        })*
                        _ => return None,
                    })
                }
            );

            /// A point beneath a point of a primitive's surface: `depth` away from it along the normal, and
            /// in solids beneath all other faces by what is their bound, as far as they are thick enough.
            ///
            /// At an edge or a rim the way along the normal alone could lead out again.
            #[inline(never)]
            pub(crate) fn inside<N: Arithmetic>(
                &self,
                kind: Kind,
                index: usize,
                surface: [[N; 3]; 2],
                depth: N,
            ) -> [N; 3] {
                match kind {
                    $(Kind::$kind if kind.is_available() && !is_flat(kind) => match self.$field.get(index) {
                        Some(record) => record.inside(surface, depth),
                        None => surface[0],
                    },)*
                    _ => offset_inward(surface[0], surface[1], depth),
                }
            }
        }
    };
}

shapes!(registry);

/// Proves the records of a section.
fn validate<T: Primitive>(
    records: &[T],
    section: SectionKind,
    bounds: &UnitBox,
) -> Result<(), BlobError> {
    records.iter().enumerate().try_for_each(|(index, record)| {
        let at = At { section, index };
        record.validate(InScene { at, bounds })
    })
}

impl<'a> Shapes<'a> {
    /// The clusters.
    #[inline(always)]
    pub(crate) fn clusters(&self) -> &Clusters<'a> {
        self.clusters.get().unwrap_or(&Clusters::NONE)
    }

    /// Number of primitives of a kind.
    pub(crate) fn count(&self, kind: Kind) -> usize {
        let records = self.records(kind);
        if WIDE && records == 0 {
            return match kind {
                Kind::Triangle => self.clusters().triangles(),
                Kind::Sphere => self.clusters().spheres(),
                _ => 0,
            };
        }
        records
    }

    /// Number of primitives that have records of their own.
    pub(crate) fn total(&self) -> usize {
        self.before(Kind::ALL.len())
    }

    /// Number of primitives that also have a box: structures count slots among them.
    pub(crate) fn bounded(&self) -> usize {
        let kinds = Kind::ALL.iter().filter(|kind| kind.is_bounded());
        kinds.fold(0, |sum: usize, &kind| sum.wrapping_add(self.records(kind)))
    }

    /// Number of clusters of a kind whose primitives lie nowhere else.
    pub(crate) fn sole_clusters(&self, kind: Kind) -> usize {
        match kind {
            Kind::Triangle if self.triangles.len() == 0 => self.clusters().strips.len(),
            Kind::Sphere if self.spheres.len() == 0 => self.clusters().packs.len(),
            _ => 0,
        }
    }

    /// The location of the primitive of a slot. Triangles and spheres without records of their own are counted in the
    /// order of the clusters.
    pub(crate) fn place(&self, kind: Kind, slot: u32) -> PrimitiveId {
        if WIDE && self.records(kind) == 0 {
            let index = slot as usize;
            let found = match kind {
                Kind::Triangle => {
                    let found = self.clusters().find_triangle(index);
                    found.map(|(strip, place)| PrimitiveId::in_cluster(kind, strip, place))
                }
                // All packs but the last are full.
                Kind::Sphere => Some(PrimitiveId::in_cluster(kind, slot >> 3, slot & 7)),
                _ => None,
            };
            return found.unwrap_or(PrimitiveId::in_slot(kind, slot));
        }
        PrimitiveId::in_slot(kind, slot)
    }

    /// The slot of a primitive among those of all kinds that have records of their own.
    pub(crate) fn slot(&self, kind: Kind, index: u32) -> usize {
        self.before(kind as usize).wrapping_add(index as usize)
    }

    /// Number of primitives of the first kinds, this many. All of them are records of one slice of memory, so no sum
    /// wraps.
    fn before(&self, kinds: usize) -> usize {
        let kinds = Kind::ALL.iter().take(kinds);
        kinds.fold(0, |sum: usize, &kind| sum.wrapping_add(self.records(kind)))
    }

    /// The primitive of a slot among those that have a box, as a leaf of its own; an empty leaf beyond the last.
    #[inline(always)]
    pub(crate) fn single(&self, slot: u32) -> Leaf {
        let mut first = slot;
        for kind in Kind::ALL.into_iter().filter(|kind| kind.is_bounded()) {
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
        let id = self.place(Kind::Triangle, slot as u32);
        match id.lane() {
            Some(place) => self.clusters().strips.triangle(id.number, place),
            None => self.indexed_triangle(slot),
        }
    }

    pub(crate) fn indexed_triangle(&self, index: usize) -> Option<[[i32; 3]; 3]> {
        let [a, b, c] = self.triangles.corners(index)?;
        let position = |corner| self.vertices.position(corner);
        Some([position(a)?, position(b)?, position(c)?])
    }

    /// Removes the normals, where vertices move.
    pub(crate) fn drop_normals(&mut self) {
        self.normals = SmoothOnly::new(Default::default);
    }

    /// Replaces the normals by others.
    pub(crate) fn replace_normals(&mut self, others: &'a [[i16; 2]]) {
        self.normals = SmoothOnly::new(|| others);
    }

    /// The normals of the first vertices; none in builds without the code for them.
    pub(crate) fn normals(&self) -> &'a [[i16; 2]] {
        self.normals.get().copied().unwrap_or_default()
    }

    /// The colors of the first vertices; none in builds without the code for them.
    #[inline(always)]
    pub(crate) fn colors(&self) -> &'a [[u8; 4]] {
        self.colors.get().copied().unwrap_or_default()
    }

    /// The texture coordinates of the first vertices; none in builds without the code for them.
    #[inline(always)]
    pub(crate) fn coordinates(&self) -> Coordinates<'a> {
        self.coordinates.get().copied().unwrap_or_default()
    }

    /// The corners of a triangle in a slot and their normals, if there are any.
    #[inline(always)]
    pub(crate) fn smooth_triangle(&self, slot: usize) -> Option<SmoothTriangle> {
        let [a, b, c] = self.triangles.corners(slot)?;
        let all = self.normals();
        let normals = [*all.get(a)?, *all.get(b)?, *all.get(c)?];
        let position = |corner| self.vertices.position(corner);
        let corners = [position(a)?, position(b)?, position(c)?];
        Some(SmoothTriangle { corners, normals })
    }

    /// A sphere, of which some blobs have no record but in a cluster.
    fn sphere(&self, index: usize) -> Option<([i32; 3], i32)> {
        self.sphere_at(self.place(Kind::Sphere, index as u32))
    }

    /// Center and radius of the sphere at a place, in 1/256 unit.
    #[inline(always)]
    pub(crate) fn sphere_at(&self, place: PrimitiveId) -> Option<([i32; 3], i32)> {
        match place.lane() {
            Some(lane) => self.clusters().packs.sphere(place.number, lane),
            None => self.spheres.get(place.number as usize),
        }
    }

    /// The box of a sphere.
    fn sphere_bounds(&self, index: usize) -> Option<UnitBox> {
        let (center, radius) = self.sphere(index)?;
        Some(sphere::bounds(center, radius))
    }

    /// Returns true if all primitives of a leaf exist and lie in a box.
    pub(crate) fn leaf_inside(&self, leaf: Leaf, outer: &UnitBox) -> bool {
        leaf.slots().all(|index| {
            self.bounds(leaf.kind, index)
                .is_some_and(|bounds| outer.contains(&bounds))
        })
    }

    inline_on_hosts!(
        /// Returns the surface of a primitive where a ray hit it, and true if the ray came from the side to which the
        /// normal points.
        pub(crate) fn surface<N: Arithmetic>(
            &self,
            place: PrimitiveId,
            part: Part,
            ray: &Ray<N>,
            point: [N; 3],
        ) -> Option<(Surface<N>, bool)> {
            let mut surface = match (place.lane(), place.kind) {
                (None, kind) => {
                    self.surface_in_slot(kind, place.number as usize, ray, part, point)?
                }
                (Some(lane), Kind::Triangle) => {
                    triangle::surface(self.clusters().strips.triangle(place.number, lane)?, point)
                }
                (Some(_), _) => {
                    let (center, radius) = self.sphere_at(place)?;
                    sphere::surface(center, radius, point)
                }
            };
            let against = N::dot(surface.normal, ray.slope) < N::Wide::default();
            let front = if is_flat(place.kind) {
                against
            } else {
                part & LEAVING == 0
            };
            if front != against && is_leveled(place.kind) {
                surface.normal = surface.level_with(ray);
            }
            Some((surface, front))
        }
    );
}
