//! Places in a scene file.

use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A place in a scene file, for messages. The default one is not known.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceSpan {
    /// Shared by all objects of the file.
    pub file: Arc<PathBuf>,
    /// Line, counted from 1; 0 where the format has no lines.
    pub line: usize,
}

impl SourceSpan {
    /// A whole file.
    pub(super) fn of(path: &Path) -> Self {
        Self {
            file: Arc::new(path.to_owned()),
            line: 0,
        }
    }

    /// Returns whether this names a file.
    pub fn is_known(&self) -> bool {
        !self.file.as_os_str().is_empty()
    }
}

impl std::fmt::Display for SourceSpan {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.line {
            0 => write!(f, "{}", self.file.display()),
            line => write!(f, "{}:{line}", self.file.display()),
        }
    }
}
