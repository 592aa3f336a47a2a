//! Deforming meshes of any size: vertices and boxes on the heap.

use gridel_core::Scene;
use gridel_core::deform::{DeformError, DeformationIn, Memory};
use gridel_core::format::record::Pair;
use gridel_core::format::width::Vertex;
use std::ops::{Deref, DerefMut};

/// A [`Deformation`](gridel_core::Deformation) that takes as much memory as its scene needs.
///
/// ```
/// # let file = "[[object]]\nkind = 'mesh'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]";
/// # let imported = gridel_host::scene::read("flag.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_core::Structure;
/// use gridel_core::format::record::Vertex24;
/// use gridel_host::compile::{Options, compile};
/// use gridel_host::deformation::{HeapDeformation, of};
///
/// let options = Options {
///     structures: vec![Structure::Bvh],
///     room: 0.25,
///     ..Options::default()
/// };
/// let blob = compile(&imported.scene, &options)?.blob;
/// let scene = blob.scene()?;
/// let mut mesh: HeapDeformation<Vertex24> = of(&scene)?;
/// for vertex in mesh.vertices_mut() {
///     vertex.0[2] += 256;
/// }
/// mesh.refit(&scene)?;
/// let moved = scene.with_deformation(&mesh)?;
/// assert_ne!(moved.triangle(0), scene.triangle(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub type HeapDeformation<V> = DeformationIn<V, Grown<V>, Grown<Pair>, Grown<[i16; 2]>>;

/// Records on the heap, as many as are needed.
#[derive(Clone, Debug)]
pub struct Grown<T>(Vec<T>);

impl<T> Default for Grown<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Deref for Grown<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> DerefMut for Grown<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

impl<T: Copy> Memory<T> for Grown<T> {
    fn copy_from(&mut self, records: &[T]) -> bool {
        self.0.clear();
        self.0.extend_from_slice(records);
        true
    }

    fn room(&self) -> usize {
        usize::MAX
    }
}

/// Returns a deformation of a scene, at rest.
///
/// # Errors
/// If the blob holds structures that cannot be refitted, or its vertices have another type.
pub fn of<V: Vertex>(scene: &Scene<'_>) -> Result<HeapDeformation<V>, DeformError> {
    let mut deformation = HeapDeformation::default();
    deformation.reset(scene)?;
    Ok(deformation)
}
