//! Blobs in memory and on disk.

use gridel_core::Scene;
use gridel_core::blob::record::ALIGNMENT;
use std::io;
use std::path::Path;

/// A blob's bytes, aligned as the core asks.
#[derive(Clone, Debug)]
pub struct Blob {
    words: Vec<u128>,
    length: usize,
}

const _: () = assert!(align_of::<u128>() == ALIGNMENT && size_of::<u128>() == ALIGNMENT);

impl Blob {
    /// Copies bytes into aligned memory.
    pub fn new(bytes: &[u8]) -> Self {
        let mut words = vec![0_u128; bytes.len().div_ceil(ALIGNMENT)];
        bytemuck::cast_slice_mut(&mut words)[..bytes.len()].copy_from_slice(bytes);
        Self {
            words,
            length: bytes.len(),
        }
    }

    /// Reads a blob file, unchecked.
    pub fn read(path: &Path) -> io::Result<Self> {
        std::fs::read(path).map(|bytes| Self::new(&bytes))
    }

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }

    /// The checked view.
    pub fn scene(&self) -> Result<Scene<'_>, gridel_core::BlobError> {
        Scene::from_bytes(self.bytes())
    }
}
