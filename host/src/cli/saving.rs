//! The times at which unfinished work is saved, so that an interrupted command loses little and spends little on it.

use std::time::{Duration, Instant};

/// The first time.
const SOON: Duration = Duration::from_millis(250);
/// The longest pause.
const LONGEST: Duration = Duration::from_secs(5);

/// The clock of saving: each pause is twice as long as the last, up to 5 seconds.
pub struct Saving {
    last: Instant,
    pause: Duration,
}

impl Saving {
    pub fn start() -> Self {
        Self {
            last: Instant::now(),
            pause: SOON,
        }
    }

    /// Returns whether it is time to save; then the next pause begins.
    pub fn is_due(&mut self) -> bool {
        let is_due = self.last.elapsed() >= self.pause;
        if is_due {
            self.last = Instant::now();
            self.pause = LONGEST.min(2 * self.pause);
        }
        is_due
    }
}
