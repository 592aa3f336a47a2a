//! Blobs whose meshes are as their morph targets have them.

use crate::blob::{Blob, Buffer};
use crate::deformation;
use bytemuck::NoUninit;
use gridel_core::deform::{DeformError, MorphTargets};
use gridel_core::format::record::{Header, SectionEntry, Vertex16, Vertex24};
use gridel_core::format::width::Vertex;
use gridel_core::format::{SectionKind, checksum};
use gridel_core::{BlobError, Scene};
use std::mem::offset_of;
use std::ops::Range;

/// The reason why a blob cannot have these weights.
#[derive(Debug, thiserror::Error)]
pub enum MorphError {
    /// The blob is not valid.
    #[error(transparent)]
    Blob(#[from] BlobError),
    /// Weights or meshes do not fit the morph targets.
    #[error(transparent)]
    Deform(#[from] DeformError),
    /// The corners of a triangle come to lie on a line.
    #[error("the corners of primitive {primitive}, a triangle of object {object}, lie on a line")]
    Collapsed {
        /// Number of the object in the scene and its parts.
        object: u32,
        /// Number of the triangle in the scene and its parts, in the order of the scene file.
        primitive: u32,
    },
}

/// Returns the blob of a scene with vertices, normals and boxes as its morph targets have them with these weights,
/// which have 24 fraction bits; `None` if no vertex moves. A device that
/// [morphs](gridel_core::deform::DeformationIn::morph) its meshes sees the same, bit for bit.
///
/// ```
/// # let file = "[morph.up]\n[[object]]\nkind = 'triangle'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
/// #     morph = { up = [[0, 0, 0], [0, 0, 0], [0, 0, 1]] }";
/// # let imported = gridel_host::scene::read("flag.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_core::Structure;
/// use gridel_host::compile::{Options, compile};
/// use gridel_host::morphed::morphed;
///
/// let options = Options { structures: vec![Structure::Bvh], ..Options::default() };
/// let blob = compile(&imported.scene, &options)?.blob;
/// let scene = blob.scene()?;
/// let halfway = morphed(&blob, &scene, &[1 << 23])?.expect("a vertex moves");
/// assert_ne!(halfway.scene()?.triangle(0), scene.triangle(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If there are more or fewer weights than morph targets, one is beyond ±64, or a mesh cannot be so. Also if the scene
/// is not the blob's.
pub fn morphed(
    blob: &Blob,
    scene: &Scene<'_>,
    weights: &[i32],
) -> Result<Option<Blob>, MorphError> {
    let bytes = blob.bytes();
    let mut moved: Option<Buffer> = None;
    let of_part = |part| scene.first_primitive_of_part(part).unwrap_or(0);
    let firsts = std::iter::once(0).chain((0..).map(of_part));
    let scenes = std::iter::once(scene).chain(scene.parts()).zip(firsts);
    let meshes = scenes.zip(morph_targets(bytes)?).zip(blob_ranges(bytes)?);
    for (((mesh, first), targets), range) in meshes {
        if targets.is_empty() {
            continue;
        }
        let moved = moved.get_or_insert_with(|| {
            let mut copy = Buffer::zeros(bytes.len());
            copy.bytes_mut().copy_from_slice(bytes);
            copy
        });
        let moved = &mut moved.bytes_mut()[range];
        let written = match mesh.header().storage_bits {
            16 => write::<Vertex16>(mesh, &targets, weights, moved),
            _ => write::<Vertex24>(mesh, &targets, weights, moved),
        };
        written.map_err(|error| match error {
            DeformError::Collapsed { primitive } => MorphError::Collapsed {
                object: scene.object(first + primitive),
                primitive: first + primitive,
            },
            error => error.into(),
        })?;
        seal(moved);
    }
    Ok(moved.map(|mut moved| {
        // Parts have changed.
        seal(moved.bytes_mut());
        moved.into_blob()
    }))
}

/// Checks the morph targets of a blob and returns them: those of the scene's own meshes, then those of each part.
///
/// ```
/// # let file = "[morph.up]\n[[object]]\nkind = 'triangle'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
/// #     morph = { up = [[0, 0, 0], [0, 0, 0], [0, 0, 1]] }";
/// # let imported = gridel_host::scene::read("flag.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_core::Structure;
/// use gridel_host::compile::{Options, compile};
/// use gridel_host::morphed::morph_targets;
///
/// let options = Options { structures: vec![Structure::Bvh], ..Options::default() };
/// let blob = compile(&imported.scene, &options)?.blob;
/// assert!(!morph_targets(blob.bytes())?[0].is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If they are not valid.
pub fn morph_targets(blob: &[u8]) -> Result<Vec<MorphTargets<'_>>, BlobError> {
    let own = MorphTargets::from_bytes(blob)?;
    let parts = gridel_core::scene::part_blobs(blob)?.map(|part| own.of_part(part));
    std::iter::once(Ok(own)).chain(parts).collect()
}

/// Writes the moved vertices and normals of a blob, and its boxes.
fn write<V: Vertex + NoUninit>(
    scene: &Scene<'_>,
    targets: &MorphTargets<'_>,
    weights: &[i32],
    blob: &mut [u8],
) -> Result<(), DeformError> {
    let mut mesh = deformation::of::<V>(scene)?;
    mesh.morph(scene, targets, weights)?;
    replace(blob, SectionKind::Vertices, mesh.vertices());
    replace(blob, SectionKind::Pairs, mesh.pairs());
    replace(blob, SectionKind::Normals, mesh.normals());
    Ok(())
}

/// Replaces the records of a section by as many others.
fn replace<T: NoUninit>(blob: &mut [u8], kind: SectionKind, records: &[T]) {
    let bytes: &[u8] = bytemuck::cast_slice(records);
    let start = section(blob, kind).map_or(0, |entry| entry.offset as usize);
    blob[start..start + bytes.len()].copy_from_slice(bytes);
}

/// The entry of a section of a valid blob.
fn section(blob: &[u8], kind: SectionKind) -> Option<SectionEntry> {
    let header: &Header = bytemuck::from_bytes(&blob[..size_of::<Header>()]);
    let table = &blob[size_of::<Header>()..];
    let table = &table[..usize::from(header.section_count) * size_of::<SectionEntry>()];
    let entries: &[SectionEntry] = bytemuck::cast_slice(table);
    entries.iter().find(|it| it.kind == kind as u16).copied()
}

/// Returns the byte ranges of a valid blob and of its parts.
fn blob_ranges(blob: &[u8]) -> Result<Vec<Range<usize>>, BlobError> {
    let start = blob.as_ptr() as usize;
    let parts = gridel_core::scene::part_blobs(blob)?;
    let parts = std::iter::once(blob).chain(parts);
    Ok(parts
        .map(|part| {
            let from = part.as_ptr() as usize - start;
            from..from + part.len()
        })
        .collect())
}

/// Writes the checksum of a blob.
fn seal(blob: &mut [u8]) {
    let place = offset_of!(Header, checksum);
    let sum = checksum(blob);
    blob[place..place + size_of_val(&sum)].copy_from_slice(&sum.to_ne_bytes());
}
