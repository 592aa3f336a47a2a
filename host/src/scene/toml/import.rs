//! Reading other scene files into this one: each once, and none into itself.

use super::source::{Name, Source};
use crate::scene::access::Access;
use crate::scene::importer::{Choices, Importers, Input};
use crate::scene::{Choice, MoleculeOptions, Scene, SceneError};
use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

/// How many files may be open inside each other; each takes stack.
const MAX_OPEN: usize = 16;

/// Reads a file of this format.
type Read = fn(Input<'_>, &mut Imports) -> Result<Scene, SceneError>;

/// The files that were imported, and those that are being read right now.
pub(super) struct Imports {
    /// The function that reads files of this format, and the format's name.
    own: (&'static str, Read),
    importers: Importers,
    /// Which files may be imported.
    access: Access,
    /// Canonical paths, the outermost file first.
    open: Vec<PathBuf>,
    /// How many groups are open inside each other, in all open files together.
    pub(super) nesting: usize,
    /// A scene may import a file many times, but with few different options.
    done: HashMap<PathBuf, Vec<(Molecules, Rc<Scene>)>>,
    pub(super) warnings: Vec<String>,
    /// Whether a molecule is among the files.
    pub(super) molecules: bool,
    /// Which cameras and animations are read.
    choice: Choice,
    /// Whether a file to choose them from is among the files.
    pub(super) choices: bool,
    /// The assembly of imports that name none.
    assembly: Option<String>,
    /// Whether a file that can hold assemblies is among the files.
    pub(super) assemblies: bool,
}

/// How an import reads molecules.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Molecules {
    pub(super) options: MoleculeOptions,
    /// `None` for that of the command line.
    pub(super) assembly: Option<String>,
}

impl Imports {
    pub(super) fn new(own: (&'static str, Read), input: &Input<'_>) -> Self {
        Self {
            own,
            importers: input.importers,
            access: input.access.clone(),
            open: Vec::new(),
            nesting: 0,
            done: HashMap::new(),
            warnings: Vec::new(),
            molecules: false,
            choice: input.choices.choice.clone(),
            choices: false,
            assembly: input.choices.assembly.map(str::to_owned),
            assemblies: false,
        }
    }

    /// Reads the scene file from which everything starts.
    pub(super) fn root(&mut self, input: Input<'_>) -> Result<Scene, SceneError> {
        // A path that leads nowhere is that of standard input, which nothing can import.
        let canonical = std::fs::canonicalize(input.path).unwrap_or_else(|_| input.path.to_owned());
        self.nested(input, canonical)
    }

    fn nested(&mut self, input: Input<'_>, canonical: PathBuf) -> Result<Scene, SceneError> {
        self.open.push(canonical);
        let scene = (self.own.1)(input, self)?;
        self.open.pop();
        Ok(scene)
    }

    /// Reads the scene that `source` imports by `file`, which is relative to its own folder.
    pub(super) fn import(
        &mut self,
        source: &Source,
        file: &Name,
        molecules: Molecules,
    ) -> Result<Rc<Scene>, SceneError> {
        let allowed = self.access.resolve(&source.path, &file.text);
        let path = allowed.map_err(|[cause, remedy]| {
            source.error(&file.span, format!("the import {cause}"), remedy)
        })?;
        let canonical = std::fs::canonicalize(&path).map_err(|error| {
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
        if let Some((_, scene)) = done.into_iter().find(|(with, _)| *with == molecules) {
            return Ok(Rc::clone(scene));
        }
        let access = self.access.clone();
        let choice = self.choice.clone();
        let assembly = molecules.assembly.clone().or(self.assembly.clone());
        let choices = Choices {
            molecule: &molecules.options,
            assembly: assembly.as_deref(),
            choice: &choice,
        };
        let opened = self.importers.open(&path, choices, &access);
        let scene = opened.and_then(|(importer, input)| {
            if importer.name == self.own.0 {
                return self.nested(input, canonical.clone());
            }
            let imported = importer.import(input)?;
            self.warnings.extend(imported.warnings);
            self.molecules |= imported.molecules;
            self.choices |= imported.choices;
            self.assemblies |= imported.assemblies;
            Ok(imported.scene)
        });
        let scene = scene.map(Rc::new).map_err(|mut error| {
            error.cause = format!("{} (imported by {})", error.cause, source.place(&file.span));
            error
        })?;
        self.done
            .entry(canonical)
            .or_default()
            .push((molecules, Rc::clone(&scene)));
        Ok(scene)
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
