//! Textures of materials.

use super::access::Access;
use super::access::FileError;
use super::error::CauseAndRemedy;
use super::image::Image;
use glam::{DAffine2, DVec2};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An image that weights the diffuse color of a material.
///
/// ```
/// use gridel_host::scene::{Image, Texture, Wrap};
///
/// let image = Image::new("gray", 1, 1, vec![[128, 128, 128, 255]]).unwrap();
/// let texture = Texture::of(image.into());
/// assert_eq!(texture.wrap, [Wrap::Repeat; 2]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    pub image: Arc<Image>,
    /// Wrapping beyond the image, along u and v.
    pub wrap: [Wrap; 2],
    /// True if four texels are mixed; otherwise the nearest one is used.
    pub bilinear: bool,
    /// True if smaller copies of the image are shown where it is far away.
    pub levels: bool,
    /// Takes the coordinates of meshes to those of the image.
    pub transform: DAffine2,
}

/// An image whose colors are normals of a bumpy surface: red to the right along u, green up against v, blue outward. A
/// value of 0 is -1, and 255 is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalMap {
    pub texture: Texture,
    /// A factor of the components along u and v, 0 to [`NormalMap::STEEPEST`]: how steep bumps are.
    pub scale: f64,
}

impl NormalMap {
    /// The largest scale.
    pub const STEEPEST: f64 = 16.0;
}

/// The continuation of an image beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// It repeats.
    #[default]
    Repeat,
    /// It repeats, every second time mirrored.
    Mirror,
    /// Its edge is repeated.
    Clamp,
}

impl Texture {
    /// Returns a bilinear texture that repeats, without levels.
    pub fn of(image: Arc<Image>) -> Self {
        Self {
            image,
            wrap: [Wrap::Repeat; 2],
            bilinear: true,
            levels: false,
            transform: DAffine2::IDENTITY,
        }
    }
}

/// The transform of texture coordinates as `KHR_texture_transform` defines it: scaled, turned by an angle in radians,
/// moved.
pub(super) fn texture_transform(scale: DVec2, radians: f64, offset: DVec2) -> DAffine2 {
    let (sine, cosine) = (libm::sin(radians), libm::cos(radians));
    DAffine2::from_cols(
        DVec2::new(cosine, -sine) * scale.x,
        DVec2::new(sine, cosine) * scale.y,
        offset,
    )
}

/// The means of images, each computed once: many materials may share an image.
#[derive(Default)]
pub(super) struct ImageMeans(HashMap<*const Image, (Arc<Image>, Mean)>);

/// The mean of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mean {
    /// As linear light.
    pub(super) color: [f64; 3],
    /// The mean of red, as a number rather than light.
    pub(super) red: f64,
}

impl ImageMeans {
    pub(super) fn of(&mut self, image: &Arc<Image>) -> Mean {
        // The image is kept, so that no other one takes its address.
        let mean = || Mean {
            color: image.mean(),
            red: image.mean_of_red(),
        };
        let known = self.0.entry(Arc::as_ptr(image));
        known.or_insert_with(|| (Arc::clone(image), mean())).1
    }
}

/// Images that were read, each once.
pub(super) struct Images<'a> {
    access: &'a Access,
    files: HashMap<PathBuf, Arc<Image>>,
    pub(super) means: ImageMeans,
}

impl<'a> Images<'a> {
    pub(super) fn new(access: &'a Access) -> Self {
        Self {
            access,
            files: HashMap::new(),
            means: ImageMeans::default(),
        }
    }

    /// Returns the image in the file that `name` in a scene file refers to.
    ///
    /// # Errors
    /// If it lies outside of the scene's folder, cannot be read, or is no image: cause and remedy.
    pub(super) fn file(
        &mut self,
        scene: &Path,
        name: &str,
    ) -> Result<Arc<Image>, FileError<CauseAndRemedy>> {
        let path = self
            .access
            .resolve(scene, name)
            .map_err(FileError::Unusable)?;
        // One file can have several names; one that is not there is missed below.
        let key = self
            .access
            .canonical(&path)
            .unwrap_or_else(|_| path.clone());
        if let Some(image) = self.files.get(&key) {
            return Ok(Arc::clone(image));
        }
        let of_file = |CauseAndRemedy { cause, remedy }| {
            CauseAndRemedy::new(format!("{} {cause}", path.display()), remedy)
        };
        let bytes = self.access.read(&path).map_err(|error| {
            FileError::Unreadable(of_file(CauseAndRemedy::new(error.cause, error.remedy)))
        })?;
        let image = Image::decode(name, &bytes, &self.access.texels)
            .map_err(|fault| FileError::Unusable(of_file(fault)))?;
        let image = Arc::new(image);
        self.files.insert(key, Arc::clone(&image));
        Ok(image)
    }
}
