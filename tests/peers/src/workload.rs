//! Workloads: scenes, and rays that are the same for everybody.

use glam::{DVec3, Vec3};
use gridel_host::scene::{self, MoleculeOptions, Scene, Shape};
use gridel_host::shape::Sphere;
use gridel_host::trace::SceneRay;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Triangles or spheres, in single precision.
#[derive(Clone)]
pub enum Geometry {
    Triangles(Vec<[Vec3; 3]>),
    Spheres(Vec<(Vec3, f32)>),
}

/// A scene to trace.
pub struct Workload {
    pub name: String,
    pub scene: Scene,
    pub geometry: Geometry,
}

/// A ray in scene units.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Query {
    pub origin: Vec3,
    pub direction: Vec3,
}

/// The answer to a ray.
#[derive(Clone, Copy, PartialEq)]
#[repr(transparent)]
pub struct Answer {
    /// Infinite for a miss, and 0 where any hit was asked for and there is one.
    pub t: f32,
}

/// Rays of one kind.
pub struct Rays {
    pub kind: &'static str,
    pub any: bool,
    pub queries: Vec<Query>,
    /// The queries in Gridel's form.
    pub scene_rays: Vec<SceneRay>,
}

impl Rays {
    pub fn new(kind: &'static str, any: bool, queries: Vec<Query>) -> Self {
        let scene_ray = |query: &Query| SceneRay {
            origin: query.origin.as_dvec3(),
            tmin: 0.0,
            direction: query.direction.as_dvec3(),
            tmax: f64::INFINITY,
        };
        Self {
            kind,
            any,
            scene_rays: queries.iter().map(scene_ray).collect(),
            queries,
        }
    }
}

/// The folder of scenes.
pub fn folder() -> PathBuf {
    std::env::var_os("GRIDEL_SCENES").map_or_else(
        || {
            PathBuf::from(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/../../../shared/scenes"
            ))
        },
        PathBuf::from,
    )
}

/// Scenes from files, by their names.
const FILES: [(&str, &str); 4] = [
    ("suzanne", "meshes/suzanne.obj"),
    ("bunny", "meshes/stanford-bunny.obj"),
    ("3dqb", "molecules/3dqb.pdb"),
    ("4YVS", "molecules/4YVS.cif"),
];
const FINER_BUNNY: &str = "bunny, each triangle in four";
pub const BALL: &str = "ball";

/// All scenes.
pub const NAMES: [&str; 6] = [
    FILES[0].0,
    FILES[1].0,
    FILES[2].0,
    FILES[3].0,
    FINER_BUNNY,
    BALL,
];

/// The scenes that are there; a scene that is not is named. Fails if one cannot be used.
pub fn workloads() -> Result<Vec<Workload>, String> {
    let mut all = Vec::new();
    for (name, file) in FILES {
        let path = folder().join(file);
        match load(name, &path)? {
            Some(workload) => all.push(workload),
            None => println!("SKIPPED: {} is absent", path.display()),
        }
    }
    let finer = all
        .iter()
        .find(|workload| workload.name == "bunny")
        .map(subdivided);
    all.extend(finer);
    all.push(ball());
    Ok(all)
}

fn load(name: &str, path: &Path) -> Result<Option<Workload>, String> {
    if !path.exists() {
        return Ok(None);
    }
    let imported =
        scene::load(path, &MoleculeOptions::default()).map_err(|error| error.to_string())?;
    Ok(Some(Workload::of(name, imported.scene)))
}

impl Workload {
    fn of(name: &str, scene: Scene) -> Self {
        let (mut triangles, mut spheres) = (Vec::new(), Vec::new());
        for object in &scene.objects {
            match &object.shape {
                Shape::Mesh {
                    vertices,
                    triangles: faces,
                } => {
                    let corner = |v: u32| vertices[v as usize].as_vec3();
                    triangles.extend(faces.iter().map(|face| face.map(corner)));
                }
                Shape::Sphere(Sphere { center, radius }) => {
                    spheres.push((center.as_vec3(), *radius as f32));
                }
                _ => {}
            }
        }
        let geometry = if spheres.is_empty() {
            Geometry::Triangles(triangles)
        } else {
            Geometry::Spheres(spheres)
        };
        Self {
            name: name.to_owned(),
            scene,
            geometry,
        }
    }

    pub fn primitives(&self) -> usize {
        match &self.geometry {
            Geometry::Triangles(triangles) => triangles.len(),
            Geometry::Spheres(spheres) => spheres.len(),
        }
    }

    /// The longest side of the scene's box.
    pub fn size(&self) -> f32 {
        let (low, high) = self.bounds();
        (high - low).max_element()
    }

    fn bounds(&self) -> (Vec3, Vec3) {
        let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let add = |(low, high): (Vec3, Vec3), point: Vec3| (low.min(point), high.max(point));
        match &self.geometry {
            Geometry::Triangles(triangles) => triangles.iter().flatten().copied().fold(empty, add),
            Geometry::Spheres(spheres) => {
                spheres.iter().fold(empty, |bounds, &(center, radius)| {
                    add(add(bounds, center - radius), center + radius)
                })
            }
        }
    }

    /// Rays through the pixels of a square picture of the whole scene.
    pub fn primary(&self, side: usize) -> Vec<Query> {
        let (low, high) = self.bounds();
        let middle = (low + high) * 0.5;
        let size = (high - low).max_element();
        let eye = middle + Vec3::new(0.3, 0.2, 1.6) * size;
        let forward = (middle - eye).normalize();
        let right = forward.cross(Vec3::Y).normalize();
        let up = right.cross(forward);
        let place = |pixel: usize| (pixel as f32 + 0.5) / side as f32 * 0.7 - 0.35;
        (0..side * side)
            .map(|pixel| {
                let (x, y) = (place(pixel % side), place(pixel / side));
                Query {
                    origin: eye,
                    direction: (forward + right * x - up * y).normalize(),
                }
            })
            .collect()
    }

    /// Rays from what was hit, in all directions of the half space outside.
    pub fn bounces(&self, primary: &[Query], hits: &[(f32, Vec3)]) -> Vec<Query> {
        let mut state = 0x9e37_79b9_u32;
        let mut random = move || {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            state as f32 / u32::MAX as f32 * 2.0 - 1.0
        };
        let (low, high) = self.bounds();
        let off = (high - low).max_element() * 1e-4;
        let met = primary
            .iter()
            .zip(hits)
            .filter(|(_, hit)| hit.0.is_finite());
        met.map(|(query, &(t, normal))| {
            let normal = if normal.dot(query.direction) > 0.0 {
                -normal
            } else {
                normal
            };
            let random = Vec3::new(random(), random(), random());
            Query {
                origin: query.origin + query.direction * t + normal * off,
                direction: (normal * 1.001 + random.normalize_or_zero()).normalize_or(normal),
            }
        })
        .collect()
    }

    /// Rays from inside a closed mesh at its vertices and along its edges: each must hit.
    pub fn at_seams(&self) -> Vec<Query> {
        let Geometry::Triangles(triangles) = &self.geometry else {
            return Vec::new();
        };
        let origin = Vec3::new(0.013, -0.027, 0.041);
        triangles
            .iter()
            .flat_map(|[a, b, c]| {
                [(a, b), (b, c), (c, a)]
                    .into_iter()
                    .flat_map(|(a, b)| [0.0, 0.25, 1.0 / 3.0, 0.5].map(|part| a.lerp(*b, part)))
            })
            .map(|target| Query {
                origin,
                direction: (target - origin).normalize(),
            })
            .collect()
    }
}

/// The mesh with every triangle cut in four, the new vertices moved along the normals a little: as
/// many triangles as a scan has.
fn subdivided(coarse: &Workload) -> Workload {
    let mut scene = coarse.scene.clone();
    for object in &mut scene.objects {
        let Shape::Mesh {
            vertices,
            triangles,
        } = &mut object.shape
        else {
            continue;
        };
        let mut normals = vec![DVec3::ZERO; vertices.len()];
        for face in triangles.iter() {
            let [a, b, c] = face.map(|v| vertices[v as usize]);
            for &v in face {
                normals[v as usize] += (b - a).cross(c - a);
            }
        }
        let mut middles = HashMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for &[a, b, c] in triangles.iter() {
            let mut middle = |a: u32, b: u32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let [p, q] = [a, b].map(|v| vertices[v as usize]);
                    let [m, n] = [a, b].map(|v| normals[v as usize].normalize_or_zero());
                    let bulge = (q - p).dot(m - n) * 0.125;
                    vertices.push((p + q) * 0.5 + (m + n).normalize_or_zero() * bulge);
                    vertices.len() as u32 - 1
                })
            };
            let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        *triangles = finer;
    }
    Workload::of(FINER_BUNNY, scene)
}

/// A closed ball of 20,480 triangles, for leaks.
fn ball() -> Workload {
    let mut scene = Scene::default();
    scene.materials.push(scene::Material::default());
    let (vertices, triangles) = icosphere(5);
    scene.objects.push(scene::Object {
        name: String::from("ball"),
        material: 0,
        shape: Shape::Mesh {
            vertices,
            triangles,
        },
        place: scene::SourceSpan::default(),
        normals: Default::default(),
        attributes: Default::default(),
    });
    Workload::of(BALL, scene)
}

/// An icosahedron, each triangle cut in four again and again, on the unit sphere.
fn icosphere(times: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let golden = f64::midpoint(1.0, 5_f64.sqrt());
    let mut vertices = Vec::new();
    for axis in 0..3 {
        for (one, long) in [
            (1.0, golden),
            (1.0, -golden),
            (-1.0, golden),
            (-1.0, -golden),
        ] {
            let mut vertex = [0.0; 3];
            vertex[(axis + 1) % 3] = one;
            vertex[(axis + 2) % 3] = long;
            vertices.push(DVec3::from_array(vertex).normalize());
        }
    }
    // The faces are the triples of vertices that are nearest to each other.
    let near = |a: DVec3, b: DVec3| a.distance(b) < 1.2;
    let mut triangles = Vec::new();
    for a in 0..12_u32 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|v| vertices[v as usize]);
                if near(p, q) && near(q, r) && near(r, p) {
                    let outward = (q - p).cross(r - p).dot(p) > 0.0;
                    triangles.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..times {
        let mut middles = HashMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let mut middle = |a: u32, b: u32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let sum: DVec3 = vertices[a as usize] + vertices[b as usize];
                    vertices.push(sum.normalize());
                    vertices.len() as u32 - 1
                })
            };
            let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        triangles = finer;
    }
    (vertices, triangles)
}
