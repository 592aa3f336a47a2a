//! The files that a scene or a blob was read from.

use super::Source;
use crate::cli::failure::Failure;
use crate::cli::output::reject_inputs;
use std::path::{Path, PathBuf};

impl Source {
    /// Rejects to write over the input, or another file that the scene was read from, such as a texture.
    pub fn reject_lost(
        &self,
        outputs: impl IntoIterator<Item = impl AsRef<Path>>,
    ) -> Result<(), Failure> {
        let outputs: Vec<_> = outputs.into_iter().collect();
        reject_inputs(self.input.file(), &outputs, "the input")?;
        let inputs = self.files.iter().map(PathBuf::as_path);
        reject_inputs(inputs, &outputs, "a file that the scene reads")
    }
}
