//! The input of a command: a scene blob, or a scene file that is compiled on the spot.
//! The first bytes distinguish them.

mod files;
mod size;
mod time;

pub use time::tick;

use super::arguments::{
    ImportOptions, LightChange, SceneOptions, TraceOptions, check_quality, check_room,
};
use super::changes::Changes;
use super::failure::Failure;
use super::input::Input;
use super::output::warn;
use super::progress::Progress;
use gridel_core::{BlobError, Effects, Format, Scene, Structure, Tracks};
use gridel_host::blob::{Blob, remedy_of};
use gridel_host::compile::{self, CompileError, Compiled, Names, Options};
use gridel_host::measure::Deforming;
use gridel_host::morphed::morph_targets;
use gridel_host::resolution::{FACTOR, Unresolved, unresolved};
use gridel_host::scene::{self, FileKinds, Imported, Posed, SourceSpan, Track, TrackTarget};
use gridel_host::table::{counted, grouped, printable, significant};
use std::path::{Path, PathBuf};

/// A blob, from a file or from the compiler.
pub struct Source {
    input: Input,
    pub blob: Blob,
    /// The compiler's report, for a scene file.
    pub report: Option<compile::Report>,
    /// The importer's warnings, and those about objects that the lattice moves far.
    pub warnings: Vec<String>,
    /// Sentences about rough materials of a scene file that show too little of a light in `fixed`.
    dim_in_fixed: Vec<String>,
    /// The changes to a blob.
    changes: Option<Changes>,
    /// The options for a blob's pictures, if some were given.
    for_pictures: Option<SceneOptions>,
    /// The names of a scene file.
    names: Option<Names>,
    /// The placements at which moving instances were copied, if they were.
    posed: Option<Posed>,
    /// The targets of the scene file's tracks, also of those that the blob has not: options replace them, or they move
    /// nothing.
    tracked: Vec<TrackTarget>,
    /// Number of instances of a scene file that were copied.
    pub copied: usize,
    /// Effects of a scene file that were left out.
    without: Effects,
    /// The files that a scene file was read from.
    files: Vec<PathBuf>,
    /// The options with which a scene file was read and compiled.
    made_by: Option<(scene::ImportOptions, compile::Options)>,
}

/// The options with which a scene file is compiled.
pub struct Compiling {
    pub options: compile::Options,
    /// True if the user chose the structures. Otherwise a scene with morph targets gets those that can be refitted.
    pub chosen: bool,
}

impl Source {
    /// Reads a blob, or compiles a scene file for the requested structure, or else for `usual`.
    pub fn to_trace(
        path: &Path,
        options: &SceneOptions,
        with: &TraceOptions,
        usual: Structure,
    ) -> Result<Self, Failure> {
        Self::to_view(path, options, with, &[usual])
    }

    /// Reads a blob, or compiles a scene file for the requested structure, or else for all of `usual`.
    pub fn to_view(
        path: &Path,
        options: &SceneOptions,
        with: &TraceOptions,
        usual: &[Structure],
    ) -> Result<Self, Failure> {
        check_room(options.geometry.room, with.accel.as_slice())?;
        let compiling = compile::Options {
            structures: with.accel.map_or(usual.to_vec(), |accel| vec![accel]),
            quality: with.quality.unwrap_or_default(),
            ..compile::Options::default()
        };
        let chosen = with.accel.is_some();
        let input = Input::open(path)?;
        let quality = with.quality.map(|_| "--quality");
        if quality.is_some() && !input.is_blob()? {
            check_quality(with.quality, &compiling.structures)?;
        }
        let other = options.geometry.given().or(quality);
        let compiling = Compiling {
            options: compiling,
            chosen,
        };
        let mut source = Self::read(input, options, other, compiling)?;
        if source.report.is_none() && options.given_for_pictures().is_some() {
            let changes = Changes::of(&source.scene()?, options)?;
            source.changes = Some(changes);
            source.for_pictures = Some(options.clone());
        }
        if let Some(seconds) = options.time.filter(|_| source.moves_otherwise()) {
            source.changes = Some(source.changes_at_time(seconds)?);
        }
        Ok(source)
    }

    /// Reads a blob, or compiles a scene file; the lattice's bits are those of `options`. A blob is rejected with
    /// options for scene files; `other` is one more that was given.
    pub fn open(
        path: &Path,
        options: &SceneOptions,
        other: Option<&'static str>,
        compiling: Compiling,
    ) -> Result<Self, Failure> {
        Self::read(
            Input::open(path)?,
            options,
            options.given().or(other),
            compiling,
        )
    }

    /// Reads a blob, unless an option was given that is for scene files; or compiles a scene file.
    fn read(
        input: Input,
        options: &SceneOptions,
        for_scenes: Option<&'static str>,
        compiling: Compiling,
    ) -> Result<Self, Failure> {
        if !input.is_blob()? {
            return Self::build(input, options, compiling);
        }
        if let Some(option) = for_scenes {
            return Err(Failure::usage(
                format!(
                    "{option} is for scene files, and {} is a blob",
                    input.path().display()
                ),
                "leave the option out, or give the scene file that the blob was built from",
            ));
        }
        Ok(Self {
            blob: input.blob()?,
            input,
            report: None,
            warnings: Vec::new(),
            dim_in_fixed: Vec::new(),
            changes: None,
            for_pictures: None,
            names: None,
            posed: None,
            tracked: Vec::new(),
            copied: 0,
            without: Effects::NONE,
            files: Vec::new(),
            made_by: None,
        })
    }

    /// Compiles a scene file; the lattice's bits are those of `options`.
    pub fn compile(
        path: &Path,
        options: &SceneOptions,
        compiling: Compiling,
    ) -> Result<Self, Failure> {
        Self::build(Input::open(path)?, options, compiling)
    }

    fn build(
        input: Input,
        options: &SceneOptions,
        Compiling {
            options: mut compiling,
            chosen,
        }: Compiling,
    ) -> Result<Self, Failure> {
        let (imported, tracked) = import_from(&input, options)?;
        if let Some(bits) = options.geometry.lattice_bits {
            compiling.lattice_bits = bits;
        }
        if let Some(room) = options.geometry.room {
            compiling.room = room;
        }
        // Of all structures only these can be refitted.
        let morphs = !chosen && !imported.scene.morph_targets.is_empty();
        if morphs || compiling.room > 0.0 {
            compiling.structures = Deforming::STRUCTURES.to_vec();
        }
        compiling.texture_bytes = options.geometry.texture_bytes.or(compiling.texture_bytes);
        let Compiled { blob, report } = compile_shown(&imported.scene, &compiling)
            .map_err(|error| Failure::compiling(input.path(), error))?;
        let names = Names::of_scene(&imported.scene);
        let mut warnings = imported.warnings;
        let sentences = report.warnings(compiling.lattice_bits);
        warn_of_file(input.path(), sentences, &mut warnings);
        Ok(Self {
            input,
            blob,
            report: Some(report),
            warnings,
            dim_in_fixed: compile::dim_reflections(&imported.scene),
            files: imported.files,
            changes: None,
            for_pictures: None,
            names: Some(names),
            posed: imported.posed,
            tracked,
            copied: imported.copied,
            without: options.geometry.import.left_out(),
            made_by: Some((options.for_import(), compiling)),
        })
    }

    /// The error of a blob that is not valid.
    fn invalid(&self, error: BlobError) -> Failure {
        let remedy = match self.report {
            Some(_) => "this is a fault of gridel: report it with the scene file",
            None => remedy_of(&error),
        };
        Failure::failed(format!("{}: {error}", self.input.path().display()), remedy)
    }

    /// Returns the checked view of the blob with the changes. Its names, tracks and morph targets are valid as well.
    pub fn scene(&self) -> Result<Scene<'_>, Failure> {
        let checked = self.blob.scene().and_then(|scene| {
            gridel_core::Names::from_bytes(self.blob.bytes())?;
            Tracks::from_bytes(self.blob.bytes())?;
            morph_targets(self.blob.bytes())?;
            match &self.changes {
                Some(changes) => changes.state.apply(&scene),
                None => Ok(scene),
            }
        });
        checked.map_err(|error| self.invalid(error))
    }

    /// Returns the names of a scene file, or those in the blob.
    pub fn names(&self, scene: &Scene<'_>) -> Names {
        let in_blob = || Names::of_blob(scene, self.blob.bytes()).unwrap_or_default();
        self.names.clone().unwrap_or_else(in_blob)
    }

    /// Returns the requested structure, or else the best that the blob holds.
    pub fn structure(
        &self,
        scene: &Scene<'_>,
        asked: Option<Structure>,
    ) -> Result<Structure, Failure> {
        match asked {
            Some(structure) if scene.holds(structure) => Ok(structure),
            None => Ok(scene.best_structure()),
            Some(structure) => {
                let held: Vec<_> = scene.structures().map(Structure::name).collect();
                Err(Failure::usage(
                    format!(
                        "{} has no structure {}, only: {}",
                        self.input.path().display(),
                        structure.name(),
                        held.join(", ")
                    ),
                    format!("build it with `--accel {}`", structure.name()),
                ))
            }
        }
    }
}

/// Warns of a file, and adds that to its other warnings.
pub fn warn_of_file(path: &Path, sentences: Vec<String>, warnings: &mut Vec<String>) {
    for sentence in sentences {
        let warning = format!("{}: {sentence}", path.display());
        warn(&warning);
        warnings.push(warning);
    }
}

/// Compiles a scene, and shows the progress.
fn compile_shown(scene: &scene::Scene, options: &Options) -> Result<Compiled, CompileError> {
    let progress = Progress::unknown("compiling");
    let on_progress = |structure: Structure, done: u64, of: u64| {
        let share = 100 * done / of.max(1);
        let cells = grouped(of);
        let name = structure.name();
        progress.show(&format!("compiling {name}: {share} % of {cells} cells"));
    };
    compile::compile_with_progress(scene, options, &on_progress)
}

/// Objects that a warning names; the rest are counted.
const NAMED: usize = 5;

impl Source {
    /// Warns of rough materials that show too little of a light in `fixed`, unless another format is chosen.
    pub fn warn_of_dim_reflections(&mut self, format: Option<Format>) {
        if format.is_some_and(|it| it != Format::Fixed) {
            return;
        }
        let sentences = std::mem::take(&mut self.dim_in_fixed);
        warn_of_file(self.input.path(), sentences, &mut self.warnings);
    }

    /// Warns of objects that a format does not resolve, or without one any of them, and returns them.
    pub fn warn_of_unresolved(&self, scene: &Scene<'_>, format: Option<Format>) -> Vec<Unresolved> {
        let mut found = unresolved(scene);
        if let Some(format) = format {
            let is_coarse =
                |it: &Unresolved| it.formats.iter().any(|it| it.format == format.name());
            found.retain(is_coarse);
        }
        let file = self.input.path().display();
        let names = self.names(scene);
        for it in found.iter().take(NAMED) {
            let name = names.object(it.object);
            let name = name.map_or(String::new(), |name| format!(" `{}`", printable(name)));
            let instance = it.instance.map_or(String::new(), |number| {
                let name = names.instance(number);
                let name = name.map_or(String::new(), |name| format!(" `{}`", printable(name)));
                format!(" in instance {number}{name}")
            });
            let remedy = match &it.resolved_by[..] {
                [] => String::from("make it larger, or leave out what makes the scene so large"),
                formats => format!(
                    "render it with `--format {}`",
                    formats.join("` or `--format ")
                ),
            };
            let bounds = it.formats.iter().map(|coarse| {
                let bound = significant(coarse.bound);
                format!("{} there ({bound} scene units)", coarse.format)
            });
            warn(format!(
                "{file}: object {}{name}{instance}: its smallest feature, {} scene units, is less than {FACTOR} \
                 error bounds of {}: contact shadows may be lost; {remedy}",
                it.object,
                significant(it.feature),
                bounds.collect::<Vec<_>>().join(" and of "),
            ));
        }
        if found.len() > NAMED {
            let more = counted(found.len() - NAMED, "more object");
            warn(format!("{file}: {more} likewise; --json names them"));
        }
        found
    }
}

/// Reads a scene file, warns of the parts that its importer ignored, and applies the options.
pub fn import(path: &Path, options: &SceneOptions) -> Result<Imported, Failure> {
    Ok(import_from(&Input::open(path)?, options)?.0)
}

/// Rejects a blob in place of a scene file.
fn reject_blob(input: &Input) -> Result<(), Failure> {
    if !input.is_blob()? {
        return Ok(());
    }
    let path = input.path();
    if !input.begins_as_blob()? {
        return Err(Failure::failed(
            format!(
                "{} has the name of a blob, but its content is not that of a blob",
                path.display()
            ),
            "if it is a scene file, rename it to the extension of its format, such as .toml",
        ));
    }
    Err(Failure::failed(
        format!("{} is a blob already, not a scene file", path.display()),
        "give the scene file that it was built from; `gridel inspect` and `gridel render` take \
         blobs",
    ))
}

/// Checks that the options for files of some kinds are given for such files.
fn check_options(options: &ImportOptions, kinds: FileKinds, path: &Path) -> Result<(), Failure> {
    let given = [
        options.molecule.given(),
        options.given_for_gltf(),
        options.given_for_assemblies(),
    ];
    for option in given.into_iter().flatten() {
        let name = option.trim_start_matches('-');
        if let Some(why) = kinds.inapplicable(name, &path.display()) {
            return Err(Failure::usage(
                format!("{option} {why}"),
                "leave the option out",
            ));
        }
    }
    Ok(())
}

/// Imports a scene file, and returns what its tracks move, those that options replace among them.
fn import_from(
    input: &Input,
    options: &SceneOptions,
) -> Result<(Imported, Vec<TrackTarget>), Failure> {
    reject_blob(input)?;
    let path = input.path();
    let importing = &options.geometry.import;
    let progress = Progress::unknown("reading");
    let imported = input.scene(&options.for_import());
    drop(progress);
    let mut imported = imported.map_err(|error| Failure::Failed(miette::Report::new(error)))?;
    check_options(importing, imported.kinds, path)?;
    imported.warnings.iter().for_each(warn);
    let lost = scene::leave_out(&mut imported.scene, &importing.without);
    warn_of_file(path, lost, &mut imported.warnings);
    if let Some(cutoff) = options.cutoff {
        imported.scene.render.cutoff = cutoff;
    }
    if let Some(exposure) = options.exposure {
        imported.scene.render.exposure = exposure;
    }
    if let Some(tone_mapping) = options.tone_mapping {
        imported.scene.render.tone_mapping = tone_mapping;
        // No file states it.
        imported.scene.places.tone_mapping = SourceSpan::default();
    }
    options.view.apply(&mut imported.scene)?;
    for change in &options.lights {
        change.apply_to_scene(&mut imported.scene)?;
    }
    let replaced = |track: &Track| {
        let by_light = |change: &LightChange| change.replaces(track.target, track.index);
        options.view.replaces(track.target) || options.lights.iter().any(by_light)
    };
    let tracked = imported.scene.tracks.iter().map(|it| it.target).collect();
    imported.scene.tracks.retain(|track| !replaced(track));
    Ok((imported, tracked))
}
