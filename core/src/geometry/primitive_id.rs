//! Where a blob keeps a primitive.

use crate::format::Kind;

/// Where a blob keeps a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PrimitiveId {
    /// Among the records of its kind.
    Slot(Kind, u32),
    /// In a strip, at a place of it.
    Strip(u32, u8),
    /// In a pack, in a lane of it.
    Pack(u32, u8),
}

impl PrimitiveId {
    /// The kind of the primitive.
    pub(crate) fn kind(self) -> Kind {
        match self {
            PrimitiveId::Slot(kind, _) => kind,
            PrimitiveId::Strip(..) => Kind::Triangle,
            PrimitiveId::Pack(..) => Kind::Sphere,
        }
    }
}
