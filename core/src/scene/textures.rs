//! Textures: images, and how they are looked up.
//!
//! Everything is integer arithmetic, so a texel and its weight are the same in every number format. Bilinear weights
//! have 8 bits along each axis. Colors are stored as square roots and mixed as linear light.

use crate::format::range::{At, Ranges};
use crate::format::record::{Material, SurfaceMaps, Texture};
use crate::format::{BlobError, Field, SectionKind, Sections};
use crate::geometry::attributes::{COORDINATE_BITS, linear};

impl Material {
    /// The bits of [`maps`](Self::maps) that are a number.
    pub const MAPS_NUMBER: u16 = (1 << 12) - 1;

    /// The bit of [`maps`](Self::maps) for a texture of the diffuse color.
    pub const MAPS_TEXTURE: u16 = 1 << 12;

    /// The bit of [`maps`](Self::maps) for a texture whose alpha is used.
    pub const MAPS_ALPHA: u16 = 1 << 13;

    /// All bits of [`maps`](Self::maps) for effects.
    pub(crate) const MAPS_FLAGS: u16 = Self::MAPS_TEXTURE | Self::MAPS_ALPHA;
}

/// The textures of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Textures<'a> {
    pub(crate) maps: &'a [SurfaceMaps],
    pub(crate) textures: &'a [Texture],
    texels: &'a [u8],
}

/// A texture, looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Texel {
    /// Linear ratios with 30 fraction bits.
    pub(crate) color: [i32; 3],
    /// The nearest texel, or the upper left one of four.
    pub(crate) place: [u32; 2],
}

impl<'a> Textures<'a> {
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self {
            maps: sections.records(SectionKind::SurfaceMaps)?,
            textures: sections.records(SectionKind::Textures)?,
            texels: sections.records(SectionKind::Texels)?,
        })
    }

    /// Proves that maps have textures, and textures their texels.
    pub(crate) fn validate(&self) -> Result<(), BlobError> {
        let section = SectionKind::SurfaceMaps;
        for (index, maps) in self.maps.iter().enumerate() {
            let at = At { section, index };
            let most = self.textures.len() as i64;
            at.within(Field::TextureNumber, maps.color.into(), 0, most)?;
        }
        let section = SectionKind::Textures;
        for (index, texture) in self.textures.iter().enumerate() {
            let at = At { section, index };
            texture.check_ranges(at.location())?;
            let most = self.texels.len() as i64 - texture.bytes() as i64;
            at.within(Field::FirstTexel, texture.first.into(), 0, most)?;
        }
        Ok(())
    }

    /// The maps of a material.
    #[inline(always)]
    pub(crate) fn maps_of(&self, material: &Material) -> Option<&'a SurfaceMaps> {
        let number = material.maps & Material::MAPS_NUMBER;
        self.maps.get(usize::from(number).wrapping_sub(1))
    }

    /// A texture, whose number counts from 1.
    #[inline(always)]
    pub(crate) fn texture(&self, number: u16) -> Option<&'a Texture> {
        self.textures.get(usize::from(number).wrapping_sub(1))
    }

    /// The color of a texture at coordinates with [`COORDINATE_BITS`] fraction bits.
    ///
    /// Cost: 4 texels of a bilinear texture, 1 of another.
    #[inline(always)]
    pub(crate) fn lookup(&self, texture: &Texture, [u, v]: [i32; 2]) -> Texel {
        let (places, weights, place) = match taps(texture, [u, v]) {
            Taps::Nearest(index, place) => {
                let color = self.texel(texture, index);
                return Texel {
                    color: color.map(|root| linear(square(root) << 16)),
                    place,
                };
            }
            Taps::Mixed(places, weights, place) => (places, weights, place),
        };
        let mut sum = [0_u32; 3];
        for (index, weight) in places.into_iter().zip(weights) {
            let texel = self.texel(texture, index);
            for (sum, root) in sum.iter_mut().zip(texel) {
                // In all at most 255^2 2^16, which has 32 bits.
                *sum = sum.wrapping_add(square(root).wrapping_mul(weight));
            }
        }
        Texel {
            color: sum.map(linear),
            place,
        }
    }

    /// The alpha of a texture at coordinates with [`COORDINATE_BITS`] fraction bits: a ratio with 30 fraction bits.
    #[inline(always)]
    pub(crate) fn alpha(&self, texture: &Texture, at: [i32; 2]) -> i32 {
        ratio(match taps(texture, at) {
            Taps::Nearest(index, _) => self.texel_alpha(texture, index) << 16,
            Taps::Mixed(places, weights, _) => {
                let all = places.into_iter().zip(weights);
                all.fold(0, |sum, (index, weight)| {
                    let alpha = self.texel_alpha(texture, index);
                    sum.wrapping_add(alpha.wrapping_mul(weight))
                })
            }
        })
    }

    /// The alpha of a texel, of 255.
    #[inline(always)]
    fn texel_alpha(&self, texture: &Texture, index: u32) -> u32 {
        if !matches!(texture.form, 0 | 3) {
            return 255;
        }
        let [_, _, _, alpha] = self.bytes(self.place(texture, index));
        u32::from(alpha)
    }

    /// Where the bytes of a texel are, or those of its color in the palette.
    #[inline(always)]
    fn place(&self, texture: &Texture, index: u32) -> usize {
        let start = (texture.first as usize).wrapping_add(texture.palette_bytes());
        let at = (index as usize)
            .wrapping_mul(texture.texel_bytes())
            .wrapping_add(start);
        if texture.form != 0 {
            return at;
        }
        let [entry] = self.bytes(at);
        usize::from(entry)
            .wrapping_mul(4)
            .wrapping_add(texture.first as usize)
    }

    /// The color of a texel, as roots of 8 bits.
    #[inline(always)]
    fn texel(&self, texture: &Texture, index: u32) -> [u8; 3] {
        let at = self.place(texture, index);
        if texture.form == 1 {
            let [low, high] = self.bytes(at);
            let packed = u32::from(low) | u32::from(high) << 8;
            // The upper bits of each channel again below it, so that all ones are 255.
            let five = |bits: u32| (bits << 3 | bits >> 2) as u8;
            let green = packed >> 5 & 63;
            return [
                five(packed >> 11),
                (green << 2 | green >> 4) as u8,
                five(packed & 31),
            ];
        }
        self.bytes(at)
    }

    /// Bytes of the texels; loading proves that they are there.
    #[inline(always)]
    fn bytes<const N: usize>(&self, at: usize) -> [u8; N] {
        let rest = self.texels.get(at..).unwrap_or_default();
        rest.first_chunk().copied().unwrap_or([0; N])
    }
}

/// What of a texture is looked up at coordinates: places of texels, their weights with 16 fraction bits, and column and
/// row of the first.
enum Taps {
    Nearest(u32, [u32; 2]),
    Mixed([u32; 4], [u32; 4], [u32; 2]),
}

#[inline(always)]
fn taps(texture: &Texture, [u, v]: [i32; 2]) -> Taps {
    let [width, height] = [texture.width, texture.height].map(u32::from);
    let u = wrapped(u, texture.wrap[0]);
    let v = wrapped(v, texture.wrap[1]);
    if texture.filter == 0 {
        // At most 2^20 - 1 times 4096.
        let x = u.wrapping_mul(width) >> COORDINATE_BITS;
        let y = v.wrapping_mul(height) >> COORDINATE_BITS;
        return Taps::Nearest(y.wrapping_mul(width).wrapping_add(x), [x, y]);
    }
    let ([left, right], across) = neighbors(u, width, texture.wrap[0] == 0);
    let ([upper, lower], down) = neighbors(v, height, texture.wrap[1] == 0);
    let (above, below) = (upper.wrapping_mul(width), lower.wrapping_mul(width));
    let both = across.wrapping_mul(down);
    // Their sum is 1.
    let weights = [
        (1_u32 << 16)
            .wrapping_add(both)
            .wrapping_sub(across.wrapping_add(down) << 8),
        (across << 8).wrapping_sub(both),
        (down << 8).wrapping_sub(both),
        both,
    ];
    let places = [
        above.wrapping_add(left),
        above.wrapping_add(right),
        below.wrapping_add(left),
        below.wrapping_add(right),
    ];
    Taps::Mixed(places, weights, [left, upper])
}

/// A ratio with 30 fraction bits from a number of 8 bits, of which 255 stands for 1, with 16 fraction bits.
#[inline(always)]
pub(crate) fn ratio(number_q16: u32) -> i32 {
    // 2^62 / (255 2^16), rounded up, so that 255 is 1 exactly.
    const SCALE: u64 = (1_u64 << 62).div_ceil(255 << 16);
    (u64::from(number_q16).wrapping_mul(SCALE) >> 32) as i32
}

#[inline(always)]
fn square(root: u8) -> u32 {
    u32::from(root).wrapping_mul(root.into())
}

/// A texture coordinate inside of the image, by the way in which that goes on: 0 up to 1.
#[inline(always)]
fn wrapped(coordinate: i32, wrap: u8) -> u32 {
    const ONE: i32 = 1 << COORDINATE_BITS;
    let inside = match wrap {
        0 => coordinate & (ONE - 1),
        1 => {
            // Every second image is mirrored: all bits of the fraction are turned.
            let turned = (coordinate << (31 - COORDINATE_BITS)) >> 31;
            (coordinate ^ turned) & (ONE - 1)
        }
        _ => coordinate.clamp(0, ONE - 1),
    };
    inside.cast_unsigned()
}

/// The two texels between whose middles a coordinate lies, of so many, and the weight of the second in 1/256.
#[inline(always)]
fn neighbors(inside: u32, count: u32, repeats: bool) -> ([u32; 2], u32) {
    // With 8 fraction bits, half a texel back.
    let place = (inside.wrapping_mul(count) >> (COORDINATE_BITS - 8))
        .wrapping_sub(128)
        .cast_signed();
    let (first, last) = (place >> 8, count.wrapping_sub(1));
    let weight = place.cast_unsigned() & 255;
    let second = first.wrapping_add(1).cast_unsigned();
    let pair = if first < 0 {
        [if repeats { last } else { 0 }, 0]
    } else if second > last {
        [last, if repeats { 0 } else { last }]
    } else {
        [first.cast_unsigned(), second]
    };
    (pair, weight)
}

#[cfg(test)]
mod tests;
