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
use crate::shade::surface::Filter;

pub(crate) struct Absorption;

impl Effect for Absorption {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::ABSORPTION;

    fn is_called_by_material(material: &Material) -> bool {
        Glass::is_called_by_material(material) && material.absorption != [0; 3]
    }

    #[inline(always)]
    fn arrive<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        ray: &Ray<N>,
        hit: &Hit<N>,
        material: &Material,
        weight: &mut Color<N>,
    ) {
        if Glass::is_called_by_material(material) && !hit.front {
            *weight = weight.times(absorb(material, path_length(ray, hit)));
            if X::Observer::ENABLED {
                tracer.count().event(Event::Absorbed {
                    weight: weight.ratios_to_f64(),
                });
            }
        }
    }

    #[inline(always)]
    fn filter<'s, N: Number, X: Tracer<'s, N>>(
        _: &mut X,
        (): &mut (),
        ray: &Ray<N>,
        filter: &mut Filter<'_, N>,
    ) {
        if filter.passes && !filter.hit.front {
            let length = path_length(ray, filter.hit);
            filter.left = filter.left.times(absorb(filter.material, length));
        }
    }
}

/// What is left of light after a length of glass.
pub(super) fn absorb<N: Number>(material: &Material, length: N) -> Color<N> {
    Color(
        material
            .absorption
            .map(|coefficient| length.exp_neg(coefficient)),
    )
}

/// The length of a ray up to its hit.
fn path_length<N: Number>(ray: &Ray<N>, hit: &Hit<N>) -> N {
    // |slope| lies between 1 and the square root of 3.
    let (_, norm) = N::normalize(ray.slope);
    // From far away it is longer than a length can be.
    N::from_wide(N::narrow(hit.t).wide(norm))
}
