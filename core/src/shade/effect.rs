//! The interface between effects and the ray loop.
//!
//! An effect is a type without values that implements [`Effect`]: it can act at every place, and by default does
//! nothing. The list of effects has the same places, and calls those of the effects in use, one after the other. All of
//! it is inlined, so effects that are not in use cost no instruction.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::{Light, Material, View};
use crate::observe::count::Observer;
use crate::observe::event::RayKind;
use crate::query::Hit;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shade::Color;
use crate::shade::surface::{
    Aim, Arrival, Bounce, Filter, Gleam, Lighting, Reach, Secondary, Surface,
};
use core::fmt::Debug;

/// The ray loop, as effects use it.
pub(crate) trait Tracer<'s, N: Number> {
    /// Receives counts and events.
    type Observer: Observer;

    /// True if surfaces can send secondary rays.
    const SENDS: bool;

    /// Returns true if light can pass a surface on its way to another one.
    fn filters(&self) -> bool;

    fn scene(&self) -> &'s Scene<'s>;

    fn count(&mut self) -> &mut Self::Observer;

    /// The purpose of the current ray.
    fn kind(&self) -> RayKind;

    /// A random point of the unit square, with 32 fraction bits, for the current ray. See
    /// [`Sampler::point`](crate::shade::sampler::Sampler::point), which explains dimensions.
    fn point(&self, dimension: u16) -> [u32; 2];

    /// The binary logarithm of the distance between the rays of neighboring samples, per distance from the eye. It has
    /// [`LOG2_BITS`](crate::number::log2::LOG2_BITS) fraction bits. `None` for rays of the caller's own.
    fn spread(&self) -> Option<i32>;

    fn any_hit(&mut self, ray: &Ray<N>) -> bool;

    fn closest_hit(&mut self, ray: &Ray<N>) -> Option<Hit<N>>;

    /// Lets the effects in use pass light through a surface.
    fn filter(&mut self, ray: &Ray<N>, filter: &mut Filter<'s, '_, N>);

    /// Lets the effects in use act on light on the last part of its way.
    fn reach(&mut self, reach: &mut Reach<'s, N>);

    /// Puts a ray that leaves a surface on the work list, unless its weight is too small.
    fn send(&mut self, hit: &Hit<N>, secondary: Secondary<N>);
}

/// Declares the places once for an effect and for the list of effects.
///
/// The arguments of each are the ray loop, and the state that the effect adds to the current ray.
macro_rules! places {
    ($(
        $(#[doc = $doc:literal])*
        fn $place:ident($($argument:ident: $type:ty),*);
    )*) => {
        /// An effect.
        #[allow(unused_variables, reason = "most effects do nothing at most places")]
        pub(crate) trait Effect {
            /// The state that the effect adds to a ray, `()` for none. The rays that a hit causes begin
            /// with the state after [`surface`](Self::surface).
            type State<N: Number>: Copy + Debug + Default;

            /// The effect, as sets hold it.
            const EFFECT: Effects;

            /// True if rays wait because of it.
            const CASTS: bool = Effects::CASTING.contains(Self::EFFECT);

            /// True if it needs the direction of a ray with length 1.
            const NEEDS_DIRECTION: bool = false;

            /// True if it acts on light that comes through surfaces.
            const FILTERS: bool = false;

            /// True if because of it rays may pass a surface straight on.
            const PASSES: bool = false;

            /// True if it acts on the mean of samples that are brighter than display white, or needs that mean to be
            /// right.
            const DEVELOPS: bool = false;

            /// True if because of it single samples are up to a few times brighter than their mean.
            const VARIES: bool = false;

            /// Returns true if a material requires it.
            fn is_required_by_material(material: &Material) -> bool {
                false
            }

            /// Returns true if a light requires it.
            fn is_required_by_light(light: &Light) -> bool {
                false
            }

            /// Returns true if a view requires it.
            fn is_required_by_view(view: &View) -> bool {
                false
            }

            $(
                $(#[doc = $doc])*
                #[inline(always)]
                fn $place<'s, N: Number, X: Tracer<'s, N>>(
                    tracer: &mut X,
                    state: &mut Self::State<N>,
                    $($argument: $type),*
                ) {
                }
            )*
        }

        /// Effects, one after the other: `(First, (Second, ()))`. Of all that it has, `USED` are in use.
        pub(crate) trait EffectList {
            type State<N: Number>: Copy + Debug + Default;

            /// The effects because of which rays wait.
            const CASTING: u32;
            /// The effects that need a direction with length 1.
            const DIRECTED: u32;
            /// The effects that act on light that comes through surfaces.
            const FILTERING: u32;
            /// The effects because of which rays may pass a surface straight on.
            const PASSING: u32;
            /// The effects that act on the mean of samples that are brighter than display white.
            const DEVELOPING: u32;
            /// The effects because of which single samples are up to a few times brighter than their mean.
            const VARYING: u32;

            /// Bytes of the states of some effects in a ray that waits.
            fn state_bytes<N: Number>(effects: Effects) -> usize;

            /// The effects that a material requires.
            fn required_by_material(material: &Material) -> Effects;

            /// The effects that a light requires.
            fn required_by_light(light: &Light) -> Effects;

            /// The effects that a view requires.
            fn required_by_view(view: &View) -> Effects;

            $(
                fn $place<'s, const USED: u32, N: Number, X: Tracer<'s, N>>(
                    tracer: &mut X,
                    state: &mut Self::State<N>,
                    $($argument: $type),*
                );
            )*
        }

        impl EffectList for () {
            type State<N: Number> = ();

            const CASTING: u32 = 0;
            const DIRECTED: u32 = 0;
            const FILTERING: u32 = 0;
            const PASSING: u32 = 0;
            const DEVELOPING: u32 = 0;
            const VARYING: u32 = 0;

            fn state_bytes<N: Number>(_: Effects) -> usize {
                0
            }

            #[inline(always)]
            fn required_by_material(_: &Material) -> Effects {
                Effects::NONE
            }

            fn required_by_light(_: &Light) -> Effects {
                Effects::NONE
            }

            fn required_by_view(_: &View) -> Effects {
                Effects::NONE
            }

            $(
                #[inline(always)]
                fn $place<'s, const USED: u32, N: Number, X: Tracer<'s, N>>(
                    _: &mut X,
                    _: &mut Self::State<N>,
                    $(_: $type),*
                ) {
                }
            )*
        }

        impl<First: Effect, Rest: EffectList> EffectList for (First, Rest) {
            type State<N: Number> = (First::State<N>, Rest::State<N>);

            const CASTING: u32 = First::EFFECT.only_if(First::CASTS).0 | Rest::CASTING;
            const DIRECTED: u32 = First::EFFECT.only_if(First::NEEDS_DIRECTION).0 | Rest::DIRECTED;
            const FILTERING: u32 = First::EFFECT.only_if(First::FILTERS).0 | Rest::FILTERING;
            const PASSING: u32 = First::EFFECT.only_if(First::PASSES).0 | Rest::PASSING;
            const DEVELOPING: u32 = First::EFFECT.only_if(First::DEVELOPS).0 | Rest::DEVELOPING;
            const VARYING: u32 = First::EFFECT.only_if(First::VARIES).0 | Rest::VARYING;

            fn state_bytes<N: Number>(effects: Effects) -> usize {
                let is_there = effects.contains(First::EFFECT);
                let first = if is_there { size_of::<First::State<N>>() } else { 0 };
                first.wrapping_add(Rest::state_bytes::<N>(effects))
            }

            #[inline(always)]
            fn required_by_material(material: &Material) -> Effects {
                let first = First::EFFECT.only_if(First::is_required_by_material(material));
                first.with(Rest::required_by_material(material))
            }

            fn required_by_light(light: &Light) -> Effects {
                let first = First::EFFECT.only_if(First::is_required_by_light(light));
                first.with(Rest::required_by_light(light))
            }

            fn required_by_view(view: &View) -> Effects {
                let first = First::EFFECT.only_if(First::is_required_by_view(view));
                first.with(Rest::required_by_view(view))
            }

            $(
                #[inline(always)]
                fn $place<'s, const USED: u32, N: Number, X: Tracer<'s, N>>(
                    tracer: &mut X,
                    (first, rest): &mut Self::State<N>,
                    $($argument: $type),*
                ) {
                    if const { Effects(USED).contains(First::EFFECT) } {
                        First::$place(tracer, first, $($argument),*);
                    }
                    Rest::$place::<USED, N, X>(tracer, rest, $($argument),*);
                }
            )*
        }
    };
}

places! {
    /// A ray leaves the camera for a sample, counted from 0 in its pixel.
    fn camera(ray: &mut Ray<N>);

    /// A ray has come to a hit: the ratio of the light from there that arrives at the eye may change.
    fn arrive(ray: &Ray<N>, arrival: &mut Arrival<'s, '_, N>);

    /// A ray hits a surface: the diffuse color and the shading normal may change.
    fn surface(ray: &Ray<N>, surface: &mut Surface<'_, N>);

    /// A surface sends out light: its radiance, first that of ambient light, may change.
    fn emit(surface: &Surface<'_, N>, local: &mut Color<N>);

    /// A surface looks for a light of the scene, by its number: the point of the light may change.
    fn aim(number: u32, light: &Light, aim: &mut Aim<N>);

    /// A surface faces a light: the start of the way there may change, and whether the light reaches it.
    fn face(surface: &Surface<'_, N>, lighting: &mut Lighting<'_, N>, is_reached: &mut bool);

    /// A surface reflects a light that it faces: the reflected ratio may change, and facets may mirror the light.
    fn reflect(
        surface: &Surface<'_, N>,
        lighting: &Lighting<'_, N>,
        reflected: &mut Color<N>,
        gleam: &mut Option<Gleam<N>>
    );

    /// Light arrives from a light at a surface that reflects it: its radiance may change.
    fn light(surface: &Surface<'_, N>, lighting: &Lighting<'_, N>, arriving: &mut Color<N>);

    /// A surface is in the way of light to another one: it may let a part through.
    fn filter(ray: &Ray<N>, filter: &mut Filter<'s, '_, N>);

    /// Nothing else is in the way of light from a place to another surface: a part of it may remain.
    fn reach(reach: &mut Reach<'s, N>);

    /// A ray hits nothing: its radiance, first the background, may change.
    fn miss(ray: &Ray<N>, radiance: &mut Color<N>);

    /// A surface may send rays on, if the ray depth allows more.
    fn bounce(surface: &Surface<'_, N>, bounce: &mut Bounce<N>);

    /// A ray is about to leave a hit: its direction may change.
    fn leave(hit: &Hit<N>, secondary: &mut Secondary<N>);

    /// All rays of a sample were traced: its radiance may change before it is limited to the
    /// range of a display. The state is a new one.
    fn pixel(radiance: &mut Color<N>);

    /// The mean of a pixel's samples is known: it may change before it is limited to the range of a display. The
    /// state is a new one.
    fn develop(mean: &mut Color<N>);
}
