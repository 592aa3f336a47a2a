//! The camera and the background of a scene that states none.

use crate::compile::geometry::extent::Shapes;
use crate::scene::{Camera, Color, Scene, Shape};
use crate::shape::unit;
use glam::{DQuat, DVec3};

/// The background of a scene that states neither a camera nor a background. On light gray, white objects are visible by
/// their shades, and black ones by their outline.
pub const BACKGROUND: Color = [0.9, 0.92, 0.95];

/// The part of the picture's width or height that the scene takes.
const SHARE: f64 = 0.8;

/// The full vertical field of view.
const FOV_DEGREES: f64 = 40.0;

/// The least distance of the eye from the scene, as a part of the distance at which the scene would fit if it were
/// flat. Only spikes towards the eye, narrower than the view, are this near.
const NEAREST: f64 = 1.0 / 16.0;

/// Returns a camera that looks at a scene from its front. The scene takes 80 % of the picture's width or height,
/// and no more of the other; the picture's shape is that of `scene.render`.
///
/// The front is that of the scene's [up](Scene::up): the camera looks along -z where y is up, and along +y where z is
/// up. A flat scene that would be seen from its edge is seen from above or from its right. Unbounded shapes do not
/// count if there are bounded ones. If the eye lay in a plane or near one, the view is raised or turned by 15 degrees
/// or more, so that the eye lies in front of the plane.
///
/// ```
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_host::compile::framing;
///
/// let camera = framing(&imported.scene, Some(30.0));
/// assert_eq!(camera.target, glam::DVec3::ZERO);
/// assert!(camera.eye.x == 0.0 && camera.eye.y == 0.0 && camera.eye.z > 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn framing(scene: &Scene, fov_degrees: Option<f64>) -> Camera {
    framing_of(&Shapes::of(scene), fov_degrees)
}

/// [`framing`] of a scene whose shapes are prepared.
pub fn framing_of(shapes: &Shapes<'_>, fov_degrees: Option<f64>) -> Camera {
    let scene = shapes.scene();
    let fov_degrees = fov_degrees.unwrap_or(FOV_DEGREES);
    let support = |direction| support(shapes, direction);
    let highest = DVec3::from_array(DVec3::AXES.map(support));
    let lowest = -DVec3::from_array(DVec3::AXES.map(|axis| support(-axis)));
    let middle = lowest.midpoint(highest);
    let half = highest - middle;
    let up = DVec3::AXES[scene.up.axis()];
    let right = DVec3::X;
    let forward = up.cross(right);
    let extent_along = |axis: DVec3| half.dot(axis.abs());
    let is_flat = |axis| extent_along(axis) == 0.0 && extent_along(forward) > 0.0;
    let (forward, up) = match (is_flat(up), is_flat(right)) {
        (true, _) => (-up, forward),
        (false, true) => (-right, up),
        _ if !is_seen_from_edge(shapes, forward) => (forward, up),
        _ if is_seen_from_edge(shapes, up) => (-right, up),
        _ => (-up, forward),
    };
    let fitted = |view| fitted(shapes, [lowest, highest], view, fov_degrees);
    off_planes(scene, [forward, up], fitted)
}

/// The camera of a direction of view and one up, at a right angle to it, from which a scene within a box takes its
/// share of the picture.
fn fitted(
    shapes: &Shapes<'_>,
    [lowest, highest]: [DVec3; 2],
    [forward, up]: [DVec3; 2],
    fov_degrees: f64,
) -> Camera {
    let scene = shapes.scene();
    let support = |direction| support(shapes, direction);
    let middle = lowest.midpoint(highest);
    let half = highest - middle;
    let extent_along = |axis: DVec3| half.dot(axis.abs());
    let right = forward.cross(up);
    let [across, along, deep] = [right, up, forward].map(extent_along);

    let aspect = f64::from(scene.render.width) / f64::from(scene.render.height);
    let slope = SHARE * libm::tan(fov_degrees.to_radians() / 2.0);
    let from_middle = |direction: DVec3| support(direction) - middle.dot(direction);
    // The eye lies where two planes of this slope meet that touch the scene from opposite sides. The result is its
    // distance from the middle of the scene, and its offset aside.
    let touching = |axis: DVec3, slope: f64| {
        let [one, other] = [axis, -axis].map(|side| from_middle(side - slope * forward));
        ((one + other) / (2.0 * slope), (one - other) / 2.0)
    };
    let (for_width, aside) = touching(right, slope * aspect);
    let (for_height, above) = touching(up, slope);
    let least = match (across / aspect).max(along) / slope {
        // A point, or a line away from the eye.
        0.0 => middle.abs().max_element().max(1.0),
        flat => NEAREST * flat,
    };
    let distance = for_width.max(for_height).max(deep + least);
    let target = middle + aside * right + above * up;
    Camera {
        eye: target - distance * forward,
        target,
        up,
        fov_degrees,
    }
}

/// The largest `point.dot(direction)` of a scene; 0 without points, and where it has no end.
fn support(shapes: &Shapes<'_>, direction: DVec3) -> f64 {
    let largest = shapes.support(direction);
    if largest.is_finite() { largest } else { 0.0 }
}

/// The least distance of the eye from planes, as a part of its distance from what it looks at.
const OFF_PLANES: f64 = 1.0 / 32.0;

/// Degrees by which a view is raised and turned, in the order in which they are tried.
const TURNS: [[f64; 2]; 11] = [
    [15.0, 0.0],
    [-15.0, 0.0],
    [0.0, 15.0],
    [0.0, -15.0],
    [15.0, 15.0],
    [15.0, -15.0],
    [-15.0, 15.0],
    [-15.0, -15.0],
    [30.0, 30.0],
    [30.0, -30.0],
    [-30.0, 30.0],
];

/// The camera of a view. If its eye lies in a plane, or near one, the view is raised or turned so far that it lies
/// in front of that plane: each ray from within a plane hits it at once.
fn off_planes(
    scene: &Scene,
    [forward, up]: [DVec3; 2],
    fitted: impl Fn([DVec3; 2]) -> Camera,
) -> Camera {
    let planes = scene
        .objects
        .iter()
        .filter_map(|object| match &object.shape {
            Shape::Plane(plane) => Some((plane.point, unit(plane.normal))),
            _ => None,
        });
    let planes: Vec<(DVec3, DVec3)> = planes.collect();
    let above = |camera: &Camera, (point, normal): (DVec3, DVec3)| {
        (camera.eye - point).dot(normal) / camera.eye.distance(camera.target)
    };
    let first = fitted([forward, up]);
    // The planes to be left, on the side of their normal, come first.
    let (near, far): (Vec<_>, Vec<_>) = planes
        .into_iter()
        .partition(|&plane| above(&first, plane).abs() < OFF_PLANES);
    if near.is_empty() {
        return first;
    }
    let clearance = |camera: &Camera| {
        let near = near.iter().map(|&plane| above(camera, plane));
        let far = far.iter().map(|&plane| above(camera, plane).abs());
        near.chain(far).fold(f64::INFINITY, f64::min)
    };
    let mut best = (clearance(&first), first);
    for [raised, turned] in TURNS {
        let (raise, turn) = (
            DQuat::from_axis_angle(forward.cross(up), -f64::to_radians(raised)),
            DQuat::from_axis_angle(up, f64::to_radians(turned)),
        );
        let view = [forward, up].map(|it| turn * (raise * it));
        let camera = Camera { up, ..fitted(view) };
        let clearance = clearance(&camera);
        if clearance >= OFF_PLANES {
            return camera;
        }
        if clearance > best.0 {
            best = (clearance, camera);
        }
    }
    best.1
}

/// The least part of the area of flat faces that a view must show.
const LEAST_SHOWN: f64 = 1e-3;

/// Returns whether a scene has flat faces and nothing else, and a view shows next to nothing of them.
fn is_seen_from_edge(shapes: &Shapes<'_>, forward: DVec3) -> bool {
    if !shapes.are_flat() {
        return false;
    }
    let (mut area, mut shown) = (0.0, 0.0);
    shapes.each_face(|face| {
        area += face.length();
        shown += face.dot(forward).abs();
    });
    shown < LEAST_SHOWN * area
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Material, Object, SourceSpan};
    use crate::shape::{Cuboid, Plane};
    use gridel_core::Up;

    fn scene(min: [f64; 3], max: [f64; 3], up: Up) -> Scene {
        let [min, max] = [min, max].map(DVec3::from_array);
        let object = Object {
            name: String::from("box"),
            material: 0,
            shape: Shape::Box(Cuboid { min, max }),
            place: SourceSpan::default(),
            normals: Default::default(),
            attributes: Default::default(),
        };
        Scene {
            materials: vec![Material::default()],
            objects: vec![object],
            up,
            ..Scene::default()
        }
    }

    /// Returns the part of the picture that the projected corners of the scene's box take, across and along. Also
    /// returns how far their middle is from the picture's.
    fn share(scene: &Scene, camera: &Camera) -> ([f64; 2], [f64; 2]) {
        let (lowest, highest) = Shapes::of(scene).extent();
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let up = right.cross(forward);
        let tangent = libm::tan(camera.fov_degrees.to_radians() / 2.0);
        let aspect = f64::from(scene.render.width) / f64::from(scene.render.height);
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for corner in 0..8 {
            let sides = [corner & 1, corner >> 1 & 1, corner >> 2];
            let corner: [f64; 3] = std::array::from_fn(|axis| [lowest, highest][sides[axis]][axis]);
            let seen = DVec3::from_array(corner) - camera.eye;
            let depth = seen.dot(forward);
            assert!(depth > 0.0);
            let place = [
                seen.dot(right) / (depth * tangent * aspect),
                seen.dot(up) / (depth * tangent),
            ];
            for (bounds, place) in bounds.iter_mut().zip(place) {
                *bounds = [bounds[0].min(place), bounds[1].max(place)];
            }
        }
        (
            bounds.map(|[low, high]| (high - low) / 2.0),
            bounds.map(|[low, high]| (high + low) / 2.0),
        )
    }

    fn looks(camera: &Camera, forward: DVec3) -> bool {
        let view = (camera.target - camera.eye).normalize();
        view.distance(forward) < 1e-12
    }

    #[test]
    fn the_box_takes_80_percent_of_the_picture_and_is_in_its_middle() {
        let boxes = [
            ([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]),
            ([3.0, 0.0, 0.0], [4.0, 9.0, 1.0]),
            ([-50.0, 7.0, 0.0], [50.0, 8.0, 1e3]),
            ([1e6, 1e6, 1e6], [1e6 + 1.0, 1e6 + 2.0, 1e6]),
            ([0.0, 0.0, -5.0], [1e-3, 1e-3, 5.0]),
        ];
        for (min, max) in boxes {
            for up in [Up::Y, Up::Z] {
                for (size, fov) in [
                    ([320, 240], None),
                    ([64, 640], Some(1.0)),
                    ([640, 10], Some(150.0)),
                ] {
                    let mut scene = scene(min, max, up);
                    [scene.render.width, scene.render.height] = size;
                    let camera = framing(&scene, fov);
                    assert_eq!(camera.fov_degrees, fov.unwrap_or(40.0));
                    let (sides, middle) = share(&scene, &camera);
                    let largest = sides[0].max(sides[1]);
                    assert!(
                        (largest - 0.8).abs() < 1e-6,
                        "{min:?} {up:?} {size:?}: {sides:?}"
                    );
                    assert!(middle.iter().all(|it| it.abs() < 1e-6), "{middle:?}");
                }
            }
        }
    }

    #[test]
    fn eye_stays_before_spikes_that_are_narrower_than_the_view() {
        let mut needle = scene([0.0; 3], [1.0; 3], Up::Y);
        let cone = crate::shape::Cone {
            base: DVec3::ZERO,
            base_radius: 1.0,
            apex: DVec3::new(0.0, 0.0, 100.0),
            apex_radius: 0.0,
        };
        needle.objects[0].shape = Shape::Cone(cone);
        let camera = framing(&needle, None);
        let flat = 1.0 / (0.8 * libm::tan(20_f64.to_radians()));
        let expected = 100.0 + flat / 16.0;
        assert!((camera.eye.z - expected).abs() < 1e-9, "{}", camera.eye);
        assert!(looks(&camera, DVec3::NEG_Z));
    }

    #[test]
    fn vertices_of_no_triangle_are_not_framed() {
        let mut mesh = scene([0.0; 3], [1.0; 3], Up::Y);
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let mut frame = |vertices: &[DVec3]| {
            mesh.objects[0].shape = Shape::Mesh {
                vertices: vertices.to_vec(),
                triangles: vec![[0, 1, 2]],
            };
            framing(&mesh, None)
        };
        let expected = frame(&triangle);
        let with_another = [triangle.as_slice(), &[DVec3::splat(100.0)]].concat();
        assert_eq!(frame(&with_another), expected);
    }

    #[test]
    fn y_up_is_seen_along_minus_z_and_z_up_along_y() {
        for (up, forward) in [(Up::Y, DVec3::NEG_Z), (Up::Z, DVec3::Y)] {
            let camera = framing(&scene([0.0; 3], [1.0, 2.0, 3.0], up), None);
            assert!(looks(&camera, forward));
            assert_eq!(camera.up, DVec3::AXES[up.axis()]);
            assert_eq!(camera.target, DVec3::new(0.5, 1.0, 1.5));
        }
    }

    #[test]
    fn flat_scenes_are_not_seen_from_their_edge() {
        let floor = scene([0.0, 1.0, 0.0], [4.0, 1.0, 4.0], Up::Y);
        let camera = framing(&floor, None);
        assert!(looks(&camera, DVec3::NEG_Y));
        assert_eq!(camera.up, DVec3::NEG_Z);
        assert!((share(&floor, &camera).0[1] - 0.8).abs() < 1e-9);
        let floor = scene([0.0, 0.0, 1.0], [4.0, 4.0, 1.0], Up::Z);
        let camera = framing(&floor, None);
        assert!(looks(&camera, DVec3::NEG_Z));
        assert_eq!(camera.up, DVec3::Y);
        // Neither are those that no axis runs along.
        for normal in [[1.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 1.0, 1e-9]] {
            let normal = DVec3::from_array(normal);
            let (across, along) = normal.normalize().any_orthonormal_pair();
            let mut tilted = scene([0.0; 3], [1.0; 3], Up::Y);
            tilted.objects[0].shape = Shape::Mesh {
                vertices: vec![across, along, -across, -along],
                triangles: vec![[0, 1, 2], [0, 2, 3]],
            };
            let camera = framing(&tilted, None);
            let view = (camera.target - camera.eye).normalize();
            assert!(view.dot(normal.normalize()).abs() > 0.4, "{view}");
        }
        for (up, size) in [(Up::Y, [0.0, 1.0, 4.0]), (Up::Z, [0.0, 4.0, 1.0])] {
            let wall = scene([0.0; 3], size, up);
            let camera = framing(&wall, None);
            assert!(looks(&camera, DVec3::NEG_X));
            assert_eq!(camera.up, DVec3::AXES[up.axis()]);
            assert!((share(&wall, &camera).0[0] - 0.8).abs() < 1e-9);
        }
    }

    #[test]
    fn eye_lies_in_front_of_planes_that_it_would_lie_in() {
        let above = |camera: &Camera, normal: DVec3| {
            camera.eye.dot(normal) / camera.eye.distance(camera.target)
        };
        for up in [Up::Y, Up::Z] {
            let alone = scene([-1.0; 3], [1.0; 3], up);
            let first = framing(&alone, None);
            for axis in DVec3::AXES.into_iter().chain([DVec3::new(1.0, 1.0, 0.0)]) {
                for normal in [axis, -axis].map(DVec3::normalize) {
                    let mut cut = alone.clone();
                    cut.objects.push(cut.objects[0].clone());
                    let point = DVec3::ZERO;
                    cut.objects[1].shape = Shape::Plane(Plane { point, normal });
                    let camera = framing(&cut, None);
                    if above(&first, normal).abs() > 0.1 {
                        assert_eq!(camera, first);
                        continue;
                    }
                    assert!(above(&camera, normal) >= OFF_PLANES, "{up:?} {normal}");
                    let sides = share(&alone, &camera).0;
                    assert!(sides[0].max(sides[1]) < 0.81, "{sides:?}");
                }
            }
        }
    }

    #[test]
    fn lines_points_and_nothing_are_seen_from_somewhere() {
        for (min, max) in [
            ([0.0; 3], [0.0; 3]),
            ([5.0; 3], [5.0; 3]),
            ([0.0; 3], [0.0, 0.0, 9.0]),
            ([0.0; 3], [0.0, 9.0, 0.0]),
            ([0.0; 3], [9.0, 0.0, 0.0]),
        ] {
            for up in [Up::Y, Up::Z] {
                let camera = framing(&scene(min, max, up), None);
                let view = camera.target - camera.eye;
                assert!(view.length() > 0.0 && view.cross(camera.up).length() > 0.0);
                assert!(camera.eye.is_finite());
            }
        }
        let camera = framing(&Scene::default(), None);
        assert!(camera.eye.is_finite() && camera.eye != camera.target);
    }
}
