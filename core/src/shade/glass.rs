//! Glass: Snell's law, Fresnel's equations, Beer's law.
//!
//! The index of refraction is kept as its inverse `k`, at most 1, and the refracted direction may
//! have any length, so that every number here lies between -2 and 2.

use crate::accel::Number;
use crate::format::record::Material;
use crate::shade::Color;

/// What a glass surface does with a ray.
pub(crate) struct Split<N> {
    /// The part that is reflected; 1 is total internal reflection.
    pub(crate) reflected: N,
    /// The direction of the rest, of any length.
    pub(crate) refracted: [N; 3],
}

/// The reflected part of unpolarised light, from the cosines on both sides of a surface.
///
/// The two polarisations swap when a ray goes the other way, so this serves both.
fn fresnel<N: Number>(k: N, cos_in: N, cos_out: N) -> N {
    let part = |a: N, b: N| {
        let amplitude = (a.half() - b.half()).div(a.half() + b.half());
        amplitude * amplitude
    };
    let sum = part(k * cos_in, cos_out).half() + part(cos_in, k * cos_out).half();
    sum.min(N::ONE)
}

/// Splits a ray of direction `d` (of length 1) at a surface. `normal` points to where the ray came
/// from, `cos_in` is the cosine between them; `entering` says that the ray goes into the glass.
pub(crate) fn split<N: Number>(
    k: N,
    entering: bool,
    d: [N; 3],
    normal: [N; 3],
    cos_in: N,
) -> Split<N> {
    if k == N::ONE {
        return Split {
            reflected: N::ZERO,
            refracted: d,
        };
    }
    let sin2_in = (N::ONE - cos_in * cos_in).max(N::ZERO);
    let (cos_out, scale, lift);
    if entering {
        cos_out = (N::ONE - k * k * sin2_in).sqrt();
        (scale, lift) = (k, k * cos_in - cos_out);
    } else {
        if sin2_in >= k * k {
            return Split {
                reflected: N::ONE,
                refracted: d,
            };
        }
        cos_out = (N::ONE - sin2_in.div(k * k)).sqrt();
        (scale, lift) = (N::ONE, cos_in - k * cos_out);
    }
    let axis = |i: usize| scale * d[i] + lift * normal[i];
    Split {
        reflected: fresnel(k, cos_in, cos_out),
        refracted: [axis(0), axis(1), axis(2)],
    }
}

/// The part of light that passes a surface straight on, as shadows do: what Fresnel's equations
/// leave at the ray's angle, taken from outside whichever way it goes.
pub(crate) fn straight_through<N: Number>(k: N, cos_in: N) -> N {
    if k == N::ONE {
        return N::ONE;
    }
    let sin2_in = (N::ONE - cos_in * cos_in).max(N::ZERO);
    N::ONE - fresnel(k, cos_in, (N::ONE - k * k * sin2_in).sqrt())
}

/// What is left of light after a length of glass.
pub(crate) fn absorb<N: Number>(material: &Material, length: N) -> Color<N> {
    Color(
        material
            .absorption
            .map(|coefficient| length.exp_neg(coefficient)),
    )
}

#[cfg(test)]
mod tests;
