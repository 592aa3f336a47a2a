//! `gridel trace`: rays of the user's own, as NumPy arrays.

use super::arguments::{self, GeometryOptions, TraceOptions};
use super::failure::Failure;
use super::input::{is_standard, standard_input};
use super::names::{NameTable, hits_by_name, most_hit};
use super::output::{
    Content, Warned, check_extension, check_writable, json, print_about, reject_inputs,
    reject_same, write_files,
};
use super::progress::Progress;
use super::source::Source;
use super::threads;
use clap::Args;
use gridel_core::{Counters, Structure};
use gridel_host::npy::{read_rays, write_hits};
use gridel_host::table::grouped;
use gridel_host::trace::{
    MissingStructure, Query, Rejections, SceneHit, SceneRay, trace, trace_counted,
};
use rayon::ThreadPool;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Trace rays from a NumPy file through a blob or a scene file
///
/// Rays are a float32 or float64 array of shape (N, 8): origin x y z, tmin, direction x y z, tmax,
/// in scene units. The direction can have any length; t is in multiples of it. t of a hit is never
/// below tmin or above tmax. The number format rounds both, so it can find or miss a surface that is
/// as near to one of them as it rounds.
///
/// Hits are a structured array with the fields t (f8, inf for a miss), object and primitive (u4,
/// 0xffffffff for a miss, counted in the order of the scene file) and normal (3 f4 of length 1,
/// pointing outward; 0 for a miss). Those of a scene with instances have a field more behind
/// primitive: instance (u4, 0xffffffff for the scene's own objects).
///
/// A ray is rejected if it has a NaN, if its direction is zero, or if its origin or direction is infinite. It is
/// rejected, too, if tmin is greater than tmax, or if its origin is more than 2^37 units of the lattice away, 2^21
/// times the lattice's width (`gridel inspect` shows the unit). A ray whose closest hit has a t beyond double precision
/// is rejected; with --any, which needs no t, it is answered. t of a rejected ray is nan in the file. Rejected rays are
/// counted separately from misses. The first one is printed with its row and the reason.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// Blob or scene file, or `-` for standard input
    #[arg(value_name = "BLOB|SCENE")]
    input: PathBuf,

    /// Rays to trace, a NumPy file, or `-` for standard input
    #[arg(long, value_name = "RAYS.npy")]
    rays: PathBuf,

    /// Hits to write, a NumPy file; with `-` they go to standard output, and the counts to standard error, behind
    /// warnings
    #[arg(short, long, value_name = "HITS.npy")]
    output: PathBuf,

    #[command(flatten)]
    with: TraceOptions,

    /// Only test whether each ray hits anything; t, object, primitive and normal of a hit are 0
    #[arg(long)]
    any: bool,

    /// Number of timed runs, 1 to 1000
    #[arg(long, value_name = "N", default_value_t = 1,
        value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,

    /// Number of threads, 1 to 1024
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = arguments::threads())]
    threads: usize,

    /// Count the hits by name: print the objects with the most, or with --json all. With a file, as in
    /// --names=names.json, write the names of objects, materials, lights and instances there, and the primitives of
    /// each object, in place of the table
    #[arg(long, value_name = "NAMES.json", num_args = 0..=1, require_equals = true)]
    names: Option<Option<PathBuf>>,

    /// Print counts and times as JSON; an extra run, before the timed ones, counts the tests
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    geometry: GeometryOptions,
}

/// Rays that a thread takes at once; they count as one step of progress.
const CHUNK: usize = 4096;

/// The report of `trace`.
#[derive(Serialize)]
struct Traced {
    rays: usize,
    hits: usize,
    misses: usize,
    /// Rays that were not answered, neither among the hits nor the misses.
    rejected: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    first_rejected: Option<Rejected>,
    format: &'static str,
    accel: &'static str,
    any: bool,
    threads: usize,
    /// Seconds of each repeat, tracing alone.
    seconds: Vec<f64>,
    /// Rate of the fastest repeat.
    rays_per_second: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    counters: Option<Tests>,
    /// Number of hits of each object, by name. Present if names are written and hits have objects.
    #[serde(skip_serializing_if = "Option::is_none")]
    hits_by_name: Option<BTreeMap<String, usize>>,
}

/// A ray that was not answered.
#[derive(Serialize)]
struct Rejected {
    /// Counted from 0, as NumPy counts.
    row: usize,
    reason: String,
    remedy: &'static str,
}

/// Tests of all rays.
#[derive(Serialize)]
struct Tests {
    planes: u64,
    boxes: u64,
    /// Cells that rays entered.
    cells: u64,
    primitives: u64,
    /// Instances that rays entered.
    instances: u64,
}

/// Checks that input and output files are distinct, and that outputs can be written.
fn check_arguments(arguments: &Arguments) -> Result<(), Failure> {
    reject_same(&arguments.input, &arguments.output)?;
    reject_same(&arguments.rays, &arguments.output)?;
    check_extension(&arguments.output, &["npy"], "hits")?;
    check_writable(&arguments.output)?;
    if let Some(None) = arguments.names
        && arguments.any
    {
        return Err(Failure::usage(
            "--names counts hits by object, and --any finds no objects",
            "leave one of them out, or name a file: `--names=names.json`",
        ));
    }
    if let Some(Some(path)) = &arguments.names {
        reject_inputs(
            [
                arguments.input.as_path(),
                arguments.rays.as_path(),
                arguments.output.as_path(),
            ],
            [path],
            "a file of this command",
        )?;
        check_extension(path, &["json"], "names")?;
        if is_standard(path) {
            return Err(Failure::usage(
                "names cannot go to standard output, where the report goes",
                "name a file, such as `--names=names.json`",
            ));
        }
        check_writable(path)?;
    }
    if is_standard(&arguments.input) && is_standard(&arguments.rays) {
        return Err(Failure::usage(
            "scene and rays are both to come from standard input",
            "name a file for one of them",
        ));
    }
    Ok(())
}

/// Traces rays and writes what they hit.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    check_arguments(arguments)?;
    let options = arguments.geometry.clone().into();
    let source = Source::to_trace(&arguments.input, &options, &arguments.with, Structure::Wide)?;
    let names = arguments.names.iter().flatten();
    source.reject_lost(names.chain([&arguments.output]))?;
    let scene = source.scene()?;
    let query = Query {
        format: arguments.with.format,
        structure: source.structure(&scene, arguments.with.accel)?,
        any: arguments.any,
    };
    let rays = read(&arguments.rays)?;
    let pool = threads::start(arguments.threads)?;

    let passes = u64::from(arguments.repeat) + u64::from(arguments.json);
    let chunks = rays.len().div_ceil(CHUNK) as u64;
    let progress = Progress::steps("tracing", passes * chunks);
    let mut hits = vec![SceneHit::MISS; rays.len()];
    let pass = Pass {
        rays: &rays,
        pool: &pool,
        progress: &progress,
    };
    let mut counters = None;
    if arguments.json {
        let counted = pass.run(&mut hits, |rays, hits| {
            let mut counters = Counters::default();
            trace_counted(&scene, rays, query, hits, &mut counters).map(|_| counters)
        })?;
        let parts = counted.iter();
        counters = Some(parts.fold(Counters::default(), |sum, part| sum.plus(part)));
    }
    // The rejections of the last pass; all passes reject the same rays.
    let mut parts: Vec<Rejections> = Vec::new();
    let mut seconds = Vec::new();
    for _ in 0..arguments.repeat {
        let begun = Instant::now();
        parts = pass.run(&mut hits, |rays, hits| trace(&scene, rays, query, hits))?;
        seconds.push(begun.elapsed().as_secs_f64());
    }
    drop(progress);
    let names = source.names(&scene);
    let write_hits: Content<'_> = &|out| write_hits(out, &hits, !scene.instances().is_empty());
    match &arguments.names {
        Some(Some(path)) => {
            let table = json(&NameTable::of(&scene, &names))?;
            let write_names: Content<'_> = &|out| out.write_all(table.as_bytes());
            write_files(&[(&arguments.output, write_hits), (path, write_names)])?;
        }
        Some(None) | None => write_files(&[(&arguments.output, write_hits)])?,
    }

    let places = (0..).step_by(CHUNK);
    let rejections = places
        .zip(parts)
        .fold(Rejections::default(), |all, (place, part)| {
            all.followed_by(place, part)
        });
    let unmet = hits.iter().filter(|hit| hit.primitive == u32::MAX).count();
    let misses = unmet - rejections.count;
    let fastest = seconds.iter().copied().fold(f64::INFINITY, f64::min);
    let traced = Traced {
        rays: rays.len(),
        hits: rays.len() - unmet,
        misses,
        rejected: rejections.count,
        first_rejected: rejections.first.map(|(row, why)| Rejected {
            row,
            reason: why.to_string(),
            remedy: why.remedy(),
        }),
        format: query.format.name(),
        accel: query.structure.name(),
        any: query.any,
        threads: arguments.threads,
        rays_per_second: rays.len() as f64 / fastest.max(f64::MIN_POSITIVE),
        seconds,
        counters: counters.map(|counters| Tests {
            planes: counters.planes,
            boxes: counters.boxes,
            cells: counters.cells,
            primitives: counters.primitives,
            instances: counters.instances,
        }),
        hits_by_name: (arguments.names.is_some() && !query.any)
            .then(|| hits_by_name(&hits, &names)),
    };
    let report = match arguments.json {
        true => json(&Warned {
            value: &traced,
            warnings: &source.warnings,
        })?,
        false => traced.text(&arguments.output, matches!(arguments.names, Some(None))),
    };
    print_about(&arguments.output, report)
}

fn read(path: &Path) -> Result<Vec<SceneRay>, Failure> {
    if is_standard(path) {
        let rays = read_rays(&standard_input()?);
        return rays.map_err(|error| Failure::in_file(Path::new("<stdin>"), error));
    }
    let bytes = std::fs::metadata(path)
        .and_then(|metadata| match metadata.is_file() {
            true => std::fs::read(path),
            false => Err(io::Error::other("it is not a file")),
        })
        .map_err(|error| Failure::reading(path, &error))?;
    read_rays(&bytes).map_err(|error| Failure::in_file(path, error))
}

/// All rays, once.
struct Pass<'p> {
    rays: &'p [SceneRay],
    pool: &'p ThreadPool,
    /// Counts the chunks that are done.
    progress: &'p Progress,
}

impl Pass<'_> {
    /// Traces the rays in chunks, and returns what tracing each of them returns.
    fn run<T: Send>(
        &self,
        hits: &mut [SceneHit],
        trace: impl Fn(&[SceneRay], &mut [SceneHit]) -> Result<T, MissingStructure> + Sync,
    ) -> Result<Vec<T>, Failure> {
        let one = |(rays, hits): (&[SceneRay], &mut [SceneHit])| {
            let traced = trace(rays, hits);
            self.progress.step();
            traced.map_err(|error| Failure::usage(error.to_string(), "name one with `--accel`"))
        };
        if self.pool.current_num_threads() == 1 {
            let rays = self.rays.chunks(CHUNK);
            return rays.zip(hits.chunks_mut(CHUNK)).map(one).collect();
        }
        self.pool.install(|| {
            let rays = self.rays.par_chunks(CHUNK);
            rays.zip(hits.par_chunks_mut(CHUNK)).map(one).collect()
        })
    }
}

impl Traced {
    fn text(&self, output: &Path, with_names: bool) -> String {
        let mut text = format!(
            "{}: {} rays, {} hits, {} misses, {}, {}\n",
            output.display(),
            grouped(self.rays),
            grouped(self.hits),
            grouped(self.misses),
            self.format,
            self.accel
        );
        if let Some(Rejected {
            row,
            reason,
            remedy,
        }) = &self.first_rejected
        {
            text.push_str(&format!(
                "{} rejected; the first is row {row}: {reason}; {remedy}\n",
                grouped(self.rejected)
            ));
        }
        for seconds in &self.seconds {
            text.push_str(&format!(
                "{seconds:.6} s, {} rays per second\n",
                grouped((self.rays as f64 / seconds.max(f64::MIN_POSITIVE)).round())
            ));
        }
        if let Some(hits) = self.hits_by_name.as_ref().filter(|_| with_names) {
            text.push_str(&format!("\n{}", most_hit(hits)));
        }
        text
    }
}
