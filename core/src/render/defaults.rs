//! Renderers and workspaces for any scene, without a choice of format, structure and effects.

use crate::accel::{DynAccel, Number};
use crate::format::Effects;
use crate::format::limits::MAX_STACK_DEPTH;
use crate::render::renderer::{RenderError, Renderer, Settings};
use crate::render::workspace::Workspace;
use crate::scene::Scene;

impl<'s, 'a> Renderer<'s, 'a, f32, DynAccel, { Effects::AVAILABLE.0 }> {
    /// Returns a renderer of the picture that the scene file states, in `f32`, through the best structure of the
    /// blob. [`with_settings`](Renderer::with_settings) is the form for all other cases.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Rgb888, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let [x, y] = [renderer.settings().width / 2, renderer.settings().height * 3 / 4];
    /// let Rgb888(pixel) = renderer.pixel(x, y, &mut space.as_view(), &mut NoCount);
    /// assert_ne!(pixel, [0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`with_settings`](Renderer::with_settings).
    pub fn new(scene: &'s Scene<'a>) -> Result<Self, RenderError> {
        Self::with_settings(scene, Settings::of(scene))
    }
}

impl<N: Number> Workspace<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }> {
    /// Returns an empty workspace that is large enough for every scene: 5 KB in `f32` and `fixed`, and 3 KB without the
    /// feature `indirect`.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Renderer, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut space = Workspace::for_any_scene();
    /// Renderer::new(&scene)?.check_workspace(&space.as_view())?;
    /// assert!(size_of_val(&space) < 5120);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn for_any_scene() -> Self {
        Self::new()
    }
}
