//! The scene behind Python's: a blob, and what it was compiled from.

use crate::arguments::{format, invalid, not_held, structure};
use crate::closed::closed;
use crate::model::Model;
use crate::query::How;
use crate::rays::{Array, Middle, Rays, Slack};
use glam::DVec3;
use gridel_core::Scene;
use gridel_host::blob::{Blob, CheckedBlob, remedy_of};
use gridel_host::compile::Compiled;
use gridel_host::trace::Frame;
use pyo3::prelude::*;
use std::sync::OnceLock;

/// How much farther along a ray than across it the lattice may move a surface, in a search near the limits of rays: by
/// so much where they meet at an angle of one degree.
const SLACK: f64 = 64.0;

/// Parts of a scene's size by which number formats may round the t of a hit.
const ROUNDING: f64 = 1.0 / (1 << 22) as f64;

/// A step of the finest lattice, as a part of a scene's size: so far directions in single precision lead astray.
const STEP: f64 = 1.0 / (1 << 24) as f64;

/// A scene, compiled and checked.
#[pyclass(frozen, name = "NativeScene")]
pub struct NativeScene {
    pub(super) blob: CheckedBlob,
    /// The source that it was compiled from; `None` of a blob.
    pub(super) model: Option<Model>,
    /// The number of the first primitive of each object of `model`.
    pub(super) firsts: Vec<u32>,
    pub(super) displacement: f64,
    slack: Slack,
    /// How far from a triangle as it was given its hits are, in scene units: the lattice moved it.
    pub(super) moved: f64,
    pub(super) middle: Middle,
    pub(super) closed: OnceLock<Vec<bool>>,
    bounds: OnceLock<[DVec3; 2]>,
}

impl NativeScene {
    pub(super) fn of_blob(blob: Blob, model: Option<Model>, displacement: f64) -> PyResult<Self> {
        let blob = CheckedBlob::new(blob).map_err(|error| {
            let remedy = remedy_of(&error);
            invalid(format!("invalid scene blob: {error}; {remedy}"))
        })?;
        let scene = blob.scene();
        let (middle, size) = (Middle::of(scene), size(scene));
        let mut next = 0;
        let firsts = model
            .iter()
            .flat_map(|model| model.scene.all_objects())
            .map(|object| {
                let first = next;
                next += object.shape.primitives() as u32;
                first
            });
        let firsts = firsts.collect();
        let slack = SLACK * displacement.max(size * ROUNDING);
        let moved = match model {
            Some(_) => displacement.max(size * STEP),
            None => 0.0,
        };
        let from_behind = model.as_ref().is_some_and(Model::is_meshes);
        Ok(Self {
            blob,
            model,
            firsts,
            displacement,
            slack: Slack {
                length: slack,
                from_behind,
            },
            moved,
            bounds: OnceLock::new(),
            middle,
            closed: OnceLock::new(),
        })
    }

    pub(super) fn compiled(py: Python<'_>, model: Model) -> PyResult<Self> {
        let Compiled { blob, report } = model.compile(py)?;
        model.warn_of(py, &report)?;
        let collapsed = match report.collapsed.count() + report.flat_at_rest.count() {
            0 => 0.0,
            _ => report.step,
        };
        let displacement = report.largest_displacement.max(collapsed);
        py.detach(|| Self::of_blob(blob, Some(model), displacement))
    }

    pub(super) fn scene(&self) -> &Scene<'_> {
        self.blob.scene()
    }

    pub(super) fn how(
        &self,
        format_name: &str,
        accel: Option<&str>,
        threads: usize,
    ) -> PyResult<How> {
        let scene = self.scene();
        let structure = match accel {
            Some(name) => structure(name)?,
            None => scene.best_structure(),
        };
        if !scene.holds(structure) {
            return Err(not_held(structure, scene));
        }
        Ok(How {
            format: format(format_name)?,
            structure,
            threads,
        })
    }

    /// Which objects are closed, if any is.
    pub(super) fn closed(&self, py: Python<'_>, scene: &Scene<'_>) -> PyResult<&[bool]> {
        let found = match self.closed.get() {
            Some(found) => found,
            None => {
                // Found outside of the lock: who holds it may not wait for the GIL.
                let found = py.detach(|| closed(scene));
                self.closed.get_or_init(|| found)
            }
        };
        if !found.contains(&true) {
            return Err(invalid(
                "no object of the scene is closed; pass closed_only=False to count crossings all the same",
            ));
        }
        Ok(found)
    }

    /// The lowest and the highest corner of a box around the scene: of its vertices as they were given where it has
    /// nothing but meshes, else in whole steps of its coordinates.
    pub(super) fn corners_of_box(&self) -> [DVec3; 2] {
        let scene = self.scene();
        *self.bounds.get_or_init(|| {
            let given = self.model.as_ref().and_then(Model::bounds);
            given.unwrap_or_else(|| {
                let frame = Frame::of(scene);
                let sides = scene.bounds().0;
                [0, 1].map(|side| frame.place(sides.map(|it| f64::from(it[side]))))
            })
        })
    }

    /// The rays of an array.
    pub(super) fn rays<'a>(&self, array: &'a Array<'_>) -> PyResult<Rays<'a>> {
        Rays::rows(array.rows("rays")?, self.slack)
    }

    /// The scene with a structure chosen.
    pub(super) fn chosen(&self, how: How) -> PyResult<Scene<'_>> {
        let chosen = self.scene().choose(how.structure);
        chosen.ok_or_else(|| invalid("the structure is not there"))
    }
}

/// The longest side of a scene's box, in scene units.
fn size(scene: &Scene<'_>) -> f64 {
    let sides = scene.bounds().0;
    let lengths = sides.map(|[low, high]| f64::from(high) - f64::from(low));
    Frame::of(scene).length(lengths.into_iter().fold(0.0, f64::max))
}
