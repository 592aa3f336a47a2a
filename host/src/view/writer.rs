//! Texts on standard output beside a window. A thread of its own writes them, so that an output that nobody reads keeps
//! no window waiting.

use std::io::{self, Write};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::thread;
use std::time::Duration;

/// Number of texts that may wait.
const MOST_WAITING: usize = 64;

/// Longest time to wait for the last texts.
const PATIENCE: Duration = Duration::from_secs(1);

/// The message where a text is lost.
pub(super) const UNREAD: &str = "the text is lost, because standard output is not read";

/// Texts to write, in their order.
#[derive(Clone)]
pub(super) struct Texts(SyncSender<String>);

/// The thread that writes.
pub(super) struct Writer(Receiver<()>);

/// Starts the thread that writes.
pub(super) fn start() -> (Texts, Writer) {
    let (sender, texts) = mpsc::sync_channel(MOST_WAITING);
    let (ended, end) = mpsc::channel();
    // It is not joined: an output that nobody reads never lets it end.
    thread::spawn(move || {
        write_all(&texts);
        drop(ended);
    });
    (Texts(sender), Writer(end))
}

fn write_all(texts: &Receiver<String>) {
    for text in texts {
        // The terminal may be closed without harm to the window.
        let _ = io::stdout().lock().write_all(text.as_bytes());
        let _ = io::stdout().flush();
    }
}

impl Texts {
    /// Writes a text, and returns true. Returns false if it is lost, because too many wait.
    pub(super) fn write(&self, text: String) -> bool {
        self.0.try_send(text).is_ok()
    }
}

impl Writer {
    /// Waits for the last texts once all [`Texts`] are dropped, but no longer than a moment.
    pub(super) fn finish(self) {
        // An error is the end of the thread, or of the time.
        let _ = self.0.recv_timeout(PATIENCE);
    }
}
