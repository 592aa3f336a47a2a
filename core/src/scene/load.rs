//! Loading: from the bytes of a blob to a scene.

use crate::format::{BlobError, Sections};
use crate::scene::blob::Scene;
use crate::scene::prevalidated::Prevalidated;
use crate::scene::{check, read};

impl<'a> Scene<'a> {
    /// Checks a blob and returns a view of it.
    ///
    /// Proves these facts:
    ///
    /// - The alignment, size, version, byte order and checksum are valid.
    /// - Every section lies in the blob, every field lies in its range, and every index leads to a record.
    /// - Every hierarchy is a tree in breadth-first order whose depth is that of the header.
    /// - Boxes lie inside their parents', and primitives inside their leaves', each primitive in one leaf.
    ///
    /// So a walk through any structure ends. A walk through a hierarchy returns the same hits as a test of every
    /// primitive (see [`Structure::is_proved`](crate::Structure::is_proved) for the others).
    ///
    /// Costs time linear in the blob's length, with at most 48 steps for each leaf of a hierarchy, and about 2 KiB of stack, or 3.3 KiB in a build with all features.
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
    /// If a proof fails, or the scene requires an effect or holds a kind of primitive that this build was compiled
    /// without. Also if the blob has parts: [`Scene::with_parts`] loads those. A scene without lights or objects is
    /// valid.
    pub fn from_bytes(blob: &'a [u8]) -> Result<Self, BlobError> {
        Self::with_parts(blob, &[])
    }

    /// Checks a blob that has parts and returns a view of it. The parts must be loaded before: by
    /// [`Parts`](crate::Parts), or one by one from their [blobs](crate::scene::part_blobs).
    ///
    /// Proves all that [`Scene::from_bytes`] proves. Proves also that every instance places a part by a rotation and a
    /// uniform scale, and that its box holds the placed part. The hierarchy above leads to every instance once.
    ///
    /// # Errors
    /// If a proof fails, or these are not all parts of this blob in their order.
    pub fn with_parts(blob: &'a [u8], parts: &'a [Scene<'a>]) -> Result<Self, BlobError> {
        let header = read::header(blob)?;
        check::check_sum(blob, header)?;
        let sections = Sections::read(blob, header.section_count)?;
        // Checked in place, because boards have no stack for a copy.
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
    /// If the slice is not aligned, or the header, the section table or the view is invalid. Also if this build lacks a
    /// feature that the scene requires.
    pub fn prevalidated(blob: Prevalidated<'a>) -> Result<Self, BlobError> {
        let header = read::header(blob.blob)?;
        let sections = Sections::read(blob.blob, header.section_count)?;
        read::scene(header, &sections, &[])
    }
}
