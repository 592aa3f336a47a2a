//! Blobs in memory and on disk.

use crate::simd;
use gridel_core::format::record::{Header, MAGIC, SECTION_ALIGNMENT};
use gridel_core::{BlobError, Scene};
use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// A blob's bytes, aligned as the core requires.
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
pub struct Blob(Loaded);

/// The bytes of a blob to be.
#[derive(Debug)]
pub(crate) struct Buffer {
    words: Vec<u128>,
    length: usize,
}

/// The checked views of a blob's parts, which borrow from its bytes.
type Parts<'b> = Result<Vec<Scene<'b>>, BlobError>;

// A view of a scene borrows the views of its parts, so these have to live as long as the bytes.
self_cell::self_cell!(
    struct Loaded {
        owner: Buffer,
        #[covariant]
        dependent: Parts,
    }
);

const _: () =
    assert!(align_of::<u128>() == SECTION_ALIGNMENT && size_of::<u128>() == SECTION_ALIGNMENT);

impl Buffer {
    /// Returns a buffer with this number of zero bytes.
    pub(crate) fn zeros(length: usize) -> Self {
        Self {
            words: vec![0; length.div_ceil(SECTION_ALIGNMENT)],
            length,
        }
    }

    fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }

    pub(crate) fn bytes_mut(&mut self) -> &mut [u8] {
        &mut bytemuck::cast_slice_mut(&mut self.words)[..self.length]
    }

    /// The blob, whose parts are checked now.
    pub(crate) fn into_blob(self) -> Blob {
        Blob(Loaded::new(self, |buffer| {
            let parts = gridel_core::scene::part_blobs(buffer.bytes())?;
            let load = |part| Ok(Scene::from_bytes(part)?.with_simd(simd::level()));
            parts.map(load).collect()
        }))
    }
}

/// Returns what to do about a file that is no valid blob.
pub fn remedy_of(error: &BlobError) -> &'static str {
    match error {
        BlobError::Truncated { .. } | BlobError::Checksum { .. } => {
            "copy the file again, as binary, or build it again with `gridel build`"
        }
        BlobError::Magic => {
            "blobs are made by `gridel build`; a scene file must have the extension of its format"
        }
        _ => "build it again with `gridel build`",
    }
}

impl Blob {
    /// Copies bytes into aligned memory.
    pub fn new(bytes: &[u8]) -> Self {
        let mut buffer = Buffer::zeros(bytes.len());
        buffer.bytes_mut().copy_from_slice(bytes);
        buffer.into_blob()
    }

    /// Reads a blob file, unchecked.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn read(path: &Path) -> io::Result<Self> {
        std::fs::read(path).map(|bytes| Self::new(&bytes))
    }

    /// Returns the bytes.
    pub fn bytes(&self) -> &[u8] {
        self.0.borrow_owner().bytes()
    }

    /// The header, of a blob that this crate compiled.
    pub(crate) fn header(&self) -> &Header {
        bytemuck::from_bytes(&self.bytes()[..size_of::<Header>()])
    }

    /// Returns the checked view, for queries with [these instructions](crate::simd::level).
    ///
    /// # Errors
    /// If the bytes are no valid blob of this version.
    pub fn scene(&self) -> Result<Scene<'_>, BlobError> {
        // The scene's own faults come first: without a header that is read no part is.
        match self.0.borrow_dependent() {
            Ok(parts) => Ok(Scene::with_parts(self.bytes(), parts)?.with_simd(simd::level())),
            Err(error) => match Scene::from_bytes(self.bytes()) {
                Err(own) if !matches!(own, BlobError::Parts { .. }) => Err(own),
                _ => Err(*error),
            },
        }
    }
}

impl Clone for Blob {
    fn clone(&self) -> Self {
        Self::new(self.bytes())
    }
}

impl PartialEq for Blob {
    fn eq(&self, other: &Self) -> bool {
        self.bytes() == other.bytes()
    }
}

impl fmt::Debug for Blob {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Blob({} bytes)", self.bytes().len())
    }
}

// A scene borrows from its blob.
self_cell::self_cell!(
    struct Checked {
        owner: Blob,
        #[covariant]
        dependent: Scene,
    }
);

/// A valid blob with its checked view, which a program keeps.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # use gridel_host::blob::{Blob, CheckedBlob};
/// let checked = CheckedBlob::new(compile(&imported.scene, &Options::default())?.blob)?;
/// assert_eq!(checked.scene().header().primitives, 1);
/// assert!(CheckedBlob::new(Blob::new(b"no blob")).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct CheckedBlob(Checked);

impl CheckedBlob {
    /// Checks a blob.
    ///
    /// # Errors
    /// If it is no valid blob of this version.
    pub fn new(blob: Blob) -> Result<Self, BlobError> {
        Checked::try_new(blob, Blob::scene).map(Self)
    }

    /// Returns the checked view.
    pub fn scene(&self) -> &Scene<'_> {
        self.0.borrow_dependent()
    }

    /// Returns the bytes.
    pub fn bytes(&self) -> &[u8] {
        self.0.borrow_owner().bytes()
    }
}

/// Returns whether a file begins as a blob does, or has a blob's name. The last two bytes of the magic do not count, so
/// that a blob that was damaged as text is reported as a broken blob.
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
