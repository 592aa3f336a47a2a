//! Depth of field. Rays from the camera start from random points of a thin lens. They meet the rays of the other
//! samples where the picture is sharp.
//!
//! The lens is a disc around the eye, parallel to the picture. A point in front of it at a depth *z* (along the
//! camera's axis) appears as a circle. On the plane of focus, at the depth *f*, its diameter is *d* |z - f| / z. *d* is
//! the lens's own diameter. (Potmesil and Chakravarty, "A Lens and Aperture Camera Model for Synthetic Image
//! Generation", 1981.)

use crate::accel::Number;
use crate::format::Effects;
use crate::format::lens::Lens;
use crate::number::Angle;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::ray::Ray;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::sampler::ratio;

pub(crate) struct DepthOfField;

/// The dimension of the sampler's points.
const LENS: u16 = 0x1000;

impl Effect for DepthOfField {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::DEPTH_OF_FIELD;

    #[inline(always)]
    fn camera<'s, N: Number, X: Tracer<'s, N>>(tracer: &mut X, (): &mut (), ray: &mut Ray<N>) {
        let Some(lens) = tracer.scene().lens() else {
            return;
        };
        let view = tracer.scene().view();
        let axes = [view.forward, view.right, view.up].map(unit::<N>);
        let offset = offset(lens, axes, tracer.point(LENS));
        if X::Observer::ENABLED {
            let axis = |k: usize| N::far_to_f64(N::far(view.eye[k]) + offset[k]);
            let point = [axis(0), axis(1), axis(2)];
            tracer.count().event(Event::Lens { point });
        }
        let eye = view.eye.map(N::far);
        let origin = [0, 1, 2].map(|k: usize| eye[k] + offset[k]);
        let direction = toward_focus(lens, axes[0], ray.slope, offset);
        let zero = N::Wide::default();
        let bounds = tracer.scene().bounds();
        // Loading proves that the lens is no farther away than rays can start.
        if let Ok(refracted) = Ray::new(bounds, origin, direction, zero, N::far(i64::MAX)) {
            *ray = refracted;
        }
    }
}

/// A vector of the camera at length 1.
fn unit<N: Number>(vector: [i32; 3]) -> [N; 3] {
    let slopes = N::slopes(vector.map(|x| N::far(x.into())));
    slopes.map_or([N::ZERO; 3], |(slopes, _)| N::normalize(slopes).0)
}

/// The way from the eye to a random point of the lens.
#[inline(never)]
fn offset<N: Number>(lens: &Lens, [_, right, up]: [[N; 3]; 3], [u, v]: [u32; 2]) -> [N::Wide; 3] {
    let radius = ratio::<N>(u).sqrt();
    let [sine, cosine] = Angle(v).sin_cos().map(N::ratio);
    let (along, across) = (radius * cosine, radius * sine);
    let aperture = N::far(lens.radius);
    let axis = |k: usize| N::wide_scale(aperture, right[k] * along + up[k] * across);
    [axis(0), axis(1), axis(2)]
}

/// Returns the direction from a point of the lens to where the ray from the eye hits the plane of focus, of any length.
fn toward_focus<N: Number>(
    lens: &Lens,
    forward: [N; 3],
    slope: [N; 3],
    offset: [N::Wide; 3],
) -> [N::Wide; 3] {
    // The ray from the eye is there after focus / cosine. Both are multiplied by the cosine, which is above 0.
    let cosine = N::from_wide(N::dot(forward, slope));
    let focus = N::far(lens.focus);
    let axis = |k: usize| N::wide_scale(focus, slope[k]) - N::wide_scale(offset[k], cosine);
    [axis(0), axis(1), axis(2)]
}
