//! Asks the core through one structure or another.

pub use gridel_host::verify::{UnitRay, depart};

use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Fixed, Hit, NoCount, Number, Observer, Ray, Scene, Stack, Structure, any_hit,
    closest_hit, closest_primitive,
};
use std::any::Any;

/// A hit to the last bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitBits {
    pub primitive: u32,
    pub object: u32,
    pub instance: Option<u32>,
    pub front: bool,
    pub t: u64,
    pub point: [u64; 3],
    pub normal: [u64; 3],
    pub error: u64,
}

impl HitBits {
    pub fn of<N: Number>(hit: &Hit<N>) -> Self {
        Self {
            primitive: hit.primitive,
            object: hit.object,
            instance: hit.instance(),
            front: hit.front,
            t: N::far_to_f64(hit.t).to_bits(),
            point: hit.point.map(|x| x.length_to_f64().to_bits()),
            normal: hit.normal.map(|x| x.ratio_to_f64().to_bits()),
            error: hit.error.length_to_f64().to_bits(),
        }
    }
}

/// The first hit through one structure.
pub fn closest<N: Number, A: Accel>(
    scene: &Scene<'_>,
    ray: &Ray<N>,
    count: &mut impl Observer,
) -> Option<Hit<N>> {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    closest_hit::<N, A, _>(scene, ray, stack.as_view(), count)
}

/// Returns whether there is a hit, through one structure.
pub fn any<N: Number, A: Accel>(scene: &Scene<'_>, ray: &Ray<N>) -> bool {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    any_hit::<N, A, _>(scene, ray, stack.as_view(), &mut NoCount)
}

/// The structures of a scene that are not the list.
pub fn held(scene: &Scene<'_>) -> impl Iterator<Item = Structure> {
    let all = Structure::ALL.into_iter();
    all.filter(|&structure| structure != Structure::List && scene.holds(structure))
}

/// A first hit, and whether there is any.
type Answer<N> = (Option<Hit<N>>, bool);

/// The first hit through a structure that is chosen while the program runs, and whether
/// [`any_hit`] finds one.
///
/// Every structure is compiled for every format once, in this library, and not again in each test program. So the types
/// are selected at run time.
pub fn through<N: Number>(structure: Structure, scene: &Scene<'_>, ray: &Ray<N>) -> Answer<N> {
    fn answer<N: Number, M: Number>(
        asked: fn(Structure, &Scene<'_>, &Ray<M>) -> Answer<M>,
        structure: Structure,
        scene: &Scene<'_>,
        ray: &Ray<N>,
    ) -> Option<Answer<N>> {
        let ray = (ray as &dyn Any).downcast_ref::<Ray<M>>()?;
        let answer = asked(structure, scene, ray);
        (&answer as &dyn Any).downcast_ref::<Answer<N>>().copied()
    }
    answer(ask_fixed, structure, scene, ray)
        .or_else(|| answer(ask_f32, structure, scene, ray))
        .or_else(|| answer(ask_f64, structure, scene, ray))
        .expect("there are three formats")
}

fn ask_fixed(structure: Structure, scene: &Scene<'_>, ray: &Ray<Fixed>) -> Answer<Fixed> {
    ask(structure, scene, ray)
}

fn ask_f32(structure: Structure, scene: &Scene<'_>, ray: &Ray<f32>) -> Answer<f32> {
    ask(structure, scene, ray)
}

fn ask_f64(structure: Structure, scene: &Scene<'_>, ray: &Ray<f64>) -> Answer<f64> {
    ask(structure, scene, ray)
}

fn ask<N: Number>(structure: Structure, scene: &Scene<'_>, ray: &Ray<N>) -> Answer<N> {
    let chosen = scene.choose(structure).expect("a structure that is held");
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let found = closest_primitive::<N, DynAccel, _>(&chosen, ray, stack.as_view(), &mut NoCount);
    let hit = found.map(|found| {
        let hit = found.hit(&chosen, ray).expect("a surface");
        assert_eq!(found.normal(&chosen, ray), Some(hit.normal));
        hit
    });
    (hit, any::<N, DynAccel>(&chosen, ray))
}

/// Returns the largest error of t, measured along the normal. It is the bound of the largest coordinate of ray and hit,
/// which is more than that of the hit's point.
pub fn t_bound<N: Number>(ray: &Ray<N>, hit: &Hit<N>) -> f64 {
    let place = ray.start().into_iter().chain(hit.point);
    let largest = place.fold(N::ZERO, |most, x| most.max(x.abs()));
    N::error_bound(largest).length_to_f64()
}

/// A point in units, from a hit.
pub fn point_of<N: Number>(hit: &Hit<N>) -> [f64; 3] {
    hit.point.map(N::length_to_f64)
}
