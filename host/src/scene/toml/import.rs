//! Reading other scene files into this one: each once, and none into itself.

use super::source::{Name, Source};
use crate::scene::access::Access;
use crate::scene::importer::{FileOptions, Importers, Input};
use crate::scene::size::Keys;
use crate::scene::{CauseAndRemedy, FileKinds, GltfOptions, MoleculeOptions, Scene, SceneError};
use crate::table::grouped;
use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

/// Maximum number of files that are open inside each other; each takes stack.
const MAX_OPEN: usize = 16;

/// The most bytes of text of open files. While they are read, a byte takes up to 165 bytes of memory.
const MOST_TEXT: usize = 22_000_000;

/// Reads a file of this format.
type Read = fn(Input<'_>, &mut Imports) -> Result<Scene, SceneError>;

/// The files that were imported, and those that are being read right now.
pub(super) struct Imports {
    /// The function that reads files of this format, and the format's name.
    own: (&'static str, Read),
    importers: Importers,
    /// The files that may be imported.
    access: Access,
    /// Canonical paths, the outermost file first.
    open: Vec<PathBuf>,
    /// Bytes of their text.
    text: usize,
    /// Number of groups that are open inside each other, in all open files together.
    pub(super) nesting: usize,
    /// A scene may import a file many times, but with few different options.
    done: HashMap<PathBuf, Vec<(Molecules, Done)>>,
    pub(super) warnings: Vec<String>,
    /// The keys of the tracks of all files, and of each of their imports, which may copy them.
    pub(super) keys: Keys,
    /// The cameras and animations of glTF files.
    gltf: GltfOptions,
    /// The kinds of the files.
    pub(super) kinds: FileKinds,
}

/// Options with which an import reads molecules.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Molecules {
    pub(super) options: MoleculeOptions,
    /// `None` for the atoms as a file lists them.
    pub(super) assembly: Option<String>,
}

/// A file that was read.
#[derive(Clone)]
pub(super) struct Done {
    pub(super) scene: Rc<Scene>,
    pub(super) kinds: FileKinds,
}

impl Imports {
    pub(super) fn new(own: (&'static str, Read), input: &Input<'_>) -> Self {
        Self {
            own,
            importers: input.importers,
            access: input.access.clone(),
            open: Vec::new(),
            text: 0,
            nesting: 0,
            done: HashMap::new(),
            warnings: Vec::new(),
            keys: Keys::default(),
            gltf: input.options.gltf.clone(),
            kinds: FileKinds::default(),
        }
    }

    /// Reads the scene file from which everything starts.
    pub(super) fn root(&mut self, input: Input<'_>) -> Result<Scene, SceneError> {
        // A path that does not exist is that of standard input, which no file can import.
        let canonical = input
            .access
            .canonical(input.path)
            .unwrap_or_else(|_| input.path.to_owned());
        self.nested(input, canonical)
    }

    fn nested(&mut self, input: Input<'_>, canonical: PathBuf) -> Result<Scene, SceneError> {
        let length = input.bytes.len();
        self.text += length;
        if self.text > MOST_TEXT {
            let cause = format!(
                "the text has {} bytes, with the files that import it; the limit is {}",
                grouped(self.text),
                grouped(MOST_TEXT)
            );
            let remedy = "write large meshes as PLY, OBJ or glTF, and import them";
            return Err(SceneError::new(input.path, cause, remedy));
        }
        self.open.push(canonical);
        let scene = (self.own.1)(input, self)?;
        self.open.pop();
        self.text -= length;
        Ok(scene)
    }

    /// Reads the scene that `source` imports by `file`, which is relative to its own folder, and counts its keys.
    pub(super) fn import(
        &mut self,
        source: &Source,
        file: &Name,
        molecules: Molecules,
    ) -> Result<Done, SceneError> {
        let done = self.read(source, file, molecules)?;
        let keys = done.scene.tracks.iter().map(|it| it.keys.len() as u64);
        self.keys.add(keys.sum()).map_err(|excess| {
            source.error(
                &file.span,
                format!("with this import, each import counted, tracks have {excess}"),
                "import files with fewer keys, or import them less often",
            )
        })?;
        Ok(done)
    }

    fn read(
        &mut self,
        source: &Source,
        file: &Name,
        molecules: Molecules,
    ) -> Result<Done, SceneError> {
        let allowed = self.access.resolve(&source.path, &file.text);
        let path = allowed.map_err(|CauseAndRemedy { cause, remedy }| {
            source.error(&file.span, format!("the import {cause}"), remedy)
        })?;
        let canonical = self.access.canonical(&path).map_err(|error| {
            source.error(
                &file.span,
                format!("the import {} cannot be read: {error}", path.display()),
                "check the path; it is relative to the folder of the scene file that imports it",
            )
        })?;
        if let Some(first) = self.open.iter().position(|open| *open == canonical) {
            return Err(source.error(
                &file.span,
                self.circle(first),
                "remove one of these imports",
            ));
        }
        if self.open.len() >= MAX_OPEN {
            return Err(source.error(
                &file.span,
                format!("imports are nested deeper than {MAX_OPEN} files"),
                "import the file nearer to the outermost scene",
            ));
        }
        let done = self.done.get(&canonical).into_iter().flatten();
        if let Some((_, done)) = done.into_iter().find(|(with, _)| *with == molecules) {
            self.kinds = self.kinds.with(done.kinds);
            return Ok(done.clone());
        }
        let access = self.access.clone();
        let gltf = self.gltf.clone();
        let options = FileOptions {
            molecule: &molecules.options,
            assembly: molecules.assembly.as_deref(),
            gltf: &gltf,
        };
        // The kinds of the files below are counted separately, and then added to those before.
        let before = std::mem::take(&mut self.kinds);
        let opened = self.importers.open(&path, options, &access);
        let scene = opened.and_then(|(importer, input)| {
            if importer.name == self.own.0 {
                return self.nested(input, canonical.clone());
            }
            let imported = importer.import(input)?;
            self.warnings.extend(imported.warnings);
            self.kinds = imported.kinds;
            Ok(imported.scene)
        });
        let scene = scene.map(Rc::new).map_err(|mut error| {
            error.cause = format!("{} (imported by {})", error.cause, source.place(&file.span));
            error
        })?;
        let done = Done {
            scene,
            kinds: self.kinds,
        };
        self.kinds = before.with(done.kinds);
        let all = self.done.entry(canonical).or_default();
        all.push((molecules, done.clone()));
        Ok(done)
    }

    /// Describes how the open files from `first` on import each other in a circle.
    fn circle(&self, first: usize) -> String {
        let around = self.open[first..].iter().chain([&self.open[first]]);
        let names = around.map(|path| path.file_name().unwrap_or_default().to_string_lossy());
        let names: Vec<_> = names.collect();
        format!(
            "these files import each other in a circle: {}",
            names.join(" -> ")
        )
    }
}
