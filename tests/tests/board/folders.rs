//! Folders for the firmware: of programs, and of builds of the core.
//!
//! Compiling the core takes two thirds of a program's build, and many programs share one build of it. So a program
//! goes where its core is. A build of the core takes 15 MB, and the tests make more than a hundred.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Returns the folder of this thread's programs, of their inputs and outputs. Tests that run at the same time may build
/// the same program, and neither may write what the other reads.
pub fn of_this_thread() -> PathBuf {
    static THREADS: AtomicUsize = AtomicUsize::new(0);
    thread_local!(static NUMBER: usize = THREADS.fetch_add(1, Ordering::Relaxed));
    let folder = format!("programs-{}", NUMBER.with(|&number| number));
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder)
}

/// Target folders, each for one program at a time: building takes one processor.
pub const FOLDERS: usize = 2;

/// Builds of the core that a folder keeps.
const KEPT: usize = 20;

/// A build of the core.
struct Core {
    /// Target, profile, flags and features.
    name: String,
    files: Vec<PathBuf>,
}

/// A target folder.
struct Folder {
    busy: bool,
    /// The builds of the core in it, that used last at the end.
    cores: VecDeque<Core>,
}

static ALL: Mutex<[Folder; FOLDERS]> = Mutex::new(
    [const {
        Folder {
            busy: false,
            cores: VecDeque::new(),
        }
    }; FOLDERS],
);
static FREED: Condvar = Condvar::new();

fn all() -> MutexGuard<'static, [Folder; FOLDERS]> {
    ALL.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A target folder that is reserved for one build.
pub struct Claim {
    number: usize,
    folder: PathBuf,
}

/// The folder of a target with few programs: in one folder, the crates that they share are compiled once.
fn home(target: &str) -> Option<usize> {
    match target.split_once('-')?.0 {
        "thumbv7m" | "thumbv7em" => None,
        "thumbv6m" | "thumbv8m.main" => Some(0),
        _ => Some(FOLDERS - 1),
    }
}

/// Waits for the folder where a core is, or for any where it is in none.
pub fn claim(target: &str, core: String) -> Claim {
    let mut folders = all();
    let number = loop {
        let holds = |folder: &Folder| folder.cores.iter().any(|held| held.name == core);
        let held = folders.iter().position(holds);
        let number = match held.or(home(target)) {
            Some(number) => (!folders[number].busy).then_some(number),
            None => folders.iter().position(|folder| !folder.busy),
        };
        match number {
            Some(number) => break number,
            None => folders = FREED.wait(folders).unwrap_or_else(PoisonError::into_inner),
        }
    };
    let Folder { busy, cores } = &mut folders[number];
    *busy = true;
    let found = cores.iter().position(|held| held.name == core);
    let files = found.and_then(|place| cores.remove(place));
    let files = files.map_or_else(Vec::new, |held| held.files);
    cores.push_back(Core { name: core, files });
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("firmware-{number}"));
    Claim { number, folder }
}

impl Claim {
    /// The target folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Notes what the build left among `artifacts`, and removes the builds of the core that were used least recently.
    pub fn built(&self, artifacts: &Path) {
        let cores = &mut all()[self.number].cores;
        let is_core = |path: &PathBuf| {
            let name = path.file_name().map(|name| name.to_string_lossy());
            name.is_some_and(|name| name.starts_with("libgridel_core-"))
        };
        let entries = fs::read_dir(artifacts).into_iter().flatten();
        let files = entries.flatten().map(|entry| entry.path()).filter(is_core);
        let new = files.filter(|path| !cores.iter().any(|held| held.files.contains(path)));
        let new: Vec<_> = new.collect();
        if let Some(used) = cores.back_mut() {
            used.files.extend(new);
        }
        while cores.len() > KEPT {
            let oldest = cores.pop_front().map(|oldest| oldest.files);
            for file in oldest.into_iter().flatten() {
                // Cargo builds missing files again; the others only take room.
                let _ = fs::remove_file(file);
            }
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        all()[self.number].busy = false;
        FREED.notify_all();
    }
}
