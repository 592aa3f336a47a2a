//! The memory of deforming meshes.

use crate::table::grouped;
use gridel_core::deform;
use gridel_core::format::record::{Pair, UnitBox, Vertex16, Vertex24};
use gridel_core::{Kind, Scene, Structure};
use serde::Serialize;
use std::fmt;

/// A scene, or a part of one, whose vertices have room to move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Deforming {
    /// The number of the part; `None` for the scene's own objects.
    pub part: Option<usize>,
    pub vertices: usize,
    pub pairs: usize,
    /// Bytes of a [`Deformation`](gridel_core::Deformation) on boards, where a machine word has 32 bits.
    pub bytes: usize,
}

impl Deforming {
    /// The structures that a deforming scene can hold.
    pub const STRUCTURES: [Structure; 2] = deform::STRUCTURES;

    /// The meshes of a blob that were built with room to move.
    ///
    /// ```
    /// # let file = "[[object]]\nkind = 'mesh'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]";
    /// # let imported = gridel_host::scene::read("flag.toml".as_ref(), file.into(), &Default::default())?;
    /// use gridel_core::Structure;
    /// use gridel_host::compile::{Options, compile};
    /// use gridel_host::measure::Deforming;
    ///
    /// let options = Options {
    ///     structures: vec![Structure::Bvh],
    ///     room: 0.25,
    ///     ..Options::default()
    /// };
    /// let blob = compile(&imported.scene, &options)?.blob;
    /// let deforming = Deforming::all(&blob.scene()?);
    /// assert_eq!(deforming[0].vertices, 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn all(scene: &Scene<'_>) -> Vec<Self> {
        let parts = scene.parts().iter().enumerate();
        let parts = parts.map(|(part, scene)| (Some(part), scene));
        std::iter::once((None, scene))
            .chain(parts)
            .filter_map(|(part, scene)| Self::of(part, scene))
            .collect()
    }

    /// The mesh of a scene's own objects.
    pub fn of_scene(scene: &Scene<'_>) -> Option<Self> {
        Self::of(None, scene)
    }

    fn of(part: Option<usize>, scene: &Scene<'_>) -> Option<Self> {
        let mut held = Structure::ALL.into_iter().filter(|it| scene.holds(*it));
        let can_refit = held.all(|it| Self::STRUCTURES.contains(&it));
        if !can_refit || scene.count(Kind::Triangle) == 0 || !has_room(scene) {
            return None;
        }
        let (vertices, pairs) = (scene.vertices(), scene.pairs());
        let bytes = match scene.header().storage_bits {
            16 => bytes::<Vertex16>(4, vertices, pairs),
            _ => bytes::<Vertex24>(4, vertices, pairs),
        };
        Some(Self {
            part,
            vertices,
            pairs,
            bytes,
        })
    }
}

impl fmt::Display for Deforming {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(part) = self.part {
            write!(f, "part {part}: ")?;
        }
        write!(
            f,
            "{} vertices and {} pairs, {} bytes of RAM; vertices move within the bounds",
            grouped(self.vertices),
            grouped(self.pairs),
            grouped(self.bytes)
        )
    }
}

/// Returns whether the box of a scene, or of one of its parts, is larger than its content. Parts are checked too,
/// because their boxes can cover the room of the scene's own objects.
fn has_room(scene: &Scene<'_>) -> bool {
    let mut all = std::iter::once(scene).chain(scene.parts());
    all.any(is_wider)
}

fn is_wider(scene: &Scene<'_>) -> bool {
    let own = Kind::ALL.into_iter().flat_map(|kind| {
        (0..scene.count(kind)).filter_map(move |slot| scene.primitive_bounds(kind, slot))
    });
    let placed = scene.instances().iter().filter_map(|instance| {
        instance.around(scene.parts().get(usize::from(instance.part))?.bounds())
    });
    let all: Option<UnitBox> = own.chain(placed).reduce(|a, b| a.union(&b));
    all.is_some_and(|all| all != *scene.bounds())
}

/// Bytes of a deformation where a machine word has `word` bytes: two arrays with a length each, a word and two
/// marks.
fn bytes<V>(word: usize, vertices: usize, pairs: usize) -> usize {
    let array = |count: usize, record: usize, alignment: usize| {
        (count * record + word).next_multiple_of(alignment.max(word))
    };
    let vertices = array(vertices, size_of::<V>(), align_of::<V>());
    let pairs = array(pairs, size_of::<Pair>(), align_of::<Pair>());
    (vertices + pairs + size_of::<u32>() + 2 * size_of::<bool>()).next_multiple_of(word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gridel_core::Deformation;

    #[test]
    fn sizes_are_the_compilers() {
        let word = size_of::<usize>();
        assert_eq!(
            bytes::<Vertex16>(word, 101, 7),
            size_of::<Deformation<Vertex16, 101, 7>>()
        );
        assert_eq!(
            bytes::<Vertex24>(word, 502, 255),
            size_of::<Deformation<Vertex24, 502, 255>>()
        );
        // As on the boards of the tests.
        assert_eq!(bytes::<Vertex24>(4, 502, 255), 12 * 502 + 32 * 255 + 16);
    }
}
