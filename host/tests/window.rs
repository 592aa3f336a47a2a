//! The window of `gridel view` on a display in memory (Xvfb), with real events of mouse and keyboard
//! (xdotool). Ignored where either is missing, unless `GRIDEL_REQUIRE_WINDOW` is 1.

#[allow(dead_code)]
#[path = "cli/program.rs"]
mod program;

#[path = "window/display.rs"]
mod display;

use display::{Display, Pixels};
use libtest_mimic::{Arguments, Failed, Trial};
use program::Folder;
use std::env;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Events that give a window the focus.
const FOCUS: &str = "windowfocus --sync";

/// How long anything may take.
const LIMIT: Duration = Duration::from_secs(60);

fn main() {
    let is_missing = ["Xvfb", "xdotool"].iter().any(|tool| {
        let paths = env::var_os("PATH").unwrap_or_default();
        !env::split_paths(&paths).any(|path| path.join(tool).is_file())
    });
    let required = env::var_os("GRIDEL_REQUIRE_WINDOW").is_some_and(|value| value == "1");
    let needs = "needs Xvfb and xdotool";
    let tests: [(&str, fn()); 9] = [
        ("window_shows_the_picture_of_render", shows_the_picture),
        ("mouse_orbits_pans_and_zooms", mouse_moves_the_camera),
        (
            "keys_change_settings_and_save_the_camera",
            keys_change_settings,
        ),
        ("click_explains_a_pixel", click_explains),
        ("clicks_are_explained_in_order", clicks_in_order),
        ("keys_held_at_focus_are_ignored", held_key),
        ("unread_output_keeps_no_window_open", unread_output),
        ("window_closed_by_another_program_ends", closed_by_another),
        ("display_that_lacks_something_is_an_error", unfit_display),
    ];
    let trials = tests.map(|(name, test)| {
        let trial = Trial::test(name, move || match is_missing {
            true => Err(Failed::from(needs)),
            false => {
                test();
                Ok(())
            }
        });
        let kind = if is_missing { needs } else { "" };
        trial
            .with_kind(kind)
            .with_ignored_flag(is_missing && !required)
    });
    let mut trials = Vec::from(trials);
    trials.push(Trial::test("missing_display_is_said", || {
        missing_display();
        Ok(())
    }));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// The program with a window.
struct Viewer {
    display: Display,
    folder: Folder,
    program: Child,
    lines: Receiver<String>,
    size: [usize; 2],
}

impl Viewer {
    /// Views `quick.gridel` in a window of this size, and waits for its picture.
    fn open(size: [usize; 2]) -> Self {
        Self::open_with(size, &[], FOCUS, Stdio::piped())
    }

    /// Views it with more options, and sends events to the window, which give it the focus. Lines of a piped output
    /// are read.
    fn open_with(size: [usize; 2], options: &[&str], events: &str, out: Stdio) -> Self {
        let folder = Folder::with_quick();
        let display = Display::open();
        let text = format!("{}x{}", size[0], size[1]);
        let mut program = folder
            .command(&[&["view", "quick.gridel", "--size", &text], options].concat())
            .env("DISPLAY", &display.name)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdout(out)
            .spawn()
            .unwrap();
        let (sender, lines) = channel();
        if let Some(out) = program.stdout.take() {
            thread::spawn(move || {
                for line in BufReader::new(out).lines().map_while(Result::ok) {
                    drop(sender.send(line));
                }
            });
        }
        let viewer = Self {
            display,
            folder,
            program,
            lines,
            size,
        };
        viewer.expect(options);
        // No window manager gives it the focus.
        let search = "search --sync --name quick.gridel";
        viewer.display.events(&format!("{search} {events}"));
        viewer
    }

    /// The picture that `render` makes with these options.
    fn rendered(&self, options: &[&str], file: &str) -> Vec<u8> {
        let size = format!("{}x{}", self.size[0], self.size[1]);
        let of = ["render", "quick.gridel", "--size", &size, "-o", file];
        self.folder.done(&[&of, options].concat());
        self.folder.read(file)
    }

    /// Waits until the window shows exactly the picture that `render` makes with these options.
    fn expect(&self, options: &[&str]) -> Pixels {
        let file = self.rendered(options, "expected.ppm");
        let bytes = &file[file.len() - 3 * self.size[0] * self.size[1]..];
        let pixels: Pixels = bytes.chunks(3).map(|it| it.try_into().unwrap()).collect();
        self.expect_pixels(&pixels, &format!("{options:?}"));
        pixels
    }

    fn expect_pixels(&self, expected: &Pixels, what: &str) {
        let begun = Instant::now();
        loop {
            let shown = self.display.pixels(self.size);
            if &shown == expected {
                return;
            }
            let other = shown.iter().zip(expected).filter(|(a, b)| a != b).count();
            assert!(begun.elapsed() < LIMIT, "{what}: {other} pixels differ");
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// Saves the camera under the next number, and returns the options that stand for it.
    fn save(&self, number: u32) -> Vec<String> {
        self.display.events("key s");
        let name = format!("camera-{number}.toml");
        assert_eq!(self.line(), format!("the camera is in {name}"));
        let saved = String::from_utf8(self.folder.read(&name)).unwrap();
        let options = saved.lines().next().unwrap().trim_start_matches("# ");
        options.split(' ').map(String::from).collect()
    }

    /// Waits until the window shows what `render` makes with the camera that it saves.
    fn expect_saved(&self, number: u32) -> Pixels {
        let options = self.save(number);
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        self.expect(&options)
    }

    /// Waits for a line on standard output.
    fn line(&self) -> String {
        self.lines.recv_timeout(LIMIT).expect("a line")
    }

    /// Waits for a title that contains some words.
    fn expect_title(&self, words: &str) -> String {
        let begun = Instant::now();
        loop {
            let title = self.display.title();
            if title.contains(words) {
                return title;
            }
            assert!(begun.elapsed() < LIMIT, "no {words:?} in {title:?}");
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// Quits by its key.
    fn quit(self) {
        self.display.events("key q");
        self.expect_end();
    }

    /// Waits until the program ends without an error.
    fn expect_end(mut self) {
        let begun = Instant::now();
        while begun.elapsed() < LIMIT {
            if let Some(status) = self.program.try_wait().unwrap() {
                assert!(status.success());
                return;
            }
            thread::sleep(Duration::from_millis(20));
        }
        panic!("the window does not close");
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        drop(self.program.kill());
        drop(self.program.wait());
    }
}

fn missing_display() {
    let folder = Folder::with_quick();
    for wayland in [None, Some("wayland-0")] {
        let mut command = folder.command(&["view", "quick.gridel"]);
        for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(name);
        }
        if let Some(name) = wayland {
            command.env("WAYLAND_DISPLAY", name);
        }
        expect_no_window(command, "DISPLAY is not set");
    }
}

fn unfit_display() {
    let folder = Folder::with_quick();
    let of = |display: &Display| {
        let mut command = folder.command(&["view", "quick.gridel"]);
        command.env("DISPLAY", &display.name);
        command
    };
    let bare = Display::with(&["-extension", "RANDR"]);
    expect_no_window(of(&bare), "failed to request XRandR version");
    let display = Display::open();
    let mut command = of(&display);
    command.env("WINIT_X11_SCALE_FACTOR", "bogus");
    expect_no_window(command, "`WINIT_X11_SCALE_FACTOR` invalid");
}

/// Expects an error without a panic.
fn expect_no_window(mut command: Command, cause: &str) {
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    let cause = format!("no window can be opened: {cause}");
    assert!(said.contains(&cause), "{said}");
    assert!(said.contains("--terminal"), "{said}");
}

fn shows_the_picture() {
    let mut viewer = Viewer::open([240, 180]);
    viewer.expect_title("quick.gridel: f32, flagged, 1 sample");
    // The picture follows the window's size.
    for size in [[300, 200], [77, 90]] {
        let resize = format!(
            "search --name quick.gridel windowsize {} {}",
            size[0], size[1]
        );
        viewer.display.events(&resize);
        viewer.size = size;
        viewer.expect(&[]);
    }
    viewer.quit();
}

/// The numbers behind an option, such as `--eye=1,2,3`.
fn vector(options: &[String], name: &str) -> [f64; 3] {
    let values = options.iter().find_map(|option| option.strip_prefix(name));
    let values = values.unwrap().split(',').map(|it| it.parse().unwrap());
    values.collect::<Vec<f64>>().try_into().unwrap()
}

/// From the target to the eye.
fn away(options: &[String]) -> [f64; 3] {
    let [eye, target] = ["--eye=", "--target="].map(|name| vector(options, name));
    [0, 1, 2].map(|k| eye[k] - target[k])
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn mouse_moves_the_camera() {
    let viewer = Viewer::open([240, 180]);
    let first = viewer.save(1);
    let mut before = viewer.expect(&[]);
    let mut changes = |number: u32, events: &str| {
        viewer.display.events(events);
        let options = viewer.save(number);
        let named: Vec<&str> = options.iter().map(String::as_str).collect();
        let picture = viewer.expect(&named);
        assert!(picture != before, "{events} changes nothing");
        before = picture;
        options
    };
    // Over a quarter of the height, to the right: by an eighth of a turn, and the camera goes to the left.
    let drag = "mousemove 100 90 mousedown 1 mousemove 120 90 mousemove 145 90 mouseup 1";
    let orbited = changes(2, drag);
    let [from, to] = [&first, &orbited].map(|it| away(it));
    assert!((length(from) / length(to) - 1.0).abs() < 1e-9);
    assert!((from[1] - to[1]).abs() < 1e-9, "its height stays");
    let turn = to[0].atan2(to[2]) - from[0].atan2(from[2]);
    assert!((turn + std::f64::consts::FRAC_PI_4).abs() < 1e-9, "{turn}");
    let pan = "mousemove 100 90 mousedown 3 mousemove 110 80 mousemove 118 72 mouseup 3";
    let panned = changes(3, pan);
    let [from, to] = [&orbited, &panned].map(|it| away(it));
    assert!([0, 1, 2].iter().all(|&k| (from[k] - to[k]).abs() < 1e-9));
    assert_ne!(vector(&orbited, "--target="), vector(&panned, "--target="));
    // A wheel of buttons: winit takes both their press and their release for a step.
    let zoomed = changes(4, "click 4");
    let share = length(away(&zoomed)) / length(away(&panned));
    assert!((share - 0.64).abs() < 1e-9, "{share}");
    changes(5, "click 5");
    // A picture that has to begin anew all the time gets there.
    let moves: Vec<String> = (0..100)
        .map(|x| format!("mousemove {} 90", 50 + x))
        .collect();
    let drag = format!("mousemove 50 90 mousedown 1 {} mouseup 1", moves.join(" "));
    changes(6, &drag);
    viewer.display.events("key r");
    viewer.expect(&[]);
    viewer.quit();
}

fn keys_change_settings() {
    let viewer = Viewer::open([240, 180]);
    let first = viewer.expect(&[]);
    viewer.display.events("key Right key Up key plus");
    assert!(viewer.expect_saved(1) != first);
    viewer.display.events("key r");
    viewer.expect(&[]);
    viewer.display.events("key ctrl+f key alt+f key f");
    viewer.expect_title("quick.gridel: f64, flagged, 1 sample");
    viewer.expect(&["--format", "f64"]);
    viewer.display.events("key a");
    viewer.expect_title("f64, bvh, 1 sample");
    viewer.display.events("key m");
    viewer.expect_title("f64, bvh, 2 samples");
    viewer.expect(&["--format", "f64", "--samples", "2"]);
    viewer.display.events("key c");
    viewer.expect_title("2 samples, heat map");
    let map = [
        "--format",
        "f64",
        "--samples",
        "2",
        "--accel",
        "bvh",
        "--heat-map",
        "heat.png",
    ];
    viewer.rendered(&map, "expected.ppm");
    let file = viewer.folder.read("heat.png");
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; 3 * viewer.size[0] * viewer.size[1]];
    reader.next_frame(&mut pixels).unwrap();
    let pixels: Pixels = pixels.chunks(3).map(|it| it.try_into().unwrap()).collect();
    viewer.expect_pixels(&pixels, "heat map");
    viewer.display.events("key h");
    assert!(viewer.line().ends_with("orbit to the left"));
    viewer.quit();
}

fn click_explains() {
    let viewer = Viewer::open([240, 180]);
    for pixel in [[120, 90], [0, 0]] {
        let [x, y] = pixel;
        viewer.display.events(&format!("mousemove {x} {y} click 1"));
        let place = format!("{x},{y}");
        let of = [
            "explain",
            "quick.gridel",
            "--size",
            "240x180",
            "--pixel",
            &place,
        ];
        for expected in viewer.folder.done(&of).lines() {
            assert_eq!(viewer.line(), expected);
        }
        // Ends with the line of the title.
        assert_eq!(viewer.line(), "");
        let line = viewer.line();
        assert!(line.starts_with(&format!("pixel {x},{y}: #")), "{line}");
        assert_eq!(viewer.line(), "");
        let title = viewer.expect_title(&format!("quick.gridel: pixel {x},{y}: #"));
        assert_eq!(title.contains("object"), pixel != [0, 0], "{title}");
    }
    viewer.quit();
}

fn clicks_in_order() {
    let viewer = Viewer::open_with([240, 180], &["--samples", "8"], FOCUS, Stdio::piped());
    let places: Vec<String> = (0..10).map(|k| format!("{},90", 100 + 4 * k)).collect();
    let events = places.iter().map(|place| place.replace(',', " "));
    let events: Vec<_> = events
        .map(|place| format!("mousemove {place} click 1"))
        .collect();
    viewer.display.events(&events.join(" "));
    for place in places {
        let begin = format!("Pixel {place} of 240 x 180 is ");
        while !viewer.line().starts_with(&begin) {}
        let note = format!("`gridel explain --pixel {place} --samples 8` explains all.");
        assert!(viewer.line().ends_with(&note));
        let is_end = |line: &str| line.starts_with(&format!("pixel {place}: #"));
        let lines = std::iter::from_fn(|| Some(viewer.line()).filter(|line| !is_end(line)));
        let samples = lines.filter(|line| line.starts_with("Sample "));
        assert_eq!(samples.count(), 4);
    }
    viewer.quit();
}

fn held_key() {
    let events = "keydown q windowfocus --sync keyup q";
    let viewer = Viewer::open_with([240, 180], &[], events, Stdio::piped());
    viewer.display.events("key f");
    viewer.expect_title("quick.gridel: f64");
    viewer.quit();
}

/// Explains more than a pipe holds, which nobody reads.
fn unread_output() {
    let (_reader, writer) = std::io::pipe().unwrap();
    let options = ["--samples", "4"];
    let viewer = Viewer::open_with([240, 180], &options, FOCUS, writer.into());
    let clicks: Vec<String> = (0..12)
        .map(|k| format!("mousemove {} 90 click 1", 80 + 6 * k))
        .collect();
    viewer.display.events(&clicks.join(" "));
    viewer.expect_title("pixel 146,90: #");
    viewer.quit();
}

fn closed_by_another() {
    let viewer = Viewer::open([240, 180]);
    viewer.display.events("key m key m key m key m key m");
    viewer
        .display
        .events("search --name quick.gridel windowclose");
    viewer.expect_end();
}
