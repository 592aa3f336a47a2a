//! Origins and directions of every magnitude (hard cases F: origins at 10^k, directions of 10^-k).
//!
//! Answers are right within the bounds of a hit in the scene, not of the distance to the ray's
//! origin; t is rounded once more. A ray without an answer is rejected with a reason. There is no
//! third case.

mod answers;
mod faces;
mod far_eyes;
mod far_rays;
mod starts;

use glam::DVec3;
use gridel_core::format::limits::FARTHEST;
use gridel_host::blob::Blob;
use gridel_host::scene::Shape;
use gridel_host::shape::Sphere;
use gridel_tests::exact::{Line, Real, Vector, along, scaled, vector};
use gridel_tests::scenes;

/// The farthest coordinate that is answered, in units.
const LIMIT: f64 = (FARTHEST >> 13) as f64;

/// A ball of radius 1, in a blob with every structure.
fn ball(center: DVec3) -> Blob {
    let radius = 1.0;
    scenes::compact_blob(&scenes::of([Shape::Sphere(Sphere { center, radius })]), 16)
}

/// A ray from far away in exact arithmetic, from where the core moved it to.
fn exact_line(origin: [f64; 3], direction: [f64; 3], major: usize, plane: f64) -> (Line, Real) {
    let along_major = Real::of(direction[major]);
    let slope: Vector = scaled(&vector(direction), &(Real::of(1.0) / along_major.abs()));
    let moved = (Real::of(plane) - Real::of(origin[major])) / &slope[major];
    let origin = along(&vector(origin), &moved, &slope);
    (Line { origin, slope }, moved)
}
