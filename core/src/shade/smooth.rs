//! Smooth normals: meshes are shaded by the normals of their vertices.
//!
//! The triangle determines the side that a ray hits, where rays start and what is inside. So a ray that leaves must not
//! go to the wrong side of it:
//!
//! - **Lights** that the smooth normal faces and the triangle does not: the shadow ray starts from the curved surface
//!   (see [`geometry::smooth`](crate::geometry::smooth)). Where that surface lies beneath the triangle, the light does
//!   not reach it.
//! - **Mirrored and refracted rays** to the wrong side are turned into the triangle's plane. Local shading normals are
//!   adapted in this way in "The Iray Light Transport Simulation and Rendering System", 2017. Its authors are Keller,
//!   Wächter, Raab, Seibert, van Antwerpen, Korndörfer and Kettner.

use crate::accel::Number;
use crate::format::Effects;
use crate::geometry::smooth::moved;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::query::Hit;
use crate::ray::Ray;
use crate::shade::departure::Origin;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::{Lighting, Secondary, Surface};

pub(crate) struct Smooth;

/// The effects of a material that send rays by the shading normal.
pub(super) const SENDING: u32 = Effects::MIRROR.0 | Effects::GLASS.0;

impl Effect for Smooth {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::SMOOTH;

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
        let smooth = surface
            .hit
            .smooth_normal(tracer.scene(), surface.shading_normal);
        let Some(mut normal) = smooth else {
            return;
        };
        if X::SENDS && surface.required.0 & SENDING != 0 {
            normal = turned_to_ray(normal, surface.direction);
        }
        surface.shading_normal = normal;
        if X::Observer::ENABLED {
            tracer.count().event(Event::Smooth {
                normal: normal.map(N::ratio_to_f64),
            });
        }
    }

    #[inline(always)]
    fn face<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        lighting: &mut Lighting<'_, N>,
        is_reached: &mut bool,
    ) {
        // Without shadows nothing is in the way.
        let both = Self::EFFECT.with(Effects::SHADOW);
        if !tracer.scene().effects().contains(both) {
            return;
        }
        if is_behind(surface.hit, lighting.to_light) {
            *is_reached = lift(tracer, surface, lighting);
            if X::Observer::ENABLED && !*is_reached {
                tracer.count().event(Event::BehindTriangle);
            }
        }
    }

    #[inline(always)]
    fn leave<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        hit: &Hit<N>,
        secondary: &mut Secondary<N>,
    ) {
        if !tracer.scene().effects().contains(Self::EFFECT) {
            return;
        }
        keep_on_its_side(hit, secondary);
    }
}

/// Returns true if a light is on the other side of a surface than the origin of the ray that hit it.
#[inline(always)]
pub(super) fn is_behind<N: Number>(hit: &Hit<N>, to_light: [N; 3]) -> bool {
    let cos = N::dot(hit.normal, to_light);
    let zero = N::Wide::default();
    if hit.front { cos <= zero } else { cos >= zero }
}

/// Turns a ray to the wrong side of a surface into its plane.
#[inline(always)]
pub(super) fn keep_on_its_side<N: Number>(hit: &Hit<N>, secondary: &mut Secondary<N>) {
    let normal = if secondary.outward {
        hit.normal
    } else {
        hit.normal.map(|x| -x)
    };
    let rise = N::from_wide(N::dot(secondary.direction, normal));
    if rise <= N::ZERO {
        // In the plane, and up by more than rounding: 1/4096 of the direction's length.
        let up = N::ratio(1 << 18) - rise;
        let direction = secondary.direction;
        let axis = |k: usize| direction[k] + up * normal[k];
        secondary.direction = [axis(0), axis(1), axis(2)];
    }
}

/// Returns the normal, turned until it is level with a ray of length 1 that hits it from behind.
#[inline(always)]
pub(super) fn turned_to_ray<N: Number>(normal: [N; 3], direction: [N; 3]) -> [N; 3] {
    let along = N::from_wide(N::dot(normal, direction));
    if along < N::ZERO {
        return normal;
    }
    let axis = |k: usize| normal[k] - along * direction[k];
    let (level, length) = N::normalize([axis(0), axis(1), axis(2)]);
    if length > N::ZERO { level } else { normal }
}

/// Moves the start of the way to a light to the curved surface. Returns true if that lies above the triangle, farther
/// than the error bound.
#[cold]
#[inline(never)]
fn lift<'s, N: Number, X: Tracer<'s, N>>(
    tracer: &mut X,
    surface: &Surface<'_, N>,
    lighting: &mut Lighting<'_, N>,
) -> bool {
    let hit = surface.hit;
    let facing = hit.facing_normal();
    let Some(way) = hit.lift(tracer.scene(), facing) else {
        return false;
    };
    if N::from_wide(N::dot(way, facing)) <= hit.error {
        return false;
    }
    lighting.origin = Origin::of(moved(lighting.origin.point, way));
    // Only a point light has another direction from there: of the others one was drawn, or they are far away.
    if lighting.light.is_point() {
        (lighting.way, lighting.distance) = lighting.light.seen_from(&lighting.origin);
        // The distance by which a light falls off is that from there, too.
        if const { Effects::AVAILABLE.contains(Effects::FALLOFF) }
            && lighting.light.form().is_some()
        {
            let Some((slopes, _)) = N::slopes(lighting.way) else {
                return false;
            };
            lighting.norm = N::normalize(slopes).1;
        }
    }
    true
}
