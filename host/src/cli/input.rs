//! The scene or blob that a command reads: a file, or standard input, which is written `-`.
//!
//! Standard input is called `<stdin>` in messages, and is read once, whole. Files that a scene from there
//! names lie in the current folder, as those of a scene file there do.

use super::failure::Failure;
use gridel_host::blob::{self, Blob};
use gridel_host::scene::{self, ImportOptions, Imported, MOST_INPUT, SceneError};
use gridel_host::table::grouped;
use std::fs::File;
use std::io::{self, IsTerminal, Read};
use std::path::{Path, PathBuf};

/// Returns whether a path means standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// Returns the name of a scene in titles and in the names of files: `stdin` for standard input.
pub fn stem(path: &Path) -> String {
    match is_standard(path) {
        true => String::from("stdin"),
        false => path.file_stem().unwrap_or_default().display().to_string(),
    }
}

/// A file, or what came from standard input.
pub struct Input {
    path: PathBuf,
    /// The content of standard input.
    bytes: Option<Vec<u8>>,
}

impl Input {
    /// Opens a file, or reads standard input.
    ///
    /// # Errors
    /// If standard input is a terminal, cannot be read, or is too long.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        Ok(if is_standard(path) {
            Self {
                path: PathBuf::from("<stdin>"),
                bytes: Some(standard_input()?),
            }
        } else {
            Self {
                path: path.to_owned(),
                bytes: None,
            }
        })
    }

    /// Returns its name in messages.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns its path if it is a file.
    pub fn file(&self) -> Option<&Path> {
        self.bytes.is_none().then_some(self.path.as_path())
    }

    /// Returns whether it is a blob, and not a scene file.
    pub fn is_blob(&self) -> Result<bool, Failure> {
        match &self.bytes {
            Some(bytes) => Ok(blob::begins_as_blob(bytes)),
            None => blob::is_blob(&self.path).map_err(|error| Failure::reading(&self.path, &error)),
        }
    }

    /// Returns whether its content begins as that of a blob, whatever its name is.
    pub fn begins_as_blob(&self) -> Result<bool, Failure> {
        let mut start = Vec::new();
        let start = match &self.bytes {
            Some(bytes) => bytes,
            None => {
                let file = File::open(&self.path);
                file.and_then(|it| it.take(8).read_to_end(&mut start))
                    .map_err(|error| Failure::reading(&self.path, &error))?;
                &start
            }
        };
        Ok(blob::begins_as_blob(start))
    }

    /// Returns it as a blob, unchecked.
    pub fn blob(&self) -> Result<Blob, Failure> {
        match &self.bytes {
            Some(bytes) => Ok(Blob::new(bytes)),
            None => Blob::read(&self.path).map_err(|error| Failure::reading(&self.path, &error)),
        }
    }

    /// Returns it as a scene.
    pub fn scene(&self, options: &ImportOptions) -> Result<Imported, SceneError> {
        match &self.bytes {
            Some(bytes) => scene::read(&self.path, bytes.clone(), options),
            None => scene::load_with(&self.path, options),
        }
    }
}

/// Returns all of standard input.
///
/// # Errors
/// If it is a terminal, cannot be read, or is too long.
pub fn standard_input() -> Result<Vec<u8>, Failure> {
    let input = io::stdin().lock();
    if input.is_terminal() {
        return Err(Failure::usage(
            "standard input is a terminal",
            "pipe a file into this command, or name one in place of `-`",
        ));
    }
    let mut bytes = Vec::new();
    let mut most = input.take(MOST_INPUT + 1);
    most.read_to_end(&mut bytes)
        .map_err(|error| Failure::reading(Path::new("<stdin>"), &error))?;
    if bytes.len() as u64 > MOST_INPUT {
        return Err(Failure::failed(
            format!("standard input has more than {} bytes", grouped(MOST_INPUT)),
            "write it to a file, and name that in place of `-`",
        ));
    }
    Ok(bytes)
}
