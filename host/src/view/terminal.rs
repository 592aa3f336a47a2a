//! Half blocks in a terminal: two pixels per character, in colors of 24 bits.

use super::frame::Frame;
use super::keys::{Action, Key, action, key_help};
use super::refine::Refiner;
use super::save::save;
use super::shot::ViewError;
use super::state::{Effect, State};
use crate::output::unfinished::gives_back;
use console::Term;
use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;
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
    let size = Term::stdout().size_checked();
    let (rows, columns) = size.unwrap_or((u16::MAX, COLUMNS));
    let height = rows.saturating_sub(LINES_BELOW).saturating_mul(2);
    fitted(shape, [columns, height])
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
    let colors: Vec<u32> = frame.colors().collect();
    let rows: Vec<&[u32]> = colors.chunks(usize::from(frame.width.max(1))).collect();
    let mut text = String::new();
    for pair in rows.chunks(2) {
        let mut before = None;
        for x in 0..usize::from(frame.width) {
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

/// Shows a scene until the user quits. The picture fits the terminal, or keeps its size if `is_fixed`.
///
/// # Errors
/// If standard output cannot be written.
pub fn live(refiner: &Refiner<'_>, state: State<'_>, is_fixed: bool) -> io::Result<()> {
    let (sender, receiver) = channel();
    let wake = sender.clone();
    // Before a key is read, which changes the terminal's settings for that time.
    let _screen = Screen::open()?;
    thread::scope(|scope| {
        scope.spawn(move || read_keys(&sender));
        // At the end the receiver is gone.
        let wake = || drop(wake.send(Event::Drawn));
        refiner.run(&wake, || {
            Live {
                refiner,
                shape: [state.settings().width, state.settings().height],
                state,
                is_fixed,
                message: None,
                shows_keys: false,
            }
            .run(&receiver)
        })
    })
}

/// The events while a scene is shown.
enum Event {
    Key(Key),
    /// There is more of the picture.
    Drawn,
    /// No more keys can be read.
    End,
}

/// Sends keys until one of them quits.
fn read_keys(sender: &Sender<Event>) {
    let terminal = Term::stdout();
    loop {
        let event = match terminal.read_key_raw() {
            Ok(console::Key::Char(c)) => Event::Key(Key::Character(c)),
            Ok(console::Key::ArrowLeft) => Event::Key(Key::Left),
            Ok(console::Key::ArrowRight) => Event::Key(Key::Right),
            Ok(console::Key::ArrowUp) => Event::Key(Key::Up),
            Ok(console::Key::ArrowDown) => Event::Key(Key::Down),
            Ok(console::Key::Escape) => Event::Key(Key::Escape),
            Ok(console::Key::CtrlC) | Err(_) => Event::End,
            Ok(_) => continue,
        };
        let is_last = match event {
            Event::Key(key) => action(key) == Some(Action::Quit),
            _ => true,
        };
        if sender.send(event).is_err() || is_last {
            return;
        }
    }
}

/// The terminal's second screen, without a cursor; the first one returns in the end.
struct Screen;

/// Shows the first screen and the cursor.
const CLOSED: &str = "\x1b[0m\x1b[?25h\x1b[?1049l";

impl Screen {
    fn open() -> io::Result<Self> {
        let restore = settings();
        gives_back(Some(Box::new(move || {
            // Nothing is drawn any more.
            let mut out = std::mem::ManuallyDrop::new(io::stdout().lock());
            let _ = out.write_all(CLOSED.as_bytes()).and_then(|()| out.flush());
            restore();
        })));
        write("\x1b[?1049h\x1b[?25l\x1b[2J")?;
        Ok(Self)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        gives_back(None);
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

/// A scene that is shown.
struct Live<'r, 's> {
    refiner: &'r Refiner<'s>,
    state: State<'s>,
    /// The width and height whose ratio the picture has.
    shape: [u16; 2],
    is_fixed: bool,
    /// Shown in place of the settings until the next key.
    message: Option<String>,
    /// True if the keys are shown in place of the picture.
    shows_keys: bool,
}

impl Live<'_, '_> {
    fn run(&mut self, events: &Receiver<Event>) -> io::Result<()> {
        self.refiner.show(self.state.shot());
        let mut is_drawn = false;
        let mut last = Instant::now();
        loop {
            self.fit()?;
            // No event reports another size of the terminal, so it is checked now and then.
            let timeout = match is_drawn && !self.shows_keys {
                true => FRAME_TIME.saturating_sub(last.elapsed()),
                false => LOOK_TIME,
            };
            match events.recv_timeout(timeout) {
                Ok(Event::Drawn) => is_drawn = true,
                Ok(Event::Key(key)) => {
                    let Some(action) = action(key) else { continue };
                    self.message = None;
                    if std::mem::take(&mut self.shows_keys) {
                        write("\x1b[2J")?;
                    }
                    match self.state.apply(action) {
                        Effect::Nothing => {}
                        Effect::Redraw => self.refiner.show(self.state.shot()),
                        Effect::Save => self.message = Some(self.save()),
                        Effect::Help => {
                            write(&format!("\x1b[H\x1b[2J{}", key_help()))?;
                            self.shows_keys = true;
                        }
                        Effect::Quit => return Ok(()),
                    }
                    is_drawn = true;
                }
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => return Ok(()),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if is_drawn && !self.shows_keys && last.elapsed() >= FRAME_TIME {
                self.draw()?;
                (is_drawn, last) = (false, Instant::now());
            }
        }
    }

    /// Draws the picture in the terminal's size.
    fn fit(&mut self) -> io::Result<()> {
        if !self.is_fixed && self.state.resize(fitting_size(self.shape)) == Effect::Redraw {
            write("\x1b[2J")?;
            self.refiner.show(self.state.shot());
        }
        Ok(())
    }

    fn draw(&self) -> io::Result<()> {
        let (picture, below) = self.refiner.look(|frame, status| {
            let settings = self.state.description();
            let below = match (&status.error, &self.message) {
                (Some(error), _) => error.to_string(),
                (None, Some(message)) => message.clone(),
                (None, None) if status.share < 1.0 => {
                    format!("{settings}, {:.0} %", 100.0 * status.share)
                }
                (None, None) => format!("{settings}; h shows the keys"),
            };
            (half_blocks(frame), below)
        });
        let columns = Term::stdout().size().1;
        let below: String = below.chars().take(columns.into()).collect();
        write(&format!("\x1b[H{picture}{below}\x1b[K"))
    }

    fn save(&self) -> String {
        match save(self.state.camera(), Path::new("")) {
            Ok(path) => format!("the camera is in {}", path.display()),
            Err(error) => format!("the camera cannot be saved: {error}"),
        }
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
