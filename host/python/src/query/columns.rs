//! First hits, written to arrays.

use super::limits::first_accepted;
use super::{CHUNK, Closest, Hit, How, NONE, Nearest, ask_some, chunks_of, each_chunk};
use crate::rays::Rays;
use gridel_core::Scene;
use gridel_host::trace::SceneRay;

/// Where a hit lies.
pub struct Placed {
    pub t: f64,
    pub uv: [f32; 2],
    /// `None` where the hit has its normal.
    pub normal: Option<[f32; 3]>,
}

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

/// Hits that are placed together.
const PLACED: usize = 32;

/// How hits become rows.
pub struct Rows<A, P, M> {
    places_normals: bool,
    load_ahead: A,
    place: P,
    number: M,
}

impl<A, P, M> Rows<A, P, M> {
    /// `places_normals` is true if `place` gives the normals of all hits. `load_ahead` starts to load what `place` needs.
    /// `place` gives where a hit lies, or none where there is no hit after all. `number` gives the t and the primitive of
    /// a hit as the arrays have them.
    pub fn new(places_normals: bool, load_ahead: A, place: P, number: M) -> Self {
        Self {
            places_normals,
            load_ahead,
            place,
            number,
        }
    }
}

/// Finds the first hit of each ray and writes it to arrays of as many rows.
pub fn cast<T, A, P, M>(
    scene: &Scene<'_>,
    rays: Rays<'_>,
    how: How,
    mut columns: Columns<'_, T>,
    form: &Rows<A, P, M>,
) where
    T: Send + Copy,
    A: Fn(&Hit) + Sync,
    P: Fn(&SceneRay, &Hit) -> Option<Placed> + Sync,
    M: Fn(&Hit) -> (T, u32) + Sync,
{
    let mut chunks = Vec::with_capacity(rays.len().div_ceil(CHUNK));
    for numbers in chunks_of(rays.len()) {
        let (chunk, rest) = columns.split(numbers.len());
        chunks.push((numbers.start, chunk));
        columns = rest;
    }
    let write = |(start, mut columns): (usize, Columns<'_, T>)| {
        let mut hits = [Hit::MISS; WRITTEN];
        let mut start = start;
        while !columns.t.is_empty() {
            let count = WRITTEN.min(columns.t.len());
            let (rows, rest) = columns.split(count);
            let hits = &mut hits[..count];
            hits.fill(Hit::MISS);
            if form.places_normals {
                ask_some::<Nearest>(scene, rays, how, (start, hits));
            } else {
                ask_some::<Closest>(scene, rays, how, (start, hits));
            }
            for row in 0..count {
                if row % PLACED == 0 {
                    let ahead = row..count.min(row + PLACED);
                    hits[ahead].iter().for_each(&form.load_ahead);
                }
                let hit = &mut hits[row];
                if hit.primitive != NONE {
                    let number = start + row;
                    let mut placed = within(rays, number, hit, &form.place);
                    if placed.is_none() && rays.have_limits() {
                        placed = next_within((scene, rays, how), number, hit, &form.place);
                    }
                    match placed {
                        Some(placed) => {
                            (hit.t, rows.uv[row]) = (placed.t, placed.uv);
                            hit.normal = placed.normal.unwrap_or(hit.normal);
                        }
                        None => *hit = Hit::MISS,
                    }
                }
                (rows.t[row], rows.primitive[row]) = (form.number)(hit);
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

/// Where a ray meets a hit, if that is within the limits of the ray.
#[inline(always)]
fn within<P: Fn(&SceneRay, &Hit) -> Option<Placed>>(
    rays: Rays<'_>,
    number: usize,
    hit: &Hit,
    place: &P,
) -> Option<Placed> {
    // The function itself, because one by reference is not inlined.
    let placed = (*place)(&rays.searched(number), hit);
    placed.filter(|placed| rays.holds(number, placed.t))
}

/// The next hit of a ray within its limits, and where the ray meets it.
#[cold]
#[inline(never)]
fn next_within<P: Fn(&SceneRay, &Hit) -> Option<Placed>>(
    (scene, rays, how): (&Scene<'_>, Rays<'_>, How),
    number: usize,
    hit: &mut Hit,
    place: &P,
) -> Option<Placed> {
    let mut placed = None;
    first_accepted(scene, rays, how, number, &mut |next| {
        placed = within(rays, number, next, place);
        *hit = *next;
        placed.is_some()
    });
    placed
}
