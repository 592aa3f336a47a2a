//! Loading: from the bytes of a blob to a scene.

use crate::format::{BlobError, Sections};
use crate::scene::blob::Scene;
use crate::scene::prevalidated::Prevalidated;
use crate::scene::{check, read};

impl<'a> Scene<'a> {
    /// Checks a blob and returns a view of it.
    ///
    /// Proves alignment, size, version, byte order and checksum; that every section lies in the
    /// blob and every field in its range; that every index leads to a record; that every hierarchy
    /// is a tree in breadth-first order whose depth is what the header says, with boxes inside
    /// their parents' and primitives inside their leaves', each primitive in one leaf. After that
    /// a walk through any structure ends, and through a hierarchy it gives the same hits as testing
    /// every primitive (see [`Structure::is_proved`](crate::Structure::is_proved) for the others).
    ///
    /// Costs time linear in the blob's length and about 2 KiB of stack.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{BlobError, Scene};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// assert_eq!(scene.lights().len(), 1);
    /// // A damaged blob is rejected with the reason.
    /// let cut = Scene::from_bytes(&BLOB[..100]);
    /// assert!(matches!(cut, Err(BlobError::Truncated { .. })));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If anything of this fails to hold, or the scene requires an effect, or holds a kind of
    /// primitive, that this build was compiled without, or the blob has parts: those are loaded by
    /// [`Scene::with_parts`]. Shortcomings of the scene itself (no lights, no objects) are no errors.
    pub fn from_bytes(blob: &'a [u8]) -> Result<Self, BlobError> {
        Self::with_parts(blob, &[])
    }

    /// Checks a blob that has parts and returns a view of it. The parts are loaded before: by [`Parts`](crate::Parts), or one by one
    /// from their [blobs](crate::scene::part_blobs).
    ///
    /// Proves what [`Scene::from_bytes`] proves, and that every instance places a part by a rotation and a uniform
    /// scale, that its box holds the placed part, and that the hierarchy above leads to every instance once.
    ///
    /// # Errors
    /// If anything of this fails to hold, or these are not all parts of this blob in their order.
    pub fn with_parts(blob: &'a [u8], parts: &'a [Scene<'a>]) -> Result<Self, BlobError> {
        let header = read::header(blob)?;
        check::check_sum(blob, header)?;
        let sections = Sections::read(blob, header.section_count)?;
        // Checked where it lies: boards have no stack for a copy.
        let scene = read::scene(header, &sections, parts);
        if let Ok(scene) = &scene {
            check::check(scene, &sections)?;
        }
        scene
    }

    /// Returns the view of a [prevalidated](Prevalidated) blob, in constant time.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Prevalidated, Scene};
    ///
    /// let scene = Scene::prevalidated(Prevalidated::of(BLOB)?)?;
    /// assert_eq!(scene.lights().len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the slice is not aligned, or the header, the section table or the view is not as it must
    /// be, or this build lacks what the scene requires.
    pub fn prevalidated(blob: Prevalidated<'a>) -> Result<Self, BlobError> {
        let header = read::header(blob.blob)?;
        let sections = Sections::read(blob.blob, header.section_count)?;
        read::scene(header, &sections, &[])
    }
}
