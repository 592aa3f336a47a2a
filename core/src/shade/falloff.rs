//! Light that falls off with the square of the distance, spots, and the brightness of areas.
//!
//! A light's form states the distance at which the light has its color. So one radiance of 20 fraction bits serves for
//! every distance: `fixed` holds arriving light up to 2048 times display white, and beyond that saturates.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::light_form::LightForm;
use crate::format::record::Light;
use crate::number::Format;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::light::Distance;
use crate::shade::surface::{Lighting, Surface};
use crate::target::inline_on_boards;

pub(crate) struct Falloff;

impl Effect for Falloff {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::FALLOFF;

    fn is_required_by_light(light: &Light) -> bool {
        light.form().is_some()
    }

    #[inline(always)]
    fn face<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Surface<'_, N>,
        lighting: &mut Lighting<'_, N>,
        is_reached: &mut bool,
    ) {
        if let Some(form) = tracer.scene().light_form(lighting.light) {
            let is_shone_on = shines(form, lighting) && is_in_range(form, lighting);
            if X::Observer::ENABLED && !is_shone_on {
                tracer.count().event(Event::Outside);
            }
            *is_reached = *is_reached && is_shone_on;
        }
    }

    #[inline(always)]
    fn light<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Surface<'_, N>,
        lighting: &Lighting<'_, N>,
        arriving: &mut Color<N>,
    ) {
        if let Some(form) = tracer.scene().light_form(lighting.light) {
            *arriving = falling(form, lighting, *arriving);
            if X::Observer::ENABLED {
                tracer.count().event(Event::Fallen {
                    arriving: arriving.to_f64(),
                });
            }
        }
    }
}

/// The cosine between the light's direction and the way to a surface, given the way back.
fn cosine<N: Number>(form: &LightForm, to_light: [N; 3]) -> N {
    let cos = -N::from_wide(N::dot(form.normal.map(N::ratio), to_light));
    // Nothing proves the length of the normal.
    cos.max(-N::ONE).min(N::ONE)
}

/// Returns true if a light shines towards a surface. Keeps the cosine for the light that arrives.
fn shines<N: Number>(form: &LightForm, lighting: &mut Lighting<'_, N>) -> bool {
    let least = match form.shape {
        LightForm::SPHERE => return true,
        LightForm::RECTANGLE | LightForm::DISC | LightForm::TRIANGLE => N::ZERO,
        _ if has_cone(form) => N::ratio(form.cone_cosine),
        _ => return true,
    };
    lighting.facing = cosine(form, lighting.to_light);
    lighting.facing > least
}

/// Returns true if a light's range reaches a surface.
#[inline(always)]
fn is_in_range<N: Number>(form: &LightForm, lighting: &Lighting<'_, N>) -> bool {
    form.range == 0
        || lighting.light_distance().is_some_and(|distance| {
            let [distance, range] = distance_and_range(form, distance);
            distance < range
        })
}

/// The distance of a light and its range, both over the same number.
#[inline(always)]
fn distance_and_range<N: Number>(form: &LightForm, distance: Distance<N>) -> [N; 2] {
    let range = distance.half_length(form.range.wrapping_abs());
    let is_far = form.range < 0;
    let bits = if is_far { LightForm::FAR_RANGE_BITS } else { 0 };
    [(0..bits).fold(distance.half, |half, _| half.half()), range]
}

fn has_cone(form: &LightForm) -> bool {
    form.cone_cosine > -(1 << 30)
}

inline_on_boards!(
    /// Returns the arriving part of a light's color.
    fn falling<N: Number>(
        form: &LightForm,
        lighting: &Lighting<'_, N>,
        color: Color<N>,
    ) -> Color<N> {
        let apparent = lighting.apparent_distance;
        let Some(distance) = apparent.or_else(|| lighting.light_distance()) else {
            return Color::BLACK;
        };
        let mut arriving = if form.reference == 0 {
            color
        } else {
            fallen(color, distance.half_length(form.reference), distance.half)
        };
        if form.range != 0
            && let Some(distance) = lighting.light_distance()
        {
            // KHR_lights_punctual: 1 minus the fourth power of the distance over the range.
            let [distance, range] = distance_and_range(form, distance);
            let part = distance.div(range);
            if part >= N::ONE {
                return Color::BLACK;
            }
            let square = part * part;
            arriving = arriving.scaled(N::ONE - square * square);
        }
        match form.shape {
            _ if apparent.is_some() => arriving,
            LightForm::RECTANGLE | LightForm::DISC | LightForm::TRIANGLE => {
                arriving.scaled(lighting.facing)
            }
            _ if has_cone(form) => {
                let within = lighting.facing - N::ratio(form.cone_cosine);
                let width = N::ratio(form.width);
                if within >= width {
                    return arriving;
                }
                let part = within.div(width);
                arriving.scaled(part).scaled(part)
            }
            _ => arriving,
        }
    }
);

/// Maximum number of times that a distance is doubled until it is no shorter than another.
const DOUBLINGS: u32 = 32;

/// Returns a color that is given at a reference distance, at another distance; both are given by their halves.
fn fallen<N: Number>(color: Color<N>, reference: N, distance: N) -> Color<N> {
    if reference <= N::ZERO || distance <= N::ZERO {
        return Color::BLACK;
    }
    if N::FORMAT != Format::Fixed {
        let most = N::FAR * N::FAR;
        let ratio = reference.div(distance).min(most);
        return color.scaled(ratio).scaled(ratio);
    }
    // `fixed` holds no ratio above 2.
    let (mut far, mut doublings) = (distance, 0);
    while far < reference && doublings < DOUBLINGS {
        far = far + far;
        doublings += 1;
    }
    let ratio = reference.div(far).min(N::ONE);
    let mut fallen = color.scaled(ratio).scaled(ratio);
    for _ in 0..doublings {
        let twice = fallen.plus(fallen);
        fallen = twice.plus(twice);
    }
    fallen
}
