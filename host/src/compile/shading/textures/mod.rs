//! Textures as a blob holds them, within a budget of bytes.
//!
//! Without a budget an image of at most 256 colors becomes a palette, and any other RGB888. With one, the image that
//! takes the most bytes is made coarser until all fit. The steps are RGB565 (not where alpha is used), then a palette
//! of 256 colors, then half the size, again and again. Images wider or higher than 4096 are halved in any case. Levels
//! are smaller copies of the result, and count. Their colors come from the palette, which has more where there is room.
//! Texels that are not visible get the colors of those beside them.

mod hidden;
mod stored;

use crate::compile::CompileError;
use crate::compile::section::{Section, section};
use crate::scene::{Alpha, Material, Texture, Wrap};
use crate::srgb::{linear_of_srgb, srgb_of_linear};
use crate::table::{grouped, printable};
use gridel_core::format::SectionKind;
use gridel_core::format::record;
use serde::Serialize;
use std::fmt;
use std::sync::Arc;
use stored::{Stored, UsedImage};

/// The storage of a texture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TextureFigures {
    /// The source of the image.
    pub name: String,
    pub width: u32,
    pub height: u32,
    /// `palette`, `rgb565`, `rgb888` or `rgba8888`.
    pub form: &'static str,
    /// True if smaller copies of the image follow it.
    pub levels: bool,
    pub bytes: u64,
}

impl fmt::Display for TextureFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            width,
            height,
            form,
            levels,
            bytes,
        } = self;
        let (name, bytes) = (printable(name), grouped(*bytes));
        let levels = if *levels { ", with levels" } else { "" };
        write!(
            f,
            "{name}, {width} x {height}, {form}{levels}, {bytes} bytes"
        )
    }
}

/// Returns a channel of linear light as a blob holds it. In scenes whose colors are display values, the channel itself
/// counts.
pub fn root(linear: f64, display_values: bool) -> u8 {
    let channel = linear.clamp(0.0, 1.0);
    let channel = if display_values {
        srgb_of_linear(channel)
    } else {
        channel
    };
    (libm::sqrt(channel) * 255.0).round() as u8
}

/// Returns the lookup flags of a texture's record.
fn filter(texture: &Texture) -> u8 {
    let bit = |bit, is_set| if is_set { bit } else { 0 };
    bit(record::Texture::BILINEAR, texture.bilinear) | bit(record::Texture::LEVELS, texture.levels)
}

/// The textures of the materials in use.
#[derive(Debug, Default)]
pub struct Textures {
    images: Vec<UsedImage>,
    textures: Vec<(usize, Texture)>,
    maps: Vec<(record::SurfaceMaps, record::NormalMap)>,
}

impl Textures {
    /// Returns the field of a material's record about its maps.
    pub fn maps(&mut self, material: &Material) -> u16 {
        let alpha = material.alpha.filter(|_| material.transmit == [0.0; 3]);
        let color = material.texture.as_ref();
        let normals = material.normal_map.as_ref();
        if color.is_none() && normals.is_none() {
            return 0;
        }
        // Too many are an error later.
        let limit = |number: usize| (number + 1).min(record::Material::MAPS_NUMBER.into()) as u16;
        let mut flags = 0;
        let mut maps = record::SurfaceMaps {
            color: 0,
            cutoff: 0,
            opacity: 0,
        };
        let textures = color.into_iter().chain(normals.map(|it| &it.texture));
        if textures.into_iter().any(|it| it.levels) {
            flags |= record::Material::MAPS_LEVELS;
        }
        if let Some(texture) = color {
            flags |= record::Material::MAPS_TEXTURE;
            maps.color = limit(self.number(texture, false, alpha.is_some()));
            let of_255 = |it: f64| (it.clamp(0.0, 1.0) * 255.0).round() as u8;
            (maps.cutoff, maps.opacity) = match alpha {
                None => (0, 0),
                Some(Alpha::Blend(factor)) => (0, of_255(factor)),
                Some(Alpha::CutOut(least)) => (least_alpha(least), 255),
            };
            if alpha.is_some() {
                flags |= record::Material::MAPS_ALPHA;
            }
        }
        let mut normal_map = record::NormalMap::default();
        if let Some(map) = normals {
            flags |= record::Material::MAPS_NORMAL;
            let of_65535 = |it: f64| (it.clamp(0.0, 1.0) * 65_535.0).round() as u16;
            normal_map = record::NormalMap {
                texture: limit(self.number(&map.texture, true, false)),
                // Only the ratio of both matters.
                across: of_65535(map.scale),
                along: of_65535(1.0 / map.scale.max(1.0)),
            };
        }
        let both = (maps, normal_map);
        let known = self.maps.iter().position(|it| *it == both);
        let number = known.unwrap_or_else(|| {
            self.maps.push(both);
            self.maps.len() - 1
        });
        limit(number) | flags
    }

    /// The number of a texture of colors or of normals, counted from 0.
    fn number(&mut self, texture: &Texture, has_normals: bool, has_alpha: bool) -> usize {
        let known = self
            .images
            .iter()
            .position(|it| it.image == texture.image && it.has_normals == has_normals);
        let image = known.unwrap_or_else(|| {
            self.images.push(UsedImage {
                image: Arc::clone(&texture.image),
                has_normals,
                has_alpha: false,
                has_levels: false,
                mixed: None,
            });
            self.images.len() - 1
        });
        self.images[image].has_alpha |= has_alpha;
        self.images[image].has_levels |= texture.levels;
        let mixed = &mut self.images[image].mixed;
        *mixed = mixed.or(texture.bilinear.then_some(texture.wrap));
        let looked_up = |it: &Texture| (it.wrap, it.bilinear, it.levels);
        let same = |(number, other): &(usize, Texture)| {
            *number == image && looked_up(other) == looked_up(texture)
        };
        let known = self.textures.iter().position(same);
        known.unwrap_or_else(|| {
            self.textures.push((image, texture.clone()));
            self.textures.len() - 1
        })
    }

    /// Returns the sections, and how each image is stored.
    pub fn sections(
        self,
        display_values: bool,
        budget: Option<u64>,
    ) -> Result<(Vec<Section>, Vec<TextureFigures>), CompileError> {
        let most = record::Material::MAPS_NUMBER.into();
        let count = self.textures.len().max(self.maps.len());
        if count > most {
            let what = "textures";
            return Err(CompileError::TooMany { what, count, most });
        }
        if count == 0 {
            return Ok((Vec::new(), Vec::new()));
        }
        let roots: [u8; 256] = std::array::from_fn(|it| {
            let channel = it as f64 / 255.0;
            root(linear_of_srgb(channel), display_values)
        });
        let as_they_are: [u8; 256] = std::array::from_fn(|it| it as u8);
        let images = self.images.iter().map(|it| {
            let channels = if it.has_normals { &as_they_are } else { &roots };
            Stored::of(it, channels)
        });
        let mut images: Vec<Stored> = images.collect();
        let total = |images: &[Stored]| images.iter().map(Stored::bytes).sum::<u64>();
        while budget.is_some_and(|most| total(&images) > most) {
            let largest = images.iter_mut().max_by_key(|it| it.bytes());
            if !largest.is_some_and(Stored::make_coarser) {
                return Err(CompileError::TextureBytes {
                    bytes: total(&images),
                    most: budget.unwrap_or(0),
                });
            }
        }
        let mut texels = Vec::new();
        let mut firsts = Vec::new();
        for image in &images {
            firsts.push(texels.len() as u32);
            texels.extend(image.encoded());
            let (count, most) = (texels.len(), i32::MAX as usize);
            if count > most {
                let what = "bytes of textures";
                return Err(CompileError::TooMany { what, count, most });
            }
        }
        let textures = self.textures.iter().map(|(number, texture)| {
            let image = &images[*number];
            record::Texture {
                first: firsts[*number],
                width: image.raster.width as u16,
                height: image.raster.height as u16,
                form: image.form as u8,
                filter: filter(texture),
                wrap: texture.wrap.map(|it| match it {
                    Wrap::Repeat => 0,
                    Wrap::Mirror => 1,
                    Wrap::Clamp => 2,
                }),
            }
        });
        let textures: Vec<_> = textures.collect();
        let figures = images.iter().map(|it| TextureFigures {
            name: it.name.clone(),
            width: it.raster.width,
            height: it.raster.height,
            form: it.form.name(),
            levels: it.has_levels,
            bytes: it.bytes(),
        });
        let (maps, mut normal_maps): (Vec<_>, Vec<_>) = self.maps.into_iter().unzip();
        // Those behind the last have none.
        let used = normal_maps.iter().rposition(|it| it.texture > 0);
        normal_maps.truncate(used.map_or(0, |last| last + 1));
        let sections = vec![
            section(SectionKind::SurfaceMaps, &maps),
            section(SectionKind::NormalMaps, &normal_maps),
            section(SectionKind::Textures, &textures),
            section(SectionKind::Texels, &texels),
        ];
        Ok((sections, figures.collect()))
    }
}

/// The part of a cutoff that rounding may add: glTF files bring it in `f32`, and as a quotient of two of those.
const ROUNDED: f64 = 1.0 / (1 << 22) as f64;

/// Returns the least alpha of 8 bits that is as large as a cutoff.
fn least_alpha(cutoff: f64) -> u8 {
    let least = cutoff.clamp(0.0, 1.0) * 255.0;
    (least * (1.0 - ROUNDED)).ceil().max(1.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Image;
    use std::sync::Arc;

    fn image(width: u32, height: u32, color: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let pixels = (0..width * height).map(|it| color(it % width, it / width));
        Image::new("test", width, height, pixels.collect()).unwrap()
    }

    fn stored(image: Image, budget: Option<u64>) -> Result<TextureFigures, CompileError> {
        let mut textures = Textures::default();
        let material = Material {
            texture: Some(Texture::of(Arc::new(image))),
            ..Material::default()
        };
        assert_eq!(textures.maps(&material), 1 | record::Material::MAPS_TEXTURE);
        assert_eq!(textures.maps(&material), 1 | record::Material::MAPS_TEXTURE);
        let (_, mut figures) = textures.sections(false, budget)?;
        Ok(figures.remove(0))
    }

    #[test]
    fn alpha_that_equals_the_cutoff_is_kept_whatever_rounded_it() {
        for alpha in 1..=255_u8 {
            let exact = f64::from(alpha) / 255.0;
            assert_eq!(least_alpha(exact), alpha);
            assert_eq!(least_alpha((exact as f32).into()), alpha);
            for factor in [0.1_f32, 0.3, 0.7, 0.9] {
                let cutoff = f64::from((exact * f64::from(factor)) as f32);
                assert_eq!(least_alpha(cutoff / f64::from(factor)), alpha);
            }
            assert_eq!(least_alpha(exact * 1.000_001), alpha.saturating_add(1));
        }
        assert_eq!(least_alpha(0.2_f32.into()), 51);
        assert_eq!([0.0, 0.5, 1.0].map(least_alpha), [1, 128, 255]);
    }

    #[test]
    fn budget_chooses_forms_and_sizes() {
        let many = || {
            image(64, 64, |x, y| {
                [4 * x as u8, 4 * y as u8, (x ^ y) as u8, 255]
            })
        };
        for (budget, form, width) in [
            (None, "rgb888", 64),
            (Some(12_288), "rgb888", 64),
            (Some(12_287), "rgb565", 64),
            (Some(8191), "palette", 64),
            (Some(5119), "palette", 32),
            (Some(2047), "rgb565", 16),
            (Some(2), "rgb565", 1),
        ] {
            let figures = stored(many(), budget).unwrap();
            assert_eq!((figures.form, figures.width), (form, width), "{budget:?}");
            assert!(budget.is_none_or(|most| figures.bytes <= most));
        }
        assert!(matches!(
            stored(many(), Some(1)),
            Err(CompileError::TextureBytes { .. })
        ));
        let few = image(64, 64, |x, _| [x as u8, 0, 0, 255]);
        assert_eq!(stored(few, None).unwrap().form, "palette");
        let wide = image(8192, 2, |_, _| [9, 9, 9, 255]);
        assert_eq!(stored(wide, None).unwrap().width, 4096);
    }

    #[test]
    fn roots_are_within_a_step_of_a_display() {
        for encoded in 0..=255_u8 {
            let linear = linear_of_srgb(f64::from(encoded) / 255.0);
            let root = f64::from(root(linear, false)) / 255.0;
            let back = srgb_of_linear(root * root) * 255.0;
            assert!(
                (back - f64::from(encoded)).abs() <= 1.0,
                "{encoded}: {back}"
            );
        }
        assert_eq!(
            [root(1.0, false), root(0.0, false), root(1.0, true)],
            [255, 0, 255]
        );
    }
}
