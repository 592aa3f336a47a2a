//! Options of a comparison.

use crate::compile::{self, Builder, CompileError, takes_hierarchy};
use crate::picture_rays::PictureRaysError;
use crate::scene::SceneError;
use gridel_core::{BlobError, Format, Structure};
use peak_alloc::PeakAlloc;

/// Options of a comparison.
#[derive(Clone, Debug)]
pub struct Options<'o> {
    pub structures: Vec<Structure>,
    /// Builders of hierarchies. A structure that uses one is a contender with each.
    pub builders: Vec<Builder>,
    /// Options for compiling everything else.
    pub compiling: compile::Options,
    pub format: Format,
    /// Width and height of the picture whose rays are traced; one sample per pixel.
    pub size: [u16; 2],
    /// Instances of the scene file that were [copied](crate::scene::Imported::copied), for the report.
    pub copied: usize,
    /// Number of times that everything is timed; 0 for counts alone.
    pub repeats: usize,
    /// Tests of primitives that a row may spend on one pass over the rays. A row that would need more traces every
    /// second ray, or every third, and so on. Brute force decides about as many.
    pub tests: u64,
    /// The program's allocator, to measure the memory of builders with.
    pub memory: Option<&'o PeakAlloc>,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self {
            structures: Structure::ALL.to_vec(),
            builders: vec![Builder::default()],
            compiling: compile::Options::default(),
            format: Format::F32,
            size: [256, 256],
            copied: 0,
            repeats: 5,
            tests: 400_000_000,
            memory: None,
        }
    }
}

/// A structure and the builder of its hierarchy, if it takes one.
pub type Contender = (Structure, Option<Builder>);

impl Options<'_> {
    /// Returns the number of times that [`compare`](crate::compare::compare) reports progress, if all contenders can be
    /// built and are right.
    pub fn steps(&self) -> u64 {
        let contenders = self.contenders().len();
        (2 + contenders * (2 + self.repeats)) as u64
    }

    /// All contenders.
    pub(super) fn contenders(&self) -> Vec<Contender> {
        let with_builders = |&structure| {
            let builders: Vec<Option<Builder>> = if takes_hierarchy(structure) {
                self.builders.iter().copied().map(Some).collect()
            } else {
                vec![None]
            };
            builders
                .into_iter()
                .map(move |builder| (structure, builder))
        };
        self.structures.iter().flat_map(with_builders).collect()
    }
}

/// An error of a comparison.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum CompareError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Compile(#[from] CompileError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Rays(#[from] PictureRaysError),
    #[error("the growth charts need copies of all instances")]
    #[diagnostic(help("leave `--plot` out, or place fewer instances"))]
    Growth(#[source] SceneError),
    #[error("the thread that is timed cannot be started: {0}")]
    #[diagnostic(help("end other programs"))]
    Thread(String),
    #[error("the compiled blob is rejected: {0}")]
    #[diagnostic(help("this is a fault of gridel: report it with the scene file"))]
    Blob(#[from] BlobError),
}
