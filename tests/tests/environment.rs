//! The light around a scene: pictures have the values that analysis gives.

use glam::DVec3;
use gridel_core::{Effects, Format, Settings, Structure};
use gridel_host::explain::{LightOutcome, Subject, explain};
use gridel_host::scene::{Environment, Panorama, Scene, Sky, read};
use gridel_tests::measured::{SCRAMBLES, check, compiled, measured_color, wrong_pixels};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A scene in which 4 by 4 pixels show nearly one point.
fn scene(eye: &str, target: &str, rest: &str) -> Scene {
    let text = format!(
        "[camera]\neye = {eye}\ntarget = {target}\nup = [0.3, 0.5, 0.8]\nfov = 0.05\n\
         [render]\nwidth = 4\nheight = 4\nsamples = 1\n\
         [material.gray]\ndiffuse = 0.8\n[material.white]\ndiffuse = 1\n\
         [material.mirror]\ndiffuse = 0\nmirror = 1\n{rest}"
    );
    let imported = read("sky.toml".as_ref(), text.into(), &Default::default());
    imported
        .unwrap_or_else(|error| panic!("{error}: {rest}"))
        .scene
}

const BALL: &str = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'gray'";

fn uniform(radiance: f64) -> String {
    format!(
        "[environment]\nzenith = {radiance}\nhorizon = {radiance}\nground = {radiance}\nsize = 16"
    )
}

/// A convex body with reflectance a in radiance L from everywhere has the color a L everywhere.
#[test]
fn white_furnace_shows_the_reflectance_times_the_radiance() {
    let sky = uniform(0.5);
    for eye in [
        "[5, 0.1, 0.2]",
        "[-3, -4, 1]",
        "[0.1, 6, -3]",
        "[0.3, -0.2, -9]",
    ] {
        let blob = compiled(&scene(eye, "[0, 0, 0]", &format!("{sky}\n{BALL}")));
        assert!(
            blob.scene()
                .expect("a scene")
                .effects()
                .contains(Effects::ENVIRONMENT)
        );
        check("ball", &blob, 0.4);
    }
    let floor = "[[object]]\nkind = 'plane'\npoint = [0, 0, 0]\nnormal = [0.2, 1, 0.1]\nmaterial = 'gray'\n\
                 [[object]]\nkind = 'box'\nmin = [2, -3, 2]\nmax = [3, -2, 3]\nmaterial = 'gray'";
    let blob = compiled(&scene(
        "[0.5, 3, 1]",
        "[0, 0, 0]",
        &format!("{sky}\n{floor}"),
    ));
    check("plane", &blob, 0.4);
}

/// Under a sky that is bright above the horizon alone, a surface that leans by an angle sees (1 + cos) / 2 of it.
#[test]
fn half_bright_sky_gives_the_analytic_irradiance() {
    let sky = "[environment]\nzenith = 0.75\nhorizon = 0.75\nground = 0";
    for degrees in [0.0_f64, 40.0, 90.0, 130.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        // The point of the ball whose normal leans by the angle, seen from outside.
        let eye = format!("[{}, {}, 0]", 6.0 * sine, 6.0 * cosine);
        let blob = compiled(&scene(&eye, "[0, 0, 0]", &format!("{sky}\n{BALL}")));
        check(
            &format!("{degrees}"),
            &blob,
            0.8 * 0.75 * (1.0 + cosine) / 2.0,
        );
    }
}

/// A gradient whose radiance at elevation sine h is z h (2 - h): on level ground 2 z (2/3 - 1/4).
#[test]
fn gradient_gives_the_analytic_irradiance() {
    let sky = "[environment]\nzenith = 0.9\nhorizon = 0\nground = 0.3\nsize = 128";
    let blob = compiled(&scene("[0, 6, 0]", "[0, 0, 0]", &format!("{sky}\n{BALL}")));
    // The map's value of the curve is within 1 in 1,000 of it.
    let exact = 0.8 * 0.9 * 2.0 * (2.0 / 3.0 - 0.25);
    for format in Format::ALL {
        let ([mean, ..], error) = measured_color(&blob, format, 1024);
        assert!(
            (mean / exact - 1.0).abs() < 1e-3 + 3.0 * error,
            "{format:?} {mean} {exact}"
        );
    }
}

/// The mean cosine of directions in the sun around an elevation is the elevation's sine times (1 + cos of half the angle) / 2.
#[test]
fn sun_gives_the_analytic_irradiance_and_is_seen_where_it_stands() {
    for angle in [0.53_f64, 20.0, 80.0] {
        let sky = format!(
            "[environment]\nzenith = 0\nhorizon = 0\nground = 0\nsize = 16\n\
             sun = {{ direction = [-3, -8, 2], color = 0.7, angle = {angle} }}"
        );
        let elevation = 8.0 / 77_f64.sqrt();
        let blob = compiled(&scene("[0, 6, 0]", "[0, 0, 0]", &format!("{sky}\n{BALL}")));
        // As much as a directional light of its color.
        check("sun", &blob, 0.8 * 0.7 * elevation);
    }
    let dim = "[environment]\nzenith = 0.125\nhorizon = 0.125\nground = 0.125\n\
               sun = { direction = [0, -1, 0], radiance = 0.5, angle = 10 }";
    for (degrees, exact) in [(0.0_f64, 0.625), (4.9, 0.625), (5.1, 0.125), (90.0, 0.125)] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let blob = compiled(&scene(
            "[5, 0, 0]",
            &format!("[{}, {cosine}, 0]", 5.0 + sine),
            &format!("{dim}\n{BALL}"),
        ));
        check(&format!("seen {degrees}"), &blob, exact);
    }
}

/// A picture whose colors say where its pixels look.
fn directions() -> Environment {
    let pixels = (0..512 * 256).map(|it| {
        let longitude = TAU * (f64::from(it % 512) + 0.5) / 512.0;
        let row = (f64::from(it / 512) + 0.5) / 256.0;
        [
            0.5 + 0.4 * longitude.cos(),
            0.5 + 0.4 * longitude.sin(),
            row,
        ]
        .map(|it| it as f32)
    });
    let panorama = Panorama::new("directions", 512, 256, pixels.collect()).expect("pixels");
    Environment {
        size: 128,
        ..Environment::of(Sky::Picture(Arc::new(panorama)))
    }
}

/// Returns the value that [`directions`] shows.
fn shown(towards: DVec3) -> [f64; 3] {
    // The middle is at -z, the right at x.
    let longitude = PI + f64::atan2(towards.x, -towards.z);
    let row = f64::acos(towards.normalize().y) / PI;
    [
        0.5 + 0.4 * longitude.cos(),
        0.5 + 0.4 * longitude.sin(),
        row,
    ]
}

#[test]
fn mirrors_and_cameras_see_the_picture_where_geometry_says() {
    let glass = "[[object]]\nkind = 'disc'\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 2\nmaterial = 'mirror'";
    for eye in [
        DVec3::new(3.0, 2.0, 0.0),
        DVec3::new(-1.0, 1.0, 2.0),
        DVec3::new(0.5, 3.0, -2.0),
        DVec3::new(-2.0, 0.5, -2.0),
    ] {
        let at = |point: DVec3| format!("[{}, {}, {}]", point.x, point.y, point.z);
        let mut scene = scene(&at(eye), "[0, 0, 0]", glass);
        scene.environment = Some(directions());
        let expected = shown(DVec3::new(-eye.x, eye.y, -eye.z));
        let mirrored = compiled(&scene);
        if let Some(camera) = &mut scene.camera {
            camera.target = 2.0 * eye;
        }
        let direct = compiled(&scene);
        for format in Format::ALL {
            for (found, expected) in [
                (measured_color(&mirrored, format, 1).0, expected),
                (measured_color(&direct, format, 1).0, shown(eye)),
            ] {
                for (found, expected) in found.into_iter().zip(expected) {
                    let off = (found - expected).abs();
                    assert!(off < 0.02, "{format:?} {eye}: {found} {expected}");
                }
            }
        }
    }
}

/// A dim sky with a spot that has most of the light.
fn spot() -> Environment {
    let mut pixels = vec![[0.2_f32; 3]; 256 * 128];
    for row in 30..34 {
        for column in 100..105 {
            pixels[row * 256 + column] = [120.0; 3];
        }
    }
    let panorama = Panorama::new("spot", 256, 128, pixels).expect("pixels");
    Environment::of(Sky::Picture(Arc::new(panorama)))
}

/// The error falls at least as N^-0.6, and is far below that of as many uniform directions.
#[test]
fn bright_spots_converge() {
    let mut scene = scene("[0, 6, 0]", "[0, 0, 0]", BALL);
    scene.environment = Some(spot());
    // Within the range of a display.
    scene.render.exposure = -1.0;
    let blob = compiled(&scene);
    let (mean, few) = measured_color(&blob, Format::F64, 16);
    let (_, many) = measured_color(&blob, Format::F64, 4096);
    let exponent = (few / many).log2() / 8.0;
    eprintln!("{mean:?} {few:.6} {many:.6}: N^-{exponent:.2}");
    assert!(exponent >= 0.6, "{exponent}");
    // Uniform directions: the spot of 1/300 of the sphere brings all or nothing.
    let part = 20.0 / (256.0 * 128.0) * PI / 2.0 * (32.0 * PI / 128.0).sin();
    let uniform = mean[0] / (part * 16.0 * SCRAMBLES as f64).sqrt();
    assert!(few < 0.2 * uniform, "{few} {uniform}");
}

#[test]
fn pictures_are_read_from_files_and_their_faults_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sky.toml");
    let load = |text: &str| {
        std::fs::write(&file, format!("{text}\n{BALL}\n[material.gray]\n")).expect("a file");
        gridel_host::scene::load(&file, &Default::default())
    };
    let flat = [
        &b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"[..],
        &[128, 64, 32, 129, 64, 32, 16, 129],
    ]
    .concat();
    std::fs::write(folder.path().join("sky.hdr"), &flat).expect("a file");
    std::fs::write(folder.path().join("cut.hdr"), &flat[..flat.len() - 1]).expect("a file");
    std::fs::write(folder.path().join("text.png"), "text").expect("a file");
    std::fs::write(folder.path().join("cut.exr"), b"\x76\x2f\x31\x01\x02").expect("a file");
    let scene = load("[environment]\nimage = 'sky.hdr'\nintensity = 2\nrotation = 30\nsize = 32")
        .expect("a scene")
        .scene;
    let Some(Environment {
        sky: Sky::Picture(picture),
        size: 32,
        ..
    }) = &scene.environment
    else {
        panic!("{:?}", scene.environment)
    };
    assert_eq!(
        picture.rows().next(),
        Some(&[[1.0, 0.5, 0.25], [0.5, 0.25, 0.125]][..])
    );
    compiled(&scene);
    for (text, words) in [
        ("image = 'cut.hdr'", "ends in row 0"),
        ("image = 'text.png'", "is neither Radiance"),
        ("image = 'cut.exr'", "OpenEXR"),
        ("image = 'none.hdr'", "none.hdr"),
        ("image = '../sky.hdr'", "sky.hdr"),
        ("image = 'sky.hdr'\nzenith = 1", "not both"),
        ("intensity = 1", "neither an `image`"),
        ("zenith = 1\nhorizon = 1", "has no `ground`"),
        (
            "zenith = 1\nhorizon = 1\nground = 1\nrotation = 4",
            "`rotation` does nothing",
        ),
        ("image = 'sky.hdr'\nsize = 48", "power of two"),
        ("image = 'sky.hdr'\nsize = 512", "from 16 to 256"),
        (
            "image = 'sky.hdr'\nsun = { direction = [0, 0, 0] }",
            "points nowhere",
        ),
        (
            "image = 'sky.hdr'\nsun = { direction = [0, -1, 0], angle = 0 }",
            "degrees",
        ),
        (
            "image = 'sky.hdr'\nsun = { direction = [0, -1, 0], color = 1, radiance = 1 }",
            "not both",
        ),
        (
            "image = 'sky.hdr'\nsun = { direction = [0, -1, 0], radiance = 1e9, angle = 9 }",
            "at most 2047",
        ),
    ] {
        let error = load(&format!("[environment]\n{text}"))
            .expect_err(text)
            .to_string();
        assert!(
            error.contains(words) && error.contains("sky.toml:"),
            "{text}: {error}"
        );
    }
}

#[test]
fn scenes_without_an_environment_have_no_byte_of_it() {
    let mut with = scene(
        "[0, 6, 0]",
        "[0, 0, 0]",
        &format!("{}\n{BALL}", uniform(0.5)),
    );
    with.ambient = [0.1; 3];
    let mut without = with.clone();
    without.environment = None;
    with.remove_effects(Effects::ENVIRONMENT);
    let [with, without] = [with, without].map(|scene| compiled(&scene));
    assert_eq!(with.bytes(), without.bytes());
    assert!(without.scene().expect("a scene").environment().is_none());
}

#[test]
fn environments_are_verified_and_explained() {
    let sky = "[environment]\nzenith = 0.5\nhorizon = 0.5\nground = 0.125\nsize = 32\n\
               sun = { direction = [0, -1, 0], angle = 4 }";
    let blob = compiled(&scene("[0, 6, 0]", "[0, 0, 0]", &format!("{sky}\n{BALL}")));
    let scene = blob.scene().expect("a scene");
    let report = gridel_host::verify::verify(&scene, 500, &|| ());
    assert_eq!(report.broken(), 0);
    let explained = |origin: DVec3, direction: DVec3| {
        let ray = gridel_host::trace::SceneRay {
            origin,
            direction,
            tmin: 0.0,
            tmax: f64::INFINITY,
        };
        let (settings, subject) = (Settings::of(&scene), Subject::Ray(ray));
        let explanation = explain(&scene, Format::F64, Structure::List, settings, subject);
        explanation.expect("an explanation").samples[0].rays[0].clone()
    };
    let hit = explained(6.0 * DVec3::Y, DVec3::NEG_Y);
    assert_eq!(hit.lights.len(), 2);
    let sun = &hit.lights[1];
    assert!(
        sun.outcome == LightOutcome::Lit && sun.from_environment.expect("a direction")[1] > 0.99
    );
    let missed = |direction: DVec3| {
        explained(3.0 * DVec3::Y, direction)
            .environment
            .expect("a texel")
    };
    let (_, sees_sun) = missed(DVec3::Y);
    let (_, sees_no_sun) = missed(DVec3::X);
    assert!(sees_sun && !sees_no_sun);
}

/// A light of the sky shines over the edge of a smooth mesh. The ray to it begins above the triangle and keeps its
/// direction. The sky has no position.
#[test]
fn smooth_meshes_are_lit_from_the_direction_that_was_drawn() {
    let text = "[camera]\neye = [0.5, 2, 8]\ntarget = [0, 0, 0]\nfov = 24\n\
        [render]\nwidth = 24\nheight = 24\nsamples = 4\n\
        [environment]\nzenith = [0.5, 0.6, 0.9]\nhorizon = 0.7\nground = 0.2\nsize = 16\n\
        sun = { direction = [1, -1.1, -0.8], color = 1.5, angle = 2 }\n\
        [material.clay]\ndiffuse = 0.8\n\
        [[object]]\nkind = 'mesh'\nmaterial = 'clay'\nsmooth = 120\n\
        vertices = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]\n\
        faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]";
    let imported = read("ball.toml".as_ref(), text.into(), &Default::default());
    let blob = compiled(&imported.expect("a scene").scene);
    for format in Format::ALL {
        assert_eq!(wrong_pixels(&blob, format), 0, "{format:?}");
    }
}
