//! Vertex colors: the diffuse color of a mesh is weighted by the colors of its vertices.

use crate::accel::Number;
use crate::format::Effects;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::ray::Ray;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::Surface;

pub(crate) struct VertexColors;

impl Effect for VertexColors {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::VERTEX_COLORS;

    #[inline(always)]
    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        // No material states it, unlike for other effects: a mesh does.
        if !tracer.scene().effects().contains(Self::EFFECT) {
            return;
        }
        let Some(color) = surface.hit.vertex_color(tracer.scene()) else {
            return;
        };
        let color = Color::ratios(color);
        surface.diffuse = surface.diffuse.times(color);
        if X::Observer::ENABLED {
            tracer.count().event(Event::VertexColor {
                color: color.ratios_to_f64(),
            });
        }
    }
}
