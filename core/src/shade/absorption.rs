//! Glass that absorbs light along the way: Beer's law.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::query::Hit;
use crate::ray::Ray;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::glass::Glass;
use crate::shade::surface::{Arrival, Filter};

pub(crate) struct Absorption;

impl Effect for Absorption {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::ABSORPTION;
    const FILTERS: bool = true;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        Glass::is_required_by_material(material) && material.absorption != [0; 3]
    }

    #[inline(always)]
    fn arrive<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        ray: &Ray<N>,
        arrival: &mut Arrival<'s, '_, N>,
    ) {
        let Arrival { hit, material, .. } = *arrival;
        let is_behind = Glass::is_required_by_material(material) && !hit.front;
        let medium = arrival.medium.or(is_behind.then_some(material));
        if let Some(medium) = medium {
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
        _: &mut X,
        (): &mut (),
        ray: &Ray<N>,
        filter: &mut Filter<'s, '_, N>,
    ) {
        // It is not yet known whether any light passes: alpha decides after this.
        let is_behind = Glass::is_required_by_material(filter.material) && !filter.hit.front;
        if let Some(medium) = filter.medium.or(is_behind.then_some(filter.material)) {
            filter.left = filter.left.times(left(ray, filter.hit, medium));
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
    let coefficients = material.absorption;
    Color(coefficients.map(|coefficient| length.exp_neg(coefficient)))
}
