//! Shapes after transforms.

use super::{assert_near, named, rejection, scene, volume};
use crate::scene::{Scene, Shape};
use crate::shape::{Cone, Cuboid, Disc, Sphere};
use glam::DVec3;

/// A scene with one object, in the groups whose transforms are given, the outermost first.
fn nested(object: &str, transforms: &[&str]) -> String {
    let mut text = format!("{{ name = \"it\", {object} }}");
    for transform in transforms.iter().rev() {
        text = format!("{{ name = \"g\", kind = \"group\", {transform}, object = [{text}] }}");
    }
    format!("object = [{text}]\n")
}

fn only(object: &str, transforms: &[&str]) -> Shape {
    let scene: Scene = scene(&nested(object, transforms));
    assert_eq!(scene.objects.len(), 1);
    scene.objects[0].shape.clone()
}

const SPHERE: &str = r#"kind = "sphere", center = [1, 0, 0], radius = 1"#;
const BOX: &str = r#"kind = "box", min = [0, 0, 0], max = [1, 2, 3]"#;
const CONE: &str = r#"kind = "cone", base = [0, 0, 0], apex = [0, 1, 0], radius = 0.5"#;
const DISC: &str = r#"kind = "disc", center = [1, 0, 0], normal = [5, 0, 0], radius = 1"#;
const TETRAHEDRON: &str = r#"kind = "mesh",
  vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
  faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]"#;

#[test]
fn scale_comes_before_rotation_before_translation() {
    let shape = only(
        &format!("{SPHERE}, translate = [0, 0, 5], rotate = [0, 90, 0], scale = 2"),
        &[],
    );
    // (1, 0, 0) scales to (2, 0, 0), turns to (0, 0, -2) and moves to (0, 0, 3).
    assert_eq!(
        shape,
        Shape::Sphere(Sphere {
            center: DVec3::new(0.0, 0.0, 3.0),
            radius: 2.0
        })
    );
}

#[test]
fn angles_apply_about_x_then_y_then_z() {
    let shape = only(
        r#"kind = "sphere", center = [0, 1, 0], radius = 1, rotate = [90, 90, 90]"#,
        &[],
    );
    // y goes to z about x, z to x about y, x to y about z.
    assert_eq!(
        shape,
        Shape::Sphere(Sphere {
            center: DVec3::Y,
            radius: 1.0
        })
    );
}

#[test]
fn an_axis_of_any_length_turns_counter_clockwise() {
    for axis in ["[0, 0, 1]", "[0, 0, 1e-200]", "[0, 0, 1e200]"] {
        let shape = only(
            &format!("{SPHERE}, rotate = {{ axis = {axis}, degrees = 30 }}"),
            &[],
        );
        let Shape::Sphere(Sphere { center, radius }) = shape else {
            panic!()
        };
        assert_near(center, DVec3::new(30_f64.to_radians().cos(), 0.5, 0.0));
        assert!((radius - 1.0).abs() < 1e-15);
    }
    let diagonal = only(
        &format!("{SPHERE}, rotate = {{ axis = [1, 1, 1], degrees = 120 }}"),
        &[],
    );
    let Shape::Sphere(Sphere { center, .. }) = diagonal else {
        panic!()
    };
    assert_near(center, DVec3::Y);
}

#[test]
fn groups_apply_from_the_inside_out() {
    let shape = only(
        SPHERE,
        &["translate = [10, 0, 0]", "scale = 3", "rotate = [0, 0, 90]"],
    );
    assert_eq!(
        shape,
        Shape::Sphere(Sphere {
            center: DVec3::new(10.0, 3.0, 0.0),
            radius: 3.0
        })
    );
}

#[test]
fn a_box_stays_a_box_under_quarter_turns_mirrors_and_uneven_scales() {
    let turned = only(BOX, &["rotate = [90, 0, 0]"]);
    assert_eq!(
        turned,
        Shape::Box(Cuboid {
            min: DVec3::new(0.0, -3.0, 0.0),
            max: DVec3::new(1.0, 0.0, 2.0)
        })
    );
    let mirrored = only(BOX, &["scale = [-1, 2, 1]"]);
    assert_eq!(
        mirrored,
        Shape::Box(Cuboid {
            min: DVec3::new(-1.0, 0.0, 0.0),
            max: DVec3::new(0.0, 4.0, 3.0)
        })
    );
    // Two halves of a quarter turn leave rounding errors behind.
    let halves = only(BOX, &["rotate = [0, 45, 0]", "rotate = [0, 45, 0]"]);
    let Shape::Box(Cuboid { min, max }) = halves else {
        panic!("{halves:?}")
    };
    assert_near(min, DVec3::new(0.0, 0.0, -1.0));
    assert_near(max, DVec3::new(3.0, 2.0, 0.0));
}

#[test]
fn a_turned_box_becomes_a_mesh_with_its_fronts_outside() {
    for transform in [
        "rotate = [0, 30, 0]",
        "rotate = [10, 20, 30], scale = [-1, 1, 1]",
    ] {
        let shape = only(BOX, &[transform]);
        let Shape::Mesh {
            vertices,
            triangles,
        } = &shape
        else {
            panic!("{shape:?}")
        };
        assert_eq!((vertices.len(), triangles.len()), (8, 12));
        assert!(
            (volume(&shape) - 36.0).abs() < 1e-12,
            "{transform}: {}",
            volume(&shape)
        );
    }
}

#[test]
fn a_flat_box_that_is_turned_has_two_faces() {
    for max in ["[1, 2, 0]", "[1, 0, 2]", "[0, 1, 2]"] {
        let object = format!("kind = \"box\", min = [0, 0, 0], max = {max}, rotate = [20, 30, 40]");
        let Shape::Mesh {
            vertices,
            triangles,
        } = only(&object, &[])
        else {
            panic!()
        };
        assert_eq!(triangles.len(), 4);
        let area = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|index| vertices[index as usize]);
            (b - a).cross(c - a) / 2.0
        };
        assert!(
            triangles
                .iter()
                .all(|triangle| (area(triangle).length() - 1.0).abs() < 1e-12)
        );
        assert_near(triangles.iter().map(area).sum(), DVec3::ZERO);
    }
}

#[test]
fn a_mesh_keeps_its_fronts_outside_in_every_mirror() {
    assert_eq!(volume(&only(TETRAHEDRON, &["translate = [0, 0, 0]"])), 1.0);
    assert_eq!(volume(&only(TETRAHEDRON, &["scale = [-1, 1, 1]"])), 1.0);
    assert_eq!(volume(&only(TETRAHEDRON, &["scale = -2"])), 8.0);
    assert_eq!(
        volume(&only(
            TETRAHEDRON,
            &["scale = [1, -1, 1]", "scale = [1, 1, -1]"]
        )),
        1.0
    );
    let skewed = only(
        TETRAHEDRON,
        &[
            "scale = [3, 1, -1]",
            "rotate = [0, 40, 0]",
            "scale = [1, 2, 1]",
        ],
    );
    assert!((volume(&skewed) - 6.0).abs() < 1e-12);
}

#[test]
fn discs_and_cones_follow_a_mirror() {
    let Shape::Disc(Disc { center, normal, .. }) = only(DISC, &["scale = [-1, 1, 1]"]) else {
        panic!()
    };
    assert_eq!((center, normal), (DVec3::NEG_X, DVec3::NEG_X));
    let Shape::Disc(Disc { normal, radius, .. }) = only(DISC, &["rotate = [0, 0, 90], scale = 3"])
    else {
        panic!()
    };
    assert_eq!((normal, radius), (DVec3::Y, 3.0));
    let cone = only(CONE, &["scale = -2"]);
    let expected = Shape::Cone(Cone {
        base: DVec3::ZERO,
        base_radius: 1.0,
        apex: DVec3::new(0.0, -2.0, 0.0),
        apex_radius: 0.0,
    });
    assert_eq!(cone, expected);
}

/// The normal stays at right angles to the plane whatever the scales are.
#[test]
fn planes_take_every_transform() {
    const PLANE: &str = r#"kind = "plane", point = [1, 0, 0], normal = [5, 5, 0]"#;
    let moved = |transforms: &[&str]| {
        let Shape::Plane(plane) = only(PLANE, transforms) else {
            panic!()
        };
        plane
    };
    let wide = moved(&["scale = [2, 1, 1]"]);
    assert_eq!(wide.point, DVec3::new(2.0, 0.0, 0.0));
    assert!(wide.normal.angle_between(DVec3::new(1.0, 2.0, 0.0)) < 1e-12);
    let turned = moved(&["rotate = [0, 0, 90]", "translate = [0, 0, 4]"]);
    assert!(turned.point.distance(DVec3::new(0.0, 1.0, 4.0)) < 1e-12);
    assert!(turned.normal.angle_between(DVec3::new(-1.0, 1.0, 0.0)) < 1e-12);
    let mirrored = moved(&["scale = [-1, 1, 1]"]);
    assert!(mirrored.normal.angle_between(DVec3::new(-1.0, 1.0, 0.0)) < 1e-12);
    let flattened = rejection(&nested(PLANE, &["scale = [1, 0, 1]"]));
    assert!(flattened.cause.contains("flattens"), "{flattened}");
}

#[test]
fn uneven_scales_that_cancel_out_are_even() {
    let shape = only(SPHERE, &["scale = [4, 2, 1]", "scale = [0.5, 1, 2]"]);
    assert_eq!(
        shape,
        Shape::Sphere(Sphere {
            center: DVec3::new(2.0, 0.0, 0.0),
            radius: 2.0
        })
    );
}

#[test]
fn round_shapes_reject_uneven_scales() {
    for object in [SPHERE, DISC, CONE] {
        for transforms in [
            &["scale = [1, 2, 1]"][..],
            &["scale = [1, 1, 1.0001]", "rotate = [0, 45, 0]"],
        ] {
            let error = rejection(&nested(object, transforms));
            assert!(error.cause.contains("/it\" is scaled unevenly"), "{error}");
            assert!(error.remedy.contains("the same number on every axis"));
            assert_eq!(error.line, Some(1));
        }
    }
}

#[test]
fn shapes_that_round_to_nothing_or_infinity_are_rejected() {
    let tiny = ["scale = 1e-200", "scale = 1e-200"];
    for object in [SPHERE, BOX, DISC, CONE, TETRAHEDRON] {
        let error = rejection(&nested(object, &tiny));
        assert!(
            error.cause.contains("range of numbers") || error.cause.contains("flattened"),
            "{error}"
        );
        let huge = rejection(&nested(object, &["scale = 1e200", "scale = 1e200"]));
        assert!(huge.cause.contains("range of numbers"), "{huge}");
    }
    let lost = rejection(&nested(CONE, &["translate = [0, 1e30, 0]"]));
    assert!(lost.cause.contains("range of numbers"), "{lost}");
    let flat = rejection(&nested(
        TETRAHEDRON,
        &["scale = [1, 1e-300, 1]", "scale = [1, 1e-300, 1]"],
    ));
    assert!(flat.cause.contains("flattened"), "{flat}");
}

#[test]
fn a_shape_without_a_transform_keeps_its_numbers() {
    let text =
        r#"object = [{ kind = "sphere", center = [0.1, -7.3, 1e10], radius = 0.3, name = "s" }]"#;
    let expected = Shape::Sphere(Sphere {
        center: DVec3::new(0.1, -7.3, 1e10),
        radius: 0.3,
    });
    assert_eq!(named(&scene(text), "s").shape, expected);
}
