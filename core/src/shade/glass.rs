//! Glass: Snell's law, Fresnel's equations. One or two more rays per hit, and shadows through it.
//!
//! The index of refraction is stored as its inverse `k`, at most 1, and the refracted direction can
//! have any length. So every number here lies between -2 and 2.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::observe::count::Observer;
use crate::observe::event::{Event, RayKind};
use crate::ray::Ray;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::{Bounce, Filter, Interface, Secondary, Surface};

pub(crate) struct Glass;

impl Effect for Glass {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::GLASS;
    const NEEDS_DIRECTION: bool = true;
    const FILTERS: bool = true;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        material.is_glass()
    }

    #[inline(always)]
    fn filter<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Ray<N>,
        filter: &mut Filter<'s, '_, N>,
    ) {
        let material = filter.material;
        if !Self::is_required_by_material(material) {
            return;
        }
        filter.passes = true;
        let cos = N::from_wide(N::dot(filter.hit.normal, filter.to_light));
        let cos = cos.abs().min(N::ONE);
        let interface = filter
            .interface
            .unwrap_or_else(|| Interface::of(filter.hit, material));
        let passed = straight_through(interface.k, cos);
        let transmit = Color::ratios(material.transmit);
        filter.left = filter.left.times(transmit).scaled(passed);
    }

    #[inline(always)]
    fn bounce<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        bounce: &mut Bounce<N>,
    ) {
        let Surface { hit, material, .. } = *surface;
        if !surface.required.contains(Self::EFFECT) {
            return;
        }
        let interface = surface.interface();
        let Split {
            reflected,
            refracted,
        } = split(interface, surface.direction, bounce.normal, bounce.cos_in);
        if X::Observer::ENABLED {
            tracer.count().event(Event::Split {
                reflected: reflected.ratio_to_f64(),
            });
        }
        bounce.mirror(mirrored(material, reflected));
        let transmit = Color::ratios(material.transmit);
        let secondary = Secondary {
            kind: RayKind::Refracted,
            direction: refracted,
            outward: !hit.front,
            weight: surface.weight.times(transmit.scaled(N::ONE - reflected)),
        };
        // Facets do not hide what they do not bend.
        let is_bent = interface.k != N::ONE;
        let secondary = if is_bent {
            bounce.leaving(hit, secondary)
        } else {
            secondary
        };
        tracer.send(hit, secondary);
    }
}

/// Returns the weight of what glass reflects of a ray. The surface has no color: its largest channel weights all.
#[inline(always)]
pub(super) fn mirrored<N: Number>(material: &Material, reflected: N) -> Color<N> {
    let [red, green, blue] = material.transmit;
    let part = N::ratio(red.max(green).max(blue)) * reflected;
    Color([part; 3])
}

/// The split of a ray at a glass surface.
pub(super) struct Split<N> {
    /// The part that is reflected; 1 is total internal reflection.
    pub(super) reflected: N,
    /// The direction of the rest, of any length.
    refracted: [N; 3],
}

/// The reflected part of unpolarized light, from the cosines on both sides of a surface.
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

/// Splits a ray of direction `d` (of length 1) at a surface. `normal` points to the ray's origin,
/// `cos_in` is the cosine between them.
pub(super) fn split<N: Number>(
    Interface { k, to_denser }: Interface<N>,
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
    if to_denser {
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

/// Returns the part of light that passes a surface straight on, as for shadows. It is the part that
/// Fresnel's equations transmit at the ray's angle, as seen from outside, for either direction.
fn straight_through<N: Number>(k: N, cos_in: N) -> N {
    if k == N::ONE {
        return N::ONE;
    }
    let sin2_in = (N::ONE - cos_in * cos_in).max(N::ZERO);
    N::ONE - fresnel(k, cos_in, (N::ONE - k * k * sin2_in).sqrt())
}

#[cfg(test)]
mod tests;
