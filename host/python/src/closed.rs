//! Which objects are closed, so that they can contain points.

use gridel_core::{Kind, Scene};
use std::collections::HashMap;

/// Returns for each object of a scene and its parts whether it is closed. Solids are closed, and so are meshes each of
/// whose edges an even number of triangles share.
pub fn closed(scene: &Scene<'_>) -> Vec<bool> {
    let objects = scene.header().objects as usize;
    let mut closed = vec![false; objects];
    let mut edges: HashMap<(u32, [i32; 3], [i32; 3]), bool> = HashMap::new();
    let parts = (0..).zip(scene.parts()).map(|(number, part)| {
        let first = scene.first_primitive_of_part(number).unwrap_or(0);
        (part, first)
    });
    for (held_by, first) in std::iter::once((scene, 0)).chain(parts) {
        for kind in Kind::ALL {
            for slot in 0..held_by.count(kind) as u32 {
                let object = scene.object(first + held_by.primitive(kind, slot));
                let Some(closed) = closed.get_mut(object as usize) else {
                    continue;
                };
                *closed |= kind.encloses();
                if kind != Kind::Triangle {
                    continue;
                }
                let Some([a, b, c]) = held_by.triangle(slot as usize) else {
                    continue;
                };
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let edge = (object, from.min(to), from.max(to));
                    *edges.entry(edge).or_insert(false) ^= true;
                }
            }
        }
    }
    for ((object, ..), is_odd) in edges {
        if is_odd {
            closed[object as usize] = false;
        }
    }
    closed
}
