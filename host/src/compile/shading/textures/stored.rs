//! Images in fewer and fewer bytes, with their levels.

use crate::palette::{median_cut, nearest};
use crate::scene::{Image, Wrap};
use gridel_core::format::record;
use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::Arc;

/// Most texels of a side.
const MOST_SIDE: u32 = 4096;
/// Most colors of a palette.
pub(super) const COLORS: usize = 256;

/// A color as roots of linear light, or a normal, and alpha.
pub(super) type Roots = [u8; 4];

/// An image and its uses.
#[derive(Debug)]
pub(super) struct UsedImage {
    pub(super) image: Arc<Image>,
    /// True if it holds normals, and not colors.
    pub(super) has_normals: bool,
    /// True if its alpha is used.
    pub(super) has_alpha: bool,
    /// True if smaller copies follow it.
    pub(super) has_levels: bool,
    /// How it continues beyond its edges, in the first texture that mixes its texels.
    pub(super) mixed: Option<[Wrap; 2]>,
}

/// The forms of texels, as [`record::Texture`] numbers them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Palette = 0,
    Rgb565 = 1,
    Rgb888 = 2,
    Rgba8888 = 3,
}

impl Form {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Palette => "palette",
            Self::Rgb565 => "rgb565",
            Self::Rgb888 => "rgb888",
            Self::Rgba8888 => "rgba8888",
        }
    }
}

/// Pixels, row by row.
#[derive(Clone)]
pub(super) struct Raster {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) pixels: Vec<Roots>,
}

/// An image on its way into a blob.
pub(super) struct Stored {
    pub(super) name: String,
    pub(super) raster: Raster,
    has_alpha: bool,
    has_normals: bool,
    pub(super) has_levels: bool,
    /// How it continues, if its texels are mixed and some may not be visible.
    hidden: Option<[Wrap; 2]>,
    pub(super) form: Form,
}

impl Raster {
    /// Returns the image with half the width and height, rounded up. Colors are means of linear light by area and
    /// alpha, and normals by area.
    fn halved(&self, has_normals: bool) -> Self {
        let [width, height] = record::Texture::next_level([self.width, self.height]);
        let mut pixels = Vec::with_capacity((width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                // What is invisible counts where all is.
                let mean = self.mean(has_normals, [x, y], [width, height], |alpha| alpha);
                let mean = mean.or_else(|| self.mean(has_normals, [x, y], [width, height], |_| 1));
                pixels.push(mean.unwrap_or_default());
            }
        }
        Self {
            width,
            height,
            pixels,
        }
    }

    /// The mean of the pixels below one of a smaller copy; `None` if all their weights are 0.
    fn mean(
        &self,
        has_normals: bool,
        [x, y]: [u32; 2],
        [width, height]: [u32; 2],
        weight: impl Fn(u64) -> u64,
    ) -> Option<Roots> {
        let (mut sum, mut all) = ([0_u64; 3], 0);
        let (mut alphas, mut area) = (0, 0);
        for (row, tall) in below(y, height, self.height) {
            for (column, wide) in below(x, width, self.width) {
                let pixel = self.pixels[(row * self.width + column) as usize].map(u64::from);
                let part = wide * tall;
                alphas += part * pixel[3];
                area += part;
                let part = part * weight(pixel[3]);
                all += part;
                for (sum, channel) in sum.iter_mut().zip(pixel) {
                    *sum += part
                        * if has_normals {
                            channel
                        } else {
                            channel * channel
                        };
                }
            }
        }
        let [r, g, b] = sum.map(|it| {
            let mean = it as f64 / all as f64;
            let channel = if has_normals { mean } else { libm::sqrt(mean) };
            channel.round() as u8
        });
        let alpha = (alphas + area / 2) / area;
        (all > 0).then_some([r, g, b, alpha as u8])
    }
}

/// The texels of a side that lie below one of a smaller copy, each with how much of it does: all add up to the side's
/// texels.
fn below(place: u32, copies: u32, texels: u32) -> impl Iterator<Item = (u32, u64)> {
    let [place, copies, texels] = [place, copies, texels].map(u64::from);
    let [start, end] = [place * texels, (place + 1) * texels];
    (start / copies..end.div_ceil(copies)).map(move |texel| {
        let covered = end.min((texel + 1) * copies) - start.max(texel * copies);
        (texel as u32, covered)
    })
}

impl Stored {
    /// An image whose channels are stored so.
    pub(super) fn of(used: &UsedImage, channels: &[u8; 256]) -> Self {
        let image = &used.image;
        let [width, height] = image.size();
        let pixels = image.pixels().iter();
        let has_alpha = used.has_alpha && !image.is_opaque();
        let pixels = pixels.map(|&[r, g, b, alpha]| {
            let [r, g, b] = [r, g, b].map(|it| channels[usize::from(it)]);
            [r, g, b, if has_alpha { alpha } else { 255 }]
        });
        let mut raster = Raster {
            width,
            height,
            pixels: pixels.collect(),
        };
        let hidden = used.mixed.filter(|_| has_alpha);
        if let Some(wrap) = hidden {
            raster.fill_hidden(wrap);
        }
        let mut stored = Self {
            name: image.name.clone(),
            raster,
            has_alpha,
            has_normals: used.has_normals,
            has_levels: used.has_levels,
            hidden,
            form: match has_alpha {
                true => Form::Rgba8888,
                false => Form::Rgb888,
            },
        };
        while stored.raster.width > MOST_SIDE || stored.raster.height > MOST_SIDE {
            stored.halve();
        }
        let mut colors = HashSet::new();
        let is_few = stored.raster.pixels.iter().all(|it| {
            colors.insert(*it);
            colors.len() <= COLORS
        });
        let as_palette = Form::Palette;
        if is_few && stored.bytes_as(as_palette) < stored.bytes() {
            stored.form = as_palette;
        }
        stored
    }

    pub(super) fn bytes(&self) -> u64 {
        self.bytes_as(self.form)
    }

    fn bytes_as(&self, form: Form) -> u64 {
        let texture = record::Texture {
            first: 0,
            width: self.raster.width as u16,
            height: self.raster.height as u16,
            form: form as u8,
            filter: match self.has_levels {
                true => record::Texture::LEVELS,
                false => 0,
            },
            wrap: [0; 2],
        };
        texture.bytes() as u64
    }

    /// Takes fewer bytes and loses as little as can be; false where it cannot.
    pub(super) fn make_coarser(&mut self) -> bool {
        match self.form {
            Form::Rgb888 => self.form = Form::Rgb565,
            Form::Rgb565 | Form::Rgba8888 if self.bytes_as(Form::Palette) < self.bytes() => {
                self.form = Form::Palette;
            }
            _ if self.raster.pixels.len() == 1 => return false,
            _ => {
                self.halve();
                let direct = match self.has_alpha {
                    true => Form::Rgba8888,
                    false => Form::Rgb565,
                };
                if self.bytes_as(direct) < self.bytes() {
                    self.form = direct;
                }
            }
        }
        true
    }

    fn halve(&mut self) {
        self.raster = self.smaller(&self.raster);
    }

    /// A copy of half the width and height.
    fn smaller(&self, raster: &Raster) -> Raster {
        let mut copy = raster.halved(self.has_normals);
        if let Some(wrap) = self.hidden {
            copy.fill_hidden(wrap);
        }
        copy
    }

    /// The pixels of the image, and those of its levels.
    fn pixels(&self) -> Cow<'_, [Roots]> {
        if !self.has_levels {
            return Cow::Borrowed(&self.raster.pixels);
        }
        let mut all = self.raster.pixels.clone();
        let mut level = self.raster.clone();
        while level.pixels.len() > 1 {
            level = self.smaller(&level);
            all.extend(&level.pixels);
        }
        Cow::Owned(all)
    }

    /// Palette and texels.
    pub(super) fn encoded(&self) -> Vec<u8> {
        let pixels = self.pixels();
        match self.form {
            Form::Rgb888 => pixels.iter().flat_map(|it| [it[0], it[1], it[2]]).collect(),
            Form::Rgba8888 => pixels.as_flattened().to_vec(),
            Form::Rgb565 => {
                let pack = |&[r, g, b, _]: &Roots| {
                    let bits = |root: u8, most: u32| (u32::from(root) * most + 127) / 255;
                    let packed = bits(r, 31) << 11 | bits(g, 63) << 5 | bits(b, 31);
                    (packed as u16).to_le_bytes()
                };
                pixels.iter().flat_map(pack).collect()
            }
            Form::Palette => {
                let palette = palette(&self.raster.pixels, &pixels);
                let mut bytes: Vec<u8> = Vec::with_capacity(self.bytes() as usize);
                bytes.extend(palette.as_flattened());
                bytes.resize(4 * COLORS, 0);
                bytes.extend(nearest(&palette, &pixels));
                bytes
            }
        }
    }
}

/// At most [`COLORS`] colors for the pixels of an image, and for these with those of its levels. If those of the image
/// fit, all of them are among the colors, and others where there is room.
fn palette(image: &[Roots], all: &[Roots]) -> Vec<Roots> {
    let own: HashSet<Roots> = image.iter().copied().collect();
    if own.len() > COLORS {
        return median_cut(all, COLORS);
    }
    let mut colors = median_cut(image, COLORS);
    let others = all.iter().filter(|it| !own.contains(*it)).copied();
    let others: Vec<Roots> = others.collect();
    if colors.len() < COLORS && !others.is_empty() {
        colors.extend(median_cut(&others, COLORS - colors.len()));
    }
    colors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn palette_of_few_colors_is_exact() {
        let pixels: Vec<Roots> = (0..=255).map(|it| [it, 255 - it, 7, it / 2]).collect();
        let sorted = |mut colors: Vec<Roots>| {
            colors.sort_unstable();
            colors
        };
        assert_eq!(sorted(palette(&pixels, &pixels)), pixels);
        // There is no room for another.
        let more = [&pixels[..], &[[9, 9, 9, 9]; 4]].concat();
        assert_eq!(sorted(palette(&pixels, &more)), pixels);
        // For one of two there is.
        let (few, others) = (&pixels[1..], [[0, 0, 0, 255], [2, 0, 0, 255]]);
        let found = palette(few, &[few, &others].concat());
        assert!(few.iter().all(|it| found.contains(it)) && found.contains(&[1, 0, 0, 255]));
        assert_eq!(found.len(), COLORS);
    }

    /// The pixel to which an image shrinks.
    fn shrunk(width: u32, height: u32, pixel: impl Fn(u32, u32) -> Roots) -> Roots {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let mut raster = Raster {
            width,
            height,
            pixels: places.map(|(x, y)| pixel(x, y)).collect(),
        };
        while raster.pixels.len() > 1 {
            raster = raster.halved(false);
        }
        raster.pixels[0]
    }

    #[test]
    fn smaller_copies_have_the_mean_of_images_of_every_size() {
        for (width, height) in [
            (64, 64),
            (65, 65),
            (100, 100),
            (513, 3),
            (1, 129),
            (7, 1000),
        ] {
            // White in the last row and column.
            let is_white = |x, y| x + 1 == width || y + 1 == height;
            let [root, .., alpha] = shrunk(width, height, |x, y| match is_white(x, y) {
                true => [255; 4],
                false => [40, 40, 40, 255],
            });
            let white = f64::from(width + height - 1) / f64::from(width * height);
            let mean = white + (1.0 - white) * (40.0_f64 / 255.0).powi(2);
            let found = (f64::from(root) / 255.0).powi(2);
            assert!(
                (found - mean).abs() < 0.02 && alpha == 255,
                "{width}x{height}: {found} {mean}"
            );
        }
    }

    #[test]
    fn hidden_colors_do_not_show_in_smaller_copies() {
        let half = shrunk(8, 8, |x, _| match x < 4 {
            true => [255, 0, 0, 255],
            false => [0, 255, 0, 0],
        });
        assert_eq!(half, [255, 0, 0, 128]);
        assert_eq!(shrunk(3, 3, |_, _| [9, 8, 7, 0]), [9, 8, 7, 0]);
    }
}
