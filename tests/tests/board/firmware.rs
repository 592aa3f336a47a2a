//! Builds the firmware for a board and runs it in QEMU, or in Node.

use crate::elf::Elf;
use crate::folders;
use crate::scenes::{Compiled, repository};
use gridel_core::{Format, Structure};
use gridel_host::measure::board::Board;
use gridel_host::measure::board::programs::{Profile, ProgramKey};
use std::collections::BTreeMap;
use std::fmt;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::{Mutex, PoisonError};
use std::{env, fs};

/// The runner that comes nearest to a board without an operating system: WebAssembly in Node.
pub const WASM: Board = Board {
    name: "wasm32",
    core: "WebAssembly",
    measured: "wasm32",
    target: "wasm32-unknown-unknown",
    flash: u32::MAX as u64,
    ram: u32::MAX as u64,
    formats: &[Format::F32, Format::Fixed, Format::F64],
};

/// A processor of phones and servers, as a program of Linux.
pub const AARCH64: Board = Board {
    name: "linux-aarch64",
    core: "Armv8-A",
    target: "aarch64-unknown-linux-gnu",
    ..WASM
};

/// The core of an ESP32-C3, without atomic instructions, in the memory of a board whose core has them.
pub const RV32IMC: Board = Board {
    name: "sifive_e",
    core: "RV32IMC",
    measured: "sifive_e",
    target: "riscv32imc-unknown-none-elf",
    flash: 12 << 20,
    ram: 16 << 10,
    formats: &[Format::Fixed],
};

/// A big-endian machine, as a program of Linux.
pub const S390X: Board = Board {
    name: "linux-s390x",
    core: "z/Architecture",
    target: "s390x-unknown-linux-gnu",
    ..AARCH64
};

/// A board by its name.
pub fn board(name: &str) -> &'static Board {
    Board::named(name).unwrap_or(&WASM)
}

/// The program that runs a board's programs.
fn emulator(board: &Board) -> &'static str {
    match board.target.split_once('-') {
        Some(("wasm32", _)) => "node",
        Some(("riscv32imac" | "riscv32imc", _)) => "qemu-system-riscv32",
        Some(("aarch64", _)) => "qemu-aarch64",
        Some(("s390x", _)) => "qemu-s390x",
        _ => "qemu-system-arm",
    }
}

/// The program that links a board's programs, where Rust does not bring it.
fn linker(board: &Board) -> Option<String> {
    let processor = board.target.strip_suffix("-unknown-linux-gnu")?;
    Some(format!("{processor}-linux-gnu-gcc"))
}

/// Missing tools to build a board's programs and to run them.
pub fn missing_for(board: &Board) -> Vec<String> {
    static KNOWN: Mutex<BTreeMap<String, bool>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut missing = Vec::new();
    for tool in linker(board).into_iter().chain([emulator(board).into()]) {
        let starts = || Command::new(&tool).arg("--version").output().is_ok();
        if !*known.entry(tool.clone()).or_insert_with(starts) {
            missing.push(tool);
        }
    }
    let target = format!("the Rust target {}", board.target);
    let has_library = || {
        let library = Command::new("rustc")
            .args(["--print", "target-libdir", "--target", board.target])
            .output();
        library
            .is_ok_and(|output| Path::new(String::from_utf8_lossy(&output.stdout).trim()).exists())
    };
    if !*known.entry(target.clone()).or_insert_with(has_library) {
        missing.push(target);
    }
    missing
}

/// The configuration of a firmware build.
pub struct Build<'b> {
    board: &'b Board,
    format: Format,
    structure: Structure,
    scene: &'b Compiled,
    overflow_checks: bool,
    small: bool,
    /// The board whose memory it is linked for.
    memory: &'b str,
}

impl fmt::Display for Build<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (board, scene) = (self.board.name, self.scene.name);
        let (format, structure) = (self.format.name(), self.structure.name());
        let checked = if self.overflow_checks { " checked" } else { "" };
        let small = if self.small { " small" } else { "" };
        write!(f, "{scene} {board} {format} {structure}{checked}{small}")
    }
}

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
            overflow_checks: false,
            small: false,
            memory: board.name,
        }
    }

    /// The build with all arithmetic checked for overflow, as debug builds check it.
    pub fn with_overflow_checks(self) -> Self {
        Self {
            overflow_checks: true,
            ..self
        }
    }

    /// The firmware with the least flash: small code, and a blob that is prevalidated.
    pub fn small(self) -> Self {
        Self {
            small: true,
            ..self
        }
    }

    /// The program to be measured and not run: it may need more flash than the smallest Cortex-M3 has.
    pub fn beyond_flash(self) -> Self {
        let memory = match self.memory {
            "stm32vldiscovery" => "mps2-an385",
            own => own,
        };
        Self { memory, ..self }
    }

    /// Returns the board, the number format and the structure.
    pub fn place(&self) -> ProgramKey<'b> {
        (self.board, self.format, self.structure)
    }

    /// Returns the profile with which it is built.
    pub fn profile(&self) -> Profile {
        match self.small {
            true => Profile::Small,
            false => Profile::Fast,
        }
    }

    /// Returns whether it is built so.
    pub fn is_small(&self) -> bool {
        self.small
    }

    /// Builds one of the firmware's programs with what the scene requires, and nothing else.
    pub fn program(&self, name: &str) -> Program<'b> {
        self.program_with(name, &self.scene.features())
    }

    /// Builds one of the firmware's programs with code for shapes and effects of its own choice.
    pub fn program_with(&self, name: &str, features: &[&str]) -> Program<'b> {
        let built = self.try_program(name, features);
        built.unwrap_or_else(|errors| panic!("{self}: {errors}"))
    }

    /// Builds one of the firmware's programs, or says why it does not compile.
    pub fn try_program(&self, name: &str, features: &[&str]) -> Result<Program<'b>, String> {
        let folder = self.folder(name);
        // Beside it a module with a `scene.gridel` of its own may lie.
        let blob = folder.join("firmware.gridel");
        fs::write(&blob, self.scene.blob.bytes()).expect("the target folder can be written to");

        let (profile, small): (_, &[_]) = if self.small {
            ("small", &["small"])
        } else {
            ("release", &[])
        };
        let mut cargo = Command::new(env!("CARGO"));
        cargo
            .current_dir(repository().join("tests/firmware"))
            .args(["build", "--profile", profile, "--locked", "--target"])
            .args([self.board.target, "--bin", name, "--features"])
            .arg(
                [
                    &[self.format.name(), self.structure.name()],
                    small,
                    features,
                ]
                .concat()
                .join(","),
            );
        // Variables for the host's build would change the measured figures.
        for (variable, _) in env::vars_os() {
            let name = variable.to_string_lossy();
            if name.ends_with("RUSTFLAGS") || name.starts_with("CARGO_PROFILE_") {
                cargo.env_remove(&variable);
            }
        }
        let mut flags = String::new();
        if let Some(linker) = linker(self.board) {
            // Whole, so that the emulator needs no libraries.
            flags += &format!("-C linker={linker} -C target-feature=+crt-static");
        } else if self.board.target != WASM.target {
            // For the bound of the stack; neither changes an instruction.
            flags += " -Z emit-stack-sizes -C link-arg=--emit-relocs";
        }
        if self.overflow_checks {
            flags += " -C overflow-checks=on";
        }
        if self.board.core == "Cortex-M7" {
            // The target's own baseline is a Cortex-M4F, without double precision.
            flags += " -C target-cpu=cortex-m7";
        }
        // The core is the same in every number format and with a module of any sort.
        let mut parts = [&[self.structure.name()], features].concat();
        parts.retain(|&part| part != "emitted");
        parts.sort_unstable();
        let target = self.board.target;
        let claim = folders::claim(target, format!("{target} {profile} {flags} {parts:?}"));
        let target_folder = claim.folder();
        let artifacts = target_folder.join(target).join(profile);
        cargo
            .env("RUSTC_BOOTSTRAP", "1")
            // No instruction depends on them, and every fifth second of a build does.
            .env("CARGO_PROFILE_RELEASE_DEBUG", "false")
            .env("RUSTFLAGS", flags.trim_start())
            .env("CARGO_TARGET_DIR", target_folder)
            .env("GRIDEL_BOARD", self.memory)
            .env("GRIDEL_BLOB", &blob)
            .env("GRIDEL_MODULE", &folder);
        let output = cargo.output().expect("cargo runs");
        claim.built(&artifacts.join("deps"));
        if !output.status.success() {
            return Err(text(&output));
        }
        let extension = if self.board.target == WASM.target {
            ".wasm"
        } else {
            ""
        };
        let built = artifacts.join(format!("{name}{extension}"));
        fs::copy(built, folder.join("firmware.elf")).expect("the target folder can be written to");
        Ok(Program {
            board: self.board,
            folder,
        })
    }

    /// Returns the folder of a program, of its inputs and of its outputs.
    pub fn folder(&self, name: &str) -> PathBuf {
        let programs = folders::of_this_thread();
        // Scenes of one name differ.
        let mut hasher = DefaultHasher::new();
        self.scene.blob.bytes().hash(&mut hasher);
        self.board.target.hash(&mut hasher);
        let folder = format!("{name} {self} {:016x}", hasher.finish());
        let folder = programs.join(folder.replace([' ', ','], "-"));
        fs::create_dir_all(&folder).expect("the target folder can be written to");
        folder
    }
}

/// A program of the firmware in a folder of its own.
pub struct Program<'b> {
    board: &'b Board,
    folder: PathBuf,
}

impl Program<'_> {
    /// The program's functions and memory.
    pub fn elf(&self) -> Elf {
        Elf::read(self.path())
    }

    /// Returns the folder of the program and of its outputs.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The program itself.
    fn path(&self) -> PathBuf {
        self.folder.join("firmware.elf")
    }

    /// A file that the program wrote.
    pub fn file(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder.join(name)).expect("the program wrote it")
    }

    /// Runs the program and returns its figures.
    pub fn run(&self) -> BTreeMap<String, u64> {
        self.lines().into_iter().collect()
    }

    /// Runs the program and returns its figures in the order in which it prints them.
    pub fn lines(&self) -> Vec<(String, u64)> {
        let output = self.output();
        assert!(
            output.status.success(),
            "{}: {}",
            self.folder.display(),
            text(&output)
        );
        // QEMU prints what comes letter by letter on standard error.
        let all = [output.stdout, output.stderr].concat();
        let lines = String::from_utf8_lossy(&all);
        let pairs = lines.lines().filter_map(|line| line.split_once(' '));
        pairs
            .filter_map(|(name, value)| Some((name.into(), value.parse().ok()?)))
            .collect()
    }

    /// Runs the program, which has to fail, and returns its message.
    pub fn failure(&self) -> String {
        let output = self.output();
        assert!(!output.status.success(), "{}", self.folder.display());
        text(&output)
    }

    fn output(&self) -> Output {
        let mut emulator = Command::new(emulator(self.board));
        if self.board.target == WASM.target {
            emulator.arg(repository().join("tests/firmware/src/board/run.mjs"));
        } else if linker(self.board).is_none() {
            // The clock counts instructions; see the boards' counters.
            let shift = if self.board.core.starts_with("RV") {
                "shift=0"
            } else {
                "shift=4"
            };
            emulator
                .args(["-M", self.board.name, "-icount", shift, "-nographic"])
                .args(["-monitor", "none", "-serial", "none"])
                .args(["-semihosting-config", "enable=on,target=native", "-kernel"]);
        }
        emulator
            .arg(self.path())
            .current_dir(&self.folder)
            .stdin(Stdio::null())
            .output()
            .expect("the emulator runs")
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
