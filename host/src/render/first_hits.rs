//! The first hits of the rays through the middles of pixels.

use super::{ALL, Job, chosen};
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::RenderError;
use gridel_core::{Fixed, Format, NoCount, Number, Renderer, Scene, Stack, closest_hit};
use rayon::prelude::*;

/// The first hit of the ray through the middle of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelHit {
    /// The distance from the eye, in scene units.
    pub distance: f64,
    /// The shading normal, of length 1, on the side of the eye.
    pub normal: [f32; 3],
    /// Texture coordinates, where the surface has them.
    pub uv: Option<[f32; 2]>,
    pub object: u32,
    pub primitive: u32,
    /// The instance's number in scene-file order. Its place in the blob depends on the lattice.
    pub instance: Option<u32>,
}

/// The first hits of some rows, row by row; `None` on a miss.
///
/// # Errors
/// If the blob lacks the structure or a setting is out of its range.
pub(crate) fn first_hits(
    scene: &Scene<'_>,
    job: &Job,
) -> Result<Vec<Option<PixelHit>>, RenderError> {
    let scene = &chosen(scene, job.structure)?;
    match job.format {
        Format::Fixed => rows::<Fixed>(scene, job),
        Format::F32 => rows::<f32>(scene, job),
        Format::F64 => rows::<f64>(scene, job),
    }
}

fn rows<N: Number>(scene: &Scene<'_>, job: &Job) -> Result<Vec<Option<PixelHit>>, RenderError> {
    let renderer = Renderer::<N, DynAccel, ALL>::with_settings(scene, job.settings)?;
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let first = |x: u16, y: u16, stack: &mut Stack<MAX_STACK_DEPTH>| {
        let ray = renderer.primary_ray(x, y).ok()?;
        let hit = closest_hit::<N, DynAccel, _>(scene, &ray, stack.as_view(), &mut NoCount)?;
        let slope = ray.slope().map(N::ratio_to_f64);
        let norm = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
        let index = hit.instance();
        let instance = index.and_then(|index| scene.instances().get(index as usize));
        Some(PixelHit {
            distance: N::far_to_f64(hit.t) * norm * unit,
            normal: hit.shading_normal(scene).map(|x| x.ratio_to_f64() as f32),
            uv: hit
                .texture_coordinates(scene)
                .map(|pair| pair.map(|it| it as f32)),
            object: hit.object,
            primitive: hit.primitive,
            instance: instance.map(|instance| instance.number),
        })
    };
    let rows = job.rows.clone().into_par_iter().map(|y| {
        let mut stack = Stack::new();
        let row = (0..job.settings.width).map(|x| first(x, y, &mut stack));
        row.collect::<Vec<_>>()
    });
    Ok(rows.flatten_iter().collect())
}
