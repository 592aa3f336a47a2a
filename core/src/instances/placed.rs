//! The instances of a scene, and the parts that they place.

use crate::format::instance::{Instance, Part};
use crate::instances::top::Top;

/// The instances of a scene, and the parts that they place: scenes themselves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed<'a, S> {
    pub(crate) top: Top<'a>,
    pub(crate) directory: &'a [Part],
    pub(crate) parts: &'a [S],
}

impl<'a, S> Placed<'a, S> {
    /// Used for scenes without instances.
    pub(crate) const NONE: Self = Self {
        top: Top {
            instances: &[],
            pairs: &[],
        },
        directory: &[],
        parts: &[],
    };

    /// The part of an instance, and the number of its first primitive.
    #[inline(always)]
    pub(crate) fn part(&self, instance: &Instance) -> Option<(&'a S, u32)> {
        let number = usize::from(instance.part);
        let part = self.parts.get(number)?;
        Some((part, self.directory.get(number)?.first_primitive))
    }

    /// Number of primitives of the scene's own objects, given that of all.
    pub(crate) fn own_primitives(&self, all: u32) -> u32 {
        let first = self.directory.first();
        first.map_or(all, |part| part.first_primitive)
    }
}
