//! The scenes that go into flash, compiled small.

use glam::{DQuat, DVec3};
use gridel_core::render::Pixel;
use gridel_core::{Format, Rgb888, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{self, Options};
use gridel_host::render::{Job, render_moments};
use gridel_host::sample;
use gridel_host::scene::{
    self, Attributes, Camera, Displacements, Instance, Interpolation, Key, Light, Material,
    MorphTarget, Normals, NormalsChoice, Object, Part, Placement, Scene, Shape, SourceSpan, Track,
    TrackTarget,
};
use gridel_host::shape::Sphere;
use gridel_tests::random::Random;
use gridel_tests::scenes::from_its_corner;
use std::env;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::slice::from_ref;

/// A blob, with the name of its scene.
pub struct Compiled {
    pub name: &'static str,
    pub blob: Blob,
}

/// Shadows, highlights, mirrors, glass that absorbs, and checkers.
pub fn quick() -> Compiled {
    fixture("quick", [48, 36])
}

/// Returns that scene with every structure, including small tables.
pub fn quick_through_everything() -> Compiled {
    let options = Options {
        structures: Structure::ALL.to_vec(),
        gridels: Some(1),
        budget: Some(4096),
        ..Options::default()
    };
    compile_with("quick", load(&fixture_path("quick")), [48, 36], options)
}

/// Light through 100 clear panes, and a ball between two mirrors, to depth 32: limits that hold without indirect light.
pub fn deep() -> Compiled {
    let mut text = String::from(
        "[camera]\neye = [0.5, 1, 0]\ntarget = [0, 0.9, -4]\nfov = 70\n[render]\ndepth = 32\n\
         [material.mirror]\ndiffuse = 0\nmirror = 0.95\n[material.clear]\ntransmit = 1\nior = 1\n\
         [[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\ncolor = 0.9\n\
         [[object]]\nkind = 'sphere'\ncenter = [0, 0.5, -2]\nradius = 0.5\n",
    );
    for (z, normal) in [(-4, 1), (4, -1)] {
        text += &format!(
            "[[object]]\nkind = 'disc'\ncenter = [0, 0, {z}]\nnormal = [0, 0, {normal}]\nradius = 9\n\
             material = 'mirror'\n"
        );
    }
    for pane in 0..100 {
        let y = 5.0 + 0.1 * f64::from(pane);
        text += &format!(
            "[[object]]\nkind = 'disc'\ncenter = [0, {y}, -2]\nnormal = [0, 1, 0]\nradius = 1\n\
             material = 'clear'\n"
        );
    }
    let read = scene::read(
        "deep.toml".as_ref(),
        text.into(),
        &scene::ImportOptions::default(),
    );
    let compiled = compile_with("deep", read.expect("a scene").scene, [32, 24], small());
    assert_eq!(view_depth(&compiled), 32);
    assert!(!compiled.features().contains(&"indirect"));
    compiled
}

/// Glass on glass, to depth 6.
pub fn glass_chess() -> Compiled {
    let compiled = fixture("glass-chess", [48, 36]);
    assert_eq!(view_depth(&compiled), 6);
    compiled
}

/// Scenes of the paper's sorts and sizes, a glass chessboard and two crystals for its molecules, with
/// some structures.
pub fn papers(structures: &[Structure]) -> [Compiled; 3] {
    PAPERS.map(|name| paper(name, structures, None))
}

/// The names of these scenes.
pub const PAPERS: [&str; 3] = ["paper-150", "paper-2800", "paper-27000"];
/// The smaller crystal, seen from so near that it fills the picture.
pub const CLOSE: &str = "paper-2800-close";

/// One of these scenes, with some structures; the cylinder cubes with so many gridels per side.
pub fn paper(name: &'static str, structures: &[Structure], gridels: Option<u32>) -> Compiled {
    let mut scene = match name {
        "paper-150" => load(&fixture_path("glass-chess")),
        "paper-27000" => sample::diamond(sample::DIAMOND_27_000),
        _ => sample::diamond(sample::DIAMOND_2_800),
    };
    if name == CLOSE
        && let Some(camera) = &mut scene.camera
    {
        camera.eye = camera.target + 0.45 * (camera.eye - camera.target);
    }
    let options = Options {
        structures: structures.to_vec(),
        gridels,
        ..Options::default()
    };
    compile_with(name, scene, [48, 36], options)
}

fn view_depth(compiled: &Compiled) -> u8 {
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    scene.view().depth
}

/// The chessboard for the smallest board: a lattice of 16 bits, 64 by 64 pixels, depth 4.
pub fn glass_chess_small() -> Compiled {
    let mut scene = load(&fixture_path("glass-chess"));
    scene.render.depth = 4;
    compile_with("glass-chess-64", scene, [64, 64], small())
}

/// A molecule of 2,800 atoms: a computed tube of carbon.
pub fn molecule() -> Compiled {
    let scene = sample::nanotube(10, 10, 172.0);
    compile_with("nanotube", scene, [64, 64], small())
}

/// The real scenes' files.
pub const PROTEIN: &str = "molecules/3dqb.pdb";
pub const SUZANNE: &str = "meshes/suzanne.obj";

/// A protein of about as many atoms.
pub fn protein() -> Compiled {
    let scene = from_its_corner(load(&real(PROTEIN)));
    compile_with("3dqb", scene, [64, 64], small())
}

/// A torus of 2,048 triangles, lit from the side on which it is seen.
pub fn torus_mesh() -> Compiled {
    compile_with("torus-mesh", torus_mesh_scene([32; 2]), [64, 64], small())
}

/// The torus in a picture that is rendered often.
pub fn torus_mesh_in_few_pixels() -> Compiled {
    compile_with(
        "torus-mesh-24",
        torus_mesh_scene([32; 2]),
        [24, 18],
        small(),
    )
}

/// A torus of 2 times these numbers of triangles, whose vertices have room to move.
pub fn deforming_torus(rings: u32, around: u32, lattice_bits: u8) -> Compiled {
    let options = Options {
        structures: vec![Structure::Bvh],
        lattice_bits,
        room: 0.25,
        ..Options::default()
    };
    let name = if lattice_bits > 16 {
        "torus-24"
    } else {
        "torus-16"
    };
    compile_with(name, torus_mesh_scene([rings, around]), [64, 64], options)
}

/// A smooth torus of 2 times these numbers of triangles with two morph targets: it lifts on one side, and swells.
pub fn morphing_torus(rings: u32, around: u32, lattice_bits: u8) -> Compiled {
    let mut scene = torus_mesh_scene([rings, around]);
    let object = &mut scene.objects[0];
    let Shape::Mesh { vertices, .. } = &object.shape else {
        panic!("a mesh");
    };
    let lift = vertices.iter().map(|it| DVec3::Z * it.x.max(0.0) * 0.5);
    let swell = vertices.iter().map(|it| *it * 0.3 + DVec3::Z * it.z);
    let displacements = [lift.collect(), swell.collect()].into_iter().enumerate();
    object.attributes.displacements = displacements
        .map(|(target, vectors)| Displacements { target, vectors })
        .collect();
    object.shade(NormalsChoice::Smooth(60.0));
    for (index, weights) in [[0.0, 1.0, 0.25], [0.5, 0.0, 1.0]].into_iter().enumerate() {
        scene.morph_targets.push(MorphTarget {
            name: String::from("target"),
            weight: weights[0],
            range: [0.0, 1.0],
            place: SourceSpan::default(),
        });
        let key = |(seconds, weight): (f64, f64)| Key {
            seconds,
            value: [weight, 0.0, 0.0, 0.0],
            ..Key::default()
        };
        scene.tracks.push(Track {
            target: TrackTarget::MorphWeight,
            index,
            interpolation: [Interpolation::Linear, Interpolation::Cubic][index],
            keys: [0.0, 1.0, 2.0].into_iter().zip(weights).map(key).collect(),
            place: SourceSpan::default(),
        });
    }
    let options = Options {
        structures: vec![Structure::Bvh],
        lattice_bits,
        ..Options::default()
    };
    compile_with("morphing-torus", scene, [64, 64], options)
}

/// A torus of so many rings, and so many vertices around each of them.
fn torus_mesh_scene([rings, around]: [u32; 2]) -> Scene {
    let part = |step: u32, of: u32| f64::from(step) * TAU / f64::from(of);
    let vertex = |ring: u32, step: u32| {
        let (along, across) = (part(ring, rings), part(step, around));
        let radius = 1.0 + 0.4 * libm::cos(across);
        DVec3::new(
            radius * libm::cos(along),
            radius * libm::sin(along),
            0.4 * libm::sin(across),
        )
    };
    let number = |ring: u32, step: u32| ring % rings * around + step % around;
    let faces = |ring, step| {
        let [a, b] = [number(ring, step), number(ring + 1, step)];
        let [c, d] = [number(ring + 1, step + 1), number(ring, step + 1)];
        [[a, b, c], [a, c, d]]
    };
    let cells = |ring| (0..around).map(move |step| (ring, step));
    let cells = (0..rings).flat_map(cells);
    Scene {
        camera: Some(Camera {
            eye: DVec3::new(0.6, -3.2, 2.4),
            target: DVec3::ZERO,
            up: DVec3::Z,
            fov_degrees: 45.0,
        }),
        ambient: [0.1; 3],
        lights: vec![Light::Directional {
            direction: DVec3::new(0.5, 1.0, -1.0),
            color: [0.8; 3],
        }],
        materials: vec![Material::default()],
        objects: vec![Object {
            name: String::from("torus-mesh"),
            material: 0,
            shape: Shape::Mesh {
                vertices: cells
                    .clone()
                    .map(|(ring, step)| vertex(ring, step))
                    .collect(),
                triangles: cells.flat_map(|(ring, step)| faces(ring, step)).collect(),
            },
            place: SourceSpan::default(),
            normals: Default::default(),
            attributes: Default::default(),
        }],
        ..Scene::default()
    }
}

/// The mesh on which tracers for boards are compared: seen from 3.2 before its middle, in a square
/// picture that is 2.9 wide there.
pub fn suzanne() -> Compiled {
    compile("suzanne", suzanne_scene(), [64, 64])
}

/// Suzanne on a lattice of 16 bits, which moves no vertex by more than 2.4e-5 of 2.7.
pub fn suzanne_in_16_bits() -> Compiled {
    let (name, size) = ("suzanne-16", [64, 64]);
    compile_with(name, suzanne_scene(), size, small())
}

/// Suzanne in as few bytes as a hierarchy takes.
pub fn small_suzanne() -> Compiled {
    let options = Options {
        structures: vec![Structure::Flagged],
        leaf_size: 8,
        ..small()
    };
    let (name, size) = ("suzanne-small", [64, 64]);
    compile_with(name, suzanne_scene(), size, options)
}

/// Suzanne turned by 30 degrees and scaled by 0.7, without light, as an instance of a part and as an object. The camera
/// was moved likewise.
pub fn suzanne_as_an_instance() -> [Compiled; 2] {
    let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
    let placement = Placement {
        rotation: DQuat::from_axis_angle(axis, PI / 6.0),
        translation: DVec3::ZERO,
        scale: 0.7,
    };
    let mut flat = suzanne_scene();
    (flat.ambient, flat.lights) = ([1.0; 3], Vec::new());
    let mut placed = flat.clone();
    if let Some(camera) = &mut placed.camera {
        camera.eye = placement.point(camera.eye);
        camera.target = placement.point(camera.target);
        camera.up = placement.rotation * camera.up;
    }
    placed.parts = vec![Part {
        name: String::from("suzanne"),
        objects: std::mem::take(&mut placed.objects),
        place: SourceSpan::default(),
    }];
    placed.instances = vec![Instance {
        name: String::from("suzanne"),
        part: 0,
        joint: None,
        placement,
        place: SourceSpan::default(),
    }];
    [placed, flat].map(|scene| compile("suzanne-placed", scene, [64, 64]))
}

/// An arm of six instances on a chain of joints.
pub fn arm() -> Compiled {
    fixture("robot-arm", [64, 64])
}

/// 32 instances of one ball, here and there.
pub fn thirty_two_balls() -> Compiled {
    let random = &mut Random(32);
    let mut scene = torus_mesh_scene([3, 3]);
    scene.lights.clear();
    scene.objects.clear();
    scene.parts = vec![Part {
        name: String::from("ball"),
        objects: vec![Object {
            normals: Normals::default(),
            attributes: Attributes::default(),
            name: String::from("ball"),
            material: 0,
            shape: Shape::Sphere(Sphere {
                center: DVec3::ZERO,
                radius: 0.1,
            }),
            place: SourceSpan::default(),
        }],
        place: SourceSpan::default(),
    }];
    let turned = |random: &mut Random| Placement {
        rotation: DQuat::from_axis_angle(DVec3::from_array(random.direction()), random.signed()),
        translation: DVec3::from_array(random.direction()) * random.unit(),
        scale: 1.0,
    };
    scene.instances = (0..32)
        .map(|number| Instance {
            name: format!("ball {number}"),
            part: 0,
            joint: None,
            placement: turned(random),
            place: SourceSpan::default(),
        })
        .collect();
    compile_with("balls", scene, [32, 32], small())
}

fn suzanne_scene() -> Scene {
    let mut scene = load(&real(SUZANNE));
    // As other tracers draw it.
    scene
        .objects
        .iter_mut()
        .for_each(|object| object.normals = Default::default());
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
    scene
}

impl Compiled {
    /// The Cargo features of the core that the scene requires.
    pub fn features(&self) -> Vec<&'static str> {
        let scene = self.blob.scene().expect("the compiler's own blob");
        scene.features().collect()
    }

    /// The picture as the host renders it: three bytes per pixel.
    pub fn picture(&self, format: Format) -> Vec<u8> {
        self.picture_through(Structure::DualSplit, format)
    }

    /// Returns the picture through a structure of choice.
    pub fn picture_through(&self, structure: Structure, format: Format) -> Vec<u8> {
        let scene = self.blob.scene().expect("the compiler's own blob");
        picture(&scene, structure, format)
    }
}

/// Returns a scene's picture as the host renders it: three bytes per pixel.
pub fn picture(scene: &gridel_core::Scene<'_>, structure: Structure, format: Format) -> Vec<u8> {
    picture_of(from_ref(scene), structure, format, Settings::of(scene))
}

/// The picture of a scene at several moments while a shutter is open.
pub fn picture_of(
    moments: &[gridel_core::Scene<'_>],
    structure: Structure,
    format: Format,
    settings: Settings,
) -> Vec<u8> {
    let job = Job::whole(format, structure, settings);
    let picture = render_moments(moments, &job, &|| ()).expect("the blob holds the structure");
    let encoded = picture.pixels.iter();
    let encoded = encoded.map(|&linear| Rgb888::encode(linear, None).0);
    encoded.flatten().collect()
}

fn fixture(name: &'static str, size: [u32; 2]) -> Compiled {
    compile(name, load(&fixture_path(name)), size)
}

pub fn fixture_path(name: &str) -> PathBuf {
    let path = repository().join("fixtures").join(name);
    path.with_extension("toml")
}

/// Returns the path of a real scene, which need not exist.
pub fn real(name: &str) -> PathBuf {
    let folder = env::var_os("GRIDEL_SCENES")
        .map_or_else(|| repository().join("../shared/scenes"), PathBuf::from);
    folder.join(name)
}

fn load(path: &Path) -> Scene {
    match scene::load(path, &Default::default()) {
        Ok(imported) => imported.scene,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

/// A scene file as `gridel build` compiles it by default.
pub fn by_default(name: &'static str, path: &Path) -> Compiled {
    let compiled = compile::compile(&load(path), &Options::default());
    Compiled {
        name,
        blob: compiled.expect("the scene compiles").blob,
    }
}

/// Compiles a scene with all hierarchies, so that they can be compared.
fn compile(name: &'static str, scene: Scene, size: [u32; 2]) -> Compiled {
    let options = Options {
        structures: vec![Structure::Bvh, Structure::Flagged, Structure::DualSplit],
        ..Options::default()
    };
    compile_with(name, scene, size, options)
}

/// Returns the options that take the least flash.
pub fn small() -> Options {
    Options {
        structures: vec![Structure::DualSplit],
        lattice_bits: 16,
        ..Options::default()
    }
}

pub fn compile_with(
    name: &'static str,
    mut scene: Scene,
    [width, height]: [u32; 2],
    options: Options,
) -> Compiled {
    (scene.render.width, scene.render.height) = (width, height);
    let compiled = compile::compile(&scene, &options).expect("the scene compiles");
    Compiled {
        name,
        blob: compiled.blob,
    }
}

pub fn repository() -> &'static Path {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().expect("the package lies in the repository")
}
