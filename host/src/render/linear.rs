//! Pictures in linear radiance, which no display's range limits.

use super::{ALL, Job, all_chosen, renderers};
use crate::observed::Observed;
use crate::srgb::linear_of_srgb;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::format::record::View;
use gridel_core::render::{RenderError, Shutter};
use gridel_core::{Effects, Fixed, Format, Number, Scene, Workspace};
use rayon::prelude::*;
use std::ops::Range;
use std::slice::from_ref;

/// Some rows of a picture in linear radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearPicture {
    pub width: u16,
    /// Rows of the whole picture that these are.
    pub rows: Range<u16>,
    /// Red, green and blue, row by row, 1 being display white: the sums of the light of all rays. In `fixed` one ray
    /// brings at most 2,048.
    pub pixels: Vec<[f32; 3]>,
}

/// Renders some rows in linear radiance. Calls `progress` after every row, from any thread.
///
/// Samples are averaged as they are, where [`render`](super::render()) limits each to display white first. Where
/// colors are display values (see `View::encoding`), their mean is decoded by the curve of sRGB, continued above 1.
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
    render_linear_moments(from_ref(scene), job, progress)
}

/// Renders some rows of a scene that moves in linear radiance, at several moments while a shutter is open: see
/// [`render_moments`](super::render_moments). Calls `progress` after every row, from any thread.
///
/// # Errors
/// If the blob lacks the structure, a setting is out of its range, or there are more moments than samples per pixel.
pub fn render_linear_moments(
    moments: &[Scene<'_>],
    job: &Job,
    progress: &(dyn Fn() + Sync),
) -> Result<LinearPicture, RenderError> {
    let moments = &all_chosen(moments, job.structure)?;
    let pixels = match job.format {
        Format::Fixed => rows::<Fixed>(moments, job, progress),
        Format::F32 => rows::<f32>(moments, job, progress),
        Format::F64 => rows::<f64>(moments, job, progress),
    }?;
    Ok(LinearPicture {
        width: job.settings.width,
        rows: job.rows.clone(),
        pixels,
    })
}

fn rows<N: Number>(
    moments: &[Scene<'_>],
    job: &Job,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<[f32; 3]>, RenderError> {
    let renderers = renderers::<N, DynAccel, ALL>(moments, job)?;
    let shutter = Shutter::new(&renderers)?;
    let (width, samples) = (job.settings.width, f64::from(job.settings.samples));
    let is_display_value = moments
        .iter()
        .any(|scene| scene.view().encoding == View::DISPLAY_VALUES);
    let mut pixels = vec![[0.0; 3]; usize::from(width) * job.rows.len()];
    let rows = job.rows.clone().into_par_iter();
    rows.zip(pixels.par_chunks_mut(width.into()))
        .for_each(|(y, row)| {
            let mut space = Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
            let mut space = space.as_view();
            for (x, pixel) in (0..width).zip(row) {
                let mut observed = Observed::default();
                shutter.linear(x, y, &mut space, &mut observed);
                *pixel = observed.radiance.map(|sum| {
                    let mean = sum / samples;
                    let linear = if is_display_value {
                        linear_of_srgb(mean)
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

#[cfg(test)]
mod tests;
