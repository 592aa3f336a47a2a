//! Progress of long work: a bar on standard error, if that is a terminal and the work takes longer
//! than a moment.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Time after which progress is shown.
const MOMENT: Duration = Duration::from_millis(500);

/// A bar that appears after a moment and vanishes when it is dropped.
pub struct Progress {
    bar: ProgressBar,
    /// Dropped to end the thread that shows the bar.
    done: Option<Sender<()>>,
    shower: Option<JoinHandle<()>>,
}

impl Progress {
    /// Work of a known number of steps.
    pub fn steps(what: &'static str, steps: u64) -> Self {
        let template = "{msg} {wide_bar} {pos}/{len}, {eta} left";
        Self::new(ProgressBar::new(steps), what, template)
    }

    /// Indeterminate progress.
    pub fn unknown(what: &'static str) -> Self {
        Self::new(
            ProgressBar::new_spinner(),
            what,
            "{spinner} {msg} {elapsed}",
        )
    }

    fn new(bar: ProgressBar, what: &'static str, template: &str) -> Self {
        bar.set_draw_target(ProgressDrawTarget::hidden());
        bar.set_message(what);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        let mut progress = Self {
            bar,
            done: None,
            shower: None,
        };
        if std::io::stderr().is_terminal() {
            let (done, wait) = channel();
            let bar = progress.bar.clone();
            progress.done = Some(done);
            progress.shower = Some(std::thread::spawn(move || {
                if wait.recv_timeout(MOMENT) == Err(RecvTimeoutError::Timeout) {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                    bar.enable_steady_tick(MOMENT / 4);
                }
            }));
        }
        progress
    }

    /// Shows the current step.
    pub fn show(&self, what: &str) {
        self.bar.set_message(what.to_owned());
    }

    /// Shows the next step, and counts it.
    pub fn pass(&self, what: &str) {
        self.show(what);
        self.step();
    }

    /// One more step is done.
    pub fn step(&self) {
        self.bar.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.done = None;
        if let Some(shower) = self.shower.take() {
            // A thread that panicked shows no bar, and there is nothing else to do about it.
            let _ = shower.join();
        }
        self.bar.finish_and_clear();
    }
}
