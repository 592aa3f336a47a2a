//! Access to files that a scene file names: only those in its own folder and below, unless more is allowed.
//!
//! The folder is that of the file from which everything starts. So a scene may keep imports in
//! folders, and these may name each other. All links are followed before a file's place is checked,
//! so a link that leads outside is outside. Backslashes separate folders as slashes do, on every
//! system.

use super::error::CauseAndRemedy;
use super::error::{SceneError, UNREADABLE};
use super::files::{Files, lexical};
use super::image::Texels;
use crate::table::shortened;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The files that a scene may name.
#[derive(Clone, Debug)]
pub(super) struct Access {
    /// The scene's folder, all links followed; `None` where every file is allowed.
    folder: Option<PathBuf>,
    /// The files in memory, which are all that there is; `None` for those of a disk.
    files: Option<Arc<Files>>,
    /// The texels of images that were read so far.
    pub(super) texels: Texels,
    /// The files that were read so far, of all clones.
    read: Arc<Mutex<Vec<PathBuf>>>,
}

/// The reason why a file that a scene names cannot be used. `E` is the error text.
#[derive(Debug)]
pub(super) enum FileError<E> {
    /// It cannot be read. Pictures are often left behind, so importers can go on without them.
    Unreadable(E),
    /// It holds something else, or lies where it must not.
    Unusable(E),
}

impl<E> FileError<E> {
    /// The error, for callers to whom both are one.
    pub(super) fn into_error(self) -> E {
        match self {
            Self::Unreadable(error) | Self::Unusable(error) => error,
        }
    }
}

impl Access {
    /// Returns the access for the scene that begins with this file.
    pub(super) fn of(scene: &Path, allow_outside: bool) -> Self {
        let folder = folder(scene);
        // A folder that cannot be resolved cannot be read from either, and reading says why.
        let resolved = || folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        Self {
            folder: (!allow_outside).then(resolved),
            files: None,
            texels: Texels::default(),
            read: Arc::default(),
        }
    }

    /// Returns the access for a scene among files in memory.
    pub(super) fn among(files: &Files) -> Self {
        Self {
            folder: None,
            files: Some(Arc::new(files.clone())),
            texels: Texels::default(),
            read: Arc::default(),
        }
    }

    /// Reads a file; not a device, which may have no end.
    pub(super) fn read(&self, path: &Path) -> Result<Vec<u8>, SceneError> {
        let (bytes, remedy) = match &self.files {
            Some(files) => (
                files
                    .find(path)
                    .map(|(_, bytes)| bytes.to_vec())
                    .ok_or_else(not_given),
                "give that file too",
            ),
            None => {
                let bytes = std::fs::metadata(path).and_then(|metadata| match metadata.is_file() {
                    true => std::fs::read(path),
                    false => Err(io::Error::other("it is not a file")),
                });
                if bytes.is_ok() {
                    self.read_files().push(path.to_owned());
                }
                (bytes, "check that the path names a file you may read")
            }
        };
        bytes.map_err(|error| SceneError::new(path, format!("{UNREADABLE}: {error}"), remedy))
    }

    /// The files of a disk that were read so far.
    pub(super) fn read_files(&self) -> MutexGuard<'_, Vec<PathBuf>> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The one path of a file that is there.
    pub(super) fn canonical(&self, path: &Path) -> io::Result<PathBuf> {
        match &self.files {
            Some(files) => files
                .find(path)
                .map(|(path, _)| path.to_owned())
                .ok_or_else(not_given),
            None => path.canonicalize(),
        }
    }

    /// Returns whether a file is there.
    pub(super) fn is_file(&self, path: &Path) -> bool {
        match &self.files {
            Some(files) => files.find(path).is_some(),
            None => path.is_file(),
        }
    }

    /// Returns the path of the file that `name` in `file` refers to.
    ///
    /// # Errors
    /// If it lies outside of the scene's folder: the cause, which names the folder, and the remedy.
    pub(super) fn resolve(&self, file: &Path, name: &str) -> Result<PathBuf, CauseAndRemedy> {
        let slashed = name.replace('\\', "/");
        if self.files.is_some() {
            return Ok(sibling(file, &slashed));
        }
        let found = || {
            let named = sibling(file, name);
            // Elsewhere than on Windows a backslash may belong to the name of a file.
            match self.is_file(&named) {
                true => named,
                false => sibling(file, &slashed),
            }
        };
        let Some(root) = &self.folder else {
            return Ok(found());
        };
        let outside = || {
            CauseAndRemedy::new(
                format!(
                    "{name:?} lies outside of the scene's folder, {}",
                    root.display(),
                    name = shortened(name)
                ),
                String::from(
                    "move the file into that folder, or allow such files with `--allow-outside`",
                ),
            )
        };
        let drive = slashed.as_bytes();
        if drive.len() >= 2 && drive[0].is_ascii_alphabetic() && drive[1] == b':' && !cfg!(windows)
        {
            return Err(outside());
        }
        let here = folder(file);
        let here = here.canonicalize().unwrap_or_else(|_| here.to_owned());
        for name in [name, &slashed] {
            let path = here.join(name);
            if !lexical(&path).starts_with(root) {
                return Err(outside());
            }
            // A file that does not exist has no place; reading reports it.
            if path
                .canonicalize()
                .is_ok_and(|real| !real.starts_with(root))
            {
                return Err(outside());
            }
        }
        Ok(found())
    }
}

fn sibling(file: &Path, name: &str) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).join(name)
}

fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

fn not_given() -> io::Error {
    io::Error::new(
        io::ErrorKind::NotFound,
        "it is not among the files that were given",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_leave_the_folder_are_rejected() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("scene");
        std::fs::create_dir_all(folder.join("sub")).unwrap();
        std::fs::write(outer.path().join("secret.obj"), "").unwrap();
        std::fs::write(folder.join("near.obj"), "").unwrap();
        let file = folder.join("scene.toml");
        let nested = folder.join("sub/nested.toml");
        let access = Access::of(&file, false);
        let near = folder.join("near.obj").display().to_string();
        for name in [
            "near.obj",
            "./near.obj",
            "sub/../near.obj",
            "none.obj",
            "..near",
            &near,
        ] {
            assert!(access.resolve(&file, name).is_ok(), "{name}");
        }
        assert!(access.resolve(&nested, "../near.obj").is_ok());
        for name in [
            "../secret.obj",
            "../none.obj",
            "sub/../../secret.obj",
            "..\\secret.obj",
            "sub\\..\\..\\secret.obj",
            "/etc/passwd",
            "\\\\server\\share\\a.obj",
            "\\etc\\passwd",
            "C:\\a.obj",
            "c:/a.obj",
            "../scene2/near.obj",
        ] {
            let CauseAndRemedy { cause, remedy } = access.resolve(&file, name).unwrap_err();
            assert!(cause.contains(&format!("{name:?}")), "{cause}");
            assert!(cause.contains(&folder.canonicalize().unwrap().display().to_string()));
            assert!(remedy.contains("--allow-outside"));
            assert!(Access::of(&file, true).resolve(&file, name).is_ok());
        }
        assert!(access.resolve(&nested, "../../secret.obj").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_outside_are_rejected() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("scene");
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(outer.path().join("secret.obj"), "").unwrap();
        std::fs::write(folder.join("near.obj"), "").unwrap();
        let link = |from: &Path, to: &str| std::os::unix::fs::symlink(from, folder.join(to));
        link(&outer.path().join("secret.obj"), "out.obj").unwrap();
        link(&folder.join("near.obj"), "in.obj").unwrap();
        link(outer.path(), "up").unwrap();
        let file = folder.join("scene.toml");
        let access = Access::of(&file, false);
        assert!(access.resolve(&file, "in.obj").is_ok());
        assert!(access.resolve(&file, "out.obj").is_err());
        assert!(access.resolve(&file, "up/secret.obj").is_err());
        // The scene's own folder may be reached through a link.
        let around = outer.path().join("around");
        std::os::unix::fs::symlink(&folder, &around).unwrap();
        let file = around.join("scene.toml");
        assert!(Access::of(&file, false).resolve(&file, "near.obj").is_ok());
    }

    #[test]
    fn a_scene_named_without_a_folder_has_the_current_one() {
        let access = Access::of(Path::new("scene.toml"), false);
        assert!(access.resolve(Path::new("scene.toml"), "a.obj").is_ok());
        assert!(access.resolve(Path::new("scene.toml"), "../a.obj").is_err());
        let path = access.resolve(Path::new("scene.toml"), "a.obj").unwrap();
        assert_eq!(lexical(&path), Path::new("a.obj"));
    }
}
