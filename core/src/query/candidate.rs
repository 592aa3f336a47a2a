//! The best hit of a search.

use crate::geometry::{Part, PrimitiveId};

/// The best hit so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate<N> {
    pub(super) t: N,
    pub(super) place: PrimitiveId,
    pub(super) part: Part,
}
