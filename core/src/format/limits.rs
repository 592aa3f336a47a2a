//! Limits of every blob, and the features of this build.

/// The largest stack depth that a blob can need.
pub const MAX_STACK_DEPTH: usize = 160;

/// Maximum number of levels of a hierarchy of pairs, and the largest stack depth that one needs.
pub const MAX_LEVELS: usize = 48;

/// The largest ray depth of a scene.
pub const MAX_RAY_DEPTH: usize = 32;

/// Maximum number of surfaces that a shadow ray passes; light behind more surfaces does not arrive.
pub const MAX_SHADOW_SURFACES: usize = 128;

/// Maximum number of diffuse reflections of a ray of light.
pub const MAX_BOUNCES: usize = 32;

/// Maximum number of samples per pixel.
pub const MAX_SAMPLES: u16 = 4096;

/// Maximum number of bytes of a name.
pub const MAX_NAME_BYTES: usize = 255;

/// The greatest distance of an origin from the lattice's middle along each axis: 2^37 units, with 13 fraction bits.
/// Eyes and lights of a blob are no farther away, so sums and products with ratios stay in 64 bits.
pub const FARTHEST: i64 = 1 << 50;

/// The coarsest step of scene coordinates is a unit times 2 to the power of this less 13, so that a coordinate
/// reaches [`FARTHEST`].
pub const MAX_COORDINATE_SHIFT: u8 = 19;

/// Rays hit shapes without bounds at less than 2^49 units, with 13 fraction bits. The distance is measured from the
/// ray's origin, or from where the ray reaches the scene's box.
pub const FARTHEST_HIT: i64 = 1 << 62;

/// The greatest distance of the point of a shape without bounds from the lattice's middle on each axis, in 1/256 unit:
/// 2^17 units. So some point of the shape is a length in every format, with the same margin.
pub const FARTHEST_POINT: i64 = 1 << 25;

/// Points of shapes without bounds stay this many units below the longest length. A start beside such a point is then a
/// length, too.
pub(crate) const ROOM_FOR_ERRORS: i16 = 16;

/// Maximum number of instances of a scene.
pub const MAX_INSTANCES: usize = 1 << 20;

/// Maximum number of levels of the hierarchy above instances.
pub const MAX_INSTANCE_LEVELS: usize = 24;

/// The least and the greatest scale of a joint, with 24 fraction bits: 1/16384 and 64.
pub const SCALES: [i32; 2] = [1 << 10, 1 << 30];

/// The greatest magnitude of the weight of a morph target, with 24 fraction bits: 64.
pub const LARGEST_WEIGHT: i32 = 1 << 30;

/// The greatest magnitude of a vertex' displacement by a morph target, in steps of its storage.
pub const LARGEST_DISPLACEMENT: i32 = 1 << 28;

/// The powers of two by which an instance scales from scene units to units of its part.
pub const INSTANCE_EXPONENT: [i64; 2] = [-4, 18];

/// The least α of rough materials, with 30 fraction bits: that of a roughness of 0.05.
pub const LEAST_ROUGHNESS: i32 = 2_684_354;

/// Maximum number of materials with a priority.
pub const MAX_MEDIA: usize = 8;

/// The narrowest and the widest [angle](crate::Angle) that a camera of a track sees.
pub const FIELD_OF_VIEW: [i32; 2] = [2, i32::MAX];

/// True if this build holds the code for scenes whose colors are display values.
pub(crate) const DISPLAY_VALUES: bool = cfg!(feature = "display-values");

/// True if this build holds the code for coordinates of more than 16 bits.
pub(crate) const WIDE_LATTICE: bool = cfg!(feature = "wide-lattice");

/// True if this build holds the code for vertex indices of more than 16 bits.
pub(crate) const WIDE_INDICES: bool = cfg!(feature = "wide-indices");

/// True if this build holds the code for shapes without bounds.
pub(crate) const UNBOUNDED: bool = cfg!(feature = "unbounded");

/// True if this build holds the code for indirect light.
pub(crate) const INDIRECT: bool = cfg!(feature = "indirect");

/// True if this build holds the code for nested dielectrics.
pub(crate) const NESTED: bool = cfg!(feature = "nested");

/// True if this build holds the code for smooth normals.
pub(crate) const SMOOTH: bool = cfg!(feature = "smooth");

/// True if this build holds the code for parts and their instances.
pub(crate) const INSTANCES: bool = cfg!(feature = "instances");
