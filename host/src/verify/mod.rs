//! Traces hard rays through a scene, and checks that every structure and number format keeps its promises.
//!
//! Where structures disagree, 320-bit arithmetic decides, from the textbook's formulas of each shape. Every format gets
//! the ray that it can represent. So the test judges the kernels' arithmetic and not the rounding of the ray.
//!
//! | file | what is in it |
//! |---|---|
//! | `property.rs` | the properties, and their violations |
//! | `rays.rs` | hard rays |
//! | `ask.rs`, `check.rs` | a ray through all structures of a blob; the properties of the answers |
//! | `rounded.rs` | rays and answers as the kernels of a format have them |
//! | `judge.rs` | right answers by exact arithmetic |
//! | `placed.rs` | rays mapped by the integers of instances, exactly |
//! | `leave.rs` | secondary rays, which leave surfaces |
//! | `shadow.rs` | contact shadows |
//! | `closed.rs`, `leaks.rs` | closed meshes, and rays from inside of them |
//! | `report.rs` | the report, and the results while it is made |

mod ask;
mod check;
mod closed;
#[doc(hidden)]
pub mod judge;
mod leaks;
mod leave;
mod placed;
mod property;
#[doc(hidden)]
pub mod rays;
mod report;
pub mod rounded;
mod shadow;

pub use crate::trace::UnitRay;
pub use ask::{StructureAnswer, ask, ask_all};
pub use check::{Outcome, check};
pub use closed::ClosedMesh;
pub use leaks::sealed;
pub use leave::{depart, leave};
pub use property::{Fault, Property, Tested};
pub use rays::Targets;
pub use report::{Example, FormatReport, PropertyReport, Report, Worst, as_argument};

use crate::random::Random;
use crate::trace::{Frame, SceneRay};
use gridel_core::accel::DynAccel;
use gridel_core::{Fixed, Number, Scene, Structure};
use judge::Judge;
use leaks::{Aim, aim, inside};
use rayon::prelude::*;
use report::Tally;

/// Default number of rays of all sorts that a scene is verified with.
pub const RAYS: u64 = 10_000;
/// Rays of a chunk of work.
const CHUNK: u64 = 128;
/// One ray in this many is judged by exact arithmetic whatever the answer. Secondary rays leave one hit in this many.
const CONTROL: u64 = 16;

/// Steps of the work, for progress: [`verify`] reports each.
pub fn steps(rays: u64) -> u64 {
    2 * rays.div_ceil(CHUNK)
}

/// Verifies a scene with `rays` rays of all sorts, and as many at the vertices and edges of closed meshes. Calls
/// `progress` after every step, from any thread. The rays are the same every time.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// let report = gridel_host::verify::verify(&scene, 100, &|| ());
/// assert_eq!(report.broken(), 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn verify(scene: &Scene<'_>, rays: u64, progress: &(dyn Fn() + Sync)) -> Report {
    let judge = Judge::of(scene);
    let targets = Targets::of(scene);
    let frame = Frame::of(scene);
    let work = Work {
        scene,
        judge: &judge,
        frame: &frame,
    };
    let chunks = rays.div_ceil(CHUNK);
    let tally = |chunk: u64| {
        let mut tally = Tally::default();
        let count = CHUNK.min(rays - chunk * CHUNK);
        let mut random = Random(!chunk);
        for (number, ray) in (0..count).zip(targets.rays(chunk)) {
            let ray = frame.scene_ray(&ray);
            let control = number % CONTROL == 0;
            work.ray::<Fixed>(&ray, control, &mut random, &mut tally);
            work.ray::<f32>(&ray, control, &mut random, &mut tally);
            work.ray::<f64>(&ray, control, &mut random, &mut tally);
            if control && let Some(ray) = shadow::at_a_shadow(scene, &mut random) {
                let ray = frame.scene_ray(&ray);
                work.shadow::<Fixed>(&ray, &mut tally);
                work.shadow::<f32>(&ray, &mut tally);
            }
        }
        progress();
        tally
    };
    let all = (0..chunks).into_par_iter().map(tally);
    let mut all = all.reduce(Tally::default, Tally::plus);

    let (meshes, closed_meshes) = ClosedMesh::all(scene);
    let starts: Vec<_> = meshes
        .par_iter()
        .filter_map(|mesh| Some((mesh, inside(scene, mesh)?)))
        .collect();
    let aimed_from = (starts.len() as u64).min(rays) as usize;
    let leaks = (0..chunks).into_par_iter().map(|chunk| {
        let mut tally = Tally::default();
        let mut random = Random(0x1ea5 ^ !chunk);
        let numbers = chunk * CHUNK..rays.min((chunk + 1) * CHUNK);
        for aim in numbers.filter_map(|number| aim(&starts, number, &mut random)) {
            work.leak::<Fixed>(&aim, &mut tally);
            work.leak::<f32>(&aim, &mut tally);
            work.leak::<f64>(&aim, &mut tally);
        }
        progress();
        tally
    });
    all = all.plus(leaks.reduce(Tally::default, Tally::plus));
    all.report(scene, rays, [closed_meshes, aimed_from])
}

/// The input of checking a ray.
struct Work<'w> {
    scene: &'w Scene<'w>,
    judge: &'w Judge,
    frame: &'w Frame,
}

impl Work<'_> {
    /// Puts a ray to all structures in one format.
    fn ray<N: Number>(
        &self,
        ray: &SceneRay,
        control: bool,
        random: &mut Random,
        tally: &mut Tally,
    ) {
        let Ok((ready, _)) = self.frame.ray::<N>(self.scene, ray) else {
            return;
        };
        let answers = ask_all::<N>(self.scene, &ready);
        let outcome = check(self.scene, self.judge, &ready, &answers, control);
        let hit = answers.first().and_then(|list| list.hit);
        let entry = tally.format(N::FORMAT);
        entry.hits += u64::from(hit.is_some());
        entry.judged += u64::from(outcome.judged);
        if outcome.grazes {
            entry.worst_grazing.record(outcome.error, ray);
        } else {
            entry.worst.record(outcome.error, ray);
        }
        let structures = answers.len() as u64;
        tally.checked(Property::Structures, structures - 1);
        tally.checked(Property::AnyHit, structures);
        tally.checked(Property::Answers, 1);
        tally.checked(Property::Numbers, u64::from(hit.is_some()));
        for fault in outcome.faults {
            tally.fault(fault, ray);
        }
        if let Some(hit) = hit.filter(|_| random.one_in(CONTROL as usize)) {
            let tested = leave(self.scene, self.judge, &hit, random);
            tally.tested(Property::SelfHits, tested, ray);
        }
    }

    /// Looks at a place that lies in a shadow in one format.
    fn shadow<N: Number>(&self, ray: &SceneRay, tally: &mut Tally) {
        let Ok((ready, _)) = self.frame.ray::<N>(self.scene, ray) else {
            return;
        };
        tally.tested(Property::Shadows, shadow::lost(self.scene, &ready), ray);
    }

    /// Follows a ray from inside of a closed mesh through every structure.
    fn leak<N: Number>(&self, aim: &Aim<'_>, tally: &mut Tally) {
        if !aim.is_inside(N::FORMAT) {
            return;
        }
        let (origin, direction) = (aim.origin, aim.direction);
        for structure in Structure::ALL {
            let Some(scene) = self.scene.choose(structure) else {
                continue;
            };
            tally.checked(Property::Leaks, 1);
            let fault = sealed::<N, DynAccel>(&scene, self.judge, aim.mesh, origin, direction);
            if let Some(fault) = fault {
                let ray = UnitRay::new(origin, direction);
                tally.fault(Fault { structure, ..fault }, &self.frame.scene_ray(&ray));
            }
        }
    }
}
