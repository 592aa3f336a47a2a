//! The renderer: pixels of one scene at one size, at any place and in any order.

use crate::accel::{Accel, Number};
use crate::format::limits::{DISPLAY_VALUES, MAX_RAY_DEPTH, MAX_SAMPLES};
use crate::format::record::View;
use crate::format::{Effects, Structure};
use crate::number::Format;
use crate::ray::{Ray, RayError};
use crate::render::encoding::{Linear, from_display};
use crate::render::pixel_rays;
use crate::render::pixel_rays::PixelRays;
use crate::render::sample_pattern::SUBPIXELS;
use crate::render::spread::{Spread, spread};
use crate::render::trace::RayLoop;
use crate::render::workspace::WorkspaceView;
use crate::scene::Scene;
use crate::shade::Color;
use crate::target::SMALL;
use core::fmt;
use core::marker::PhantomData;

/// The settings of a picture; [`Settings::of`] returns those of the scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// Pixels from left to right, above 0.
    pub width: u16,
    /// Pixels from top to bottom, above 0. The field of view is vertical.
    pub height: u16,
    /// Samples per pixel, 1 to 4,096; powers of two are spread best. Beyond 256 they share places within the pixel, but
    /// effects draw different random points.
    pub samples: u16,
    /// Maximum number of secondary rays that follow each other, 0 to 32: off mirrors, through glass or alpha, diffuse.
    pub depth: u8,
    /// True if pixels are dithered.
    pub dither: bool,
}

impl Settings {
    /// Returns the settings of the scene file, without dithering.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// let settings = gridel_core::Settings::of(&scene);
    /// assert_eq!([settings.samples, settings.width], [scene.view().samples, scene.view().width]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(scene: &Scene<'_>) -> Self {
        let view = scene.view();
        Self {
            width: view.width,
            height: view.height,
            samples: view.samples,
            depth: view.depth,
            dither: false,
        }
    }
}

/// The reason why a scene has no picture with these settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RenderError {
    /// The picture has no pixels, or is more than 64 times as wide as high.
    Size {
        /// The requested width.
        width: u16,
        /// The requested height.
        height: u16,
    },
    /// Not 1 to 4,096 samples.
    Samples(u16),
    /// A shutter has no moments.
    NoMoments,
    /// A shutter has moments with different settings.
    MomentSettings,
    /// A shutter has more moments than a pixel has samples.
    Moments {
        /// Number of moments.
        found: usize,
        /// Samples per pixel.
        samples: u16,
    },
    /// The depth is above 32.
    Depth(u8),
    /// The blob does not hold the structure.
    Structure(Structure),
    /// The scene requires effects that the renderer was not compiled for.
    Effects(Effects),
    /// The pixels are too narrow for the number format to distinguish their directions. (The feature `small` removes
    /// this check.)
    Resolution(Format),
    /// The workspace has fewer entries or places than it needs.
    Workspace {
        /// The memory that is too small: the stack, or the work list.
        what: &'static str,
        /// Its size.
        found: usize,
        /// The size that it needs.
        needed: usize,
    },
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            RenderError::Size { width, height } => write!(
                f,
                "a picture of {width} by {height} pixels cannot be made: both sides must be above 0, \
                 and the width at most 64 times the height"
            ),
            RenderError::Samples(samples) => {
                write!(
                    f,
                    "{samples} samples per pixel are not possible: ask for 1 to {MAX_SAMPLES}"
                )
            }
            RenderError::NoMoments => f.write_str("a shutter has no moments: give it at least one"),
            RenderError::Moments { found, samples } => write!(
                f,
                "{found} moments are not possible with {samples} samples per pixel: ask for at most one per sample"
            ),
            RenderError::MomentSettings => {
                f.write_str("the moments of a shutter have different settings: give all the same")
            }
            RenderError::Depth(depth) => {
                write!(
                    f,
                    "a depth of {depth} is not possible: ask for 0 to {MAX_RAY_DEPTH}"
                )
            }
            RenderError::Structure(structure) => write!(
                f,
                "the blob holds no structure `{name}`: build it with `--accel {name}`",
                name = structure.name()
            ),
            RenderError::Effects(effects) => write!(
                f,
                "the scene requires the effects {effects}, which the renderer's type leaves out"
            ),
            RenderError::Resolution(format) => write!(
                f,
                "the pixels are so narrow that `{name}` cannot tell their directions apart: use a wider \
                 field of view or fewer pixels, or move the eye closer{finer}",
                name = format.name(),
                finer = match format {
                    Format::F32 => ", or use `fixed` or `f64`",
                    Format::Fixed => ", or use `f64`",
                    Format::F64 => "",
                }
            ),
            RenderError::Workspace {
                what,
                found,
                needed,
            } => write!(
                f,
                "the {what} of the workspace has room for {found} and this scene needs {needed}"
            ),
        }
    }
}

impl core::error::Error for RenderError {}

/// Renders pixels of a scene in the number format `N`, through the structure `A`. It is compiled for the effects in
/// `EFFECTS` (an [`Effects`] as its bits), which must include those of the scene.
///
/// Holds the camera for one picture size, some 200 bytes. Everything that changes lies in the caller's
/// [`Workspace`](crate::render::Workspace). Pixels do not depend on each other, so any number of renderers can share a
/// picture.
#[derive(Clone, Copy, Debug)]
pub struct Renderer<'s, 'a, N: Number, A: Accel, const EFFECTS: u32> {
    scene: &'s Scene<'a>,
    settings: Settings,
    rays: PixelRays<N>,
    spread: Spread,
    structure: PhantomData<A>,
}

impl<'s, 'a, N: Number, A: Accel, const EFFECTS: u32> Renderer<'s, 'a, N, A, EFFECTS> {
    /// Returns a renderer for one scene and picture size, in a number format and through a structure, with the code of
    /// some effects. Use it in firmware, because the program then holds no other code.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{DualSplit, Effects, Fixed, Renderer, Scene, Settings};
    ///
    /// const EFFECTS: u32 = Effects::SHADOW.with(Effects::MIRROR).0;
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let settings = Settings { width: 160, height: 120, ..Settings::of(&scene) };
    /// let renderer = Renderer::<Fixed, DualSplit, EFFECTS>::with_settings(&scene, settings)?;
    /// assert_eq!(renderer.settings().width, 160);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If a setting is out of its range, or the blob lacks the structure. Also if the scene requires an effect that is
    /// not in `EFFECTS`, or the number format cannot distinguish the pixels' directions.
    pub fn with_settings(scene: &'s Scene<'a>, settings: Settings) -> Result<Self, RenderError> {
        let Settings {
            width,
            height,
            samples,
            depth,
            ..
        } = settings;
        if width == 0 || height == 0 || u32::from(width) > 64 * u32::from(height) {
            return Err(RenderError::Size { width, height });
        }
        if samples == 0 || samples > MAX_SAMPLES {
            return Err(RenderError::Samples(samples));
        }
        if usize::from(depth) > MAX_RAY_DEPTH {
            return Err(RenderError::Depth(depth));
        }
        let needed = A::needs(&scene.geometry);
        if !scene.holds(needed) {
            return Err(RenderError::Structure(needed));
        }
        let missing = scene.effects().without(Effects(EFFECTS));
        if missing != Effects::NONE {
            return Err(RenderError::Effects(missing));
        }
        if !SMALL && !pixel_rays::resolves::<N>(scene.view(), height) {
            return Err(RenderError::Resolution(N::FORMAT));
        }
        let rays = PixelRays::new(scene.bounds(), scene.view(), width, height);
        Ok(Self {
            scene,
            settings,
            rays,
            spread: spread(scene.view(), height, samples),
            structure: PhantomData,
        })
    }

    /// Returns the settings.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Renderer, Scene, Settings};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// assert_eq!(Renderer::new(&scene)?.settings(), Settings::of(&scene));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Checks that a workspace is large enough.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::render::RenderError;
    /// use gridel_core::{Renderer, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut short = Workspace::<f32, 1, 1>::new();
    /// let error = Renderer::new(&scene)?.check_workspace(&short.as_view());
    /// assert!(matches!(error, Err(RenderError::Workspace { what: "stack", found: 1, .. })));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the workspace is too small, with the missing size. Rendering with it is safe, but rays without room bring no
    /// light.
    pub fn check_workspace(&self, space: &WorkspaceView<'_, N>) -> Result<(), RenderError> {
        let rooms = [
            ("stack", space.stack.capacity(), self.scene.stack_depth()),
            (
                "work list",
                space.work.capacity(),
                self.scene.effects().work_depth(self.settings.depth),
            ),
        ];
        for (what, found, needed) in rooms {
            if found < needed {
                return Err(RenderError::Workspace {
                    what,
                    found,
                    needed,
                });
            }
        }
        Ok(())
    }

    /// Returns the ray from the eye through the middle of a pixel, for queries of the caller's own. Of a pixel outside of
    /// the picture, [`ray_through`](Self::ray_through) returns it.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Renderer, Scene};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let ray = Renderer::new(&scene)?.primary_ray(0, 0)?;
    /// // The camera looks along -z, mostly.
    /// assert_eq!(ray.slope()[2], -1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the blob's camera vectors make no direction.
    #[inline]
    pub fn primary_ray(&self, x: u16, y: u16) -> Result<Ray<N>, RayError> {
        let middle = |pixel: u16| i32::from(pixel) * SUBPIXELS + SUBPIXELS / 2;
        self.rays.ray(&self.rays.row(middle(y)), middle(x))
    }

    /// Returns the ray from the eye through the middle of a pixel that can lie anywhere, also left of the picture or above
    /// it: each number is -65,535 to 65,535. Inside of the picture it is the [primary ray](Self::primary_ray). In `fixed`,
    /// beside a picture more than 1,000 times as high as wide, it can be off by up to 7 pixels.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Renderer, Scene};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// assert_eq!(renderer.ray_through(7, 5)?.slope(), renderer.primary_ray(7, 5)?.slope());
    /// // Far to the left, where the camera looks along -z and x grows to the right.
    /// assert_eq!(renderer.ray_through(-30_000, 0)?.slope()[0], -1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If a number is out of its range, or the blob's camera vectors make no direction.
    pub fn ray_through(&self, x: i32, y: i32) -> Result<Ray<N>, RayError> {
        let most = i32::from(u16::MAX);
        let range = -most..=most;
        if !range.contains(&x) || !range.contains(&y) {
            return Err(RayError::Direction);
        }
        let middle = |pixel: i32| pixel * SUBPIXELS + SUBPIXELS / 2;
        self.rays.ray_anywhere([middle(x), middle(y)])
    }

    /// The source of the pixels' rays.
    #[inline(always)]
    pub(super) fn rays(&self) -> &PixelRays<N> {
        &self.rays
    }

    /// A pixel's value in the steps of a picture.
    #[inline(always)]
    pub(super) fn to_linear(&self, seen: Color<N>) -> Linear {
        let values = seen.0.map(N::to_linear16);
        if DISPLAY_VALUES && self.scene.view().encoding == View::DISPLAY_VALUES {
            from_display(values)
        } else {
            values
        }
    }

    pub(super) fn ray_loop(&self) -> RayLoop<'s, 'a> {
        RayLoop {
            scene: self.scene,
            depth: self.settings.depth,
            from_camera: true,
            spread: self.spread,
        }
    }
}
