//! Who takes part, and Gridel's own structures among them.

use crate::workload::{Answer, Query, Workload};
use glam::DVec3;
use gridel_core::accel::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, NoCount, Number, Ray, Scene, Stack, Structure, any_hit, closest_primitive,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, Quality, compile};
use std::time::Instant;

/// Traces rays: the queries, whether any hit will do, and where the answers go.
pub type Trace<'c> = dyn Fn(&[Query], bool, &mut [Answer]) + 'c;

/// One way to trace rays.
pub struct Contender<'c> {
    pub name: String,
    /// What building took.
    pub seconds: f64,
    /// Everything that tracing reads.
    pub bytes: usize,
    pub trace: Box<Trace<'c>>,
}

/// A blob with one structure, and what building took, from the scene in memory on. Fails if the
/// scene cannot be compiled.
pub fn built(
    workload: &Workload,
    structure: Structure,
    lattice_bits: u8,
    quality: Quality,
) -> Result<(Blob, f64), String> {
    let options = Options {
        structures: vec![structure],
        lattice_bits,
        quality,
        ..Options::default()
    };
    let started = Instant::now();
    let compiled = compile(&workload.scene, &options)
        .map_err(|error| format!("{}: {error}", workload.name))?;
    Ok((compiled.blob, started.elapsed().as_secs_f64()))
}

/// Gridel through one structure. A rate counts everything from a ray's origin and direction in
/// scene units on: Gridel's set-up on the lattice is in its time.
pub fn gridel<'c, N: Number, A: Accel>(
    name: String,
    scene: Scene<'c>,
    bytes: usize,
    seconds: f64,
) -> Contender<'c> {
    Contender {
        name,
        seconds,
        bytes,
        trace: Box::new(move |queries, any, answers| {
            trace::<N, A>(&scene, queries, any, answers);
        }),
    }
}

fn trace<N: Number, A: Accel>(
    scene: &Scene<'_>,
    queries: &[Query],
    any: bool,
    answers: &mut [Answer],
) {
    let header = scene.header();
    let origin = DVec3::from_array(header.origin).as_vec3();
    let scale = f32::powi(2.0, -i32::from(header.unit_exponent));
    let back = f32::powi(2.0, header.unit_exponent.into());
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let wide = |v: glam::Vec3| v.to_array().map(|x| N::far_from_f64(x.into()));
    for (query, answer) in queries.iter().zip(answers) {
        answer.t = f32::INFINITY;
        let start = (query.origin - origin) * scale;
        let ray = Ray::<N>::new(
            scene.bounds(),
            wide(start),
            wide(query.direction),
            N::far_from_f64(0.0),
            N::far_from_f64(f64::from(f32::MAX)),
        );
        let Ok(ray) = ray else { continue };
        if any {
            if any_hit::<N, A, _>(scene, &ray, stack.as_view(), &mut NoCount) {
                answer.t = 0.0;
            }
        } else if let Some(found) =
            closest_primitive::<N, A, _>(scene, &ray, stack.as_view(), &mut NoCount)
        {
            // t is a length along the major axis, in units.
            let along = query.direction.abs().max_element();
            answer.t = N::far_to_f64(found.t) as f32 * back / along;
        }
    }
}
