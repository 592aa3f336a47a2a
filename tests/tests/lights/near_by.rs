//! Lights with an area that are near to what they light, and lights that have lost their area.

use super::{FLOOR, scene};
use glam::{DQuat, DVec3};
use gridel_core::{Effects, Format};
use gridel_host::compile::{Options, compile};
use gridel_tests::measured::{check, measured, read, wrong_pixels};
use std::f64::consts::PI;

/// The irradiance of a polygon above a surface over its radiance, by the angles of its edges (Lambert, 1760).
fn irradiance(polygon: &[DVec3], point: DVec3, normal: DVec3) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    let edges = polygon
        .iter()
        .zip(next)
        .map(|(&a, &b)| [a - point, b - point]);
    let parts = edges.map(|[a, b]| a.angle_between(b) * a.cross(b).normalize().dot(normal));
    parts.sum::<f64>().abs() / 2.0
}

/// A light just above a floor and beside a wall, as near as a hundredth of its size: below its middle, an edge and a
/// corner, and outside of it.
#[test]
fn lights_near_by_give_the_analytic_irradiance() {
    // Samples are up to 2.5 times as bright: brighter than white.
    const RADIANCE: f64 = 0.8;
    let given = |v: DVec3| format!("[{}, {}, {}]", v.x, v.y, v.z);
    let (wide, long) = (DVec3::X * 80.0, DVec3::Z * 100.0);
    for height in [1.0, 5.0, 60.0] {
        let above = DVec3::Y * height;
        let corner = above - (wide + long) / 2.0;
        let rectangle = format!(
            "kind = 'rectangle'\ncorner = {}\nedges = [{}, {}]",
            given(corner),
            given(wide),
            given(long)
        );
        let disc = format!(
            "kind = 'disc'\ncenter = {}\nradius = 40\nnormal = [0, -1, 0]",
            given(above)
        );
        let around = |k: u32| DQuat::from_rotation_y(f64::from(k) * PI / 500.0) * DVec3::X;
        for (light, polygon) in [
            (
                rectangle,
                vec![corner, corner + wide, corner + wide + long, corner + long],
            ),
            (disc, (0..1000).map(|k| above - 40.0 * around(k)).collect()),
        ] {
            let light = format!("[[light]]\n{light}\nradiance = {RADIANCE}");
            for [x, z] in [
                [0.0, 0.0],
                [-40.0, 3.0],
                [-39.0, -49.0],
                [43.0, 10.0],
                [80.0, 80.0],
            ] {
                let (eye, target) = (format!("[{x}, 30, {z}]"), format!("[{x}, 0, {z}]"));
                let exact = irradiance(&polygon, DVec3::new(x, 0.0, z), DVec3::Y) / PI;
                let blob = scene(&light, &eye, &target, FLOOR);
                check(&format!("{light} {x}"), &blob, RADIANCE * exact);
            }
            let wall = "[[object]]\nkind = 'box'\nmin = [41, -99, -200]\nmax = [50, 99, 200]\nmaterial = 'white'";
            let exact = irradiance(&polygon, DVec3::new(41.0, 0.0, 2.0), DVec3::NEG_X) / PI;
            let blob = scene(&light, "[30, 0, 2]", "[41, 0, 2]", wall);
            check(&format!("{light} wall"), &blob, RADIANCE * exact);
        }
    }
}

/// A twentieth of its size above a floor: by area the error would be a hundred times as large.
#[test]
fn points_by_solid_angle_have_small_errors() {
    let light = "[[light]]\nkind = 'rectangle'\ncorner = [-40, 5, -50]\nedges = [[80, 0, 0], [0, 0, 100]]\nradiance = 0.3";
    let blob = scene(light, "[0, 30, 0]", "[0, 0, 0]", FLOOR);
    for format in Format::ALL {
        let (_, error) = measured(&blob, format, 256);
        assert!(error < 2e-4, "{format:?}: {error}");
    }
}

/// Only what arrives is limited in `fixed`, and not the radiance: a bright lamp above a dark floor, from near by and from
/// where it is drawn by area.
#[test]
fn bright_lights_near_by_are_as_bright_in_every_format() {
    const DARK: &str = "[material.dark]\ndiffuse = 0.00048828125\n\
                        [[object]]\nkind = 'box'\nmin = [-9, -1, -9]\nmax = [9, 0, 9]\nmaterial = 'dark'";
    let down = [(-0.05, -0.05), (0.05, -0.05), (0.05, 0.05), (-0.05, 0.05)];
    for height in [0.15, 0.25, 0.35, 0.5] {
        let polygon = down.map(|(x, z)| DVec3::new(x, height, z));
        let exact = 1e4 * irradiance(&polygon, DVec3::ZERO, DVec3::Y) / PI;
        let light = format!(
            "[[light]]\nkind = 'rectangle'\ncorner = [-0.05, {height}, -0.05]\n\
             edges = [[0.1, 0, 0], [0, 0, 0.1]]\nradiance = 1e4"
        );
        let blob = scene(&light, "[0, 0.4, 0]", "[0, 0, 0]", DARK);
        check(&format!("{height}"), &blob, exact / 2048.0);
    }
}

/// Triangles and parallelograms that glow, just above a floor.
#[test]
fn surfaces_near_by_give_the_analytic_irradiance() {
    for height in [2.0, 10.0] {
        let corner = DVec3::new(-40.0, height, -50.0);
        let (wide, skew) = (DVec3::X * 80.0, DVec3::new(60.0, 0.0, 90.0));
        for polygon in [
            vec![corner, corner + wide, corner + skew],
            vec![corner, corner + wide, corner + wide + skew, corner + skew],
        ] {
            let vertices = polygon.iter().map(|v| v.to_array()).collect::<Vec<_>>();
            let faces = (0..polygon.len()).collect::<Vec<_>>();
            let objects = format!(
                "{FLOOR}\n[material.lamp]\ndiffuse = 0\nemission = 0.3\n\
                 [[object]]\nkind = 'mesh'\nvertices = {vertices:?}\nfaces = [{faces:?}]\nmaterial = 'lamp'"
            );
            for [x, z] in [[0.0, 0.0], [-42.0, -52.0], [20.0, 38.0]] {
                let eye = format!("[{x}, {}, {z}]", height / 2.0);
                let blob = scene("", &eye, &format!("[{x}, 0, {z}]"), &objects);
                let exact = irradiance(&polygon, DVec3::new(x, 0.0, z), DVec3::Y) / PI;
                check(&format!("{polygon:?} {x}"), &blob, 0.3 * exact);
            }
        }
    }
}

/// A small tilted disc lights a floor by the cosine of its tilt, with its area and without.
#[test]
fn lights_without_their_area_shine_to_the_same_side() {
    for tilt in [0.0_f64, 30.0, 60.0, 80.0, 100.0] {
        let (sine, cosine) = tilt.to_radians().sin_cos();
        let text = format!(
            "[camera]\neye = [0, 1, 0]\ntarget = [0, 0, 0]\nup = [0.3, 0.2, 1]\nfov = 0.2\n\
             [render]\nwidth = 4\nheight = 4\nsamples = 1\n[material.white]\ndiffuse = 1\n\
             [[object]]\nkind = 'box'\nmin = [-9, -1, -9]\nmax = [9, 0, 9]\nmaterial = 'white'\n\
             [[light]]\nkind = 'disc'\ncenter = [0, 2, 0]\nradius = 0.02\nradiance = 8000\n\
             normal = [{sine}, {}, 0]\n",
            -cosine
        );
        let mut imported = read(&text);
        let exact = 8000.0 * 0.02 * 0.02 / 4.0 * cosine.max(0.0);
        for is_area in [true, false] {
            if !is_area {
                imported.remove_effects(Effects::AREA_LIGHT);
            }
            let blob = compile(&imported, &Options::default())
                .expect("a blob")
                .blob;
            let effects = blob.scene().expect("a scene").effects();
            assert_eq!(effects.contains(Effects::AREA_LIGHT), is_area);
            for format in Format::ALL {
                let (mean, _) = measured(&blob, format, 64);
                assert!(
                    (mean - exact).abs() < 0.005 * exact + 1e-4,
                    "{tilt} {is_area} {format:?}: {mean}, {exact}"
                );
                assert_eq!(
                    wrong_pixels(&blob, format),
                    0,
                    "{tilt} {is_area} {format:?}"
                );
            }
        }
    }
}
