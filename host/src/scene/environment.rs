//! The light around a scene, as scene files state it.

use super::error::CauseAndRemedy;
use super::image::{Image, Texels};
use super::{exr_image, hdr_image};
use crate::srgb::linear_of_srgb;
use glam::DVec3;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// A linear RGB color, as the scene's model has it.
type Color = [f64; 3];

/// The light around a scene: what rays that hit nothing see, and what surfaces are lit by.
///
/// ```
/// use gridel_host::scene::{Environment, Sky};
///
/// let sky = Environment::of(Sky::Gradient {
///     zenith: [0.2, 0.4, 1.0],
///     horizon: [0.8; 3],
///     ground: [0.1; 3],
/// });
/// assert_eq!(sky.size, 64);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    pub sky: Sky,
    /// Factor of the sky's radiance.
    pub intensity: f64,
    /// Degrees by which the picture is turned around the direction up, counterclockwise as seen from above.
    pub rotation: f64,
    /// Rows of the map in a blob: 16, 32, 64, 128 or 256.
    pub size: u32,
    pub sun: Option<Sun>,
}

/// The light from all directions.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// A picture of all directions. Its middle lies where a camera looks that begins an orbit: at -z, or at y where z
    /// points up. Its right lies at x.
    Picture(Arc<Panorama>),
    /// Radiance that depends on the height alone. Above the horizon, the horizon's radiance blends into the zenith's by
    /// h (2 - h), with h the sine of the elevation.
    Gradient {
        zenith: Color,
        horizon: Color,
        ground: Color,
    },
}

/// A disc in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The direction in which its light travels.
    pub direction: DVec3,
    /// The color of a directional light of the same strength.
    pub color: Color,
    /// Degrees from edge to edge: above 0, up to 90.
    pub angle: f64,
}

impl Environment {
    /// Returns a sky as it is, of 64 rows, without a sun.
    pub const fn of(sky: Sky) -> Self {
        Self {
            sky,
            intensity: 1.0,
            rotation: 0.0,
            size: 64,
            sun: None,
        }
    }
}

impl Sun {
    /// Returns the length from the middle to the edge, on a sphere with radius 1.
    pub fn radius(&self) -> f64 {
        2.0 * libm::sin(self.angle.to_radians() / 4.0)
    }

    /// Returns its radiance times its solid angle over π: what a random point of it adds to a white surface, times the
    /// cosine there.
    pub fn light(&self) -> Color {
        let part = self.solid_angle_over_pi() / self.color_over_radiance();
        self.color.map(|channel| channel * part)
    }

    /// Returns its solid angle over π.
    pub fn solid_angle_over_pi(&self) -> f64 {
        self.radius() * self.radius()
    }

    /// Returns the factor from a radiance to the [color](Self::color): the light that falls on a surface which faces
    /// the disc, over π. At the disc's edge it falls aslant.
    pub fn color_over_radiance(&self) -> f64 {
        let part = self.solid_angle_over_pi();
        part * (1.0 - part / 4.0)
    }
}

/// A picture of all directions: columns are longitudes, and rows go from the zenith down.
#[derive(Clone, PartialEq)]
pub struct Panorama {
    /// Its source, for messages.
    pub name: String,
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

impl fmt::Debug for Panorama {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            width,
            height,
            ..
        } = self;
        write!(f, "Panorama({name:?}, {width}x{height})")
    }
}

impl Panorama {
    /// Makes a picture from pixels row by row, the upper row first: linear radiance. `None` unless there are as many
    /// pixels as that, and at least one, and all channels are finite numbers at or above 0.
    pub fn new(name: &str, width: usize, height: usize, pixels: Vec<[f32; 3]>) -> Option<Self> {
        let count = width.checked_mul(height)?;
        let mut channels = pixels.as_flattened().iter();
        let is_valid = channels.all(|&it| it.is_finite() && it >= 0.0);
        (count > 0 && count == pixels.len() && is_valid).then(|| Self {
            name: String::from(name),
            width,
            height,
            pixels,
        })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Rows of pixels, the upper one first: linear radiance.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[[f32; 3]]> {
        self.pixels.chunks_exact(self.width)
    }

    /// Reads a Radiance, OpenEXR, PNG or JPEG file. Its content decides which.
    pub(super) fn decode(
        name: &str,
        bytes: &[u8],
        texels: &Texels,
    ) -> Result<Self, CauseAndRemedy> {
        let check = |width, height| texels.add(width, height);
        let (width, height, pixels) = if bytes.starts_with(b"#?") {
            hdr_image::decode(bytes, check)?
        } else if bytes.starts_with(&exr_image::MAGIC) {
            exr_image::decode(bytes, check)?
        } else {
            let is_known = bytes.starts_with(b"\x89PNG") || bytes.starts_with(b"\xff\xd8");
            if !is_known {
                return Err(CauseAndRemedy::new(
                    "is neither Radiance (.hdr) nor OpenEXR nor PNG nor JPEG",
                    "convert it to Radiance HDR or PNG",
                ));
            }
            let image = Image::decode(name, bytes, texels)?;
            let linear: Vec<f32> = (0..=255_u8)
                .map(|code| linear_of_srgb(f64::from(code) / 255.0) as f32)
                .collect();
            let pixels = image.pixels().iter();
            let pixels = pixels.map(|[r, g, b, _]| [*r, *g, *b].map(|it| linear[usize::from(it)]));
            let [width, height] = image.size().map(|it| it as usize);
            (width, height, pixels.collect())
        };
        Self::new(name, width, height, pixels)
            .ok_or_else(|| CauseAndRemedy::new("has no pixels", "save the picture again"))
    }

    /// Reads the file that `name` in a scene file refers to.
    pub(super) fn file(
        access: &super::access::Access,
        scene: &Path,
        name: &str,
    ) -> Result<Arc<Self>, CauseAndRemedy> {
        let path = access.resolve(scene, name)?;
        let of_file = |CauseAndRemedy { cause, remedy }| {
            CauseAndRemedy::new(format!("{} {cause}", path.display()), remedy)
        };
        let bytes = access
            .read(&path)
            .map_err(|error| of_file(CauseAndRemedy::new(error.cause, error.remedy)))?;
        Self::decode(name, &bytes, &access.texels)
            .map(Arc::new)
            .map_err(of_file)
    }
}
