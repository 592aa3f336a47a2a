//! The records of a blob, as the host writes them and the core reads them in place; but for those of
//! [shapes](crate::geometry).
//!
//! Little-endian, naturally aligned, without padding. `FORMAT.md` specifies every field; the
//! assertions at the end of this file hold the layout to it.

use bytemuck::{Pod, Zeroable};
use core::mem::{align_of, offset_of, size_of};

/// The first bytes of every blob. The last two betray a file that was mangled as text.
pub const MAGIC: [u8; 8] = *b"GRIDEL\x1a\n";
/// Reads as this number only where the byte order of blob and machine agree.
pub const ENDIANNESS: u32 = 0x0102_0304;
/// The version of the format.
pub const VERSION: u16 = 1;
/// Alignment of the blob and of every section, in bytes.
pub const ALIGNMENT: usize = 16;

/// The blob's first record: version, requirements and sizes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: [u8; 8],
    /// [`ENDIANNESS`].
    pub endianness: u32,
    /// [`VERSION`].
    pub version: u16,
    /// Number of entries in the section table.
    pub section_count: u16,
    /// Length of the blob in bytes, the header included.
    pub blob_bytes: u32,
    /// [`checksum`](fn@crate::format::checksum) of the blob with this field as 0.
    pub checksum: u32,
    /// Acceleration structures that the blob holds: a bit for each [`Structure`](crate::format::Structure).
    pub structures: u32,
    /// Effects that the scene requires: see [`Effects`](crate::format::Effects).
    pub effects: u32,
    /// Entries that the deepest walk pushes on the traversal stack.
    pub stack_depth: u16,
    /// Most primitives in a leaf.
    pub longest_leaf: u16,
    /// Number of primitives that the scene file has. Those that collapse on the lattice keep their
    /// number and have no slot; triangles beside them may be cut into pieces, a slot each.
    pub primitives: u32,
    /// Number of objects.
    pub objects: u32,
    /// Bits of the lattice that the scene was snapped to: 10 to 24.
    pub lattice_bits: u8,
    /// Bits of a stored coordinate: 16 or 24.
    pub storage_bits: u8,
    /// One unit (a step of the 16-bit box lattice) is 2 to this power scene units.
    pub unit_exponent: i16,
    /// Scene coordinates of the lattice's origin, a multiple of its step.
    pub origin: [f64; 3],
    /// The scene's box: smallest and largest unit on each axis.
    pub bounds: UnitBox,
    /// Bytes of the traversal stack: `stack_depth` entries.
    pub stack_bytes: u32,
    /// One step of scene coordinates (see [`Position`](crate::Position)) is a unit times 2 to the power of
    /// this less 13; at most [`MAX_COORDINATE_SHIFT`](crate::format::limits::MAX_COORDINATE_SHIFT).
    pub coordinate_shift: u8,
    /// What scene coordinates are counted from: 0 for the lattice's origin, 1 for the scene's.
    pub coordinate_origin: u8,
    /// Zero.
    pub spare: [u16; 3],
}

/// One line of the section table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct SectionEntry {
    /// A [`SectionKind`](crate::format::SectionKind).
    pub kind: u16,
    /// Bytes of a record.
    pub stride: u16,
    /// Number of records.
    pub count: u32,
    /// Where the first record lies, in bytes from the blob's start; a multiple of [`ALIGNMENT`].
    pub offset: u32,
    /// Zero.
    pub spare: u32,
}

/// An axis-aligned box on the 16-bit box lattice: `[axis][smallest, largest]`, closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub struct UnitBox(pub [[i16; 2]; 3]);

impl UnitBox {
    /// The box around coordinates of the storage lattice (1/256 unit), rounded outward.
    #[inline(always)]
    pub fn around(lowest: [i32; 3], highest: [i32; 3]) -> Self {
        let axis = |k: usize| {
            [
                (lowest[k] >> 8) as i16,
                (highest[k].wrapping_add(255) >> 8) as i16,
            ]
        };
        Self([axis(0), axis(1), axis(2)])
    }

    /// Whether `other` lies in this box, faces included.
    pub fn contains(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(outer, inner)| {
            outer[0] <= inner[0] && inner[0] <= inner[1] && inner[1] <= outer[1]
        })
    }

    /// The smallest box around both.
    pub fn union(&self, other: &Self) -> Self {
        let axis = |k: usize| {
            [
                self.0[k][0].min(other.0[k][0]),
                self.0[k][1].max(other.0[k][1]),
            ]
        };
        Self([axis(0), axis(1), axis(2)])
    }
}

/// Camera, surroundings and rendering defaults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct View {
    /// The eye: units with 13 fraction bits, at most 2^50 in magnitude.
    pub eye: [i64; 3],
    /// The middle of the picture as seen from the eye. `forward`, `right` and `up` have one scale,
    /// with magnitudes of at most 2^28.
    pub forward: [i32; 3],
    /// From the middle of the picture to its right, by half the picture's *height*.
    pub right: [i32; 3],
    /// From the middle of the picture to its upper edge.
    pub up: [i32; 3],
    /// Radiance of rays that meet nothing, 20 fraction bits.
    pub background: [i32; 3],
    /// Radiance that reaches every surface, 20 fraction bits.
    pub ambient: [i32; 3],
    /// A secondary ray that can add no more than this to any channel is not traced: 20 fraction bits.
    pub cutoff: i32,
    /// Default width of the picture in pixels.
    pub width: u16,
    /// Default height of the picture in pixels.
    pub height: u16,
    /// Default number of samples per pixel, 1 to 256.
    pub samples: u16,
    /// How often a ray may be reflected or refracted, 0 to [`MAX_RAY_DEPTH`](crate::format::limits::MAX_RAY_DEPTH).
    pub depth: u8,
    /// 1 where all colors and lights are display values, which reach the display as they are; 0
    /// where they are linear.
    pub display_values: u8,
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Light {
    /// A point light's position in units with 13 fraction bits (at most 2^50 in magnitude), or the
    /// unit vector towards a directional light with 30 fraction bits.
    pub vector: [i64; 3],
    /// Radiance, 20 fraction bits.
    pub color: [i32; 3],
    /// 0 for a point light, 1 for a directional one.
    pub directional: u32,
}

/// A surface. Colors are ratios with 30 fraction bits, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Material {
    /// Diffuse reflectance; of the even cells where there is a checkerboard.
    pub diffuse: [i32; 3],
    /// Diffuse reflectance of the odd cells.
    pub odd: [i32; 3],
    /// Edge of a checkerboard's cells, a length with 13 fraction bits, below 2^30; 0 without one.
    pub checker_size: i32,
    /// A corner of the checkerboard's cells, lengths with 13 fraction bits.
    pub checker_origin: [i32; 3],
    /// Reflectance of the lights' highlights.
    pub highlight: [i32; 3],
    /// Weight of the mirrored ray.
    pub mirror: [i32; 3],
    /// Weight of what glass brings.
    pub transmit: [i32; 3],
    /// One over the index of refraction: 0.25 to 1.
    pub inverse_ior: i32,
    /// Absorption inside, in 1/unit with 32 fraction bits.
    pub absorption: [u32; 3],
    /// Exponent of the highlight, 1 to 1024.
    pub shininess: u16,
    /// Zero.
    pub spare: u16,
}

/// A vertex on the 16-bit lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Pod, Zeroable)]
#[repr(transparent)]
pub struct Vertex16(pub [i16; 3]);

/// A vertex on the 24-bit lattice. A word each, because rays read vertices more than anything else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Pod, Zeroable)]
#[repr(transparent)]
pub struct Vertex24(pub [i32; 3]);

/// A sphere on the 16-bit lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Sphere16 {
    /// Center in units.
    pub center: Vertex16,
    /// Radius in units, above 0.
    pub radius: u16,
}

/// A sphere on the 24-bit lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Sphere24 {
    /// Center in 1/256 unit: three little-endian integers of three bytes.
    pub center: [[u8; 3]; 3],
    /// Radius in 1/256 unit, above 0: an unsigned integer of three bytes.
    pub radius: [u8; 3],
}

/// A pair of children with all their planes, for the ordinary traversal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Pair {
    /// `[axis][side][child]`: the lower sides of the left and the right child, then the upper ones.
    pub planes: [[[i16; 2]; 2]; 3],
    /// The children: the number of a pair, or that of a leaf with bit 31 set.
    pub children: [u32; 2],
}

/// A pair of children without the sides that coincide with their parent's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct FlaggedPair {
    /// `[axis]`: the inner of the two children's lower sides in the low half, the inner of their
    /// upper sides in the high half.
    pub planes: [u32; 3],
    /// The children, and which child owns each plane: see [`Link`](crate::format::Link).
    pub link: u32,
}

/// A dual-split node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DualNode {
    /// On the split's axis: the second child's lower side in the low half, the first child's upper
    /// side in the high half, in the order in which a ray up the axis enters the one and leaves the
    /// other if they overlap. Zero in a leaf.
    pub split: u32,
    /// The node's lower side in the low half and its upper side in the high half, on each carve's
    /// axis; zero where there is no carve.
    pub carves: [u32; 2],
    /// Axes, and the children or the leaf: see [`NodeWord`](crate::format::NodeWord).
    pub word: u32,
}

/// How the cylinder cubes partition the scene's box: see `accel::candidates::gridels`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Gridels {
    /// Gridels along a side of a face, 1 to 64.
    pub count: u32,
    /// The lowest corner of the partitioned box, lengths with 13 fraction bits.
    pub low: [i32; 3],
    /// The highest corner.
    pub high: [i32; 3],
    /// Gridels per length along each axis, with 44 fraction bits more than the length's.
    pub scale: [u32; 3],
}

/// A point whose rays have lists: see [`apex`](crate::accel::candidates::apex).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ApexPoint {
    /// The point, in 1/256 unit; magnitudes up to 2^29.
    pub at: [i32; 3],
    /// For each face of the cube of directions its window, or 0xffff: face `2 k` is down axis `k`,
    /// `2 k + 1` up it.
    pub windows: [u16; 6],
}

/// A direction whose rays have lists: an apex infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ApexDirection {
    /// The slopes of rays that run that way, ratios with 30 fraction bits.
    pub slope: [i32; 3],
    /// The plane across the major axis that they run to, in 1/256 unit; magnitudes up to 2^24.
    pub plane: i32,
    /// The axis along which they run most.
    pub major: u16,
    /// Their window.
    pub window: u16,
}

/// A rectangle of the values that distinguish the rays of an apex, on the two axes that follow the major one in
/// turn: slopes, with 30 fraction bits, or, where the apex is infinitely far away, places in the
/// plane that they run to, in 1/256 unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ApexWindow {
    /// The least slopes or places.
    pub low: [i32; 2],
    /// Cells for a slope of 2^-30 or 1/256 unit, with 32 fraction bits.
    pub scale: [u32; 2],
    /// Cells along each side, 1 to 1024.
    pub cells: [u16; 2],
    /// The first cell of the window in the table; cells lie row by row of the second slope.
    pub first_cell: u32,
    /// Where the levels of keys begin: culling steps from the apex or the plane.
    pub start: i32,
    /// Levels a culling step, with 24 fraction bits.
    pub a_step: u32,
}

/// A node of the eight-wide hierarchy: 128 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct WideNode {
    /// `[axis][side][child]`: the children's lower sides, then their upper ones. Missing children,
    /// which are the last ones, have a box that nothing meets: [`EMPTY`](Self::EMPTY).
    pub planes: [[[i16; 8]; 2]; 3],
    /// The children: see [`Child`](crate::format::Child).
    pub children: [u32; 8],
}

impl WideNode {
    /// The box of a missing child: no ray meets it, because it is inside out by more than the
    /// margins of culling.
    pub const EMPTY: UnitBox = UnitBox([[i16::MAX, i16::MIN]; 3]);

    /// The box of a child.
    #[inline(always)]
    pub fn child_box(&self, lane: usize) -> UnitBox {
        UnitBox(
            self.planes
                .map(|[low, high]| [low[lane & 7], high[lane & 7]]),
        )
    }

    /// A child.
    #[inline(always)]
    pub fn child(&self, lane: usize) -> crate::format::Child {
        crate::format::Child(self.children[lane & 7])
    }
}

/// A bounding sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct BoundingSphere {
    /// Center in units.
    pub center: [i16; 3],
    /// Radius in units.
    pub radius: u16,
}

/// A pair of children in bounding spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct SpherePair {
    /// The left and the right child's.
    pub spheres: [BoundingSphere; 2],
    /// The children: the number of a pair, or that of a leaf with bit 31 set.
    pub children: [u32; 2],
}

/// The shape of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct GridShape {
    /// Divisions of each axis: 1 to 1024.
    pub divisions: [u16; 3],
    /// Zero.
    pub spare: u16,
}

impl GridShape {
    /// The divisions as numbers.
    pub fn counts(&self) -> [u32; 3] {
        self.divisions.map(u32::from)
    }
}

/// Two 16-bit planes as one word, the way pairs hold them.
pub const fn plane_word(planes: [i16; 2]) -> u32 {
    planes[0] as u16 as u32 | (planes[1] as u16 as u32) << 16
}

const _: () = {
    assert!(size_of::<Header>() == 96 && align_of::<Header>() == 8);
    assert!(offset_of!(Header, endianness) == 8 && offset_of!(Header, version) == 12);
    assert!(offset_of!(Header, section_count) == 14 && offset_of!(Header, blob_bytes) == 16);
    assert!(offset_of!(Header, checksum) == 20 && offset_of!(Header, structures) == 24);
    assert!(offset_of!(Header, effects) == 28 && offset_of!(Header, stack_depth) == 32);
    assert!(offset_of!(Header, longest_leaf) == 34 && offset_of!(Header, primitives) == 36);
    assert!(offset_of!(Header, objects) == 40 && offset_of!(Header, lattice_bits) == 44);
    assert!(offset_of!(Header, storage_bits) == 45 && offset_of!(Header, unit_exponent) == 46);
    assert!(offset_of!(Header, origin) == 48 && offset_of!(Header, bounds) == 72);
    assert!(offset_of!(Header, stack_bytes) == 84 && offset_of!(Header, coordinate_shift) == 88);
    assert!(offset_of!(Header, coordinate_origin) == 89);
    assert!(size_of::<SectionEntry>() == 16);
    assert!(size_of::<View>() == 96 && align_of::<View>() == 8);
    assert!(offset_of!(View, forward) == 24 && offset_of!(View, background) == 60);
    assert!(offset_of!(View, ambient) == 72 && offset_of!(View, cutoff) == 84);
    assert!(offset_of!(View, width) == 88 && offset_of!(View, depth) == 94);
    assert!(size_of::<Light>() == 40 && offset_of!(Light, color) == 24);
    assert!(offset_of!(Light, directional) == 36);
    assert!(size_of::<Material>() == 96 && offset_of!(Material, highlight) == 40);
    assert!(offset_of!(Material, transmit) == 64 && offset_of!(Material, inverse_ior) == 76);
    assert!(offset_of!(Material, absorption) == 80 && offset_of!(Material, shininess) == 92);
    assert!(size_of::<Vertex16>() == 6 && size_of::<Vertex24>() == 12);
    assert!(size_of::<Sphere16>() == 8 && size_of::<Sphere24>() == 12);
    assert!(size_of::<Gridels>() == 40 && offset_of!(Gridels, scale) == 28);
    assert!(size_of::<ApexPoint>() == 24 && offset_of!(ApexPoint, windows) == 12);
    assert!(size_of::<ApexDirection>() == 20 && offset_of!(ApexDirection, window) == 18);
    assert!(size_of::<ApexWindow>() == 32 && offset_of!(ApexWindow, cells) == 16);
    assert!(size_of::<Pair>() == 32 && size_of::<FlaggedPair>() == 16);
    assert!(size_of::<DualNode>() == 16);
    assert!(size_of::<SpherePair>() == 24 && size_of::<GridShape>() == 8);
};
