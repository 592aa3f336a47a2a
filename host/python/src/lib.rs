//! The Python module `gridel._gridel`: scenes, and queries of NumPy arrays. The package's Python files are what users
//! import.

mod arguments;
mod closed;
mod hit_arrays;
mod meshes;
mod model;
mod query;
mod rays;
mod scene;
mod threads;

use pyo3::prelude::*;

/// Native code of the package gridel.
#[pymodule]
mod _gridel {
    #[pymodule_export]
    use crate::scene::NativeScene;
}
