//! Texture levels: distant surfaces show smaller copies of a texture, whose texels are as large as the area that a
//! sample covers.
//!
//! A sample is treated as a cone around the ray of a pinhole camera, as wide as the distance to the neighboring
//! samples. It can hit a surface after a path of any number of rays. There the area that it covers is compared with
//! that of texels, and textures and normal maps are mixed from the two nearest levels.
//!
//! This is the method of T. Akenine-Möller and others, "Texture Level of Detail Strategies for Real-Time Ray Tracing"
//! (*Ray Tracing Gems*, 2019), with one difference, the area. They use its longer axis, which blurs too much where
//! several samples share a pixel. With more samples per pixel cones are narrower, so pictures become sharper and
//! converge to those without levels.
//!
//! Curved mirrors and lenses do not change cones. Rough and matt surfaces, which draw the directions of rays at random,
//! do not change them either. Shadow rays, and rays of the caller's own, see whole images. All arithmetic is in
//! integers, on logarithms, and a waiting ray holds two more bytes.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::number::log2::{log2, log2_of_power, log2_of_sum};
use crate::ray::Ray;
use crate::scene::textures::Footprint;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::Surface;
use crate::target::TextureLevelsOnly;

pub(crate) struct TextureLevels;

impl Effect for TextureLevels {
    type State<N: Number> = PathLength;

    const EFFECT: Effects = Effects::TEXTURE_LEVELS;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        material.maps & Material::MAPS_LEVELS != 0
    }

    #[inline(always)]
    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        path: &mut PathLength,
        ray: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        let scene = tracer.scene();
        if !scene.effects().contains(Self::EFFECT) {
            return;
        }
        // The length of the slopes, from 1 to the square root of 3.
        let norm = log2_of_ratio(N::recip_norm2(ray.slope)).wrapping_neg() >> 1;
        let steps = N::far_to_q13(surface.hit.t).unsigned_abs();
        *path = path.longer_by(log2(steps).wrapping_add(norm));
        let Some(spread) = tracer
            .spread()
            .filter(|_| surface.required.contains(Self::EFFECT))
        else {
            return;
        };
        let Some(density) = surface.hit.log2_density(scene) else {
            return;
        };
        let cosine = N::from_wide(N::dot(ray.slope, surface.hit.normal)).abs();
        let width = path.log2_units().wrapping_add(spread);
        let stretched = norm.wrapping_sub(log2_of_ratio(cosine)) >> 1;
        surface.footprint = Footprint::of_log2(width.wrapping_add(stretched).wrapping_add(density));
    }
}

/// The binary logarithm of a ratio.
#[inline(always)]
fn log2_of_ratio<N: Number>(ratio: N) -> i32 {
    log2(u64::from(ratio.to_q30().unsigned_abs())).wrapping_sub(log2_of_power(30))
}

/// The total length of the rays that led to a hit. It is the binary logarithm of that length in 2^-13 units, plus 1; 0
/// before the first ray. Bytes, so that they fill gaps next to other states.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathLength(TextureLevelsOnly<[u8; 2]>);

impl Default for PathLength {
    #[inline(always)]
    fn default() -> Self {
        Self::of(0)
    }
}

impl PathLength {
    #[inline(always)]
    fn of(number: u16) -> Self {
        Self(TextureLevelsOnly::of(number.to_le_bytes()))
    }

    #[inline(always)]
    fn number(self) -> u16 {
        self.0.get().map_or(0, |bytes| u16::from_le_bytes(*bytes))
    }

    /// Returns the sum with a length, given its logarithm.
    #[inline(always)]
    fn longer_by(self, log2_steps: i32) -> Self {
        let longer = match self.number().checked_sub(1) {
            Some(length) => log2_of_sum(length.into(), log2_steps),
            None => log2_steps,
        };
        // Less than 2^65 steps, far below the limit.
        Self::of((longer.max(0) as u16).wrapping_add(1))
    }

    #[inline(always)]
    fn log2_units(self) -> i32 {
        i32::from(self.number())
            .wrapping_sub(1)
            .wrapping_sub(log2_of_power(13))
    }
}
