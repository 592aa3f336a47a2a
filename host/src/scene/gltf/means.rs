//! The means of textures that are not drawn and weight a factor: those of emission and transmission.
//!
//! Programs write the factor 1 wherever there is such a texture. The factor alone would let a whole mesh glow that has
//! one small lamp.

use super::Importer;
use super::material::{self, Means};
use crate::scene::{Image, SceneError};
use crate::table::shortened;
use std::sync::Arc;

impl Importer<'_> {
    /// Reads the means of a material's textures, and warns of those that are not drawn. A texture whose factor is 0 is
    /// not read.
    pub(super) fn means(&mut self, material: &gltf::Material<'_>) -> Result<Means, SceneError> {
        let emissive = material.emissive_texture().map(|it| it.texture());
        let glows = material.emissive_factor() != [0.0; 3];
        let through = material.transmission();
        let lets_through = through
            .as_ref()
            .is_some_and(|it| it.transmission_factor() > 0.0);
        let through = through.and_then(|it| it.transmission_texture());
        let through = through.map(|it| it.texture());
        self.warn_of_textures(material, [glows, lets_through]);
        let emissive = emissive.filter(|_| glows);
        let through = through.filter(|_| lets_through);
        let means = Means {
            emission: match &emissive {
                None => [1.0; 3],
                Some(texture) => {
                    let image =
                        self.mean_image(material, texture, ["emissive", "does not glow"])?;
                    image.map_or([0.0; 3], |it| self.image_means.of(&it).color)
                }
            },
            transmission: match &through {
                None => 1.0,
                Some(texture) => {
                    let words = ["transmission", "lets no light through"];
                    let image = self.mean_image(material, texture, words)?;
                    image.map_or(0.0, |it| self.image_means.of(&it).red)
                }
            },
        };
        for sentence in material::ignored_emission(material, &means) {
            self.warn(sentence);
        }
        Ok(means)
    }

    /// The image of a texture; `words` are its kind, and what the material does without it.
    fn mean_image(
        &mut self,
        material: &gltf::Material<'_>,
        texture: &gltf::Texture<'_>,
        [kind, without]: [&str; 2],
    ) -> Result<Option<Arc<Image>>, SceneError> {
        let name = material::name(material);
        let name = shortened(&name);
        let Some(source) = texture.source() else {
            self.warn(format!(
                "the {kind} texture of material {name:?} names no image that Gridel reads; the material {without}"
            ));
            return Ok(None);
        };
        self.image(&source, &format!("the material {name:?} {without}"))
    }

    /// Warns of textures that are not drawn. `means` says whether the means of emission and transmission are taken.
    fn warn_of_textures(&mut self, material: &gltf::Material<'_>, means: [bool; 2]) {
        let surface = material.pbr_metallic_roughness();
        let [emission, transmission] = means.map(|is_taken| match is_taken {
            true => " (its mean is taken)",
            false => "",
        });
        let through = material.transmission();
        let volume = material.volume();
        let textures = [
            (
                surface.metallic_roughness_texture().is_some(),
                "metallic-roughness",
                "",
            ),
            (material.occlusion_texture().is_some(), "occlusion", ""),
            (material.emissive_texture().is_some(), "emissive", emission),
            (
                through.is_some_and(|it| it.transmission_texture().is_some()),
                "transmission",
                transmission,
            ),
            (
                volume.is_some_and(|it| it.thickness_texture().is_some()),
                "thickness",
                "",
            ),
        ];
        let ignored = textures.into_iter().filter(|it| it.0);
        let ignored: Vec<_> = ignored
            .map(|(_, kind, mean)| format!("{kind}{mean}"))
            .collect();
        if !ignored.is_empty() {
            let name = material::name(material);
            self.warn(format!(
                "textures of material {name:?} are not drawn: {all}",
                name = shortened(&name),
                all = ignored.join(", ")
            ));
        }
    }
}
