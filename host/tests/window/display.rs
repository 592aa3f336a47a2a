//! A display in memory (Xvfb), and its events (xdotool).

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// The size of the display; windows lie in its upper left corner.
const SCREEN: [usize; 2] = [400, 320];

pub type Pixels = Vec<[u8; 3]>;

/// A display in memory, whose pixels are in a file.
pub struct Display {
    server: Child,
    pub name: String,
    memory: tempfile::TempDir,
}

impl Display {
    pub fn open() -> Self {
        Self::with(&[])
    }

    /// Opens a display with more options of the server.
    pub fn with(options: &[&str]) -> Self {
        let memory = tempfile::tempdir().unwrap();
        let screen = format!("{}x{}x24", SCREEN[0], SCREEN[1]);
        // The server chooses a number, and writes it to standard output when it is ready.
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-nolisten",
                "tcp",
                "-screen",
                "0",
                &screen,
                "-fbdir",
            ])
            .arg(memory.path())
            .args(options)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut number = String::new();
        let out = server.stdout.as_mut().unwrap();
        BufReader::new(out).read_line(&mut number).unwrap();
        Self {
            server,
            name: format!(":{}", number.trim()),
            memory,
        }
    }

    /// The upper left part of the screen, from a file of X's window dumps.
    pub fn pixels(&self, size: [usize; 2]) -> Pixels {
        let file = fs::read(self.memory.path().join("Xvfb_screen0")).unwrap();
        let number = |at: usize| {
            let bytes = file[4 * at..][..4].try_into().unwrap();
            u32::from_be_bytes(bytes) as usize
        };
        // The header's size, the pixels' byte order (0 for the lowest first), bits per pixel, bytes per row, and
        // the entries of the table of colors, of 12 bytes each.
        let [header, order, bits, stride, colors] = [0, 7, 11, 12, 19].map(number);
        assert_eq!((order, bits), (0, 32));
        let rows = file[header + 12 * colors..].chunks(stride).take(size[1]);
        rows.flat_map(|row| row.chunks(4).take(size[0]))
            .map(|pixel| [pixel[2], pixel[1], pixel[0]])
            .collect()
    }

    /// Sends events.
    pub fn events(&self, events: &str) {
        let done = Command::new("xdotool")
            .args(events.split(' '))
            .env("DISPLAY", &self.name)
            .status();
        assert!(done.unwrap().success(), "{events}");
    }

    /// The title of the window that has the focus.
    pub fn title(&self) -> String {
        let output = Command::new("xdotool")
            .args(["getwindowfocus", "getwindowname"])
            .env("DISPLAY", &self.name)
            .output();
        String::from_utf8(output.unwrap().stdout).unwrap()
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        drop(self.server.kill());
        drop(self.server.wait());
    }
}
