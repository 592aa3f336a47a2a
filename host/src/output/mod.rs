//! Output files that are written whole or not at all.

pub mod unfinished;

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;
use unfinished::unfinished;

/// Writes a file whole or not at all: what was there stays until the new content is complete.
///
/// # Errors
/// As [`Files::add`] and [`Files::keep`]. Then nothing is left behind.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut files = Files::default();
    files.add(path, write)?;
    files.keep().map_err(|(_, error)| error)
}

/// Proves that a file can be written, before the work whose result it is to hold.
///
/// # Errors
/// As [`Files::add`]. The file stays as it is, and one that is not there is not made.
pub fn check_writable(path: &Path) -> io::Result<()> {
    match fs::metadata(path) {
        // A pipe cannot be opened for a test: its reader would take the end of the test for the end of the data.
        Ok(old) if !old.is_file() && !old.is_dir() => Ok(()),
        _ => Files::default().add(path, |_| Ok(())),
    }
}

/// Returns the place of a file, which need not exist: the same for all paths that lead to it.
pub fn place(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let real = path.ancestors().find_map(|ancestor| {
        let rest = path.strip_prefix(ancestor).ok()?;
        let real = ancestor.canonicalize().ok()?;
        // An empty rest would end the path with a separator.
        Some(real.components().chain(rest.components()).collect())
    });
    real.unwrap_or(path)
}

/// Files that belong together: none of them takes its name before all are complete.
///
/// The content of each goes to a new file in its folder. A symbolic link stays one, and its target
/// is replaced. A file without write permission is not replaced either. Devices and pipes cannot be
/// replaced, so they are written to at once.
#[derive(Debug, Default)]
pub struct Files {
    /// Complete files, and the names that they take.
    complete: Vec<(NamedTempFile, PathBuf)>,
}

impl Files {
    /// Writes one more.
    ///
    /// # Errors
    /// If the file cannot be created or written, could not be replaced, or `write` fails.
    pub fn add(
        &mut self,
        path: &Path,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let target = match fs::metadata(path) {
            Ok(old) if old.is_file() => {
                OpenOptions::new().write(true).open(path)?;
                path.canonicalize()?
            }
            Ok(_) => return fill(&OpenOptions::new().write(true).open(path)?, write),
            Err(error) if error.kind() == io::ErrorKind::NotFound => match fs::read_link(path) {
                Ok(missing) => {
                    let folder = path.parent().unwrap_or(Path::new(""));
                    return self.add(&folder.join(missing), write);
                }
                Err(_) => path.to_owned(),
            },
            Err(error) => return Err(error),
        };
        let file = create_beside(&target)?;
        let written = fill(file.as_file(), write)
            .and_then(|()| inherit_permissions(&target, file.as_file()))
            .and_then(|()| file.as_file().sync_all());
        // One that is not complete is dropped with the others.
        self.complete.push((file, target));
        written
    }

    /// Gives all of them their names.
    ///
    /// # Errors
    /// If one cannot be replaced, though [`add`](Self::add) found that it can; with its path. Then
    /// the files before it exist, and those after it do not.
    pub fn keep(mut self) -> Result<(), (PathBuf, io::Error)> {
        let mut unfinished = unfinished();
        let mut files = std::mem::take(&mut self.complete).into_iter();
        let kept = files.try_for_each(|(file, target)| {
            unfinished.paths.retain(|path| path != file.path());
            match file.persist(&target) {
                Ok(_) => Ok(()),
                Err(error) => Err((target, error.error)),
            }
        });
        self.complete = files.collect();
        drop(unfinished);
        kept
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        let mut unfinished = unfinished();
        for (file, _) in self.complete.drain(..) {
            unfinished.paths.retain(|path| path != file.path());
            // It removes itself here, before others can see the list.
            drop(file);
        }
    }
}

fn create_beside(target: &Path) -> io::Result<NamedTempFile> {
    let folder = target.parent().filter(|path| !path.as_os_str().is_empty());
    let mut unfinished = unfinished();
    let file = tempfile::Builder::new()
        .prefix(".gridel-")
        // Created as any new file, and not for its owner alone as other temporary files.
        .make_in(folder.unwrap_or(Path::new(".")), |path| {
            OpenOptions::new().write(true).create_new(true).open(path)
        })?;
    unfinished.paths.push(file.path().to_owned());
    Ok(file)
}

fn fill(file: &File, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut buffered = BufWriter::new(file);
    write(&mut buffered)?;
    buffered.flush()
}

fn inherit_permissions(target: &Path, file: &File) -> io::Result<()> {
    match fs::metadata(target) {
        Ok(old) => file.set_permissions(old.permissions()),
        Err(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        write_whole(&path, |out| out.write_all(b"old")).unwrap();
        let failed = write_whole(&path, |out| {
            out.write_all(b"new")?;
            Err(io::Error::other("no more"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "no more");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["out"]);
        assert!(
            unfinished()
                .paths
                .iter()
                .all(|path| !path.starts_with(folder.path()))
        );
    }

    #[test]
    fn files_that_belong_together_appear_together() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("a"), "old").unwrap();
        fs::create_dir(path("folder")).unwrap();
        let mut files = Files::default();
        files.add(&path("a"), |out| out.write_all(b"new")).unwrap();
        files.add(&path("b"), |out| out.write_all(b"new")).unwrap();
        assert!(files.add(&path("folder"), |_| Ok(())).is_err());
        drop(files);
        assert_eq!(fs::read(path("a")).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a", "folder"]);

        let mut files = Files::default();
        for name in ["a", "b"] {
            files.add(&path(name), |out| out.write_all(b"new")).unwrap();
        }
        assert_eq!(fs::read(path("a")).unwrap(), b"old");
        files.keep().unwrap();
        assert_eq!(fs::read(path("a")).unwrap(), b"new");
        assert_eq!(names(folder.path()), ["a", "b", "folder"]);
    }

    #[test]
    fn proving_leaves_everything_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("old"), "old").unwrap();
        check_writable(&path("old")).unwrap();
        check_writable(&path("new")).unwrap();
        assert!(check_writable(folder.path()).is_err());
        assert!(check_writable(&path("old/new")).is_err());
        let lost = check_writable(&path("lost/new")).unwrap_err();
        assert_eq!(lost.kind(), io::ErrorKind::NotFound);
        assert_eq!(names(folder.path()), ["old"]);
        assert_eq!(fs::read(path("old")).unwrap(), b"old");
    }

    #[cfg(unix)]
    #[test]
    fn paths_to_one_place_are_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("folder")).unwrap();
        fs::write(path("a"), "").unwrap();
        std::os::unix::fs::symlink(path("a"), path("folder/link")).unwrap();
        std::os::unix::fs::symlink(path("folder"), path("other")).unwrap();
        assert_eq!(place(&path("other/link")), place(&path("folder/../a")));
        // And of a file that does not exist yet.
        assert_eq!(
            place(&path("other/lost/b")),
            place(&path("folder/./lost/b"))
        );
        assert_ne!(place(&path("folder/b")), place(&path("b")));
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "old").unwrap();
        fs::set_permissions(&target, PermissionsExt::from_mode(0o640)).unwrap();
        symlink(&target, &link).unwrap();
        write_whole(&link, |out| out.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&target).unwrap(), b"new");
        let mode = fs::metadata(&target).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
        // The target of a link need not exist.
        fs::remove_file(&target).unwrap();
        let second = folder.path().join("second");
        symlink("link", &second).unwrap();
        write_whole(&second, |out| out.write_all(b"newer")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&target).unwrap(), b"newer");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error() {
        let written = write_whole(Path::new("/dev/full"), |out| out.write_all(b"x"));
        assert_eq!(written.unwrap_err().kind(), io::ErrorKind::StorageFull);
    }
}
