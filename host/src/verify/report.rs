//! The report of a verification, and the results while it is made.

use super::property::{Fault, Property, Tested};
use crate::measure::structure_names;
use crate::trace::SceneRay;
use gridel_core::{Format, Scene};
use serde::Serialize;
use std::collections::BTreeMap;

/// Examples that are kept per property.
const EXAMPLES: usize = 5;

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
    /// Rays that graze ([`judge::GRAZING`](super::judge::GRAZING)): a surface that is off by a step is met many steps later.
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
    pub(super) fn record(&mut self, error: f64, ray: &SceneRay) {
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

/// The results so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    formats: [FormatTally; 3],
    checked: BTreeMap<Property, u64>,
    broken: BTreeMap<Property, (u64, Vec<Example>)>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct FormatTally {
    pub(super) hits: u64,
    pub(super) judged: u64,
    pub(super) worst: Worst,
    pub(super) worst_grazing: Worst,
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
    pub(super) fn format(&mut self, format: Format) -> &mut FormatTally {
        &mut self.formats[format as usize]
    }

    pub(super) fn checked(&mut self, property: Property, count: u64) {
        *self.checked.entry(property).or_default() += count;
    }

    pub(super) fn tested(&mut self, property: Property, tested: Tested, ray: &SceneRay) {
        self.checked(property, tested.tests);
        for fault in tested.faults {
            self.fault(fault, ray);
        }
    }

    pub(super) fn fault(&mut self, fault: Fault, ray: &SceneRay) {
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

    pub(super) fn plus(mut self, other: Self) -> Self {
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

    pub(super) fn report(
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
