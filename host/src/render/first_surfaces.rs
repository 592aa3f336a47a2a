//! The surfaces that the rays through the middles of pixels hit first, as shading sees them.

use super::{ALL, Job, chosen};
use crate::srgb::linear_of_srgb;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::format::record::{Material, View};
use gridel_core::render::RenderError;
use gridel_core::{Effects, Event, Fixed, Format, Number, Observer, Renderer, Scene, Workspace};
use rayon::prelude::*;

/// A surface as shading sees it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shaded {
    /// The diffuse reflectance, linear: 0 where nothing is hit. That of mirrors and glass is what their material states.
    pub albedo: [f32; 3],
    /// The normal of a normal map, of length 1, on the side of the eye; `None` without one.
    pub mapped_normal: Option<[f32; 3]>,
}

/// White ambient light that is reflected is the reflectance.
impl Observer for Shaded {
    const ENABLED: bool = true;

    fn event(&mut self, event: Event) {
        match event {
            Event::Ambient { radiance } => self.albedo = radiance.map(|it| it as f32),
            Event::NormalMapped { normal, .. } => {
                self.mapped_normal = Some(normal.map(|it| it as f32));
            }
            _ => (),
        }
    }
}

/// Returns the surfaces of some rows, row by row, as a pinhole sees them. The job's samples are 1, and its depth 0.
///
/// # Errors
/// If the blob lacks the structure or a setting is out of its range.
pub(super) fn first_surfaces(scene: &Scene<'_>, job: &Job) -> Result<Vec<Shaded>, RenderError> {
    let view = View {
        background: [0; 3],
        ambient: [1 << 20; 3],
        ..*scene.view()
    };
    let mut materials = scene.materials().to_vec();
    for material in &mut materials {
        // What alpha hides has colors, too.
        material.maps &= !Material::MAPS_ALPHA;
    }
    let lit = scene
        .without_lens()
        .with_lights(&[])
        .and_then(|scene| scene.with_view(&view))
        .and_then(|scene| scene.with_materials(&materials));
    let lit = &lit.expect("a scene with less requires no other effect");
    let lit = &chosen(lit, job.structure)?;
    match job.format {
        Format::Fixed => rows::<Fixed>(lit, job),
        Format::F32 => rows::<f32>(lit, job),
        Format::F64 => rows::<f64>(lit, job),
    }
}

fn rows<N: Number>(scene: &Scene<'_>, job: &Job) -> Result<Vec<Shaded>, RenderError> {
    let renderer = Renderer::<N, DynAccel, ALL>::with_settings(scene, job.settings)?;
    let is_display_value = scene.view().encoding == View::DISPLAY_VALUES;
    let rows = job.rows.clone().into_par_iter().map(|y| {
        let mut space = Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
        let mut space = space.as_view();
        let mut shaded = |x: u16| {
            let mut shaded = Shaded::default();
            renderer.linear(x, y, &mut space, &mut shaded);
            if is_display_value {
                let linear = |value: f32| linear_of_srgb(value.into()) as f32;
                shaded.albedo = shaded.albedo.map(linear);
            }
            shaded
        };
        (0..job.settings.width).map(&mut shaded).collect::<Vec<_>>()
    });
    Ok(rows.flatten_iter().collect())
}
