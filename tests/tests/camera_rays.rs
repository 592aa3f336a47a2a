//! The camera's rays through pixels, inside and outside of the picture.

use gridel_core::{Effects, Format, List, Number, RayError, Renderer, Scene, Settings};
use gridel_host::compile::{Options, compile};
use gridel_tests::{every_format, measured::read};

/// The direction through the middle of a pixel, from the records of the view.
fn direction(scene: &Scene<'_>, settings: &Settings, [x, y]: [i32; 2]) -> [f64; 3] {
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
    let renderer = Renderer::<N, List, { Effects::ALL.0 }>::with_settings(scene, settings);
    let renderer = renderer.expect("a renderer");
    let pixels = |side: u16| {
        let side = i32::from(side);
        let beyond = side + side / 2;
        [
            0,
            side / 2,
            side - 1,
            side,
            beyond,
            9 * side,
            40_000,
            65_535,
        ]
        .into_iter()
        .flat_map(|pixel| [pixel, -pixel])
        .filter(|pixel| pixel.abs() < 65_536)
        .collect::<Vec<_>>()
    };
    let rows = pixels(height);
    let both = |x| rows.iter().map(move |&y| [x, y]);
    for pixel in pixels(width).into_iter().flat_map(both) {
        let ray = renderer.ray_through(pixel[0], pixel[1]);
        let slopes = ray.expect("a direction").slope().map(N::ratio_to_f64);
        let expected = direction(scene, &settings, pixel);
        let largest = expected.iter().fold(0.0, |a, b| f64::max(a, b.abs()));
        let most = match N::FORMAT {
            Format::F64 => 1e-9,
            _ => 2e-6,
        };
        let check = |slopes: [f64; 3]| {
            for (slope, expected) in slopes.into_iter().zip(expected) {
                let off = (slope - expected / largest).abs();
                let format = N::FORMAT;
                assert!(
                    off < most,
                    "{format:?} {width}x{height} {pixel:?}: {slopes:?} {off}"
                );
            }
        };
        check(slopes);
        // Pictures themselves continue by half their size.
        let [x, y] = pixel.map(u16::try_from);
        if let (Ok(x), Ok(y)) = (x, y)
            && x < width + width / 2
            && y < height + height / 2
        {
            let ray = renderer.primary_ray(x, y).expect("a direction");
            check(ray.slope().map(N::ratio_to_f64));
        }
    }
    for far in [i32::MIN, -65_536, 65_536, i32::MAX] {
        assert_eq!(
            renderer.ray_through(far, 0).err(),
            Some(RayError::Direction)
        );
        assert_eq!(
            renderer.ray_through(0, far).err(),
            Some(RayError::Direction)
        );
    }
}
