//! The mock effects.

use crate::accel::Number;
use crate::format::Effects;
use crate::observe::event::RayKind;
use crate::ray::{Pencil, Ray};
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::{Arrival, Bounce, Filter, Gleam, Lighting, Secondary, Surface};

/// Moves the eye past the scene.
pub(crate) struct Shift;

impl Effect for Shift {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);

    fn camera<'s, N: Number, X: Tracer<'s, N>>(tracer: &mut X, (): &mut (), ray: &mut Ray<N>) {
        let scene = tracer.scene();
        let [x, y, z] = scene.view.eye;
        // In 2^-13 units.
        let eye = [x + (300 << 13), y, z].map(N::far);
        let direction = ray.slope().map(N::widen);
        if let Ok(shifted) = Pencil::of(scene.bounds(), eye).ray(direction) {
            *ray = shifted;
        }
    }
}

/// Halves the light on the way to a hit.
pub(crate) struct Fog;

impl Effect for Fog {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);

    fn arrive<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Ray<N>,
        arrival: &mut Arrival<'s, '_, N>,
    ) {
        arrival.weight = arrival.weight.scaled(N::ONE.half());
    }
}

/// Paints all surfaces green.
pub(crate) struct Tint;

impl Effect for Tint {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);

    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        surface.diffuse = Color([N::ZERO, N::ONE.half(), N::ZERO]);
    }
}

/// Surfaces reflect no light.
pub(crate) struct Matt;

impl Effect for Matt {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);

    fn reflect<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Surface<'_, N>,
        _: &Lighting<'_, N>,
        reflected: &mut Color<N>,
        _: &mut Option<Gleam<N>>,
    ) {
        *reflected = Color::BLACK;
    }
}

/// Lights shine with half of their radiance.
pub(crate) struct Falloff;

impl Effect for Falloff {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);

    fn light<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Surface<'_, N>,
        _: &Lighting<'_, N>,
        arriving: &mut Color<N>,
    ) {
        *arriving = arriving.scaled(N::ONE.half());
    }
}

/// All surfaces transmit light.
pub(crate) struct Veil;

impl Effect for Veil {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);
    const FILTERS: bool = true;

    fn filter<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Ray<N>,
        filter: &mut Filter<'s, '_, N>,
    ) {
        filter.passes = true;
    }
}

/// Rays that hit nothing see blue.
pub(crate) struct Sky;

impl Effect for Sky {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);

    fn miss<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Ray<N>,
        radiance: &mut Color<N>,
    ) {
        *radiance = Color::radiance([0, 0, 1 << 20]);
    }
}

/// Every surface sends a ray straight on.
pub(crate) struct Pane;

impl Effect for Pane {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);
    const CASTS: bool = true;
    const NEEDS_DIRECTION: bool = true;

    fn bounce<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        _: &mut Bounce<N>,
    ) {
        let secondary = Secondary {
            kind: RayKind::Refracted,
            direction: surface.direction,
            outward: !surface.hit.front,
            weight: surface.weight,
        };
        tracer.send(surface.hit, secondary);
    }
}

/// Pictures have a quarter of their light.
pub(crate) struct ToneMap;

impl Effect for ToneMap {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);

    fn pixel<'s, N: Number, X: Tracer<'s, N>>(_: &mut X, (): &mut (), radiance: &mut Color<N>) {
        *radiance = radiance.scaled(N::ONE.half().half());
    }
}

/// Counts the surfaces on the way of a ray; a ray that misses brings as many parts of white.
pub(crate) struct Trail;

impl Trail {
    /// Parts of white.
    pub(crate) const PARTS: i32 = 16;
}

impl Effect for Trail {
    type State<N: Number> = i32;

    const EFFECT: Effects = Effects(Self::BITS);

    fn camera<'s, N: Number, X: Tracer<'s, N>>(_: &mut X, surfaces: &mut i32, _: &mut Ray<N>) {
        *surfaces = 1;
    }

    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        surfaces: &mut i32,
        _: &Ray<N>,
        _: &mut Surface<'_, N>,
    ) {
        *surfaces += 1;
    }

    fn miss<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        surfaces: &mut i32,
        _: &Ray<N>,
        radiance: &mut Color<N>,
    ) {
        *radiance = Color::radiance([*surfaces * (1 << 20) / Self::PARTS; 3]);
    }
}

/// Paints surfaces green where x is above 0, and black elsewhere, and removes the normal for shading.
pub(crate) struct Print;

impl Effect for Print {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects(Self::BITS);

    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        _: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        let [x, ..] = surface.hit.point;
        let green = if x > N::ZERO { N::ONE } else { N::ZERO };
        surface.diffuse = Color([N::ZERO, green, N::ZERO]);
        surface.shading_normal = [N::ZERO; 3];
    }
}
