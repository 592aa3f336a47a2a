//! The table of importers: the description of each scene format, and the input of an importer.

use super::access::Access;
use super::gzip;
use super::text::{Source, check_encoding};
use super::{GltfOptions, ImportOptions, Imported, MoleculeOptions, SceneError};
use crate::table::shortened;
use gridel_core::Up;
use std::fmt;
use std::path::Path;

/// A scene format, and what reads it.
#[derive(Clone, Copy, Debug)]
pub struct Importer {
    /// Name of the format.
    pub name: &'static str,
    /// The content of the format, in one line.
    pub about: &'static str,
    /// Extensions of its files, in lower case and without a dot, the usual one first. Behind each of
    /// them `.gz` may stand.
    pub extensions: &'static [&'static str],
    /// The direction up in its scenes, where a file has no camera that states it.
    pub up: Up,
    /// True if its files may be binary; all formats have a text form.
    pub binary: bool,
    /// A small file in the format, which tests and fuzzers start from.
    pub example: &'static str,
    /// Recognizes a whole file by its content. At most one importer recognizes a file.
    pub(super) recognizes: fn(&[u8]) -> bool,
    /// Reads a file, all but the scene's `up`.
    pub(super) read: fn(Input<'_>) -> Result<Imported, SceneError>,
}

/// Declares the modules of the importers, and lists what they declare as `IMPORTER`.
macro_rules! formats {
    ($($visibility:vis mod $module:ident;)*) => {
        $($visibility mod $module;)*

        /// All scene formats.
        pub const IMPORTERS: &[Importer] = &[$($module::IMPORTER),*];
    };
}
pub(super) use formats;

impl Importer {
    /// Reads a file.
    pub(super) fn import(&self, input: Input<'_>) -> Result<Imported, SceneError> {
        let mut imported = (self.read)(input)?;
        imported.scene.up = self.up;
        Ok(imported)
    }
}

/// A table of importers, in which a file's is found.
#[derive(Clone, Copy)]
pub(super) struct Importers(pub(super) &'static [Importer]);

impl Importers {
    /// The importer of a file with this name: `None` for a name without an extension.
    ///
    /// # Errors
    /// If the name has an extension of another sort.
    fn of_name(self, path: &Path) -> Result<Option<&'static Importer>, SceneError> {
        let Some(extension) = extension(path) else {
            return Ok(None);
        };
        let takes = |it: &&Importer| it.extensions.contains(&extension.as_str());
        let importer = self.0.iter().find(takes);
        importer.map(Some).ok_or_else(|| {
            SceneError::new(
                path,
                format!(
                    "the extension {:?} names no scene format",
                    shortened(&extension)
                ),
                format!("use {}", self.extensions()),
            )
        })
    }

    /// The importer that recognizes the content of a file.
    fn of_content(self, path: &Path, bytes: &[u8]) -> Result<&'static Importer, SceneError> {
        check_encoding(path, bytes)?;
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut all = self.0.iter();
        all.find(|it| (it.recognizes)(bytes)).ok_or_else(|| {
            SceneError::new(
                path,
                "the content is of no scene format, and the name has no extension",
                format!(
                    "give a file whose name ends with its format: {}",
                    self.extensions()
                ),
            )
        })
    }

    /// The extensions of all formats in words.
    pub(super) fn extensions(self) -> String {
        let all: Vec<_> = self.0.iter().flat_map(|it| dotted(it.extensions)).collect();
        match all.split_last() {
            Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
            None => String::new(),
        }
    }

    /// Reads a file, and finds its importer by its name, or by its content if the name has no known
    /// extension.
    pub(super) fn open<'a>(
        self,
        path: &'a Path,
        options: FileOptions<'a>,
        access: &'a Access,
    ) -> Result<(&'static Importer, Input<'a>), SceneError> {
        // A file that no importer can read is not read.
        self.of_name(path)?;
        self.input(path, access.read(path)?, options, access)
    }

    /// Content that was read already.
    pub(super) fn input<'a>(
        self,
        path: &'a Path,
        bytes: Vec<u8>,
        options: FileOptions<'a>,
        access: &'a Access,
    ) -> Result<(&'static Importer, Input<'a>), SceneError> {
        let named = self.of_name(path)?;
        let bytes = gzip::inflate(path, bytes)?;
        let importer = match named {
            Some(importer) => importer,
            None => self.of_content(path, &bytes)?,
        };
        let input = Input {
            importers: self,
            path,
            bytes,
            options,
            access,
        };
        Ok((importer, input))
    }
}

/// The line that documents a format, such as `OFF (.off): Geomview's meshes of polygons; y is up`.
impl fmt::Display for Importer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds = if self.binary { ", text or binary" } else { "" };
        let extensions = dotted(self.extensions).join(", ");
        let up = match self.up {
            Up::Y => "y",
            Up::Z => "z",
        };
        write!(
            f,
            "{} ({extensions}{kinds}): {}; {up} is up",
            self.name, self.about
        )
    }
}

fn dotted(extensions: &[&str]) -> Vec<String> {
    extensions.iter().map(|it| format!(".{it}")).collect()
}

/// Options for the content of a file.
#[derive(Clone, Copy)]
pub(super) struct FileOptions<'a> {
    pub(super) molecule: &'a MoleculeOptions,
    pub(super) assembly: Option<&'a str>,
    pub(super) gltf: &'a GltfOptions,
}

impl<'a> FileOptions<'a> {
    pub(super) fn of(options: &'a ImportOptions) -> Self {
        Self {
            molecule: &options.molecule,
            assembly: options.assembly.as_deref(),
            gltf: &options.gltf,
        }
    }
}

/// A file on its way to an importer.
pub(super) struct Input<'a> {
    /// Importers of files that this one names.
    pub(super) importers: Importers,
    /// Names the file in messages, and its folder is where files are that it names.
    pub(super) path: &'a Path,
    /// The content, inflated if the file was gzipped.
    pub(super) bytes: Vec<u8>,
    pub(super) options: FileOptions<'a>,
    pub(super) access: &'a Access,
}

impl Input<'_> {
    /// The content as text.
    ///
    /// # Errors
    /// If it is in UTF-16 or UTF-32.
    pub(super) fn into_source(self) -> Result<Source, SceneError> {
        check_encoding(self.path, &self.bytes)?;
        Ok(Source::from_bytes(self.path, self.bytes))
    }
}

/// The extension of a file's name in lower case, without the `.gz` behind it.
pub(super) fn extension(path: &Path) -> Option<String> {
    let extension = |path: &Path| Some(path.extension()?.to_string_lossy().to_ascii_lowercase());
    match extension(path)?.as_str() {
        "gz" => extension(Path::new(path.file_stem()?)),
        other => Some(other.to_owned()),
    }
}

/// The name of a file without folder and extension.
pub(super) fn stem(path: &Path) -> String {
    let gzipped = path
        .extension()
        .is_some_and(|it| it.eq_ignore_ascii_case("gz"));
    let stem = path.file_stem().unwrap_or_default();
    let stem = match Path::new(stem).file_stem() {
        Some(inner) if gzipped => inner,
        _ => stem,
    };
    stem.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests;
