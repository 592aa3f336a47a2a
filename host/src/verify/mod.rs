//! Traces hard rays through a scene, and checks that every structure and number format keeps its promises.
//!
//! `rays.rs` makes the rays, and `check.rs` traces each through all structures of a blob and compares the answers.
//! Where they disagree, `judge.rs` decides by 320-bit arithmetic, from the textbook's formulas of each shape. Every
//! format gets the ray that it can represent. So the test judges the kernels' arithmetic and not the rounding of the
//! ray. `placed.rs` maps rays by the integers of instances, exactly.

mod check;
mod closed;
#[doc(hidden)]
pub mod judge;
mod placed;
#[doc(hidden)]
pub mod rays;
pub mod rounded;
mod shadow;

pub use crate::trace::UnitRay;
pub use check::{
    Fault, Outcome, Property, StructureAnswer, Tested, ask, ask_all, check, depart, leave, sealed,
};
pub use closed::ClosedMesh;
pub use rays::Targets;

use crate::measure::structure_names;
use crate::random::Random;
use crate::trace::{Frame, SceneRay};
use gridel_core::accel::DynAccel;
use gridel_core::{Fixed, Format, List, Number, Scene, Structure};
use judge::Judge;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// The report of a verification.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Rays that were traced through every structure in every format.
    pub rays: u64,
    pub structures: Vec<&'static str>,
    pub formats: Vec<FormatReport>,
    /// Meshes whose every edge has its two triangles.
    pub closed_meshes: usize,
    /// Those of them inside of which rays started: not all, where there are many.
    pub closed_meshes_aimed_from: usize,
    pub properties: Vec<PropertyReport>,
}

/// The results in one format.
#[derive(Clone, Debug, Serialize)]
pub struct FormatReport {
    pub format: &'static str,
    pub hits: u64,
    /// Answers that exact arithmetic judged.
    pub judged: u64,
    /// Rays that do not graze what they meet.
    pub worst: Worst,
    /// Rays that graze ([`judge::GRAZING`]): a surface that is off by a step is met many steps later.
    pub worst_grazing: Worst,
}

/// Largest error of t against the same ray in double precision.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Worst {
    /// In steps: units of rounding times the largest coordinate, and sub-steps of `fixed`.
    pub error: f64,
    /// The ray with that error, as `explain --ray` takes it.
    pub ray: Option<String>,
}

impl Worst {
    fn record(&mut self, error: f64, ray: &SceneRay) {
        if error > self.error {
            self.error = error;
            self.ray = Some(as_argument(ray));
        }
    }

    fn worse(self, other: Self) -> Self {
        if other.error > self.error {
            other
        } else {
            self
        }
    }
}

/// Number of tests of a property, and of its violations.
#[derive(Clone, Debug, Serialize)]
pub struct PropertyReport {
    pub property: Property,
    pub text: &'static str,
    /// Answers that were checked for it.
    pub checked: u64,
    pub broken: u64,
    /// The first that broke it.
    pub examples: Vec<Example>,
}

/// A violation of a property.
#[derive(Clone, Debug, Serialize)]
pub struct Example {
    pub format: &'static str,
    pub structure: &'static str,
    /// The ray as `explain --ray` takes it.
    pub ray: String,
    pub what: String,
}

impl Report {
    /// Returns how often a property was violated.
    pub fn broken(&self) -> u64 {
        self.properties.iter().map(|property| property.broken).sum()
    }
}

/// Default number of rays of all sorts that a scene is verified with.
pub const RAYS: u64 = 10_000;
/// Rays of a chunk of work.
const CHUNK: u64 = 128;
/// One ray in this many is judged by exact arithmetic whatever the answer. Secondary rays leave one hit in this many.
const CONTROL: u64 = 16;
/// Examples that are kept per property.
const EXAMPLES: usize = 5;

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
    let inside: Vec<_> = meshes
        .par_iter()
        .filter_map(|mesh| Some((mesh, work.inside(mesh)?)))
        .collect();
    let aimed_from = (inside.len() as u64).min(rays) as usize;
    let leaks = (0..chunks).into_par_iter().map(|chunk| {
        let mut tally = Tally::default();
        let mut random = Random(0x1ea5 ^ !chunk);
        let numbers = chunk * CHUNK..rays.min((chunk + 1) * CHUNK);
        for aim in numbers.filter_map(|number| aim(&inside, number, &mut random)) {
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

/// A ray from the inside of a closed mesh, in units.
struct Aim<'m> {
    mesh: &'m ClosedMesh,
    origin: [f64; 3],
    direction: [f64; 3],
}

/// Returns a ray at a vertex, along an edge or at a face of one of the meshes, from the point inside of it. All
/// triangles take their turn, then all again with other targets.
fn aim<'m>(
    inside: &[(&'m ClosedMesh, [f64; 3])],
    number: u64,
    random: &mut Random,
) -> Option<Aim<'m>> {
    let number = number as usize;
    let &(mesh, origin) = inside.get(number.checked_rem(inside.len())?)?;
    let turn = number / inside.len();
    let [a, b, c] = mesh.triangle(turn % mesh.count());
    let mix = |a: [f64; 3], b: [f64; 3], part: f64| {
        [0, 1, 2].map(|axis| a[axis] + part * (b[axis] - a[axis]))
    };
    let target = match (turn / mesh.count() + turn) % 4 {
        0 => a,
        1 => mix(a, b, 0.5),
        2 => mix(b, c, random.unit()),
        _ => mix(a, mix(b, c, random.unit()), random.unit()),
    };
    let direction = [0, 1, 2].map(|axis| target[axis] - origin[axis]);
    (direction != [0.0; 3]).then_some(Aim {
        mesh,
        origin,
        direction,
    })
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

    /// Returns a point inside of a closed mesh, in units: halfway from a face to the opposite one.
    fn inside(&self, mesh: &ClosedMesh) -> Option<[f64; 3]> {
        const TRIED: usize = 64;
        let step = mesh.count().div_ceil(TRIED);
        let places = (0..mesh.count()).step_by(step).filter_map(|index| {
            let [a, b, c] = mesh.triangle(index).map(glam::DVec3::from_array);
            let middle = (a + b + c) / 3.0;
            let inward = -(b - a).cross(c - a);
            let ray = |tmin| {
                gridel_core::Ray::<f64>::from_f64(
                    self.scene.bounds(),
                    middle.to_array(),
                    inward.to_array(),
                    tmin,
                    f64::INFINITY,
                )
            };
            // Past the face itself, and past surfaces of other objects.
            let mut tmin = 1.0 / 1024.0;
            for _ in 0..64 {
                let hit = ask::<f64, List>(self.scene, &ray(tmin).ok()?).hit?;
                if mesh.holds(&hit) {
                    let depth = 0.5 * hit.t / inward.abs().max_element();
                    return (!hit.front).then(|| (hit.t, (middle + inward * depth).to_array()));
                }
                tmin = hit.t + 1.0 / 1024.0;
            }
            None
        });
        places
            .max_by(|(a, _), (b, _)| a.total_cmp(b))
            .map(|(_, place)| place)
    }

    /// Follows a ray from inside of a closed mesh through every structure.
    fn leak<N: Number>(&self, aim: &Aim<'_>, tally: &mut Tally) {
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

/// The results so far.
#[derive(Clone, Debug, Default)]
struct Tally {
    formats: [FormatTally; 3],
    checked: BTreeMap<Property, u64>,
    broken: BTreeMap<Property, (u64, Vec<Example>)>,
}

#[derive(Clone, Debug, Default)]
struct FormatTally {
    hits: u64,
    judged: u64,
    worst: Worst,
    worst_grazing: Worst,
}

impl FormatTally {
    fn plus(self, other: Self) -> Self {
        Self {
            hits: self.hits + other.hits,
            judged: self.judged + other.judged,
            worst: self.worst.worse(other.worst),
            worst_grazing: self.worst_grazing.worse(other.worst_grazing),
        }
    }
}

impl Tally {
    fn format(&mut self, format: Format) -> &mut FormatTally {
        &mut self.formats[format as usize]
    }

    fn checked(&mut self, property: Property, count: u64) {
        *self.checked.entry(property).or_default() += count;
    }

    fn tested(&mut self, property: Property, tested: Tested, ray: &SceneRay) {
        self.checked(property, tested.tests);
        for fault in tested.faults {
            self.fault(fault, ray);
        }
    }

    fn fault(&mut self, fault: Fault, ray: &SceneRay) {
        let (count, examples) = self.broken.entry(fault.property).or_default();
        *count += 1;
        if examples.len() < EXAMPLES {
            examples.push(Example {
                format: fault.format.name(),
                structure: fault.structure.name(),
                ray: as_argument(ray),
                what: fault.what,
            });
        }
    }

    fn plus(mut self, other: Self) -> Self {
        for (mine, theirs) in self.formats.iter_mut().zip(other.formats) {
            *mine = std::mem::take(mine).plus(theirs);
        }
        for (property, count) in other.checked {
            self.checked(property, count);
        }
        for (property, (count, examples)) in other.broken {
            let mine = self.broken.entry(property).or_default();
            mine.0 += count;
            mine.1.extend(examples);
            mine.1.truncate(EXAMPLES);
        }
        self
    }

    fn report(
        mut self,
        scene: &Scene<'_>,
        rays: u64,
        [closed_meshes, closed_meshes_aimed_from]: [usize; 2],
    ) -> Report {
        let formats = Format::ALL.map(|format| {
            let tally = self.formats[format as usize].clone();
            FormatReport {
                format: format.name(),
                hits: tally.hits,
                judged: tally.judged,
                worst: tally.worst,
                worst_grazing: tally.worst_grazing,
            }
        });
        let properties = Property::ALL.map(|property| {
            let (broken, examples) = self.broken.remove(&property).unwrap_or_default();
            PropertyReport {
                property,
                text: property.text(),
                checked: self.checked.get(&property).copied().unwrap_or(0),
                broken,
                examples,
            }
        });
        Report {
            rays,
            structures: structure_names(scene),
            formats: formats.to_vec(),
            closed_meshes,
            closed_meshes_aimed_from,
            properties: properties.to_vec(),
        }
    }
}

/// Returns a ray as `explain --ray` takes it.
pub fn as_argument(ray: &SceneRay) -> String {
    let [ox, oy, oz] = ray.origin.to_array();
    let [dx, dy, dz] = ray.direction.to_array();
    let mut text = format!("{ox:?},{oy:?},{oz:?},{dx:?},{dy:?},{dz:?}");
    if (ray.tmin, ray.tmax) != (0.0, f64::INFINITY) {
        text.push_str(&format!(",{:?},{:?}", ray.tmin, ray.tmax));
    }
    text
}
