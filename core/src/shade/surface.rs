//! The surface that a ray hits, as effects use it.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::{Light, Material};
use crate::observe::event::RayKind;
use crate::query::Hit;
use crate::scene::textures::Footprint;
use crate::shade::Color;
use crate::shade::departure::{Far, Origin};
use crate::shade::facets::Facets;
use crate::shade::light::Distance;

/// A surface that a ray has hit.
pub(crate) struct Surface<'h, N: Number> {
    pub(crate) hit: &'h Hit<N>,
    pub(crate) far: Far<'h, N>,
    pub(crate) material: &'h Material,
    /// The effects that the material requires, looked up once per hit.
    pub(crate) required: Effects,
    /// The normal for lights and secondary rays, on the side that the ray came from: the geometric normal of `hit`,
    /// unless an effect changes it.
    pub(crate) shading_normal: [N; 3],
    /// The ray's direction, with length 1 if an effect in use needs that.
    pub(crate) direction: [N; 3],
    pub(crate) diffuse: Color<N>,
    /// The ratio of the light from here that arrives at the eye.
    pub(crate) weight: Color<N>,
    /// The ratio of the light from behind that passes the surface straight on.
    pub(crate) passing: Color<N>,
    /// The media that meet there; `None` for the material and the surroundings.
    pub(crate) interface: Option<Interface<N>>,
    /// The area of texture coordinates that the sample covers; a point, unless an effect computes it.
    pub(crate) footprint: Footprint,
}

/// A ray that reached a hit.
pub(crate) struct Arrival<'s, 'h, N: Number> {
    pub(crate) hit: &'h Hit<N>,
    pub(crate) material: &'s Material,
    /// The material that the ray passed, if an effect knows it.
    pub(crate) medium: Option<&'s Material>,
    /// The ratio of the light from there that arrives at the eye.
    pub(crate) weight: Color<N>,
}

/// Two media that meet at a surface.
#[derive(Clone, Copy)]
pub(crate) struct Interface<N> {
    /// The lower index of refraction over the higher one, 0.25 to 1.
    pub(crate) k: N,
    /// True if the ray goes to the one with the higher index.
    pub(crate) to_denser: bool,
}

impl<N: Number> Surface<'_, N> {
    /// The media that meet there.
    #[inline(always)]
    pub(crate) fn interface(&self) -> Interface<N> {
        let of_material = || Interface::of(self.hit, self.material);
        self.interface.unwrap_or_else(of_material)
    }
}

impl<N: Number> Interface<N> {
    /// Returns the interface between the surroundings and glass.
    #[inline(always)]
    pub(crate) fn of(hit: &Hit<N>, material: &Material) -> Self {
        Self {
            k: N::ratio(material.inverse_ior),
            to_denser: hit.front,
        }
    }
}

/// A light, seen from a surface.
pub(crate) struct Lighting<'l, N: Number> {
    pub(crate) light: &'l Light,
    /// The start of the way to the light.
    pub(crate) origin: Origin<'l, N>,
    /// The way to the light, of any length.
    pub(crate) way: [N::Wide; 3],
    /// The distance of the light along the largest component of `way`; `None` for infinitely far.
    pub(crate) distance: Option<N::Wide>,
    /// The direction of the light, with length 1.
    pub(crate) to_light: [N; 3],
    /// The length of `way`, of whose largest component this is a multiple: 1 to the square root of 3.
    pub(crate) norm: N,
    /// The distance at which the light is as bright as what its point brings; `None` unless that was drawn by solid
    /// angle.
    pub(crate) apparent_distance: Option<Distance<N>>,
    /// The cosine between the light's own direction and the way from it, if the light has a direction.
    pub(crate) facing: N,
}

impl<N: Number> Lighting<'_, N> {
    /// Returns the distance of the light; `None` for infinitely far.
    #[inline(always)]
    pub(crate) fn light_distance(&self) -> Option<Distance<N>> {
        Some(Distance::of(self.distance?, self.norm))
    }
}

/// The part of a light that facets mirror to the ray's origin. It can be far above 1.
#[derive(Clone, Copy)]
pub(crate) struct Gleam<N> {
    /// The part over 2 to the power.
    pub(crate) ratio: Color<N>,
    pub(crate) power: u32,
}

impl<N: Number> Gleam<N> {
    /// The mirrored light; in `fixed` the range of radiance limits it.
    #[inline(always)]
    pub(crate) fn of(self, mut arriving: Color<N>) -> Color<N> {
        let mut power = self.power;
        // Doubled first as often as the range allows, so that dim light keeps its digits.
        while power > 0 && arriving.peak() < N::radiance(1 << 30) {
            arriving = arriving.plus(arriving);
            power = power.wrapping_sub(1);
        }
        let mut mirrored = arriving.times(self.ratio);
        for _ in 0..power {
            mirrored = mirrored.plus(mirrored);
        }
        mirrored
    }
}

/// The way from a surface to a light.
#[derive(Clone, Copy)]
pub(crate) struct Aim<N: Number> {
    /// The way, of any length.
    pub(crate) way: [N::Wide; 3],
    /// The distance of the light along the largest component of `way`; `None` for infinitely far.
    pub(crate) distance: Option<N::Wide>,
    /// The distance at which the light is as bright as what its point brings; `None` unless that was drawn by solid
    /// angle.
    pub(crate) apparent_distance: Option<Distance<N>>,
}

/// A surface between a light and another surface.
pub(crate) struct Filter<'s, 'h, N: Number> {
    pub(crate) hit: &'h Hit<N>,
    pub(crate) material: &'s Material,
    /// The direction of the light, with length 1.
    pub(crate) to_light: [N; 3],
    /// The ratio of the light that remains.
    pub(crate) left: Color<N>,
    /// The material that the light passed, if an effect knows it.
    pub(crate) medium: Option<&'s Material>,
    /// The media that meet there; `None` for the material and the surroundings.
    pub(crate) interface: Option<Interface<N>>,
    /// True if any light passes: no surface transmits light unless an effect says so.
    pub(crate) passes: bool,
}

/// The last part of the way of light to another surface, on which nothing is in its way.
pub(crate) struct Reach<'s, N: Number> {
    /// The distance of the light along the largest component of the way.
    pub(crate) distance: N::Wide,
    /// The length of the way, of whose largest component this is a multiple.
    pub(crate) norm: N,
    /// The material that fills the place, if an effect knows it.
    pub(crate) medium: Option<&'s Material>,
    /// The ratio of the light that remains.
    pub(crate) left: Color<N>,
}

/// A surface that can send secondary rays.
pub(crate) struct Bounce<N: Number> {
    /// The normal at which the ray is mirrored and refracted: that for shading, unless an effect draws a facet.
    pub(crate) normal: [N; 3],
    /// The cosine between that normal and the way back to the ray's origin.
    pub(crate) cos_in: N,
    /// The ratio that is mirrored, `None` if no effect mirrors. All effects share one mirrored ray.
    pub(crate) mirrored: Option<Color<N>>,
    /// The facets to which the normal belongs; `None` for a smooth surface.
    pub(crate) facets: Option<Facets<N>>,
}

impl<N: Number> Bounce<N> {
    /// Adds to the ratio that is mirrored.
    #[inline(always)]
    pub(crate) fn mirror(&mut self, ratio: Color<N>) {
        self.mirrored = Some(match self.mirrored {
            Some(mirrored) => mirrored.plus_up_to_one(ratio),
            None => ratio,
        });
    }

    /// The weight of a ray that leaves, without the part that facets absorb.
    #[inline(always)]
    pub(crate) fn leaving(&self, hit: &Hit<N>, secondary: Secondary<N>) -> Secondary<N> {
        match &self.facets {
            None => secondary,
            Some(facets) => {
                let left = facets.unmasked(hit, secondary.direction, secondary.outward);
                Secondary {
                    weight: secondary.weight.scaled(left),
                    ..secondary
                }
            }
        }
    }
}

/// A ray that a hit causes.
pub(crate) struct Secondary<N: Number> {
    pub(crate) kind: RayKind,
    /// The direction, of any length.
    pub(crate) direction: [N; 3],
    /// True if it leaves on the side of the geometric normal.
    pub(crate) outward: bool,
    pub(crate) weight: Color<N>,
}
