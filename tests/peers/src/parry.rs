//! parry3d's triangle mesh.

use crate::contender::{Contender, Trace};
use crate::workload::Answer;
use glam::Vec3;
use parry3d::math::Vector;
use parry3d::query::RayCast;
use parry3d::shape::TriMesh;
use std::time::Instant;

/// The mesh, built.
pub fn contender(triangles: &[[Vec3; 3]]) -> Contender<'static> {
    let vector = |v: Vec3| Vector::new(v.x, v.y, v.z);
    let mut numbers = std::collections::HashMap::new();
    let mut vertices = Vec::new();
    let faces: Vec<[u32; 3]> = triangles
        .iter()
        .map(|face| {
            face.map(|corner| {
                *numbers
                    .entry(corner.to_array().map(f32::to_bits))
                    .or_insert_with(|| {
                        vertices.push(vector(corner));
                        vertices.len() as u32 - 1
                    })
            })
        })
        .collect();
    let started = Instant::now();
    let (points, count) = (vertices.len(), faces.len());
    let mesh = TriMesh::new(vertices, faces).expect("a mesh");
    let seconds = started.elapsed().as_secs_f64();
    // Vertices, indices, and the figures that its hierarchy reports.
    let bytes = 12 * points + 12 * count + mesh.bvh().total_memory_size();
    Contender {
        name: String::from("parry3d TriMesh"),
        seconds,
        bytes,
        trace: Trace::OfQueries(Box::new(move |queries, _, answers| {
            for (query, answer) in queries.iter().zip(answers) {
                let ray = parry3d::query::Ray::new(vector(query.origin), vector(query.direction));
                let t = mesh.cast_local_ray(&ray, f32::MAX, true);
                *answer = Answer {
                    t: t.unwrap_or(f32::INFINITY),
                };
            }
        })),
    }
}
