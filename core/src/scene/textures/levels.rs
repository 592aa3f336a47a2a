//! Levels of textures: copies of an image, each of half the width and height of the one before. They serve surfaces so
//! far away that a sample covers many texels (L. Williams, "Pyramidal Parametrics", 1983).

use crate::format::record::Texture;
use crate::number::log2::{LOG2_BITS, log2, log2_of_power};
use crate::target::TextureLevelsOnly;

/// The area of texture coordinates that a sample covers: the binary logarithm of the side of a square of the same area.
#[derive(Clone, Copy, Debug)]
pub struct Footprint(TextureLevelsOnly<i32>);

/// An image of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    /// Width and height in texels.
    pub(super) size: [u32; 2],
    /// The texels before it.
    pub(super) first: u32,
}

impl Level {
    /// The image of which levels are copies.
    #[inline(always)]
    pub(super) fn whole(texture: &Texture) -> Self {
        Self {
            size: [texture.width, texture.height].map(u32::from),
            first: 0,
        }
    }

    fn next(self) -> Self {
        let [width, height] = self.size;
        Self {
            size: Texture::next_level(self.size),
            first: self.first.wrapping_add(width.wrapping_mul(height)),
        }
    }
}

impl Footprint {
    /// Returns a point, without an area.
    #[inline(always)]
    pub fn point() -> Self {
        Self(TextureLevelsOnly::new(|| i32::MIN))
    }

    /// Returns an area whose root has this binary logarithm, with [`LOG2_BITS`] fraction bits, as a part of the image.
    #[inline(always)]
    pub fn of_log2(side: i32) -> Self {
        Self(TextureLevelsOnly::new(|| side))
    }

    /// Returns the level of a texture whose texels are as large as this, with [`LOG2_BITS`] fraction bits. It is
    /// counted from 0 for the whole image, and 0 where there are no levels.
    #[inline(always)]
    pub(crate) fn level(self, texture: &Texture) -> u32 {
        let Some(side) = self.0.get().copied().filter(|_| texture.has_levels()) else {
            return 0;
        };
        let [width, height] = [texture.width, texture.height].map(u32::from);
        let texels = width.wrapping_mul(height);
        let level = side.saturating_add(log2(texels.into()) >> 1);
        // Sides are halved, rounded up, until one texel is left.
        let longest = width.max(height).wrapping_sub(1);
        let last = 32_u32.wrapping_sub(longest.leading_zeros());
        level
            .clamp(0, log2_of_power(last.cast_signed()))
            .cast_unsigned()
    }

    /// The two levels of a texture between which this lies, with weights whose sum is 256; the second counts only if
    /// the first has less.
    #[inline(always)]
    pub(super) fn levels(self, texture: &Texture) -> [(Level, u32); 2] {
        let place = self.level(texture);
        let mut finer = Level::whole(texture);
        for _ in 0..place >> LOG2_BITS {
            finer = finer.next();
        }
        let coarser = place & ((1 << LOG2_BITS) - 1);
        let weights = [(1_u32 << LOG2_BITS).wrapping_sub(coarser), coarser];
        [(finer, weights[0]), (finer.next(), weights[1])]
    }
}
