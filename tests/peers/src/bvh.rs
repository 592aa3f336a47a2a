//! The crate bvh.

use crate::contender::{Contender, Trace};
use crate::workload::Answer;
use ::bvh::aabb::{Aabb, Bounded};
use ::bvh::bounding_hierarchy::BHShape;
use glam::Vec3;
use nalgebra::Point3;
use std::time::Instant;

/// A triangle for the crate bvh, which has a test that culls back faces and none that does not: so
/// both sides are asked.
#[derive(Clone, Copy)]
struct Face {
    corners: [Point3<f32>; 3],
    node: usize,
}

impl Bounded<f32, 3> for Face {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.corners
            .iter()
            .fold(Aabb::empty(), |bounds, corner| bounds.grow(corner))
    }
}

impl BHShape<f32, 3> for Face {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// The hierarchy, built.
pub fn contender(triangles: &[[Vec3; 3]]) -> Contender<'static> {
    let point = |v: Vec3| Point3::new(v.x, v.y, v.z);
    let mut faces: Vec<Face> = triangles
        .iter()
        .map(|face| Face {
            corners: face.map(point),
            node: 0,
        })
        .collect();
    let started = Instant::now();
    let structure = ::bvh::bvh::Bvh::build(&mut faces);
    let seconds = started.elapsed().as_secs_f64();
    let bytes = size_of_val(&structure.nodes[..]) + size_of_val(&faces[..]);
    Contender {
        name: String::from("bvh"),
        seconds,
        bytes,
        trace: Trace::OfQueries(Box::new(move |queries, any, answers| {
            for (query, answer) in queries.iter().zip(answers) {
                let direction = query.direction;
                let ray = ::bvh::ray::Ray::new(
                    point(query.origin),
                    nalgebra::Vector3::new(direction.x, direction.y, direction.z),
                );
                let hits = structure.traverse_iterator(&ray, &faces).map(|face| {
                    let [a, b, c] = &face.corners;
                    let front = ray.intersects_triangle(a, b, c).distance;
                    front.min(ray.intersects_triangle(a, c, b).distance)
                });
                let mut hits = hits.filter(|t| t.is_finite());
                let t = if any {
                    hits.next().map(|_| 0.0)
                } else {
                    hits.min_by(f32::total_cmp)
                };
                *answer = Answer {
                    t: t.unwrap_or(f32::INFINITY),
                };
            }
        })),
    }
}
