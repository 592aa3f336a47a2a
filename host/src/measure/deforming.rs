//! The memory of deforming meshes.

use crate::morphed::morph_targets;
use crate::table::grouped;
use gridel_core::deform::{self, MorphTargets};
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
    /// Normals that morph targets change.
    pub normals: usize,
    /// Bytes of a [`Deformation`](gridel_core::Deformation) on boards, where a machine word has 32 bits.
    pub bytes: usize,
}

impl Deforming {
    /// The structures that a deforming scene can hold.
    pub const STRUCTURES: [Structure; 2] = deform::STRUCTURES;

    /// Returns the meshes of a blob that were built with room to move, or with morph targets.
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
    /// let deforming = Deforming::all(&blob.scene()?, blob.bytes());
    /// assert_eq!(deforming[0].vertices, 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn all(scene: &Scene<'_>, blob: &[u8]) -> Vec<Self> {
        // They were checked with the scene.
        let targets = morph_targets(blob).unwrap_or_default();
        let parts = scene.parts().iter().enumerate();
        let parts = parts.map(|(part, scene)| (Some(part), scene));
        std::iter::once((None, scene))
            .chain(parts)
            .zip(&targets)
            .filter_map(|((part, scene), targets)| Self::of(part, scene, targets))
            .collect()
    }

    /// Returns the mesh of a scene's own objects.
    pub fn of_scene(scene: &Scene<'_>, blob: &[u8]) -> Option<Self> {
        Self::all(scene, blob)
            .into_iter()
            .find(|it| it.part.is_none())
    }

    fn of(part: Option<usize>, scene: &Scene<'_>, targets: &MorphTargets<'_>) -> Option<Self> {
        let can_refit = scene.structures().all(|it| Self::STRUCTURES.contains(&it));
        let moves = has_room(scene) || !targets.is_empty();
        if !can_refit || scene.count(Kind::Triangle) == 0 || !moves {
            return None;
        }
        let (vertices, pairs) = (scene.vertices(), scene.pairs());
        let normals = match targets.changes_normals() {
            true => scene.normals(),
            false => 0,
        };
        let bytes = match scene.header().storage_bits {
            16 => bytes::<Vertex16>(4, [vertices, pairs, normals]),
            _ => bytes::<Vertex24>(4, [vertices, pairs, normals]),
        };
        Some(Self {
            part,
            vertices,
            pairs,
            normals,
            bytes,
        })
    }
}

impl fmt::Display for Deforming {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(part) = self.part {
            write!(f, "part {part}: ")?;
        }
        let normals = match self.normals {
            0 => String::new(),
            normals => format!(" and {} normals", grouped(normals)),
        };
        write!(
            f,
            "{} vertices, {} pairs{normals}, {} bytes of RAM; vertices move within the bounds",
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

/// Bytes of a deformation where a machine word has `word` bytes, given how many vertices, pairs and normals it
/// has: an array with a length for each, a word and two marks.
fn bytes<V>(word: usize, [vertices, pairs, normals]: [usize; 3]) -> usize {
    let array = |count: usize, record: usize, alignment: usize| {
        (count * record + word).next_multiple_of(alignment.max(word))
    };
    let vertices = array(vertices, size_of::<V>(), align_of::<V>());
    let pairs = array(pairs, size_of::<Pair>(), align_of::<Pair>());
    let normals = array(normals, size_of::<[i16; 2]>(), align_of::<i16>());
    (vertices + pairs + normals + size_of::<u32>() + 2 * size_of::<bool>()).next_multiple_of(word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gridel_core::Deformation;

    #[test]
    fn sizes_are_the_compilers() {
        let word = size_of::<usize>();
        assert_eq!(
            bytes::<Vertex16>(word, [101, 7, 0]),
            size_of::<Deformation<Vertex16, 101, 7>>()
        );
        assert_eq!(
            bytes::<Vertex24>(word, [502, 255, 301]),
            size_of::<Deformation<Vertex24, 502, 255, 301>>()
        );
        // As on the boards of the tests.
        assert_eq!(
            bytes::<Vertex24>(4, [502, 255, 0]),
            12 * 502 + 32 * 255 + 20
        );
    }
}
