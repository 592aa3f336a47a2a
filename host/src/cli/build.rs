//! `gridel build`: a scene file becomes a blob.

use super::arguments::{
    self, SceneOptions, StructureOptions, TargetOptions, check_hierarchy, check_room, scene_help,
    scene_long_help,
};
use super::effects::CalledFor;
use super::failure::Failure;
use super::input::is_standard;
use super::output::{
    Content, check_extension, check_writable, json, print_about, reject_same, write_files,
};
use super::source::{Compiling, Source};
use clap::Args;
use gridel_core::{Format, Scene, Structure};
use gridel_host::blob::is_blob;
use gridel_host::compile::{
    self, Builder, EnvironmentFigures, Figures, KeptNames, LeftOut, Report, Supplied, TableStats,
    TextureFigures,
};
use gridel_host::emit::{self, Emitted};
use gridel_host::measure::InstanceCount;
use gridel_host::measure::board::Board;
use gridel_host::measure::board::{Account, MemoryReport};
use gridel_host::resolution::Unresolved;
use gridel_host::state::raised_materials;
use gridel_host::table::{Align, Table, counted, grouped, power_of_two};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::{fs, io};

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

/// The report of `build`.
#[derive(Serialize)]
struct Built<'r> {
    blob: &'r str,
    bytes: usize,
    /// `None` without primitives.
    bytes_per_primitive: Option<f64>,
    objects: u32,
    primitives: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    instances: Option<InstanceCount>,
    /// Bytes with the other treatment of instances, where that was compiled as well.
    #[serde(skip_serializing_if = "Option::is_none")]
    bytes_otherwise: Option<usize>,
    structures: Vec<&'static str>,
    stack_depth: usize,
    longest_leaf: u16,
    lattice_bits: u8,
    /// Scene units.
    step: f64,
    /// Scene units.
    largest_displacement: f64,
    collapsed: &'r LeftOut,
    without_area: &'r LeftOut,
    sah_cost: Option<f64>,
    effects: Vec<CalledFor>,
    /// The storage of each texture image.
    textures: &'r [TextureFigures],
    /// The storage of the environment.
    #[serde(skip_serializing_if = "Option::is_none")]
    environment: Option<EnvironmentFigures>,
    supplied: &'r [Supplied],
    tables: &'r [TableStats],
    /// Present if the scene has names that the blob is to have.
    #[serde(skip_serializing_if = "Option::is_none")]
    names: Option<KeptNames>,
    warnings: &'r [String],
    /// Objects that some formats do not resolve.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    unresolved: &'r [Unresolved],
    /// Present if a board is given.
    #[serde(rename = "memory_report", skip_serializing_if = "Option::is_none")]
    memory: Option<&'r MemoryReport>,
}

/// Left-out primitives that are named in the text; JSON names more.
const NAMED: usize = 5;

/// Builds a blob and reports on it.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    reject_same(&arguments.scene, &arguments.output)?;
    check_extension(&arguments.output, &["gridel", "bin"], "blob")?;
    if is_standard(&arguments.output) {
        check_writable(&arguments.output)?;
    } else {
        reject_foreign(&arguments.output, "blob", is_blob)?;
    }
    if let Some(folder) = &arguments.emit_rust {
        if folder.exists() && !folder.is_dir() {
            return Err(Failure::usage(
                format!("{} is not a folder", folder.display()),
                "give the folder that the module and its blob lie in; it need not exist",
            ));
        }
        reject_foreign(&folder.join(emit::BLOB), "blob", is_blob)?;
        reject_foreign(
            &folder.join(emit::MODULE),
            "module of Gridel",
            emit::is_module,
        )?;
    }
    let usual = compile::Options::default().structures;
    let chosen = !arguments.accel.is_empty();
    let accel = if chosen { &arguments.accel } else { &usual };
    check_hierarchy("--leaf-size", arguments.leaf_size.is_some(), accel)?;
    check_hierarchy("--builder", arguments.builder.is_some(), accel)?;
    check_room(arguments.scene_options.geometry.room, &arguments.accel)?;
    let compiling = arguments.structure_options.apply(compile::Options {
        structures: accel.clone(),
        leaf_size: arguments.leaf_size.map_or(0, usize::from),
        builder: arguments.builder.unwrap_or_default(),
        max_bytes: arguments.max_bytes,
        names: !arguments.strip_names
            && arguments.target.target().is_none()
            && arguments.emit_rust.is_none(),
        ..compile::Options::default()
    })?;
    let scene_options = arguments.target.with_target(&arguments.scene_options)?;
    let compiling = Compiling {
        options: compiling,
        chosen,
    };
    let source = Source::compile(&arguments.scene, &scene_options, compiling)?;
    source.reject_lost([&arguments.output])?;
    if let Some(folder) = &arguments.emit_rust {
        source.reject_lost([emit::BLOB, emit::MODULE].map(|name| folder.join(name)))?;
    }
    let scene = source.scene()?;
    let target = arguments.target.target();
    let board = target.map(|target| target.board);
    let format = arguments
        .format
        .unwrap_or_else(|| board.map_or(Format::Fixed, Board::format));
    if let Some(board) = board.filter(|board| !board.formats.contains(&format)) {
        let formats = board.formats.iter().map(|format| format.name());
        return Err(Failure::usage(
            format!(
                "{} would compute {} in software, which was not measured",
                board.name,
                format.name()
            ),
            format!("use {}", formats.collect::<Vec<_>>().join(" or ")),
        ));
    }
    let memory = arguments
        .target
        .memory_report(&scene, source.blob.bytes(), format)?;
    if let Some(report) = &memory {
        source.check_fits(&scene, report)?;
    }
    let blob = source.blob.bytes();
    let write_blob: Content<'_> = &|out| out.write_all(blob);
    if let Some(folder) = &arguments.emit_rust {
        let remains = memory.as_ref().and_then(|report| report.flash.remains());
        let room = remains
            .zip(target)
            .map(|(remains, target)| (remains + blob.len() as u64, target.board));
        // Firmware plays the blob's tracks as well.
        let raised = raised_materials(&scene, blob);
        let moving = scene.with_materials(&raised);
        let emitted = Emitted {
            scene: moving.as_ref().unwrap_or(&scene),
            structure: source.structure(&scene, None)?,
            format,
            blob: source.blob.bytes(),
            budget: room,
        };
        let is_new = !folder.exists();
        fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, &error))?;
        let text = emitted.module();
        let written = write_files(&[
            (&arguments.output, write_blob),
            (&folder.join(emit::BLOB), write_blob),
            (&folder.join(emit::MODULE), &|out| {
                out.write_all(text.as_bytes())
            }),
        ]);
        if written.is_err() && is_new {
            // Removes the files of a failed run, but not a folder that another program uses by now.
            let _ = fs::remove_dir(folder);
        }
        written?;
    } else {
        write_files(&[(&arguments.output, write_blob)])?;
    }

    let Some(report) = &source.report else {
        return Ok(());
    };
    let name = arguments.output.display().to_string();
    let unresolved = source.warn_of_unresolved(&scene, None);
    let instances = InstanceCount::of(&scene, source.copied);
    let mut built = Built {
        memory: memory.as_ref(),
        unresolved: &unresolved,
        bytes_otherwise: instances.and_then(|it| source.bytes_otherwise(&it)),
        instances,
        ..Built::new(&name, &scene, report, &source.warnings)
    };
    if let Some(memory) = &memory {
        for effect in &mut built.effects {
            effect.add_costs(&scene, memory);
        }
    }
    let report = match arguments.json {
        true => json(&built)?,
        false => built.text(),
    };
    print_about(&arguments.output, report)
}

/// Rejects to write over a file of another sort, such as the buffer of a glTF scene, or a program's own.
fn reject_foreign(
    path: &Path,
    sort: &str,
    is_one: impl Fn(&Path) -> io::Result<bool>,
) -> Result<(), Failure> {
    let is_foreign = match fs::metadata(path) {
        Ok(there) if there.is_file() && there.len() > 0 => {
            !is_one(path).map_err(|error| Failure::reading(path, &error))?
        }
        // Output to devices and pipes replaces nothing.
        _ => false,
    };
    if is_foreign {
        return Err(Failure::usage(
            format!(
                "{} exists and is not a {sort}: it would be overwritten",
                path.display()
            ),
            "write to another name or folder, or move that file away",
        ));
    }
    Ok(())
}

impl<'r> Built<'r> {
    fn new(blob: &'r str, scene: &Scene<'_>, report: &'r Report, warnings: &'r [String]) -> Self {
        let header = scene.header();
        Self {
            blob,
            bytes: report.bytes,
            bytes_per_primitive: (header.primitives > 0)
                .then(|| report.bytes as f64 / f64::from(header.primitives)),
            objects: header.objects,
            primitives: header.primitives,
            instances: None,
            bytes_otherwise: None,
            structures: Structure::ALL
                .into_iter()
                .filter(|&structure| scene.holds(structure))
                .map(Structure::name)
                .collect(),
            stack_depth: scene.stack_depth(),
            longest_leaf: super::inspect::longest_leaf(scene),
            lattice_bits: header.lattice_bits,
            step: report.step,
            largest_displacement: report.largest_displacement,
            collapsed: &report.collapsed,
            without_area: &report.without_area,
            sah_cost: report.sah_cost,
            effects: CalledFor::in_report(report),
            textures: &report.textures,
            environment: report.environment,
            supplied: &report.supplied,
            tables: &report.tables,
            names: report.names,
            warnings,
            unresolved: &[],
            memory: None,
        }
    }

    fn text(&self) -> String {
        let mut table = Table::untitled([Align::Left, Align::Left]);
        let mut line = |what: &str, value: String| table.row([what.to_owned(), value]);
        line("blob", self.blob.to_owned());
        let each = match (&self.instances, self.bytes_per_primitive) {
            (Some(instances), _) if instances.are_kept() => {
                let each = self.bytes as f64 / instances.placed_primitives.max(1) as f64;
                format!(", {each:.1} per placed primitive")
            }
            (_, Some(each)) => format!(", {each:.1} per primitive"),
            (_, None) => String::new(),
        };
        line("bytes", grouped(self.bytes) + &each);
        line(
            "holds",
            format!(
                "{} of {}",
                counted(self.primitives as usize, "primitive"),
                counted(self.objects as usize, "object")
            ),
        );
        if let Some(instances) = &self.instances {
            let otherwise = self
                .bytes_otherwise
                .map(|bytes| format!(", in {} bytes", grouped(bytes)));
            line(
                "instances",
                instances.text() + &otherwise.unwrap_or_default(),
            );
        }
        line("structures", self.structures.join(", "));
        line(
            "limits",
            format!(
                "stack depth {}, longest leaf {}",
                self.stack_depth, self.longest_leaf
            ),
        );
        if let Some(cost) = self.sah_cost {
            line("SAH cost", format!("{cost:.2}"));
        }
        line(
            "lattice",
            format!(
                "{} bits, step {}, largest displacement {}",
                self.lattice_bits,
                power_of_two(self.step),
                match self.largest_displacement {
                    0.0 => String::from("0"),
                    moved => format!("{moved:.3e} scene units"),
                }
            ),
        );
        for lists in self.tables {
            let Figures {
                cells,
                lists: different,
                entries,
                longest,
                bytes,
                ..
            } = lists.figures;
            line(
                "table",
                format!(
                    "{}: {}, {}, {}, {} in the longest, {}",
                    lists.structure,
                    counted(cells as usize, "cell"),
                    counted(different as usize, "list"),
                    counted(entries as usize, "entry"),
                    grouped(longest),
                    counted(bytes as usize, "byte")
                ),
            );
        }
        if let Some(KeptNames { names, bytes, .. }) = self.names.filter(|kept| kept.names > 0) {
            line(
                "names",
                format!(
                    "{}, {}; --strip-names leaves them out",
                    counted(names, "name"),
                    counted(bytes, "byte")
                ),
            );
        }
        for what in self.supplied {
            line("supplied", what.to_string());
        }
        for name in self.collapsed.names(NAMED) {
            line("collapsed", name);
        }
        for name in self.without_area.names(NAMED) {
            line("no area", name);
        }
        if self.effects.is_empty() {
            line("effects", String::from("none"));
        }
        for effect in &self.effects {
            line("effect", effect.to_string());
        }
        for texture in self.textures {
            line("texture", texture.to_string());
        }
        if let Some(environment) = self.environment {
            line("environment", environment.to_string());
        }
        if let Some(report) = self.memory {
            let remains = |account: &Account| {
                let rest = account.remains();
                let rest = rest.map_or(String::from("an unknown part"), grouped);
                format!("{rest} of {}", grouped(account.available))
            };
            line(
                report.board,
                format!(
                    "{} bytes of flash remain, and {} of RAM; `gridel inspect` shows what takes the \
                     others, and for which builds of the program that holds",
                    remains(&report.flash),
                    remains(&report.ram)
                ),
            );
        }
        table.to_string()
    }
}
