//! Glass that absorbs light along the way: Beer's law.
//!
//! A ray knows the glass without a priority that it is inside of, so that objects in the glass are seen and lit through
//! it. If such glasses are nested, it knows only the inner one. A waiting ray needs two more bytes for it.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::query::Hit;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::material::is_any;
use crate::shade::surface::{Arrival, Filter, Reach, Secondary};
use crate::target::AbsorptionOnly;

pub(crate) struct Absorption;

impl Effect for Absorption {
    type State<N: Number> = Within;

    const EFFECT: Effects = Effects::ABSORPTION;
    const FILTERS: bool = true;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        material.is_glass() && is_any(bytemuck::cast_ref(&material.absorption))
    }

    #[inline(always)]
    fn arrive<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        within: &mut Within,
        ray: &Ray<N>,
        arrival: &mut Arrival<'s, '_, N>,
    ) {
        let Arrival { hit, material, .. } = *arrival;
        let own = within.passed(tracer.scene(), hit, material);
        if let Some(medium) = arrival.medium.or(own) {
            arrival.weight = arrival.weight.times(left(ray, hit, medium));
            if X::Observer::ENABLED {
                tracer.count().event(Event::Absorbed {
                    weight: arrival.weight.ratios_to_f64(),
                });
            }
        }
    }

    #[inline(always)]
    fn filter<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        within: &mut Within,
        ray: &Ray<N>,
        filter: &mut Filter<'s, '_, N>,
    ) {
        // It is not yet known whether any light passes: alpha decides after this.
        let (scene, hit) = (tracer.scene(), filter.hit);
        let own = within.passed(scene, hit, filter.material);
        if let Some(medium) = filter.medium.or(own) {
            filter.left = filter.left.times(left(ray, hit, medium));
        }
        *within = within.beyond(scene, hit.object, hit.front);
    }

    #[inline(always)]
    fn reach<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        within: &mut Within,
        reach: &mut Reach<'s, N>,
    ) {
        let medium = reach.medium.or_else(|| within.medium(tracer.scene()));
        if let Some(medium) = medium {
            let length = N::from_wide(N::narrow(reach.distance).wide(reach.norm));
            reach.left = reach.left.times(absorb(medium, length));
            if X::Observer::ENABLED {
                tracer.count().event(Event::Absorbed {
                    weight: reach.left.ratios_to_f64(),
                });
            }
        }
    }

    #[inline(always)]
    fn leave<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        within: &mut Within,
        hit: &Hit<N>,
        secondary: &mut Secondary<N>,
    ) {
        if secondary.outward != hit.front {
            *within = within.beyond(tracer.scene(), hit.object, hit.front);
        }
    }
}

/// The glass without a priority that a ray is inside of: the number of its material plus 1, or 0, also for one of the
/// materials behind the first 65,535. Bytes, so that they fill gaps next to other states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Within(AbsorptionOnly<[u8; 2]>);

impl Default for Within {
    #[inline(always)]
    fn default() -> Self {
        Self::of(0)
    }
}

impl Within {
    #[inline(always)]
    fn of(number: u16) -> Self {
        Self(AbsorptionOnly::of(number.to_le_bytes()))
    }

    /// The glass that fills the place.
    #[inline(always)]
    fn medium<'s>(self, scene: &'s Scene<'s>) -> Option<&'s Material> {
        let number = u16::from_le_bytes(*self.0.get()?).checked_sub(1)?;
        scene.materials().get(usize::from(number))
    }

    /// The glass that a ray passed on its way to a hit. A ray that hits a back face began inside, if nothing else is
    /// known.
    #[inline(always)]
    fn passed<'s, N: Number>(
        self,
        scene: &'s Scene<'s>,
        hit: &Hit<N>,
        material: &'s Material,
    ) -> Option<&'s Material> {
        if material.is_glass() && !hit.front {
            Some(material)
        } else {
            self.medium(scene)
        }
    }

    /// The glass behind a face that a ray crosses.
    #[inline(never)]
    fn beyond(self, scene: &Scene<'_>, object: u32, enters: bool) -> Self {
        let is_glass = scene.material(object).is_some_and(Material::is_glass);
        if !is_glass || scene.place_among_media(object).is_some() {
            return self;
        }
        let number = scene.material_number(object).wrapping_add(1);
        let own = Self::of(u16::try_from(number).unwrap_or(0));
        match enters {
            true => own,
            false if self == own => Self::default(),
            false => self,
        }
    }
}

/// The part of light that remains after glass up to a hit.
///
/// Out of line, because copies of it take more code than the calls.
#[inline(never)]
fn left<N: Number>(ray: &Ray<N>, hit: &Hit<N>, material: &Material) -> Color<N> {
    // |slope| lies between 1 and the square root of 3.
    let (_, norm) = N::normalize(ray.slope);
    // The way from far away can be longer than a length can be.
    absorb(material, N::from_wide(N::narrow(hit.t).wide(norm)))
}

/// The part of light that remains after a length of glass.
pub(super) fn absorb<N: Number>(material: &Material, length: N) -> Color<N> {
    let [red, green, blue] = material.absorption;
    // A ray of the caller's own can hit glass before its origin.
    let length = length.max(N::ZERO);
    let shift = material.absorption_shift();
    let left = |coefficient: u32| length.exp_neg(coefficient, shift);
    Color([left(red), left(green), left(blue)])
}
