//! `gridel build`: a scene file becomes a blob.

use super::arguments::{self, SceneOptions, StructureOptions, TargetOptions};
use super::effects::CalledFor;
use super::failure::Failure;
use super::output::{print, print_json, refuse_same, warn, write_file};
use super::source::Source;
use clap::Args;
use gridel_core::{Format, Scene, Structure};
use gridel_host::board::Board;
use gridel_host::compile::{self, Builder, Figures, Report, Tabled};
use gridel_host::emit::{self, Emitted};
use gridel_host::report::{Align, Ledger, Table, grouped, power_of_two};
use serde::Serialize;
use std::path::PathBuf;

/// Compile a scene file into a blob
///
/// The scene is snapped to a lattice, an acceleration structure is built over it, and the effects
/// that it calls for are found. The blob is checked as a device would check it, and written whole
/// or not at all.
#[derive(Args)]
#[command(after_help = super::EXIT_CODES)]
pub struct Arguments {
    /// Scene file: .toml, .obj, .gltf, .glb, .stl, .ply, .nff, .pdb, .ent, .cif or .mmcif
    scene: PathBuf,

    /// The blob to write
    #[arg(short, long, value_name = "BLOB")]
    output: PathBuf,

    /// Acceleration structure, once for each that the blob shall hold; the list is always there
    #[arg(
        long,
        value_name = "NAME",
        value_parser = arguments::structure(),
        default_value = Structure::DualSplit.name()
    )]
    accel: Vec<Structure>,

    /// Make leaves of up to N primitives, 1 to 31, for fewer nodes and slower rays; where this is
    /// not given, what rays pay decides
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u8).range(1..=compile::LARGEST_LEAF as i64)
    )]
    leaf_size: Option<u8>,

    /// How the hierarchy is built that the structures share
    #[arg(long, value_name = "NAME", value_parser = arguments::builder(),
        default_value = Builder::Sah.name())]
    builder: Builder,

    /// Refuse to write a blob of more bytes, and say what to change; 64K and 1M are understood
    #[arg(long, value_name = "N", value_parser = arguments::bytes)]
    max_bytes: Option<u64>,

    /// Write the scene as a Rust module, scene.rs and scene.gridel, into this folder as well
    #[arg(long, value_name = "DIR")]
    emit_rust: Option<PathBuf>,

    /// Number format of the Rust module [default: the board's best, or fixed]
    #[arg(long, value_parser = arguments::format(), requires = "emit_rust")]
    format: Option<Format>,

    #[command(flatten)]
    target: TargetOptions,

    /// Print the report as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    structure_options: StructureOptions,

    #[command(flatten)]
    scene_options: SceneOptions,
}

/// What was built.
#[derive(Serialize)]
struct Built<'r> {
    blob: &'r str,
    bytes: usize,
    /// `None` without primitives.
    bytes_per_primitive: Option<f64>,
    objects: u32,
    primitives: u32,
    structures: Vec<&'static str>,
    stack_depth: usize,
    longest_leaf: u16,
    lattice_bits: u8,
    /// Scene units.
    step: f64,
    /// Scene units.
    largest_displacement: f64,
    collapsed: &'r [String],
    sah_cost: f64,
    effects: Vec<CalledFor>,
    supplied: &'r [String],
    tables: &'r [Tabled],
    warnings: &'r [String],
}

/// Builds a blob and reports on it.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    refuse_same(&arguments.scene, &arguments.output)?;
    let compiling = compile::Options {
        structures: arguments.accel.clone(),
        leaf_size: arguments.leaf_size.map_or(0, usize::from),
        builder: arguments.builder,
        max_bytes: arguments.max_bytes,
        ..compile::Options::default()
    };
    let compiling = arguments.structure_options.apply(compiling);
    let source = Source::compile(&arguments.scene, &arguments.scene_options, compiling)?;
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
    let ledger = target.map(|target| Ledger::of(&scene, source.blob.bytes(), &target, format));
    if let Some(ledger) = &ledger
        && let Some(shortage) = ledger.shortage()
    {
        return Err(Failure::refused(shortage, ledger.advice(&scene)));
    }
    if let Some(ledger) = ledger.as_ref().filter(|ledger| ledger.estimated) {
        warn(format!(
            "code and call stack were measured on boards through dual-split nodes; {} may take more",
            ledger.structure
        ));
    }
    write_file(&arguments.output, |out| out.write_all(source.blob.bytes()))?;
    if let Some(folder) = &arguments.emit_rust {
        let room = ledger.as_ref().zip(target).map(|(ledger, target)| {
            let code = ledger.flash.used - source.blob.bytes().len() as u64;
            (target.flash - code, target.board)
        });
        let emitted = Emitted {
            scene: &scene,
            structure: source.structure(&scene, None)?,
            format,
            budget: room,
        };
        std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, &error))?;
        let blob = source.blob.bytes();
        write_file(&folder.join(emit::BLOB), |out| out.write_all(blob))?;
        let text = emitted.module();
        write_file(&folder.join(emit::MODULE), |out| {
            out.write_all(text.as_bytes())
        })?;
    }

    let Some(report) = &source.report else {
        return Ok(());
    };
    let name = arguments.output.display().to_string();
    let built = Built::new(&name, &scene, report, &source.warnings);
    if arguments.json {
        print_json(&built)
    } else {
        print(built.text())
    }
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
            structures: Structure::ALL
                .into_iter()
                .filter(|&structure| scene.holds(structure))
                .map(Structure::name)
                .collect(),
            stack_depth: scene.stack_depth(),
            longest_leaf: header.longest_leaf,
            lattice_bits: header.lattice_bits,
            step: report.step,
            largest_displacement: report.largest_displacement,
            collapsed: &report.collapsed,
            sah_cost: report.sah_cost,
            effects: CalledFor::in_report(report),
            supplied: &report.supplied,
            tables: &report.tables,
            warnings,
        }
    }

    fn text(&self) -> String {
        let mut table = Table::untitled([Align::Left, Align::Left]);
        let mut line = |what: &str, value: String| table.row([what.to_owned(), value]);
        line("blob", self.blob.to_owned());
        let each = self.bytes_per_primitive;
        line(
            "bytes",
            match each {
                Some(each) => format!("{}, {each:.1} a primitive", grouped(self.bytes)),
                None => grouped(self.bytes),
            },
        );
        line(
            "holds",
            format!(
                "{} primitives of {} objects",
                grouped(self.primitives),
                grouped(self.objects)
            ),
        );
        line("structures", self.structures.join(", "));
        line(
            "limits",
            format!(
                "stack depth {}, longest leaf {}",
                self.stack_depth, self.longest_leaf
            ),
        );
        line("SAH cost", format!("{:.2}", self.sah_cost));
        line(
            "lattice",
            format!(
                "{} bits, step {}, largest displacement {:.3e} scene units",
                self.lattice_bits,
                power_of_two(self.step),
                self.largest_displacement
            ),
        );
        for lists in self.tables {
            let Figures {
                cells,
                entries,
                longest,
                bytes,
                ..
            } = lists.figures;
            line(
                "table",
                format!(
                    "{}: {} cells, {} lists, {} entries, {} in the longest, {} bytes",
                    lists.structure,
                    grouped(cells),
                    grouped(lists.figures.lists),
                    grouped(entries),
                    grouped(longest),
                    grouped(bytes)
                ),
            );
        }
        for (what, names) in [("supplied", self.supplied), ("collapsed", self.collapsed)] {
            for name in names {
                line(what, name.clone());
            }
        }
        if self.effects.is_empty() {
            line("effects", String::from("none"));
        }
        for effect in &self.effects {
            line("effect", effect.to_string());
        }
        table.to_string()
    }
}
