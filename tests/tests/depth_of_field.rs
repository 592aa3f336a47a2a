//! Depth of field: circles of confusion have the sizes that a thin lens gives.

use gridel_core::accel::Number;
use gridel_core::{
    DualSplit, Effects, Format, NoCount, Ray, Renderer, Settings, Structure, Workspace,
};
use gridel_host::render::{Job, render};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::measured::{SCRAMBLES_WIDE, blob, convergence};

const APERTURE: f64 = 0.8;
const FOCUS: f64 = 10.0;
const SIDE: u16 = 64;

/// The picture of glowing things in front of black, seen from the origin along -z under 30 degrees.
fn picture(lens: &str, objects: &str, format: Format, samples: u16) -> Vec<f64> {
    let blob = blob(&format!(
        "[camera]\neye = [0, 0, 0]\ntarget = [0, 0, -7]\nfov = 30\n{lens}\n\
         [render]\nwidth = {SIDE}\nheight = {SIDE}\n\
         [material.lamp]\ndiffuse = 0\nemission = 1\nlights = false\n{objects}"
    ));
    let scene = blob.scene().expect("a scene");
    let settings = Settings {
        samples,
        ..Settings::of(&scene)
    };
    let job = Job::whole(format, Structure::List, settings);
    let picture = render(&scene, &job, &|| ()).expect("a picture");
    let red = picture
        .pixels
        .iter()
        .map(|pixel| f64::from(pixel[0]) / 65_535.0);
    red.collect()
}

fn lens() -> String {
    format!("aperture = {APERTURE}\nfocus = {FOCUS}")
}

/// Pixels per scene unit on a plane at a depth.
fn pixels_per_unit(depth: f64) -> f64 {
    f64::from(SIDE) / (2.0 * depth * 15_f64.to_radians().tan())
}

/// Returns the diameter of a uniform disc with the spread of a picture along each axis. Also returns how far the disc's
/// middle is from the picture's.
fn diameter(picture: &[f64]) -> ([f64; 2], f64) {
    let side = usize::from(SIDE);
    let at = |index: usize| [index % side, index / side].map(|it| it as f64 + 0.5);
    let sum: f64 = picture.iter().sum();
    let mean = [0, 1].map(|axis| {
        let all = picture.iter().enumerate();
        all.map(|(index, value)| value * at(index)[axis])
            .sum::<f64>()
            / sum
    });
    let spread = [0, 1].map(|axis| {
        let all = picture.iter().enumerate();
        let squares = all.map(|(index, value)| value * (at(index)[axis] - mean[axis]).powi(2));
        // A pixel has a spread of its own; a disc's is a sixteenth of its diameter's square.
        4.0 * (squares.sum::<f64>() / sum - 1.0 / 12.0).sqrt()
    });
    let middle = f64::from(SIDE) / 2.0;
    (spread, (mean[0] - middle).hypot(mean[1] - middle))
}

#[test]
fn circles_of_confusion_have_the_diameter_of_the_formula() {
    let samples = part_of(256, 1024) as u16;
    for format in Format::ALL {
        for depth in [5.0, 7.0, 20.0, 40.0] {
            let radius = 0.04 * depth / FOCUS;
            let ball = format!(
                "[[object]]\nkind = 'sphere'\ncenter = [0, 0, {}]\nradius = {radius}\nmaterial = 'lamp'",
                -depth
            );
            let (found, aside) = diameter(&picture(&lens(), &ball, format, samples));
            let circle = APERTURE * (depth - FOCUS).abs() / depth * pixels_per_unit(FOCUS);
            // The ball's own image spreads it.
            let exact = circle.hypot(2.0 * radius * pixels_per_unit(depth));
            eprintln!("{format:?} at {depth}: {found:?}, exact {exact:.2}");
            for found in found {
                assert!(
                    (found - exact).abs() <= 0.5,
                    "{format:?} at {depth}: {found}, {exact}"
                );
            }
            assert!(aside < 0.3, "{format:?} at {depth}: {aside}");
        }
    }
}

#[test]
fn what_is_in_focus_is_as_sharp_as_with_a_pinhole() {
    let disc = format!(
        "[[object]]\nkind = 'disc'\ncenter = [0.3, 0.2, {}]\nnormal = [0, 0, 1]\nradius = 1.7\nmaterial = 'lamp'",
        -FOCUS
    );
    for format in Format::ALL {
        let sharp = picture("", &disc, format, 16);
        let found = picture(&lens(), &disc, format, 16);
        let differ = sharp.iter().zip(&found).filter(|(a, b)| a != b).count();
        assert!(differ <= 2, "{format:?}: {differ}");
        assert!(sharp.contains(&1.0));
    }
}

/// If a camera has no focus of its own, it is sharp at its target.
#[test]
fn focus_is_on_the_target() {
    let disc = "[[object]]\nkind = 'disc'\ncenter = [0, 0, -7]\nnormal = [0, 0, 1]\nradius = 1\nmaterial = 'lamp'";
    let sharp = picture("", disc, Format::F64, 4);
    let found = picture("aperture = 0.5", disc, Format::F64, 4);
    let differ = sharp.iter().zip(&found).filter(|(a, b)| a != b).count();
    assert!(differ <= 2, "{differ}");
}

/// The error falls at least as N^-0.6 from 16 to 4,096 samples; of random points it falls as N^-0.5.
#[test]
fn blurred_edges_converge() {
    let blob = blob(&format!(
        "[camera]\neye = [0, 0, 0]\ntarget = [0, 0, -7]\nfov = 0.002\naperture = 1\nfocus = 5\n\
         [render]\n{SCRAMBLES_WIDE}samples = 1\n\
         [material.lamp]\ndiffuse = 0\nemission = 0.9\nlights = false\n\
         [[object]]\nkind = 'sphere'\ncenter = [1.1, 0.3, -9]\nradius = 1\nmaterial = 'lamp'"
    ));
    let exponent = convergence(&blob);
    assert!(exponent >= 0.6, "{exponent}");
}

#[test]
fn lenses_are_stated_in_scene_units_and_cost_nothing_where_there_is_none() {
    let text = |lens: &str| {
        format!(
            "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n{lens}\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'"
        )
    };
    let (without, zero) = (blob(&text("")), blob(&text("aperture = 0")));
    assert_eq!(without.bytes(), zero.bytes());
    let with = blob(&text("aperture = 0.5\nfocus = 4"));
    let scene = with.scene().expect("a scene");
    assert!(scene.effects().contains(Effects::DEPTH_OF_FIELD));
    let lens = scene.lens().expect("a lens");
    let unit = f64::from(scene.header().unit_exponent).exp2() / 8192.0;
    assert!((lens.radius as f64 * unit - 0.25).abs() <= unit);
    assert!((lens.focus as f64 * unit - 4.0).abs() <= unit);
}

/// Lenses far away and wide, and in front of planes without bounds.
#[test]
fn lenses_of_all_sizes_bring_light() {
    for (aperture, focus, distance) in [
        (1e-6, 1e-3, 3.0),
        (2.8, 1e5, 1e5),
        (0.1, 1e6, 2e5),
        (2.9, 2.0, 3.0),
    ] {
        let blob = blob(&format!(
            "background = 0.25\n[camera]\neye = [0, 0.5, {distance}]\ntarget = [0, 0, 0]\nfov = 40\n\
             aperture = {aperture}\nfocus = {focus}\n[render]\nwidth = 8\nheight = 8\nsamples = 16\n\
             [material.lamp]\ndiffuse = 0\nemission = 1\nlights = false\n\
             [[object]]\nkind = 'plane'\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\nmaterial = 'lamp'\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'lamp'"
        ));
        let scene = blob.scene().expect("a scene");
        for format in Format::ALL {
            let job = Job::whole(format, Structure::List, Settings::of(&scene));
            let picture = render(&scene, &job, &|| ()).expect("a picture");
            let mean = |row: usize| -> f64 {
                let pixels = picture.pixels[8 * row..8 * row + 8].iter();
                pixels
                    .map(|pixel| f64::from(pixel[0]) / 65_535.0)
                    .sum::<f64>()
                    / 8.0
            };
            // Sky above, the plane below.
            assert!(
                mean(0) < mean(7),
                "{format:?} {aperture}: {} {}",
                mean(0),
                mean(7)
            );
            assert!((0.24..=1.0).contains(&mean(0)), "{format:?}");
        }
    }
}

/// A ray of the caller's own passes no lens. It shows the same as in that scene with a pinhole.
#[test]
fn rays_of_the_callers_own_pass_no_lens() {
    every_format!(shows_what_a_pinhole_shows());
}

fn shows_what_a_pinhole_shows<N: Number>() {
    const EFFECTS: u32 = Effects::ALL.0;
    let colors = |lens: &str| {
        let blob = blob(&format!(
            "background = 0.25\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n{lens}\n\
             [material.lamp]\ndiffuse = 0\nemission = 0.5\nlights = false\n\
             [[object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = 'lamp'"
        ));
        let scene = blob.scene().expect("a scene");
        let renderer =
            Renderer::<N, DualSplit, EFFECTS>::with_settings(&scene, Settings::of(&scene));
        let renderer = renderer.expect("a renderer");
        let mut space = Workspace::<N, 64, 99>::new();
        let size = f64::from(scene.header().unit_exponent).exp2();
        let colors = (0..64).map(|number| {
            let x = f64::from(number) / 16.0 - 2.0;
            // Past the camera, from the side of the box.
            let origin = [x / size, 9.0 / size, 0.0];
            let ray = Ray::<N>::from_f64(scene.bounds(), origin, [0.0, -1.0, 0.0], 0.0, f64::MAX);
            renderer.linear_along(&ray.expect("a ray"), &mut space.as_view(), &mut NoCount)
        });
        colors.collect::<Vec<_>>()
    };
    let pinhole = colors("");
    assert_eq!(colors("aperture = 3"), pinhole);
    let lit = pinhole.iter().filter(|color| color[0] > 20_000).count();
    assert!((28..36).contains(&lit), "{lit}");
}
