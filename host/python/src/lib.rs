//! The Python module `gridel._gridel`: scenes, and queries of NumPy arrays. The package's Python files are what users
//! import.

mod arguments;
mod closed;
mod hit_arrays;
mod load_options;
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
    use gridel_host::compile;

    #[pymodule_export]
    use crate::scene::NativeScene;

    /// The version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// Fewest and most bits of a lattice.
    #[pymodule_export]
    const LATTICE_BITS: (u8, u8) = (*compile::LATTICE_BITS.start(), *compile::LATTICE_BITS.end());
}
