//! stub
use super::*;
pub(super) fn load(path: &Path, _: &MoleculeOptions) -> Result<Imported, SceneError> {
    Err(SceneError::new(path, "x", "y"))
}
