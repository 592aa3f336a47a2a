//! Builds the firmware for a board and runs it in QEMU.

use crate::scenes::{Compiled, repository};
use gridel_core::{Format, Structure};
use std::collections::BTreeMap;
use std::fmt;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Mutex;
use std::{env, fs, io};

/// A board as QEMU names it, and the target of its core.
pub struct Board {
    name: &'static str,
    target: &'static str,
}

/// Cortex-M3: no floating-point unit.
pub const AN385: Board = Board {
    name: "mps2-an385",
    target: "thumbv7m-none-eabi",
};
/// Cortex-M4F: single precision.
pub const AN386: Board = Board {
    name: "mps2-an386",
    target: "thumbv7em-none-eabihf",
};

const EMULATOR: &str = "qemu-system-arm";

/// Whether boards can be emulated here. Says what is missing, and fails where boards are required.
pub fn available() -> bool {
    let mut missing = Vec::new();
    if Command::new(EMULATOR).arg("--version").output().is_err() {
        missing.push(String::from(EMULATOR));
    }
    for board in [&AN385, &AN386] {
        let library = Command::new("rustc")
            .args(["--print", "target-libdir", "--target", board.target])
            .output();
        let found = library
            .is_ok_and(|output| Path::new(String::from_utf8_lossy(&output.stdout).trim()).exists());
        if !found {
            missing.push(format!("the Rust target {}", board.target));
        }
    }
    if missing.is_empty() {
        return true;
    }
    let missing = missing.join(", ");
    let required = env::var_os("GRIDEL_REQUIRE_BOARDS").is_some_and(|value| value == "1");
    assert!(!required, "no boards can be emulated without {missing}");
    skip(format_args!("no boards can be emulated without {missing}"));
    false
}

/// Says that a test does not run, past the capture of what passing tests print.
pub fn skip(why: fmt::Arguments<'_>) {
    // Where nothing can be printed, nobody is there to read it.
    let _ = writeln!(io::stderr(), "SKIPPED: {why}");
}

/// What the firmware is built for.
pub struct Build<'b> {
    board: &'b Board,
    format: Format,
    structure: Structure,
    scene: &'b Compiled,
}

impl fmt::Display for Build<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (board, scene) = (self.board.name, self.scene.name);
        let (format, structure) = (self.format.name(), self.structure.name());
        write!(f, "{scene} {board} {format} {structure}")
    }
}

/// Builds share one target folder, so one runs at a time.
static BUILDING: Mutex<()> = Mutex::new(());

impl<'b> Build<'b> {
    pub fn new(
        board: &'b Board,
        format: Format,
        structure: Structure,
        scene: &'b Compiled,
    ) -> Self {
        Self {
            board,
            format,
            structure,
            scene,
        }
    }

    /// Builds one of the firmware's programs.
    pub fn program(&self, name: &str) -> Program<'b> {
        // A test that failed says so itself.
        let _one_at_a_time = BUILDING.lock().unwrap_or_else(|poison| poison.into_inner());
        let tmp = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let folder = tmp.join(format!("{name} {self}").replace(' ', "-"));
        fs::create_dir_all(&folder).expect("the target folder can be written to");
        let blob = folder.join("scene.gridel");
        fs::write(&blob, self.scene.blob.bytes()).expect("the target folder can be written to");

        let target_folder = tmp.join("firmware");
        let mut cargo = Command::new(env!("CARGO"));
        cargo
            .current_dir(repository().join("tests/firmware"))
            .args([
                "build",
                "--release",
                "--locked",
                "--target",
                self.board.target,
            ])
            .args(["--bin", name, "--features"])
            .arg(format!(
                "{},{},selftest",
                self.format.name(),
                self.structure.name()
            ))
            .env("CARGO_TARGET_DIR", &target_folder)
            .env("GRIDEL_BLOB", &blob);
        // What is meant for the host's build would change what is measured.
        for (variable, _) in env::vars_os() {
            let name = variable.to_string_lossy();
            if name.ends_with("RUSTFLAGS") || name.starts_with("CARGO_PROFILE_") {
                cargo.env_remove(&variable);
            }
        }
        let output = cargo.output().expect("cargo runs");
        assert!(output.status.success(), "{self}: {}", text(&output));
        let built = target_folder
            .join(self.board.target)
            .join("release")
            .join(name);
        let program = folder.join("firmware.elf");
        fs::copy(built, &program).expect("the target folder can be written to");
        Program {
            board: self.board,
            folder,
        }
    }
}

/// A program of the firmware in a folder of its own.
pub struct Program<'b> {
    board: &'b Board,
    folder: PathBuf,
}

impl Program<'_> {
    /// Where the program lies, and what it writes.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The program itself.
    pub fn path(&self) -> PathBuf {
        self.folder.join("firmware.elf")
    }

    /// A file that the program wrote.
    pub fn file(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder.join(name)).expect("the program wrote it")
    }

    /// Runs the program and returns what it measured.
    pub fn run(&self) -> BTreeMap<String, u64> {
        let output = Command::new(EMULATOR)
            .args([
                "-M",
                self.board.name,
                "-nographic",
                "-monitor",
                "none",
                "-serial",
                "none",
            ])
            // The clock counts instructions; see the board's counter.
            .args(["-icount", "shift=4"])
            .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
            .arg(self.path())
            .current_dir(&self.folder)
            .stdin(Stdio::null())
            .output()
            .expect("the emulator runs");
        assert!(
            output.status.success(),
            "{}: {}",
            self.folder.display(),
            text(&output)
        );
        let lines = String::from_utf8_lossy(&output.stdout);
        let pairs = lines.lines().filter_map(|line| line.split_once(' '));
        pairs
            .filter_map(|(name, value)| Some((name.into(), value.parse().ok()?)))
            .collect()
    }
}

fn text(output: &Output) -> String {
    let (out, err) = (&output.stdout, &output.stderr);
    format!(
        "{}\n{}\n{}",
        output.status,
        String::from_utf8_lossy(out),
        String::from_utf8_lossy(err)
    )
}
