//! Builds a scene in Rust, without a file, and writes its blob:
//!
//! ```text
//! cargo run --release --example build_scene -- scene.gridel
//! ```

use glam::DVec3;
use gridel_host::blob::Blob;
use gridel_host::compile::{CompileError, Options, compile};
use gridel_host::scene::{Camera, Diffuse, Light, Material, Object, Scene, Shape, SourceSpan};
use gridel_host::shape::{Cuboid, Sphere};
use std::error::Error;

/// A red ball on a gray floor.
pub fn scene() -> Scene {
    let material = |name: &str, color| Material {
        name: name.into(),
        diffuse: Diffuse::Plain(color),
        ..Material::default()
    };
    let object = |name: &str, material, shape| Object {
        name: name.into(),
        material,
        shape,
        place: SourceSpan::default(),
        normals: Default::default(),
        attributes: Default::default(),
    };
    let floor = Shape::Box(Cuboid {
        min: DVec3::new(-4.0, -0.5, -4.0),
        max: DVec3::new(4.0, 0.0, 4.0),
    });
    let ball = Shape::Sphere(Sphere {
        center: DVec3::Y,
        radius: 1.0,
    });
    Scene {
        camera: Some(Camera {
            eye: DVec3::new(0.0, 3.0, 8.0),
            target: DVec3::Y,
            up: DVec3::Y,
            fov_degrees: 30.0,
        }),
        lights: vec![Light::Point {
            position: DVec3::new(4.0, 6.0, 5.0),
            color: [1.0; 3],
        }],
        materials: vec![material("gray", [0.5; 3]), material("red", [0.8, 0.1, 0.1])],
        objects: vec![object("floor", 0, floor), object("ball", 1, ball)],
        ..Scene::default()
    }
}

/// Compiles the scene with default options.
pub fn blob() -> Result<Blob, CompileError> {
    Ok(compile(&scene(), &Options::default())?.blob)
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1);
    let path = path.ok_or("usage: build_scene BLOB.gridel")?;
    std::fs::write(path, blob()?.bytes())?;
    Ok(())
}
