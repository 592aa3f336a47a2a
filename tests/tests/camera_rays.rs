//! The camera's rays through pixels, inside and outside of the picture.

use gridel_core::{Format, Number, Renderer, Scene, Settings, Structure};
use gridel_host::compile::{Options, compile};
use gridel_tests::{every_format, measured::read};

/// The direction through the middle of a pixel, from the records of the view.
fn direction(scene: &Scene<'_>, settings: &Settings, [x, y]: [u16; 2]) -> [f64; 3] {
    let view = scene.view();
    let [width, height] = [settings.width, settings.height].map(f64::from);
    let right = (2.0 * (f64::from(x) + 0.5) - width) / height;
    let up = (height - 2.0 * (f64::from(y) + 0.5)) / height;
    [0, 1, 2].map(|k| {
        let [forward, across, above] =
            [view.forward, view.right, view.up].map(|it| f64::from(it[k]));
        forward + right * across + up * above
    })
}

/// Pixels of pictures of every shape, and outside of them as far as numbers of pixels go: in `fixed` directions have
/// the bits for the picture alone.
#[test]
fn pictures_continue_outside_of_their_edges() {
    for fov in [0.5, 40.0, 150.0] {
        let text = format!(
            "[camera]\neye = [1, 2, 7]\ntarget = [0, 0, 0]\nfov = {fov}\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n"
        );
        let blob = compile(&read(&text), &Options::default())
            .expect("a blob")
            .blob;
        let scene = blob.scene().expect("a scene");
        assert!(scene.holds(Structure::List));
        for size in [
            [1, 1],
            [64, 64],
            [64, 1],
            [3, 200],
            [640, 480],
            [4000, 3000],
        ] {
            every_format!(continues(&scene, size));
        }
    }
}

fn continues<N: Number>(scene: &Scene<'_>, [width, height]: [u16; 2]) {
    let settings = Settings {
        width,
        height,
        ..Settings::of(scene)
    };
    let renderer = Renderer::<N, gridel_core::List, { gridel_core::Effects::ALL.0 }>::with_settings(
        scene, settings,
    );
    let renderer = renderer.expect("a renderer");
    let pixels = |side: u16| {
        [
            0,
            side / 2,
            side - 1,
            side,
            side + 1,
            side.saturating_mul(2),
            side.saturating_mul(9),
            40_000,
            65_535,
        ]
    };
    let (columns, rows) = (pixels(width), pixels(height));
    for pixel in columns.into_iter().flat_map(|x| rows.map(|y| [x, y])) {
        let ray = renderer
            .primary_ray(pixel[0], pixel[1])
            .expect("a direction");
        let slopes = ray.slope().map(N::ratio_to_f64);
        let expected = direction(scene, &settings, pixel);
        let largest = expected.iter().fold(0.0, |a, b| f64::max(a, b.abs()));
        // The records are rounded as well; a pixel far outside is a small part of its direction.
        let inside = pixel[0] < width && pixel[1] < height;
        let most = match N::FORMAT {
            Format::F64 => 1e-9,
            _ if inside => 1e-6,
            _ => 4e-6,
        };
        for (slope, expected) in slopes.into_iter().zip(expected) {
            let off = (slope - expected / largest).abs();
            assert!(
                off < most,
                "{:?} {width}x{height} {pixel:?}: {slopes:?} {off}",
                N::FORMAT
            );
        }
    }
}
