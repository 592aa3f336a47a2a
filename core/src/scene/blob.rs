//! A scene: a checked view of a blob.

use crate::accel::{SceneGeometry, StructureViews};
use crate::format::lens::Lens;
use crate::format::light_form::LightForm;
use crate::format::limits::MAX_MEDIA;
use crate::format::record::{Emission, Header, Light, Material, Texture, UnitBox, View};
use crate::format::{Effects, Indices, Kind, Structure};
use crate::geometry::{Geometry, PrimitiveId};
use crate::instances::placed::Placed;
use crate::scene::environment::EnvironmentMap;
use crate::scene::textures::Textures;
use crate::simd::SimdLevel;
use crate::target::{
    DepthOfFieldOnly, EmissionOnly, EnvironmentOnly, FalloffOnly, GlossyOnly, IndirectOnly,
    InstancesOnly, NestedOnly, TextureOnly, WideOnly, inline_on_hosts_hint_on_boards,
};

/// A checked view of a blob: a few hundred bytes that borrow from it.
///
/// Once it exists, no blob can make a query panic, run forever or leave its arrays. [`Scene::from_bytes`] proves that,
/// and that the answers are right as well; or [`Prevalidated`](crate::Prevalidated) proves it.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The scene's box, primitives and leaves.
    pub(crate) geometry: SceneGeometry<'a>,
    /// The records of its structures.
    pub(crate) structures: StructureViews<'a>,
    pub(crate) view: &'a View,
    pub(crate) lights: &'a [Light],
    pub(in crate::scene) light_forms: FalloffOnly<&'a [LightForm]>,
    pub(crate) materials: &'a [Material],
    pub(in crate::scene) emissions: EmissionOnly<&'a [Emission]>,
    pub(in crate::scene) lens: DepthOfFieldOnly<&'a [Lens]>,
    pub(in crate::scene) bounces: IndirectOnly<u8>,
    pub(in crate::scene) media: NestedOnly<&'a [u32]>,
    pub(in crate::scene) object_first: Indices<'a>,
    pub(in crate::scene) object_material: Indices<'a>,
    pub(in crate::scene) order: Indices<'a>,
    pub(in crate::scene) effects: Effects,
    /// The roughness of its materials.
    pub(crate) rough: GlossyOnly<Rough<'a>>,
    /// Its textures.
    pub(crate) textures: TextureOnly<Textures<'a>>,
    /// The light around it.
    pub(crate) environment: EnvironmentOnly<EnvironmentMap<'a>>,
    /// Its instances and parts.
    pub(crate) placed: InstancesOnly<Placed<'a, Scene<'a>>>,
    /// True if any primitive's test needs the norm of the ray's direction.
    pub(crate) needs_norm: bool,
    /// True if any primitive is in no structure because it has no box.
    pub(crate) has_unbounded: bool,
}

/// The sections of rough materials.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rough<'a> {
    /// The α of the first materials.
    pub(crate) alphas: &'a [i32],
    /// For each of the first forms of lights, 1 where rays hit a surface that emits its light.
    pub(crate) shown_forms: &'a [u8],
}

impl<'a> Scene<'a> {
    /// Returns the header.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert_eq!(scene.header().blob_bytes as usize, BLOB.len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn header(&self) -> &'a Header {
        self.geometry.header
    }

    /// Camera, surroundings and rendering defaults.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert_eq!(scene.view().encoding, 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn view(&self) -> &'a View {
        self.view
    }

    /// Returns the lights.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert_eq!(scene.lights()[0].kind, 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn lights(&self) -> &'a [Light] {
        self.lights
    }

    /// Returns the forms of lights, which lights name by their numbers.
    pub fn light_forms(&self) -> &'a [LightForm] {
        self.light_forms.get().copied().unwrap_or_default()
    }

    /// For each of the first materials, the light that it emits; none where no material glows.
    pub fn emissions(&self) -> &'a [Emission] {
        self.emissions.get().copied().unwrap_or_default()
    }

    /// Returns the light that an object emits.
    #[inline(always)]
    pub fn emission(&self, object: u32) -> Option<&'a Emission> {
        let number = self.material_number(object);
        self.emissions().get(number as usize)
    }

    /// Returns the camera's lens; `None` for a pinhole.
    #[inline(always)]
    pub fn lens(&self) -> Option<&'a Lens> {
        self.lens.get()?.first()
    }

    /// Maximum number of diffuse reflections between the eye and a light; 0 where surfaces do not light each other.
    #[inline(always)]
    pub fn bounces(&self) -> u8 {
        self.bounces.get().copied().unwrap_or(0)
    }

    /// Returns the numbers of the materials with a priority, from the highest on; none where glass does not overlap.
    #[inline(always)]
    pub fn media(&self) -> &'a [u32] {
        self.media.get().copied().unwrap_or_default()
    }

    /// Returns the place of an object's material in the order of media; `None` for one without a priority.
    #[inline(always)]
    pub fn place_among_media(&self, object: u32) -> Option<u8> {
        let number = self.material_number(object);
        // Counted by hand: what `Iterator::position` adds could overflow, as far as the compiler knows.
        let mut place = 0_u8;
        for &medium in self.media().iter().take(MAX_MEDIA) {
            if medium == number {
                // A program can have replaced it with a material that is not glass.
                let material = self.materials.get(number as usize)?;
                return material.is_glass().then_some(place);
            }
            place = place.wrapping_add(1);
        }
        None
    }

    /// For each of the first materials, the α of its facets' distribution, with 30 fraction bits. It is 0 for a smooth
    /// material; the array is empty where no material is rough.
    pub fn roughnesses(&self) -> &'a [i32] {
        self.rough.get().map_or(&[], |rough| rough.alphas)
    }

    /// Returns the α of an object's facets; `None` for a smooth one.
    #[inline(always)]
    pub fn roughness(&self, object: u32) -> Option<i32> {
        let rough = self.rough.get()?;
        let number = self.material_number(object);
        let alpha = rough.alphas.get(number as usize).copied();
        alpha.filter(|&alpha| alpha != 0)
    }

    /// Returns true if rays hit a surface that emits a light. It is known where materials are rough.
    #[inline(always)]
    pub fn is_shown(&self, light: &Light) -> bool {
        let mark = || self.rough.get()?.shown_forms.get(light.form()? as usize);
        mark() == Some(&1)
    }

    /// Returns the form of a light.
    #[inline(always)]
    pub fn light_form(&self, light: &Light) -> Option<&'a LightForm> {
        self.light_forms().get(light.form()? as usize)
    }

    /// Returns the materials.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert!(scene.materials().iter().any(|material| material.mirror != [0; 3]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn materials(&self) -> &'a [Material] {
        self.materials
    }

    /// Returns the scene's box, for [`Ray::new`](crate::Ray::new).
    pub fn bounds(&self) -> &'a UnitBox {
        self.geometry.bounds()
    }

    /// Returns the effects that the scene requires.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::Effects;
    ///
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert_eq!(scene.effects(), Effects::SHADOW.with(Effects::MIRROR));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn effects(&self) -> Effects {
        self.effects
    }

    /// Entries that the traversal stack needs.
    pub fn stack_depth(&self) -> usize {
        self.geometry.header.stack_depth.into()
    }

    /// Returns true if the blob holds a structure.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::Structure;
    ///
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert!(scene.holds(Structure::DualSplit) && !scene.holds(Structure::Grid));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn holds(&self, structure: Structure) -> bool {
        self.geometry.holds(structure)
    }

    /// Returns the structures that the blob holds, the [best](Structure::BEST_FIRST) first.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::Structure;
    ///
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert!(scene.structures().eq([Structure::DualSplit, Structure::List]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn structures(&self) -> impl Iterator<Item = Structure> + use<'_, 'a> {
        let all = Structure::BEST_FIRST.into_iter();
        all.filter(|&structure| self.holds(structure))
    }

    /// Returns the best of the [structures](Self::structures) that the blob holds; every blob has the list.
    pub fn best_structure(&self) -> Structure {
        self.structures().next().unwrap_or(Structure::List)
    }

    /// Returns the scene with queries through [`Wide`](crate::Wide) at a level of instructions. The
    /// default is portable. Has no effect in a build without the feature `wide`.
    pub fn with_simd(self, simd: SimdLevel) -> Self {
        let mut scene = self;
        scene.geometry.simd = WideOnly::new(|| simd);
        scene
    }

    /// Returns the instructions that queries through [`Wide`](crate::Wide) use.
    pub fn simd(&self) -> SimdLevel {
        self.geometry.simd()
    }

    /// Number of primitives of a kind.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::Kind;
    ///
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert_eq!(scene.count(Kind::Sphere), 10);
    /// assert_eq!(scene.count(Kind::Triangle), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn count(&self, kind: Kind) -> usize {
        self.geometry.shapes.count(kind)
    }

    /// Number of vertices of all meshes.
    pub fn vertices(&self) -> usize {
        self.geometry.shapes.vertices.len()
    }

    /// Number of vertices that have a normal: see [`smooth`](crate::geometry::smooth).
    pub fn normals(&self) -> usize {
        self.geometry.shapes.normals().len()
    }

    /// Returns the colors of the first vertices: see [`attributes`](crate::geometry::attributes).
    pub fn vertex_colors(&self) -> &'a [[u8; 4]] {
        self.geometry.shapes.colors()
    }

    /// Number of maps.
    pub(crate) fn maps(&self) -> usize {
        self.textures.get().map_or(0, |it| it.maps.len())
    }

    /// Returns the textures.
    pub fn textures(&self) -> &'a [Texture] {
        self.textures.get().map_or(&[], |it| it.textures)
    }

    /// Returns the box of a primitive, given by its kind and its slot among those of that kind; `None` for one without
    /// bounds.
    pub fn primitive_bounds(&self, kind: Kind, slot: usize) -> Option<UnitBox> {
        self.geometry.shapes.bounds(kind, slot)
    }

    /// Returns the corners of a triangle in 1/256 unit, given by its slot.
    pub fn triangle(&self, slot: usize) -> Option<[[i32; 3]; 3]> {
        self.geometry.shapes.triangle(slot)
    }

    /// Returns the stored normals of a triangle's corners (see [`smooth`](crate::geometry::smooth)), given by the
    /// triangle's slot; `None` if the triangle is not smooth.
    pub fn corner_normals(&self, slot: usize) -> Option<[[i16; 2]; 3]> {
        Some(self.geometry.shapes.smooth_triangle(slot)?.normals)
    }

    /// Returns the colors of a triangle's corners (see [`attributes`](crate::geometry::attributes)), given by the
    /// triangle's slot; `None` where no corner has one.
    pub fn corner_colors(&self, slot: usize) -> Option<[[u8; 4]; 3]> {
        let all = self.geometry.shapes.colors();
        let vertices = self.geometry.shapes.triangles.corners(slot)?;
        let has_color = vertices.iter().any(|&vertex| vertex < all.len());
        let color = |vertex: usize| all.get(vertex).copied().unwrap_or([255; 4]);
        has_color.then(|| vertices.map(color))
    }

    /// Returns the texture coordinates of a triangle's corners, with 20 fraction bits, given by the triangle's slot;
    /// `None` where a corner has none.
    pub fn corner_coordinates(&self, slot: usize) -> Option<[[i32; 2]; 3]> {
        let vertices = self.geometry.shapes.triangles.corners(slot)?;
        self.geometry.shapes.coordinates().corners(vertices)
    }

    /// Returns a primitive in lattice coordinates, given by its kind and its slot among those of that kind.
    pub fn geometry(&self, kind: Kind, slot: usize) -> Option<Geometry> {
        self.geometry.shapes.geometry(kind, slot)
    }

    /// Returns the number, in scene-file order, of a primitive given by kind and slot. It is below the number of
    /// primitives. Several slots have one number where a triangle was cut into pieces.
    #[inline]
    pub fn primitive(&self, kind: Kind, slot: u32) -> u32 {
        self.primitive_at(self.geometry.shapes.place(kind, slot))
    }

    inline_on_hosts_hint_on_boards!(
        /// The number, in scene-file order, of a primitive at a location.
        pub(crate) fn primitive_at(&self, place: PrimitiveId) -> u32 {
            self.key(place).0
        }
    );

    inline_on_hosts_hint_on_boards!(
        /// The order of hits at the same t: by the primitive's number, and between pieces of one primitive by
        /// kind and slot. So answers do not depend on the structure.
        pub(crate) fn key(&self, place: PrimitiveId) -> (u32, u8, u32) {
            let PrimitiveId { kind, number, .. } = place;
            let Some(lane) = place.lane() else {
                return (self.in_slot(kind, number), kind as u8, number);
            };
            let clusters = self.geometry.shapes.clusters();
            if kind == Kind::Triangle {
                let members = clusters.strips.members(number);
                let member = members.map_or(0, |members| members.member(lane));
                self.member(kind, member, 0)
            } else {
                self.member(kind, number << 3 | lane, clusters.triangles())
            }
        }
    );

    /// The key of a member of a cluster, by its number among those of its kind and the number of
    /// members before them.
    #[inline(always)]
    fn member(&self, kind: Kind, number: u32, before: usize) -> (u32, u8, u32) {
        let clusters = self.geometry.shapes.clusters();
        let member = clusters.members.get(before + number as usize).unwrap_or(0);
        if clusters.locations.is_empty() {
            (member, kind as u8, number)
        } else {
            (self.in_slot(kind, member), kind as u8, member)
        }
    }

    /// The primitive in a slot of a kind that has records of its own.
    #[inline(always)]
    fn in_slot(&self, kind: Kind, slot: u32) -> u32 {
        let slot = self.geometry.shapes.slot(kind, slot);
        self.order.get(slot).unwrap_or(slot as u32)
    }

    /// Returns the object that a primitive belongs to.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// // Objects and primitives count in the order of the scene file.
    /// assert_eq!(scene.object(0), 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[cfg_attr(feature = "wide", inline)]
    pub fn object(&self, primitive: u32) -> u32 {
        if self.object_first.is_empty() {
            return if self.geometry.header.objects == self.geometry.header.primitives {
                primitive
            } else {
                0
            };
        }
        // The last object whose first primitive is not beyond this one.
        let (mut low, mut high) = (0_usize, self.object_first.len());
        while low.saturating_add(1) < high {
            let middle = low.midpoint(high);
            match self.object_first.get(middle) {
                Some(first) if first <= primitive => low = middle,
                _ => high = middle,
            }
        }
        low as u32
    }

    /// Returns the material of an object.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// let material = scene.material(0).expect("an object");
    /// assert_eq!(material.mirror, [0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    pub fn material(&self, object: u32) -> Option<&'a Material> {
        self.materials.get(self.material_number(object) as usize)
    }

    /// Returns the number of an object's material among the [materials](Self::materials).
    #[inline]
    pub fn material_number(&self, object: u32) -> u32 {
        self.object_material.get(object as usize).unwrap_or(0)
    }
}
