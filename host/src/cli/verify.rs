//! `gridel verify`: tests the properties of a scene.

use super::arguments::{self, GeometryOptions, check_quality, check_room, distinct_or};
use super::failure::Failure;
use super::output::{print, print_json_warned};
use super::progress::Progress;
use super::source::{Compiling, Source};
use clap::Args;
use gridel_core::Structure;
use gridel_host::compile::{self, Quality};
use gridel_host::table::{Align, Table, counted, grouped, significant};
use gridel_host::verify::{RAYS, Report, judge, steps, verify};
use std::fmt::Write;
use std::path::PathBuf;

/// Test a scene with hard rays
///
/// Traces rays at vertices of every kind, along edges, in the faces of boxes and cells, along axes
/// with both signs of zero, grazing, from far away, from inside, from surfaces, with huge and tiny
/// directions, and with intervals of t. The rays are the same in every run.
///
/// Compares every structure of the blob, in every number format, with brute force, and brute force
/// with double precision. Arithmetic of 320 bits, which shares no code with the kernels, judges all
/// rays that disagree and a sample of the others.
///
/// A scene passes if all of this holds. Every structure gives the bits of brute force. Any hit and
/// closest hit agree. Hits are those of exact arithmetic for a shape that is larger or smaller by at
/// most 8 steps. All numbers are finite. Secondary rays do not hit the surface that they leave.
/// Every shadow of f64 is there in the other formats. No ray leaks out of a closed mesh.
///
/// A step is a rounding of the largest coordinate (2^-24 of it in f32, 2^-53 in f64), or 2^-13 unit
/// in fixed.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// Blob or scene file, or `-` for standard input
    #[arg(value_name = "BLOB|SCENE")]
    input: PathBuf,

    /// Number of rays, and as many more from inside closed meshes; brute force traces each, so
    /// large scenes take long
    #[arg(long, value_name = "N", default_value_t = RAYS,
        value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    rays: u64,

    /// Acceleration structure for a scene file; give it again for each further one [default: all]
    #[arg(long, value_name = "NAME", value_parser = arguments::structure())]
    accel: Vec<Structure>,

    /// Time to spend on building wide, for a scene file [default: good]
    #[arg(long, value_name = "NAME")]
    quality: Option<Quality>,

    /// Print the report as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    geometry: GeometryOptions,
}

/// Verifies a scene.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = &arguments.input;
    let compiling = compile::Options {
        structures: distinct_or(&arguments.accel, &Structure::ALL),
        quality: arguments.quality.unwrap_or_default(),
        ..compile::Options::default()
    };
    check_quality(arguments.quality, &compiling.structures)?;
    check_room(arguments.geometry.room, &arguments.accel)?;
    let accel = (!arguments.accel.is_empty()).then_some("--accel");
    let other = accel.or(arguments.quality.map(|_| "--quality"));
    let options = arguments.geometry.clone().into();
    let compiling = Compiling {
        options: compiling,
        chosen: true,
    };
    let source = Source::open(input, &options, other, compiling)?;
    let scene = source.scene()?;
    let progress = Progress::steps("verifying", steps(arguments.rays));
    let report = verify(&scene, arguments.rays, &|| progress.step());
    drop(progress);
    if arguments.json {
        print_json_warned(&report, &source.warnings)?;
    } else {
        print(text(arguments, &report))?;
    }
    match report.broken() {
        0 => Ok(()),
        broken => Err(Failure::failed(
            format!(
                "{}: answers broke a property {} times",
                input.display(),
                grouped(broken)
            ),
            "`gridel explain` shows what the rays above meet; please report them with the scene",
        )),
    }
}

fn text(arguments: &Arguments, report: &Report) -> String {
    let [all, aimed_from] = [report.closed_meshes, report.closed_meshes_aimed_from];
    let inside = match aimed_from {
        0 => String::new(),
        _ if aimed_from == all => {
            format!(", and as many from inside {}", counted(all, "closed mesh"))
        }
        _ => format!(
            ", and as many from inside {} of {}",
            grouped(aimed_from),
            counted(all, "closed mesh")
        ),
    };
    let mut text = format!(
        "{}: {}{inside}, in {}\n\n",
        arguments.input.display(),
        counted(report.rays as usize, "ray"),
        report.structures.join(", ")
    );
    let mut table = Table::new([
        ("format", Align::Left),
        ("hits", Align::Right),
        ("judged exactly", Align::Right),
        ("t off by at most", Align::Right),
        ("where rays graze", Align::Right),
    ]);
    for format in &report.formats {
        table.row([
            format.format.to_owned(),
            grouped(format.hits),
            grouped(format.judged),
            format!("{} steps", significant(format.worst.error)),
            format!("{} steps", significant(format.worst_grazing.error)),
        ]);
    }
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{table}");
    let _ = writeln!(
        text,
        "A ray grazes a surface within {:.0} degrees of it: an error of one step of the surface is then \
         an error of many steps of t.\nThe surface is off by at most {} steps.",
        judge::GRAZING.asin().to_degrees(),
        judge::STEPS,
    );
    text.push_str(&worst_rays(arguments, report));
    let mut table = Table::new([
        ("property", Align::Left),
        ("checked", Align::Right),
        ("broken", Align::Right),
    ]);
    for property in &report.properties {
        table.row([
            property.text.to_owned(),
            grouped(property.checked),
            grouped(property.broken),
        ]);
    }
    let _ = write!(text, "\n{table}");
    for property in report.properties.iter().filter(|p| p.broken > 0) {
        let _ = writeln!(text, "\nBroken: {}", property.text);
        for example in &property.examples {
            let _ = writeln!(
                text,
                "  {} {}: {}\n    {}",
                example.format,
                example.structure,
                example.what,
                explain(arguments, &example.ray, example.format, example.structure)
            );
        }
    }
    text
}

/// The commands that explain the rays with the largest errors; nothing where no t is off.
fn worst_rays(arguments: &Arguments, report: &Report) -> String {
    let mut text = String::new();
    for format in &report.formats {
        for worst in [&format.worst, &format.worst_grazing] {
            if let Some(ray) = &worst.ray {
                let command = explain(arguments, ray, format.format, Structure::List.name());
                // Writing to a string cannot fail.
                let _ = writeln!(text, "  {command}");
            }
        }
    }
    match text.is_empty() {
        true => text,
        false => format!("The rays with the largest errors of t:\n{text}"),
    }
}

/// The command that explains a ray, in the scene as it was read here.
fn explain(arguments: &Arguments, ray: &str, format: &str, structure: &str) -> String {
    format!(
        "{} --ray={ray} --format {format} --accel {structure}",
        arguments.geometry.explain_command(&arguments.input)
    )
}
