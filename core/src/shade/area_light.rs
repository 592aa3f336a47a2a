//! Lights with an area: every sample of a pixel sees one point of each.
//!
//! - **Sphere**, and what is **flat and near**: a point by [solid angle](super::solid_angle).
//! - **Flat and farther away**: a uniformly distributed point of the area, whose brightness the
//!   [falloff](super::falloff) weighs by distance and angle. From there all points look nearly alike.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::light_form::LightForm;
use crate::format::record::Light;
use crate::number::{Angle, far_extent, taxicab};
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::light::length;
use crate::shade::sampler::ratio;
use crate::shade::solid_angle;
use crate::shade::surface::{Aim, Lighting, Surface};
use crate::target::inline_on_boards;

pub(crate) struct AreaLight;

impl Effect for AreaLight {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::AREA_LIGHT;

    /// Single points of a light bring up to 2.5 times their mean, and more than white where a bright light is half
    /// hidden.
    const VARIES: bool = true;

    fn is_required_by_light(light: &Light) -> bool {
        light.is_area()
    }

    #[inline(always)]
    fn aim<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        number: u32,
        light: &Light,
        aim: &mut Aim<N>,
    ) {
        if !light.is_area() {
            return;
        }
        if let Some(form) = tracer.scene().light_form(light) {
            // Lights beyond the first 4,096 share points with these.
            let point = tracer.point(number as u16 & 0xfff);
            at(form, aim, point);
        }
    }

    #[inline(always)]
    fn face<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Surface<'_, N>,
        lighting: &mut Lighting<'_, N>,
        _: &mut bool,
    ) {
        if X::Observer::ENABLED && lighting.light.is_area() {
            let way = lighting.way.map(N::far_to_f64);
            let longest = way
                .iter()
                .fold(0.0, |longest: f64, it| longest.max(it.abs()));
            let reach = lighting.distance.map_or(0.0, N::far_to_f64);
            let from = lighting.origin.place().map(N::far_to_f64);
            let axis = |k: usize| from[k] + way[k] / longest * reach;
            let point = [axis(0), axis(1), axis(2)];
            tracer.count().event(Event::FromArea { point });
        }
    }
}

inline_on_boards!(
    /// Turns the way to a light's position into the way to a random point of it.
    fn at<N: Number>(form: &LightForm, aim: &mut Aim<N>, [u, v]: [u32; 2]) {
        let turn = || Angle(v).sin_cos().map(N::ratio);
        if form.shape == LightForm::SPHERE {
            return solid_angle::of_sphere(form, aim, ratio(u), turn());
        }
        if taxicab::<N>(aim.way) < N::far(form.width.into())
            && let Some(near) = solid_angle::of_flat(form, aim.way, [ratio(u), ratio(v)])
        {
            *aim = near;
            return;
        }
        let [along, across] = match form.shape {
            LightForm::RECTANGLE => [ratio(u), ratio(v)],
            // The half of a parallelogram beyond the third side is folded onto the other half.
            LightForm::TRIANGLE if (u >> 2) + (v >> 2) > 1 << 30 => {
                [N::ONE - ratio(u), N::ONE - ratio(v)]
            }
            LightForm::TRIANGLE => [ratio(u), ratio(v)],
            LightForm::DISC => {
                let (radius, [sine, cosine]) = (ratio::<N>(u).sqrt(), turn());
                [radius * cosine, radius * sine]
            }
            _ => return,
        };
        let [first, second] = form.edges;
        let axis = |k: usize| {
            let offset = length::<N>(first[k]) * along + length::<N>(second[k]) * across;
            aim.way[k] + offset.widen()
        };
        aim.way = [axis(0), axis(1), axis(2)];
        aim.distance = Some(far_extent::<N>(aim.way));
    }
);
