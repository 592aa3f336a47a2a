//! The Standard Procedural Databases: how many of 513 by 513 rays through pixel corners hit.

use glam::DVec3;
use gridel_core::{Format, Structure};
use gridel_host::blob::Blob;
use gridel_host::scene::Scene;
use gridel_host::trace::{Query, SceneHit, SceneRay, trace};
use gridel_tests::scenes;

/// Rays through the corners of 512 by 512 pixels: the file's angle is the full vertical field of
/// view over 512 steps.
fn corner_rays(scene: &Scene) -> Vec<SceneRay> {
    let camera = scene.camera.expect("a view");
    let forward = (camera.target - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let half = (0.5 * camera.fov_degrees).to_radians().tan();
    let steps = |step: u16| f64::from(step) / 256.0 - 1.0;
    let corners = (0..=512).flat_map(|j| (0..=512).map(move |i| (i, j)));
    corners
        .map(|(i, j)| SceneRay {
            origin: camera.eye,
            tmin: 0.0,
            direction: forward + half * (steps(i) * right - steps(j) * up),
            tmax: f64::INFINITY,
        })
        .collect()
}

/// Rays that hit, in one format.
fn hits(blob: &Blob, rays: &[SceneRay], format: Format) -> usize {
    let query = Query {
        format,
        structure: Structure::Flagged,
        any: false,
    };
    let mut hits = vec![SceneHit::MISS; rays.len()];
    let scene = blob.scene().expect("a scene");
    trace(&scene, rays, query, &mut hits).expect("a structure");
    assert!(
        hits.iter()
            .all(|hit| !hit.t.is_nan() && hit.normal.iter().all(|x| x.is_finite()))
    );
    hits.iter().filter(|hit| **hit != SceneHit::MISS).count()
}

#[test]
fn as_many_rays_hit_as_other_programs_find() {
    let expected = [
        ("balls", 263_169),
        ("gears", 245_332),
        ("teapot", 161_546),
        ("tetra", 49_950),
        ("mount", 173_686),
    ];
    let mut wrong = Vec::new();
    for (name, expected) in expected {
        let Some(path) = scenes::real(&format!("spd/{name}.nff")) else {
            continue;
        };
        let scene = scenes::read(&path);
        let rays = corner_rays(&scene);
        assert_eq!(rays.len(), 263_169);
        let blob = scenes::blob(&scene, 24);
        for (format, tolerance) in [(Format::Fixed, 20), (Format::F32, 2), (Format::F64, 2)] {
            let found = hits(&blob, &rays, format);
            eprintln!(
                "{name:7} {:5}: {found} hits, {expected} expected",
                format.name()
            );
            if usize::abs_diff(found, expected) > tolerance {
                wrong.push((name, format, found));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// The middle ray looks along the view, and the outermost ones are half the angle away.
#[test]
fn corner_rays_span_the_angle() {
    let mut scene = scenes::soup(1, 1, 1.0);
    scene.camera = Some(gridel_host::scene::Camera {
        eye: DVec3::new(2.0, 1.0, 3.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        fov_degrees: 45.0,
    });
    let rays = corner_rays(&scene);
    let middle = rays[256 * 513 + 256].direction;
    let top = rays[256].direction;
    assert!(middle.dot(DVec3::new(2.0, 1.0, 3.0)) < 0.0);
    assert!((middle.angle_between(top).to_degrees() - 22.5).abs() < 1e-9);
    assert!(top.z > middle.z);
}
