//! `gridel compare`: structures side by side on a scene's own rays.

use super::arguments::TargetPoint;
use super::arguments::{
    self, SceneOptions, StructureOptions, check_hierarchy, check_room, distinct_or, scene_help,
    scene_long_help,
};
use super::failure::Failure;
use super::input::stem;
use super::output::{check_folder, print, print_json_warned, reject_foreign, write_texts};
use super::progress::Progress;
use super::source::{import, warn_of_file};
use clap::Args;
use gridel_core::{Format, Structure};
use gridel_host::compare::{
    CHARTS, CompareError, Comparison, Growth, Options, Work, Works, charts, compare, findings,
    growth, growth_steps, is_chart,
};
use gridel_host::compile::{self, Builder};
use gridel_host::picture_rays::MOST_RAYS;
use gridel_host::render::too_many_pixels;
use gridel_host::table::{Align, Table, counted, grouped};
use peak_alloc::PeakAlloc;
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// Compare acceleration structures on a scene
///
/// Compiles a blob for each structure, and traces the rays of the scene's own picture through all
/// of them: one sample per pixel, with shadow rays and bounced rays, which surfaces send on. Compares primitive and
/// t of every answer with brute force, bit for bit. A structure that differs is marked as wrong and
/// not measured, and the exit code is 1.
///
/// Times are medians on one thread, those of building among them; the structures take turns. A structure that has taken
/// a second to build is not built again. Memory while building is that on one thread, too. Findings compare times where
/// there are three runs and more. Compare times within one run only.
///
/// Instances are kept as `gridel render` keeps them, or copied with --instances flatten. Kept ones lie in a
/// hierarchy of boxes, which all structures share and which is counted with each; brute force tests every primitive
/// of a part that a ray enters. The charts of growth are made of copies.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    #[arg(help = scene_help(), long_help = scene_long_help())]
    scene: PathBuf,

    /// Acceleration structure to compare; give it again for each further one [default: all]
    #[arg(long, value_name = "NAME", value_parser = arguments::structure())]
    accel: Vec<Structure>,

    /// Builder of the hierarchies; give it again to compare builders [default: sah]
    #[arg(long, value_name = "NAME", value_parser = arguments::builder())]
    builder: Vec<Builder>,

    /// Number format
    #[arg(long, value_name = "NAME", value_parser = arguments::format(), default_value = "f32")]
    format: Format,

    /// Size of the picture whose rays are traced, such as 640x480
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "256x256")]
    size: [u16; 2],

    /// Number of timed runs; 0 counts tests only, which is faster
    #[arg(long, value_name = "N", default_value_t = 5,
        value_parser = clap::value_parser!(u16).range(0..=1000))]
    repeat: u16,

    /// Write SVG charts into this folder: tests, rates, and the growth of rates, build times and
    /// bytes with the scene. Replaces charts of an earlier run, and no other files
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    structure_options: StructureOptions,

    #[command(flatten)]
    scene_options: SceneOptions,

    #[command(flatten)]
    target_point: TargetPoint,
}

#[derive(Serialize)]
struct Report<'r> {
    scene: String,
    #[serde(flatten)]
    comparison: &'r Comparison,
    /// Sentences about the structures that do better than each.
    findings: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    growth: Option<&'r Growth>,
}

/// Compares structures on a scene.
pub fn run(arguments: &Arguments, memory: &PeakAlloc) -> Result<(), Failure> {
    let path = &arguments.scene;
    let options = options(arguments)?;
    // Each pixel casts a ray at least.
    if let Some(clause) = too_many_pixels(arguments.size, MOST_RAYS) {
        return Err(Failure::usage(clause, "ask for a smaller `--size`"));
    }
    let mut imported = import(
        path,
        &arguments
            .target_point
            .with_target(&arguments.scene_options)
            .sized(Some(arguments.size)),
    )?;
    if let Some(folder) = &arguments.plot {
        prepare(folder)?;
    }
    if !imported.scene.morph_targets.is_empty() {
        let sentence = "meshes with morph targets are compared as they are at rest";
        warn_of_file(path, vec![sentence.into()], &mut imported.warnings);
        imported.scene = compile::at_rest(&imported.scene).into_owned();
    }
    let options = Options {
        copied: imported.copied,
        memory: Some(memory),
        ..options
    };
    let failed = |error: CompareError| Failure::in_file(path, error);
    let more_steps = match &arguments.plot {
        Some(_) => growth_steps(&imported.scene, &options).map_err(failed)?,
        None => 0,
    };
    let progress = Progress::steps("comparing", options.steps());
    let comparison = compare(&imported.scene, &options, &|it| progress.pass(it)).map_err(failed)?;
    drop(progress);
    let mut warnings = imported.warnings;
    warn_of_file(path, comparison.warnings.clone(), &mut warnings);
    let mut report = Report {
        scene: path.display().to_string(),
        comparison: &comparison,
        findings: findings(&comparison),
        growth: None,
    };
    // What is measured is not lost if the growth fails.
    if !arguments.json {
        print(text(&report))?;
    }
    let grown = match &arguments.plot {
        Some(_) => {
            let progress = Progress::steps("comparing parts", more_steps);
            growth(&imported.scene, &options, &|it| progress.pass(it)).map(Some)
        }
        None => Ok(None),
    };
    if arguments.json {
        report.growth = grown.as_ref().ok().and_then(Option::as_ref);
        print_json_warned(&report, &warnings)?;
    }
    let grown = grown.map_err(failed)?;
    if let (Some(folder), Some(growth)) = (&arguments.plot, &grown) {
        let charts = charts(&stem(path), &comparison, growth).map_err(Failure::fault)?;
        write_texts(folder, &charts)?;
    }
    check_answers(&comparison, grown.as_ref())?;
    // If all structures are compared, some may not fit; a requested one must.
    match comparison.rejected.first() {
        Some(rejected) if !arguments.accel.is_empty() => Err(Failure::rejected(
            rejected.why.clone(),
            match rejected.structure == Structure::Grid.name() {
                true => "give it fewer cells, with `--grid`",
                false => "give it a larger `--budget`",
            },
        )),
        _ => Ok(()),
    }
}

/// Returns the options of the comparison, without its memory and whether it copies instances.
fn options(arguments: &Arguments) -> Result<Options<'static>, Failure> {
    let default = Options::default();
    let structures = distinct_or(&arguments.accel, &default.structures);
    check_hierarchy("--builder", !arguments.builder.is_empty(), &structures)?;
    let geometry = &arguments.scene_options.geometry;
    check_room(geometry.room, &structures)?;
    let lattice_bits = geometry.lattice_bits;
    let compiling = arguments.structure_options.apply(compile::Options {
        structures: structures.clone(),
        lattice_bits: lattice_bits.unwrap_or(default.compiling.lattice_bits),
        room: geometry.room.unwrap_or(0.0),
        texture_bytes: geometry.texture_bytes,
        ..default.compiling
    })?;
    Ok(Options {
        structures,
        format: arguments.format,
        size: arguments.size,
        builders: distinct_or(&arguments.builder, &default.builders),
        compiling,
        repeats: arguments.repeat.into(),
        ..default
    })
}

/// Returns an error if a structure answers otherwise than brute force.
fn check_answers(comparison: &Comparison, growth: Option<&Growth>) -> Result<(), Failure> {
    let steps = growth.iter().flat_map(|growth| &growth.steps);
    let of_steps = steps.flat_map(|step| &step.rows);
    let mut rows = comparison.rows.iter().chain(of_steps);
    match rows.find(|row| row.wrong.is_some()) {
        Some(row) => Err(Failure::failed(
            format!(
                "{} gives answers that differ from brute force",
                row.structure
            ),
            "this is a fault of gridel: report it with the scene file",
        )),
        None => Ok(()),
    }
}

/// Makes the folder of the charts, in which no other files are replaced.
fn prepare(folder: &Path) -> Result<(), Failure> {
    check_folder(folder)?;
    for name in CHARTS {
        reject_foreign(&folder.join(name), "chart of `gridel compare`", |path| {
            Ok(is_chart(&fs::read(path)?))
        })?;
    }
    fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, &error))
}

fn text(report: &Report<'_>) -> String {
    let comparison = report.comparison;
    let rays = comparison.rays;
    let mut text = format!(
        "{}: {}, {} by {} pixels, {}\n{} primary, {} shadow, {} bounced rays; \
         {} compared with brute force\n\n",
        report.scene,
        counted(comparison.primitives, "primitive"),
        comparison.size[0],
        comparison.size[1],
        comparison.format,
        grouped(rays.primary),
        grouped(rays.shadow),
        grouped(rays.bounced),
        grouped(comparison.listed),
    );
    if let Some(instances) = &comparison.instances {
        text.insert_str(text.len() - 1, &format!("{}\n", instances.text()));
    }
    let mut makes = Table::new([
        ("building and memory", Align::Left),
        ("SAH cost", Align::Right),
        ("set-up ms", Align::Right),
        ("peak KiB", Align::Right),
        ("own bytes", Align::Right),
        ("blob bytes", Align::Right),
        ("longest list", Align::Right),
        ("stack bytes", Align::Right),
    ]);
    for row in &comparison.rows {
        makes.row([
            row.name.clone(),
            row.sah_cost
                .map_or(String::from("-"), |cost| format!("{cost:.1}")),
            format!("{:.2}", 1e3 * row.setup_seconds),
            row.peak_bytes
                .map_or(String::from("-"), |bytes| grouped(bytes.div_ceil(1024))),
            grouped(row.own_bytes),
            grouped(row.blob_bytes),
            grouped(row.longest_list),
            grouped(row.stack_bytes),
        ]);
    }
    text += &format!("{makes}\n");
    text += &tests("a primary ray", comparison, |works| Some(works.primary));
    if rays.shadow > 0 {
        text += &tests("a shadow ray", comparison, |works| works.shadow);
    }
    if rays.bounced > 0 {
        text += &tests("a bounced ray", comparison, |works| works.bounced);
    }
    for finding in &report.findings {
        text += finding;
        text += ".\n";
    }
    text
}

/// Returns the table of the work of rays of one sort.
fn tests(title: &str, comparison: &Comparison, of: fn(&Works) -> Option<Work>) -> String {
    let with_instances = comparison.keeps_instances();
    let columns = [
        (title, Align::Left),
        ("planes", Align::Right),
        ("boxes", Align::Right),
        ("cells", Align::Right),
        ("primitives", Align::Right),
        ("instances", Align::Right),
        ("M rays/s", Align::Right),
        ("answers", Align::Left),
    ];
    let is_shown = |name: &str| with_instances || name != "instances";
    let mut table = Table::new(columns.into_iter().filter(|(name, _)| is_shown(name)));
    for row in &comparison.rows {
        let work = row.work.as_ref().and_then(of);
        let figure = |of: fn(&Work) -> f64| {
            work.as_ref()
                .map_or(String::from("-"), |work| format!("{:.2}", of(work)))
        };
        let rate = work.and_then(|work| work.rays_per_second);
        let instances = with_instances.then(|| figure(|work| work.instances.unwrap_or(0.0)));
        let tested = [
            row.name.clone(),
            figure(|work| work.planes),
            figure(|work| work.boxes),
            figure(|work| work.cells),
            figure(|work| work.primitives),
        ];
        let outcome = [
            rate.map_or(String::from("-"), |rate| format!("{:.3}", rate / 1e6)),
            match &row.wrong {
                None => String::from("equal"),
                Some(wrong) => format!("WRONG for {}: {}", counted(wrong.rays, "ray"), wrong.first),
            },
        ];
        table.row(tested.into_iter().chain(instances).chain(outcome));
    }
    format!("{table}\n")
}
