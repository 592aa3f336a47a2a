//! Explains a ray or a pixel: the nodes that are visited, the hits, and the light that they bring.
//!
//! The renderer reports events through [`Observer::event`](gridel_core::Observer::event); this module only orders
//! them. `recorder.rs` keeps them, `walk/` records a query's
//! path through a structure, and `reader.rs` finds the rays. `explanation.rs` has their sums, and `text/` writes them
//! for people.

mod explanation;
mod reader;
mod recorder;
mod text;
mod walk;

pub use crate::compile::Names;
pub use explanation::{Explanation, Hit, LightOutcome, Lighting, Ray, Sample, Weighted};
pub use text::Shown;
pub use walk::{Candidate, Culled, Plane, Side, Step, Tested, Verdict, Walk};

use crate::render::{ALL, chosen};
use crate::trace::{Frame, Rejection, SceneRay};
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::{Pixel, RenderError};
use gridel_core::{
    Effects, Fixed, Format, Number, Renderer, Rgb888, Scene, Settings, Structure, Workspace,
};
use recorder::Recorder;

/// The subject of an explanation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Subject {
    /// A pixel of the picture of the settings, from its upper left corner.
    Pixel([u16; 2]),
    /// A ray of the caller's own.
    Ray(SceneRay),
}

/// An error of an explanation.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum ExplainError {
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Ray(#[from] Rejection),
}

/// Explains a pixel or a ray.
///
/// The observed code is that of [`render`](crate::render), compiled for effects with glass or without. The other
/// effects that it is compiled for change neither bits nor paths.
///
/// # Errors
/// If the blob lacks the structure, a setting is out of its range, or the ray is invalid.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::{Format, Settings, Structure};
/// use gridel_host::explain::{Subject, explain};
///
/// let settings = Settings {
///     samples: 1,
///     ..Settings::of(&scene)
/// };
/// let middle = Subject::Pixel([settings.width / 2, settings.height / 2]);
/// let explanation = explain(&scene, Format::F32, Structure::DualSplit, settings, middle)?;
/// let hit = explanation.samples[0].rays[0].hit.as_ref().ok_or("no hit")?;
/// assert_eq!(hit.object, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn explain(
    scene: &Scene<'_>,
    format: Format,
    structure: Structure,
    settings: Settings,
    subject: Subject,
) -> Result<Explanation, ExplainError> {
    explain_first(scene, format, structure, settings, subject, usize::MAX)
}

/// Explains a pixel as [`explain`] does, but lists the rays of its first `samples` alone, so that text and memory stay
/// small. All samples count for its color.
///
/// # Errors
/// As [`explain`].
pub fn explain_first(
    scene: &Scene<'_>,
    format: Format,
    structure: Structure,
    settings: Settings,
    subject: Subject,
    samples: usize,
) -> Result<Explanation, ExplainError> {
    let scene = &chosen(scene, structure)?;
    let mut recorder = Recorder::of_first(samples);
    let linear = match format {
        Format::Fixed => watch::<Fixed>(scene, settings, subject, &mut recorder),
        Format::F32 => watch::<f32>(scene, settings, subject, &mut recorder),
        Format::F64 => watch::<f64>(scene, settings, subject, &mut recorder),
    }?;
    let mut explanation = Explanation::of(scene, format, &subject, &recorder);
    if let Subject::Pixel(pixel) = subject {
        explanation.pixel = Some(pixel);
        explanation.picture = Some([settings.width, settings.height]);
    }
    explanation.format = format.name();
    explanation.accel = structure.name();
    explanation.linear = linear;
    explanation.srgb = Rgb888::encode(linear, None).0;
    Ok(explanation)
}

/// Returns the linear color, and records what leads to it.
fn watch<N: Number>(
    scene: &Scene<'_>,
    settings: Settings,
    subject: Subject,
    recorder: &mut Recorder,
) -> Result<[u16; 3], ExplainError> {
    let renderer = Renderer::<N, DynAccel, ALL>::with_settings(scene, settings)?;
    let mut space = Box::new(Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new());
    let mut space = space.as_view();
    Ok(match subject {
        Subject::Pixel([x, y]) => renderer.linear(x, y, &mut space, recorder),
        Subject::Ray(ray) => {
            let (ray, direction_scale) = Frame::of(scene).ray::<N>(scene, &ray)?;
            recorder.begin = direction_scale.begin();
            renderer.linear_along(&ray, &mut space, recorder)
        }
    })
}
