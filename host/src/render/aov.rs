//! Properties of the surfaces that a picture shows: depth, normals, colors and numbers, pixel by pixel. Renderers call
//! these arbitrary output variables, AOVs.

use super::Job;
use super::first_hits::{PixelHit, first_hits};
use super::first_surfaces::first_surfaces;
use gridel_core::render::RenderError;
use gridel_core::{Effects, Scene, Settings};

/// An arbitrary output variable: a property of the surface that the ray through the middle of a pixel hits first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Aov {
    /// Distance from the eye in scene units, infinite where nothing is hit.
    Depth,
    /// The shading normal of length 1, with normal maps, in the scene's axes, on the side of the eye; 0 where nothing is hit.
    Normal,
    /// Diffuse reflectance, linear, with textures and vertex colors, also of mirrors and glass; 0 where nothing is hit.
    Albedo,
    /// The object's number in scene-file order, `u32::MAX` where nothing is hit. Objects of parts follow the scene's
    /// own.
    Object,
    /// The primitive's number in scene-file order, `u32::MAX` where nothing is hit. Those of parts follow the scene's
    /// own.
    Primitive,
    /// Texture coordinates, u to the right and v down; infinite where nothing is hit and on what has none.
    Uv,
    /// The instance's number in scene-file order, `u32::MAX` for the scene's own objects and where nothing is hit.
    Instance,
}

impl Aov {
    pub const ALL: [Self; 7] = [
        Self::Depth,
        Self::Normal,
        Self::Albedo,
        Self::Object,
        Self::Primitive,
        Self::Uv,
        Self::Instance,
    ];

    /// Returns the name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Albedo => "albedo",
            Self::Object => "object",
            Self::Primitive => "primitive",
            Self::Uv => "uv",
            Self::Instance => "instance",
        }
    }
}

/// The values of an AOV, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Depth.
    Lengths(Vec<f32>),
    /// Texture coordinates.
    Coordinates(Vec<[f32; 2]>),
    /// Normals and colors.
    Vectors(Vec<[f32; 3]>),
    /// Numbers, such as those of objects.
    Numbers(Vec<u32>),
}

/// Computes AOVs of some rows of a picture, in the order of `aovs`. Ignores a job's samples and ray depth: there is one
/// ray through the middle of each pixel.
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
    let hits = first_hits(scene, job)?;
    let is_mapped = scene.effects_with_parts().contains(Effects::NORMAL_MAP);
    let is_shaded = |aov: &Aov| *aov == Aov::Albedo || *aov == Aov::Normal && is_mapped;
    let surfaces = match aovs.iter().any(is_shaded) {
        true => first_surfaces(scene, job)?,
        false => Vec::new(),
    };
    let all = |of: fn(&PixelHit) -> u32| {
        let numbers = hits.iter().map(|hit| hit.as_ref().map_or(u32::MAX, of));
        Values::Numbers(numbers.collect())
    };
    let values = aovs.iter().map(|aov| match aov {
        Aov::Depth => {
            let depth = |hit: &Option<PixelHit>| hit.map_or(f32::INFINITY, |it| it.distance as f32);
            Values::Lengths(hits.iter().map(depth).collect())
        }
        Aov::Normal => {
            let mut normals: Vec<_> = hits
                .iter()
                .map(|hit| hit.map_or([0.0; 3], |it| it.normal))
                .collect();
            for (normal, surface) in normals.iter_mut().zip(&surfaces) {
                *normal = surface.mapped_normal.unwrap_or(*normal);
            }
            Values::Vectors(normals)
        }
        Aov::Albedo => Values::Vectors(surfaces.iter().map(|it| it.albedo).collect()),
        Aov::Object => all(|hit| hit.object),
        Aov::Primitive => all(|hit| hit.primitive),
        Aov::Uv => {
            let pair =
                |hit: &Option<PixelHit>| hit.and_then(|it| it.uv).unwrap_or([f32::INFINITY; 2]);
            Values::Coordinates(hits.iter().map(pair).collect())
        }
        Aov::Instance => all(|hit| hit.instance.unwrap_or(u32::MAX)),
    });
    Ok(values.collect())
}

#[cfg(test)]
mod tests;
