//! `gridel check`: compares scenes and their memory with recorded figures.

use super::failure::Failure;
use super::input::is_standard;
use super::output::{
    check_text_writable, print, print_aside, print_json, reject_inputs, warn, write_file,
    write_text_file,
};
use super::progress::Progress;
use clap::Args;
use gridel_host::check::{self, Manifest, Outcome, Recorded, Report};
use gridel_host::output::Files;
use gridel_host::table::{counted, printable};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Test scenes against recorded pictures and budgets of memory and work
///
/// A manifest lists scenes or blobs. Each has expected pictures, as hashes or as files, and budgets:
/// bytes of the blob, working memory, stack entries, tests per ray, flash, RAM and call stack of a
/// board, and instructions on an emulated board. `gridel help check` describes the manifest.
///
/// A board is skipped if its emulator or its Rust target is not installed.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// The manifest
    #[arg(value_name = "MANIFEST.toml")]
    manifest: PathBuf,

    /// Record the figures and pictures that were found, and print the change of the manifest.
    /// Comments and layout stay
    #[arg(long)]
    bless: bool,

    /// Write a picture of each failure into this folder: expected, rendered, and their difference,
    /// side by side
    #[arg(long, value_name = "DIR")]
    diff: Option<PathBuf>,

    /// Write the results as JUnit XML too; with `-` for standard output, the table goes to standard
    /// error
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,

    /// Fail if a board is skipped
    #[arg(long)]
    require_boards: bool,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Checked<'r> {
    manifest: String,
    passed: usize,
    failed: usize,
    /// Failures that are recorded now.
    recorded: usize,
    not_run: usize,
    #[serde(flatten)]
    report: &'r Report,
}

/// Runs the checks of a manifest.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if is_standard(&arguments.manifest) {
        return Err(Failure::usage(
            "`-` is standard input, and a manifest is read from a file",
            "name the file: its folder is where its paths begin; one that is called `-` is written `./-`",
        ));
    }
    let manifest = Manifest::read(&arguments.manifest)
        .map_err(|error| Failure::Failed(miette::Report::new(error)))?;
    prove_outputs(arguments, &manifest)?;
    let progress = Progress::steps("checking", manifest.steps() as u64);
    let mut report = check::run(&manifest, &|| progress.step());
    drop(progress);
    if arguments.require_boards {
        for finding in &mut report.findings {
            if let Outcome::NotRun(why) = &finding.outcome {
                finding.outcome = Outcome::Failed(format!("skipped: {why}"));
            }
        }
    }
    for warning in &report.warnings {
        warn(warning);
    }
    let references = manifest.pictures().filter(|_| arguments.bless);
    let outputs = outputs(arguments, &manifest).chain(references.map(Path::to_owned));
    let inputs = report.files.iter().map(PathBuf::as_path);
    reject_inputs(inputs, outputs, "a file that a scene reads")?;
    let records = arguments.bless.then(|| check::record(&manifest, &report));
    let staged = match &records {
        Some(records) => records.files(),
        None => Ok(Files::default()),
    };
    if let Some(records) = records.as_ref().filter(|_| staged.is_ok()) {
        records.note_in(&mut report);
    }
    // Everything runs, whatever fails. A report that cannot be written does not lose findings, and the findings set the
    // exit code in either case. The changes to recorded figures were printed before.
    let diff = records.as_ref().filter(|_| staged.is_ok());
    let diff = diff.map(Recorded::diff).unwrap_or_default();
    let printed = print_findings(arguments, &report, records.as_ref(), &diff);
    let shown = match &arguments.diff {
        Some(folder) => write_evidence(folder, &report),
        None => Ok(()),
    };
    let reported = match &arguments.junit {
        Some(path) => write_text_file(path, |out| report.write_junit(out)),
        None => Ok(()),
    };
    let recorded = staged
        .and_then(Files::keep)
        .map_err(|(path, error)| Failure::writing(&path, &error));
    let failure = match report.failed() {
        0 => Ok(()),
        _ => Err(Failure::Broken),
    };
    recorded.and(reported).and(shown).and(printed).and(failure)
}

/// All files that may be written, but what is recorded.
fn outputs(arguments: &Arguments, manifest: &Manifest) -> impl Iterator<Item = PathBuf> {
    let pictures = arguments.diff.iter().flat_map(|folder| {
        let names = manifest.evidence();
        names.map(move |name| picture(folder, name))
    });
    arguments.junit.iter().cloned().chain(pictures)
}

/// Rejects outputs that cannot be written or would overwrite an input, before any work.
fn prove_outputs(arguments: &Arguments, manifest: &Manifest) -> Result<(), Failure> {
    let (folder, junit) = (&arguments.diff, &arguments.junit);
    if arguments.json && junit.as_deref().is_some_and(is_standard) {
        return Err(Failure::usage(
            "--json and --junit cannot both go to standard output",
            "name a file for --junit",
        ));
    }
    let outputs = outputs(arguments, manifest);
    reject_inputs(manifest.inputs(), outputs, "a file that the checks read")?;
    if let Some(folder) = folder {
        std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, &error))?;
    }
    if let Some(path) = junit {
        check_text_writable(path)?;
    }
    Ok(())
}

/// Prints the findings, the figures that are recorded of them, and how that changes the manifest.
fn print_findings(
    arguments: &Arguments,
    report: &Report,
    records: Option<&Recorded>,
    diff: &str,
) -> Result<(), Failure> {
    let (passed, failed, recorded) = (report.passed(), report.failed(), report.recorded());
    let not_run = report.not_run();
    let printed = if arguments.json {
        print_json(&Checked {
            manifest: arguments.manifest.display().to_string(),
            passed,
            failed,
            recorded,
            not_run,
            report,
        })
    } else {
        let recorded = match records {
            Some(_) => format!("{recorded} recorded, "),
            None => String::new(),
        };
        let summary = format!("{passed} passed, {recorded}{failed} failed, {not_run} skipped\n");
        let reasons = reasons(report);
        let text = format!("{}{reasons}{summary}{diff}", report.table());
        // Standard output is the XML's alone, so that it can be read.
        match arguments.junit.as_deref().is_some_and(is_standard) {
            true => {
                print_aside(text);
                Ok(())
            }
            false => print(text),
        }
    };
    if not_run > 0 {
        warn(format!(
            "skipped {} on boards; --require-boards makes that a failure",
            counted(not_run, "figure")
        ));
    }
    for what in records.into_iter().flat_map(|records| &records.left) {
        warn(format!("{what} cannot be recorded"));
    }
    printed
}

/// Returns the reasons of failed and skipped checks, each once.
fn reasons(report: &Report) -> String {
    let mut lines = Vec::new();
    for finding in &report.findings {
        let (Outcome::Failed(why) | Outcome::NotRun(why)) = &finding.outcome else {
            continue;
        };
        let on = finding.on.as_ref().map(|on| format!(" on {on}"));
        let check = printable(&finding.check);
        let line = format!("{check}{}: {why}\n", on.unwrap_or_default());
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    format!("\n{}", lines.concat())
}

fn picture(folder: &Path, name: &str) -> PathBuf {
    folder.join(name).with_extension("png")
}

fn write_evidence(folder: &Path, report: &Report) -> Result<(), Failure> {
    let evidence = report
        .findings
        .iter()
        .filter_map(|finding| finding.evidence.as_ref());
    // All that can be written are.
    let written = evidence.map(|evidence| {
        write_file(&picture(folder, &evidence.name), |out| {
            match &evidence.expected {
                Some(expected) => evidence.rendered.write_beside(expected, out),
                None => evidence.rendered.write(out),
            }
        })
    });
    written.fold(Ok(()), Result::and)
}
