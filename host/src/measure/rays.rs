//! Tracing with counters, and tracing against the clock.

use super::median;
use crate::observed::Observed;
use crate::picture_rays::PictureRays;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Counters, NoCount, Number, Observer, PrimitiveHit, Ray, Scene, Stack, Structure,
    StructureVisitor, any_hit, closest_primitive,
};
use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;

/// The question of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// The closest hit.
    Closest,
    /// The closest hit, and the instance that has it, which takes longer to say.
    ClosestPlaced,
    /// Any hit.
    Any,
}

/// The rays of a picture and the query for each.
#[derive(Clone, Copy, Debug)]
pub struct Questions<'q, N: Number> {
    pub rays: &'q PictureRays<N>,
    pub shadow: Question,
}

/// Rays that are measured together, and their query.
type Group<'r, N> = (Question, &'r [Ray<N>]);

impl Question {
    /// Returns the question by which answers are compared in a scene.
    pub fn of_scene(self, scene: &Scene<'_>) -> Self {
        match self {
            Self::Closest if !scene.instances().is_empty() => Self::ClosestPlaced,
            other => other,
        }
    }
}

/// An answer to the last bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    /// The primitive, or whether anything was met.
    primitive: u32,
    /// The number of its instance, where that was requested and it has one.
    instance: u32,
    /// The bits of t.
    t: u64,
}

/// The number of the instance for objects that are in none.
const NO_INSTANCE: u32 = u32::MAX;

impl Answer {
    /// The answer for a ray that misses.
    const NOTHING: Self = Self {
        primitive: u32::MAX,
        instance: NO_INSTANCE,
        t: 0,
    };

    fn any(met: bool) -> Self {
        Self {
            primitive: met.into(),
            ..Self::NOTHING
        }
    }

    fn closest<N: Number>(hit: &PrimitiveHit<N>, instance: u32) -> Self {
        Self {
            primitive: hit.primitive,
            instance,
            t: N::far_to_f64(hit.t).to_bits(),
        }
    }
}

/// Returns the number of a hit's instance, by its surface. Out of line, because timed queries do
/// not need it.
#[cold]
#[inline(never)]
fn instance_of<N: Number>(scene: &Scene<'_>, ray: &Ray<N>, hit: &PrimitiveHit<N>) -> u32 {
    let index = hit.hit(scene, ray).and_then(|hit| hit.instance());
    let instance = index.and_then(|index| scene.instances().get(index as usize));
    instance.map_or(NO_INSTANCE, |instance| instance.number)
}

impl<N: Number> Questions<'_, N> {
    /// Rays from the camera, those to lights, and those that surfaces send on.
    fn groups(&self) -> [Group<'_, N>; 3] {
        let PictureRays {
            primary,
            shadow,
            bounced,
        } = self.rays;
        [
            (Question::Closest, primary),
            (self.shadow, shadow),
            (Question::Closest, bounced),
        ]
    }

    /// Returns all rays in one order.
    pub fn all(&self) -> impl Iterator<Item = (Question, &Ray<N>)> {
        let groups = self.groups().into_iter();
        groups.flat_map(|(question, rays)| rays.iter().map(move |ray| (question, ray)))
    }
}

/// Rays, one after the other.
pub type Rays<'i, 'r, N> = &'i mut dyn Iterator<Item = &'r Ray<N>>;

/// Traces rays through a structure's own code, and passes on the results.
pub fn ask<N: Number>(
    (scene, structure): (&Scene<'_>, Structure),
    question: Question,
    rays: Rays<'_, '_, N>,
    sink: &mut dyn FnMut(Answer),
) {
    struct Ask<'a, 'i, 'r, N: Number>(
        &'a Scene<'a>,
        Question,
        Rays<'i, 'r, N>,
        &'a mut dyn FnMut(Answer),
    );
    impl<N: Number> StructureVisitor for Ask<'_, '_, '_, N> {
        type Output = ();

        fn visit<A: Accel>(self) {
            let Self(scene, question, rays, sink) = self;
            ask_through::<N, A, _>(scene, question, rays, &mut NoCount, sink);
        }
    }
    structure.visit(Ask(scene, question, rays, sink));
}

fn ask_through<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    question: Question,
    rays: Rays<'_, '_, N>,
    count: &mut C,
    sink: &mut dyn FnMut(Answer),
) {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    for ray in rays {
        sink(match question {
            Question::Closest | Question::ClosestPlaced => {
                let found = closest_primitive::<N, A, C>(scene, ray, stack.as_view(), count);
                found.map_or(Answer::NOTHING, |found| {
                    let instance = match question {
                        Question::ClosestPlaced => instance_of(scene, ray, &found),
                        _ => NO_INSTANCE,
                    };
                    Answer::closest(&found, instance)
                })
            }
            Question::Any => Answer::any(any_hit::<N, A, C>(scene, ray, stack.as_view(), count)),
        });
    }
}

/// Tests and times of some rays. Those in parts count, and those of the hierarchy above instances.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Work {
    /// Rays that were traced.
    pub rays: usize,
    /// Planes tested a ray.
    pub planes: f64,
    /// Boxes and other bounding volumes tested a ray.
    pub boxes: f64,
    /// Cells entered a ray.
    pub cells: f64,
    /// Primitives tested a ray.
    pub primitives: f64,
    /// Instances entered a ray; `None` where the scene has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instances: Option<f64>,
    /// Rays per second on one thread; `None` if nothing was timed.
    pub rays_per_second: Option<f64>,
}

impl Work {
    fn of(scene: &Scene<'_>, (tests, rays): (&Counters, usize), seconds: Option<f64>) -> Self {
        let each = |count: u64| count as f64 / rays.max(1) as f64;
        Self {
            rays,
            planes: each(tests.planes),
            boxes: each(tests.boxes),
            cells: each(tests.cells),
            primitives: each(tests.primitives),
            instances: (!scene.instances().is_empty()).then(|| each(tests.instances)),
            rays_per_second: seconds.map(|seconds| rays as f64 / seconds.max(1e-9)),
        }
    }
}

/// Tests and times by the purpose of the rays.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Works {
    pub primary: Work,
    /// Work of rays to lights; `None` without such rays.
    pub shadow: Option<Work>,
    /// Work of bounced rays: mirrored, refracted and diffusely reflected ones; `None` without such rays.
    pub bounced: Option<Work>,
    pub all: Work,
}

/// The amount of measurement.
#[derive(Clone, Copy, Debug)]
pub struct Amount {
    /// Number of times that everything is timed; 0 for counts alone.
    pub repeats: usize,
    /// Primitives of the scene, with those of a part once per instance.
    pub primitives: usize,
    /// Most primitives that the list tests: see [`stride`].
    pub tests: u64,
}

/// Counts and times contenders, which take turns.
pub fn measure<N: Number>(
    questions: &Questions<'_, N>,
    contenders: &[(&Scene<'_>, &Structure)],
    amount: &Amount,
    progress: &dyn Fn(&str),
) -> Vec<Works> {
    let groups = questions.groups();
    let strides: Vec<usize> = contenders
        .iter()
        .map(|&(_, &structure)| {
            stride(
                structure,
                questions.rays.count(),
                amount.primitives,
                amount.tests,
            )
        })
        .collect();
    let mut counts = Vec::new();
    for (&(scene, &structure), &stride) in contenders.iter().zip(&strides) {
        progress(&format!("counting {}", structure.name()));
        counts.push(groups.map(|(question, all)| {
            let mut observed = Observed::default();
            let mut some = all.iter().step_by(stride);
            let rays = some.len();
            // The work is the same as through the structure's own code.
            if let Some(scene) = scene.choose(structure) {
                ask_through::<N, DynAccel, _>(
                    &scene,
                    question,
                    &mut some,
                    &mut observed,
                    &mut |answer| {
                        black_box(answer);
                    },
                );
            }
            (observed.counters, rays)
        }));
    }
    let mut seconds = vec![[const { Vec::new() }; 3]; contenders.len()];
    for repeat in 0..amount.repeats {
        for ((&(scene, &structure), &stride), seconds) in
            contenders.iter().zip(&strides).zip(&mut seconds)
        {
            progress(&format!(
                "timing {}, {} of {}",
                structure.name(),
                repeat + 1,
                amount.repeats
            ));
            for (&(question, all), seconds) in groups.iter().zip(seconds) {
                let started = Instant::now();
                let mut some = all.iter().step_by(stride);
                ask((scene, structure), question, &mut some, &mut |answer| {
                    black_box(answer);
                });
                seconds.push(started.elapsed().as_secs_f64());
            }
        }
    }
    let measured = contenders.iter().zip(counts).zip(seconds);
    let works = measured.map(|((&(scene, _), counts), seconds)| {
        let seconds = seconds.map(|repeats| median(&repeats));
        let work = |group: usize| {
            let (tests, rays) = &counts[group];
            Work::of(scene, (tests, *rays), seconds[group])
        };
        let some = |work: Work| (work.rays > 0).then_some(work);
        let all = counts
            .iter()
            .fold(Counters::default(), |all, (one, _)| all.plus(one));
        let rays = counts.iter().map(|(_, rays)| rays).sum();
        Works {
            primary: work(0),
            shadow: some(work(1)),
            bounced: some(work(2)),
            all: Work::of(scene, (&all, rays), seconds.into_iter().sum()),
        }
    });
    works.collect()
}

/// Returns the stride of the rays that a structure traces, so that no row takes forever: only the list would.
pub fn stride(structure: Structure, rays: usize, primitives: usize, tests: u64) -> usize {
    if structure == Structure::List {
        let all = rays as u64 * primitives as u64;
        all.div_ceil(tests.max(1)).max(1) as usize
    } else {
        1
    }
}

#[cfg(test)]
mod tests;
