//! `gridel build`: a scene file becomes a blob.

mod report;

use super::arguments::{
    self, SceneOptions, StructureOptions, TargetOptions, check_hierarchy, check_room, scene_help,
    scene_long_help,
};
use super::effects::CalledFor;
use super::failure::Failure;
use super::input::is_standard;
use super::output::{
    Content, check_extension, check_folder, check_writable, json, print_about, reject_foreign,
    reject_same, write_files,
};
use super::source::{Compiling, Source};
use clap::Args;
use gridel_core::{Format, Scene, Structure};
use gridel_host::blob::{Blob, is_blob};
use gridel_host::compile::{self, Builder, Report};
use gridel_host::emit::{self, Emitted};
use gridel_host::measure::InstanceCount;
use gridel_host::measure::board::{Board, MemoryReport};
use gridel_host::output::place;
use gridel_host::state::raised_materials;
use report::Built;
use std::fs;
use std::path::{Path, PathBuf};

/// Compile a scene file into a blob
///
/// Snaps the scene to a lattice, builds an acceleration structure over it, and finds the effects
/// that it requires. The blob is checked as a device would check it. It is written completely or
/// not at all.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    #[arg(help = scene_help(), long_help = scene_long_help())]
    scene: PathBuf,

    /// Blob to write; with `-` it goes to standard output, and the report to standard error, behind
    /// warnings
    #[arg(short, long, value_name = "BLOB")]
    output: PathBuf,

    /// Acceleration structure of the blob; give it again for each further one. Every blob has the
    /// list [default: dual-split, or bvh where vertices move by --room or morph targets]
    #[arg(long, value_name = "NAME", value_parser = arguments::structure())]
    accel: Vec<Structure>,

    /// Largest number of primitives per leaf, 1 to 31; more means fewer nodes and slower rays
    /// [default: chosen by the estimated cost per ray]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u8).range(1..=compile::LARGEST_LEAF as i64)
    )]
    leaf_size: Option<u8>,

    /// Builder of the hierarchies [default: sah]
    #[arg(long, value_name = "NAME", value_parser = arguments::builder())]
    builder: Option<Builder>,

    /// Largest size of the blob in bytes, such as 65536, 64K or 1M; a larger blob is rejected with
    /// advice [default: no limit]
    #[arg(long, value_name = "N", value_parser = arguments::bytes)]
    max_bytes: Option<u64>,

    /// Write a Rust module (scene.rs and scene.gridel) into this folder too. Overwrites files from
    /// an earlier run. Add `mod scene;` to your crate
    #[arg(long, value_name = "DIR")]
    emit_rust: Option<PathBuf>,

    /// Leave out the names of objects, materials and lights [default: the blob has them, unless it is
    /// for a board (--target, --ram, --flash, --emit-rust) or exceeds --max-bytes with them]
    #[arg(long)]
    strip_names: bool,

    /// Print the report as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    target: TargetOptions,

    /// Number format of the Rust module [default: the board's best, or fixed]
    #[arg(long, value_parser = arguments::format(), requires = "emit_rust",
        help_heading = "Options for boards")]
    format: Option<Format>,

    #[command(flatten)]
    structure_options: StructureOptions,

    #[command(flatten)]
    scene_options: SceneOptions,
}

/// Builds a blob and reports on it.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    check_outputs(arguments)?;
    let format = format(arguments)?;
    let scene_options = arguments.target.with_target(&arguments.scene_options)?;
    let mut source = Source::compile(&arguments.scene, &scene_options, compiling(arguments)?)?;
    source.warn_of_dim_reflections(None);
    source.reject_lost([&arguments.output])?;
    if let Some(folder) = &arguments.emit_rust {
        source.reject_lost([emit::BLOB, emit::MODULE].map(|name| folder.join(name)))?;
    }
    let scene = source.scene()?;
    let memory = arguments
        .target
        .memory_report(&scene, source.blob.bytes(), format)?;
    if let Some(report) = &memory {
        source.check_fits(&scene, report)?;
    }
    // Firmware plays the blob's tracks as well.
    let raised = raised_materials(&scene, source.blob.bytes());
    let moving = scene.with_materials(&raised);
    let moving = moving.as_ref().unwrap_or(&scene);
    match &arguments.emit_rust {
        Some(folder) => {
            let names = source.names(moving);
            let emitted = Emitted {
                scene: moving,
                names: &names,
                structure: source.structure(&scene, None)?,
                format,
                blob: source.blob.bytes(),
                budget: budget(arguments, &source.blob, memory.as_ref()),
            };
            write_module(&arguments.output, folder, &emitted)?;
        }
        None => write_files(&[(&arguments.output, &|out| out.write_all(source.blob.bytes()))])?,
    }
    match &source.report {
        Some(report) => print_report(
            arguments,
            (&source, report),
            [&scene, moving],
            memory.as_ref(),
        ),
        None => Ok(()),
    }
}

/// Rejects outputs that cannot be written, or would replace files of another sort.
fn check_outputs(arguments: &Arguments) -> Result<(), Failure> {
    reject_same(&arguments.scene, &arguments.output)?;
    check_extension(&arguments.output, &["gridel", "bin"], "blob")?;
    if !is_in_new_folder(arguments) {
        check_writable(&arguments.output)?;
    }
    if !is_standard(&arguments.output) {
        reject_foreign(&arguments.output, "blob", is_blob)?;
    }
    let Some(folder) = &arguments.emit_rust else {
        return Ok(());
    };
    check_folder(folder)?;
    if folder.exists() && !folder.is_dir() {
        return Err(Failure::usage(
            format!("{} is not a folder", folder.display()),
            "give the folder that the module and its blob lie in; it need not exist",
        ));
    }
    if folder.exists() {
        check_writable(&folder.join(emit::BLOB))?;
    }
    reject_foreign(&folder.join(emit::BLOB), "blob", is_blob)?;
    reject_foreign(
        &folder.join(emit::MODULE),
        "module of Gridel",
        emit::is_module,
    )
}

/// Returns true if the blob is to lie in the module's folder, which does not exist yet.
fn is_in_new_folder(arguments: &Arguments) -> bool {
    let folder = arguments.emit_rust.as_deref().filter(|it| !it.exists());
    let parent = arguments.output.parent();
    folder.is_some_and(|folder| parent.is_some_and(|it| place(it) == place(folder)))
}

/// Returns the options for the compiler.
fn compiling(arguments: &Arguments) -> Result<Compiling, Failure> {
    let usual = compile::Options::default().structures;
    let chosen = !arguments.accel.is_empty();
    let accel = if chosen { &arguments.accel } else { &usual };
    check_hierarchy("--leaf-size", arguments.leaf_size.is_some(), accel)?;
    check_hierarchy("--builder", arguments.builder.is_some(), accel)?;
    check_room(arguments.scene_options.geometry.room, &arguments.accel)?;
    let options = arguments.structure_options.apply(compile::Options {
        structures: accel.clone(),
        leaf_size: arguments.leaf_size.map_or(0, usize::from),
        builder: arguments.builder.unwrap_or_default(),
        max_bytes: arguments.max_bytes,
        names: !arguments.strip_names
            && arguments.target.target().is_none()
            && arguments.emit_rust.is_none(),
        ..compile::Options::default()
    })?;
    Ok(Compiling { options, chosen })
}

/// Returns the number format of the module and of the memory report.
fn format(arguments: &Arguments) -> Result<Format, Failure> {
    let board = arguments.target.target().map(|target| target.board);
    let format = arguments
        .format
        .unwrap_or_else(|| board.map_or(Format::Fixed, Board::format));
    match board.filter(|board| !board.formats.contains(&format)) {
        None => Ok(format),
        Some(board) => {
            let formats = board.formats.iter().map(|format| format.name());
            Err(Failure::usage(
                format!(
                    "{} would compute {} in software, which was not measured",
                    board.name,
                    format.name()
                ),
                format!("use {}", formats.collect::<Vec<_>>().join(" or ")),
            ))
        }
    }
}

/// Returns how large a blob can be on the board of the arguments.
fn budget(
    arguments: &Arguments,
    blob: &Blob,
    memory: Option<&MemoryReport>,
) -> Option<(u64, &'static Board)> {
    let remains = memory?.flash.remains()?;
    let target = arguments.target.target()?;
    Some((remains + blob.bytes().len() as u64, target.board))
}

/// Writes a blob, and a Rust module with a copy of it into a folder: all of them or none.
fn write_module(output: &Path, folder: &Path, emitted: &Emitted<'_>) -> Result<(), Failure> {
    let is_new = !folder.exists();
    fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, &error))?;
    let write_blob: Content<'_> = &|out| out.write_all(emitted.blob);
    let text = emitted.module();
    let written = write_files(&[
        (output, write_blob),
        (&folder.join(emit::BLOB), write_blob),
        (&folder.join(emit::MODULE), &|out| {
            out.write_all(text.as_bytes())
        }),
    ]);
    if written.is_err() && is_new {
        // Removes the files of a failed run, but not a folder that another program uses by now.
        let _ = fs::remove_dir(folder);
    }
    written
}

/// Prints what was built, from a source and the compiler's report on it.
fn print_report(
    arguments: &Arguments,
    (source, report): (&Source, &Report),
    [scene, moving]: [&Scene<'_>; 2],
    memory: Option<&MemoryReport>,
) -> Result<(), Failure> {
    let name = arguments.output.display().to_string();
    let unresolved = source.warn_of_unresolved(scene, None);
    let instances = InstanceCount::of(scene, source.copied);
    let mut built = Built::new(&name, scene, report, &source.warnings);
    let bytes = source.blob.bytes();
    built.effects = CalledFor::at_all_times(Some(report), scene, moving, bytes);
    built.memory = memory;
    built.unresolved = &unresolved;
    built.bytes_otherwise = instances.and_then(|it| source.bytes_otherwise(&it));
    built.instances = instances;
    if let Some(memory) = memory {
        for effect in &mut built.effects {
            effect.add_costs(moving, memory);
        }
    }
    let report = match arguments.json {
        true => json(&built)?,
        false => built.text(),
    };
    print_about(&arguments.output, report)
}
