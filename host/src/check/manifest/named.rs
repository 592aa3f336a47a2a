//! Files and folders that a manifest names.

use crate::scene::SceneError;
use crate::scene::toml::source::Span;
use crate::scene::toml::value::Value;
use std::path::{Path, PathBuf};

/// A file or folder that a manifest names, and where in its text it does.
#[derive(Clone, Debug)]
pub struct Named {
    pub path: PathBuf,
    pub(super) span: Span,
}

impl Named {
    pub(super) fn read(value: Value<'_>, folder: &Path) -> Result<Self, SceneError> {
        Ok(Self {
            path: folder.join(value.filled()?),
            span: value.span(),
        })
    }

    /// Returns true if the folder of the file exists.
    pub fn has_folder(&self) -> bool {
        // The folder of a name alone is empty: the current one.
        let folder = self.path.parent();
        folder.is_none_or(|it| it.as_os_str().is_empty() || it.is_dir())
    }
}
