//! The space that all structures of a scene divide.

use crate::format::record::{Header, UnitBox};
use crate::format::{BlobError, Leaf, Structure};
use crate::geometry::Shapes;
use crate::simd::SimdLevel;
use crate::target::{AllStructuresOnly, WideOnly};

/// The space that structures divide: the scene's box, its primitives, and the leaves that hierarchies share.
#[derive(Clone, Copy, Debug)]
pub struct SceneGeometry<'a> {
    pub(crate) header: &'a Header,
    pub(crate) shapes: Shapes<'a>,
    pub(crate) leaves: &'a [u32],
    /// The structure that [`DynAccel`](crate::accel::DynAccel) walks.
    pub(crate) chosen: AllStructuresOnly<Structure>,
    /// The instructions that [`Wide`](crate::Wide) uses.
    pub(crate) simd: WideOnly<SimdLevel>,
}

impl<'a> SceneGeometry<'a> {
    /// The scene's box.
    #[inline(always)]
    pub(crate) fn bounds(&self) -> &'a UnitBox {
        &self.header.bounds
    }

    /// Returns true if the blob holds a structure.
    pub(crate) fn holds(&self, structure: Structure) -> bool {
        self.header.structures & structure.bit() != 0
    }

    /// The structure that [`DynAccel`](crate::accel::DynAccel) walks.
    #[inline(always)]
    pub(crate) fn chosen(&self) -> Structure {
        self.chosen.get().copied().unwrap_or(Structure::List)
    }

    /// The instructions that [`Wide`](crate::Wide) uses.
    #[inline(always)]
    pub(crate) fn simd(&self) -> SimdLevel {
        self.simd.get().copied().unwrap_or_default()
    }

    /// Returns true if another space has the same choice of walks.
    #[inline(always)]
    pub(crate) fn same_choice(&self, other: &SceneGeometry<'_>) -> bool {
        self.chosen == other.chosen && self.simd == other.simd
    }

    /// Copies the choice of walks from another space.
    pub(crate) fn choose_as(&mut self, other: &SceneGeometry<'_>) {
        (self.chosen, self.simd) = (other.chosen, other.simd);
    }

    /// A leaf by its number.
    #[inline(always)]
    pub(crate) fn leaf(&self, number: u32) -> Option<Leaf> {
        self.leaves
            .get(number as usize)
            .and_then(|&word| Leaf::from_word(word))
    }

    /// Proves that the blob holds a structure that another one refers to.
    pub(in crate::accel) fn require(
        &self,
        missing: Structure,
        needed_by: Structure,
    ) -> Result<(), BlobError> {
        if self.holds(missing) {
            return Ok(());
        }
        Err(BlobError::MissingStructure { missing, needed_by })
    }
}
