//! Alpha: rays and light go straight through the transparent parts of a texture.
//!
//! A hit brings the light of its surface, weighted by alpha, and sends one more ray straight on with the rest. That ray
//! counts as a bounce. Glass ignores alpha, because it transmits light by itself. Cost: one texel or four, in addition
//! to the ray.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::query::Hit;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::scene::textures::{Footprint, ratio};
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::{Filter, Surface};

pub(crate) struct Alpha;

impl Effect for Alpha {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::ALPHA;
    const FILTERS: bool = true;
    const PASSES: bool = true;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        material.maps & Material::MAPS_ALPHA != 0 && !material.is_glass()
    }

    #[inline(always)]
    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        if !surface.required.contains(Self::EFFECT) {
            return;
        }
        let alpha = alpha(
            tracer.scene(),
            surface.material,
            surface.hit,
            surface.footprint,
        );
        surface.passing = surface.weight.scaled(N::ONE - alpha);
        surface.weight = surface.weight.scaled(alpha);
        if X::Observer::ENABLED {
            tracer.count().event(Event::Alpha {
                alpha: alpha.ratio_to_f64(),
            });
        }
    }

    #[inline(always)]
    fn filter<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Ray<N>,
        filter: &mut Filter<'s, '_, N>,
    ) {
        if !Self::is_required_by_material(filter.material) {
            return;
        }
        let alpha = alpha(
            tracer.scene(),
            filter.material,
            filter.hit,
            Footprint::point(),
        );
        if alpha < N::ONE {
            filter.passes = true;
            filter.left = filter.left.scaled(N::ONE - alpha);
        }
    }
}

/// The opaque part of a surface: 1 where it has no texture coordinates.
#[inline(always)]
fn alpha<N: Number>(
    scene: &Scene<'_>,
    material: &Material,
    hit: &Hit<N>,
    footprint: Footprint,
) -> N {
    let found = || {
        let textures = scene.textures.get()?;
        let maps = textures.maps_of(material)?;
        let texture = textures.texture(maps.color)?;
        let coordinates = hit.coordinates(scene)?;
        Some((maps, textures.alpha(texture, coordinates, footprint)))
    };
    let Some((maps, alpha)) = found() else {
        return N::ONE;
    };
    if maps.cutoff == 0 {
        return N::ratio(alpha) * N::ratio(ratio(u32::from(maps.opacity) << 16));
    }
    // In integers, so that all number formats make the same decision.
    if alpha >= ratio(u32::from(maps.cutoff) << 16) {
        N::ONE
    } else {
        N::ZERO
    }
}
