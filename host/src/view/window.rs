//! A window, with the Cargo feature `view`.

use super::clicks::{self, Click, explain_all};
use super::keys::{Action, Key, action, key_help};
use super::refine::Refiner;
use super::save::save_with_message;
use super::state::{Effect, State};
use super::writer::{self, Texts, UNREAD};
use crate::compile::Names;
use gridel_core::Scene;
use softbuffer::{Context, SoftBufferError, Surface};
use std::any::Any;
use std::env;
use std::fmt::Display;
use std::io::{self, Write};
use std::num::NonZeroU32;
use std::panic::{self, AssertUnwindSafe};
use std::rc::Rc;
use std::sync::mpsc::{self, SyncSender, TrySendError};
use std::thread;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::error::EventLoopError;
use winit::event::{
    ElementState, KeyEvent, MouseButton, MouseScrollDelta, StartCause, WindowEvent,
};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, OwnedDisplayHandle};
use winit::keyboard::{Key as LogicalKey, ModifiersState, NamedKey};
use winit::window::{Window, WindowId};

/// The least time between two frames.
const FRAME_TIME: Duration = Duration::from_millis(16);

/// Time in which a window that cannot be drawn may turn out to be closed.
const CLOSING_TIME: Duration = Duration::from_millis(100);

/// A mouse that moves no further than this, in pixels, while a button is down has clicked.
const CLICK_DISTANCE: f64 = 3.0;

/// Pixels of a touchpad's motion that zoom as one step of a wheel.
const PIXELS_PER_STEP: f64 = 40.0;

/// The content of a window.
#[derive(Clone, Copy)]
pub struct Viewed<'v> {
    pub scene: &'v Scene<'v>,
    pub names: &'v Names,
    /// The beginning of the title.
    pub title: &'v str,
}

/// The reason why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    #[error("{}", without_place(.0))]
    Events(#[from] EventLoopError),
    #[error("{}", without_place(.0))]
    Window(#[from] winit::error::OsError),
    #[error("{}", platform_text(.0))]
    Pixels(#[from] SoftBufferError),
    #[error("DISPLAY is not set; windows need X11, or XWayland under Wayland")]
    NoDisplay,
    /// A display without an extension, or an invalid variable of the environment, for which winit panics.
    #[error("{0}")]
    Display(String),
}

/// The text of an error, without the marks of an optional text around it.
fn platform_text(error: &SoftBufferError) -> String {
    match error {
        SoftBufferError::PlatformError(Some(text), None) => text.clone(),
        SoftBufferError::PlatformError(Some(text), Some(cause)) => format!("{text}: {cause}"),
        _ => error.to_string(),
    }
}

/// Performs a step of opening a window. Returns a panic of winit as an error, and prints nothing.
fn caught<T>(open: impl FnOnce() -> Result<T, WindowError>) -> Result<T, WindowError> {
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let opened = panic::catch_unwind(AssertUnwindSafe(open));
    panic::set_hook(hook);
    opened.unwrap_or_else(|payload| Err(WindowError::Display(panic_text(&*payload))))
}

fn panic_text(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
    text.unwrap_or("the display lacks what a window needs")
        .to_owned()
}

/// Rejects a system without X11, where winit would ask for one of its Cargo features.
fn check_display() -> Result<(), WindowError> {
    let needs_x11 = cfg!(all(unix, not(target_vendor = "apple")));
    let has_x11 = env::var_os("DISPLAY").is_some_and(|name| !name.is_empty());
    match needs_x11 && !has_x11 {
        true => Err(WindowError::NoDisplay),
        false => Ok(()),
    }
}

/// The cause of an error, without the line of winit's source that its text begins with.
fn without_place(error: &impl Display) -> String {
    let text = error.to_string();
    let cause = text.strip_prefix("os error at ");
    match cause.and_then(|cause| cause.split_once(": ")) {
        Some((_, cause)) => cause.to_owned(),
        None => text,
    }
}

/// Shows a scene in a window until it is closed.
///
/// # Errors
/// If there is no display, or no window can be opened.
pub fn run(refiner: &Refiner<'_>, state: State<'_>, viewed: Viewed<'_>) -> Result<(), WindowError> {
    check_display()?;
    let events = caught(|| Ok(EventLoop::<Wake>::with_user_event().build()?))?;
    let proxy = events.create_proxy();
    // At the end the receiver is gone.
    let wake = || drop(proxy.send_event(Wake::Drawn));
    let (clicks, clicked) = mpsc::sync_channel(clicks::MOST_WAITING);
    let (texts, writer) = writer::start();
    let ended = thread::scope(|scope| {
        let (explained, explanations) = (proxy.clone(), texts.clone());
        // Ends with the window, which holds the other end of the channel.
        scope.spawn(move || {
            let show = |click, line| explained.send_event(Wake::Explained(click, line)).is_ok();
            explain_all(&clicked, viewed.scene, viewed.names, &explanations, show);
        });
        refiner.run(&wake, || {
            let mut app = App {
                refiner,
                state,
                viewed,
                clicks,
                texts,
                shown: None,
                last: Instant::now(),
                mouse: Mouse::default(),
                modifiers: ModifiersState::empty(),
                message: None,
                click: 0,
                error: None,
            };
            events.run_app(&mut app)?;
            app.error.map_or(Ok(()), Err)
        })
    });
    writer.finish();
    ended
}

/// The messages of threads to the window.
enum Wake {
    /// There is more of the picture.
    Drawn,
    /// The explanation of a click, in short, and the number of the click.
    Explained(u64, String),
}

/// A window and its pixels.
struct Canvas {
    window: Rc<Window>,
    /// The size of the last event: to ask a window that another program closes is a panic of winit.
    size: PhysicalSize<u32>,
    surface: Surface<OwnedDisplayHandle, Rc<Window>>,
    title: String,
}

/// The mouse, in pixels.
#[derive(Default)]
struct Mouse {
    place: PhysicalPosition<f64>,
    /// The button that is down, and where it went down.
    down: Option<(MouseButton, PhysicalPosition<f64>)>,
    /// True if it has moved since, further than in a click.
    is_drag: bool,
}

struct App<'a> {
    refiner: &'a Refiner<'a>,
    state: State<'a>,
    viewed: Viewed<'a>,
    clicks: SyncSender<Click>,
    texts: Texts,
    shown: Option<Canvas>,
    /// The time at which the window was last drawn.
    last: Instant,
    mouse: Mouse,
    modifiers: ModifiersState,
    /// Shown in the title in place of the settings, until something changes.
    message: Option<String>,
    /// The number of the click whose explanation is awaited. Each change of the view takes a new one.
    click: u64,
    /// The reason to end.
    error: Option<WindowError>,
}

impl ApplicationHandler<Wake> for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match caught(|| self.open(events)) {
            Ok(canvas) => {
                self.shown = Some(canvas);
                self.refiner.show(self.state.shot());
            }
            Err(error) => {
                self.error = Some(error);
                events.exit();
            }
        }
    }

    fn new_events(&mut self, events: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            if self.error.is_some() {
                events.exit();
            }
            events.set_control_flow(ControlFlow::Wait);
            self.request_redraw();
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, wake: Wake) {
        match wake {
            Wake::Explained(click, text) if click == self.click => self.message = Some(text),
            // One of another view or pixel.
            Wake::Explained(..) | Wake::Drawn => {}
        }
        let due = self.last + FRAME_TIME;
        if due <= Instant::now() {
            self.request_redraw();
        } else {
            events.set_control_flow(ControlFlow::WaitUntil(due));
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let effect = match event {
            WindowEvent::CloseRequested => Effect::Quit,
            // Another program closed it, which may have made drawing fail.
            WindowEvent::Destroyed => {
                self.error = None;
                Effect::Quit
            }
            WindowEvent::Resized(size) => {
                if let Some(canvas) = &mut self.shown {
                    canvas.size = size;
                }
                self.request_redraw();
                let side = |side: u32| u16::try_from(side).unwrap_or(u16::MAX).max(1);
                self.state.resize([side(size.width), side(size.height)])
            }
            WindowEvent::ModifiersChanged(modifiers) => {
                self.modifiers = modifiers.state();
                Effect::Nothing
            }
            // A synthetic one was held down when the window got the focus.
            WindowEvent::KeyboardInput {
                event,
                is_synthetic: false,
                ..
            } => match self.action(&event) {
                Some(action) => self.state.apply(action),
                None => Effect::Nothing,
            },
            WindowEvent::CursorMoved { position, .. } => self.mouse_moved(position),
            WindowEvent::MouseInput { state, button, .. } => {
                self.mouse_button(state, button);
                Effect::Nothing
            }
            WindowEvent::MouseWheel { delta, .. } => self.state.zoom(match delta {
                MouseScrollDelta::LineDelta(_, lines) => lines.into(),
                MouseScrollDelta::PixelDelta(by) => by.y / PIXELS_PER_STEP,
            }),
            WindowEvent::RedrawRequested if self.error.is_none() => {
                if let Err(error) = self.draw() {
                    self.error = Some(error.into());
                    events.set_control_flow(ControlFlow::WaitUntil(Instant::now() + CLOSING_TIME));
                }
                Effect::Nothing
            }
            _ => Effect::Nothing,
        };
        match effect {
            Effect::Nothing => {}
            Effect::Redraw => {
                self.clear();
                self.refiner.show(self.state.shot());
                self.request_redraw();
            }
            Effect::Save => self.save(),
            Effect::Help => {
                if !self.texts.write(key_help()) {
                    self.say(String::from(UNREAD));
                }
            }
            Effect::Quit => events.exit(),
        }
    }
}

impl App<'_> {
    fn open(&self, events: &ActiveEventLoop) -> Result<Canvas, WindowError> {
        let settings = self.state.settings();
        let attributes = Window::default_attributes()
            .with_title(self.viewed.title)
            .with_inner_size(PhysicalSize::new(settings.width, settings.height));
        let window = Rc::new(events.create_window(attributes)?);
        let context = Context::new(events.owned_display_handle())?;
        Ok(Canvas {
            size: window.inner_size(),
            surface: Surface::new(&context, window.clone())?,
            window,
            title: String::new(),
        })
    }

    /// Returns the action of a key, alone or with Shift: other combinations are the desktop's.
    fn action(&self, event: &KeyEvent) -> Option<Action> {
        let others = self.modifiers.difference(ModifiersState::SHIFT);
        key(event).filter(|_| others.is_empty()).and_then(action)
    }

    fn request_redraw(&self) {
        if let Some(canvas) = &self.shown {
            canvas.window.request_redraw();
        }
    }

    fn mouse_moved(&mut self, place: PhysicalPosition<f64>) -> Effect {
        let before = std::mem::replace(&mut self.mouse.place, place);
        let Some((button, start)) = self.mouse.down else {
            return Effect::Nothing;
        };
        let way = |from: PhysicalPosition<f64>| [place.x - from.x, place.y - from.y];
        let [right, down] = way(start);
        let from = match self.mouse.is_drag {
            true => before,
            // The way before it became a drag counts, too.
            false => start,
        };
        self.mouse.is_drag |= right.hypot(down) > CLICK_DISTANCE;
        if !self.mouse.is_drag {
            return Effect::Nothing;
        }
        match button {
            MouseButton::Left => self.state.drag(way(from)),
            _ => self.state.pan(way(from)),
        }
    }

    fn mouse_button(&mut self, state: ElementState, button: MouseButton) {
        match (state, self.mouse.down) {
            (ElementState::Pressed, None) => {
                self.mouse.down = Some((button, self.mouse.place));
                self.mouse.is_drag = false;
            }
            (ElementState::Released, Some((pressed, _))) if pressed == button => {
                self.mouse.down = None;
                if button == MouseButton::Left && !self.mouse.is_drag {
                    self.explain();
                }
            }
            _ => {}
        }
    }

    /// Shows the settings in the title. An explanation that is under way is not shown.
    fn clear(&mut self) {
        self.message = None;
        self.click += 1;
    }

    /// Has the pixel under the mouse explained.
    fn explain(&mut self) {
        let shot = self.state.shot();
        let PhysicalPosition { x, y } = self.mouse.place;
        // The cast saturates.
        let pixel = [x as u16, y as u16];
        if pixel[0] >= shot.settings.width || pixel[1] >= shot.settings.height {
            return;
        }
        let [x, y] = pixel;
        let number = self.click + 1;
        let sent = self.clicks.try_send(Click {
            number,
            shot,
            pixel,
        });
        self.say(match sent {
            Err(TrySendError::Full(_)) => {
                let waiting = clicks::MOST_WAITING;
                format!("pixel {x},{y} is not explained: {waiting} others wait; click again later")
            }
            // The thread is there as long as the window.
            Ok(()) | Err(TrySendError::Disconnected(_)) => {
                format!("pixel {x},{y} is being explained")
            }
        });
    }

    fn save(&mut self) {
        let saved = save_with_message(&self.state);
        match &saved {
            // The title says it, too.
            Ok(message) => drop(self.texts.write(format!("{message}\n"))),
            Err(message) => drop(writeln!(io::stderr(), "{message}")),
        }
        self.say(saved.unwrap_or_else(|message| message));
    }

    /// Shows a message in the title. An explanation that is under way is not shown, unless it is of the next click.
    fn say(&mut self, message: String) {
        self.clear();
        self.message = Some(message);
        self.request_redraw();
    }

    /// Draws the frame, stretched while it has not yet the window's size.
    fn draw(&mut self) -> Result<(), softbuffer::SoftBufferError> {
        self.last = Instant::now();
        let Some(canvas) = &mut self.shown else {
            return Ok(());
        };
        let size = canvas.size;
        let sides = [size.width, size.height].map(NonZeroU32::new);
        let [Some(width), Some(height)] = sides else {
            return Ok(());
        };
        canvas.surface.resize(width, height)?;
        let mut pixels = canvas.surface.buffer_mut()?;
        let line = self.refiner.look(|frame, status| {
            frame.stretch(&mut pixels, [width, height].map(|it| it.get() as usize));
            self.state.status_line(status, self.message.as_deref(), "")
        });
        pixels.present()?;
        let title = format!("{}: {line}", self.viewed.title);
        if canvas.title != title {
            canvas.window.set_title(&title);
            canvas.title = title;
        }
        Ok(())
    }
}

/// A key that was pressed, or is repeated.
fn key(event: &KeyEvent) -> Option<Key> {
    if event.state != ElementState::Pressed {
        return None;
    }
    match &event.logical_key {
        LogicalKey::Character(text) => text.chars().next().map(Key::Character),
        LogicalKey::Named(NamedKey::ArrowLeft) => Some(Key::Left),
        LogicalKey::Named(NamedKey::ArrowRight) => Some(Key::Right),
        LogicalKey::Named(NamedKey::ArrowUp) => Some(Key::Up),
        LogicalKey::Named(NamedKey::ArrowDown) => Some(Key::Down),
        LogicalKey::Named(NamedKey::Escape) => Some(Key::Escape),
        _ => None,
    }
}
