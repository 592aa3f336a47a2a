//! Computes the memory that a scene takes before it is made. A few lines of a file can describe more objects than any
//! machine holds.

use super::{Attributes, Shape};
use crate::table::grouped;

/// The most bytes that a scene may take until its blob is made. That is room for as many triangles as a blob holds, and
/// less than 4 GB.
pub(super) const MOST_BYTES: u64 = 3_800_000_000;

/// The most bytes of a file whose length is not known before it is read: a gzipped one, and standard input. Such a file
/// and the scene made of it fit the memory that the largest scene takes.
pub const MOST_INPUT: u64 = 1 << 30;

/// Bytes that an object takes while it is read and compiled, without its name and its triangles.
/// Measured as the growth of `inspect`'s and `build`'s peak memory per sphere and per cone.
const OBJECT: u64 = 512;
/// Bytes that a triangle takes, with its share of the vertices; measured likewise, with the
/// structure `wide`.
const TRIANGLE: u64 = 224;
/// Displacements of vertices by morph targets that take as many bytes, with their motions and records.
const DISPLACED: usize = 2;
/// The number of copies of a name: in the scene, and for messages.
const NAMES: u64 = 2;

/// The most primitives that a scene may hold.
pub(super) const MOST_PRIMITIVES: u64 = 16_777_216;

/// The most keys of all tracks of a scene. A key takes 104 bytes until the blob is made, and is copied a few times.
pub(super) const MOST_KEYS: u64 = 1 << 22;

/// The number of keys of tracks, counted before they are made.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Keys(u64);

impl Keys {
    /// Counts keys.
    ///
    /// # Errors
    /// If there are too many: the number and the limit in words.
    pub(super) fn add(&mut self, keys: u64) -> Result<(), String> {
        self.0 = self.0.saturating_add(keys);
        if self.0 <= MOST_KEYS {
            return Ok(());
        }
        Err(format!(
            "{} keys; the limit is {}",
            grouped(self.0),
            grouped(MOST_KEYS)
        ))
    }
}

/// Returns how many primitives a shape is; vertices that no triangle uses weigh as triangles would.
pub(super) fn primitives(shape: &Shape) -> u64 {
    match shape {
        Shape::Mesh {
            vertices,
            triangles,
        } => triangles.len().max(vertices.len() / 3).max(1) as u64,
        _ => 1,
    }
}

/// Returns whether lists fit into memory, given the length of each and the bytes of an entry.
pub(super) fn lists_fit(lists: &[(usize, usize)]) -> bool {
    let bytes = lists
        .iter()
        .map(|&(length, bytes)| length as u64 * bytes as u64);
    // While a list grows, it takes its bytes twice.
    bytes.sum::<u64>() <= MOST_BYTES / 2
}

/// The content of a scene, or of a part, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) objects: u64,
    /// Bytes of all objects' names.
    pub(super) names: u64,
    pub(super) triangles: u64,
}

impl Size {
    /// Returns the size of an object; `name` is the length of its name. Displacements of a few vertices count as a
    /// triangle.
    pub(super) fn of(shape: &Shape, name: usize, attributes: &Attributes) -> Self {
        let displaced = attributes.displacements.iter().map(|it| it.vectors.len());
        let displaced = displaced.sum::<usize>().div_ceil(DISPLACED) as u64;
        let triangles = match shape {
            Shape::Mesh { .. } => primitives(shape),
            _ => 0,
        };
        Self {
            objects: 1,
            names: name as u64,
            triangles: triangles + displaced,
        }
    }

    #[must_use]
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            objects: self.objects.saturating_add(other.objects),
            names: self.names.saturating_add(other.names),
            triangles: self.triangles.saturating_add(other.triangles),
        }
    }

    /// Returns the size with `by` bytes more in each name.
    #[must_use]
    pub(super) fn with_longer_names(self, by: usize) -> Self {
        let more = self.objects.saturating_mul(by as u64);
        Self {
            names: self.names.saturating_add(more),
            ..self
        }
    }

    fn bytes(self) -> u64 {
        let parts = [
            (self.objects, OBJECT),
            (self.names, NAMES),
            (self.triangles, TRIANGLE),
        ];
        let parts = parts.map(|(count, bytes)| count.saturating_mul(bytes));
        parts.into_iter().fold(0, u64::saturating_add)
    }

    /// Returns the memory in words, if it is too much.
    pub(super) fn excess(self) -> Option<String> {
        let gigabytes = |bytes: u64| bytes as f64 / 1e9;
        (self.bytes() > MOST_BYTES).then(|| {
            format!(
                "about {:.1} GB of memory, for {} objects with {} triangles and {} bytes of names; \
                 the limit is {:.1} GB",
                gigabytes(self.bytes()),
                grouped(self.objects),
                grouped(self.triangles),
                grouped(self.names),
                gigabytes(MOST_BYTES)
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_triangles_as_a_blob_holds_fit() {
        let mesh = Size {
            objects: 1,
            names: 100,
            triangles: 1 << 24,
        };
        assert_eq!(mesh.excess(), None);
        let more = mesh.plus(Size {
            objects: 100_000,
            ..Size::default()
        });
        let words = more.excess().unwrap();
        assert!(
            words.starts_with("about 3.8 GB of memory, for 100,001 objects"),
            "{words}"
        );
    }

    #[test]
    fn keys_are_counted_up_to_the_limit() {
        let mut keys = Keys::default();
        assert_eq!(keys.add(MOST_KEYS), Ok(()));
        let words = keys.add(1).unwrap_err();
        assert_eq!(words, "4,194,305 keys; the limit is 4,194,304");
        assert!(keys.add(u64::MAX).is_err());
    }

    #[test]
    fn lists_take_half_of_the_memory_at_most() {
        assert!(lists_fit(&[]));
        assert!(lists_fit(&[(50_000_000, 24), (43_750_000, 16)]));
        assert!(!lists_fit(&[(50_000_000, 24), (43_750_001, 16)]));
    }

    #[test]
    fn sizes_beyond_all_numbers_are_too_much() {
        let all = Size {
            objects: u64::MAX,
            names: 1,
            triangles: u64::MAX,
        };
        assert!(
            all.plus(all)
                .with_longer_names(usize::MAX)
                .excess()
                .is_some()
        );
    }
}
