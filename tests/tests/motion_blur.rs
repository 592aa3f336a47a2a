//! Motion blur: samples are distributed over the moments of a shutter, and moving objects are blurred by the right
//! amount.

use gridel_core::render::{RenderError, Shutter};
use gridel_core::{
    DualSplit, Effects, Format, NoCount, Renderer, Scene, Settings, Structure, Tracks, Workspace,
};
use gridel_host::blob::Blob;
use gridel_host::render::{Job, render, render_linear_moments, render_moments};
use gridel_host::state::{State, exposed};
use gridel_tests::measured::blob;

const SIDE: u16 = 32;

fn job(scene: &Scene<'_>, format: Format, samples: u16) -> Job {
    let settings = Settings {
        samples,
        ..Settings::of(scene)
    };
    Job::whole(format, Structure::DualSplit, settings)
}

/// The picture of a scene that moves, with the shutter open for some ticks from 0 on.
fn blurred(blob: &Blob, job: &Job, open: u32, moments: u16) -> Vec<[u16; 3]> {
    let scene = blob.scene().expect("a scene");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
    let states: Vec<_> = exposed(0, open, moments)
        .map(|time| State::at(blob, &scene, &tracks, time).expect("a state"))
        .collect();
    let scenes: Vec<_> = states
        .iter()
        .map(|state| state.apply(&scene).expect("a moment"))
        .collect();
    render_moments(&scenes, job, &|| ())
        .expect("a picture")
        .pixels
}

/// A ball under a soft light on a mirror: effects that draw random points and send rays on.
const BALL: &str = "\
    [camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\naperture = 0.1\n\
    [render]\nwidth = 32\nheight = 32\n\
    [material.floor]\ndiffuse = 0.4\nmirror = 0.4\n\
    [[light]]\nkind = 'sphere'\ncenter = [2, 4, 2]\nradius = 1\nradiance = 20\n\
    [[object]]\nkind = 'plane'\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\nmaterial = 'floor'\n\
    [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";

#[test]
fn scenes_that_stand_still_are_as_without_a_shutter() {
    let blob = blob(BALL);
    let scene = blob.scene().expect("a scene");
    for format in Format::ALL {
        for (samples, moments) in [(1, 1), (4, 3), (7, 7), (16, 2)] {
            let job = job(&scene, format, samples);
            let still = render(&scene, &job, &|| ()).expect("a picture").pixels;
            let found = render_moments(&vec![scene; moments], &job, &|| ()).expect("a picture");
            assert!(
                still == found.pixels,
                "{format:?}, {samples} samples, {moments} moments"
            );
        }
    }
}

/// The background is white at one moment alone, so a pixel shows how many samples were taken at it.
#[test]
fn each_moment_has_its_share_of_the_samples() {
    let blob = blob("background = 0\n[render]\nwidth = 1\nheight = 1\n");
    let black = blob.scene().expect("a scene");
    let mut white = *black.view();
    white.background = [1 << 20; 3];
    let white = black.with_view(&white).expect("a view");
    for (samples, moments) in [
        (1, 1),
        (2, 2),
        (3, 2),
        (7, 3),
        (16, 16),
        (100, 9),
        (256, 16),
        (4096, 256),
        (4096, 4096),
    ] {
        let job = job(&black, Format::F64, samples);
        let mut before = 0.0;
        // All moments where they are few, else the ends and some between them.
        for bright in (0..moments).step_by((moments / 8).max(1)) {
            let mut scenes = vec![black; moments];
            scenes[bright] = white;
            let picture = render_linear_moments(&scenes, &job, &|| ()).expect("a picture");
            let found = f64::from(picture.pixels[0][0]) * f64::from(samples);
            let share = f64::from(samples) / moments as f64;
            assert!(
                found.round() == share.floor() || found.round() == share.ceil(),
                "{found} of {samples} at moment {bright} of {moments}"
            );
            assert!((found - found.round()).abs() < 1e-3);
            before += found;
        }
        if moments < 16 {
            assert_eq!(before.round(), f64::from(samples), "{moments} moments");
        }
    }
}

/// A bright half plane moves over some pixels while the shutter is open: what they show is a ramp.
#[test]
fn moving_edge_is_a_ramp() {
    // Pixels per scene unit at the edge's depth of 8.
    let scale = f64::from(SIDE) / (2.0 * 8.0 * 15_f64.to_radians().tan());
    for (from, to) in [(-0.5, 0.5), (0.31, 1.07), (0.9, -1.1)] {
        let blob = blob(&format!(
            "background = 0\nambient = 0\n\
             [camera]\neye = [0, 0, 8]\ntarget = [0, 0, 0]\nfov = 30\n\
             [render]\nwidth = {SIDE}\nheight = 4\n\
             [material.lamp]\ndiffuse = 0\nemission = 1\nlights = false\n\
             [[object]]\nkind = 'mesh'\nmaterial = 'lamp'\nfaces = [[0, 1, 2], [0, 2, 3]]\n\
             vertices = [[-50, -50, 0], [0, -50, 0], [0, 50, 0], [-50, 50, 0]]\n\
             [[track]]\ntarget = 'camera.eye'\ntimes = [0, 1]\nvalues = [[{from}, 0, 8], [{to}, 0, 8]]\n\
             [[track]]\ntarget = 'camera.target'\ntimes = [0, 1]\nvalues = [[{from}, 0, 0], [{to}, 0, 0]]\n"
        ));
        // The picture is 4 pixels high, so its rows are as wide as 8 times their height.
        let scale = scale * 4.0 / f64::from(SIDE);
        let middle = f64::from(SIDE) / 2.0;
        let exact = |column: u16| {
            let parts = (0..4096).map(|part| {
                let after = (f64::from(part) + 0.5) / 4096.0;
                let edge = middle - scale * (from + (to - from) * after);
                (edge - f64::from(column)).clamp(0.0, 1.0)
            });
            parts.sum::<f64>() / 4096.0
        };
        let scene = blob.scene().expect("a scene");
        for format in Format::ALL {
            let job = job(&scene, format, 256);
            let open = 48_000;
            let found = blurred(&blob, &job, open, 16);
            let row = found.iter().take(SIDE.into());
            let mut sum = 0.0;
            for (column, pixel) in (0..).zip(row) {
                let off = f64::from(pixel[0]) / 65_535.0 - exact(column);
                assert!(
                    off.abs() < 0.02,
                    "{format:?}, {from} to {to}, column {column}: {off}"
                );
                sum += off;
            }
            // Places within a pixel are multiples of 1/256.
            assert!(sum.abs() < 0.02, "{format:?}, {from} to {to}: {sum}");
        }
    }
}

/// Lights, materials and instances have the values of each moment.
#[test]
fn pictures_are_means_of_their_moments() {
    let blob = blob(
        "background = 0\nambient = 0\n\
         [camera]\neye = [0, 6, 0.01]\ntarget = [0, 0, 0]\nfov = 20\n\
         [render]\nwidth = 4\nheight = 4\nsamples = 8\n\
         [material.paint]\ndiffuse = 0.9\n\
         [[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\nname = 'sun'\n\
         [[object]]\nkind = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = 'paint'\n\
         [[part]]\nname = 'shade'\n\
         [[part.object]]\nkind = 'box'\nmin = [-4, 0, -4]\nmax = [4, 0.1, 4]\n\
         [[joint]]\nname = 'up'\n\
         [[instance]]\npart = 'shade'\ntranslate = [20, 8, 0]\njoint = 'up'\n\
         [[track]]\ntarget = 'light.sun.color'\ntimes = [0, 1]\nvalues = [[0, 0, 0], [1, 1, 1]]\n\
         [[track]]\ntarget = 'material.paint.diffuse'\ntimes = [0, 1]\nvalues = [[1, 0, 0], [0, 1, 0]]\n\
         [[track]]\ntarget = 'joint.up.shift'\ninterpolation = 'step'\ntimes = [0, 0.5]\n\
         values = [[0, 0, 0], [-20, 0, 0]]\n",
    );
    let scene = blob.scene().expect("a scene");
    for format in Format::ALL {
        let job = job(&scene, format, 8);
        let found = blurred(&blob, &job, 48_000, 8);
        // In shadow in the second half.
        let exact = [0, 1].map(|channel| {
            let moments = (0..4).map(|moment| {
                let after = (f64::from(moment) + 0.5) / 8.0;
                after * if channel == 0 { 1.0 - after } else { after }
            });
            moments.sum::<f64>() / 8.0
        });
        for pixel in found {
            for (found, exact) in pixel.into_iter().zip(exact) {
                let found = f64::from(found) / 65_535.0;
                assert!(
                    (found - exact).abs() < 2e-3,
                    "{format:?}: {found}, exact {exact}"
                );
            }
        }
    }
}

#[test]
fn moments_that_share_no_samples_are_rejected() {
    let blob = blob(BALL);
    let scene = blob.scene().expect("a scene");
    let job = job(&scene, Format::F32, 4);
    let too_many = RenderError::Moments {
        found: 5,
        samples: 4,
    };
    for (expected, moments) in [(RenderError::NoMoments, vec![]), (too_many, vec![scene; 5])] {
        let shown = render_moments(&moments, &job, &|| ()).map(|it| it.pixels);
        assert_eq!(shown, Err(expected));
        let linear = render_linear_moments(&moments, &job, &|| ()).map(|it| it.pixels);
        assert_eq!(linear, Err(expected));
    }
    const ALL: u32 = Effects::ALL.0;
    let renderers = [8, 9].map(|width| {
        let settings = Settings {
            width,
            ..job.settings
        };
        Renderer::<f32, DualSplit, ALL>::with_settings(&scene, settings).expect("a renderer")
    });
    let error = Shutter::new(&renderers).expect_err("settings that differ");
    assert_eq!(error, RenderError::MomentSettings);
}

/// Rows and pixels of firmware are those of the host's pictures.
#[test]
fn rows_are_the_pictures() {
    let blob = blob(BALL);
    let scene = blob.scene().expect("a scene");
    let mut moved = *scene.view();
    moved.eye[0] += 1 << 22;
    let scenes = [scene, scene.with_view(&moved).expect("a view")];
    let job = job(&scene, Format::Fixed, 4);
    let expected = render_moments(&scenes, &job, &|| ())
        .expect("a picture")
        .pixels;
    let renderers = scenes.each_ref().map(|scene| {
        Renderer::<gridel_core::Fixed, DualSplit, { Effects::ALL.0 }>::with_settings(
            scene,
            job.settings,
        )
        .expect("a renderer")
    });
    let shutter = Shutter::new(&renderers).expect("a shutter");
    assert_eq!(shutter.settings(), job.settings);
    let mut space = Workspace::for_any_scene();
    let mut row = [gridel_core::Rgb888::default(); 20];
    shutter.row(3, 9, &mut row, &mut space.as_view(), &mut NoCount);
    for (x, pixel) in (3..).zip(row) {
        let linear = shutter.linear(x, 9, &mut space.as_view(), &mut NoCount);
        assert_eq!(linear, expected[9 * usize::from(SIDE) + usize::from(x)]);
        let shown: gridel_core::Rgb888 = shutter.pixel(x, 9, &mut space.as_view(), &mut NoCount);
        assert_eq!(pixel, shown);
    }
    let still = render(&scene, &job, &|| ()).expect("a picture").pixels;
    assert!(still != expected);
}
