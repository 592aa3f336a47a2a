use super::*;
use crate::random::Random;
use crate::scene::placement::tests::any;
use crate::scene::{Material, Placement, Shape, SourceSpan};
use crate::shape::{Cuboid, Sphere};
use glam::{DQuat, DVec3};
use std::path::Path;

fn object(name: &str, shape: Shape) -> Object {
    Object {
        name: name.to_owned(),
        material: 0,
        shape,
        place: SourceSpan::of(Path::new("a.toml")),
        normals: Default::default(),
        attributes: Default::default(),
    }
}

fn sphere() -> Object {
    let shape = Sphere {
        center: DVec3::X,
        radius: 0.5,
    };
    object("ball", Shape::Sphere(shape))
}

/// A scene with an object of its own, and a part at these places.
fn scene(objects: Vec<Object>, placements: &[Placement]) -> Scene {
    let place = SourceSpan {
        line: 7,
        ..SourceSpan::of(Path::new("a.toml"))
    };
    let instance = |(number, &placement): (usize, &Placement)| Instance {
        name: format!("copy {number}"),
        part: 0,
        placement,
        joint: None,
        place: place.clone(),
    };
    Scene {
        materials: vec![Material::default()],
        objects: vec![sphere()],
        instances: placements.iter().enumerate().map(instance).collect(),
        parts: vec![Part {
            name: String::from("part"),
            objects,
            place: place.clone(),
        }],
        ..Scene::default()
    }
}

#[test]
fn scene_without_parts_is_borrowed() {
    let plain = Scene::default();
    assert!(matches!(plain.flattened().unwrap(), Cow::Borrowed(_)));
    let unplaced = scene(vec![sphere()], &[]);
    let flat = unplaced.flattened().unwrap();
    assert!(flat.parts.is_empty());
    assert_eq!(flat.objects, unplaced.objects);
}

#[test]
fn flattened_point_is_the_placed_point_of_the_part() {
    let random = &mut Random(5);
    for _ in 0..300 {
        let vertices = [(); 3].map(|()| DVec3::from_array(random.direction()) * 3.0);
        let mesh = Shape::Mesh {
            vertices: vertices.to_vec(),
            triangles: vec![[0, 1, 2]],
        };
        let placements = [(); 3].map(|()| any(random));
        let scene = scene(vec![sphere(), object("face", mesh)], &placements);
        let flat = scene.flattened().unwrap();
        assert_eq!(flat.objects[0], scene.objects[0]);
        assert_eq!(flat.objects.len(), 1 + 2 * placements.len());
        for (number, placement) in placements.iter().enumerate() {
            let [ball, face] = &flat.objects[1 + 2 * number..][..2] else {
                unreachable!()
            };
            assert_eq!(ball.name, format!("copy {number}/ball"));
            assert_eq!(face.name, format!("copy {number}/face"));
            let Shape::Sphere(Sphere { center, radius }) = &ball.shape else {
                panic!("{ball:?}")
            };
            let far = 1e-12 * (100.0 + 10.0 * placement.scale);
            assert!((*center - placement.point(DVec3::X)).length() <= far);
            assert!((*radius / (0.5 * placement.scale) - 1.0).abs() < 1e-12);
            let Shape::Mesh {
                vertices: moved, ..
            } = &face.shape
            else {
                panic!("{face:?}")
            };
            for (moved, &vertex) in moved.iter().zip(&vertices) {
                assert!((*moved - placement.point(vertex)).length() <= far);
            }
        }
        assert_eq!(scene.clone().into_flattened().unwrap(), *flat);
    }
}

#[test]
fn box_stays_one_under_quarter_turns_and_becomes_a_mesh_under_others() {
    let cuboid = Cuboid {
        min: DVec3::ZERO,
        max: DVec3::new(1.0, 2.0, 3.0),
    };
    let turned = |degrees: f64| Placement {
        rotation: DQuat::from_rotation_z(degrees.to_radians()),
        ..Placement::IDENTITY
    };
    let part = vec![object("box", Shape::Box(cuboid))];
    let scene = scene(part, &[turned(90.0), turned(30.0)]);
    let flat = scene.flattened().unwrap();
    let kinds: Vec<_> = flat.objects.iter().map(|it| it.shape.kind()).collect();
    assert_eq!(kinds, ["sphere", "box", "mesh"]);
}

#[test]
fn too_many_primitives_are_rejected_before_they_are_made() {
    let triangles = vec![[0, 1, 2]; 1 << 14];
    let mesh = Shape::Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        triangles,
    };
    let many = scene(vec![object("mesh", mesh)], &[Placement::IDENTITY; 1025]);
    let error = many.flattened().unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.toml:7: the flattened instances come to 16,793,601 primitives; a scene holds 16,777,216"
    );
    assert!(error.remedy.contains("--instances keep"));
}

#[test]
fn too_much_memory_is_rejected_before_it_is_taken() {
    let balls = vec![sphere(); 1 << 10];
    let many = scene(balls, &[Placement::IDENTITY; 1 << 13]);
    let error = many.flattened().unwrap_err();
    assert!(error.cause.contains("GB of memory"), "{error}");
    assert!(many.into_flattened().is_err());
}

#[test]
fn shape_that_leaves_the_range_of_numbers_is_named() {
    let far = Placement {
        translation: DVec3::splat(f64::MAX),
        scale: f64::MAX,
        ..Placement::IDENTITY
    };
    let error = scene(vec![sphere()], &[far]).flattened().unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.toml:7: the object \"ball\" of instance \"copy 0\" leaves the range of numbers when its \
         transforms are applied"
    );
}
