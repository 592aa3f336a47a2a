//! Blobs in memory and on disk.

use crate::simd;
use gridel_core::format::record::{ALIGNMENT, MAGIC};
use gridel_core::{Scene, Structure};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// A blob's bytes, aligned as the core asks.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # use gridel_host::blob::Blob;
/// let blob = compile(&imported.scene, &Options::default())?.blob;
/// let copy = Blob::new(blob.bytes());
/// assert_eq!(copy.scene()?.header().primitives, 1);
/// assert!(Blob::new(b"no blob").scene().is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Blob {
    words: Vec<u128>,
    length: usize,
}

const _: () = assert!(align_of::<u128>() == ALIGNMENT && size_of::<u128>() == ALIGNMENT);

impl Blob {
    /// Copies bytes into aligned memory.
    pub fn new(bytes: &[u8]) -> Self {
        let mut blob = Self::zeros(bytes.len());
        blob.bytes_mut().copy_from_slice(bytes);
        blob
    }

    /// So many zeros, to be written to.
    pub(crate) fn zeros(length: usize) -> Self {
        Self {
            words: vec![0; length.div_ceil(ALIGNMENT)],
            length,
        }
    }

    pub(crate) fn bytes_mut(&mut self) -> &mut [u8] {
        &mut bytemuck::cast_slice_mut(&mut self.words)[..self.length]
    }

    /// Reads a blob file, unchecked.
    pub fn read(path: &Path) -> io::Result<Self> {
        std::fs::read(path).map(|bytes| Self::new(&bytes))
    }

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }

    /// The checked view, for queries with [these instructions](crate::simd::level).
    pub fn scene(&self) -> Result<Scene<'_>, gridel_core::BlobError> {
        Ok(Scene::from_bytes(self.bytes())?.with_simd(simd::level()))
    }
}

/// Returns whether a file begins as a blob does, or is named like one and so was meant as one. The last two
/// bytes of the magic do not count, so that a blob that was mangled as text is called a broken blob.
///
/// # Errors
/// If the file cannot be read.
pub fn is_blob(path: &Path) -> io::Result<bool> {
    // Opening a pipe waits for whoever writes to it.
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::other("it is not a file"));
    }
    let file = File::open(path)?;
    let mut start = Vec::new();
    file.take(6).read_to_end(&mut start)?;
    let named = path
        .extension()
        .is_some_and(|extension| extension == "gridel");
    Ok(named || begins_as_blob(&start))
}

/// Returns whether bytes begin as a blob does, the last two bytes of the magic aside.
///
/// ```
/// use gridel_host::blob::begins_as_blob;
///
/// assert!(begins_as_blob(b"GRIDEL\x1a\n"));
/// assert!(!begins_as_blob(b"ply\n"));
/// ```
pub fn begins_as_blob(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC[..6])
}

/// Returns the structures that a scene holds; a command's default comes first.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::Structure;
/// use gridel_host::blob::best_structures;
///
/// let structures: Vec<_> = best_structures(&scene).collect();
/// assert_eq!(structures, [Structure::DualSplit, Structure::List]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn best_structures(scene: &Scene<'_>) -> impl Iterator<Item = Structure> {
    const BEST_FIRST: [Structure; Structure::ALL.len()] = [
        Structure::Wide,
        Structure::Apex,
        Structure::RayClasses,
        Structure::CylinderCubeEntry,
        Structure::DualSplit,
        Structure::Flagged,
        Structure::Bvh,
        Structure::FlaggedSlabs,
        Structure::Slabs,
        Structure::Grid,
        Structure::Octree,
        Structure::Spheres,
        Structure::CylinderCubeTight,
        Structure::CylinderCube,
        Structure::List,
    ];
    BEST_FIRST
        .into_iter()
        .filter(|&structure| scene.holds(structure))
}
