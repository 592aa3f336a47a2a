//! Costs of each shape and effect in flash, stack and instructions: by building and running a
//! small scene with and without it.

use crate::scenes::{Compiled, compile_with, small};
use glam::{DAffine2, DQuat, DVec2, DVec3};
use gridel_core::{Effects, Kind, Structure};
use gridel_host::compile::Options;
use gridel_host::scene::{
    Alpha, Camera, Diffuse, Environment, Image, Instance, Lens, Light, LightForm, LightShape,
    Material, NormalMap, Normals, Object, Part, Placement, Scene, Shape, Sky, SourceSpan, Spot,
    Texture, ToneMapping,
};
use gridel_host::shape::{Cuboid, Sphere};
use gridel_tests::shapes::examples;

/// The scene that all others add to: a triangle and a diffuse light that throws no shadows.
pub const BASE: &str = "base";

const TRIANGLE: &str = Kind::Triangle.name();

/// Stands for a scene whose objects are placed by an instance.
const INSTANCES: &str = "instances";

/// A part's name, and how to require it.
type Requirements = [(&'static str, fn(&mut Scene)); 21];

const EFFECTS: Requirements = [
    ("shadow", |scene| scene.render.shadows = true),
    ("highlight", |scene| scene.materials[0].highlight = [0.5; 3]),
    ("mirror", |scene| scene.materials[0].mirror = [0.5; 3]),
    ("glossy", |scene| {
        scene.materials[0].mirror = [0.5; 3];
        scene.materials[0].roughness = 0.3;
    }),
    ("glass", |scene| scene.materials[0].transmit = [0.9; 3]),
    ("nested", |scene| {
        scene.materials[0].transmit = [0.9; 3];
        scene.materials[0].priority = Some(1);
    }),
    ("absorption", |scene| {
        scene.materials[0].transmit = [0.9; 3];
        scene.materials[0].absorption = [0.2; 3];
    }),
    ("checker", |scene| {
        scene.materials[0].diffuse = Diffuse::Checker {
            even: [0.8; 3],
            odd: [0.2; 3],
            size: 0.5,
            origin: DVec3::splat(0.1),
        }
    }),
    ("smooth", |scene| {
        scene.objects.iter_mut().for_each(make_smooth);
    }),
    ("normal-map", |scene| {
        scene.objects.iter_mut().for_each(paper);
        scene.materials[0].normal_map = Some(NormalMap {
            texture: gradients(|_| 255),
            scale: 0.5,
        });
    }),
    ("vertex-colors", |scene| {
        scene.objects.iter_mut().for_each(paint);
    }),
    ("texture", |scene| hang(scene, |_| 255)),
    ("alpha", |scene| {
        hang(scene, |it| 4 * it);
        scene.materials[0].alpha = Some(Alpha::CutOut(0.5));
    }),
    ("texture-levels", |scene| {
        if scene.materials[0].texture.is_none() {
            hang(scene, |_| 255);
        }
        let Material {
            texture,
            normal_map,
            ..
        } = &mut scene.materials[0];
        // So small that pixels see several texels.
        for it in texture
            .iter_mut()
            .chain(normal_map.as_mut().map(|it| &mut it.texture))
        {
            (it.levels, it.transform) = (true, DAffine2::from_scale(DVec2::splat(8.0)));
        }
    }),
    ("falloff", |scene| {
        let spot = Spot {
            direction: DVec3::new(0.4, 1.0, -1.0),
            inner: 20.0,
            outer: 40.0,
        };
        shine(scene, LightShape::Point, Some(spot));
    }),
    ("area-light", |scene| {
        shine(scene, LightShape::Sphere { radius: 0.5 }, None)
    }),
    ("tone-mapping", |scene| {
        scene.render.tone_mapping = ToneMapping::Aces;
    }),
    ("emission", |scene| {
        scene.materials[0].emission = [0.2; 3];
        scene.materials[0].lights = false;
    }),
    ("depth-of-field", |scene| {
        scene.lens = Some(Lens {
            radius: 0.2,
            focus: None,
        });
    }),
    ("indirect", |scene| scene.render.bounces = 2),
    ("environment", |scene| {
        scene.environment = Some(Environment {
            size: 16,
            ..Environment::of(Sky::Gradient {
                zenith: [0.2, 0.3, 0.6],
                horizon: [0.6; 3],
                ground: [0.1; 3],
            })
        });
    }),
];

/// Gives the light a form.
fn shine(scene: &mut Scene, shape: LightShape, spot: Option<Spot>) {
    scene.lights[0] = Light::Point {
        position: DVec3::new(-1.0, -2.5, 3.0),
        color: [9.0; 3],
    };
    scene.light_forms = vec![Some(LightForm {
        shape,
        spot,
        ..LightForm::default()
    })];
}

/// The base under a point light, and under lights with an area in its place.
pub fn lamps() -> [Compiled; 5] {
    let square = |side: f64| [DVec3::new(-side, 0.0, 0.0), DVec3::new(0.0, side, 0.0)];
    let shapes = [
        ("point-light", None),
        ("sphere-light", Some(LightShape::Sphere { radius: 0.5 })),
        (
            "rectangle-light",
            Some(LightShape::Rectangle { edges: square(0.5) }),
        ),
        (
            "near-rectangle-light",
            Some(LightShape::Rectangle { edges: square(3.0) }),
        ),
        (
            "disc-light",
            Some(LightShape::Disc {
                normal: DVec3::NEG_Z,
                radius: 0.5,
            }),
        ),
    ];
    shapes.map(|(name, shape)| {
        let mut scene = base();
        shine(&mut scene, shape.unwrap_or(LightShape::Point), None);
        if shape.is_none() {
            scene.light_forms.clear();
        }
        compile(name, scene)
    })
}

/// Gives all meshes a texture with this alpha.
fn hang(scene: &mut Scene, alpha: fn(u8) -> u8) {
    scene.objects.iter_mut().for_each(paper);
    scene.materials[0].texture = Some(gradients(alpha));
}

/// A texture of gradients with this alpha.
fn gradients(alpha: fn(u8) -> u8) -> Texture {
    let pixels = (0..64).map(|it| [4 * it, 255 - it, 3 * (it & 15), alpha(it)]);
    let image = Image::new("gradients", 8, 8, pixels.collect());
    Texture::of(image.expect("as many pixels").into())
}

/// The base, and a scene for every shape and effect.
pub fn scenes() -> Vec<Compiled> {
    let mut all = shapes();
    all.extend(effects());
    all
}

/// The base, and a scene for every other shape, without effects.
pub fn shapes() -> Vec<Compiled> {
    let mut all = vec![compile(BASE, base())];
    for (name, shape) in beside_triangles() {
        let mut scene = base();
        scene.objects.push(object(shape));
        all.push(compile(name, scene));
    }
    all
}

/// A scene for every effect, with the base's shapes; absorption comes with its glass.
pub fn effects() -> impl Iterator<Item = Compiled> {
    EFFECTS.into_iter().map(|(name, call_for)| {
        let mut scene = base();
        call_for(&mut scene);
        compile(name, scene)
    })
}

/// A shape of every kind, with shadows and a mirror.
pub fn every_shape() -> Compiled {
    let mut scene = base();
    scene.render.shadows = true;
    scene.materials[0].mirror = [0.3; 3];
    scene.objects = examples()
        .into_iter()
        .map(|(_, shape)| object(shape))
        .collect();
    compile("every-shape", scene)
}

/// Returns every shape and every effect, through a structure. With `instances`, an instance places all but planes.
pub fn everything(structure: Structure, instances: bool) -> Compiled {
    let mut scene = base();
    scene
        .objects
        .extend(beside_triangles().map(|(_, shape)| object(shape)));
    for (_, call_for) in EFFECTS {
        call_for(&mut scene);
    }
    // Glass has no alpha, so the triangles are no glass.
    let screen = Material {
        name: String::from("screen"),
        transmit: [0.0; 3],
        priority: None,
        ..scene.materials[0].clone()
    };
    scene.materials.push(screen);
    scene.objects[0].material = 1;
    if instances {
        let objects = scene.objects.into_iter();
        let (planes, others) = objects.partition(|it| matches!(it.shape, Shape::Plane(_)));
        scene.objects = others;
        place_a_part(&mut scene);
        scene.objects = planes;
    }
    let options = Options {
        structures: vec![structure],
        lattice_bits: 24,
        ..small()
    };
    let compiled = compile_with("everything", scene, [32, 32], options);
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    assert_eq!(scene.effects(), Effects::ALL);
    assert!(
        Kind::ALL
            .iter()
            .all(|kind| compiled.features().contains(&kind.name()))
    );
    compiled
}

/// A scene of some shapes and effects, with coordinates of 24 bits.
pub fn combination(shapes: &[&str], effects: &[&str]) -> Compiled {
    let mut scene = base();
    if !shapes.contains(&"triangle") {
        scene.objects.clear();
    }
    for (_, shape) in beside_triangles().filter(|(name, _)| shapes.contains(name)) {
        scene.objects.push(object(shape));
    }
    for (_, call_for) in EFFECTS
        .into_iter()
        .filter(|(name, _)| effects.contains(name))
    {
        call_for(&mut scene);
    }
    if shapes.contains(&INSTANCES) {
        place_a_part(&mut scene);
    }
    let options = Options {
        lattice_bits: 24,
        ..small()
    };
    let compiled = compile_with("combination", scene, [32, 32], options);
    let expected = [shapes, effects, &["wide-lattice"]].concat();
    let features = compiled.features();
    assert!(
        features.len() == expected.len() && features.iter().all(|it| expected.contains(it)),
        "{features:?}, and not {expected:?}"
    );
    compiled
}

/// Gives the corners of a mesh normals that lean away from each other.
fn make_smooth(object: &mut Object) {
    let Shape::Mesh {
        vertices,
        triangles,
    } = &object.shape
    else {
        return;
    };
    let center = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
    let [a, b, c] = triangles[0].map(|it| vertices[it as usize]);
    let face = (b - a).cross(c - a).normalize();
    let leaning = vertices.iter().map(|&it| 2.0 * face + (it - center));
    object.normals = Normals::given(leaning.collect(), triangles.clone(), (vertices, triangles));
}

/// Gives the vertices of a mesh colors.
fn paint(object: &mut Object) {
    if let Shape::Mesh { vertices, .. } = &object.shape {
        let colors = (0..vertices.len()).map(|it| [0.3, 0.2 * (it % 5) as f64, 0.9]);
        object.attributes.colors = colors.collect();
    }
}

/// Gives the vertices of a mesh texture coordinates.
fn paper(object: &mut Object) {
    if let Shape::Mesh {
        vertices,
        triangles,
    } = &object.shape
    {
        let coordinates = vertices.iter().map(|it| DVec2::new(it.x, it.y));
        object.attributes.coordinates = coordinates.collect();
        object.attributes.triangles.clone_from(triangles);
    }
}

/// Moves all objects into a part, and places that.
fn place_a_part(scene: &mut Scene) {
    scene.parts.push(Part {
        name: String::from("part"),
        objects: std::mem::take(&mut scene.objects),
        place: SourceSpan::default(),
    });
    scene.instances.push(Instance {
        name: String::from("instance"),
        part: 0,
        joint: None,
        placement: Placement {
            rotation: DQuat::from_rotation_z(0.5),
            translation: DVec3::new(0.1, 0.2, 0.3),
            scale: 0.9,
        },
        place: SourceSpan::default(),
    });
}

/// The parts of the bar for flash: spheres and triangles, diffuse, with shadows.
pub fn sphere_and_triangle() -> Compiled {
    let mut scene = base();
    scene.render.shadows = true;
    scene.objects.push(object(Shape::Sphere(Sphere {
        center: DVec3::new(0.0, 0.0, 1.0),
        radius: 0.8,
    })));
    compile("sphere, triangle, shadow", scene)
}

/// Returns scenes that each require one thing that [`sphere_and_triangle`] does not, with the error message for it.
pub fn outgrown() -> [(&'static str, Compiled); 7] {
    let [mirrors, _] = deeper();
    let mut cuboid = base();
    let (min, max) = (DVec3::splat(-0.7), DVec3::splat(0.7));
    cuboid.objects.push(object(Shape::Box(Cuboid { min, max })));
    let through = |structure: Structure| {
        let options = Options {
            structures: vec![structure],
            ..small()
        };
        compile_with(structure.name(), base(), [32, 32], options)
    };
    let mut larger = base();
    larger.objects.push(object(Shape::Sphere(Sphere {
        center: DVec3::new(0.0, 0.0, 1.0),
        radius: 80.0,
    })));
    let wider = compile_with("wider", base(), [33, 32], small());
    [
        ("the blob requires effects beyond EFFECTS", mirrors),
        ("the blob's picture has another size", wider),
        ("the scene requires `box`", compile("box", cuboid)),
        (
            "the blob does not hold the structure of Accel",
            through(Structure::Flagged),
        ),
        ("or has other structures", through(Structure::Grid)),
        ("the blob outgrew STACK_DEPTH", super::scenes::torus_mesh()),
        (
            "the blob has another COORDINATE_EXPONENT",
            compile("larger", larger),
        ),
    ]
}

/// A mirror scene and the same with more reflections.
pub fn deeper() -> [Compiled; 2] {
    [2, 3].map(|depth| {
        let mut scene = base();
        scene.render.depth = depth;
        scene.materials[0].mirror = [0.5; 3];
        compile("deeper", scene)
    })
}

/// The base again, for each wider form of storage, which the code for it makes dearer.
pub fn wider_storage() -> [Compiled; 2] {
    ["wide-lattice", "wide-indices"].map(|name| compile(name, base()))
}

fn base() -> Scene {
    let mut scene = Scene {
        camera: Some(Camera {
            eye: DVec3::new(0.0, -5.0, 2.5),
            target: DVec3::new(0.0, 0.0, 0.7),
            up: DVec3::Z,
            fov_degrees: 40.0,
        }),
        ambient: [0.1; 3],
        lights: vec![Light::Directional {
            direction: DVec3::new(0.4, 1.0, -1.0),
            color: [0.8; 3],
        }],
        materials: vec![Material::default()],
        objects: triangles().map(|(_, shape)| object(shape)).collect(),
        ..Scene::default()
    };
    scene.render.shadows = false;
    scene
}

fn triangles() -> impl Iterator<Item = (&'static str, Shape)> {
    examples().into_iter().filter(|(name, _)| *name == TRIANGLE)
}

/// A shape of every other kind.
fn beside_triangles() -> impl Iterator<Item = (&'static str, Shape)> {
    examples().into_iter().filter(|(name, _)| *name != TRIANGLE)
}

fn object(shape: Shape) -> Object {
    Object {
        name: String::from("thing"),
        material: 0,
        normals: Default::default(),
        attributes: Default::default(),
        shape,
        place: SourceSpan::default(),
    }
}

fn compile(name: &'static str, scene: Scene) -> Compiled {
    compile_with(name, scene, [32, 32], small())
}
