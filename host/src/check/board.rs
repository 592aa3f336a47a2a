//! Programs on emulated boards.

use super::manifest::{Board, Firmware, Manifest, Named, Program};
use crate::blob::Blob;
use crate::explained;
use crate::output::unfinished::{Running, TemporaryFolder};
use crate::table::grouped;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// The outcome of a program's run.
pub(super) enum BoardRun {
    /// It printed these figures, and wrote a picture if it should.
    Printed(Figures, Result<Vec<u8>, String>),
    /// The emulator or a file is missing.
    NotRun(String),
    /// It could not be built, or it failed.
    Failed(String),
}

/// The output of a program by name: a figure, or the text in place of one.
pub(super) type Figures = BTreeMap<String, Result<u64, String>>;

/// The figures and the picture of a program that ran.
type Output = (Figures, Result<Vec<u8>, String>);

/// The reason why a program did not run to its end.
enum Obstacle {
    Missing(String),
    Failure(String),
}

/// The first bytes of an ELF file.
const ELF: [u8; 4] = *b"\x7fELF";

/// Longest text of a failing program that is shown: its end.
const SHOWN: usize = 2000;

/// Most bytes that a program may print: a loop without an end would fill the disk.
const MOST_PRINTED: u64 = 4 << 20;

/// Builds a program if it must be built, and runs it.
pub(super) fn run(manifest: &Manifest, board: &Board, blob: &Blob) -> BoardRun {
    match try_run(manifest, board, blob) {
        Ok((figures, picture)) => BoardRun::Printed(figures, picture),
        Err(Obstacle::Missing(why)) => BoardRun::NotRun(why),
        Err(Obstacle::Failure(why)) => BoardRun::Failed(why),
    }
}

fn try_run(manifest: &Manifest, board: &Board, blob: &Blob) -> Result<Output, Obstacle> {
    let folder = TemporaryFolder::new().map_err(failed("a temporary folder cannot be made"))?;
    if !is_installed(board, folder.path()) {
        return Err(Obstacle::Missing(format!(
            "{} is not installed",
            board.emulator
        )));
    }
    let program = match &board.program {
        Program::Elf(file) => built_before(manifest, file)?,
        Program::Firmware(firmware) => {
            if !firmware.folder.path.is_dir() {
                let error = manifest.error(
                    &firmware.folder,
                    "is not a folder",
                    "write the path of a Cargo package's folder, relative to the manifest",
                );
                return Err(Obstacle::Failure(explained(&error)));
            }
            build(board, firmware, blob, folder.path())?
        }
    };
    let printed = emulate(board, &program, folder.path())?;
    let mut figures = BTreeMap::new();
    for (name, value) in printed.lines().filter_map(|line| line.split_once(' ')) {
        if !board.budget.contains_key(name) {
            continue;
        }
        let value = value.trim();
        let value = value.parse::<u64>().map_err(|_| String::from(value));
        match (figures.get(name), &value) {
            (Some(Ok(other)), Ok(value)) if other != value => {
                return Err(Obstacle::Failure(format!(
                    "the program prints the figure {name:?} twice: {other} and {value}"
                )));
            }
            (Some(Ok(_)), _) => {}
            _ => {
                figures.insert(String::from(name), value);
            }
        }
    }
    let picture = match &board.picture {
        Some(name) => fs::read(folder.path().join(name))
            .map_err(|error| format!("the program's file {name:?} cannot be read: {error}")),
        None => Ok(Vec::new()),
    };
    Ok((figures, picture))
}

/// Returns true if the emulator can be started. It is ended at once, as only its own run has limits.
fn is_installed(board: &Board, folder: &Path) -> bool {
    let mut command = Command::new(&board.emulator);
    command.arg("--version").current_dir(folder);
    for set in [Command::stdout, Command::stderr, Command::stdin] {
        set(&mut command, Stdio::null());
    }
    Running::start(&mut command).is_ok()
}

/// A program that was built before, if it is one.
fn built_before(manifest: &Manifest, file: &Named) -> Result<PathBuf, Obstacle> {
    let cannot_be_read = |error: io::Error| {
        let cause = format!("cannot be read: {error}");
        let remedy = "build the program first, or write the path where it is";
        let why = explained(&manifest.error(file, cause, remedy));
        match error.kind() {
            io::ErrorKind::NotFound => Obstacle::Missing(why),
            _ => Obstacle::Failure(why),
        }
    };
    let path = file.path.canonicalize().map_err(cannot_be_read)?;
    let start = File::open(&path).map_err(cannot_be_read)?;
    let mut magic = Vec::new();
    let read = start.take(ELF.len() as u64).read_to_end(&mut magic);
    read.map_err(cannot_be_read)?;
    if magic != ELF {
        let remedy = "write the path of the program that the linker wrote";
        let error = manifest.error(file, "is not an ELF file: it does not begin as one", remedy);
        return Err(Obstacle::Failure(explained(&error)));
    }
    Ok(path)
}

/// Builds the program of a Cargo package for a blob.
fn build(
    board: &Board,
    firmware: &Firmware,
    blob: &Blob,
    folder: &Path,
) -> Result<PathBuf, Obstacle> {
    let Firmware {
        folder: Named { path: package, .. },
        program,
        target,
        features,
    } = firmware;
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    if Command::new(&cargo).arg("--version").output().is_err() {
        return Err(Obstacle::Missing(String::from("cargo is not installed")));
    }
    let library = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", target])
        .current_dir(package)
        .output()
        .map_err(failed(format!(
            "{}: rustc cannot be run there",
            package.display()
        )))?;
    if !Path::new(String::from_utf8_lossy(&library.stdout).trim()).exists() {
        return Err(Obstacle::Missing(format!(
            "the Rust target {target} is not installed (`rustup target add {target}`)"
        )));
    }
    let scene = folder.join("scene.gridel");
    fs::write(&scene, blob.bytes()).map_err(failed("the blob cannot be written"))?;
    let mut command = Command::new(cargo);
    command
        .current_dir(package)
        .args([
            "build",
            "--release",
            "--message-format",
            "json-render-diagnostics",
        ])
        .args(["--target", target, "--bin", program])
        .args(["--features", &features.join(",")])
        .env("GRIDEL_BLOB", &scene)
        .env("GRIDEL_BOARD", &board.machine);
    // Variables for the host's programs would change the measured figures.
    for (variable, _) in std::env::vars_os() {
        let name = variable.to_string_lossy();
        if name.ends_with("RUSTFLAGS") || name.starts_with("CARGO_PROFILE_") {
            command.env_remove(&variable);
        }
    }
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(failed("cargo cannot be run"))?;
    if !output.status.success() {
        let text = end_of(&output.stderr);
        let package = package.display();
        return Err(Obstacle::Failure(format!(
            "{package} cannot be built: {text}"
        )));
    }
    let mut built = output
        .stdout
        .split(|&byte| byte == b'\n')
        .filter_map(|line| {
            let message: serde_json::Value = serde_json::from_slice(line).ok()?;
            let named = message["target"]["name"] == program.as_str();
            named.then(|| message["executable"].as_str().map(PathBuf::from))?
        });
    let built = built.next_back().ok_or_else(|| {
        Obstacle::Failure(format!(
            "cargo built no program {program:?} in {}",
            package.display()
        ))
    })?;
    // Out of the way of other builds.
    let program = folder.join("firmware.elf");
    fs::copy(built, &program).map_err(failed("the program cannot be copied"))?;
    Ok(program)
}

/// Runs a program in the emulator, and returns its output.
fn emulate(board: &Board, program: &Path, folder: &Path) -> Result<String, Obstacle> {
    let [printed, complaints] = ["stdout", "stderr"].map(|name| folder.join(name));
    let file = |path: &Path| File::create(path).map_err(failed("a temporary file cannot be made"));
    let mut command = Command::new(&board.emulator);
    command
        .args([
            "-M",
            &board.machine,
            "-nographic",
            "-monitor",
            "none",
            "-serial",
            "none",
        ])
        // The clock counts instructions.
        .args(["-icount", &format!("shift={}", board.shift)])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(program)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(file(&printed)?)
        .stderr(file(&complaints)?);
    let mut running = Running::start(&mut command)
        .map_err(failed(format!("{} cannot be run", board.emulator)))?;
    let size = |path: &Path| fs::metadata(path).map_or(0, |it| it.len());
    let prints_too_much = || size(&printed) + size(&complaints) > MOST_PRINTED;
    let time = Duration::from_secs(board.seconds.into());
    let ended = wait(&mut running, time, &prints_too_much)
        .map_err(failed(format!("{} cannot be run", board.emulator)))?;
    if prints_too_much() {
        return Err(Obstacle::Failure(format!(
            "the program prints more than {} bytes",
            grouped(MOST_PRINTED)
        )));
    }
    let text = |path: &Path| fs::read(path).unwrap_or_default();
    let Some(status) = ended else {
        return Err(Obstacle::Failure(format!(
            "the program has not ended after {} s (`seconds`)",
            board.seconds
        )));
    };
    if !status.success() {
        let said = [text(&printed), text(&complaints)].concat();
        return Err(Obstacle::Failure(format!(
            "the program failed ({status}): {}",
            end_of(&said)
        )));
    }
    // QEMU prints to standard error the letters that a program prints one by one.
    let lines = [text(&printed), text(&complaints)].join(&b'\n');
    Ok(String::from_utf8_lossy(&lines).into_owned())
}

/// Waits for a program; returns `None` if it runs for too long, or as soon as it prints too much.
fn wait(
    running: &mut Running,
    time: Duration,
    prints_too_much: &dyn Fn() -> bool,
) -> io::Result<Option<ExitStatus>> {
    let begun = Instant::now();
    loop {
        if let Some(status) = running.ended()? {
            return Ok(Some(status));
        }
        if begun.elapsed() > time || prints_too_much() {
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn failed(what: impl Into<String>) -> impl FnOnce(io::Error) -> Obstacle {
    move |error| Obstacle::Failure(format!("{}: {error}", what.into()))
}

/// The end of a program's text.
fn end_of(text: &[u8]) -> String {
    let text = &text[text.len().saturating_sub(SHOWN)..];
    String::from_utf8_lossy(text).trim().to_owned()
}
