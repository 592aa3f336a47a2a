//! Gridel's structures against the crates that users would pick instead, and against Embree where
//! it is installed, on identical rays, interleaved in one run, on one thread.
//!
//! `cargo run --release --manifest-path tests/peers/Cargo.toml [-- OPTION...]`; `--features simd` and
//! `RUSTFLAGS='-C target-cpu=native'` for what this machine can do. `--help` tells of the options, and
//! where scenes come from. What is recorded in `fixtures/recorded/peers.json` makes the README's table.
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
mod workload;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use contender::{Contender, built, gridel};
use glam::Vec3;
use gridel_core::{Bvh, Flagged, Structure, Wide};
use gridel_host::compile::Quality;
use gridel_host::output::{Files, write_whole};
use gridel_host::report::{Align, Table, grouped};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use workload::{Answer, Geometry, Query, Rays, Workload};

/// What one contender did on one scene.
#[derive(Serialize)]
struct Line {
    contender: String,
    bytes_a_primitive: f64,
    build_seconds: f64,
    /// Of each kind of rays: millions a second, and how many answers are wrong.
    rates: Vec<f64>,
    wrong: Vec<usize>,
    /// Of the rays at the seams of a closed mesh.
    leaks: Option<usize>,
}

/// A whole run.
#[derive(Serialize)]
struct Run {
    build: &'static str,
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
    let build = match (cfg!(target_feature = "avx2"), cfg!(feature = "simd")) {
        (false, false) => "baseline x86-64",
        (false, true) => "baseline x86-64 with the feature `simd`",
        (true, false) => "AVX2 and FMA",
        (true, true) => "AVX2 and FMA with the feature `simd`",
    };
    println!("built for {build}; median of {repeats} repeats, one thread");
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
    for ((name, structure, blob, seconds), scene) in blobs.iter().zip(&scenes) {
        let bytes = blob.bytes().len();
        let name = name.clone();
        contenders.push(match structure {
            Structure::Bvh => gridel::<f32, Bvh>(name, *scene, bytes, *seconds),
            Structure::Flagged => gridel::<f32, Flagged>(name, *scene, bytes, *seconds),
            _ => gridel::<f32, Wide>(name, *scene, bytes, *seconds),
        });
    }
    let reference = gridel::<f64, Wide>(String::new(), scenes[double], 0, 0.0);

    let primary = workload.primary(settings.side.into());
    let hits = hits_of(&reference, &workload.geometry, &primary);
    let bounces = workload.bounces(&primary, &hits);
    let kinds = [
        Rays {
            kind: "primary",
            any: false,
            queries: primary,
        },
        Rays {
            kind: "bounce",
            any: false,
            queries: bounces.clone(),
        },
        Rays {
            kind: "shadow",
            any: true,
            queries: bounces,
        },
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
        let mut found = vec![Vec::new(); contenders.len()];
        for _ in 0..settings.repeats {
            for (number, contender) in contenders.iter().enumerate() {
                let started = Instant::now();
                found[number] = answers(contender, rays);
                times[number].push(started.elapsed().as_secs_f64());
            }
        }
        for ((line, times), found) in lines.iter_mut().zip(&mut times).zip(&found) {
            times.sort_by(f64::total_cmp);
            line.rates
                .push(rays.queries.len() as f64 / times[times.len() / 2] / 1e6);
            line.wrong.push(wrong(&expected, found, size));
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
    let mut answers = vec![Answer { t: f32::INFINITY }; rays.queries.len()];
    (contender.trace)(&rays.queries, rays.any, &mut answers);
    answers
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
    let rays = Rays {
        kind: "seams",
        any: false,
        queries: workload.at_seams(),
    };
    let answers = answers(contender, &rays);
    answers
        .iter()
        .filter(|answer| !answer.t.is_finite())
        .count()
}

/// Where rays hit, and the normal there.
fn hits_of(reference: &Contender<'_>, geometry: &Geometry, queries: &[Query]) -> Vec<(f32, Vec3)> {
    // A normal from three rays side by side would go wrong at edges; so from what lies nearest.
    let mut answers = vec![Answer { t: f32::INFINITY }; queries.len()];
    (reference.trace)(queries, false, &mut answers);
    let finder = obvhs::Nearest::of(geometry);
    queries
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
