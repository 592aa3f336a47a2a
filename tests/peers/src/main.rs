//! Gridel's structures against the crates that users would pick instead, and against Embree where
//! it is installed, on identical rays, interleaved in one run, on one thread.
//!
//! `cargo run --release --manifest-path tests/peers/Cargo.toml [-- OPTION...]`. `--help` tells of the
//! options, and where scenes come from. Gridel takes part as users have it: the default build, and the
//! function that `gridel trace` calls. What is recorded in `fixtures/recorded/peers.json` makes the
//! README's table.
//!
//! tinybvh takes part where its header `tiny_bvh.h` lies in the folder that `TINYBVH` names, or else in
//! this one, when the benchmark is built; it is compiled for AVX2 and FMA.
//!
//! Only ratios within one run mean anything. A rate is the median over the repeats, in which the
//! contenders take turns. An answer is wrong where it is a miss and Gridel's in double precision is
//! a hit, or the other way round, or the two t differ by more than a thousandth of the scene. A leak
//! is a ray from inside of a closed mesh that meets nothing.

#[cfg(feature = "bvh")]
mod bvh;
mod contender;
mod embree;
mod obvhs;
#[cfg(feature = "parry3d")]
mod parry;
#[cfg(tinybvh)]
mod tinybvh;
mod workload;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use contender::{Contender, built, gridel, kernel};
use glam::Vec3;
use gridel_core::{Format, SimdLevel, Structure};
use gridel_host::compile::Quality;
use gridel_host::output::{Files, write_whole};
use gridel_host::table::{Align, Table, grouped};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use workload::{Answer, Geometry, Rays, Workload};

/// The results of one contender on one scene.
#[derive(Serialize)]
struct Line {
    contender: String,
    bytes_a_primitive: f64,
    build_seconds: f64,
    /// For each kind of rays: millions per second, and how many answers are wrong.
    rates: Vec<f64>,
    wrong: Vec<usize>,
    /// Leaks of the rays at the seams of a closed mesh.
    leaks: Option<usize>,
}

/// A whole run.
#[derive(Serialize)]
struct Run {
    build: String,
    repeats: u32,
    scenes: Vec<Figures>,
}

/// One scene.
#[derive(Serialize)]
struct Figures {
    scene: String,
    primitives: usize,
    kinds: Vec<&'static str>,
    rays: Vec<usize>,
    lines: Vec<Line>,
}

/// Traces identical rays through Gridel's structures and through other libraries, and compares them
#[derive(Parser)]
#[command(after_help = NOTES)]
struct Settings {
    /// Measure this scene alone
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(workload::NAMES))]
    only: Option<String>,

    /// How often every contender traces all rays; the median counts
    #[arg(long, value_name = "N", default_value_t = 9,
        value_parser = clap::value_parser!(u32).range(1..))]
    repeats: u32,

    /// Pixels a side of the picture whose rays are the primary ones
    #[arg(long, value_name = "N", default_value_t = 512,
        value_parser = clap::value_parser!(u16).range(1..))]
    side: u16,

    /// Write the figures to this file, too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

const NOTES: &str = "\
Scenes come from the folder that GRIDEL_SCENES names, or else from ../shared/scenes beside the
repository. What is absent is left out, and said to be.

Exit codes:
  0  done
  1  failed: a scene cannot be used, or the file cannot be written
  2  the command line is wrong";

fn main() -> ExitCode {
    match run(&Settings::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

/// Measures and reports; or says what failed.
fn run(settings: &Settings) -> Result<(), String> {
    if let Some(path) = &settings.json {
        // Before minutes go into what is to be in it.
        Files::default()
            .add(path, |_| Ok(()))
            .map_err(|error| format!("{} cannot be written: {error}", path.display()))?;
    }
    let repeats = settings.repeats;
    let target = if cfg!(target_feature = "avx2") {
        "AVX2"
    } else {
        "the baseline of its architecture"
    };
    let build = format!(
        "built for {target}; gridel uses {}",
        gridel_host::simd::level().name()
    );
    println!("{build}; median of {repeats} repeats, one thread");
    if !cfg!(tinybvh) {
        println!("SKIPPED: tinybvh, whose header was not found when this was built");
    }
    let mut scenes = Vec::new();
    for workload in workload::workloads()? {
        let wanted = settings
            .only
            .as_ref()
            .is_none_or(|only| workload.name == *only);
        if wanted {
            let figures = compare(&workload, settings)?;
            println!("\n{}", figures.table());
            scenes.push(figures);
        }
    }
    if let Some(only) = &settings.only
        && scenes.is_empty()
    {
        return Err(format!(
            "the scene \"{only}\" is absent: GRIDEL_SCENES names the folder that scenes are in"
        ));
    }
    if let Some(path) = &settings.json {
        let run = Run {
            build,
            repeats,
            scenes,
        };
        let text = serde_json::to_string_pretty(&run).expect("figures are plain");
        write_whole(path, |file| writeln!(file, "{text}"))
            .map_err(|error| format!("{} cannot be written: {error}", path.display()))?;
    }
    Ok(())
}

fn compare(workload: &Workload, settings: &Settings) -> Result<Figures, String> {
    let blobs = [
        (Structure::Bvh, 24, Quality::Good),
        (Structure::Flagged, 24, Quality::Good),
        (Structure::Wide, 16, Quality::Good),
        (Structure::Wide, 24, Quality::Fast),
        (Structure::Wide, 24, Quality::Good),
        (Structure::Wide, 24, Quality::Best),
    ]
    .into_iter()
    .map(|(structure, bits, quality)| {
        let (blob, seconds) = built(workload, structure, bits, quality)?;
        let mut name = format!("gridel {}", structure.name());
        if structure == Structure::Wide {
            name = format!("{name}, {bits} bits, {quality:?}").to_lowercase();
        }
        Ok((name, structure, blob, seconds))
    })
    .collect::<Result<Vec<_>, String>>()?;
    let scenes: Vec<_> = blobs
        .iter()
        .map(|(_, _, blob, _)| blob.scene().expect("a sound blob"))
        .collect();
    let mut contenders = rivals(&workload.geometry);
    let double = blobs.len() - 1;
    const GOOD: usize = 4;
    for ((name, structure, blob, seconds), scene) in blobs.iter().zip(&scenes) {
        let bytes = blob.bytes().len();
        let name = name.clone();
        let how = (Format::F32, *structure);
        contenders.push(gridel(name, *scene, how, bytes, *seconds));
    }
    let (good, seconds) = (&blobs[GOOD].2, blobs[GOOD].3);
    let name = String::from("gridel wide, 24 bits, good: its kernel alone");
    contenders.push(kernel(name, scenes[GOOD], good.bytes().len(), seconds));
    let portable = scenes[GOOD].with_simd(SimdLevel::Portable);
    let name = String::from("gridel wide, 24 bits, good: without AVX2");
    let how = (Format::F32, Structure::Wide);
    contenders.push(gridel(name, portable, how, good.bytes().len(), seconds));
    let how = (Format::F64, Structure::Wide);
    let reference = gridel(String::new(), scenes[double], how, 0, 0.0);

    let primary = Rays::new("primary", false, workload.primary(settings.side.into()));
    let hits = hits_of(&reference, &workload.geometry, &primary);
    let bounces = workload.bounces(&primary.queries, &hits);
    let kinds = [
        primary,
        Rays::new("bounce", false, bounces.clone()),
        Rays::new("shadow", true, bounces),
    ];
    let size = workload.size();
    let mut lines: Vec<Line> = contenders
        .iter()
        .map(|contender| Line {
            contender: contender.name.clone(),
            bytes_a_primitive: contender.bytes as f64 / workload.primitives() as f64,
            build_seconds: contender.seconds,
            rates: Vec::new(),
            wrong: Vec::new(),
            leaks: (workload.name == workload::BALL).then(|| leaks(contender, workload)),
        })
        .collect();
    for rays in &kinds {
        let expected = answers(&reference, rays);
        let mut times = vec![Vec::new(); contenders.len()];
        let count = rays.queries.len();
        let mut outputs: Vec<_> = contenders.iter().map(|it| it.output(count)).collect();
        for _ in 0..settings.repeats {
            for ((contender, output), times) in contenders.iter().zip(&mut outputs).zip(&mut times)
            {
                let started = Instant::now();
                contender.trace(rays, output);
                times.push(started.elapsed().as_secs_f64());
            }
        }
        for ((line, times), output) in lines.iter_mut().zip(&mut times).zip(outputs) {
            times.sort_by(f64::total_cmp);
            line.rates
                .push(rays.queries.len() as f64 / times[times.len() / 2] / 1e6);
            line.wrong.push(wrong(&expected, &output.answers(), size));
        }
    }
    Ok(Figures {
        scene: workload.name.clone(),
        primitives: workload.primitives(),
        kinds: kinds.iter().map(|rays| rays.kind).collect(),
        rays: kinds.iter().map(|rays| rays.queries.len()).collect(),
        lines,
    })
}

/// The peers, built.
fn rivals(geometry: &Geometry) -> Vec<Contender<'static>> {
    let mut rivals = obvhs::contenders(geometry);
    rivals.extend(embree::contender(geometry));
    #[cfg(tinybvh)]
    if let Geometry::Triangles(triangles) = geometry {
        rivals.extend(tinybvh::contenders(triangles));
    }
    #[cfg(any(feature = "bvh", feature = "parry3d"))]
    if let Geometry::Triangles(triangles) = geometry {
        #[cfg(feature = "parry3d")]
        rivals.push(parry::contender(triangles));
        #[cfg(feature = "bvh")]
        rivals.push(bvh::contender(triangles));
    }
    rivals
}

fn answers(contender: &Contender<'_>, rays: &Rays) -> Vec<Answer> {
    let mut output = contender.output(rays.queries.len());
    contender.trace(rays, &mut output);
    output.answers()
}

fn wrong(expected: &[Answer], found: &[Answer], size: f32) -> usize {
    let pairs = expected.iter().zip(found);
    pairs
        .filter(|(expected, found)| {
            expected.t.is_finite() != found.t.is_finite()
                || expected.t.is_finite() && (expected.t - found.t).abs() > size * 1e-3
        })
        .count()
}

fn leaks(contender: &Contender<'_>, workload: &Workload) -> usize {
    let rays = Rays::new("seams", false, workload.at_seams());
    let answers = answers(contender, &rays);
    answers
        .iter()
        .filter(|answer| !answer.t.is_finite())
        .count()
}

/// Where rays hit, and the normal there.
fn hits_of(reference: &Contender<'_>, geometry: &Geometry, rays: &Rays) -> Vec<(f32, Vec3)> {
    // A normal from three rays side by side would go wrong at edges; so from what lies nearest.
    let answers = answers(reference, rays);
    let finder = obvhs::Nearest::of(geometry);
    rays.queries
        .iter()
        .zip(&answers)
        .map(|(query, answer)| {
            if answer.t.is_finite() {
                (answer.t, finder.normal(query))
            } else {
                (f32::INFINITY, Vec3::ZERO)
            }
        })
        .collect()
}

impl Figures {
    /// The rates with their ratio to those of the first contender in brackets, as users read them.
    fn rows(&self) -> impl Iterator<Item = [String; 8]> {
        let first = &self.lines[0];
        self.lines.iter().map(|line| {
            let rate = |kind: usize| {
                let rate = line.rates[kind];
                format!("{rate:.2} ({:.2})", rate / first.rates[kind])
            };
            [
                line.contender.clone(),
                rate(0),
                rate(1),
                rate(2),
                format!("{:.1}", line.bytes_a_primitive),
                format!("{:.0}", line.build_seconds * 1e3),
                line.wrong.iter().sum::<usize>().to_string(),
                line.leaks
                    .map_or(String::from("-"), |leaks| leaks.to_string()),
            ]
        })
    }

    fn titles(&self) -> [String; 8] {
        [
            format!("{}: {} primitives", self.scene, grouped(self.primitives)),
            self.kinds[0].to_owned(),
            self.kinds[1].to_owned(),
            self.kinds[2].to_owned(),
            String::from("bytes each"),
            String::from("build, ms"),
            String::from("wrong"),
            String::from("leaks"),
        ]
    }

    fn table(&self) -> String {
        let titles = self.titles();
        let mut columns = titles
            .each_ref()
            .map(|title| (title.as_str(), Align::Right));
        columns[0].1 = Align::Left;
        let mut table = Table::new(columns);
        for row in self.rows() {
            table.row(row);
        }
        table.to_string()
    }
}
