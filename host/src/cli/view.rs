//! `gridel view`: a scene, live in a window or a terminal.

use super::arguments::{PictureOptions, SceneOptions, TargetPoint, TraceOptions, seconds};
use super::failure::{Failure, INTERRUPTED};
use super::output::print;
use super::source::Source;
use clap::Args;
use gridel_core::{Scene, Settings, Structure};
use gridel_host::output::unfinished::exit_removing_unfinished;
use gridel_host::render::{MOST_PIXELS, too_many_pixels};
use gridel_host::view::terminal::{self, End, fitting_size};
use gridel_host::view::{Refiner, State, key_help};
use std::io::{self, IsTerminal};
use std::path::PathBuf;

/// View a blob or a scene file live, in a window or in the terminal
///
/// The picture appears from coarse to fine, and begins anew when something changes; it becomes the picture of
/// `gridel render`. Dragging with the left mouse button orbits, with another button it pans, and the wheel
/// zooms. A click explains a pixel on standard output, by its first four samples. Windows on Linux are X11's, which
/// Wayland shows with XWayland.
///
/// The key `s` saves the camera in a new file: as options on its first line, and as a table for the scene file, with
/// its lens. Comments name tracks that would move it, and a background that the scene file does not state. A scene
/// file without lights gets a light from its first camera, which stays there while it is viewed. It is saved, too,
/// because `--eye` moves it.
///
/// A key changes among the structures that a blob was built with, and the list of all primitives. A scene file is
/// compiled for `wide`, `flagged` and `bvh`, or for the structure of `--accel` alone.
#[derive(Args)]
#[command(after_help = format!("Keys:\n{}\n{}", key_help(), super::failure::EXIT_CODES))]
pub struct Arguments {
    /// Blob or scene file, or `-` for standard input
    #[arg(value_name = "BLOB|SCENE")]
    input: PathBuf,

    /// Draw with half blocks in the terminal, in colors of 24 bits; one frame, if standard input or
    /// output is not a terminal [default: open a window]
    #[arg(long)]
    terminal: bool,

    /// Show a scene that moves at this time, in seconds [default: as its file states it, without tracks]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    time: Option<f64>,

    #[command(flatten)]
    with: TraceOptions,

    #[command(flatten)]
    picture: PictureOptions,

    #[command(flatten)]
    scene_options: SceneOptions,

    #[command(flatten)]
    target_point: TargetPoint,
}

/// Hierarchies that a scene file is compiled for, among which a key switches. They take little more time to build
/// together than one alone.
const STRUCTURES: [Structure; 3] = [Structure::Wide, Structure::Flagged, Structure::Bvh];

/// Shows a scene.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    #[cfg(not(feature = "view"))]
    if !arguments.terminal {
        return Err(Failure::usage(
            "this program was built without a window",
            "install it with `cargo install gridel-host --features view`, or with `--path host` from its \
             repository; `--terminal` draws in the terminal without it",
        ));
    }
    let size = arguments.picture.size;
    if let Some(cause) = size.and_then(|size| too_many_pixels(size, MOST_PIXELS)) {
        return Err(Failure::usage(
            cause,
            "give a smaller `--size`, or use `gridel render`",
        ));
    }
    let source = Source::to_view(
        &arguments.input,
        &arguments
            .target_point
            .with_target(&arguments.scene_options)
            .sized(arguments.picture.size)
            .at(arguments.time),
        &arguments.with,
        &STRUCTURES,
    )?;
    let scene = source.scene()?;
    let structure = source.structure(&scene, arguments.with.accel)?;
    let settings = arguments.picture.settings(&scene);
    let state = State::new(&scene, arguments.with.format, structure, settings);
    let state = state.noting(source.notes());
    #[cfg(feature = "view")]
    if !arguments.terminal {
        return in_window(arguments, &source, &scene, state);
    }
    in_terminal(arguments, &scene, state)
}

fn in_terminal(
    arguments: &Arguments,
    scene: &Scene<'_>,
    mut state: State<'_>,
) -> Result<(), Failure> {
    let is_fixed = arguments.picture.size.is_some();
    let refiner = Refiner::new(scene);
    let Settings { width, height, .. } = state.settings();
    if io::stdin().is_terminal() && io::stdout().is_terminal() {
        let end = terminal::live(&refiner, state, is_fixed).map_err(|error| {
            Failure::failed(
                format!("the terminal cannot be written: {error}"),
                "use another terminal",
            )
        })?;
        return match end {
            End::Quit => Ok(()),
            End::Interrupted => exit_removing_unfinished(INTERRUPTED),
        };
    }
    if !is_fixed {
        state.resize(fitting_size([width, height]));
    }
    print(terminal::one_frame(&refiner, &state).map_err(Failure::rendering)?)
}

#[cfg(feature = "view")]
fn in_window(
    arguments: &Arguments,
    source: &Source,
    scene: &Scene<'_>,
    mut state: State<'_>,
) -> Result<(), Failure> {
    use gridel_host::view::terminal::fitted;
    use gridel_host::view::window::{self, Viewed};

    let Settings { width, height, .. } = state.settings();
    if arguments.picture.size.is_none() && (width > SCREEN[0] || height > SCREEN[1]) {
        state.resize(fitted([width, height], SCREEN));
    }
    let viewed = Viewed {
        scene,
        names: &source.names(scene),
        title: &arguments.input.display().to_string(),
    };
    window::run(&Refiner::new(scene), state, viewed).map_err(|error| {
        Failure::failed(
            format!("no window can be opened: {error}"),
            "run it where there is a display, with DISPLAY set on Linux; or draw in the terminal with `--terminal`",
        )
    })
}

/// The size of screens that a window fits on, for a scene whose picture is larger.
#[cfg(feature = "view")]
const SCREEN: [u16; 2] = [1280, 960];
