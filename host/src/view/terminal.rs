//! Half blocks in a terminal: two pixels per character, in colors of 24 bits.

use super::frame::Frame;
use super::keys::{Action, Key, action, key_help};
use super::refine::Refiner;
use super::save::save_with_message;
use super::shot::ViewError;
use super::state::{Effect, State};
use super::terminal_keys::{Pressed, Sequences};
use crate::output::unfinished::{gives_back, within_limits};
use console::Term;
use std::fmt::Write as _;
use std::io::{self, Write};
use std::mem::ManuallyDrop;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Columns of a picture that goes to no terminal.
const COLUMNS: u16 = 80;

/// The least time between two frames, which a terminal takes long to draw.
const FRAME_TIME: Duration = Duration::from_millis(50);

/// The time after which the terminal's size is checked.
const LOOK_TIME: Duration = Duration::from_millis(250);

/// Lines below the picture, for the settings.
const LINES_BELOW: u16 = 1;

/// Returns the size of a picture with a given shape, in pixels of the terminal. Uses 80 columns where standard output
/// is not a terminal.
pub fn fitting_size(shape: [u16; 2]) -> [u16; 2] {
    let (rows, columns) = terminal_size();
    let height = rows.saturating_sub(LINES_BELOW).saturating_mul(2);
    fitted(shape, [columns, height])
}

/// Rows and columns of the terminal.
fn terminal_size() -> (u16, u16) {
    let size = Term::stdout().size_checked();
    size.unwrap_or((u16::MAX, COLUMNS))
}

/// Returns the largest size of a shape within limits, at least one pixel.
pub fn fitted([width, height]: [u16; 2], limits: [u16; 2]) -> [u16; 2] {
    let shape = [width, height].map(|side| f64::from(side.max(1)));
    let scales = [0, 1].map(|k| f64::from(limits[k].max(1)) / shape[k]);
    let scale = scales[0].min(scales[1]);
    // The cast saturates.
    shape.map(|side| ((side * scale).round() as u16).max(1))
}

/// Returns a frame as lines of half blocks: the upper pixel is the character's color, the lower one its background.
pub fn half_blocks(frame: &Frame) -> String {
    half_blocks_within(frame, [u16::MAX; 2])
}

/// Returns the upper left part of a frame that has so many columns and lines.
fn half_blocks_within(frame: &Frame, [columns, lines]: [u16; 2]) -> String {
    let columns = usize::from(frame.width.min(columns));
    let colors: Vec<u32> = frame.colors().collect();
    let rows: Vec<&[u32]> = colors.chunks(usize::from(frame.width.max(1))).collect();
    let mut text = String::new();
    for pair in rows.chunks(2).take(lines.into()) {
        let mut before = None;
        for x in 0..columns {
            let cell = (pair[0][x], pair.get(1).map(|row| row[x]));
            if before != Some(cell) {
                let [_, red, green, blue] = cell.0.to_be_bytes();
                // Writing to a string cannot fail.
                let _ = write!(text, "\x1b[38;2;{red};{green};{blue}");
                if let Some([_, red, green, blue]) = cell.1.map(u32::to_be_bytes) {
                    let _ = write!(text, ";48;2;{red};{green};{blue}");
                }
                text.push('m');
            }
            text.push('▀');
            before = Some(cell);
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

/// Returns one whole frame of a picture.
///
/// # Errors
/// If there is no such picture.
pub fn one_frame(refiner: &Refiner<'_>, state: &State<'_>) -> Result<String, ViewError> {
    refiner.run(&|| (), || {
        refiner.show(state.shot());
        refiner.wait();
    });
    refiner.look(|frame, status| match &status.error {
        Some(error) => Err(error.clone()),
        None => Ok(half_blocks(frame)),
    })
}

/// The reason why a scene is shown no longer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The user quit, or no more keys can be read.
    Quit,
    /// The user interrupted the program.
    Interrupted,
}

/// Shows a scene until the user quits. The picture fits the terminal, or keeps its size if `is_fixed`.
///
/// # Errors
/// If standard output cannot be written.
pub fn live(refiner: &Refiner<'_>, state: State<'_>, is_fixed: bool) -> io::Result<End> {
    let (sender, receiver) = channel();
    let wake = sender.clone();
    // Before a key is read, which changes the terminal's settings for that time.
    let _screen = Screen::open()?;
    // Nothing waits for this thread: it reads until a key is pressed, also after an error.
    thread::Builder::new().spawn(move || read_keys(&sender))?;
    // At the end the receiver is gone.
    let wake = || drop(wake.send(Event::Drawn));
    refiner.run(&wake, move || {
        Live {
            refiner,
            shape: [state.settings().width, state.settings().height],
            state,
            is_fixed,
            terminal: (0, 0),
            message: None,
            shows_keys: false,
        }
        .run(&receiver)
    })
}

/// The events while a scene is shown.
enum Event {
    Key(Key),
    /// A key that does nothing but close the help.
    OtherKey,
    /// There is more of the picture.
    Drawn,
    End(End),
}

/// Sends keys until one of them quits.
fn read_keys(sender: &Sender<Event>) {
    let terminal = Term::stdout();
    let mut sequences = Sequences::default();
    loop {
        let event = match terminal.read_key_raw().map(|sent| sequences.next(&sent)) {
            Ok(None) => continue,
            Ok(Some(Pressed::Key(key))) => Event::Key(key),
            Ok(Some(Pressed::Other)) => Event::OtherKey,
            Ok(Some(Pressed::Interrupt)) => Event::End(End::Interrupted),
            Err(_) => Event::End(End::Quit),
        };
        let is_last = match event {
            Event::Key(key) => action(key) == Some(Action::Quit),
            Event::OtherKey | Event::Drawn => false,
            Event::End(_) => true,
        };
        if sender.send(event).is_err() || is_last {
            return;
        }
    }
}

/// The terminal's second screen, without a cursor; the first one and the settings return in the end.
struct Screen {
    restore: Option<Box<dyn FnOnce()>>,
}

/// Shows the first screen and the cursor.
const CLOSED: &str = "\x1b[0m\x1b[?25h\x1b[?1049l";

impl Screen {
    fn open() -> io::Result<Self> {
        let restore = settings();
        gives_back(Some(Box::new(move || {
            restore();
            within_limits(|| {
                // Nothing is drawn any more. Where the terminal takes nothing, what draws holds the lock.
                let mut out = ManuallyDrop::new(io::stdout().lock());
                let _ = out.write_all(CLOSED.as_bytes()).and_then(|()| out.flush());
            });
        })));
        let screen = Self {
            restore: Some(Box::new(settings())),
        };
        write("\x1b[?1049h\x1b[?25l\x1b[2J")?;
        Ok(screen)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        gives_back(None);
        // After an error a key may still be waited for.
        if let Some(restore) = self.restore.take() {
            restore();
        }
        // The program ends, so a failure is not reported.
        let _ = write(CLOSED);
    }
}

/// Returns what gives the terminal the settings that it has now. Reading a key changes them for that time.
#[cfg(unix)]
fn settings() -> impl FnOnce() + Send {
    use nix::sys::termios::{SetArg, tcgetattr, tcsetattr};
    let before = tcgetattr(io::stdin());
    move || {
        if let Ok(before) = before {
            let _ = tcsetattr(io::stdin(), SetArg::TCSANOW, &before);
        }
    }
}

#[cfg(not(unix))]
fn settings() -> impl FnOnce() + Send {
    || ()
}

fn write(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

fn write_help() -> io::Result<()> {
    write(&format!(
        "\x1b[H\x1b[2J{}  Any key returns to the picture.",
        key_help()
    ))
}

/// A scene that is shown.
struct Live<'r, 's> {
    refiner: &'r Refiner<'s>,
    state: State<'s>,
    /// The width and height whose ratio the picture has.
    shape: [u16; 2],
    is_fixed: bool,
    /// Rows and columns of the terminal; none before it is looked at.
    terminal: (u16, u16),
    /// Shown in place of the settings until the next key.
    message: Option<String>,
    /// True if the keys are shown in place of the picture.
    shows_keys: bool,
}

impl Live<'_, '_> {
    fn run(&mut self, events: &Receiver<Event>) -> io::Result<End> {
        self.refiner.show(self.state.shot());
        let mut is_drawn = false;
        let mut last = Instant::now();
        loop {
            is_drawn |= self.fit()?;
            // No event reports another size of the terminal, so it is checked now and then.
            let timeout = match is_drawn && !self.shows_keys {
                true => FRAME_TIME.saturating_sub(last.elapsed()),
                false => LOOK_TIME,
            };
            match events.recv_timeout(timeout) {
                Ok(Event::Drawn) => is_drawn = true,
                Ok(Event::Key(key)) => match self.press(action(key))? {
                    Effect::Quit => return Ok(End::Quit),
                    _ => is_drawn = true,
                },
                Ok(Event::OtherKey) => {
                    self.press(None)?;
                    is_drawn = true;
                }
                Ok(Event::End(end)) => return Ok(end),
                Err(RecvTimeoutError::Disconnected) => return Ok(End::Quit),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if is_drawn && !self.shows_keys && last.elapsed() >= FRAME_TIME {
                self.draw()?;
                (is_drawn, last) = (false, Instant::now());
            }
        }
    }

    /// Does what a key says. Every key closes the help.
    fn press(&mut self, action: Option<Action>) -> io::Result<Effect> {
        let closes_help = std::mem::take(&mut self.shows_keys);
        if closes_help {
            write("\x1b[2J")?;
        }
        let Some(action) = action else {
            return Ok(Effect::Nothing);
        };
        self.message = None;
        let effect = self.state.apply(action);
        match effect {
            Effect::Nothing | Effect::Quit => {}
            Effect::Redraw => self.refiner.show(self.state.shot()),
            Effect::Save => {
                let saved = save_with_message(&self.state);
                self.message = Some(saved.unwrap_or_else(|message| message));
            }
            Effect::Help if closes_help => {}
            Effect::Help => {
                self.shows_keys = true;
                write_help()?;
            }
        }
        Ok(effect)
    }

    /// Fits the picture into the terminal. Returns true if it is to be drawn again.
    fn fit(&mut self) -> io::Result<bool> {
        let size = terminal_size();
        if std::mem::replace(&mut self.terminal, size) == size {
            return Ok(false);
        }
        if !self.is_fixed && self.state.resize(fitting_size(self.shape)) == Effect::Redraw {
            self.refiner.show(self.state.shot());
        }
        // What a terminal shows of the frame before is undefined.
        write("\x1b[2J")?;
        if self.shows_keys {
            write_help()?;
        }
        Ok(true)
    }

    fn draw(&self) -> io::Result<()> {
        let (rows, columns) = self.terminal;
        let limits = [columns, rows.saturating_sub(LINES_BELOW)];
        let (picture, below) = self.refiner.look(|frame, status| {
            let message = self.message.as_deref();
            let below = self
                .state
                .status_line(status, message, "; h shows the keys");
            (half_blocks_within(frame, limits), below)
        });
        let below: String = below.chars().take(columns.into()).collect();
        write(&format!("\x1b[H{picture}{below}\x1b[K"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gridel_core::render::Block;

    #[test]
    fn picture_fits_the_terminal_and_keeps_its_shape() {
        assert_eq!(fitted([640, 480], [80, 200]), [80, 60]);
        assert_eq!(fitted([640, 480], [80, 48]), [64, 48]);
        assert_eq!(fitted([480, 640], [80, 131_u16]), [80, 107]);
        assert_eq!(fitted([65_535, 1], [80, 48]), [80, 1]);
        assert_eq!(fitted([1, 65_535], [80, 48]), [1, 48]);
        assert_eq!(fitted([3, 2], [0, 0]), [1, 1]);
    }

    #[test]
    fn a_character_is_two_pixels_and_equal_ones_share_a_color() {
        let mut frame = Frame::default();
        frame.prepare([3, 3], false);
        let block = |x, y, width, height| Block {
            x,
            y,
            width,
            height,
        };
        frame.fill(block(0, 0, 3, 1), 0x01_02_03);
        frame.fill(block(0, 1, 2, 1), 0x0a_0b_0c);
        frame.fill(block(0, 2, 3, 1), 0xff_00_80);
        assert_eq!(
            half_blocks(&frame),
            "\x1b[38;2;1;2;3;48;2;10;11;12m▀▀\x1b[38;2;1;2;3;48;2;0;0;0m▀\x1b[0m\n\
             \x1b[38;2;255;0;128m▀▀▀\x1b[0m\n"
        );
    }
}
