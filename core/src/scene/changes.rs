//! Changes of the blob's own values by a program: camera, lights and materials.
//!
//! Nothing is written to the blob. A changed scene borrows the new values in addition to the blob. The checks of
//! [`Scene::from_bytes`] prove each of them in constant time. A program that changes nothing holds no code for it.

use crate::format::record::{Light, Material, View};
use crate::format::{BlobError, Effects, SectionKind};
use crate::scene::Scene;
use crate::scene::check::{check_light, check_material};
use crate::scene::read::{check_lens, check_view};
use crate::target::DepthOfFieldOnly;

impl<'a> Scene<'a> {
    /// Returns the scene seen by another camera, in other surroundings or with other defaults for pictures.
    ///
    /// A view is a copy of the blob's view with changes; [`Camera::view`](crate::Camera::view) makes one with another
    /// camera.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut view = *scene.view();
    /// view.background = [1 << 20; 3];
    /// let bright = scene.with_view(&view)?;
    /// let renderer = Renderer::new(&bright)?;
    /// let mut space = Workspace::for_any_scene();
    /// assert_eq!(renderer.linear(0, 0, &mut space.as_view(), &mut NoCount), [65_535; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If a number is out of its range, or this build lacks a feature that the view requires.
    pub fn with_view(&self, view: &'a View) -> Result<Self, BlobError> {
        check_view(view)?;
        check_lens(self.lens(), view)?;
        let effects = self.effects.with(view.effects());
        check_available(effects)?;
        Ok(Self {
            view,
            effects,
            ..*self
        })
    }

    /// Returns the scene as a pinhole sees it: in focus everywhere.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert!(scene.without_lens().lens().is_none());
    /// # Ok::<(), gridel_core::BlobError>(())
    /// ```
    pub fn without_lens(&self) -> Self {
        Self {
            lens: DepthOfFieldOnly::new(|| &[][..]),
            ..*self
        }
    }

    /// Returns the scene with other lights, of which there can be more or fewer than before.
    ///
    /// They cast shadows where this scene's do; in a scene without lights they require [`Effects::SHADOW`]. So call
    /// this on the scene as it was loaded, also for the lights of each further frame.
    ///
    /// Keep the lights of surfaces that glow. Diffuse and rough surfaces get the light of such a surface from its light
    /// and not from rays that hit it, so without it they lose that light.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::Scene;
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut lights = [scene.lights()[0]];
    /// lights[0].color = [1 << 19, 0, 0];
    /// let red = scene.with_lights(&lights)?;
    /// assert_eq!(red.lights()[0].color[0], 1 << 19);
    /// assert!(scene.with_lights(&[])?.lights().is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If a number is out of its range, or this build lacks an effect that a light requires.
    pub fn with_lights(&self, lights: &'a [Light]) -> Result<Self, BlobError> {
        let mut effects = self.effects;
        let decided = match self.lights.is_empty() {
            true => Effects::NONE,
            false => Effects::SHADOW,
        };
        for (index, light) in lights.iter().enumerate() {
            check_light(index, light, self)?;
            effects = effects.with(light.effects().without(decided));
        }
        check_available(effects)?;
        Ok(Self {
            effects,
            lights,
            ..*self
        })
    }

    /// Returns the scene with other materials in place of the blob's, one for each and in their order.
    ///
    /// An effect that a material requires becomes one of the [scene's](Self::effects). A renderer that was not compiled
    /// for it is rejected with the effect's name.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::format::record::Material;
    /// use gridel_core::{Effects, Scene};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut materials: Vec<Material> = scene.materials().to_vec();
    /// materials[0].highlight = [1 << 29; 3];
    /// let shiny = scene.with_materials(&materials)?;
    /// assert!(shiny.effects().contains(Effects::HIGHLIGHT));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Materials have the order in which the scene file's objects first have them.
    ///
    /// # Errors
    /// If there are more or fewer than the blob has, or a number is out of its range. Also if this build lacks an
    /// effect that a material requires.
    pub fn with_materials(&self, materials: &'a [Material]) -> Result<Self, BlobError> {
        if materials.len() != self.materials.len() {
            return Err(BlobError::Memory {
                section: SectionKind::Materials,
                found: materials.len(),
                needed: self.materials.len(),
            });
        }
        let mut effects = self.effects;
        for (index, material) in materials.iter().enumerate() {
            check_material(index, material, self.maps())?;
            effects = effects.with(material.effects());
        }
        check_available(effects)?;
        Ok(Self {
            effects,
            materials,
            ..*self
        })
    }
}

/// Returns an error if this build lacks an effect.
fn check_available(effects: Effects) -> Result<(), BlobError> {
    let missing = effects.without(Effects::AVAILABLE);
    if missing == Effects::NONE {
        Ok(())
    } else {
        Err(BlobError::MissingEffects { missing })
    }
}
