//! The location of a primitive in a blob.

use crate::format::Kind;
use crate::target::WideOnly;

/// The location of a primitive in a blob.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PrimitiveId {
    /// The kind of the primitive.
    pub(crate) kind: Kind,
    /// The slot among the records of its kind, or the cluster.
    pub(crate) number: u32,
    /// The lane of a cluster.
    lane: WideOnly<Option<u8>>,
}

impl PrimitiveId {
    /// The location among the records of its kind.
    #[inline(always)]
    pub(crate) fn in_slot(kind: Kind, number: u32) -> Self {
        let lane = WideOnly::new(|| None);
        Self { kind, number, lane }
    }

    /// The location in a lane of a strip, whose place it is, or of a pack.
    #[inline(always)]
    pub(crate) fn in_cluster(kind: Kind, number: u32, lane: u32) -> Self {
        let lane = WideOnly::new(|| Some(lane as u8));
        Self { kind, number, lane }
    }

    /// The lane, if the primitive lies in a cluster.
    #[inline(always)]
    pub(crate) fn lane(self) -> Option<u32> {
        self.lane.get().copied().flatten().map(u32::from)
    }
}
