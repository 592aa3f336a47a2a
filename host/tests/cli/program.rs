//! Running the program in a folder of its own.

use serde_json::Value;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A folder in which the program runs.
pub struct Folder(TempDir);

/// How a run ended.
#[derive(Debug)]
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Run {
    /// Returns standard error in one line: messages are wrapped at the terminal's width.
    pub fn said(&self) -> String {
        let said = self.stderr.split_whitespace().collect::<Vec<_>>();
        said.join(" ").replace("│ ", "")
    }
}

impl Folder {
    /// An empty folder.
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// A folder with `quick.toml`, and `quick.gridel` built from it with every structure.
    pub fn with_quick() -> Self {
        let folder = Self::new();
        folder.write("quick.toml", &fixture("quick"));
        let accels = ["--accel", "bvh", "--accel", "flagged"];
        folder.done(&[&["build", "quick.toml", "-o", "quick.gridel"], &accels[..]].concat());
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub fn write(&self, name: &str, content: &[u8]) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// The names of all files, hidden ones too.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gridel"));
        command.args(arguments).current_dir(self.0.path());
        command.stdin(Stdio::null());
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Run {
        let output = self.command(arguments).output().unwrap();
        Run {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// A run with these bytes on standard input: how it ended, and the bytes of standard output.
    pub fn piped(&self, arguments: &[&str], input: &[u8]) -> (Run, Vec<u8>) {
        let mut command = self.command(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        let bytes = input.to_owned();
        // The program may end before it has read everything.
        let writer = std::thread::spawn(move || drop(stdin.write_all(&bytes)));
        let output = child.wait_with_output().unwrap();
        writer.join().unwrap();
        let run = Run {
            code: output.status.code(),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        };
        (run, output.stdout)
    }

    /// A run that must succeed: what it printed.
    pub fn done(&self, arguments: &[&str]) -> String {
        let run = self.run(arguments);
        assert_eq!(run.code, Some(0), "{arguments:?}: {}", run.stderr);
        run.stdout
    }

    /// A run that must succeed and print one JSON document and nothing else.
    pub fn json(&self, arguments: &[&str]) -> Value {
        let text = self.done(&[arguments, &["--json"]].concat());
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
    }

    /// A run that must end with an exit code, print nothing, leave all files alone, and say all of
    /// `words` on standard error.
    pub fn fails(&self, code: i32, arguments: &[&str], words: &[&str]) {
        let before = self.snapshot();
        let run = self.run(arguments);
        assert_eq!(run.code, Some(code), "{arguments:?}: {}", run.stderr);
        assert_eq!(run.stdout, "", "{arguments:?}");
        let said = run.said();
        for word in words {
            assert!(said.contains(word), "{arguments:?}: no {word:?} in {said}");
        }
        assert!(before == self.snapshot(), "{arguments:?} changed a file");
    }

    fn snapshot(&self) -> Vec<(String, Option<Vec<u8>>)> {
        let content = |name: &String| {
            let path = self.path(name);
            path.is_file().then(|| std::fs::read(&path).unwrap())
        };
        let names = self.names();
        let contents = names.iter().map(content).collect::<Vec<_>>();
        names.into_iter().zip(contents).collect()
    }
}

/// The text of one of the project's scenes.
pub fn fixture(name: &str) -> Vec<u8> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures"));
    std::fs::read(folder.join(format!("{name}.toml"))).unwrap()
}
