//! The best hit of a search.

use crate::geometry::{Part, PrimitiveId};
use crate::number::Scalar;
use crate::target::{WideOnly, wide_only};

/// The best hit so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate<N> {
    pub(super) t: N,
    pub(super) place: PrimitiveId,
    pub(super) part: Part,
    /// A triangle's normal, of any length; 0 where it is not known.
    // Hosts keep what the test has computed.
    pub(super) normal: WideOnly<[N; 3]>,
}

impl<N: Scalar> Candidate<N> {
    #[inline(always)]
    pub(super) fn new((t, part): (N, Part), place: PrimitiveId) -> Self {
        Self {
            t,
            place,
            part,
            normal: wide_only(|| [N::ZERO; 3]),
        }
    }

    /// A triangle's normal, of any length, if it is known.
    #[inline(always)]
    pub(super) fn normal(&self) -> Option<[N; 3]> {
        let normal = self.normal.get().copied()?;
        let is_known = normal.iter().any(|&component| component != N::ZERO);
        is_known.then_some(normal)
    }
}
