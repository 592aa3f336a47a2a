//! Values of pixels, with their errors, compared with the values of analysis.

use crate::effort::full;
use gridel_core::{Format, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::certify::{World, code, enclose};
use gridel_host::compile::{Options, compile};
use gridel_host::render::{Job, render};
use gridel_host::scene::Scene;

/// Scrambles: the pixels of a picture, each with its own scramble.
pub const SCRAMBLES: usize = 16;

/// The keys of a picture with as many pixels, which a narrow field of view makes show nearly one point.
pub const SCRAMBLES_WIDE: &str = "width = 4\nheight = 4\n";

/// The scene of a file in TOML.
pub fn read(text: &str) -> Scene {
    let read = gridel_host::scene::read("scene.toml".as_ref(), text.into(), &Default::default());
    read.unwrap_or_else(|error| panic!("{error}: {text}")).scene
}

/// The blob of a file in TOML.
pub fn blob(text: &str) -> Blob {
    compiled(&read(text))
}

/// The blob of a scene.
pub fn compiled(scene: &Scene) -> Blob {
    let compiled = compile(scene, &Options::default());
    compiled.unwrap_or_else(|error| panic!("{error}")).blob
}

/// The mean of red of the pixels, from 0 to 1, and its standard error.
pub fn measured(blob: &Blob, format: Format, samples: u16) -> (f64, f64) {
    let ([mean, ..], error) = measured_color(blob, format, samples);
    (mean, error)
}

/// The means of the pixels' channels, from 0 to 1, and the standard error of red.
pub fn measured_color(blob: &Blob, format: Format, samples: u16) -> ([f64; 3], f64) {
    let scene = blob.scene().expect("a scene");
    let settings = Settings {
        samples,
        ..Settings::of(&scene)
    };
    let job = Job::whole(format, Structure::List, settings);
    let picture = render(&scene, &job, &|| ()).expect("a picture");
    assert_eq!(picture.pixels.len(), SCRAMBLES);
    let values = |channel: usize| {
        let channel = picture.pixels.iter().map(move |it| it[channel]);
        channel.map(|it| f64::from(it) / 65_535.0)
    };
    let mean = |channel: usize| values(channel).sum::<f64>() / SCRAMBLES as f64;
    let means = [0, 1, 2].map(mean);
    let squares: f64 = values(0).map(|value| (value - means[0]).powi(2)).sum();
    let error = (squares / (SCRAMBLES * (SCRAMBLES - 1)) as f64).sqrt();
    (means, error)
}

/// Returns by which power of the number of samples the error of a picture in `f64` falls, from 16 to 4,096 samples.
pub fn convergence(blob: &Blob) -> f64 {
    let [few, many] = [16_u16, 4096];
    let [before, after] = [few, many].map(|samples| measured(blob, Format::F64, samples).1);
    let exponent = (before / after).log2() / (f64::from(many) / f64::from(few)).log2();
    eprintln!("{before:.6} {after:.6}: N^-{exponent:.2}");
    exponent
}

/// Half a step of a pixel, and of the lattice.
pub const ROUNDING: f64 = 2e-5;

/// Each format has a value within three standard errors, and within 0.2 % (`fixed`: 0.5 %) at the most samples.
pub fn check(name: &str, blob: &Blob, exact: f64) {
    for format in Format::ALL {
        for samples in if full() {
            vec![16, 256, 4096]
        } else {
            vec![16, 256]
        } {
            let (mean, error) = measured(blob, format, samples);
            eprintln!("{name} {format:?} {samples}: {mean:.6} +- {error:.6}, exact {exact:.6}");
            let off = (mean - exact).abs();
            assert!(
                off <= 3.0 * error + ROUNDING + 2e-4 * exact,
                "{name} {format:?} {samples}"
            );
            let most = if format == Format::Fixed {
                0.005
            } else {
                0.002
            };
            assert!(
                samples < 4096 || off <= most * exact + ROUNDING,
                "{name} {format:?}"
            );
        }
    }
}

/// Returns how many pixels of a picture are proved to be off by more than one of 255, in its own size and samples.
pub fn wrong_pixels(blob: &Blob, format: Format) -> usize {
    let scene = blob.scene().expect("a scene");
    let settings = Settings::of(&scene);
    let world = World::of(&scene).expect("a scene that is known");
    let job = Job::whole(format, Structure::List, settings);
    let picture = render(&scene, &job, &|| ()).expect("a picture");
    let width = usize::from(settings.width);
    let pixels = picture.pixels.iter().enumerate();
    let wrong = pixels.filter(|&(index, &linear)| {
        let pixel = [index % width, index / width].map(|it| it as u16);
        let error = enclose(&world, &settings, pixel, 2).error_of(code(linear));
        error.is_some_and(|it| it > 1)
    });
    wrong.count()
}
