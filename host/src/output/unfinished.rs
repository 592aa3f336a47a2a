//! Cleanup after an interrupt: files that are being written, temporary folders, child processes, and a terminal that
//! shows a scene.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::mpsc::channel;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

/// All of it, at one time.
pub(super) struct Unfinished {
    /// Files under the names they have until they are complete, and folders.
    pub(super) paths: Vec<PathBuf>,
    running: Vec<Child>,
    /// Gives the terminal back.
    screen: Option<Box<dyn FnOnce() + Send>>,
}

impl Unfinished {
    /// Returns the place of a program in the list of those that run; `None` if it was seen to end.
    fn place(&self, id: u32) -> Option<usize> {
        self.running.iter().position(|child| child.id() == id)
    }
}

static UNFINISHED: Mutex<Unfinished> = Mutex::new(Unfinished {
    paths: Vec::new(),
    running: Vec::new(),
    screen: None,
});

pub(super) fn unfinished() -> MutexGuard<'static, Unfinished> {
    // The lists are complete even if the thread that locked them panicked.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Says how the terminal is given back if the program is interrupted; `None` when that is done.
pub(crate) fn gives_back(screen: Option<Box<dyn FnOnce() + Send>>) {
    unfinished().screen = screen;
}

/// Longest time that the end of the program waits for a terminal.
const PATIENCE: Duration = Duration::from_millis(500);

/// Writes to a terminal, but waits no longer than half a second: a terminal may take nothing.
pub fn within_limits(write: fn()) {
    let (done, ended) = channel();
    let writer = move || {
        write();
        let _ = done.send(());
    };
    match thread::Builder::new().spawn(writer) {
        Ok(_) => drop(ended.recv_timeout(PATIENCE)),
        // There is no memory for a thread.
        Err(_) => write(),
    }
}

/// Ends what runs, removes what writing has left so far, gives the terminal back, and ends the program: for whoever
/// handles an interrupt.
pub fn exit_removing_unfinished(exit_code: i32) -> ! {
    exit_removing(unfinished(), exit_code)
}

/// [`exit_removing_unfinished`] for a thread that may have the lists locked. If it has, they stay as they are.
pub fn exit_without_memory(exit_code: i32) -> ! {
    for _ in 0..100 {
        if let Ok(unfinished) = UNFINISHED.try_lock() {
            exit_removing(unfinished, exit_code);
        }
        thread::sleep(Duration::from_millis(10));
    }
    std::process::exit(exit_code)
}

fn exit_removing(mut unfinished: MutexGuard<'static, Unfinished>, exit_code: i32) -> ! {
    if let Some(give_back) = unfinished.screen.take() {
        give_back();
    }
    // The program ends, so failures are not reported.
    unfinished.running.iter_mut().for_each(end);
    for path in &unfinished.paths {
        let _ = match path.is_dir() {
            true => fs::remove_dir_all(path),
            false => fs::remove_file(path),
        };
    }
    // The lists stay locked, so that no other thread starts or completes anything meanwhile.
    std::process::exit(exit_code)
}

/// A temporary folder.
#[derive(Debug)]
pub struct TemporaryFolder(Option<TempDir>);

impl TemporaryFolder {
    /// Makes one.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn new() -> io::Result<Self> {
        let mut unfinished = unfinished();
        let folder = tempfile::tempdir()?;
        unfinished.paths.push(folder.path().to_owned());
        Ok(Self(Some(folder)))
    }

    /// Returns its path.
    pub fn path(&self) -> &Path {
        self.0.as_ref().map_or(Path::new(""), TempDir::path)
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        let mut unfinished = unfinished();
        unfinished.paths.retain(|path| path != self.path());
        // It is removed here, before others can see the list.
        self.0 = None;
    }
}

/// Ends a program that runs. On Unix this ends its process group as well, which has the processes that it started.
fn end(child: &mut Child) {
    #[cfg(unix)]
    end_group(child.id());
    // One that has ended needs neither.
    let _ = child.kill();
    let _ = child.wait();
}

/// Ends the processes of a group, which has the number of its first process.
#[cfg(unix)]
fn end_group(number: u32) {
    use nix::sys::signal::{Signal, killpg};
    use nix::unistd::Pid;
    // A group of which nothing runs is an error.
    let group = i32::try_from(number).map(Pid::from_raw);
    let _ = group.map(|group| killpg(group, Signal::SIGKILL));
}

/// A program that runs for this one. It is ended with this one, and so are the processes that it started.
///
/// On Unix it runs in a process group of its own. A process that leaves this group is not ended. Elsewhere only the
/// program itself is ended.
#[derive(Debug)]
pub struct Running {
    id: u32,
    status: Option<ExitStatus>,
}

impl Running {
    /// Starts a program.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start(command: &mut Command) -> io::Result<Self> {
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        let mut unfinished = unfinished();
        let child = command.spawn()?;
        let id = child.id();
        unfinished.running.push(child);
        Ok(Self { id, status: None })
    }

    /// Returns its exit status, if it has ended. Then the processes that it started are ended, too.
    ///
    /// # Errors
    /// If the system reports an error.
    pub fn ended(&mut self) -> io::Result<Option<ExitStatus>> {
        if self.status.is_some() {
            return Ok(self.status);
        }
        let mut unfinished = unfinished();
        let Some(place) = unfinished.place(self.id) else {
            return Ok(None);
        };
        self.status = unfinished.running[place].try_wait()?;
        if self.status.is_some() {
            // At once: later the system may give its number to another program.
            end(&mut unfinished.running.swap_remove(place));
        }
        Ok(self.status)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let mut unfinished = unfinished();
        if let Some(place) = unfinished.place(self.id) {
            end(&mut unfinished.running.swap_remove(place));
        }
    }
}
