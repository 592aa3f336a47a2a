//! Rough surfaces: facets that are mirrors or glass, with the distribution GGX of their normals.
//!
//! - **Distribution and shadowing**: Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through
//!   Rough Surfaces", 2007. For reflection, one height masks both ways (Heitz, "Understanding the Masking-Shadowing
//!   Function in Microfacet-Based BRDFs", 2014). For refraction, each way is masked on its own.
//! - **Visible normals**: a facet is drawn as the ray sees it (Heitz, "Sampling the GGX Distribution of Visible
//!   Normals", 2018). The method is a cap of the sphere (Dupuy and Benyoub, "Sampling Visible GGX Normals with
//!   Spherical Caps", 2023).
//!
//! Light that bounces between facets is lost, as is usual.

use crate::accel::Number;
use crate::format::limits::LEAST_ROUGHNESS;
use crate::number::Angle;
use crate::query::Hit;
use crate::shade::basis::{perpendicular, wide_cross};
use crate::shade::sampler::ratio;

/// The facets of a rough surface, seen by a ray.
#[derive(Clone, Copy)]
pub(crate) struct Facets<N> {
    /// The surface's own normal for shading, on the side from which the ray came.
    normal: [N; 3],
    alpha: N,
    square: N,
    /// The cosine between the normal and the way back to the ray's origin, 0 to 1.
    cos_in: N,
    /// The [`slant`](Self::slant) of that cosine.
    slant_in: N,
}

impl<N: Number> Facets<N> {
    /// Returns facets with an α of 30 fraction bits.
    #[inline(always)]
    pub(crate) fn new(alpha: i32, normal: [N; 3], cos_in: N) -> Self {
        // Limited to the range for blobs that are not proved.
        let alpha = N::ratio(alpha.clamp(LEAST_ROUGHNESS, 1 << 30));
        let mut facets = Self {
            normal,
            alpha,
            square: alpha * alpha,
            cos_in: cos_in.max(N::ZERO).min(N::ONE),
            slant_in: N::ONE,
        };
        facets.slant_in = facets.slant(facets.cos_in);
        facets
    }

    /// Returns the root of α² + (1 - α²) cos², from α to 1. A way with this cosine is masked by 1 - 2 cos / (cos +
    /// slant).
    #[inline(always)]
    fn slant(&self, cos: N) -> N {
        (self.square + (N::ONE - self.square) * cos * cos).sqrt()
    }

    /// The normal of a random facet that the ray sees.
    #[inline(never)]
    pub(crate) fn draw(&self, direction: [N; 3], [u, v]: [u32; 2]) -> [N; 3] {
        let [first, second] = perpendicular(self.normal);
        let back = |axis: [N; 3]| -N::from_wide(N::dot(axis, direction));
        // As if the surface were a hemisphere, which α flattens.
        let stretched = [
            self.alpha * back(first),
            self.alpha * back(second),
            self.cos_in,
        ];
        let ([x, y, z], length) = N::normalize(stretched);
        if length <= N::ZERO {
            return self.normal;
        }
        // A uniformly distributed point of the cap above -z; 1 less its height.
        let part = ratio::<N>(u);
        let sag = part + part * z;
        let across = sag * (N::ONE - sag.half());
        let across = (across + across).max(N::ZERO).min(N::ONE).sqrt();
        let [sine, cosine] = Angle(v).sin_cos().map(N::ratio);
        // Halfway between it and the ray, like the normal of a mirror on the hemisphere.
        let x = (across * cosine).half() + x.half();
        let y = (across * sine).half() + y.half();
        let z = N::ONE.half() - sag.half() + z.half();
        let facet = [self.alpha * x, self.alpha * y, z.max(N::ZERO)];
        let ([x, y, z], length) = N::normalize(facet);
        if length <= N::ZERO {
            return self.normal;
        }
        let normal = self.normal;
        let axis = |k: usize| first[k] * x + second[k] * y + normal[k] * z;
        [axis(0), axis(1), axis(2)]
    }

    /// Returns the part of a ray's weight that leaves by a drawn facet, because no other facet is in its way. It is 0
    /// for a ray to the wrong side of the surface as it is shaded. One to the wrong side of a triangle is turned later.
    /// `outward` is the side of the geometric normal.
    #[inline(never)]
    pub(crate) fn unmasked(&self, hit: &Hit<N>, direction: [N; 3], outward: bool) -> N {
        let (out, _) = N::normalize(direction);
        let is_reflected = outward == hit.front;
        let rise = N::from_wide(N::dot(out, self.normal));
        let cos_out = if is_reflected { rise } else { -rise }.min(N::ONE);
        if cos_out <= N::ZERO {
            N::ZERO
        } else if is_reflected {
            self.unmasked_reflection(cos_out)
        } else {
            let slant = self.slant(cos_out);
            cos_out.div(cos_out.half() + slant.half()).min(N::ONE)
        }
    }

    /// Returns the part of the light reflected by visible facets that leaves with this cosine above 0.
    #[inline(always)]
    fn unmasked_reflection(&self, cos_out: N) -> N {
        let seen = cos_out * (self.cos_in.half() + self.slant_in.half());
        seen.div(self.half_masking(cos_out)).min(N::ONE)
    }

    /// Half of cos_out slant_in + cos_in slant_out: in the range of ratios.
    #[inline(always)]
    fn half_masking(&self, cos_out: N) -> N {
        let slant_out = self.slant(cos_out);
        (cos_out * self.slant_in).half() + (self.cos_in * slant_out).half()
    }

    /// Returns the part of a light that the facets reflect, if each reflects all light, as a ratio and a power of two.
    /// The light's direction is `cos_out` above 0 over the surface. The result is π times the facets' part of all
    /// reflected light times `cos_out`. `halfway` is the normal of the facets that mirror the light to the ray's
    /// origin.
    #[inline(never)]
    pub(crate) fn reflect(&self, cos_out: N, halfway: [N; 3]) -> (N, u32) {
        // The sine is precise where the angle is small, and 1 - cos² is not.
        let sine = wide_cross(self.normal, halfway);
        let sine2 = N::from_wide(N::dot(sine, sine));
        let cos = N::from_wide(N::dot(self.normal, halfway));
        // α² over this, squared, is π times the distribution.
        let spread = sine2 + self.square * cos * cos;
        let spread = spread.max(self.square).min(N::ONE);
        let (spread_part, spread_power) = scaled_up(spread);
        let (masking_part, masking_power) = scaled_up(self.half_masking(cos_out));
        // α² / spread² times cos_out / (4 half_masking).
        let ratio = cos_out.half().half().div(masking_part);
        let mut ratio = (self.square.div(spread) * ratio).div(spread_part);
        let mut power = spread_power.wrapping_add(masking_power);
        // The power is the least possible, because it costs other ratios digits.
        while ratio < N::ONE.half() && power > 0 {
            ratio = ratio + ratio;
            power = power.wrapping_sub(1);
        }
        (ratio.min(N::ONE), power)
    }
}

/// Returns a ratio above 0 as a ratio of at least 1/2, over a power of two.
#[inline(always)]
fn scaled_up<N: Number>(mut ratio: N) -> (N, u32) {
    let half = N::ONE.half();
    let mut power = 0_u32;
    while ratio < half && power < 30 {
        ratio = ratio + ratio;
        power = power.wrapping_add(1);
    }
    (ratio.max(half), power)
}

#[cfg(test)]
mod tests;
