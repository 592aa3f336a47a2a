//! A blob and its scene.

use crate::problem::Problem;
use crate::request::{CameraOf, ShotOf};
use gridel_core::format::limits::MAX_SAMPLES;
use gridel_core::format::record::View;
use gridel_core::{BlobError, Scene, Settings};
use gridel_host::blob::{Blob, CheckedBlob, remedy_of};
use gridel_host::compile::Names;
use gridel_host::scene::Camera;
use gridel_host::view::Shot;
use serde_json::{Value, json};

/// A valid blob and its scene.
pub struct Loaded {
    blob: CheckedBlob,
    pub names: Names,
}

impl Loaded {
    /// Checks a blob, of a file with this name.
    pub fn new(blob: Blob, name: Option<&str>) -> Result<Self, Problem> {
        let blob = CheckedBlob::new(blob).map_err(|error| invalid(&error, name))?;
        let names = Names::of_blob(blob.scene(), blob.bytes());
        let names = names.map_err(|error| invalid(&error, name))?;
        Ok(Self { blob, names })
    }

    pub fn scene(&self) -> &Scene<'_> {
        self.blob.scene()
    }

    pub fn bytes(&self) -> &[u8] {
        self.blob.bytes()
    }

    /// Returns the data of it that a page shows.
    pub fn json(&self) -> Value {
        let scene = self.scene();
        let settings = Settings::of(scene);
        let header = scene.header();
        let structures: Vec<_> = scene.structures().map(|it| it.name()).collect();
        let effects: Vec<_> = scene.effects().names().collect();
        json!({
            "bytes": self.bytes().len(),
            "width": settings.width,
            "height": settings.height,
            "samples": settings.samples,
            "depth": settings.depth,
            "structures": structures,
            "effects": effects,
            "latticeBits": header.lattice_bits,
            "objects": header.objects,
            "primitives": header.primitives,
            "instances": scene.instances().len(),
        })
    }

    /// The view of a camera; the blob's own without one.
    pub fn view(&self, camera: Option<CameraOf>) -> Result<View, Problem> {
        let scene = self.scene();
        match camera {
            None => Ok(*scene.view()),
            Some(camera) => Camera::from(camera).in_blob(scene).map_err(Problem::of),
        }
    }

    /// Returns the requested picture.
    pub fn shot(&self, of: &ShotOf) -> Result<Shot, Problem> {
        Ok(Shot {
            view: self.view(of.camera)?,
            format: of.format.0,
            structure: of.structure.0,
            settings: Settings {
                width: of.width,
                height: of.height,
                samples: of.samples.clamp(1, MAX_SAMPLES),
                depth: of.depth,
                dither: false,
            },
            heat_map: of.heat_map,
        })
    }
}

fn invalid(error: &BlobError, name: Option<&str>) -> Problem {
    let help = remedy_of(error);
    match name {
        Some(name) => Problem::new(format!("{name}: {error}"), help),
        None => Problem::new(error, help),
    }
}
