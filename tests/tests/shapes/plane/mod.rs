//! Planes: unbounded, outside of all structures.

mod rays;
mod scenes;

use glam::DVec3;
use gridel_host::scene::Shape;
use gridel_host::shape::Plane;

fn plane(point: DVec3, normal: DVec3) -> Shape {
    Shape::Plane(Plane { point, normal })
}
