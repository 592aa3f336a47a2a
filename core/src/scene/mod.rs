//! The scene blob: records in one aligned slice, checked once and then read in place.
//!
//! `FORMAT.md` beside the crate's manifest specifies every byte.

mod check;
pub(crate) mod prevalidated;
mod read;

pub use prevalidated::Vouched;

use crate::accel::{Held, Leaf, Structure};
use crate::format::{BlobError, Indices, Sections, record};
use crate::geometry::{Kind, Place, Shapes};
use crate::shade::Effects;
#[cfg(feature = "wide")]
use crate::simd::SimdLevel;
use record::{Cone, Cuboid, Disc, Header, Light, Material, UnitBox, View};

/// A checked view of a blob: a few hundred bytes that borrow from it.
///
/// Once it exists, no blob can make a query panic, run forever or leave its arrays: that was proved
/// by [`Scene::from_bytes`], which proves that the answers are right as well, or by [`Vouched`].
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    pub(crate) header: &'a Header,
    pub(crate) view: &'a View,
    pub(crate) lights: &'a [Light],
    pub(crate) materials: &'a [Material],
    object_first: Indices<'a>,
    object_material: Indices<'a>,
    order: Indices<'a>,
    pub(crate) shapes: Shapes<'a>,
    pub(crate) leaves: &'a [u32],
    pub(crate) held: Held<'a>,
    /// Whether any primitive's test needs the norm of the ray's direction.
    pub(crate) needs_norm: bool,
    /// What `Chosen` walks.
    #[cfg(feature = "all-structures")]
    pub(crate) chosen: Structure,
    /// The instructions that `Wide` uses.
    #[cfg(feature = "wide")]
    pub(crate) simd: SimdLevel,
}

impl<'a> Scene<'a> {
    /// Checks a blob and returns a view of it.
    ///
    /// Proves alignment, size, version, byte order and checksum; that every section lies in the
    /// blob and every field in its range; that every index leads to a record; that every hierarchy
    /// is a tree in breadth-first order whose depth is what the header says, with boxes inside
    /// their parents' and primitives inside their leaves', each primitive in one leaf. After that
    /// a walk through any structure ends, and through a hierarchy it gives the same hits as testing
    /// every primitive (see [`Structure::is_proved`] for the others).
    ///
    /// Costs time linear in the blob's length and about 2 KiB of stack.
    ///
    /// # Errors
    /// If anything of this fails to hold, or the scene calls for an effect, or holds a kind of
    /// primitive, that this build was compiled without. Shortcomings of the scene itself (no lights, no objects) are no errors.
    pub fn from_bytes(blob: &'a [u8]) -> Result<Self, BlobError> {
        let header = read::header(blob)?;
        check::check_sum(blob, header)?;
        let sections = Sections::read(blob, header.section_count)?;
        let scene = read::scene(header, &sections)?;
        check::check(&scene, &sections)?;
        Ok(scene)
    }

    /// The view of a blob that was [vouched for](Vouched), in constant time.
    ///
    /// # Errors
    /// If the slice is not aligned, or the header, the section table or the view is not as it must
    /// be, or this build lacks what the scene calls for.
    pub fn vouched(vouched: Vouched<'a>) -> Result<Self, BlobError> {
        let header = read::header(vouched.blob)?;
        let sections = Sections::read(vouched.blob, header.section_count)?;
        read::scene(header, &sections)
    }

    /// The header.
    pub fn header(&self) -> &'a Header {
        self.header
    }

    /// Camera, surroundings and rendering defaults.
    pub fn view(&self) -> &'a View {
        self.view
    }

    /// The lights.
    pub fn lights(&self) -> &'a [Light] {
        self.lights
    }

    /// The materials.
    pub fn materials(&self) -> &'a [Material] {
        self.materials
    }

    /// The scene's box, for [`Ray::new`](crate::Ray::new).
    pub fn bounds(&self) -> &'a UnitBox {
        &self.header.bounds
    }

    /// The effects that the scene calls for.
    pub fn effects(&self) -> Effects {
        Effects(self.header.effects)
    }

    /// Entries that the traversal stack needs.
    pub fn stack_depth(&self) -> usize {
        self.header.stack_depth.into()
    }

    /// Whether the blob holds a structure.
    pub fn holds(&self, structure: Structure) -> bool {
        self.header.structures & structure.bit() != 0
    }

    /// The scene with a structure chosen for [`Chosen`](crate::accel::Chosen) to walk; `None` if the
    /// blob does not hold it.
    #[cfg(feature = "all-structures")]
    pub fn choose(&self, structure: Structure) -> Option<Self> {
        self.holds(structure).then_some(Self {
            chosen: structure,
            ..*self
        })
    }

    /// The scene with queries through [`Wide`](crate::Wide) at a level of instructions; at first they
    /// are portable.
    #[cfg(feature = "wide")]
    pub fn with_simd(self, simd: SimdLevel) -> Self {
        Self { simd, ..self }
    }

    /// The instructions that queries through [`Wide`](crate::Wide) use.
    #[cfg(feature = "wide")]
    pub fn simd(&self) -> SimdLevel {
        self.simd
    }

    /// Number of primitives of a kind.
    pub fn count(&self, kind: Kind) -> usize {
        self.shapes.count(kind)
    }

    /// Number of vertices of all meshes.
    pub fn vertices(&self) -> usize {
        self.shapes.vertices.len()
    }

    /// The box of a primitive, given by its kind and its slot among those of that kind.
    pub fn primitive_bounds(&self, kind: Kind, slot: usize) -> Option<UnitBox> {
        self.shapes.bounds(kind, slot)
    }

    /// The corners of a triangle in 1/256 unit, given by its slot.
    pub fn triangle(&self, slot: usize) -> Option<[[i32; 3]; 3]> {
        self.shapes.triangle(slot)
    }

    /// A primitive as it lies on the lattice, given by its kind and its slot among those of that kind.
    pub fn geometry(&self, kind: Kind, slot: usize) -> Option<Geometry> {
        let shapes = &self.shapes;
        Some(match kind {
            Kind::Triangle => Geometry::Triangle(shapes.triangle(slot)?),
            Kind::Sphere => {
                let (center, radius) = shapes.spheres.get(slot)?;
                Geometry::Sphere { center, radius }
            }
            Kind::Box => Geometry::Box(*shapes.boxes.get(slot)?),
            Kind::Disc => Geometry::Disc(*shapes.discs.get(slot)?),
            Kind::Cone => Geometry::Cone(*shapes.cones.get(slot)?),
        })
    }

    /// The number, in scene-file order, of a primitive given by kind and slot. Below the number of
    /// primitives. Several slots have one number where a triangle was cut into pieces.
    #[inline]
    pub fn primitive(&self, kind: Kind, slot: u32) -> u32 {
        self.primitive_at(self.shapes.place(kind, slot))
    }

    /// The number, in scene-file order, of a primitive that lies somewhere.
    #[cfg_attr(feature = "wide", inline(always))]
    #[cfg_attr(not(feature = "wide"), inline)]
    pub(crate) fn primitive_at(&self, place: Place) -> u32 {
        self.key(place).0
    }

    /// What decides between hits at the same t: the primitive's number, and between pieces of one
    /// primitive, kind and slot; so answers do not depend on the structure either.
    #[cfg_attr(feature = "wide", inline(always))]
    #[cfg_attr(not(feature = "wide"), inline)]
    pub(crate) fn key(&self, place: Place) -> (u32, u8, u32) {
        match place {
            Place::Slot(kind, slot) => (self.in_slot(kind, slot), kind as u8, slot),
            #[cfg(feature = "wide")]
            Place::Strip(strip, place) => {
                let members = self.shapes.clusters.strips.members(strip);
                let member = members.map_or(0, |members| members.member(place.into()));
                self.member(Kind::Triangle, member, 0)
            }
            #[cfg(feature = "wide")]
            Place::Pack(pack, lane) => {
                let number = pack << 3 | u32::from(lane);
                self.member(Kind::Sphere, number, self.shapes.clusters.triangles())
            }
        }
    }

    /// The key of a member of a cluster, by its number among those of its kind and the number of
    /// members before them.
    #[cfg(feature = "wide")]
    #[inline(always)]
    fn member(&self, kind: Kind, number: u32, before: usize) -> (u32, u8, u32) {
        let clusters = &self.shapes.clusters;
        let member = clusters.members.get(before + number as usize).unwrap_or(0);
        if clusters.homes.is_empty() {
            (member, kind as u8, number)
        } else {
            (self.in_slot(kind, member), kind as u8, member)
        }
    }

    /// The primitive in a slot of a kind that has records of its own.
    #[inline(always)]
    fn in_slot(&self, kind: Kind, slot: u32) -> u32 {
        let slot = self.shapes.slot(kind, slot);
        self.order.get(slot).unwrap_or(slot as u32)
    }

    /// The object that a primitive belongs to.
    #[cfg_attr(feature = "wide", inline)]
    pub fn object(&self, primitive: u32) -> u32 {
        if self.object_first.is_empty() {
            return if self.header.objects == self.header.primitives {
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

    /// The material of an object.
    #[inline]
    pub fn material(&self, object: u32) -> Option<&'a Material> {
        let material = self.object_material.get(object as usize).unwrap_or(0);
        self.materials.get(material as usize)
    }

    #[inline(always)]
    pub(crate) fn leaf(&self, number: u32) -> Option<Leaf> {
        self.leaves
            .get(number as usize)
            .and_then(|&word| Leaf::from_word(word))
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

/// The checksum of a blob: FNV-1a over its 32-bit words, the checksum's own taken as 0.
///
/// Every step is a bijection of the state, so a change of any single word always shows.
pub const fn checksum(blob: &[u8]) -> u32 {
    const OWN_WORD: usize = core::mem::offset_of!(Header, checksum) / 4;
    const fn mix(state: u32, word: u32) -> u32 {
        (state ^ word).wrapping_mul(0x0100_0193)
    }
    let mut state: u32 = 0x811c_9dc5;
    let (mut words, mut rest) = blob.as_chunks();
    let mut before = 0;
    while let [word, after @ ..] = words {
        let own = before == OWN_WORD;
        state = mix(state, if own { 0 } else { u32::from_le_bytes(*word) });
        before = before.wrapping_add(1);
        words = after;
    }
    if !rest.is_empty() {
        // The last bytes as a word that ends in zeros.
        let mut word = 0;
        while let [before @ .., byte] = rest {
            word = word << 8 | *byte as u32;
            rest = before;
        }
        state = mix(state, word);
    }
    state
}

/// Bytes aligned as a blob must be; what [`include_blob!`](crate::include_blob) makes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Aligned<T: ?Sized>(pub T);

/// Embeds a blob file with the alignment that [`Scene::from_bytes`] asks for.
///
/// ```ignore
/// static BLOB: &[u8] = gridel_core::include_blob!("scene.gridel");
/// ```
#[macro_export]
macro_rules! include_blob {
    ($path:expr) => {{
        const BYTES: &[u8] = include_bytes!($path);
        static ALIGNED: $crate::Aligned<[u8; BYTES.len()]> =
            $crate::Aligned(*include_bytes!($path));
        &ALIGNED.0 as &'static [u8]
    }};
}
