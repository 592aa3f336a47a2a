//! Objects of valid files.

use super::{example, load, material_of, named, rejection, scene};
use crate::scene::{Diffuse, Light, Material, RenderSettings, Scene, Shape};
use crate::shape::{Cone, Cuboid, Sphere};
use glam::DVec3;

#[test]
fn the_documented_example_holds_what_it_says() {
    let imported = load(example()).unwrap();
    assert_eq!(imported.warnings, Vec::<String>::new());
    let scene = imported.scene;
    let names: Vec<_> = scene
        .objects
        .iter()
        .map(|object| object.name.as_str())
        .collect();
    let expected = [
        "floor",
        "left/cylinder 1",
        "left/ball",
        "right/cylinder 1",
        "right/ball",
        "ring/cone 1",
        "ring/frustum 2",
        "ring/disc 3",
        "plane 5",
        "triangle 6",
        "mesh 7",
    ];
    assert_eq!(names, expected);
    assert_eq!(scene.parts.len(), 1);
    let flat = scene.flattened().unwrap();
    let names: Vec<_> = flat.objects.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names[11..], ["front/torus 1", "rear/torus 1"]);
    assert_eq!(material_of(&flat, "rear/torus 1"), "steel");
    assert_eq!(material_of(&scene, "left/cylinder 1"), "steel");
    assert_eq!(material_of(&scene, "left/ball"), "glass");
    assert_eq!(material_of(&scene, "right/cylinder 1"), "default");
    assert_eq!(material_of(&scene, "ring/disc 3"), "steel");
    let camera = scene.camera.unwrap();
    assert_eq!(
        (camera.eye, camera.fov_degrees),
        (DVec3::new(0.0, 4.0, 12.0), 40.0)
    );
    let render = RenderSettings {
        width: 400,
        height: 300,
        samples: 4,
        depth: 6,
        cutoff: 0.002,
        ..RenderSettings::default()
    };
    assert_eq!(scene.render, render);
    assert_eq!(scene.ambient, [0.1; 3]);
    assert_eq!(scene.lights.len(), 2);
    let down = Light::Directional {
        direction: DVec3::new(-1.0, -2.0, -1.0),
        color: [0.3; 3],
    };
    assert_eq!(scene.lights[1], down);
    let Shape::Mesh {
        vertices,
        triangles,
    } = &named(&scene, "mesh 7").shape
    else {
        panic!()
    };
    assert_eq!((vertices.len(), triangles.len()), (4, 2));
}

#[test]
fn an_empty_file_is_the_default_scene() {
    assert_eq!(scene(""), Scene::default());
}

#[test]
fn an_empty_material_is_the_default_one_under_its_name() {
    let scene = scene("[material.plain]");
    assert_eq!(
        scene.materials,
        [Material {
            name: "plain".into(),
            place: scene.materials[0].place.clone(),
            ..Material::default()
        }]
    );
}

#[test]
fn a_material_called_default_serves_objects_without_one() {
    let scene = scene(
        "[material.default]\ndiffuse = 0.25\n[[object]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    assert_eq!(scene.materials.len(), 1);
    assert_eq!(
        scene.materials[scene.objects[0].material].diffuse,
        Diffuse::Plain([0.25; 3])
    );
}

#[test]
fn colors_have_three_spellings() {
    assert_eq!(scene("background = 0.5").background, Some([0.5; 3]));
    assert_eq!(
        scene("background = [0, 0.5, 2]").background,
        Some([0.0, 0.5, 2.0])
    );
    let [red, green, blue] = scene("background = \"#ff8000\"").background.unwrap();
    assert_eq!((red, blue), (1.0, 0.0));
    // The value of the code 128 by IEC 61966-2-1.
    assert!((green - 0.215_860_500_113_899_26).abs() < 1e-15);
}

#[test]
fn objects_know_their_line() {
    let scene = scene("\n\n[[object]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n");
    assert_eq!(scene.objects[0].place.line, 3);
    assert!(scene.objects[0].place.file.ends_with("scene.toml"));
}

#[test]
fn every_shape_is_read() {
    let scene = scene(
        r#"object = [
            { kind = "sphere", center = [1, 2, 3], radius = 4 },
            { kind = "box", min = [0, 0, 0], max = [1, 0, 1] },
            { kind = "disc", center = [0, 0, 0], normal = [0, 9, 0], radius = 1 },
            { kind = "cylinder", base = [0, 0, 0], top = [0, 1, 0], radius = 0.5 },
            { kind = "cone", base = [0, 0, 0], apex = [0, 1, 0], radius = 0.5 },
            { kind = "frustum", base = [0, 0, 0], top = [0, 1, 0], base_radius = 0.5, top_radius = 0.25 },
            { kind = "triangle", vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] },
        ]"#,
    );
    let radii = |index: usize| match scene.objects[index].shape {
        Shape::Cone(Cone {
            base_radius,
            apex_radius,
            ..
        }) => (base_radius, apex_radius),
        _ => panic!("no cone"),
    };
    assert_eq!(
        [radii(3), radii(4), radii(5)],
        [(0.5, 0.5), (0.5, 0.0), (0.5, 0.25)]
    );
    let sphere = Shape::Sphere(Sphere {
        center: DVec3::new(1.0, 2.0, 3.0),
        radius: 4.0,
    });
    assert_eq!(scene.objects[0].shape, sphere);
    let flat = Shape::Box(Cuboid {
        min: DVec3::ZERO,
        max: DVec3::new(1.0, 0.0, 1.0),
    });
    assert_eq!(scene.objects[1].shape, flat);
    assert!(
        matches!(&scene.objects[6].shape, Shape::Mesh { triangles, .. } if *triangles == [[0, 1, 2]])
    );
}

/// The area of a mesh in the plane z = 0; triangles that overlap or turn would change it.
fn area(shape: &Shape) -> (f64, bool) {
    let Shape::Mesh {
        vertices,
        triangles,
    } = shape
    else {
        panic!()
    };
    let areas = triangles.iter().map(|&[a, b, c]| {
        let [a, b, c] = [a, b, c].map(|index| vertices[index as usize]);
        (b - a).cross(c - a).z / 2.0
    });
    let areas: Vec<f64> = areas.collect();
    (areas.iter().sum(), areas.iter().all(|&area| area > 0.0))
}

#[test]
fn concave_faces_are_cut_into_triangles_that_turn_alike() {
    let faces = [
        ("[[0,0,0],[4,0,0],[4,4,0],[2,1,0],[0,4,0]]", 10.0),
        // A spiral, a comb, a polygon with corners on its sides, and a convex one.
        (
            "[[0,0,0],[5,0,0],[5,5,0],[1,5,0],[1,2,0],[3,2,0],[3,3,0],[2,3,0],[2,4,0],[4,4,0],[4,1,0],[0,1,0]]",
            15.0,
        ),
        (
            "[[0,0,0],[5,0,0],[5,3,0],[4,3,0],[4,1,0],[3,1,0],[3,3,0],[2,3,0],[2,1,0],[1,1,0],[1,3,0],[0,3,0]]",
            11.0,
        ),
        (
            "[[0,0,0],[1,0,0],[2,0,0],[2,1,0],[2,2,0],[1,2,0],[0,2,0],[0,1,0]]",
            4.0,
        ),
        ("[[1,0,0],[2,0,0],[3,1,0],[2,2,0],[1,2,0],[0,1,0]]", 4.0),
    ];
    for (vertices, expected) in faces {
        let count = vertices.matches("],").count() + 1;
        let around: Vec<usize> = (0..count).collect();
        let text =
            format!("[[object]]\nkind = \"mesh\"\nvertices = {vertices}\nfaces = [{around:?}]\n");
        let scene = scene(&text);
        let (area, alike) = area(&scene.objects[0].shape);
        assert!(
            (area - expected).abs() < 1e-12 && alike,
            "{area} of {expected}: {:?}",
            scene.objects[0].shape
        );
        let Shape::Mesh { triangles, .. } = &scene.objects[0].shape else {
            panic!()
        };
        assert_eq!(triangles.len(), count - 2);
    }
}

#[test]
fn an_unused_group_is_worth_a_warning() {
    let imported =
        load("[[group.spare.object]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n")
            .unwrap();
    assert_eq!(imported.scene.objects, []);
    assert_eq!(imported.warnings.len(), 1);
    assert!(imported.warnings[0].ends_with("scene.toml:1: the group \"spare\" is placed nowhere"));
}

#[test]
fn instances_of_instances_are_all_placed() {
    let scene = scene(
        r#"
[group.dot]
object = [{ kind = "sphere", center = [0, 0, 0], radius = 0.5 }]
[group.pair]
object = [
  { kind = "instance", group = "dot", translate = [-1, 0, 0], name = "a" },
  { kind = "instance", group = "dot", translate = [1, 0, 0], name = "b" },
]
[[object]]
kind = "instance"
group = "pair"
[[object]]
kind = "instance"
group = "pair"
scale = 2
translate = [0, 10, 0]
name = "big"
"#,
    );
    assert_eq!(scene.objects.len(), 4);
    let far = Shape::Sphere(Sphere {
        center: DVec3::new(2.0, 10.0, 0.0),
        radius: 1.0,
    });
    assert_eq!(named(&scene, "big/b/sphere 1").shape, far);
    let near = Shape::Sphere(Sphere {
        center: DVec3::new(-1.0, 0.0, 0.0),
        radius: 0.5,
    });
    assert_eq!(named(&scene, "instance 1/a/sphere 1").shape, near);
}

#[test]
fn the_innermost_material_counts() {
    let scene = scene(
        r#"
[material.inner]
[material.outer]
[group.two]
object = [
  { kind = "sphere", center = [0, 0, 0], radius = 1, material = "inner", name = "own" },
  { kind = "sphere", center = [0, 0, 0], radius = 1, name = "none" },
]
[[object]]
name = "i"
kind = "instance"
group = "two"
material = "outer"
"#,
    );
    assert_eq!(material_of(&scene, "i/own"), "inner");
    assert_eq!(material_of(&scene, "i/none"), "outer");
}

#[test]
fn meshes_are_smooth_below_an_angle() {
    let roof = |smooth: &str| {
        format!(
            "[[object]]\nkind = 'mesh'\n{smooth}\nvertices = [[-1, 0, 0], [0, -1, 1], [0, 1, 1], [1, 0, 0]]\n\
             faces = [[0, 1, 2], [1, 3, 2]]\nscale = [1, 1, -1]\n"
        )
    };
    for (smooth, is_flat) in [("", true), ("smooth = 40", true), ("smooth = 91", false)] {
        let normals = &scene(&roof(smooth)).objects[0].normals;
        assert_eq!(normals.is_flat(), is_flat, "{smooth}");
        let ridge = normals
            .vectors
            .iter()
            .filter(|it| it.z.abs() > 0.99)
            .count();
        assert_eq!(ridge, if is_flat { 0 } else { 2 });
    }
    let error = rejection(&roof("smooth = 200")).to_string();
    assert!(
        error.contains("`smooth` is 200; it must be from 0 to 180 degrees"),
        "{error}"
    );
}
