//! The result of certifying a picture: for the command, for manifests and for the page.

use super::picture::{Enclosed, LEVELS, code, enclose};
use super::reason::Reason;
use super::world::{NONE, World};
use crate::render::{Job, render};
use crate::trace::Frame;
use gridel_core::render::RenderError;
use gridel_core::{Format, Scene, Settings, Structure};
use rayon::prelude::*;
use serde::Serialize;
use std::sync::{Mutex, PoisonError};

/// The store of pixels as they are done.
struct Kept<'p, F> {
    pixels: &'p mut [Enclosed],
    keep: F,
    /// For each row, the number of pixels that are not done.
    open: Vec<usize>,
}

/// Encloses the pixels of a picture that are not yet done. Calls `progress` once for every row, and `keep` after every
/// pixel that was not done, from any thread. An error of `keep` ends the work.
///
/// # Errors
/// Those of `keep`.
///
/// # Panics
/// If there are not as many pixels as the settings say.
pub fn certify<E: Send>(
    world: &World<'_>,
    settings: &Settings,
    pixels: &mut [Enclosed],
    progress: &(dyn Fn() + Sync),
    keep: impl FnMut(&[Enclosed]) -> Result<(), E> + Send,
) -> Result<(), E> {
    let width = usize::from(settings.width);
    assert_eq!(pixels.len(), width * usize::from(settings.height));
    let not_done = |&index: &usize| pixels[index].done == 0;
    let indices: Vec<usize> = (0..pixels.len()).filter(not_done).collect();
    let mut open = vec![0; settings.height.into()];
    indices.iter().for_each(|index| open[index / width] += 1);
    open.iter()
        .filter(|&&open| open == 0)
        .for_each(|_| progress());
    let kept = Mutex::new(Kept { pixels, keep, open });
    indices.into_par_iter().try_for_each(|index| {
        let [x, y] = [index % width, index / width];
        let pixel = enclose(world, settings, [x as u16, y as u16], LEVELS.len());
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        let Kept { pixels, keep, open } = &mut *kept;
        pixels[index] = pixel;
        open[y] -= 1;
        if open[y] == 0 {
            progress();
        }
        keep(pixels)
    })
}

/// A picture in a format: linear values, 65535 being display white.
pub type FormatPicture = (Format, Vec<[u16; 3]>);

/// Renders a picture in some formats, to compare with the exact one.
///
/// # Errors
/// If no picture has these settings.
pub fn pictures(
    scene: &Scene<'_>,
    structure: Structure,
    settings: Settings,
    formats: &[Format],
) -> Result<Vec<FormatPicture>, RenderError> {
    let picture = |&format: &Format| {
        let job = Job::whole(format, structure, settings);
        let picture = render(scene, &job, &|| ())?;
        Ok((format, picture.pixels))
    };
    formats.iter().map(picture).collect()
}

/// The report of a picture.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub size: [u16; 2],
    /// Per pixel: it is the sampled picture that is certified, not the integral behind it.
    pub samples: u16,
    pub ray_depth: u8,
    pub pixels: usize,
    pub proved: usize,
    /// Pixels proved, as a part of all.
    pub certified: f64,
    /// Pixels proved with numbers of 53, 128 and 256 bits.
    pub proved_with_bits: Vec<(usize, usize)>,
    /// The reasons why the others are open.
    pub reasons: Vec<OpenPixels>,
    pub widths: Vec<Width>,
    pub formats: Vec<FormatReport>,
}

/// The pixels that are open for one reason.
#[derive(Clone, Debug, Serialize)]
pub struct OpenPixels {
    pub reason: Reason,
    pub text: &'static str,
    pub pixels: usize,
    /// Open pixels whose ray lies on the boundary as far as 256 bits can decide.
    pub on_boundary: usize,
    /// All of them, row by row.
    pub open_pixels: Vec<OpenPixel>,
}

/// An open pixel.
#[derive(Clone, Debug, Serialize)]
pub struct OpenPixel {
    pub pixel: [usize; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub primitive: Option<u32>,
    /// In scene units; none where everything is known but the rounding.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<[f64; 3]>,
    pub depth: u8,
}

/// Pixels whose interval is at most so wide.
#[derive(Clone, Debug, Serialize)]
pub struct Width {
    /// The largest channel's width is at most this power of ten.
    pub power: i32,
    pub pixels: usize,
}

/// A number format against the exact picture.
#[derive(Clone, Debug, Serialize)]
pub struct FormatReport {
    pub format: &'static str,
    /// Pixels proved to be the exact ones.
    pub equal: usize,
    /// Pixels proved to be others.
    pub different: usize,
    pub open: usize,
    /// The largest proved difference of a channel, in 255ths.
    pub max_proved_error: u8,
    /// The pixel with that difference.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<[usize; 2]>,
    /// Pixels by their proved difference in 255ths, from 1.
    pub by_error: Vec<(u8, usize)>,
    /// All pixels proved to be others, row by row.
    pub different_pixels: Vec<DifferentPixel>,
}

/// A pixel of a format that is proved to differ from the exact one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct DifferentPixel {
    pub pixel: [usize; 2],
    /// The largest proved difference of a channel, in 255ths.
    pub error: u8,
}

/// The narrowest power of ten that is counted on its own.
const NARROWEST: i32 = -17;

impl Report {
    /// Returns the report of pixels and of pictures in some formats, as 16-bit values.
    pub fn of(
        world: &World<'_>,
        settings: &Settings,
        pixels: &[Enclosed],
        pictures: &[FormatPicture],
    ) -> Self {
        let frame = Frame::of(world.scene);
        let width = usize::from(settings.width);
        let place = |index: usize| [index % width, index / width];
        let proved = pixels.iter().filter(|it| it.proved().is_some()).count();
        let with_bits = |level: usize| {
            let with = |it: &&Enclosed| it.proved().is_some() && usize::from(it.level) == level;
            (LEVELS[level], pixels.iter().filter(with).count())
        };
        let mut reasons = Vec::new();
        for reason in Reason::ALL {
            let is_open = |it: &Enclosed| it.proved().is_none() && it.reason() == Some(reason);
            let open = || pixels.iter().enumerate().filter(|(_, it)| is_open(it));
            let count = open().count();
            if count == 0 {
                continue;
            }
            let open_pixel = |(index, it): (usize, &Enclosed)| OpenPixel {
                pixel: place(index),
                primitive: (it.primitive != NONE).then_some(it.primitive),
                point: it.point().map(|point| frame.place(point).to_array()),
                depth: it.depth,
            };
            reasons.push(OpenPixels {
                reason,
                text: reason.text(),
                pixels: count,
                on_boundary: open().filter(|(_, it)| it.on_boundary == 1).count(),
                open_pixels: open().map(open_pixel).collect(),
            });
        }
        reasons.sort_by_key(|it| std::cmp::Reverse(it.pixels));
        let power = |it: &Enclosed| match it.width() {
            width if width > 0.0 => (libm::log10(width).ceil() as i32).clamp(NARROWEST, 0),
            _ => NARROWEST,
        };
        let widths = (NARROWEST..=0).map(|of| Width {
            power: of,
            pixels: pixels.iter().filter(|it| power(it) == of).count(),
        });
        let formats = pictures.iter().map(|(format, picture)| {
            let errors: Vec<Option<u8>> = pixels
                .iter()
                .zip(picture)
                .map(|(it, &linear)| it.error_of(code(linear)))
                .collect();
            let most = errors.iter().flatten().copied().max().unwrap_or(0);
            let with = |error: u8| errors.iter().filter(|&&it| it == Some(error)).count();
            let worst = errors.iter().position(|&it| it == Some(most) && most > 0);
            let different = errors.iter().enumerate().filter_map(|(index, it)| {
                let error = it.filter(|&error| error > 0)?;
                let pixel = place(index);
                Some(DifferentPixel { pixel, error })
            });
            FormatReport {
                format: format.name(),
                equal: with(0),
                different: different.clone().count(),
                different_pixels: different.collect(),
                open: errors.iter().filter(|it| it.is_none()).count(),
                max_proved_error: most,
                worst: worst.map(place),
                by_error: (1..=most)
                    .map(|error| (error, with(error)))
                    .filter(|(_, count)| *count > 0)
                    .collect(),
            }
        });
        Self {
            size: [settings.width, settings.height],
            samples: settings.samples,
            ray_depth: settings.depth,
            pixels: pixels.len(),
            proved,
            certified: proved as f64 / pixels.len().max(1) as f64,
            proved_with_bits: (0..LEVELS.len()).map(with_bits).collect(),
            reasons,
            widths: widths.collect(),
            formats: formats.collect(),
        }
    }
}

/// Returns a picture of the results: gray where all formats are proved equal, orange where one is proved different,
/// blue where a pixel is open. As sRGB pixels.
pub fn map(pixels: &[Enclosed], pictures: &[FormatPicture]) -> Vec<u8> {
    let color = |index: usize, it: &Enclosed| -> [u8; 3] {
        let errors = pictures
            .iter()
            .map(|(_, all)| it.error_of(code(all[index])));
        let most = errors.clone().flatten().max().unwrap_or(0);
        match most {
            2.. => [200, 30, 20],
            1 => [240, 150, 40],
            0 if it.proved().is_none() => [40, 90, 220],
            _ => it.low.map(|x| 110 + x / 4),
        }
    };
    let all = pixels.iter().enumerate();
    all.flat_map(|(index, it)| color(index, it)).collect()
}

/// Returns the exact picture: proved values, and the middle of the bounds elsewhere. As sRGB pixels.
pub fn exact_picture(pixels: &[Enclosed]) -> Vec<u8> {
    let middle = |it: &Enclosed| [0, 1, 2].map(|k| it.low[k].midpoint(it.high[k]));
    pixels.iter().flat_map(middle).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};

    const FILE: &str = "[render]\nwidth = 6\nheight = 4\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";

    fn with_world(test: impl FnOnce(&World<'_>, &Settings)) {
        let imported = crate::scene::read("ball.toml".as_ref(), FILE.into(), &Default::default());
        let blob = compile(&imported.unwrap().scene, &Options::default());
        let blob = blob.unwrap().blob;
        let scene = blob.scene().unwrap();
        let world = World::of(&scene).unwrap_or_else(|unknown| panic!("{unknown}"));
        test(&world, &Settings::of(&scene));
    }

    #[test]
    fn every_pixel_that_is_done_is_kept_at_once() {
        with_world(|world, settings| {
            let mut pixels = vec![Enclosed::default(); 24];
            let mut counts = Vec::new();
            let stopped = certify(world, settings, &mut pixels, &|| (), |pixels| {
                counts.push(pixels.iter().filter(|it| it.done == 1).count());
                if counts.len() < 3 { Ok(()) } else { Err(()) }
            });
            assert_eq!(stopped, Err(()));
            assert_eq!(counts[..3], [1, 2, 3]);
            let before = pixels.iter().filter(|it| it.done == 1).count();
            let (mut more, rows) = (0, std::sync::atomic::AtomicUsize::new(0));
            let count_row = || {
                rows.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            };
            let Ok(()) = certify(world, settings, &mut pixels, &count_row, |_| {
                more += 1;
                Ok::<_, std::convert::Infallible>(())
            });
            assert_eq!((before + more, rows.into_inner()), (24, 4));
            assert!(pixels.iter().all(|it| it.done == 1));
        });
    }

    #[test]
    fn reports_list_all_different_and_open_pixels() {
        with_world(|world, settings| {
            let known = Enclosed {
                done: 1,
                ..Enclosed::default()
            };
            let open = Enclosed {
                high: [255; 3],
                reason: Reason::Hit as u8,
                point: [3.0, 0.0, 0.0],
                has_point: 1,
                ..known
            };
            let mut pixels = [known; 24];
            pixels[9..24].fill(open);
            pixels[10] = Enclosed {
                has_point: 0,
                ..open
            };
            let mut picture = vec![[0; 3]; 24];
            picture[2] = [u16::MAX; 3];
            picture[7] = [0, u16::MAX, 0];
            let report = Report::of(world, settings, &pixels, &[(Format::F32, picture)]);
            let of = |pixel| DifferentPixel { pixel, error: 255 };
            assert_eq!(report.formats[0].different_pixels, [of([2, 0]), of([1, 1])]);
            let listed = &report.reasons[0].open_pixels;
            assert_eq!(listed.len(), 15);
            // A place in lattice units is written in scene units.
            let header = world.scene.header();
            let x = header.origin[0] + libm::ldexp(3.0, header.unit_exponent.into());
            assert_eq!(listed[0].point.map(|it| it[0]), Some(x));
            // Without an open comparison there is no place, as the lattice's origin would be.
            assert_eq!(listed[1].point, None);
        });
    }
}
