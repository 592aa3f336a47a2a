//! Textures: images, and their look-up.
//!
//! All arithmetic is in integers, so a texel and its weight are the same in every number format. Bilinear weights have
//! 8 bits along each axis. Colors are stored as square roots and mixed as linear light.

mod levels;

use crate::format::range::{At, Ranges};
use crate::format::record::{Material, NormalMap, SurfaceMaps, Texture};
use crate::format::{BlobError, Effects, Field, SectionKind, Sections};
use crate::geometry::attributes::{COORDINATE_BITS, linear};
use crate::number::log2::LOG2_BITS;
use crate::target::{NormalMapOnly, TEXTURE_LEVELS, inline_on_boards, inline_unless_small};
use levels::Level;

pub use levels::Footprint;

impl Material {
    /// The bits of [`maps`](Self::maps) that are a number.
    pub const MAPS_NUMBER: u16 = (1 << 12) - 1;

    /// The bit of [`maps`](Self::maps) for a texture of the diffuse color.
    pub const MAPS_TEXTURE: u16 = 1 << 12;

    /// The bit of [`maps`](Self::maps) for a texture whose alpha is used.
    pub const MAPS_ALPHA: u16 = 1 << 13;

    /// The bit of [`maps`](Self::maps) for a normal map.
    pub const MAPS_NORMAL: u16 = 1 << 14;

    /// The bit of [`maps`](Self::maps) for a texture or a normal map that has levels.
    pub const MAPS_LEVELS: u16 = 1 << 15;
}

/// The textures of a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Textures<'a> {
    pub(crate) maps: &'a [SurfaceMaps],
    normal_maps: NormalMapOnly<&'a [NormalMap]>,
    pub(crate) textures: &'a [Texture],
    texels: &'a [u8],
}

/// The result of a texture look-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Texel {
    /// Ratios with 30 fraction bits: of linear light, or of a normal's length.
    pub(crate) color: [i32; 3],
    /// The nearest texel, or the upper left one of four.
    pub(crate) place: [u32; 2],
}

impl<'a> Textures<'a> {
    /// No textures, in builds without their code.
    pub(crate) fn none() -> Self {
        Self {
            maps: &[],
            normal_maps: NormalMapOnly::new(|| &[][..]),
            textures: &[],
            texels: &[],
        }
    }

    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        let normal_maps = match const { Effects::AVAILABLE.contains(Effects::NORMAL_MAP) } {
            true => sections.records(SectionKind::NormalMaps)?,
            false => &[],
        };
        Ok(Self {
            normal_maps: NormalMapOnly::new(|| normal_maps),
            maps: sections.records(SectionKind::SurfaceMaps)?,
            textures: sections.records(SectionKind::Textures)?,
            texels: sections.records(SectionKind::Texels)?,
        })
    }

    /// Proves that maps have textures, and textures their texels.
    pub(crate) fn validate(&self) -> Result<(), BlobError> {
        let section = SectionKind::SurfaceMaps;
        for (index, maps) in (0..self.maps.len()).zip(self.maps) {
            let at = At { section, index };
            let most = self.textures.len() as i64;
            at.within(Field::TextureNumber, maps.color.into(), 0, most)?;
        }
        let section = SectionKind::NormalMaps;
        let normal_maps = self.normal_maps.get().map_or(&[][..], |it| *it);
        if normal_maps.len() > self.maps.len() {
            return Err(BlobError::TooMany {
                section,
                found: normal_maps.len(),
                most: self.maps.len(),
            });
        }
        for (index, map) in normal_maps.iter().enumerate() {
            let at = At { section, index };
            let most = self.textures.len() as i64;
            at.within(Field::TextureNumber, map.texture.into(), 0, most)?;
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

    /// The normal map of a material, and its texture.
    #[inline(always)]
    pub(crate) fn normal_map_of(
        &self,
        material: &Material,
    ) -> Option<(&'a NormalMap, &'a Texture)> {
        let number = material.maps & Material::MAPS_NUMBER;
        let map = self
            .normal_maps
            .get()?
            .get(usize::from(number).wrapping_sub(1))?;
        Some((map, self.texture(map.texture)?))
    }

    /// A texture, whose number counts from 1.
    #[inline(always)]
    pub(crate) fn texture(&self, number: u16) -> Option<&'a Texture> {
        self.textures.get(usize::from(number).wrapping_sub(1))
    }

    /// The color of a texture at coordinates with [`COORDINATE_BITS`] fraction bits.
    ///
    /// Cost: 4 texels of a bilinear texture, 1 of another; twice as many between two levels.
    #[inline(always)]
    pub(crate) fn lookup(&self, texture: &Texture, at: [i32; 2], footprint: Footprint) -> Texel {
        let squares = |texel: Packed| texel.channels().map(square);
        let (sums, place) = self.mixed(texture, at, footprint, squares);
        Texel {
            color: sums.map(linear),
            place,
        }
    }

    inline_on_boards!(
        /// Returns the normal in a texture at coordinates with [`COORDINATE_BITS`] fraction bits: ratios from -1 to 1
        /// with 30 fraction bits. Texels are mixed as they are, and the mean has any length up to the square root of 3.
        pub(crate) fn normal(
            &self,
            texture: &Texture,
            at: [i32; 2],
            footprint: Footprint,
        ) -> Texel {
            let (sums, place) = self.mixed(texture, at, footprint, Packed::channels);
            // Twice as much and 1 less: half of 255 is 0.
            let signed = |sum: u32| ratio(sum).wrapping_sub(1 << 29).wrapping_shl(1);
            Texel {
                color: sums.map(signed),
                place,
            }
        }
    );

    /// The alpha of a texture at coordinates with [`COORDINATE_BITS`] fraction bits: a ratio with 30 fraction bits.
    #[inline(always)]
    pub(crate) fn alpha(&self, texture: &Texture, at: [i32; 2], footprint: Footprint) -> i32 {
        let ([sum], _) = self.mixed(texture, at, footprint, |texel| [texel.alpha()]);
        ratio(sum)
    }

    /// Returns means of texels at coordinates, with 16 fraction bits, and the place of the first texel.
    #[inline(always)]
    fn mixed<const COUNT: usize>(
        &self,
        texture: &Texture,
        at: [i32; 2],
        footprint: Footprint,
        held: impl Fn(Packed) -> [u32; COUNT],
    ) -> ([u32; COUNT], [u32; 2]) {
        if !TEXTURE_LEVELS {
            return self.mixed_in(texture, &Level::whole(texture), at, held);
        }
        let (mut sums, mut place) = ([0_u32; COUNT], None);
        for (level, weight) in footprint.levels(texture) {
            let (parts, first) = self.mixed_in(texture, &level, at, &held);
            if weight == 1 << LOG2_BITS {
                return (parts, first);
            }
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum = sum.wrapping_add((part >> LOG2_BITS).wrapping_mul(weight));
            }
            place = place.or(Some(first));
        }
        (sums, place.unwrap_or_default())
    }

    /// The means of one level.
    #[inline(always)]
    fn mixed_in<const COUNT: usize>(
        &self,
        texture: &Texture,
        level: &Level,
        at: [i32; 2],
        held: impl Fn(Packed) -> [u32; COUNT],
    ) -> ([u32; COUNT], [u32; 2]) {
        match taps(texture, level, at) {
            Taps::Nearest(index, place) => {
                let [texel] = self.fetched(texture, [index]);
                (held(texel).map(|it| it << 16), place)
            }
            Taps::Mixed(indices, weights, place) => {
                let mut sums = [0_u32; COUNT];
                for (texel, weight) in self.fetched(texture, indices).into_iter().zip(weights) {
                    for (sum, it) in sums.iter_mut().zip(held(texel)) {
                        // At most 255^2 2^16 in all, which has 32 bits.
                        *sum = sum.wrapping_add(it.wrapping_mul(weight));
                    }
                }
                (sums, place)
            }
        }
    }

    /// Returns texels of a texture; loading proves that they exist.
    #[inline(always)]
    fn fetched<const COUNT: usize>(
        &self,
        texture: &Texture,
        indices: [u32; COUNT],
    ) -> [Packed; COUNT] {
        let bytes = self
            .texels
            .get(texture.first as usize..)
            .unwrap_or_default();
        match texture.form {
            0 => {
                let (palette, texels) = bytes.split_at_checked(1024).unwrap_or_default();
                let palette = palette.as_chunks().0;
                each(indices, |index| {
                    let entry = texels.get(index as usize).copied().unwrap_or_default();
                    Packed::rgba(element(palette, entry.into()))
                })
            }
            1 => {
                let texels = bytes.as_chunks().0;
                each(indices, |index| {
                    Packed::rgb565(u16::from_le_bytes(element(texels, index)))
                })
            }
            2 => {
                let texels = bytes.as_chunks().0;
                each(indices, |index| {
                    let [red, green, blue] = element(texels, index);
                    Packed::rgba([red, green, blue, 255])
                })
            }
            _ => {
                let texels = bytes.as_chunks().0;
                each(indices, |index| Packed::rgba(element(texels, index)))
            }
        }
    }
}

/// Fetches texels one by one, because `array::map` is a function of its own on some targets, with a frame of unknown
/// size.
#[inline(always)]
fn each<const COUNT: usize>(
    indices: [u32; COUNT],
    fetch: impl Fn(u32) -> Packed,
) -> [Packed; COUNT] {
    let mut texels = [Packed(0); COUNT];
    for (texel, index) in texels.iter_mut().zip(indices) {
        *texel = fetch(index);
    }
    texels
}

/// Returns an element that is known to exist.
#[inline(always)]
fn element<const BYTES: usize>(all: &[[u8; BYTES]], index: u32) -> [u8; BYTES] {
    all.get(index as usize).copied().unwrap_or([0; BYTES])
}

/// Red, green, blue and alpha, from the lowest byte up; the colors are roots.
#[derive(Clone, Copy)]
struct Packed(u32);

impl Packed {
    #[inline(always)]
    fn rgba(bytes: [u8; 4]) -> Self {
        Self(u32::from_le_bytes(bytes))
    }

    #[inline(always)]
    fn rgb565(texel: u16) -> Self {
        let texel = u32::from(texel);
        // The upper bits of each channel again below it, so that all ones are 255.
        let five = |bits: u32| bits << 3 | bits >> 2;
        let (red, green, blue) = (five(texel >> 11), texel >> 5 & 63, five(texel & 31));
        let green = green << 2 | green >> 4;
        Self(red | green << 8 | blue << 16 | 255 << 24)
    }

    #[inline(always)]
    fn channels(self) -> [u32; 3] {
        [self.0 & 255, self.0 >> 8 & 255, self.0 >> 16 & 255]
    }

    #[inline(always)]
    fn alpha(self) -> u32 {
        self.0 >> 24
    }
}

/// The texels of a look-up at coordinates: their places, their weights with 16 fraction bits, and column and row of the
/// first.
enum Taps {
    Nearest(u32, [u32; 2]),
    Mixed([u32; 4], [u32; 4], [u32; 2]),
}

inline_unless_small!(
    fn taps(texture: &Texture, level: &Level, [u, v]: [i32; 2]) -> Taps {
        let [width, height] = level.size;
        let u = wrapped(u, texture.wrap[0]);
        let v = wrapped(v, texture.wrap[1]);
        if texture.filter & Texture::BILINEAR == 0 {
            // At most 2^20 - 1 times 4096.
            let x = u.wrapping_mul(width) >> COORDINATE_BITS;
            let y = v.wrapping_mul(height) >> COORDINATE_BITS;
            let row = level.first.wrapping_add(y.wrapping_mul(width));
            return Taps::Nearest(row.wrapping_add(x), [x, y]);
        }
        let ([left, right], across) = neighbors(u, width, texture.wrap[0] == 0);
        let ([upper, lower], down) = neighbors(v, height, texture.wrap[1] == 0);
        let row = |y: u32| level.first.wrapping_add(y.wrapping_mul(width));
        let (above, below) = (row(upper), row(lower));
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
);

/// Returns a ratio with 30 fraction bits from a number of 8 bits, of which 255 means 1, with 16 fraction bits.
#[inline(always)]
pub(crate) fn ratio(number_q16: u32) -> i32 {
    // 2^62 / (255 2^16), rounded up, so that 255 is 1 exactly.
    const SCALE: u64 = (1_u64 << 62).div_ceil(255 << 16);
    (u64::from(number_q16).wrapping_mul(SCALE) >> 32) as i32
}

#[inline(always)]
fn square(root: u32) -> u32 {
    root.wrapping_mul(root)
}

/// Moves a texture coordinate into the image, by the rule by which the image continues: 0 up to 1.
#[inline(always)]
fn wrapped(coordinate: i32, wrap: u8) -> u32 {
    const ONE: i32 = 1 << COORDINATE_BITS;
    let inside = match wrap {
        0 => coordinate & (ONE - 1),
        1 => {
            // Every second image is mirrored: all bits of the fraction are inverted.
            let turned = (coordinate << (31 - COORDINATE_BITS)) >> 31;
            (coordinate ^ turned) & (ONE - 1)
        }
        _ => coordinate.clamp(0, ONE - 1),
    };
    inside.cast_unsigned()
}

/// Returns the two texels, of this many, between whose middles a coordinate lies, and the weight of the second in
/// 1/256.
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
