//! Scenes: generated ones, the project's fixtures, and real ones where they are available.

use crate::random::Random;
use glam::DVec3;
use gridel_core::Structure;
use gridel_host::blob::Blob;
use gridel_host::compile::{CompileError, Options, compile};
use gridel_host::scene::{
    Camera, Interpolation, Key, Light, Material, MoleculeOptions, Object, Scene, Shape, SourceSpan,
    Track, TrackTarget, load,
};
use gridel_host::shape::{Cone, Cuboid, Disc, Sphere};
use std::path::{Path, PathBuf};

/// A scene of shapes of one plain material.
pub fn of(shapes: impl IntoIterator<Item = Shape>) -> Scene {
    let objects = shapes.into_iter().map(|shape| Object {
        name: String::from("thing"),
        material: 0,
        shape,
        place: SourceSpan::default(),
        normals: Default::default(),
        attributes: Default::default(),
    });
    Scene {
        materials: vec![Material::default()],
        objects: objects.collect(),
        ..Scene::default()
    }
}

/// A track of a scene; keys are times and values.
pub fn track<const N: usize>(
    target: TrackTarget,
    index: usize,
    interpolation: Interpolation,
    keys: &[(f64, [f64; N])],
) -> Track {
    let four = |value: [f64; N]| std::array::from_fn(|k| value.get(k).copied().unwrap_or(0.0));
    let keys = keys.iter().map(|&(seconds, value)| Key {
        seconds,
        value: four(value),
        entering: four(value),
        leaving: four(value.map(|it| 0.5 - it)),
    });
    Track {
        target,
        index,
        interpolation,
        keys: keys.collect(),
        place: SourceSpan::default(),
    }
}

/// Returns tracks of everything that moves in a scene whose last material without alpha is a checkerboard. The camera
/// turns by a rotation, or looks at a target and orbits it.
pub fn moving(scene: &Scene, by_rotation: bool) -> Vec<Track> {
    use Interpolation::{Cubic, Linear, Step};
    let mut tracks = vec![
        track(
            TrackTarget::CameraEye,
            0,
            Cubic,
            &[
                (-0.5, [0.5, 0.7, 4.0]),
                (1.0, [1.0, 1.0, 3.0]),
                (2.0, [-1.0, 1.0, 3.0]),
            ],
        ),
        track(
            TrackTarget::CameraFieldOfView,
            0,
            Linear,
            &[(0.0, [40.0]), (1.5, [55.0])],
        ),
    ];
    if by_rotation {
        let turned = [
            (0.0, [0.0, 0.0, 0.0, 1.0]),
            (1.0, [0.0, 0.6, 0.0, 0.8]),
            (2.0, [0.2, 0.3, 0.4, -0.9]),
        ];
        tracks.push(track(TrackTarget::CameraRotation, 0, Linear, &turned));
    } else {
        tracks.extend([
            track(
                TrackTarget::CameraTarget,
                0,
                Linear,
                &[(0.0, [0.0; 3]), (1.0, [0.1, 0.2, 0.3])],
            ),
            track(
                TrackTarget::CameraUp,
                0,
                Linear,
                &[(0.0, [0.0, 1.0, 0.0]), (2.0, [0.3, 2.0, 0.1])],
            ),
            track(
                TrackTarget::CameraOrbit,
                0,
                Linear,
                &[(0.0, [0.0]), (2.0, [360.0])],
            ),
        ]);
    }
    for (index, light) in scene.lights.iter().enumerate() {
        let keys = [(0.25, [3.0, 4.0, 5.0]), (1.25, [-2.0, 5.0, 1.0])];
        let (target, interpolation) = match light {
            Light::Point { .. } => (TrackTarget::LightPosition, Linear),
            Light::Directional { .. } => (TrackTarget::LightDirection, Cubic),
        };
        tracks.push(track(target, index, interpolation, &keys));
        let colors = [(0.0, [0.2, 0.4, 0.8]), (0.5, [0.9, 0.1, 0.3])];
        tracks.push(track(
            TrackTarget::LightColor,
            index,
            [Step, Cubic][index % 2],
            &colors,
        ));
    }
    let opaque = |it: &Material| it.alpha.is_none();
    let material = scene.materials.iter().rposition(opaque).unwrap_or(0);
    for target in [
        TrackTarget::MaterialDiffuse,
        TrackTarget::MaterialOdd,
        TrackTarget::MaterialHighlight,
        TrackTarget::MaterialMirror,
        TrackTarget::MaterialTransmit,
    ] {
        let keys = [(0.0, [0.1, 0.5, 0.9]), (1.0, [1.0, 0.25, 0.0])];
        tracks.push(track(target, material, Linear, &keys));
    }
    tracks
}

/// Returns a blob with every structure that loading proves. Tables of candidates take long to build and have tests of
/// their own.
pub fn blob(scene: &Scene, lattice_bits: u8) -> Blob {
    blob_with_inside(scene, lattice_bits).expect("meshes with an inside")
}

/// Returns the blob, or `None` if a closed mesh has no inside on the lattice.
pub fn blob_with_inside(scene: &Scene, lattice_bits: u8) -> Option<Blob> {
    let all = Structure::ALL.into_iter();
    let options = Options {
        structures: all.filter(|structure| structure.is_proved()).collect(),
        lattice_bits,
        ..Options::default()
    };
    match compile(scene, &options) {
        Err(CompileError::Flattened { .. }) => None,
        compiled => Some(compiled.expect("compiles").blob),
    }
}

/// A blob with every structure, the cylinder cubes with a number of gridels per side.
pub fn blob_with_gridels(scene: &Scene, lattice_bits: u8, gridels: u32) -> Blob {
    blob_with_tables(scene, lattice_bits, gridels, 1 << 24)
}

/// A blob with every structure, and tables as small as they can be.
pub fn compact_blob(scene: &Scene, lattice_bits: u8) -> Blob {
    let options = compact_options(lattice_bits);
    compile(scene, &options).expect("compiles").blob
}

fn blob_with_tables(scene: &Scene, lattice_bits: u8, gridels: u32, budget: u64) -> Blob {
    let options = all_structures(lattice_bits, gridels, budget);
    compile(scene, &options).expect("compiles").blob
}

/// Options for all structures, with the smallest tables.
pub fn compact_options(lattice_bits: u8) -> Options {
    all_structures(lattice_bits, 1, 4096)
}

fn all_structures(lattice_bits: u8, gridels: u32, budget: u64) -> Options {
    Options {
        structures: Structure::ALL.to_vec(),
        lattice_bits,
        gridels: Some(gridels),
        budget: Some(budget),
        ..Options::default()
    }
}

/// Reads a scene file, with its own folder as base.
pub fn read(path: &Path) -> Scene {
    match load(path, &MoleculeOptions::default()) {
        Ok(imported) => imported.scene,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

/// The project's folder of fixtures.
pub fn fixture_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures")
}

/// Returns the manifest with the records of the fixtures.
pub fn manifest() -> PathBuf {
    fixture_folder().join("check.toml")
}

/// All scenes in the project's folder of fixtures, by name.
pub fn fixtures() -> Vec<(String, Scene)> {
    let folder = fixture_folder();
    let mut paths: Vec<PathBuf> = std::fs::read_dir(&folder)
        .expect("the folder of fixtures")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml" || e == "pdb"))
        .filter(|path| *path != manifest())
        .collect();
    paths.sort();
    assert!(paths.len() >= 10, "{} fixtures", paths.len());
    let name = |path: &PathBuf| path.file_stem().unwrap_or_default().display().to_string();
    paths.iter().map(|path| (name(path), read(path))).collect()
}

/// Returns a file of real scenes: below `GRIDEL_SCENES`, or in the folder `shared/scenes` next to the repository. Tests
/// that need one are skipped, with a message, where it is absent.
pub fn real(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("GRIDEL_SCENES").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes"),
        PathBuf::from,
    );
    let path = folder.join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!(
        "SKIPPED: {} is not there; set GRIDEL_SCENES",
        path.display()
    );
    None
}

/// Returns a scene of spheres from above its front right corner. Costs of molecules were recorded in this view from the
/// beginning.
pub fn from_its_corner(mut scene: Scene) -> Scene {
    let spheres = scene
        .objects
        .iter()
        .filter_map(|object| match object.shape {
            Shape::Sphere(Sphere { center, radius }) => Some((center - radius, center + radius)),
            _ => None,
        });
    let nowhere = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (lowest, highest) = spheres.fold(nowhere, |(lowest, highest), (low, high)| {
        (lowest.min(low), highest.max(high))
    });
    let target = (lowest + highest) * 0.5;
    let diagonal = highest - lowest;
    let longest = diagonal.max_element();
    let radius = 0.5 * longest * (diagonal / longest).length();
    let fov_degrees: f64 = 40.0;
    let distance = radius / (fov_degrees.to_radians() * 0.5).sin();
    scene.camera = Some(Camera {
        eye: target + DVec3::new(0.45, 0.35, 1.0).normalize() * distance,
        target,
        up: DVec3::Y,
        fov_degrees,
    });
    scene
}

fn point(random: &mut Random, size: f64) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| random.signed() * size))
}

/// A random shape of a kind (0 to 7) at a place of about a size.
pub fn shape(random: &mut Random, kind: usize, place: DVec3, size: f64) -> Shape {
    let length = |random: &mut Random| size * random.magnitude(0.1, 1.0);
    match kind {
        0 | 1 => Shape::Mesh {
            vertices: (0..3).map(|_| place + point(random, size)).collect(),
            triangles: vec![[0, 1, 2]],
        },
        2 => Shape::Sphere(Sphere {
            center: place,
            radius: length(random),
        }),
        3 => Shape::Box(Cuboid {
            min: place,
            max: place + point(random, size).abs(),
        }),
        4 => Shape::Disc(Disc {
            center: place,
            normal: DVec3::from_array(random.direction()),
            radius: length(random),
        }),
        _ => {
            let radius = length(random);
            Shape::Cone(Cone {
                base: place,
                base_radius: radius,
                apex: place + DVec3::from_array(random.direction()) * size,
                apex_radius: [radius, 0.0, length(random)][kind - 5],
            })
        }
    }
}

/// Shapes of every kind thrown into a cube of edge 2.
pub fn soup(seed: u64, count: usize, size: f64) -> Scene {
    let mut random = Random(seed);
    of((0..count).map(|number| {
        let place = point(&mut random, 1.0);
        shape(&mut random, number % 8, place, size)
    }))
}

/// Returns a bent sheet of `squares` squares per side, as a mesh.
pub fn sheet(squares: u32) -> Shape {
    let row = squares + 1;
    let corner = |number: u32| {
        let (x, y) = (f64::from(number % row), f64::from(number / row));
        DVec3::new(x, y, (x * y) % 1.75)
    };
    let square = |number: u32| {
        let first = number / squares * row + number % squares;
        let [a, b, c, d] = [0, 1, row, row + 1].map(|it| first + it);
        [[a, b, c], [b, d, c]]
    };
    Shape::Mesh {
        vertices: (0..row * row).map(corner).collect(),
        triangles: (0..squares * squares).flat_map(square).collect(),
    }
}

/// The icosphere of a number of subdivisions: 20 times 4 to that power triangles.
pub fn icosphere(subdivisions: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let golden = 0.5 + 1.25_f64.sqrt();
    let mut vertices = Vec::new();
    for (a, b) in [
        (1.0, golden),
        (-1.0, golden),
        (1.0, -golden),
        (-1.0, -golden),
    ] {
        vertices.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]].map(DVec3::from_array));
    }
    // The faces are the triples of vertices at the edges' distance, 2.
    let mut triangles = Vec::new();
    let joined = |a: DVec3, b: DVec3| (a.distance_squared(b) - 4.0).abs() < 1e-9;
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|v: usize| vertices[v]);
                if joined(p, q) && joined(q, r) && joined(r, p) {
                    let outward = (q - p).cross(r - p).dot(p) > 0.0;
                    let face = if outward { [a, b, c] } else { [a, c, b] };
                    triangles.push(face.map(|v| v as u32));
                }
            }
        }
    }
    vertices.iter_mut().for_each(|v| *v = v.normalize());
    for _ in 0..subdivisions {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
                vertices.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    (vertices, triangles)
}
