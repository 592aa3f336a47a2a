//! The records of a blob, as the host writes them and the core reads them in place. The records of
//! [shapes](crate::geometry) and [clusters](crate::format::cluster) are elsewhere.
//!
//! Little-endian, aligned to at most 4 bytes, without padding. `FORMAT.md` shows every field: its tables come from the
//! declarations here, see [`layout`](crate::format::layout).

mod candidates;
mod header;
mod nodes;
mod points;
mod shading;
mod texture;

pub use candidates::{ApexDirection, ApexPoint, ApexWindow, Gridels};
pub use header::{Header, SectionEntry};
pub(crate) use header::{LENGTH_BITS, exponent_of_step};
pub use nodes::{
    BoundingSphere, DualNode, FlaggedPair, GridShape, Pair, SpherePair, WideNode, plane_word,
};
pub use points::{Sphere16, Sphere24, UnitBox, Vertex16, Vertex24};
pub use shading::{Emission, Light, Material, View};
pub use texture::{NormalMap, SurfaceMaps, Texture};

/// The first bytes of every blob. The last two detect a file that was transferred as text.
pub const MAGIC: [u8; 8] = *b"GRIDEL\x1a\n";
/// Has this value only if blob and machine have the same byte order.
pub const ENDIANNESS: u32 = 0x0102_0304;
/// The version of the format.
pub const VERSION: u16 = 1;
/// Alignment of a blob in memory, in bytes: no record needs more.
pub const ALIGNMENT: usize = 4;
/// Alignment of every section in the blob, in bytes.
pub const SECTION_ALIGNMENT: usize = 16;
