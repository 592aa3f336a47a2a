//! What the surfaces are like that a picture shows: depth, normals, colors and numbers, pixel by pixel. Renderers call
//! these arbitrary output variables, AOVs.

use super::linear::render_linear;
use super::{ALL, Job, chosen};
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::format::record::View;
use gridel_core::render::RenderError;
use gridel_core::{Fixed, Format, NoCount, Number, Renderer, Scene, Settings, Stack, closest_hit};
use rayon::prelude::*;

/// An arbitrary output variable: a property of the surface that the ray through the middle of a pixel hits first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Aov {
    /// Distance from the eye in scene units, infinite where nothing is hit.
    Depth,
    /// The normal that the surface is shaded with, of length 1, in the scene's axes, on the side of the eye; 0 where
    /// nothing is hit.
    Normal,
    /// Diffuse reflectance, linear, of the cell where there is a checkerboard; 0 where nothing is hit.
    Albedo,
    /// The object's number in scene-file order, `u32::MAX` where nothing is hit. Objects of parts follow the scene's own.
    Object,
    /// The primitive's number in scene-file order, `u32::MAX` where nothing is hit. Those of parts follow the scene's own.
    Primitive,
    /// The instance's number in scene-file order, `u32::MAX` for the scene's own objects and where nothing is hit.
    Instance,
}

impl Aov {
    pub const ALL: [Self; 6] = [
        Self::Depth,
        Self::Normal,
        Self::Albedo,
        Self::Object,
        Self::Primitive,
        Self::Instance,
    ];

    /// The name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Albedo => "albedo",
            Self::Object => "object",
            Self::Primitive => "primitive",
            Self::Instance => "instance",
        }
    }
}

/// The values of an AOV, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Depth.
    Lengths(Vec<f32>),
    /// Normals and colors.
    Vectors(Vec<[f32; 3]>),
    /// Numbers of objects and the like.
    Numbers(Vec<u32>),
}

/// What a ray hits first.
#[derive(Clone, Copy)]
struct FirstHit {
    depth: f32,
    normal: [f32; 3],
    object: u32,
    primitive: u32,
    instance: u32,
}

impl FirstHit {
    const NONE: Self = Self {
        depth: f32::INFINITY,
        normal: [0.0; 3],
        object: u32::MAX,
        primitive: u32::MAX,
        instance: u32::MAX,
    };
}

/// Computes AOVs of some rows of a picture, in the order in which they are asked for. Of a job's settings, samples and
/// ray depth do not count: there is one ray through the middle of each pixel.
///
/// # Errors
/// If the blob lacks the structure or a setting is out of its range.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n\
/// #     [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::{Format, Settings, Structure};
/// use gridel_host::render::{Aov, Job, Values, render_aovs};
///
/// let settings = Settings {
///     width: 9,
///     height: 9,
///     ..Settings::of(&scene)
/// };
/// let job = Job::whole(Format::F64, Structure::DualSplit, settings);
/// let [Values::Lengths(depth)] = &render_aovs(&scene, &job, &[Aov::Depth])?[..] else {
///     panic!("depth is lengths");
/// };
/// // The ball's surface is at 1 unit from the origin, and the eye at 5.
/// assert!((depth[4 * 9 + 4] - 4.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn render_aovs(scene: &Scene<'_>, job: &Job, aovs: &[Aov]) -> Result<Vec<Values>, RenderError> {
    let job = &Job {
        settings: Settings {
            samples: 1,
            depth: 0,
            ..job.settings
        },
        ..job.clone()
    };
    let scene = &chosen(scene, job.structure)?;
    let hits = match job.format {
        Format::Fixed => first_hits::<Fixed>(scene, job),
        Format::F32 => first_hits::<f32>(scene, job),
        Format::F64 => first_hits::<f64>(scene, job),
    }?;
    let numbers = |of: fn(&FirstHit) -> u32| Values::Numbers(hits.iter().map(of).collect());
    let values = aovs.iter().map(|aov| {
        Ok(match aov {
            Aov::Depth => Values::Lengths(hits.iter().map(|hit| hit.depth).collect()),
            Aov::Normal => Values::Vectors(hits.iter().map(|hit| hit.normal).collect()),
            Aov::Albedo => Values::Vectors(albedo(scene, job)?),
            Aov::Object => numbers(|hit| hit.object),
            Aov::Primitive => numbers(|hit| hit.primitive),
            Aov::Instance => numbers(|hit| hit.instance),
        })
    });
    values.collect()
}

fn first_hits<N: Number>(scene: &Scene<'_>, job: &Job) -> Result<Vec<FirstHit>, RenderError> {
    let renderer = Renderer::<N, DynAccel, ALL>::with_settings(scene, job.settings)?;
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let first = |x: u16, y: u16, stack: &mut Stack<MAX_STACK_DEPTH>| {
        let ray = renderer.primary_ray(x, y).ok()?;
        let hit = closest_hit::<N, DynAccel, _>(scene, &ray, stack.as_view(), &mut NoCount)?;
        let slope = ray.slope().map(N::ratio_to_f64);
        let norm = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
        let instance = hit
            .instance()
            .and_then(|index| scene.instances().get(index as usize));
        Some(FirstHit {
            depth: (N::far_to_f64(hit.t) * norm * unit) as f32,
            normal: hit.shading_normal(scene).map(|x| x.ratio_to_f64() as f32),
            object: hit.object,
            primitive: hit.primitive,
            instance: instance.map_or(u32::MAX, |instance| instance.number),
        })
    };
    let rows = job.rows.clone().into_par_iter().map(|y| {
        let mut stack = Stack::new();
        let row = (0..job.settings.width).map(|x| first(x, y, &mut stack));
        let row = row.map(|hit| hit.unwrap_or(FirstHit::NONE));
        row.collect::<Vec<_>>()
    });
    Ok(rows.flatten_iter().collect())
}

/// The picture under white ambient light alone, on black.
fn albedo(scene: &Scene<'_>, job: &Job) -> Result<Vec<[f32; 3]>, RenderError> {
    let view = View {
        background: [0; 3],
        ambient: [1 << 20; 3],
        ..*scene.view()
    };
    let lit = scene
        .with_lights(&[])
        .and_then(|scene| scene.with_view(&view));
    let lit = lit.expect("a scene without lights requires no effect");
    Ok(render_linear(&lit, job, &|| ())?.pixels)
}

#[cfg(test)]
mod tests;
