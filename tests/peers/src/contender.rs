//! Who takes part, and Gridel's own structures among them.

use crate::workload::{Answer, Query, Rays, Workload};
use glam::DVec3;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Format, NoCount, Ray, Scene, Stack, Structure, Wide, any_hit, closest_primitive,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, Quality, compile};
use gridel_host::trace::{SceneHit, SceneRay};
use std::time::Instant;

/// Traces rays `R`, or finds whether each meets anything, and writes answers `A`.
type Tracer<'c, R, A> = Box<dyn Fn(&[R], bool, &mut [A]) + 'c>;

/// How a contender traces rays: given them, whether any hit will do, and where the answers go.
pub enum Trace<'c> {
    /// A library's function for one ray, called for each.
    OfQueries(Tracer<'c, Query, Answer>),
    /// Gridel's function for many rays, on the arrays that it takes.
    OfSceneRays(Tracer<'c, SceneRay, SceneHit>),
}

/// One way to trace rays.
pub struct Contender<'c> {
    pub name: String,
    /// Time and memory of building.
    pub seconds: f64,
    /// Everything that tracing reads.
    pub bytes: usize,
    pub trace: Trace<'c>,
}

/// The answers of a contender.
pub enum Output {
    Answers(Vec<Answer>),
    Hits(Vec<SceneHit>),
}

impl Contender<'_> {
    /// Room for the answers of so many rays.
    pub fn output(&self, rays: usize) -> Output {
        match self.trace {
            Trace::OfQueries(_) => Output::Answers(vec![Answer { t: f32::INFINITY }; rays]),
            Trace::OfSceneRays(_) => Output::Hits(vec![SceneHit::MISS; rays]),
        }
    }

    /// Traces rays: what is timed.
    pub fn trace(&self, rays: &Rays, output: &mut Output) {
        match (&self.trace, output) {
            (Trace::OfQueries(trace), Output::Answers(answers)) => {
                trace(&rays.queries, rays.any, answers);
            }
            (Trace::OfSceneRays(trace), Output::Hits(hits)) => {
                trace(&rays.scene_rays, rays.any, hits);
            }
            _ => unreachable!("the output is the contender's"),
        }
    }
}

impl Output {
    /// The answers in one form.
    pub fn answers(self) -> Vec<Answer> {
        match self {
            Self::Answers(answers) => answers,
            Self::Hits(hits) => hits.iter().map(|hit| Answer { t: hit.t as f32 }).collect(),
        }
    }
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

/// Gridel as users call it: its function for many rays in scene units, with the whole of each hit.
pub fn gridel(
    name: String,
    scene: Scene<'_>,
    (format, structure): (Format, Structure),
    bytes: usize,
    seconds: f64,
) -> Contender<'_> {
    Contender {
        name,
        seconds,
        bytes,
        trace: Trace::OfSceneRays(Box::new(move |rays, any, hits| {
            let query = gridel_host::trace::Query {
                format,
                structure,
                any,
            };
            gridel_host::trace::trace(&scene, rays, query, hits).expect("a structure that is held");
        })),
    }
}

/// The core's query alone, in `f32` through `wide`, with no more of the hit than t: what
/// [`gridel`]'s rate is compared with.
pub fn kernel(name: String, scene: Scene<'_>, bytes: usize, seconds: f64) -> Contender<'_> {
    Contender {
        name,
        seconds,
        bytes,
        trace: Trace::OfQueries(Box::new(move |queries, any, answers| {
            trace(&scene, queries, any, answers);
        })),
    }
}

fn trace(scene: &Scene<'_>, queries: &[Query], any: bool, answers: &mut [Answer]) {
    let header = scene.header();
    let origin = DVec3::from_array(header.origin).as_vec3();
    let scale = f32::powi(2.0, -i32::from(header.unit_exponent));
    let back = f32::powi(2.0, header.unit_exponent.into());
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    for (query, answer) in queries.iter().zip(answers) {
        answer.t = f32::INFINITY;
        let start = (query.origin - origin) * scale;
        let (start, direction) = (start.to_array(), query.direction.to_array());
        let ray = Ray::<f32>::new(scene.bounds(), start, direction, 0.0, f32::MAX);
        let Ok(ray) = ray else { continue };
        if any {
            if any_hit::<f32, Wide, _>(scene, &ray, stack.as_view(), &mut NoCount) {
                answer.t = 0.0;
            }
        } else if let Some(found) =
            closest_primitive::<f32, Wide, _>(scene, &ray, stack.as_view(), &mut NoCount)
        {
            // t is a length along the major axis, in units.
            let along = query.direction.abs().max_element();
            answer.t = found.t * back / along;
        }
    }
}
