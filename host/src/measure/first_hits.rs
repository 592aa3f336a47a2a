//! The first hits of the rays through the middles of pixels.

use crate::render::chosen;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::RenderError;
use gridel_core::{
    Effects, Fixed, Format, NoCount, Number, Renderer, Scene, Settings, Stack, Structure,
    closest_hit,
};

/// The object that the ray through the middle of a pixel hits, and how far away; `None` on a miss.
pub type FirstHit = Option<(u32, f64)>;

/// The first hit of each pixel.
///
/// # Errors
/// If the settings are out of their range, or the scene does not hold the structure.
pub fn first_hits(
    scene: &Scene<'_>,
    (structure, format): (Structure, Format),
    settings: Settings,
) -> Result<Vec<FirstHit>, RenderError> {
    let scene = &chosen(scene, structure)?;
    match format {
        Format::Fixed => first_hits_in::<Fixed>(scene, settings),
        Format::F32 => first_hits_in::<f32>(scene, settings),
        Format::F64 => first_hits_in::<f64>(scene, settings),
    }
}

fn first_hits_in<N: Number>(
    scene: &Scene<'_>,
    settings: Settings,
) -> Result<Vec<FirstHit>, RenderError> {
    let renderer = Renderer::<N, DynAccel, { Effects::ALL.0 }>::with_settings(scene, settings)?;
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut first = |x: u16, y: u16| {
        let ray = renderer.primary_ray(x, y).ok()?;
        let hit = closest_hit::<N, DynAccel, _>(scene, &ray, stack.as_view(), &mut NoCount)?;
        let slope = ray.slope().map(N::ratio_to_f64);
        let norm = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
        Some((hit.object, N::far_to_f64(hit.t) * norm * unit))
    };
    let places = (0..settings.height).flat_map(|y| (0..settings.width).map(move |x| (x, y)));
    Ok(places.map(|(x, y)| first(x, y)).collect())
}
