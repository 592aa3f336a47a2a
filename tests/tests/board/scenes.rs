//! The scenes that go into flash, compiled small.

use crate::firmware::skip;
use glam::DVec3;
use gridel_core::render::Pixel;
use gridel_core::{Format, Rgb888, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{self, Options};
use gridel_host::render::{Job, render};
use gridel_host::scene::{self, Camera, Scene, Shape};
use std::env;
use std::path::{Path, PathBuf};

/// A blob, with the name of its scene.
pub struct Compiled {
    pub name: &'static str,
    pub blob: Blob,
}

/// Every shape and every effect.
pub fn quick() -> Compiled {
    fixture("quick", [48, 36])
}

/// Glass on glass, to depth 6.
pub fn glass_chess() -> Compiled {
    let compiled = fixture("glass-chess", [48, 36]);
    assert_eq!(view_depth(&compiled), 6);
    compiled
}

fn view_depth(compiled: &Compiled) -> u8 {
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    scene.view().depth
}

/// The mesh on which tracers for boards are compared: seen from 3.2 before its middle, in a square
/// picture that is 2.9 wide there. `None` where the mesh is missing.
pub fn suzanne() -> Option<Compiled> {
    Some(compile("suzanne", suzanne_scene()?, [64, 64]))
}

/// The same in as few bytes as a hierarchy takes.
pub fn small_suzanne() -> Option<Compiled> {
    let options = Options {
        structures: vec![Structure::Flagged],
        lattice_bits: 16,
        leaf_size: 8,
        ..Options::default()
    };
    let (name, size) = ("suzanne-small", [64, 64]);
    Some(compile_with(name, suzanne_scene()?, size, &options))
}

fn suzanne_scene() -> Option<Scene> {
    let folder = env::var_os("GRIDEL_SCENES")
        .map_or_else(|| repository().join("../shared/scenes"), PathBuf::from);
    let path = folder.join("meshes/suzanne.obj");
    if !path.exists() {
        skip(format_args!(
            "{} is missing; set GRIDEL_SCENES",
            path.display()
        ));
        return None;
    }
    let mut scene = load(&path);
    let vertices = scene.objects.iter().flat_map(|object| match &object.shape {
        Shape::Mesh { vertices, .. } => &vertices[..],
        _ => &[],
    });
    let (lowest, highest) = vertices.fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(lowest, highest), &vertex| (lowest.min(vertex), highest.max(vertex)),
    );
    let target = (lowest + highest) * 0.5;
    scene.camera = Some(Camera {
        eye: target + DVec3::new(0.0, 0.0, 3.2),
        target,
        up: DVec3::Y,
        fov_degrees: 2.0 * f64::atan(1.45 / 3.2).to_degrees(),
    });
    Some(scene)
}

impl Compiled {
    /// The picture as the host renders it: three bytes a pixel.
    pub fn picture(&self, format: Format) -> Vec<u8> {
        let scene = self.blob.scene().expect("the compiler's own blob");
        let settings = Settings::of(&scene);
        let job = Job {
            format,
            structure: Structure::DualSplit,
            settings,
            rows: 0..settings.height,
            count: false,
        };
        let picture = render(&scene, &job, &|| ()).expect("the blob holds the structure");
        let encoded = picture
            .pixels
            .iter()
            .map(|&linear| Rgb888::encode(linear, None).0);
        encoded.flatten().collect()
    }
}

fn fixture(name: &'static str, size: [u32; 2]) -> Compiled {
    let path = repository()
        .join("fixtures")
        .join(name)
        .with_extension("toml");
    compile(name, load(&path), size)
}

fn load(path: &Path) -> Scene {
    match scene::load(path, &Default::default()) {
        Ok(imported) => imported.scene,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

fn compile(name: &'static str, scene: Scene, size: [u32; 2]) -> Compiled {
    let options = Options {
        structures: vec![Structure::Bvh, Structure::Flagged, Structure::DualSplit],
        ..Options::default()
    };
    compile_with(name, scene, size, &options)
}

fn compile_with(
    name: &'static str,
    mut scene: Scene,
    [width, height]: [u32; 2],
    options: &Options,
) -> Compiled {
    (scene.render.width, scene.render.height) = (width, height);
    let compiled = compile::compile(&scene, options).expect("the scene compiles");
    Compiled {
        name,
        blob: compiled.blob,
    }
}

pub fn repository() -> &'static Path {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().expect("the package lies in the repository")
}
