//! Rough surfaces: facets whose normals have the distribution GGX.

use super::exact::Exact;
use super::media::cos_back;
use super::numbers::{black, color, fraction, limited, mixed, one, peak, real};
use super::placed::Met;
use super::random::{beside, part, turn};
use super::surface::{Leaving, Surface};
use gridel_core::format::record::Light;
use gridel_host::shape::exact::{Real, Vector, cross, dot, minus, scaled, unit};

/// The α from which lights that are surfaces are reflected by the formula.
pub const WIDE: i32 = 96_636_764;

pub struct Facets {
    /// The surface's own normal for shading.
    normal: Vector,
    alpha: Real,
    cos_in: Real,
}

impl Facets {
    pub fn new(alpha: i32, normal: &Vector, cos_in: Real) -> Self {
        Self {
            normal: normal.clone(),
            alpha: fraction(alpha, 30),
            cos_in: limited(cos_in, 0.0, 1.0),
        }
    }

    /// The root of α² + (1 - α²) cos².
    fn slant(&self, cos: &Real) -> Real {
        let square = &self.alpha * &self.alpha;
        (&square + (one() - &square) * cos * cos).sqrt()
    }

    /// Returns the joint masking of the ways in and out: `cos_out` slant_in + `cos_in` slant_out.
    fn masking(&self, cos_out: &Real) -> Real {
        cos_out * self.slant(&self.cos_in) + &self.cos_in * self.slant(cos_out)
    }

    /// The normal of a random facet that the ray sees.
    pub fn draw(&self, direction: &Vector, [u, v]: [u32; 2]) -> Vector {
        let [first, second] = beside(&self.normal);
        let seen = [
            &self.alpha * cos_back(direction, &first),
            &self.alpha * cos_back(direction, &second),
            self.cos_in.clone(),
        ];
        let [x, y, z] = unit(&seen);
        // A point of the cap above -z of the sphere, uniformly.
        let sag = part(u) * (one() + &z);
        let across = limited(&sag * (real(2.0) - &sag), 0.0, 1.0).sqrt();
        let [sine, cosine] = turn(v);
        // Halfway between it and the ray.
        let half = real(0.5);
        let up = (one() - &sag + z) * &half;
        let facet = [
            &self.alpha * (&across * cosine + x) * &half,
            &self.alpha * (&across * sine + y) * &half,
            up.max(real(0.0)),
        ];
        let [x, y, z] = unit(&facet);
        mixed([&first, &second, &self.normal], [&x, &y, &z])
    }

    /// The ray without what other facets keep of it.
    pub fn leaving(&self, met: &Met<'_>, ray: Leaving) -> Leaving {
        let out = unit(&ray.slope);
        let is_reflected = ray.outward == met.front;
        let signed = |cos: Real, is_up: bool| if is_up { cos } else { -cos };
        let cos_out = signed(dot(&out, &self.normal), is_reflected).min(one());
        if !cos_out.is_positive() {
            return Leaving {
                weight: black(),
                ..ray
            };
        }
        let left = if is_reflected {
            let seen = &cos_out * (&self.cos_in + self.slant(&self.cos_in));
            seen / self.masking(&cos_out)
        } else {
            real(2.0) * &cos_out / (&cos_out + self.slant(&cos_out))
        };
        Leaving {
            weight: scaled(&ray.weight, &left.min(one())),
            ..ray
        }
    }

    /// π times the part of a light that all facets mirror, times the cosine.
    fn reflect(&self, cos_out: &Real, halfway: &Vector) -> Real {
        let sine = cross(&self.normal, halfway);
        let cos = dot(&self.normal, halfway);
        let square = &self.alpha * &self.alpha;
        let spread = dot(&sine, &sine) + &square * &cos * &cos;
        let distribution = &square / (&spread * &spread);
        distribution * cos_out / (real(2.0) * self.masking(cos_out))
    }
}

impl Exact<'_> {
    /// Returns the light that the facets of a rough surface mirror, for a light that rays do not
    /// hit; `None` for others.
    pub fn mirrored_light(
        &self,
        surface: &Surface<'_>,
        light: &Light,
        to_light: &Vector,
    ) -> Option<Vector> {
        let alpha = self.scene.roughness(surface.met.object)?;
        let is_met = match light.kind {
            Light::ENVIRONMENT => true,
            Light::SUN => alpha < WIDE && !self.is_sun_limited(),
            _ => alpha < WIDE && self.scene.is_shown(light),
        };
        if is_met {
            return None;
        }
        let Surface {
            material,
            normal,
            direction,
            ..
        } = surface;
        let halfway = unit(&minus(to_light, direction));
        let facets = Facets::new(alpha, normal, cos_back(direction, normal));
        let mut mirror = color(material.mirror, 30);
        if let Some(interface) = &surface.interface {
            let cos = limited(cos_back(direction, &halfway), 0.0, 1.0);
            let (reflected, _) = interface.split(direction, &halfway, &cos);
            let more = peak(&color(material.transmit, 30)) * &reflected;
            mirror = mirror.map(|x| (x + &more).min(one()));
        }
        let cos_out = dot(to_light, normal).min(one());
        Some(scaled(&mirror, &facets.reflect(&cos_out, &halfway)))
    }
}
