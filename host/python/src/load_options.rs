//! The options of `Scene.load`.

use crate::arguments::{invalid, structures};
use gridel_core::{Effects, Structure};
use gridel_host::compile::{LATTICE_BITS, Options, Quality};
use gridel_host::scene::{
    GltfOptions, ImportOptions, Imported, Instances, MoleculeOptions, MoleculeStyle, NormalsChoice,
    Posed, effect_named,
};
use pyo3::prelude::*;
use std::path::Path;
use std::str::FromStr;

/// The structure of scene files without `accel`.
const STRUCTURE: &str = "wide";

/// The options of `Scene.load`, a dictionary; `None` where Python gives none.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct LoadOptions {
    accel: Option<Vec<String>>,
    lattice_bits: Option<u8>,
    quality: Option<String>,
    without: Vec<String>,
    texture_bytes: Option<u64>,
    camera: Option<String>,
    animation: Option<String>,
    time: Option<f64>,
    instances: Option<String>,
    normals: Option<String>,
    assembly: Option<String>,
    style: Option<String>,
    model: Option<usize>,
    altloc: Option<char>,
    allow_outside: bool,
}

impl LoadOptions {
    /// The options of the compiler.
    pub fn for_compiler(&self) -> PyResult<Options> {
        let usual = || vec![STRUCTURE.to_owned()];
        let structures = structures(&self.accel.clone().unwrap_or_else(usual))?;
        let quality = self.quality.as_deref().map(quality).transpose()?;
        if quality.is_some() && !structures.contains(&Structure::Wide) {
            return Err(invalid(
                "`quality` is for the structure wide, which is not built; add \"wide\" to `accel`, or leave `quality` out",
            ));
        }
        Ok(Options {
            structures,
            lattice_bits: self.lattice_bits.unwrap_or(*LATTICE_BITS.end()),
            quality: quality.unwrap_or_default(),
            texture_bytes: self.texture_bytes,
            ..Options::default()
        })
    }

    /// The effects to leave out.
    pub fn without(&self) -> PyResult<Vec<Effects>> {
        self.without.iter().map(|name| effect(name)).collect()
    }

    /// The options of importers.
    pub fn for_import(&self) -> PyResult<ImportOptions> {
        let instances = self.instances.as_deref().map(instances).transpose()?;
        let default = MoleculeOptions::default();
        let style = self.style.as_deref().map(style).transpose()?;
        let normals = self.normals.as_deref().map(normals).transpose()?;
        Ok(ImportOptions {
            molecule: MoleculeOptions {
                style: style.unwrap_or(default.style),
                model: self.model.unwrap_or(default.model),
                altloc: self.altloc,
            },
            assembly: self.assembly.clone(),
            gltf: GltfOptions {
                camera: self.camera.clone(),
                animation: self.animation.clone(),
            },
            instances: instances.unwrap_or_default(),
            time: self.time,
            normals: normals.unwrap_or_default(),
            allow_outside: self.allow_outside,
        })
    }

    /// Rejects any option: a blob takes none.
    pub fn reject_for_blob(&self, path: &Path) -> PyResult<()> {
        let compiled = "is compiled already";
        let given = [
            (
                self.accel.is_some(),
                "accel",
                "holds its structures already",
            ),
            (
                self.lattice_bits.is_some(),
                "lattice_bits",
                "holds its coordinates already",
            ),
            (self.quality.is_some(), "quality", compiled),
            (!self.without.is_empty(), "without", compiled),
            (self.texture_bytes.is_some(), "texture_bytes", compiled),
            (self.camera.is_some(), "camera", compiled),
            (self.animation.is_some(), "animation", compiled),
            (self.time.is_some(), "time", compiled),
            (self.instances.is_some(), "instances", compiled),
            (self.normals.is_some(), "normals", compiled),
            (self.assembly.is_some(), "assembly", compiled),
            (self.style.is_some(), "style", compiled),
            (self.model.is_some(), "model", compiled),
            (self.altloc.is_some(), "altloc", compiled),
            (self.allow_outside, "allow_outside", compiled),
        ];
        match given.into_iter().find(|&(is_given, ..)| is_given) {
            Some((_, option, why)) => Err(invalid(format!(
                "{}: `{option}` is for scene files: a blob {why}; leave `{option}` out, or load the scene file that \
                 the blob was built from",
                path.display()
            ))),
            None => Ok(()),
        }
    }

    /// Rejects options that do not apply to the file that was read.
    pub fn check(&self, path: &Path, imported: &Imported, instances: Instances) -> PyResult<()> {
        let given = [
            (self.style.is_some(), "style"),
            (self.model.is_some(), "model"),
            (self.altloc.is_some(), "altloc"),
            (self.camera.is_some(), "camera"),
            (self.animation.is_some(), "animation"),
            (self.assembly.is_some(), "assembly"),
        ];
        let path = path.display();
        for (_, option) in given.into_iter().filter(|&(is_given, _)| is_given) {
            if let Some(why) = imported.kinds.inapplicable(option, &"the file") {
                return Err(invalid(format!(
                    "{path}: `{option}` {why}; leave `{option}` out"
                )));
            }
        }
        if self.time.is_none() {
            return Ok(());
        }
        let scene = &imported.scene;
        let is_flat = instances == Instances::Flatten;
        let moves = if is_flat {
            imported.posed.is_some()
        } else {
            scene.instances.iter().any(|it| it.joint.is_some())
                || scene.tracks.iter().any(|it| it.target.is_of_joint())
        };
        match (moves, is_flat) {
            (true, true) => Ok(()),
            (true, false) => Err(invalid(format!(
                "{path}: `time` says where copies of instances stand; add `instances=\"flatten\"`, or leave `time` out"
            ))),
            (false, _) => Err(invalid(format!(
                "{path}: no instance moves, so `time` has no effect; leave `time` out"
            ))),
        }
    }

    /// The importer's warnings, and what a scene keeps at rest although a time was given.
    pub fn warnings(&self, path: &Path, imported: &Imported) -> Vec<String> {
        let moves = imported.posed == Some(Posed::AtTime) && !imported.scene.tracks.is_empty();
        let at_rest = moves.then(|| {
            format!(
                "{}: `time` places copies of instances alone; camera, lights, materials and vertices stay as they are \
                 at rest",
                path.display()
            )
        });
        imported.warnings.iter().cloned().chain(at_rest).collect()
    }
}

fn quality(word: &str) -> PyResult<Quality> {
    one_of("quality", word, Quality::ALL, Quality::name)
}

fn effect(name: &str) -> PyResult<Effects> {
    effect_named(name).ok_or_else(|| {
        let names = Effects::NAMED.map(|(_, name)| name).join(", ");
        invalid(format!("unknown effect `{name}`; the effects are {names}"))
    })
}

fn instances(word: &str) -> PyResult<Instances> {
    one_of("instances", word, Instances::ALL, Instances::name)
}

fn style(word: &str) -> PyResult<MoleculeStyle> {
    one_of("style", word, MoleculeStyle::ALL, MoleculeStyle::name)
}

/// Returns the one of some things that a word names.
fn one_of<T: Copy, const N: usize>(
    option: &str,
    word: &str,
    all: [T; N],
    name: fn(T) -> &'static str,
) -> PyResult<T> {
    let found = all.into_iter().find(|&it| name(it) == word);
    found.ok_or_else(|| {
        let names = all.map(name).join(" or ");
        invalid(format!("unknown {option} `{word}`; use {names}"))
    })
}

fn normals(text: &str) -> PyResult<NormalsChoice> {
    let choice = NormalsChoice::from_str(text);
    choice.map_err(|remedy| invalid(format!("unknown normals `{text}`; {remedy}")))
}
