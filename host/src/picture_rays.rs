//! The rays of a scene's own picture, as the ray loop casts them.

use crate::observed::Observed;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::RenderError;
use gridel_core::{Effects, Number, Ray, RayKind, Renderer, Scene, Settings, Structure, Workspace};
use rayon::prelude::*;
use std::any::Any;

/// Most rays of one picture.
pub const MOST_RAYS: usize = 1 << 22;

/// The reason why a picture's rays cannot be cast.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum PictureRaysError {
    #[error("the picture of {pixels} pixels casts more than {most} rays")]
    #[diagnostic(help("ask for a smaller one with `--size`"))]
    TooMany { pixels: usize, most: usize },
    #[error("{0}")]
    #[diagnostic(help("ask for another `--size`"))]
    Settings(#[from] RenderError),
}

/// The rays of a picture, in the order of its pixels.
#[derive(Clone, Debug, Default)]
pub struct PictureRays<N: Number> {
    /// Rays from the camera.
    pub primary: Vec<Ray<N>>,
    /// Rays towards lights.
    pub shadow: Vec<Ray<N>>,
    /// Rays off mirrors, glass and diffuse surfaces, and through glass.
    pub bounced: Vec<Ray<N>>,
}

impl<N: Number> PictureRays<N> {
    /// Keeps a ray that is cast.
    fn keep(&mut self, kind: RayKind, ray: &dyn Any) {
        let Some(&ray) = ray.downcast_ref::<Ray<N>>() else {
            return;
        };
        match kind {
            RayKind::Primary => self.primary.push(ray),
            RayKind::Shadow => self.shadow.push(ray),
            RayKind::Reflected
            | RayKind::Refracted
            | RayKind::Diffuse
            | RayKind::Glossy
            | RayKind::Polished => self.bounced.push(ray),
        }
    }

    /// Casts the rays of a picture. The scene must hold flagged pairs.
    ///
    /// Through glass a shadow ray continues behind every surface as a new one; each is kept.
    ///
    /// # Errors
    /// If there are more than [`MOST_RAYS`], or the settings are out of their range.
    pub fn of(scene: &Scene<'_>, settings: Settings) -> Result<Self, PictureRaysError> {
        let lacks = RenderError::Structure(Structure::Flagged);
        let scene = &scene.choose(Structure::Flagged).ok_or(lacks)?;
        let renderer = Renderer::with_settings(scene, settings)?;
        let pixels = usize::from(settings.width) * usize::from(settings.height);
        let mut rays = Self::default();
        // So many rows at a time that what they cast cannot exceed memory before it is counted.
        let rows_at_once = (MOST_RAYS / (usize::from(settings.width) << 8)).max(1) as u16;
        let mut first = 0;
        while first < settings.height {
            let end = first.saturating_add(rows_at_once).min(settings.height);
            let rows: Vec<Self> = (first..end)
                .into_par_iter()
                .map(|y| Self::of_row(&renderer, y))
                .collect();
            for row in rows {
                rays.primary.extend(row.primary);
                rays.shadow.extend(row.shadow);
                rays.bounced.extend(row.bounced);
            }
            if rays.count() > MOST_RAYS {
                return Err(PictureRaysError::TooMany {
                    pixels,
                    most: MOST_RAYS,
                });
            }
            first = end;
        }
        Ok(rays)
    }

    fn of_row(renderer: &Renderer<'_, '_, N, DynAccel, { Effects::ALL.0 }>, y: u16) -> Self {
        let mut rays = Self::default();
        let mut space = Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
        let mut space = space.as_view();
        for x in 0..renderer.settings().width {
            let mut observed = Observed {
                sink: Some(&mut |kind, ray| rays.keep(kind, ray)),
                ..Observed::default()
            };
            renderer.linear(x, y, &mut space, &mut observed);
        }
        rays
    }

    /// Returns all rays.
    pub fn count(&self) -> usize {
        self.primary.len() + self.shadow.len() + self.bounced.len()
    }
}
