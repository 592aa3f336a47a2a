//! First hits, written to arrays.

use super::{CHUNK, Closest, Found, How, NONE, ask_some, chunks_of, each_chunk};
use crate::rays::Rays;
use gridel_core::Scene;
use gridel_host::trace::SceneRay;

/// The first hits of some rays, as arrays hold them.
pub struct Columns<'c, T> {
    pub t: &'c mut [T],
    pub object: &'c mut [u32],
    pub primitive: &'c mut [u32],
    /// Empty where it is not requested.
    pub instance: &'c mut [u32],
    pub normal: &'c mut [[f32; 3]],
    pub uv: &'c mut [[f32; 2]],
}

impl<'c, T> Columns<'c, T> {
    /// Returns the first `at` rows, and the others.
    fn split(self, at: usize) -> (Self, Self) {
        let (t, more_t) = self.t.split_at_mut(at);
        let (object, more_objects) = self.object.split_at_mut(at);
        let (primitive, more_primitives) = self.primitive.split_at_mut(at);
        let instances = at.min(self.instance.len());
        let (instance, more_instances) = self.instance.split_at_mut(instances);
        let (normal, more_normals) = self.normal.split_at_mut(at);
        let (uv, more_uvs) = self.uv.split_at_mut(at);
        let first = Self {
            t,
            object,
            primitive,
            instance,
            normal,
            uv,
        };
        let rest = Self {
            t: more_t,
            object: more_objects,
            primitive: more_primitives,
            instance: more_instances,
            normal: more_normals,
            uv: more_uvs,
        };
        (first, rest)
    }
}

/// Rays whose hits are found before they are written: as many as a processor's nearest memory holds.
const WRITTEN: usize = 256;

/// Finds the first hit of each ray and writes it to arrays of as many rows.
///
/// `place` gives the t and the weights of corners of a hit, or none where there is no hit after all, and `number` its t and its primitive as the arrays have them.
pub fn cast<T: Send + Copy>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    mut columns: Columns<'_, T>,
    place: impl Fn(&SceneRay, &Found) -> Option<(f64, [f32; 2])> + Sync,
    number: impl Fn(&Found) -> (T, u32) + Sync,
) {
    let mut chunks = Vec::with_capacity(rays.len().div_ceil(CHUNK));
    for numbers in chunks_of(rays.len()) {
        let (chunk, rest) = columns.split(numbers.len());
        chunks.push((numbers.start, chunk));
        columns = rest;
    }
    let write = |(start, mut columns): (usize, Columns<'_, T>)| {
        let mut hits = [Found::MISS; WRITTEN];
        let mut start = start;
        while !columns.t.is_empty() {
            let count = WRITTEN.min(columns.t.len());
            let (rows, rest) = columns.split(count);
            let hits = &mut hits[..count];
            hits.fill(Found::MISS);
            ask_some::<Closest>(scene, rays, how, (start, hits));
            for (row, hit) in hits.iter_mut().enumerate() {
                if hit.primitive != NONE {
                    match place(&rays.get(start + row), hit) {
                        Some(placed) => (hit.t, rows.uv[row]) = placed,
                        None => *hit = Found::MISS,
                    }
                }
                (rows.t[row], rows.primitive[row]) = number(hit);
                rows.object[row] = hit.object;
                rows.normal[row] = hit.normal;
                if let Some(instance) = rows.instance.get_mut(row) {
                    *instance = hit.instance;
                }
            }
            start += WRITTEN;
            columns = rest;
        }
    };
    each_chunk(how, chunks, write);
}
