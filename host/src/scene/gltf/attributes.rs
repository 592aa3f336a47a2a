//! Colors of vertices, texture coordinates, and textures.

use super::buffers::fetch;
use super::normal_transforms::NormalTransforms;
use super::{Importer, material};
use crate::scene::access::FileError;
use crate::scene::error::COPY_AGAIN;
use crate::scene::texture::texture_transform;
use crate::scene::{
    Attributes, CauseAndRemedy, Image, Material, NormalMap, SceneError, Texture, Wrap,
};
use crate::table::shortened;
use glam::{DAffine2, DVec2};
use gltf::image::Source;
use gltf::material::AlphaMode;
use gltf::texture::{MagFilter, MinFilter, WrappingMode};
use gltf::{Primitive, Semantic};
use std::borrow::Cow;
use std::sync::Arc;

/// The placement of an image on a mesh: its set of texture coordinates, and their transform.
#[derive(Clone, Copy, PartialEq)]
struct ImagePlacement {
    set: u32,
    transform: DAffine2,
}

impl ImagePlacement {
    /// Returns the placement of a material's images; `None` without one.
    fn of(material: &gltf::Material<'_>, transforms: &NormalTransforms) -> Option<Self> {
        Self::of_color(material).or_else(|| Self::of_normals(material, transforms))
    }

    fn of_color(material: &gltf::Material<'_>) -> Option<Self> {
        let info = material.pbr_metallic_roughness().base_color_texture();
        let info = info.filter(|it| it.texture().source().is_some())?;
        let transform = info.texture_transform();
        let set = transform.as_ref().and_then(|it| it.tex_coord());
        Some(Self {
            set: set.unwrap_or(info.tex_coord()),
            transform: transform.map_or(DAffine2::IDENTITY, |it| {
                texture_placement(it.scale(), it.rotation(), it.offset())
            }),
        })
    }

    fn of_normals(material: &gltf::Material<'_>, transforms: &NormalTransforms) -> Option<Self> {
        let info = material.normal_texture();
        let info = info.filter(|it| it.texture().source().is_some())?;
        let number = material.index();
        let transform = number.and_then(|number| transforms.get(&number));
        let set = transform.and_then(|it| it.tex_coord);
        Some(Self {
            set: set.unwrap_or(info.tex_coord()),
            transform: transform.map_or(DAffine2::IDENTITY, |it| {
                texture_placement(it.scale.0, it.rotation.0, it.offset.0)
            }),
        })
    }
}

/// The transform of `KHR_texture_transform`.
fn texture_placement(scale: [f32; 2], rotation: f32, offset: [f32; 2]) -> DAffine2 {
    let [scale, offset] = [scale, offset].map(|it| DVec2::from(it.map(f64::from)));
    texture_transform(scale, rotation.into(), offset)
}

/// An image with the sampler of a texture.
fn sampled(image: Arc<Image>, texture: &gltf::Texture<'_>, transform: DAffine2) -> Texture {
    let sampler = texture.sampler();
    let wrap = |mode: WrappingMode| match mode {
        WrappingMode::Repeat => Wrap::Repeat,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
        WrappingMode::ClampToEdge => Wrap::Clamp,
    };
    Texture {
        wrap: [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())],
        bilinear: sampler.mag_filter() != Some(MagFilter::Nearest),
        levels: sampler
            .min_filter()
            .is_some_and(|it| !matches!(it, MinFilter::Nearest | MinFilter::Linear)),
        transform,
        ..Texture::of(image)
    }
}

impl Importer<'_> {
    /// The colors and texture coordinates of a primitive with so many vertices and these triangles.
    pub(super) fn attributes(
        &mut self,
        place: &str,
        part: &Primitive<'_>,
        (vertices, triangles): (usize, &[[u32; 3]]),
    ) -> Result<Attributes, SceneError> {
        let mut attributes = Attributes::default();
        let check_count = |found: usize, what: &str| {
            if found == vertices {
                return Ok(());
            }
            let cause = format!("{place} has {vertices} vertices and {found} {what}");
            Err(SceneError::new(self.path, cause, "export the file again"))
        };
        if let Some(accessor) = part.get(&Semantic::Colors(0)) {
            let colors = self.buffers.colors(&accessor)?;
            check_count(colors.len(), "colors")?;
            // What is opaque has no alpha.
            let uses_alpha = part.material().alpha_mode() != AlphaMode::Opaque;
            let is_clear = uses_alpha && colors.iter().any(|it| it[3] < 1.0);
            let solid = colors
                .iter()
                .map(|&[r, g, b, _]| [r, g, b].map(|it| it.clamp(0.0, 1.0)));
            attributes.colors = solid.collect();
            self.warn_of(usize::from(is_clear), "the alpha of COLOR_0 is ignored");
        }
        let material = part.material();
        let Some(set) = ImagePlacement::of(&material, &self.normal_transforms).map(|it| it.set)
        else {
            return Ok(attributes);
        };
        let Some(accessor) = part.get(&Semantic::TexCoords(set)) else {
            self.warn(format!(
                "{place} has a texture and no TEXCOORD_{set}; its plain color is used"
            ));
            return Ok(attributes);
        };
        let coordinates = self.buffers.coordinates(&accessor)?;
        check_count(coordinates.len(), "texture coordinates")?;
        attributes.coordinates = coordinates.into_iter().map(DVec2::from_array).collect();
        attributes.triangles = triangles.to_vec();
        Ok(attributes)
    }

    /// Warns of colors that weight only a part of the light that a material sends on.
    pub(super) fn warn_of_colors(&mut self, attributes: &Attributes, material: usize) {
        let made = &self.scene.materials[material];
        let is_diffuse = made.mirror == [0.0; 3] && made.transmit == [0.0; 3];
        if is_diffuse || attributes.colors.iter().all(|it| *it == [1.0; 3]) {
            return;
        }
        let name = shortened(&made.name);
        self.warn(format!(
            "COLOR_0 on material {name:?} weights its diffuse color alone, not what it mirrors or lets through"
        ));
    }

    /// The material of a primitive, each read once.
    pub(super) fn material(&mut self, part: &Primitive<'_>) -> Result<usize, SceneError> {
        let material = part.material();
        if let Some(&known) = self.materials.get(&material.index()) {
            return Ok(known);
        }
        let means = self.means(&material)?;
        let plain = material::read(&material, false, &means);
        // A texture may bring the alpha that is a pane without it.
        let texture = self.texture(&material, &material::read(&material, true, &means))?;
        let normal_map = self.normal_map(&material, &plain)?;
        let is_opaque = texture.as_ref().is_none_or(|it| it.image.is_opaque());
        let alpha = material::alpha(&material).filter(|_| !is_opaque);
        let made = match alpha {
            None => plain,
            Some(_) => material::read(&material, true, &means),
        };
        let made = Material {
            texture,
            alpha,
            normal_map,
            place: self.place.clone(),
            ..made
        };
        if alpha.is_some() && made.transmit != [0.0; 3] {
            let name = &made.name;
            self.warn(format!(
                "the alpha of the texture of material {name:?} is ignored, because it is glass",
                name = shortened(name)
            ));
        }
        let number = self.scene.materials.len();
        self.scene.materials.push(made);
        self.materials.insert(material.index(), number);
        Ok(number)
    }

    /// The texture of the base color.
    fn texture(
        &mut self,
        material: &gltf::Material<'_>,
        made: &Material,
    ) -> Result<Option<Texture>, SceneError> {
        let name = &made.name;
        let Some(info) = material.pbr_metallic_roughness().base_color_texture() else {
            return Ok(None);
        };
        if made.mirror != [0.0; 3] || made.transmit != [0.0; 3] {
            self.warn(format!(
                "the texture of material {name:?} weights its diffuse color alone, not what it mirrors or lets through", name = shortened(name)));
        }
        let Some(source) = info.texture().source() else {
            self.warn(format!(
                "the texture of material {name:?} names no image that Gridel reads; its plain color is used", name = shortened(name)));
            return Ok(None);
        };
        let Some(image) = self.image(&source, "the plain color is used")? else {
            return Ok(None);
        };
        let placed =
            ImagePlacement::of_color(material).map_or(DAffine2::IDENTITY, |it| it.transform);
        Ok(Some(sampled(image, &info.texture(), placed)))
    }

    /// The normal map, if it lies as the texture of the base color does.
    fn normal_map(
        &mut self,
        material: &gltf::Material<'_>,
        made: &Material,
    ) -> Result<Option<NormalMap>, SceneError> {
        let name = &made.name;
        let Some(info) = material.normal_texture() else {
            return Ok(None);
        };
        let (Some(placed), Some(source)) = (
            ImagePlacement::of_normals(material, &self.normal_transforms),
            info.texture().source(),
        ) else {
            self.warn(format!(
                "the normal map of material {name:?} names no image that Gridel reads; it is not drawn", name = shortened(name)));
            return Ok(None);
        };
        if ImagePlacement::of_color(material).is_some_and(|it| it != placed) {
            self.warn(format!(
                "the normal map of material {name:?} does not lie as the texture of its color does; it is not drawn", name = shortened(name)));
            return Ok(None);
        }
        let scale = f64::from(info.scale());
        let taken = scale.clamp(-NormalMap::STEEPEST, NormalMap::STEEPEST);
        if scale != taken {
            self.warn(format!(
                "the normal map of material {name:?} has the scale {scale}; it is drawn with {taken}", name = shortened(name)));
        }
        let Some(mut image) = self.image(&source, "the normal map is not drawn")? else {
            return Ok(None);
        };
        if taken < 0.0 {
            image = self.turned(&source, &image)?;
        }
        Ok(Some(NormalMap {
            texture: sampled(image, &info.texture(), placed.transform),
            scale: taken.abs(),
        }))
    }

    /// The image of a normal map whose scale is negative: its components along u and v have the other sign.
    fn turned(
        &mut self,
        source: &gltf::Image<'_>,
        image: &Arc<Image>,
    ) -> Result<Arc<Image>, SceneError> {
        let number = source.index();
        if let Some(known) = self.turned.get(&number) {
            return Ok(Arc::clone(known));
        }
        let [width, height] = image.size().map(|side| side as usize);
        let counted = self.access.texels.add(width, height);
        counted.map_err(|CauseAndRemedy { cause, remedy }| {
            self.error(format!("image {number}, turned, {cause}"), &remedy)
        })?;
        let turned = Arc::new(image.turned());
        self.turned.insert(number, Arc::clone(&turned));
        Ok(turned)
    }

    /// Reads an image, each once. `None` for a file that is not there, with a warning that says what happens `instead`.
    pub(super) fn image(
        &mut self,
        image: &gltf::Image<'_>,
        instead: &str,
    ) -> Result<Option<Arc<Image>>, SceneError> {
        let key = match image.source() {
            Source::View { view, .. } => format!("view {}", view.index()),
            Source::Uri { uri, .. } => String::from(uri),
        };
        if let Some(known) = self.images.get(&key).cloned() {
            return Ok(self.found(known, instead));
        }
        let what = format!("image {}", image.index());
        let bytes = match image.source() {
            Source::View { view, .. } => match self.buffers.view(&view) {
                Some(bytes) => Cow::Borrowed(bytes),
                None => {
                    let number = view.index();
                    let cause =
                        format!("{what} reads buffer view {number}, which its buffer lacks");
                    return Err(self.error(cause, COPY_AGAIN));
                }
            },
            Source::Uri { uri, .. } => match fetch(self.path, &what, uri, self.access) {
                Ok(bytes) => Cow::Owned(bytes),
                // As with textures of OBJ files: it was often left behind.
                Err(FileError::Unreadable(error)) => {
                    self.images.insert(key, Err(error.cause.clone()));
                    return Ok(self.found(Err(error.cause), instead));
                }
                Err(FileError::Unusable(error)) => return Err(error),
            },
        };
        let name = image.name().map_or_else(|| what.clone(), str::to_owned);
        let decoded = Image::decode(&name, &bytes, &self.access.texels).map_err(
            |CauseAndRemedy { cause, remedy }| {
                self.error(
                    format!("{what} ({name:?}) {cause}", name = shortened(&name)),
                    &remedy,
                )
            },
        )?;
        let decoded = Arc::new(decoded);
        self.images.insert(key, Ok(Arc::clone(&decoded)));
        Ok(Some(decoded))
    }

    /// The image that was read, or a warning with the cause.
    fn found(&mut self, image: Result<Arc<Image>, String>, instead: &str) -> Option<Arc<Image>> {
        image
            .map_err(|cause| self.warn(format!("{cause}; {instead}")))
            .ok()
    }
}
