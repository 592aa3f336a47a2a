//! What a verb works on: a scene blob, or a scene file that is compiled on the spot. Which of them
//! it is, the first bytes tell.

use super::arguments::SceneOptions;
use super::failure::Failure;
use super::output::warn;
use super::progress::Progress;
use gridel_core::{BlobError, Kind, Scene, Structure};
use gridel_host::blob::{self, Blob};
use gridel_host::compile::{self, Compiled};
use gridel_host::explain::Names;
use gridel_host::scene;
use std::path::{Path, PathBuf};

/// A blob, from wherever it came.
pub struct Source {
    path: PathBuf,
    pub blob: Blob,
    /// What compiling told, for a scene file.
    pub report: Option<compile::Report>,
    /// What the importer told.
    pub warnings: Vec<String>,
    /// What a scene file calls its objects.
    pub names: Names,
}

impl Source {
    /// Reads a blob, or compiles a scene file for `structure`, or else for the default.
    pub fn open(
        path: &Path,
        options: &SceneOptions,
        structure: Option<Structure>,
    ) -> Result<Self, Failure> {
        let mut compiling = compile::Options::default();
        if let Some(structure) = structure {
            compiling.structures = vec![structure];
        }
        Self::open_or_compile(path, options, compiling)
    }

    /// Reads a blob, or compiles a scene file; the lattice's bits are those of `options`.
    pub fn open_or_compile(
        path: &Path,
        options: &SceneOptions,
        compiling: compile::Options,
    ) -> Result<Self, Failure> {
        if !is_blob(path)? {
            return Self::compile(path, options, compiling);
        }
        if let Some(option) = options.given() {
            return Err(Failure::usage(
                format!(
                    "{option} is for scene files, and {} is a blob",
                    path.display()
                ),
                "leave the option out, or give the scene file that the blob was built from",
            ));
        }
        Ok(Self {
            path: path.to_owned(),
            blob: Blob::read(path).map_err(|error| Failure::reading(path, &error))?,
            report: None,
            warnings: Vec::new(),
            names: Names::default(),
        })
    }

    /// Compiles a scene file; the lattice's bits are those of `options`.
    pub fn compile(
        path: &Path,
        options: &SceneOptions,
        mut compiling: compile::Options,
    ) -> Result<Self, Failure> {
        if is_blob(path)? {
            return Err(Failure::failed(
                format!("{} is a blob already, not a scene file", path.display()),
                "give the scene file that it was built from; `gridel inspect` and `gridel render` \
                 take blobs",
            ));
        }
        if let Some(bits) = options.lattice_bits {
            compiling.lattice_bits = bits;
        }
        compiling.quality = options.quality.unwrap_or_default();
        let progress = Progress::unknown("compiling");
        let mut imported = scene::load(path, &options.molecule())
            .map_err(|error| Failure::Failed(miette::Report::new(error)))?;
        options.change(&mut imported.scene);
        let compiled = compile::compile(&imported.scene, &compiling);
        drop(progress);
        for warning in &imported.warnings {
            warn(warning);
        }
        let Compiled { blob, report } =
            compiled.map_err(|error| Failure::compiling(path, error))?;
        Ok(Self {
            path: path.to_owned(),
            blob,
            report: Some(report),
            warnings: imported.warnings,
            names: names(&imported.scene),
        })
    }

    /// The checked view of the blob.
    pub fn scene(&self) -> Result<Scene<'_>, Failure> {
        self.blob.scene().map_err(|error| {
            let remedy = match (&self.report, error) {
                (Some(_), _) => "this is a fault of gridel: report it with the scene file",
                (None, BlobError::Truncated { .. } | BlobError::Checksum { .. }) => {
                    "copy the file again, as binary, or build it again with `gridel build`"
                }
                (None, BlobError::Magic) => {
                    "blobs are made by `gridel build`; a scene file must have the extension of its format"
                }
                (None, _) => "build it again with `gridel build`",
            };
            Failure::failed(format!("{}: {error}", self.path.display()), remedy)
        })
    }

    /// The structure asked for, or else the best that the blob holds.
    pub fn structure(
        &self,
        scene: &Scene<'_>,
        asked: Option<Structure>,
    ) -> Result<Structure, Failure> {
        let mut held = blob::best_structures(scene);
        match asked {
            Some(structure) if scene.holds(structure) => Ok(structure),
            None => Ok(held.next().unwrap_or(Structure::List)),
            Some(structure) => {
                let held: Vec<_> = held.map(Structure::name).collect();
                Err(Failure::usage(
                    format!(
                        "{} holds no structure {}, only: {}",
                        self.path.display(),
                        structure.name(),
                        held.join(", ")
                    ),
                    format!("build it with `--accel {}`", structure.name()),
                ))
            }
        }
    }

    /// Warns of primitives that the lattice left nothing of, for verbs that do not name them.
    pub fn warn_of_collapsed(&self, scene: &Scene<'_>) {
        let kept: usize = Kind::ALL.iter().map(|&kind| scene.count(kind)).sum();
        let collapsed = scene.header().primitives as usize - kept;
        if collapsed > 0 && self.report.is_some() {
            warn(format!(
                "{}: the lattice is too coarse for {collapsed} primitives, which are left out; \
                 `gridel build` names them",
                self.path.display()
            ));
        }
    }
}

fn names(scene: &scene::Scene) -> Names {
    let material = |object: &scene::Object| scene.materials[object.material].name.clone();
    Names {
        objects: scene.objects.iter().map(|o| o.name.clone()).collect(),
        materials: scene.objects.iter().map(material).collect(),
    }
}

fn is_blob(path: &Path) -> Result<bool, Failure> {
    blob::is_blob(path).map_err(|error| Failure::reading(path, &error))
}
