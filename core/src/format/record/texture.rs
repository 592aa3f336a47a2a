//! Textures, and the maps of materials.

use crate::format::layout::records;
use crate::target::TEXTURE_LEVELS;
use bytemuck::{Pod, Zeroable};

records! {
    /// The maps of a material.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(4)]
    pub struct SurfaceMaps {
        /// The texture that weights the diffuse color, counted from 1; 0 for none.
        pub color: u16,
        /// Where the texture's alpha is used: 0 for blending, else what alpha, of 255, is opaque; less is not there.
        pub cutoff: u8,
        /// Where the texture's alpha is used: a factor of it, of which 255 is 1.
        pub opacity: u8,
    }

    /// The image of the normals of a material, in the order of the [`SurfaceMaps`]. Its red, green and blue are the
    /// components along u, against v, and along the normal: 0 is -1, and 255 is 1.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(6)]
    pub struct NormalMap {
        /// The texture, counted from 1; 0 for none.
        pub texture: u16,
        /// A factor of the components along u and v: 65535 is 1.
        pub across: u16,
        /// A factor of the component along the normal: 65535 is 1.
        pub along: u16,
    }

    /// An image, and how it is looked up. Colors are square roots of linear light: 255 is 1. Those
    /// of normal maps are not roots.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(12)]
    pub struct Texture {
        /// Its first byte among the texels. Texels are stored row by row, the upper row first.
        pub first: u32,
        /// Width in texels.
        #[valid(TextureWidth: 1..=4096)]
        pub width: u16,
        /// Height in texels.
        #[valid(TextureHeight: 1..=4096)]
        pub height: u16,
        /// The storage of a texel: 0 as an index of 8 bits into 256 colors of 4 bytes, which lie before the texels; 1 as
        /// RGB565, the lower byte first; 2 as red, green, blue; 3 as red, green, blue, alpha.
        #[valid(TextureForm: 0..=3)]
        pub form: u8,
        /// 0 for the nearest texel, 1 for the bilinear mean of four. 2 more if smaller copies follow the texels, each of
        /// half the width and height, rounded up, down to a single texel: its levels.
        #[valid(TextureFilter: 0..=3)]
        pub filter: u8,
        /// Beyond the image, along u and v: 0 it repeats, 1 it repeats in a mirror, 2 its edge goes on.
        #[valid(TextureWrap: 0..=2)]
        pub wrap: [u8; 2],
    }
}

impl Texture {
    /// Bytes of the palette before the texels.
    pub const fn palette_bytes(&self) -> usize {
        if self.form == 0 { 1024 } else { 0 }
    }

    /// Bytes per texel.
    pub const fn texel_bytes(&self) -> usize {
        match self.form {
            0 => 1,
            1 => 2,
            2 => 3,
            _ => 4,
        }
    }

    /// The bit of [`filter`](Self::filter) for the bilinear mean.
    pub const BILINEAR: u8 = 1;

    /// The bit of [`filter`](Self::filter) for levels.
    pub const LEVELS: u8 = 2;

    /// Returns true if levels follow the texels, and this build reads them.
    pub const fn has_levels(&self) -> bool {
        TEXTURE_LEVELS && self.filter & Self::LEVELS != 0
    }

    /// Width and height of the level after one of this size.
    pub const fn next_level([width, height]: [u32; 2]) -> [u32; 2] {
        [width.div_ceil(2), height.div_ceil(2)]
    }

    /// Number of texels, with those of levels: less than 2^25.
    pub const fn texels(&self) -> usize {
        let mut size = [self.width as u32, self.height as u32];
        let mut texels = size[0].wrapping_mul(size[1]);
        while self.has_levels() && (size[0] > 1 || size[1] > 1) {
            size = Self::next_level(size);
            texels = texels.wrapping_add(size[0].wrapping_mul(size[1]));
        }
        texels as usize
    }

    /// Bytes of palette and texels: less than 2^27 and 1024.
    pub const fn bytes(&self) -> usize {
        let texels = self.texels().wrapping_mul(self.texel_bytes());
        self.palette_bytes().wrapping_add(texels)
    }
}
