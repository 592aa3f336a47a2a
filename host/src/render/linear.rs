//! Pictures in linear radiance, which no display's range limits.

use super::{ALL, Job, chosen};
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::{MAX_RAY_DEPTH, MAX_STACK_DEPTH};
use gridel_core::render::RenderError;
use gridel_core::{Event, Fixed, Format, Number, Observer, Renderer, Scene, Workspace};
use rayon::prelude::*;
use std::ops::Range;

/// Some rows of a picture in linear radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearPicture {
    pub width: u16,
    /// Rows of the whole picture that these are.
    pub rows: Range<u16>,
    /// Red, green and blue, row by row, 1 being display white: 0 to some 1e5, the sums of all that rays bring.
    pub pixels: Vec<[f32; 3]>,
}

/// Renders some rows in linear radiance. Calls `progress` after every row, from any thread.
///
/// Samples are averaged as they are, where [`render`](super::render()) limits each to display white first. Where
/// colors are display values (see `View::display_values`), their mean is decoded by the curve of sRGB, continued above 1.
/// Work is not counted.
///
/// # Errors
/// If the blob lacks the structure or a setting is out of its range.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[light]]\nkind = 'directional'\ndirection = [0, 0, -1]\ncolor = [40, 40, 40]\n\
/// #     [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::{Format, Settings, Structure};
/// use gridel_host::render::{Job, render_linear};
///
/// let settings = Settings {
///     width: 8,
///     height: 6,
///     ..Settings::of(&scene)
/// };
/// let job = Job::whole(Format::F32, Structure::DualSplit, settings);
/// let picture = render_linear(&scene, &job, &|| ())?;
/// let [red, ..] = picture.pixels[3 * 8 + 4];
/// assert!(red > 20.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn render_linear(
    scene: &Scene<'_>,
    job: &Job,
    progress: &(dyn Fn() + Sync),
) -> Result<LinearPicture, RenderError> {
    let scene = &chosen(scene, job.structure)?;
    let pixels = match job.format {
        Format::Fixed => rows::<Fixed>(scene, job, progress),
        Format::F32 => rows::<f32>(scene, job, progress),
        Format::F64 => rows::<f64>(scene, job, progress),
    }?;
    Ok(LinearPicture {
        width: job.settings.width,
        rows: job.rows.clone(),
        pixels,
    })
}

/// The sum of what rays bring to the samples of a pixel.
#[derive(Default)]
struct Radiance([f64; 3]);

impl Observer for Radiance {
    const ENABLED: bool = true;

    #[inline(always)]
    fn event(&mut self, event: Event) {
        if let Event::Added { radiance, .. } = event {
            for (sum, brought) in self.0.iter_mut().zip(radiance) {
                *sum += brought;
            }
        }
    }
}

fn rows<N: Number>(
    scene: &Scene<'_>,
    job: &Job,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<[f32; 3]>, RenderError> {
    let renderer = Renderer::<N, DynAccel, ALL>::with_settings(scene, job.settings)?;
    let (width, samples) = (job.settings.width, f64::from(job.settings.samples));
    let is_display_value = scene.view().display_values != 0;
    let mut pixels = vec![[0.0; 3]; usize::from(width) * job.rows.len()];
    let rows = job.rows.clone().into_par_iter();
    rows.zip(pixels.par_chunks_mut(width.into()))
        .for_each(|(y, row)| {
            let mut space = Workspace::<N, MAX_STACK_DEPTH, { MAX_RAY_DEPTH + 1 }>::new();
            let mut space = space.as_view();
            for (x, pixel) in (0..width).zip(row) {
                let mut sum = Radiance::default();
                renderer.linear(x, y, &mut space, &mut sum);
                *pixel = sum.0.map(|sum| {
                    let mean = sum / samples;
                    let linear = if is_display_value {
                        decoded(mean)
                    } else {
                        mean
                    };
                    linear as f32
                });
            }
            progress();
        });
    Ok(pixels)
}

/// The linear value of a display value, by the curve of sRGB (IEC 61966-2-1), which goes on above 1.
fn decoded(value: f64) -> f64 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        // The same bits on every host, unlike the standard library's.
        libm::pow((value + 0.055) / 1.055, 2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::super::render;
    use super::*;
    use crate::compile::{Options, compile};
    use crate::scene;
    use gridel_core::{Settings, Structure};

    /// Two balls, one of them a mirror, under a strong and a weak light.
    const BALLS: &str = "
        background = [0.25, 0.5, 3.0]
        [camera]
        eye = [0, 1, 6]
        target = [0, 0, 0]
        fov = 40
        [[light]]
        kind = 'directional'
        direction = [-1, -1, -1]
        color = [9.0, 0.5, 0.25]
        [material.mirror]
        diffuse = [0.1, 0.1, 0.1]
        mirror = [0.8, 0.8, 0.8]
        [[object]]
        kind = 'sphere'
        center = [-1, 0, 0]
        radius = 1
        [[object]]
        kind = 'sphere'
        center = [1.2, 0, 0]
        radius = 1
        material = 'mirror'";

    fn with_scene(text: &str, test: impl FnOnce(&Scene<'_>)) {
        let read = scene::read("test.toml".as_ref(), text.into(), &Default::default());
        let options = Options {
            structures: vec![Structure::DualSplit, Structure::Wide, Structure::Flagged],
            ..Options::default()
        };
        let compiled = compile(&read.expect("a scene").scene, &options).expect("a blob");
        test(&compiled.blob.scene().expect("a scene"));
    }

    fn job(scene: &Scene<'_>, format: Format, samples: u16) -> Job {
        let settings = Settings {
            width: 48,
            height: 32,
            samples,
            ..Settings::of(scene)
        };
        Job::whole(format, Structure::DualSplit, settings)
    }

    fn linear(scene: &Scene<'_>, job: &Job) -> Vec<[f32; 3]> {
        render_linear(scene, job, &|| ()).expect("a picture").pixels
    }

    /// With one sample a display shows the radiance, limited to white.
    #[test]
    fn displays_show_the_limited_radiance() {
        with_scene(BALLS, |scene| {
            for format in Format::ALL {
                let job = job(scene, format, 1);
                let shown = render(scene, &job, &|| ()).expect("a picture").pixels;
                let linear = linear(scene, &job);
                assert!(linear.iter().any(|pixel| pixel[0] > 4.0), "{format:?}");
                for (shown, linear) in shown.iter().flatten().zip(linear.iter().flatten()) {
                    let limited = f64::from(*linear).clamp(0.0, 1.0) * 65535.0;
                    let apart = (f64::from(*shown) - limited).abs();
                    assert!(apart <= 1.0, "{format:?}: {shown} for {limited}");
                }
            }
        });
    }

    #[test]
    fn backgrounds_and_ambient_light_come_out_as_the_scene_states_them() {
        let scene = "
            background = [0.25, 0.5, 3.0]
            ambient = [2.0, 4.0, 8.0]
            [material.gray]
            diffuse = [0.5, 0.25, 0.125]
            [[object]]
            kind = 'sphere'
            center = [0, 0, 0]
            radius = 1
            material = 'gray'";
        with_scene(scene, |scene| {
            for format in Format::ALL {
                for samples in [1, 5] {
                    let pixels = linear(scene, &job(scene, format, samples));
                    let near = |pixel: [f32; 3], expected: [f32; 3]| {
                        let apart = |k: usize| (pixel[k] - expected[k]).abs();
                        assert!((0..3).all(|k| apart(k) < 1e-4), "{format:?}: {pixel:?}");
                    };
                    near(pixels[0], [0.25, 0.5, 3.0]);
                    near(pixels[16 * 48 + 24], [1.0; 3]);
                }
            }
        });
    }

    #[test]
    fn bits_depend_on_neither_structure_nor_rows() {
        with_scene(BALLS, |scene| {
            for format in Format::ALL {
                let whole = job(scene, format, 3);
                let expected = linear(scene, &whole);
                for structure in [Structure::List, Structure::Wide, Structure::Flagged] {
                    let other = Job {
                        structure,
                        ..whole.clone()
                    };
                    assert!(linear(scene, &other) == expected, "{structure:?}");
                }
                let part = Job {
                    rows: 7..9,
                    ..whole
                };
                assert!(linear(scene, &part) == expected[7 * 48..9 * 48]);
            }
        });
    }

    /// A scene of display values shows what it states, and its linear picture is what displays of sRGB make of it.
    #[test]
    fn display_values_are_decoded() {
        let nff = "b 0.5 0.25 1\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 48 32\n\
                   l 3 4 5\nf 1 .75 .33 .8 0 0 0 1\ns 0 0 0 .5\n";
        let read = scene::read("ball.nff".as_ref(), nff.into(), &Default::default());
        let compiled = compile(&read.expect("a scene").scene, &Options::default());
        let blob = compiled.expect("a blob").blob;
        let scene = blob.scene().expect("a scene");
        let job = job(&scene, Format::F64, 1);
        let corner = linear(&scene, &job)[0];
        for (linear, exact) in corner.into_iter().zip([0.214_041_14, 0.050_876_09, 1.0]) {
            assert!((linear - exact).abs() < 1e-5, "{linear} for {exact}");
        }
        assert!((decoded(2.0) - 4.953_846).abs() < 1e-4);
    }
}
