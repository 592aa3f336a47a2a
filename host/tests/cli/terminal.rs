//! `gridel view --terminal`.

use crate::program::{Folder, fixture};

type Rows = Vec<Vec<[u8; 3]>>;

/// The pixels of half blocks. An odd last row has no lower pixels.
fn drawn(text: &str) -> Rows {
    let mut rows = Rows::new();
    for line in text.lines() {
        let (mut upper, mut lower) = (Vec::new(), Vec::new());
        let mut colors = [None; 2];
        // Each part begins with the numbers of its colors.
        for part in line.split("\x1b[").skip(1) {
            let (code, cells) = part.split_once('m').unwrap();
            let numbers: Vec<u8> = code.split(';').map(|it| it.parse().unwrap()).collect();
            colors = match numbers[..] {
                [38, 2, a, b, c] => [Some([a, b, c]), None],
                [38, 2, a, b, c, 48, 2, d, e, f] => [Some([a, b, c]), Some([d, e, f])],
                [0] => [None; 2],
                _ => panic!("{code}"),
            };
            for cell in cells.chars() {
                assert_eq!(cell, '▀');
                upper.push(colors[0].unwrap());
                lower.extend(colors[1]);
            }
        }
        assert_eq!(colors, [None; 2], "colors end with the line");
        rows.push(upper);
        rows.extend(Some(lower).filter(|lower| !lower.is_empty()));
    }
    rows
}

/// The pixels that `render` makes.
fn rendered(folder: &Folder, arguments: &[&str], size: [usize; 2]) -> Rows {
    let size_option = format!("{}x{}", size[0], size[1]);
    let of = ["--size", &size_option, "-o", "expected.ppm"];
    folder.done(&[&["render"], arguments, &of[..]].concat());
    let file = folder.read("expected.ppm");
    let pixels = &file[file.len() - 3 * size[0] * size[1]..];
    let rows = pixels.chunks(3 * size[0]);
    rows.map(|row| row.chunks(3).map(|it| it.try_into().unwrap()).collect())
        .collect()
}

fn view(folder: &Folder, arguments: &[&str]) -> Rows {
    drawn(&folder.done(&[&["view", "--terminal"], arguments].concat()))
}

#[test]
fn one_frame_has_the_colors_of_render() {
    let folder = Folder::with_quick();
    let eye = ["quick.gridel", "--eye=3,2,6", "--fov", "50"];
    for arguments in [
        &["quick.gridel"][..],
        &["quick.toml"],
        &["quick.gridel", "--format", "fixed", "--accel", "bvh"],
        &["quick.gridel", "--samples", "3", "--depth", "1"],
        &eye,
    ] {
        let shown = view(&folder, &[arguments, &["--size", "24x17"]].concat());
        assert!(
            shown == rendered(&folder, arguments, [24, 17]),
            "{arguments:?}"
        );
    }
    assert!(rendered(&folder, &eye, [24, 17]) != rendered(&folder, &eye[..1], [24, 17]));
}

#[test]
fn one_frame_without_a_size_has_80_columns_and_the_shape_of_the_scenes_picture() {
    let folder = Folder::with_quick();
    let shown = view(&folder, &["quick.gridel"]);
    assert_eq!((shown[0].len(), shown.len()), (80, 60));
    assert!(shown == rendered(&folder, &["quick.gridel"], [80, 60]));
}

#[test]
fn scenes_from_standard_input_are_viewed() {
    let folder = Folder::with_quick();
    let (run, shown) = folder.piped(
        &["view", "-", "--terminal", "--size", "16x12"],
        &fixture("quick"),
    );
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let shown = drawn(std::str::from_utf8(&shown).unwrap());
    assert!(shown == rendered(&folder, &["quick.gridel"], [16, 12]));
}

#[test]
fn mistakes_are_rejected() {
    let folder = Folder::with_quick();
    let fails = |code, arguments: &[&str], words: &[&str]| {
        folder.fails(code, &[&["view", "--terminal"], arguments].concat(), words);
    };
    fails(1, &["nothing.toml"], &["nothing.toml cannot be read"]);
    fails(
        2,
        &["quick.gridel", "--accel", "grid"],
        &["has no structure grid"],
    );
    fails(
        2,
        &["quick.gridel", "--size", "65535x65535"],
        &["pixels exceed the largest size"],
    );
    fails(
        2,
        &["quick.gridel", "--size", "6500x1"],
        &["64 times the height"],
    );
    fails(2, &["quick.gridel", "--lattice-bits", "12"], &["is a blob"]);
}

#[cfg(not(feature = "view"))]
#[test]
fn program_without_a_window_says_how_to_get_one() {
    let folder = Folder::with_quick();
    let words = ["cargo install gridel-host --features view", "--terminal"];
    folder.fails(2, &["view", "quick.gridel"], &words);
}

#[test]
fn help_lists_the_keys() {
    let help = Folder::new().done(&["view", "--help"]);
    for line in ["  left   orbit to the left", "  q      quit"] {
        assert!(help.contains(line), "{help}");
    }
}

/// In a terminal of its own, which `script` makes.
#[cfg(target_os = "linux")]
mod live {
    use super::*;
    use std::io::{Read, Write};
    use std::process::{Child, ChildStdin, Command, Stdio};
    use std::sync::mpsc::{Receiver, channel};
    use std::time::{Duration, Instant};

    struct Terminal {
        child: Child,
        keys: ChildStdin,
        output: Receiver<Vec<u8>>,
        shown: Vec<u8>,
    }

    impl Terminal {
        /// Begins to view a scene in 30 lines of 40 columns.
        fn open(folder: &Folder, scene: &str) -> Self {
            let program = env!("CARGO_BIN_EXE_gridel");
            let command = format!("stty rows 30 cols 40; exec '{program}' view {scene} --terminal");
            let mut child = Command::new("script")
                .args(["-qec", &command, "/dev/null"])
                .current_dir(folder.path(""))
                .stdin(Stdio::piped())
                .stdout(Stdio::piped())
                .spawn()
                .unwrap();
            let keys = child.stdin.take().unwrap();
            let mut from = child.stdout.take().unwrap();
            let (sender, output) = channel();
            std::thread::spawn(move || {
                let mut buffer = vec![0; 1 << 16];
                while let Ok(read @ 1..) = from.read(&mut buffer) {
                    drop(sender.send(buffer[..read].to_vec()));
                }
            });
            Self {
                child,
                keys,
                output,
                shown: Vec::new(),
            }
        }

        fn press(&mut self, keys: &str) {
            self.keys.write_all(keys.as_bytes()).unwrap();
            self.keys.flush().unwrap();
        }

        /// Waits for a frame that has this line below it, and returns the last one.
        fn frame(&mut self, below: &str) -> Rows {
            let limit = Instant::now() + Duration::from_secs(60);
            loop {
                let text = String::from_utf8_lossy(&self.shown).replace('\r', "");
                let mut frames = text.rsplit("\x1b[H");
                if let Some(frame) = frames.find(|it| it.contains(below) && it.ends_with("\x1b[K"))
                {
                    let (picture, _) = frame.rsplit_once('\n').unwrap();
                    self.shown.clear();
                    return drawn(picture);
                }
                let left = limit.saturating_duration_since(Instant::now());
                let more = self.output.recv_timeout(left);
                self.shown
                    .extend(more.unwrap_or_else(|_| panic!("no {below:?}: {text}")));
            }
        }

        /// Waits for a text, and forgets all that was shown.
        fn wait(&mut self, text: &str) {
            let limit = Instant::now() + Duration::from_secs(60);
            while !String::from_utf8_lossy(&self.shown).contains(text) {
                let left = limit.saturating_duration_since(Instant::now());
                self.shown.extend(self.output.recv_timeout(left).unwrap());
            }
            self.shown.clear();
        }

        /// Waits for the end of the program, and returns what it wrote last.
        fn end(self) -> String {
            self.end_with(0)
        }

        fn end_with(mut self, exit_code: i32) -> String {
            assert_eq!(self.child.wait().unwrap().code(), Some(exit_code));
            self.shown.extend(self.output.iter().flatten());
            String::from_utf8(self.shown).unwrap()
        }
    }

    /// The options that a saved camera states.
    fn options(folder: &Folder, name: &str) -> Vec<String> {
        let saved = String::from_utf8(folder.read(name)).unwrap();
        let options = saved.lines().next().unwrap().trim_start_matches("# ");
        options.split(' ').map(String::from).collect()
    }

    #[test]
    fn keys_move_the_camera_and_save_it() {
        let folder = Folder::with_quick();
        folder.write("camera-1.toml", b"mine");
        let mut terminal = Terminal::open(&folder, "quick.gridel");
        let first = terminal.frame("; h shows the keys");
        // 40 columns are the limit.
        assert!(first == rendered(&folder, &["quick.gridel"], [40, 30]));
        // To the right, up, nearer, and in another number format. Escape is the begin of other keys, and no key.
        terminal.press("\x1b");
        terminal.press("[C\x1bOA+f");
        let moved = terminal.frame("f64, flagged, 1 sample; h");
        assert!(moved != first);
        terminal.press("s");
        terminal.frame("the camera is in camera-2.toml");
        let camera = options(&folder, "camera-2.toml");
        let camera: Vec<&str> = camera.iter().map(String::as_str).collect();
        let of = [&["quick.gridel", "--format", "f64"], &camera[..]].concat();
        assert!(moved == rendered(&folder, &of, [40, 30]));
        assert_eq!(folder.read("camera-1.toml"), b"mine");
        // Back to the first camera and format.
        terminal.press("rff");
        assert!(terminal.frame("f32, flagged, 1 sample; h") == first);
        terminal.press("hm");
        terminal.frame("f32, flagged, 2 samples; h");
        terminal.press("hq");
        let end = terminal.end();
        assert!(end.contains("orbit to the left"), "{end:?}");
        assert!(end.ends_with("\x1b[?25h\x1b[?1049l"), "{end:?}");
    }

    /// The light of a scene without lights lies above a shoulder of its first camera.
    #[test]
    fn saved_camera_and_light_of_a_scene_without_lights_show_the_view() {
        let folder = Folder::new();
        let objects = "[[object]]\nkind = 'box'\nmin = [0, 0, 0]\nmax = [2, 1, 4]\n";
        let orbit = "[[track]]\ntarget = 'camera.orbit'\ntimes = [0, 1]\nvalues = [0, 90]\n";
        folder.write("a.toml", format!("{objects}{orbit}").as_bytes());
        let mut terminal = Terminal::open(&folder, "a.toml");
        let first = terminal.frame("; h shows the keys");
        terminal.press("\x1b[C\x1b[C\x1b[C\x1b[A+f");
        let moved = terminal.frame("f64, wide, 1 sample; h");
        assert!(moved != first);
        terminal.press("s");
        terminal.frame("the camera is in camera-1.toml");
        terminal.press("q");
        terminal.end();
        let saved = String::from_utf8(folder.read("camera-1.toml")).unwrap();
        assert!(saved.contains("tracks of camera.orbit beside"), "{saved}");
        let is_value = |line: &&str| line.starts_with("# ") && line.contains(" = [");
        let values = saved
            .lines()
            .filter(is_value)
            .map(|it| format!("{}\n", &it[2..]));
        let values: String = values.collect();
        folder.write("b.toml", format!("{values}{saved}{objects}").as_bytes());
        assert!(moved == rendered(&folder, &["b.toml", "--format", "f64"], [40, 30]));
    }

    #[test]
    fn help_is_left_by_every_key() {
        let folder = Folder::with_quick();
        let mut terminal = Terminal::open(&folder, "quick.gridel");
        let first = terminal.frame("; h shows the keys");
        // Its own key, one without an action, and one without a character.
        for key in ["h", "z", "\t"] {
            terminal.press("h");
            terminal.wait("Any key returns to the picture.");
            terminal.press(key);
            assert!(terminal.frame("; h shows the keys") == first, "{key:?}");
        }
        terminal.press("q");
        terminal.end();
    }

    #[test]
    fn picture_beyond_the_terminal_is_cut_off() {
        let folder = Folder::with_quick();
        let mut terminal = Terminal::open(&folder, "quick.gridel --size 100x90");
        let shown = terminal.frame("; h shows the keys");
        let mut expected = rendered(&folder, &["quick.gridel"], [100, 90]);
        // A line below the picture is left.
        expected.truncate(2 * 29);
        expected.iter_mut().for_each(|row| row.truncate(40));
        assert!(shown == expected);
        terminal.press("q");
        terminal.end();
    }

    #[test]
    fn interrupt_ends_it_and_the_terminal_is_as_before() {
        let folder = Folder::with_quick();
        let mut terminal = Terminal::open(&folder, "quick.gridel");
        terminal.frame("; h shows the keys");
        terminal.press("\x03");
        let end = terminal.end_with(130);
        assert!(end.ends_with("\x1b[?25h\x1b[?1049l"), "{end:?}");
    }
}

/// Views a blob at a size in a terminal of its own; returns the terminal, its settings before, and the program.
#[cfg(unix)]
fn viewed(
    folder: &Folder,
    size: &str,
) -> (
    nix::pty::OpenptyResult,
    nix::sys::termios::Termios,
    std::process::Child,
) {
    use std::process::{Command, Stdio};

    let terminal = nix::pty::openpty(None, None).unwrap();
    let before = nix::sys::termios::tcgetattr(&terminal.slave).unwrap();
    let side = || Stdio::from(terminal.slave.try_clone().unwrap());
    let view = Command::new(env!("CARGO_BIN_EXE_gridel"))
        .args(["view", "--terminal", "--size", size])
        .arg(folder.path("quick.gridel"))
        .stdin(side())
        .stdout(side())
        .stderr(side())
        .spawn()
        .unwrap();
    (terminal, before, view)
}

/// An interrupt gives the terminal back as it was: its first screen, its cursor, and its settings.
#[cfg(unix)]
#[test]
fn an_interrupted_view_gives_the_terminal_back() {
    use nix::sys::termios::{LocalFlags, tcgetattr};
    use std::io::Read;
    use std::process::Command;

    let folder = Folder::with_quick();
    for signal in ["-TERM", "-INT", "-HUP"] {
        let (terminal, before, mut view) = viewed(&folder, "16x12");
        let mut master = std::fs::File::from(terminal.master.try_clone().unwrap());
        let mut shown = Vec::new();
        let mut bytes = [0; 4096];
        while !shown.windows(3).any(|it| it == "▀".as_bytes()) {
            let count = master.read(&mut bytes).unwrap();
            shown.extend(&bytes[..count]);
        }
        // Keys are read one by one.
        let flags = || tcgetattr(&terminal.slave).unwrap().local_flags;
        while flags().contains(LocalFlags::ICANON) {
            std::thread::yield_now();
        }
        let kill = [signal, &view.id().to_string()];
        assert!(Command::new("kill").args(kill).status().unwrap().success());
        const CLOSED: &[u8] = b"\x1b[?25h\x1b[?1049l";
        while !shown.ends_with(CLOSED) {
            let count = master.read(&mut bytes).unwrap();
            shown.extend(&bytes[..count]);
        }
        assert_eq!(view.wait().unwrap().code(), Some(130), "{signal}");
        assert_eq!(tcgetattr(&terminal.slave).unwrap(), before, "{signal}");
    }
}

/// A terminal that takes nothing, such as one that is stopped, does not keep the program from its end.
#[cfg(unix)]
#[test]
fn an_interrupt_ends_a_view_whose_terminal_takes_nothing() {
    use nix::sys::termios::tcgetattr;
    use std::process::Command;
    use std::time::{Duration, Instant};

    let folder = Folder::with_quick();
    // A frame is larger than what the terminal keeps, and nobody reads it.
    let (terminal, before, mut view) = viewed(&folder, "400x400");
    while tcgetattr(&terminal.slave).unwrap() == before {
        std::thread::yield_now();
    }
    std::thread::sleep(Duration::from_secs(2));
    let kill = ["-TERM", &view.id().to_string()];
    assert!(Command::new("kill").args(kill).status().unwrap().success());
    let begun = Instant::now();
    let code = loop {
        if let Some(status) = view.try_wait().unwrap() {
            break status.code();
        }
        if begun.elapsed() > Duration::from_secs(20) {
            view.kill().unwrap();
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(code, Some(130));
    assert_eq!(tcgetattr(&terminal.slave).unwrap(), before);
}
