//! Lights in rough mirrors that are far brighter there than white.

use super::{MANY, brdf, check, floor, floor_with, over};
use gridel_core::{Format, Settings, Structure};
use gridel_host::render::{Job, render_linear};
use std::f64::consts::PI;

/// Few facets mirror a small lamp, and samples that hit it are far brighter than white; their mean is not.
#[test]
fn small_lamps_are_as_bright_in_mirrors_of_either_side_of_the_limit() {
    for roughness in [0.29, 0.3] {
        let cos: f64 = 0.8;
        let mirrored = over(cos, PI);
        let light = format!(
            "[[light]]\nkind = 'sphere'\ncenter = {:?}\nradius = 1\nradiance = 14\nvisible = true",
            mirrored.map(|x| 30.0 * x)
        );
        let material = format!("diffuse = 0\nmirror = 1\nroughness = {roughness}");
        let sine: f64 = 1.0 / 30.0;
        let exact = 14.0 * PI * sine * sine * over_disc(roughness, cos, sine);
        assert!((0.1..0.9).contains(&exact), "{exact}");
        let blob = floor(cos, &material, &light, 2);
        check(&format!("small {roughness}"), &blob, MANY, exact);
    }
}

/// The mean of f cos over a cone of directions around the mirrored ray, given the sine of its angle.
fn over_disc(roughness: f64, cos: f64, sine: f64) -> f64 {
    const CELLS: usize = 400;
    let (i, middle) = (over(cos, 0.0), over(cos, PI));
    // Perpendicular to the middle, in the plane of the normal and beside it.
    let (up, side) = ([middle[1], -middle[0], 0.0], [0.0, 0.0, 1.0]);
    let mut sum = 0.0;
    for ring in 0..CELLS {
        let part = (ring as f64 + 0.5) / CELLS as f64;
        let toward = 1.0 - part * (1.0 - (1.0 - sine * sine).sqrt());
        let away = (1.0 - toward * toward).sqrt();
        for step in 0..CELLS {
            let turn = (step as f64 + 0.5) / CELLS as f64 * 2.0 * PI;
            let axis =
                |k: usize| toward * middle[k] + away * (turn.cos() * up[k] + turn.sin() * side[k]);
            let o = [axis(0), axis(1), axis(2)];
            sum += brdf(roughness * roughness, i, o) * o[1];
        }
    }
    sum / (CELLS * CELLS) as f64
}

/// The usual sun is brighter than a blob holds. Rough mirrors reflect all its light, once.
#[test]
fn the_sun_is_as_bright_in_mirrors_of_every_roughness() {
    let cos: f64 = 0.8;
    let towards = over(cos, PI);
    for roughness in [0.05, 0.1, 0.2, 0.29, 0.3] {
        let angle: f64 = 0.53;
        let sine = (angle / 2.0).to_radians().sin();
        let whole = PI * over_disc(roughness, cos, sine);
        // As bright as a display shows.
        let mirror = 0.6 / whole;
        let material = format!("diffuse = 0\nmirror = {mirror}\nroughness = {roughness}");
        let sky = format!(
            "[environment]\nzenith = 0\nhorizon = 0\nground = 0\nsize = 16\n\
             sun = {{ direction = {:?}, color = 1, angle = {angle} }}",
            towards.map(|x| -x)
        );
        let blob = floor_with(cos, &material, &sky, "depth = 2\ncutoff = 0");
        let record = *blob.scene().expect("a scene").environment().expect("a sky");
        assert!(record.is_sun_limited());
        check(&format!("sun {roughness}"), &blob, MANY, 0.6);
    }
}

/// Highlights far above white, and the diffuse light of the same light beside them.
#[test]
fn rough_highlights_keep_their_strength_in_every_format() {
    let cos: f64 = 0.8;
    let towards = over(cos, PI);
    let light = format!(
        "[[light]]\nkind = 'directional'\ndirection = {:?}\ncolor = 0.03",
        towards.map(|x| -x)
    );
    let material = "diffuse = [0, 0.8, 0]\nmirror = [1, 0, 0]\nroughness = 0.05";
    let blob = floor(cos, material, &light, 0);
    let scene = blob.scene().expect("a scene");
    let exact = 0.03 * PI * brdf(0.0025, over(cos, 0.0), towards) * cos;
    assert!(exact > 1000.0 && exact < 2000.0, "{exact}");
    for format in Format::ALL {
        let job = Job::whole(format, Structure::List, Settings::of(&scene));
        let picture = render_linear(&scene, &job, &|| ()).expect("a picture");
        for pixel in picture.pixels {
            let [red, green, blue] = pixel.map(f64::from);
            // A pixel is as wide as a part of the highlight.
            assert!(
                (red / exact - 1.0).abs() < 0.03,
                "{format:?}: {red} for {exact}"
            );
            assert!((green - 0.0192).abs() < 1e-3, "{format:?}: {green}");
            assert_eq!(blue, 0.0);
        }
    }
}
