//! The scenes that blobs are compiled from.

use crate::arguments::rejected;
use crate::threads::in_pool;
use gridel_host::blob::Blob;
use gridel_host::compile::{Compiled, LATTICE_BITS, Options, Report, compile};
use gridel_host::scene::{RenderSettings, Scene};
use gridel_host::table::{counted, significant};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use std::ffi::CString;

/// What a scene is compiled from.
pub struct Model {
    pub scene: Scene,
    pub options: Options,
    /// Whether the scene is made of arrays alone.
    pub is_of_arrays: bool,
}

impl Model {
    /// Compiles it.
    pub fn compile(&self, py: Python<'_>) -> PyResult<Compiled> {
        in_pool(py, 0, || compile(&self.scene, &self.options))?.map_err(rejected)
    }

    /// Warns of primitives that the lattice leaves nothing of.
    pub fn warn_of_collapsed(&self, py: Python<'_>, report: &Report, level: i32) -> PyResult<()> {
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
        warn(py, &warning, level)
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

/// Issues a UserWarning, of a function so many levels up.
pub fn warn(py: Python<'_>, warning: &str, level: i32) -> PyResult<()> {
    let warning = CString::new(warning.replace('\0', " "))?;
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &warning, level)
}
