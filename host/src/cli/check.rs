//! `gridel check`: scenes and their memory, held to what is recorded.

use super::failure::Failure;
use super::output::{print, print_json, refuse_same, warn, write_file};
use super::progress::Progress;
use clap::Args;
use gridel_host::check::{self, Manifest, Outcome, Report};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Hold scenes to their recorded pictures and to budgets of memory and work
///
/// A manifest lists scenes or blobs, the hashes of their pictures or pictures that they must look
/// like, and the most that they may cost: bytes of the blob, working memory, entries of the stack,
/// tests a ray, instructions on a board that QEMU emulates. `cargo doc` documents the manifest
/// (`gridel_host::check`); the project's own is fixtures/check.toml.
///
/// What cannot be run here, because an emulator or a Rust target is missing, is neither held nor
/// broken, and is said not to have been run.
#[derive(Args)]
#[command(after_help = super::EXIT_CODES)]
pub struct Arguments {
    /// The manifest
    #[arg(value_name = "MANIFEST.toml")]
    manifest: PathBuf,

    /// Record what was found in place of what is broken, and print the change of the manifest;
    /// its comments and layout stay
    #[arg(long)]
    bless: bool,

    /// Write a picture for each that is broken: expected, rendered, and their difference, side by
    /// side, as far as there are
    #[arg(long, value_name = "DIR")]
    diff: Option<PathBuf>,

    /// Also write the findings as JUnit XML
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,

    /// Boards that cannot be run count as broken
    #[arg(long)]
    require_boards: bool,

    /// Print the findings as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Checked<'r> {
    manifest: String,
    held: usize,
    broken: usize,
    not_run: usize,
    /// Whether what was broken was recorded.
    blessed: bool,
    #[serde(flatten)]
    report: &'r Report,
}

/// Runs the checks of a manifest.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(junit) = &arguments.junit {
        refuse_same(&arguments.manifest, junit)?;
    }
    let manifest = Manifest::read(&arguments.manifest)
        .map_err(|error| Failure::Failed(miette::Report::new(error)))?;
    let progress = Progress::steps("checking", manifest.steps() as u64);
    let mut report = check::run(&manifest, &|| progress.step());
    drop(progress);
    if arguments.require_boards {
        for finding in &mut report.findings {
            if let Outcome::NotRun(why) = &finding.outcome {
                finding.outcome = Outcome::Broken(format!("it was not run: {why}"));
            }
        }
    }
    if let Some(folder) = &arguments.diff {
        write_evidence(folder, &report)?;
    }
    if let Some(path) = &arguments.junit {
        write_file(path, |out| report.write_junit(out))?;
    }
    let (held, broken, not_run) = (report.held(), report.broken(), report.not_run());
    if arguments.json {
        print_json(&Checked {
            manifest: arguments.manifest.display().to_string(),
            held,
            broken,
            not_run,
            blessed: arguments.bless,
            report: &report,
        })?;
    } else {
        let summary = format!("{held} held, {broken} broken, {not_run} not run\n");
        print(format!("{}{}{summary}", report.table(), reasons(&report)))?;
    }
    if not_run > 0 {
        warn(format!(
            "NOT RUN: {not_run} of the figures on boards; --require-boards makes that a failure"
        ));
    }
    if arguments.bless {
        return bless(&manifest, &report, arguments.json);
    }
    if broken > 0 {
        return Err(Failure::Broken);
    }
    Ok(())
}

/// Why things are as they are, where they are not held.
fn reasons(report: &Report) -> String {
    let mut text = String::from("\n");
    for finding in &report.findings {
        let (Outcome::Broken(why) | Outcome::NotRun(why)) = &finding.outcome else {
            continue;
        };
        let on = finding
            .on
            .as_ref()
            .map(|on| format!(" on {on}"))
            .unwrap_or_default();
        text += &format!("{}, {}{on}: {why}\n", finding.check, finding.what);
    }
    text
}

fn bless(manifest: &Manifest, report: &Report, json: bool) -> Result<(), Failure> {
    let blessed = check::bless(manifest, report);
    blessed
        .write()
        .map_err(|(path, error)| Failure::writing(&path, &error))?;
    // Standard output is one JSON document then.
    if !json {
        print(blessed.diff())?;
    }
    if blessed.left.is_empty() {
        return Ok(());
    }
    for what in &blessed.left {
        warn(format!("{what} cannot be recorded"));
    }
    Err(Failure::Broken)
}

fn write_evidence(folder: &Path, report: &Report) -> Result<(), Failure> {
    let evidence = report
        .findings
        .iter()
        .filter_map(|finding| finding.evidence.as_ref());
    for evidence in evidence {
        std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, &error))?;
        let path = folder.join(&evidence.name).with_extension("png");
        write_file(&path, |out| match &evidence.expected {
            Some(expected) => evidence.rendered.write_beside(expected, out),
            None => evidence.rendered.write(out),
        })?;
    }
    Ok(())
}
