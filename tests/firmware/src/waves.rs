//! A mesh whose vertices move with time; for programs of boards and, to the bit, for the host.

use gridel_core::format::record::Pair;
use gridel_core::format::width::Vertex;

/// Poses that are measured.
pub const POSES: u32 = 8;

/// Moves every vertex from its place at rest by at most 1/16 of its largest coordinate, in a way that differs from
/// vertex to vertex and from pose to pose.
pub fn pose<V: Vertex>(rest: &[V], vertices: &mut [V], number: u32) {
    let mut phase = number.wrapping_mul(0x9e37_79b9);
    for (vertex, rest) in vertices.iter_mut().zip(rest) {
        phase = phase.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let place = [rest.steps(0), rest.steps(1), rest.steps(2)];
        let reach = place.iter().fold(0, |most, x| x.wrapping_abs().max(most)) >> 4;
        let mut bits = phase;
        *vertex = V::from_steps(place.map(|x| {
            // From -128 to 127, in 128ths.
            let part = (bits >> 24) as u8 as i8;
            bits = bits.rotate_left(7);
            x.wrapping_add(reach.wrapping_mul(part.into()) >> 7)
        }));
    }
}

/// Returns a word that depends on all normals and their order.
pub fn sum_of_normals(normals: &[[i16; 2]]) -> u32 {
    normals.iter().flatten().fold(0, |sum: u32, x| {
        sum.rotate_left(5).wrapping_mul(0x9e37_79b1) ^ *x as u32
    })
}

/// Returns a word that depends on all boxes and their order.
pub fn sum(pairs: &[Pair]) -> u32 {
    let planes = pairs.iter().flat_map(|pair| pair.planes);
    planes.flatten().flatten().fold(0, |sum: u32, plane| {
        sum.rotate_left(5).wrapping_mul(0x9e37_79b1) ^ plane as u32
    })
}
