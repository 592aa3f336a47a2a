//! Rough surfaces: the distribution GGX of their facets, in exact arithmetic.

use super::directions;
use super::hit::{Hit, Seen};
use super::number::*;
use super::shade;
use gridel_core::format::record::Light;
use gridel_core::{RayKind, Scene};

/// The dimension of the point of a facet.
pub const DIMENSION: u16 = 0x1010;

/// The α from which lights that rays could meet are reflected by the formula.
const WIDE: i32 = 96_636_764;

/// Returns whether lights are reflected by the formula, and not by rays that hit them.
fn is_wide(alpha: i32) -> bool {
    alpha >= WIDE
}

/// The facets of a surface, seen by a ray.
#[derive(Clone, Copy, Debug)]
pub struct Facets<N> {
    /// The normal for shading, on the side from which the ray came.
    normal: Three<N>,
    alpha: N,
    square: N,
    cos_in: N,
    slant_in: N,
}

/// The part of a ray that leaves by a facet.
pub struct Unmasked<N> {
    pub part: N,
    /// True if it cannot be decided whether the ray leads to the right side of the surface as it is shaded.
    pub is_open: bool,
}

/// Limits a ratio to 0 to 1, which only roundings exceed.
fn limited<N: Enclosure>(ratio: N) -> N {
    ratio.at_least(N::zero()).at_most(N::one())
}

impl<N: Enclosure> Facets<N> {
    pub fn new(alpha: i32, normal: Three<N>, cos_in: N) -> Self {
        let alpha = ratio_of::<N>(alpha);
        let mut facets = Self {
            normal,
            alpha,
            square: alpha.square(),
            cos_in: limited(cos_in),
            slant_in: N::one(),
        };
        facets.slant_in = facets.slant(facets.cos_in);
        facets
    }

    fn slant(&self, cos: N) -> N {
        (self.square + (N::one() - self.square) * cos.square()).sqrt()
    }

    /// Returns the normal of a random facet that a ray of length 1 sees; `None` where it is open.
    pub fn draw(&self, direction: Three<N>, [u, v]: [u32; 2]) -> Option<Three<N>> {
        let sides = directions::perpendiculars(self.normal)?;
        let back = sides.map(|side| -dot(side, direction));
        let [x, y, z] = unit([self.alpha * back[0], self.alpha * back[1], self.cos_in])?;
        let part = directions::ratio::<N>(u);
        let sag = part + part * z;
        let across = limited(sag * (N::int(2) - sag)).sqrt();
        let [sine, cosine] = directions::turn::<N>(v);
        // Twice the vector halfway: lengths do not matter.
        let facet = [
            self.alpha * (across * cosine + x),
            self.alpha * (across * sine + y),
            (N::one() - sag + z).at_least(N::zero()),
        ];
        let [x, y, z] = unit(facet)?;
        Some(directions::combined(self.normal, z, sides, [x, y]))
    }

    /// Returns the part with which a ray leaves, because no other facet is in its way.
    pub fn unmasked(
        &self,
        hit: &Hit<N>,
        direction: Three<N>,
        outward: bool,
    ) -> Option<Unmasked<N>> {
        let out = unit(direction)?;
        let is_reflected = outward == hit.front;
        let rise = dot(out, self.normal);
        let cos_out = if is_reflected { rise } else { -rise };
        let is_up = positive(cos_out);
        if is_up == Some(false) {
            return Some(Unmasked {
                part: N::zero(),
                is_open: false,
            });
        }
        let cos_out = limited(cos_out);
        let part = if is_reflected {
            let seen = cos_out * (self.cos_in + self.slant_in);
            seen.div(self.masking(cos_out))?
        } else {
            (cos_out + cos_out).div(cos_out + self.slant(cos_out))?
        };
        let part = limited(part);
        let is_open = is_up.is_none();
        Some(Unmasked {
            part: if is_open { part.hull(N::zero()) } else { part },
            is_open,
        })
    }

    /// cos_out slant_in + cos_in slant_out.
    fn masking(&self, cos_out: N) -> N {
        cos_out * self.slant_in + self.cos_in * self.slant(cos_out)
    }

    /// Returns the part that the facets reflect of a light `cos_out` above the surface, if each of
    /// them reflects all.
    fn reflect(&self, cos_out: N, halfway: Three<N>) -> Option<N> {
        let sine2 = norm2(cross(self.normal, halfway));
        let cos = dot(self.normal, halfway);
        let spread = (sine2 + self.square * cos.square())
            .at_least(self.square)
            .at_most(N::one());
        // By the rule half of it is no less than 2^-31.
        let masking = self.masking(cos_out).at_least(N::scaled(1, 30));
        let distribution = self.square.div(spread)?.div(spread)?;
        Some(distribution * cos_out.half().div(masking)?)
    }
}

/// Returns the kind of a ray that is reflected off facets.
pub fn reflected_kind(scene: &Scene<'_>, alpha: i32) -> RayKind {
    if is_wide(alpha) {
        RayKind::Glossy
    } else if is_sun_limited(scene) {
        RayKind::Polished
    } else {
        RayKind::Reflected
    }
}

fn is_sun_limited(scene: &Scene<'_>) -> bool {
    scene
        .environment()
        .is_some_and(|sky| sky.sun_radiance.contains(&i32::MAX))
}

/// Returns whether a light is reflected by the formula of a surface's facets.
pub fn reflects(scene: &Scene<'_>, alpha: i32, light: &Light) -> bool {
    let is_met = match light.kind {
        Light::ENVIRONMENT => true,
        Light::SUN => !is_wide(alpha) && !is_sun_limited(scene),
        _ => !is_wide(alpha) && scene.is_shown(light),
    };
    !is_met
}

/// Returns the mirrored light of a light by facets.
pub fn mirrored<N: Enclosure>(
    alpha: i32,
    seen: &Seen<'_, N>,
    to_light: Three<N>,
    cos_out: N,
) -> Option<Three<N>> {
    let halfway = unit(minus(to_light, seen.direction))?;
    let cos_in = -dot(seen.direction, seen.normal);
    let facets = Facets::new(alpha, seen.normal, cos_in);
    let ratio = facets.reflect(cos_out.at_most(N::one()), halfway)?;
    let material = seen.material;
    let mut color = material.mirror.map(ratio_of);
    if material.is_glass() {
        let cos = limited(-dot(seen.direction, halfway));
        let split = shade::split(&seen.interface, seen.direction, halfway, cos)?;
        let part = shade::mirrored(material, split.reflected);
        color = color.map(|x: N| (x + part).at_most(N::one()));
    }
    Some(scale(color, ratio))
}
