//! The scenes that blobs are compiled from.

use crate::arguments::{in_python, rejected};
use crate::threads::in_pool;
use glam::DVec3;
use gridel_host::blob::Blob;
use gridel_host::compile::{Compiled, LATTICE_BITS, Options, Report, compile};
use gridel_host::scene::{RenderSettings, Scene, Shape};
use gridel_host::table::{counted, significant};
use pyo3::prelude::*;
use std::path::PathBuf;

/// The source that a scene is compiled from.
pub struct Model {
    pub scene: Scene,
    pub options: Options,
    /// The file that it was read from; `None` for arrays.
    pub file: Option<PathBuf>,
}

impl Model {
    /// Compiles it.
    pub fn compile(&self, py: Python<'_>) -> PyResult<Compiled> {
        in_pool(py, 0, || compile(&self.scene, &self.options))?.map_err(rejected)
    }

    /// Gives the compiler's warnings. Of arrays only primitives are reported that the lattice leaves nothing of.
    pub fn warn_of(&self, py: Python<'_>, report: &Report) -> PyResult<()> {
        if let Some(file) = &self.file {
            let warnings = report.warnings(self.options.lattice_bits);
            let mut warnings = warnings.iter().map(|it| in_python(it));
            return warnings.try_for_each(|it| warn(py, &format!("{}: {it}", file.display())));
        }
        if report.collapsed.count() == 0 {
            return Ok(());
        }
        let remedy = if self.options.lattice_bits < *LATTICE_BITS.end() {
            "use more lattice_bits"
        } else {
            "scale them up, or put them into a scene of their own"
        };
        let warning = format!(
            "{} left out: too small for the lattice, whose step is {}; {remedy}",
            counted(report.collapsed.count(), "primitive"),
            significant(report.step),
        );
        warn(py, &warning)
    }

    /// Returns whether all that the scene has is meshes of its own.
    pub fn is_meshes(&self) -> bool {
        let mut objects = self.scene.objects.iter();
        self.scene.instances.is_empty() && objects.all(|it| matches!(it.shape, Shape::Mesh { .. }))
    }

    /// The lowest and the highest corner of a scene that consists of meshes, of the vertices that faces use.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let scene = &self.scene;
        let is_larger = !scene.instances.is_empty() || scene.room.is_some();
        if is_larger || !scene.morph_targets.is_empty() {
            return None;
        }
        let mut corners: Option<[DVec3; 2]> = None;
        for object in &scene.objects {
            let Shape::Mesh {
                vertices,
                triangles,
            } = &object.shape
            else {
                return None;
            };
            for &corner in triangles.as_flattened() {
                let place = *vertices.get(corner as usize)?;
                let [low, high] = corners.unwrap_or([place; 2]);
                corners = Some([low.min(place), high.max(place)]);
            }
        }
        corners
    }

    /// Returns the scene for pictures of another shape, where the compiler chooses the camera by their shape.
    pub fn framed(&self, py: Python<'_>, size: [u16; 2]) -> PyResult<Option<Blob>> {
        let scene = &self.scene;
        let [width, height] = size.map(u32::from);
        let has_shape = scene.render.width * height == scene.render.height * width;
        if scene.camera.is_some() || has_shape {
            return Ok(None);
        }
        let render = RenderSettings {
            width,
            height,
            ..scene.render
        };
        let scene = Scene {
            render,
            ..scene.clone()
        };
        let compiled = in_pool(py, 0, || compile(&scene, &self.options))?;
        Ok(Some(compiled.map_err(rejected)?.blob))
    }
}

/// Issues a UserWarning at the line of whoever called the package, so that Python shows it once for each such line.
pub fn warn(py: Python<'_>, warning: &str) -> PyResult<()> {
    let warn = py.import("gridel._warnings")?.getattr("warn")?;
    warn.call1((warning,))?;
    Ok(())
}
