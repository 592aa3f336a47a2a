//! Renders pictures from a blob on all cores.
//!
//! Rows are spread over threads. A pixel depends only on the blob, the number format and the settings. So a picture is
//! the same, bit for bit, with any number of threads.

mod aov;
mod first_hits;
mod first_surfaces;
mod linear;

pub use aov::{Aov, Values, render_aovs};
pub(crate) use first_hits::{PixelHit, first_hits};
pub use linear::{LinearPicture, render_linear, render_linear_moments};

use crate::observed::Observed;
use crate::table::grouped;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::{RenderError, Shutter};
use gridel_core::{
    Accel, Counters, DualSplit, Effects, Fixed, Format, NoCount, Number, Observer, Renderer, Scene,
    Settings, Structure, Wide, Workspace,
};
use rayon::prelude::*;
use std::ops::Range;
use std::slice::from_ref;

/// Most pixels of a picture in memory at once.
pub const MOST_PIXELS: usize = 1 << 26;

/// Returns a clause about a picture of more than `most` pixels; `None` for others.
#[doc(hidden)]
pub fn too_many_pixels(size: [u16; 2], most: usize) -> Option<String> {
    let [width, height] = size.map(usize::from);
    (width * height > most).then(|| {
        let [pixels, most] = [width * height, most].map(grouped);
        format!("{pixels} pixels exceed the largest size of {most}")
    })
}

/// Linear pixels of some rows of a picture, and what they cost.
#[derive(Clone, Debug)]
pub struct Picture {
    pub width: u16,
    /// Height of the whole picture.
    pub height: u16,
    /// Rows of the whole picture that these are.
    pub rows: Range<u16>,
    /// Row by row, 65535 being white.
    pub pixels: Vec<[u16; 3]>,
    /// All work, if it was counted.
    pub counters: Option<Counters>,
    /// Boxes and primitives tested for each pixel, if work was counted.
    pub work: Vec<u32>,
}

/// The settings of a picture, or of some of its rows.
#[derive(Clone, Debug)]
pub struct Job {
    pub format: Format,
    pub structure: Structure,
    pub settings: Settings,
    pub rows: Range<u16>,
    pub count: bool,
}

impl Job {
    /// Returns all rows, without counting.
    pub fn whole(format: Format, structure: Structure, settings: Settings) -> Self {
        Self {
            format,
            structure,
            settings,
            rows: 0..settings.height,
            count: false,
        }
    }
}

/// Renders some rows. Calls `progress` after every row, from any thread.
///
/// # Errors
/// If the blob lacks the structure or a setting is out of its range.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::{Format, Settings, Structure};
/// use gridel_host::render::{Job, render};
///
/// let settings = Settings {
///     width: 8,
///     height: 6,
///     ..Settings::of(&scene)
/// };
/// let job = Job::whole(Format::Fixed, Structure::DualSplit, settings);
/// let picture = render(&scene, &job, &|| ())?;
/// assert_eq!(picture.pixels.len(), 48);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn render(
    scene: &Scene<'_>,
    job: &Job,
    progress: &(dyn Fn() + Sync),
) -> Result<Picture, RenderError> {
    render_moments(from_ref(scene), job, progress)
}

/// Renders some rows of a scene that moves, at several moments while a shutter is open: see [`Shutter`]. Calls
/// `progress` after every row, from any thread.
///
/// # Errors
/// If the blob lacks the structure, a setting is out of its range, or there are more moments than samples per pixel.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'\n\
/// #     [camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n\
/// #     [[track]]\ntarget = 'camera.orbit'\ntimes = [0, 4]\nvalues = [0, 360]";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::{Format, Settings, Structure, Tracks};
/// use gridel_host::render::{Job, render_moments};
/// use gridel_host::state::{State, exposed};
///
/// let tracks = Tracks::from_bytes(blob.bytes())?;
/// // The first tenth of a second, in four steps.
/// let states = exposed(0, tracks.ticks_per_second() / 10, 4).map(|time| State::at(&blob, &scene, &tracks, time));
/// let states = states.collect::<Result<Vec<_>, _>>()?;
/// let moments = states.iter().map(|state| state.apply(&scene));
/// let moments = moments.collect::<Result<Vec<_>, _>>()?;
///
/// let settings = Settings {
///     width: 8,
///     height: 6,
///     samples: 16,
///     ..Settings::of(&scene)
/// };
/// let job = Job::whole(Format::F32, Structure::DualSplit, settings);
/// let picture = render_moments(&moments, &job, &|| ())?;
/// assert_eq!(picture.pixels.len(), 48);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn render_moments(
    moments: &[Scene<'_>],
    job: &Job,
    progress: &(dyn Fn() + Sync),
) -> Result<Picture, RenderError> {
    let moments = all_chosen(moments, job.structure)?;
    Ok(spread(job, progress, &*tracer(&moments, job)?))
}

/// Returns the code that traces pixels, compiled for the job's number format and structure and for the scene's
/// effects. The structure is chosen in the moments: see [`chosen`].
///
/// Inline in WebAssembly alone: the page's crate then compiles this code by its own profile. Elsewhere each crate that
/// calls it would compile all of this code again.
#[cfg_attr(target_family = "wasm", inline)]
pub(crate) fn tracer<'s>(moments: &'s [Scene<'_>], job: &Job) -> NewTracer<'s> {
    match job.format {
        Format::Fixed => with_format::<Fixed>(moments, job),
        Format::F32 => with_format::<f32>(moments, job),
        Format::F64 => with_format::<f64>(moments, job),
    }
}

/// Fills a part of a row, given its first pixel, and may return its cost.
pub(crate) type Tracer<'s> = dyn Fn([u16; 2], &mut [[u16; 3]]) -> Option<Cost> + Sync + 's;

/// The cost of a part of a row in total, and of each of its pixels.
pub(crate) type Cost = (Counters, Vec<u32>);

/// Returns a new tracer, or the reason why there is none.
type NewTracer<'s> = Result<Box<Tracer<'s>>, RenderError>;

/// Sets of effects that the ray loop is compiled for; a scene gets the first that has all of its.
const SHADOWED: u32 = Effects::SHADOW.0;
pub(crate) const ALL: u32 = Effects::ALL.0;

/// WebAssembly is downloaded by pages, so it has no second code for the same work: the code that counts draws all
/// pictures.
const PAGE: bool = cfg!(target_family = "wasm");

/// True if no structure has code of its own. The library's own tests compile all of it again.
const COMPACT: bool = PAGE || cfg!(test);

fn with_format<'s, N: Number>(moments: &'s [Scene<'_>], job: &Job) -> NewTracer<'s> {
    if PAGE || job.count {
        return counted_rows::<N>(moments, job);
    }
    match job.structure {
        // Pictures are made through these; the others are there to be compared.
        Structure::DualSplit if !COMPACT => fast::<N, DualSplit>(moments, job),
        Structure::Wide if !COMPACT => fast::<N, Wide>(moments, job),
        _ => rows::<N, DynAccel, ALL>(moments, job),
    }
}

/// Renderers of the moments, which a shutter accepts.
fn renderers<'s, N: Number, A: Accel, const EFFECTS: u32>(
    moments: &'s [Scene<'s>],
    job: &Job,
) -> Result<Vec<Renderer<'s, 's, N, A, EFFECTS>>, RenderError> {
    let renderers = moments
        .iter()
        .map(|scene| Renderer::with_settings(scene, job.settings));
    let renderers = renderers.collect::<Result<Vec<_>, _>>()?;
    Shutter::new(&renderers)?;
    Ok(renderers)
}

/// The moments with a structure chosen: see [`chosen`].
fn all_chosen<'a>(
    moments: &[Scene<'a>],
    structure: Structure,
) -> Result<Vec<Scene<'a>>, RenderError> {
    moments
        .iter()
        .map(|scene| chosen(scene, structure))
        .collect()
}

/// The scene with a structure chosen for [`DynAccel`] to walk.
pub(crate) fn chosen<'a>(
    scene: &Scene<'a>,
    structure: Structure,
) -> Result<Scene<'a>, RenderError> {
    let chosen = scene.choose(structure);
    chosen.ok_or(RenderError::Structure(structure))
}

/// Returns a tracer through one structure. Plain scenes get one without code for effects that they do not use.
fn fast<'s, N: Number, A: Accel + 's>(moments: &'s [Scene<'_>], job: &Job) -> NewTracer<'s> {
    let plain = moments
        .iter()
        .all(|scene| Effects(SHADOWED).contains(scene.effects()));
    if plain {
        rows::<N, A, SHADOWED>(moments, job)
    } else {
        rows::<N, A, ALL>(moments, job)
    }
}

fn counted_rows<'s, N: Number>(moments: &'s [Scene<'_>], job: &Job) -> NewTracer<'s> {
    let renderers = renderers::<N, DynAccel, ALL>(moments, job)?;
    let count = job.count;
    Ok(Box::new(move |first, pixels| {
        let cost = counted_row(&renderers, first, pixels);
        count.then_some(cost)
    }))
}

fn rows<'s, N: Number, A: Accel + 's, const EFFECTS: u32>(
    moments: &'s [Scene<'_>],
    job: &Job,
) -> NewTracer<'s> {
    let renderers = renderers::<N, A, EFFECTS>(moments, job)?;
    Ok(Box::new(move |first, pixels| {
        render_row(&renderers, first, pixels, || NoCount, |_| ());
        None
    }))
}

/// Spreads rows over all threads.
fn spread(job: &Job, progress: &(dyn Fn() + Sync), tracer: &Tracer<'_>) -> Picture {
    let width = job.settings.width;
    let mut pixels = vec![[0; 3]; usize::from(width) * job.rows.len()];
    let costs: Vec<Option<Cost>> = job
        .rows
        .clone()
        .into_par_iter()
        .zip(pixels.par_chunks_mut(width.into()))
        .map(|(y, pixels)| {
            let cost = tracer([0, y], pixels);
            progress();
            cost
        })
        .collect();
    let costs: Vec<Cost> = costs.into_iter().flatten().collect();
    let sum = |sum: Counters, (row, _): &Cost| sum.plus(row);
    Picture {
        width,
        height: job.settings.height,
        rows: job.rows.clone(),
        pixels,
        counters: job
            .count
            .then(|| costs.iter().fold(Counters::default(), sum)),
        work: costs.into_iter().flat_map(|(_, work)| work).collect(),
    }
}

/// A part of a row, and its cost.
fn counted_row<N: Number, A: Accel, const EFFECTS: u32>(
    renderers: &[Renderer<'_, '_, N, A, EFFECTS>],
    first: [u16; 2],
    pixels: &mut [[u16; 3]],
) -> Cost {
    let mut work = Vec::with_capacity(pixels.len());
    let mut total = Counters::default();
    let counted = |Observed { counters, .. }: Observed<'_>| {
        work.push((counters.boxes + counters.primitives).min(u32::MAX.into()) as u32);
        total = total.plus(&counters);
    };
    render_row(renderers, first, pixels, Observed::default, counted);
    (total, work)
}

/// A part of a row; every pixel is counted on its own.
fn render_row<N: Number, A: Accel, C: Observer, const EFFECTS: u32>(
    renderers: &[Renderer<'_, '_, N, A, EFFECTS>],
    [x, y]: [u16; 2],
    pixels: &mut [[u16; 3]],
    counter: impl Fn() -> C,
    mut counted: impl FnMut(C),
) {
    let shutter = Shutter::new(renderers).expect("what a shutter accepted before");
    let mut space = Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let mut space = space.as_view();
    for (x, pixel) in (x..=u16::MAX).zip(pixels) {
        let mut count = counter();
        *pixel = shutter.linear(x, y, &mut space, &mut count);
        counted(count);
    }
}

#[cfg(test)]
mod test_pictures;
#[cfg(test)]
mod tests;
