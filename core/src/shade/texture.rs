//! Textures: the diffuse color of a mesh is weighted by that of an image.
//!
//! The image is looked up at the interpolated texture coordinates of the triangle's vertices: see
//! [`attributes`](crate::geometry::attributes). Cost: one texel or four, in addition to the
//! interpolation.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::geometry::attributes::COORDINATE_BITS;
use crate::number::log2::LOG2_BITS;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::ray::Ray;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::Surface;

pub(crate) struct Texture;

impl Effect for Texture {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::TEXTURE;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        material.maps & Material::MAPS_TEXTURE != 0
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
        let scene = tracer.scene();
        let Some(textures) = scene.textures.get() else {
            return;
        };
        let maps = textures.maps_of(surface.material);
        let texture = maps.and_then(|maps| textures.texture(maps.color));
        let (Some(texture), Some(coordinates)) = (texture, surface.hit.coordinates(scene)) else {
            return;
        };
        let texel = textures.lookup(texture, coordinates, surface.footprint);
        let color = Color::ratios(texel.color);
        surface.diffuse = surface.diffuse.times(color);
        if X::Observer::ENABLED {
            tracer.count().event(Event::Textured {
                coordinates: coordinates.map(|it| f64::from(it) / f64::from(1 << COORDINATE_BITS)),
                level: f64::from(surface.footprint.level(texture)) / f64::from(1 << LOG2_BITS),
                texel: texel.place,
                color: color.ratios_to_f64(),
            });
        }
    }
}
