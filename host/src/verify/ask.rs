//! The answers of structures to a ray.

use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Hit, List, NoCount, Number, Ray, Scene, Stack, Structure, any_hit, closest_hit,
};

/// The answer of one structure.
#[derive(Clone, Copy, Debug)]
pub struct StructureAnswer<N: Number> {
    pub structure: Structure,
    pub hit: Option<Hit<N>>,
    pub any: bool,
}

/// Asks one structure.
pub fn ask<N: Number, A: Accel>(scene: &Scene<'_>, ray: &Ray<N>) -> StructureAnswer<N> {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    StructureAnswer {
        structure: A::STRUCTURE,
        hit: closest_hit::<N, A, _>(scene, ray, stack.as_view(), &mut NoCount),
        any: any_hit::<N, A, _>(scene, ray, stack.as_view(), &mut NoCount),
    }
}

/// Asks the list and then every structure that a scene holds.
pub fn ask_all<N: Number>(scene: &Scene<'_>, ray: &Ray<N>) -> Vec<StructureAnswer<N>> {
    let list = ask::<N, List>(scene, ray);
    let others = Structure::ALL
        .into_iter()
        .filter(|&structure| structure != Structure::List)
        .filter_map(|structure| {
            let chosen = scene.choose(structure)?;
            Some(StructureAnswer {
                structure,
                ..ask::<N, DynAccel>(&chosen, ray)
            })
        });
    std::iter::once(list).chain(others).collect()
}
