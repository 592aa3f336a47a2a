//! Lights with an area: every sample of a pixel sees one point of each.
//!
//! - **Sphere**: a uniformly distributed direction of the cone in which it is seen. All drawn points face the surface.
//!   (Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", 1996.)
//! - **Rectangle, triangle and disc**: a uniformly distributed point of the area, whose brightness the
//!   [falloff](super::falloff) weighs by distance and angle. Sampling the solid angle of a rectangle (Ureña, Fajardo
//!   and King, 2013) needs arc cosines. `fixed` does not have them, and all formats must draw the same points.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::light_form::LightForm;
use crate::format::record::Light;
use crate::number::{Angle, extent, far_extent};
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::shade::basis::beside;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::light::{Reach, length};
use crate::shade::surface::{Aim, Cone, Lighting, Surface};
use crate::target::inline_on_boards;

pub(crate) struct AreaLight;

impl Effect for AreaLight {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::AREA_LIGHT;

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
            let from = lighting.origin.map(N::length_to_f64);
            let axis = |k: usize| from[k] + way[k] / longest * reach;
            let point = [axis(0), axis(1), axis(2)];
            tracer.count().event(Event::FromArea { point });
        }
    }
}

inline_on_boards!(
    /// Turns the way to a light's position into the way to a random point of it.
    fn at<N: Number>(form: &LightForm, aim: &mut Aim<N>, [u, v]: [u32; 2]) {
        let ratio = |point: u32| N::ratio((point >> 2) as i32);
        let turn = || Angle(v).sin_cos().map(N::ratio);
        let [along, across] = match form.shape {
            LightForm::SPHERE => return on_sphere(form, aim, ratio(u), turn()),
            LightForm::RECTANGLE => [ratio(u), ratio(v)],
            // The half of a parallelogram beyond the third side is folded onto the other half.
            LightForm::TRIANGLE if (u >> 2) + (v >> 2) > 1 << 30 => {
                [N::ONE - ratio(u), N::ONE - ratio(v)]
            }
            LightForm::TRIANGLE => [ratio(u), ratio(v)],
            LightForm::DISC => {
                let (radius, [sine, cosine]) = (ratio(u).sqrt(), turn());
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

/// Turns the way to the middle of a sphere into the way to where a random direction hits it; no way from inside the
/// sphere.
fn on_sphere<N: Number>(form: &LightForm, aim: &mut Aim<N>, u: N, [sine, cosine]: [N; 2]) {
    let reach = Reach::<N>::of(aim.way, aim.distance);
    aim.way = [N::Wide::default(); 3];
    let Some(Reach { unit, distance }) = reach else {
        return;
    };
    let radius = distance.half_length(form.edges[0][0]);
    let widest = radius.div(distance.half);
    if widest <= N::ZERO || widest >= N::ONE {
        return;
    }
    let square = widest * widest;
    let one = N::ONE.half();
    // 1 - cos of the cone's angle, and of the direction's.
    let widening = one.div(one + (N::ONE - square).sqrt().half());
    let cap = square * widening;
    let sag = cap * u;
    let away = (sag + (sag - sag * sag)).sqrt().min(widest);
    let toward = N::ONE - sag;
    let [first, second] = beside(unit);
    let (right, up) = (away * cosine, away * sine);
    let axis = |k: usize| unit[k] * toward + first[k] * right + second[k] * up;
    let direction = [axis(0), axis(1), axis(2)];
    // In halves, from the middle of the chord to the surface.
    let part = away.div(widest).min(N::ONE);
    let inward = radius * (N::ONE - part * part).sqrt();
    let end = distance.whole((distance.half * toward - inward) * extent(direction));
    *aim = Aim {
        way: direction.map(N::widen),
        distance: Some(end + end),
        cone: Some(Cone { distance, widening }),
    };
}
