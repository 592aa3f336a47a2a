//! Which meshes of a scene are closed, so that no ray can leave their inside unseen.

use gridel_core::{Kind, Scene};
use std::collections::HashMap;

/// A mesh whose every edge belongs to two triangles that run along it in opposite ways.
#[derive(Clone, Debug)]
pub struct ClosedMesh {
    pub object: u32,
    /// In units.
    pub triangles: Vec<[[f64; 3]; 3]>,
}

impl ClosedMesh {
    /// The closed meshes of a scene, as they lie on its lattice.
    pub fn all(scene: &Scene<'_>) -> Vec<Self> {
        let mut objects: HashMap<u32, Vec<[[i32; 3]; 3]>> = HashMap::new();
        for slot in 0..scene.count(Kind::Triangle) {
            let object = scene.object(scene.primitive(Kind::Triangle, slot as u32));
            objects
                .entry(object)
                .or_default()
                .extend(scene.triangle(slot));
        }
        let mut closed: Vec<_> = objects
            .into_iter()
            .filter(|(_, triangles)| is_closed(triangles))
            .map(|(object, triangles)| Self {
                object,
                triangles: triangles
                    .iter()
                    .map(|corners| corners.map(|corner| corner.map(|x| f64::from(x) / 256.0)))
                    .collect(),
            })
            .collect();
        closed.sort_by_key(|mesh| mesh.object);
        closed
    }
}

fn is_closed(triangles: &[[[i32; 3]; 3]]) -> bool {
    // How often each edge is run along, in its one way and in the other.
    let mut edges: HashMap<[[i32; 3]; 2], [u32; 2]> = HashMap::new();
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let forward = from < to;
            let edge = if forward { [from, to] } else { [to, from] };
            edges.entry(edge).or_default()[usize::from(forward)] += 1;
        }
    }
    triangles.len() >= 4 && edges.values().all(|&ways| ways == [1, 1])
}
