//! Pixels, rows and rectangles of a picture.

use crate::accel::{Accel, Number};
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::ray::Ray;
use crate::render::pixel_samples::Samples;
use crate::render::spread::no_spread;
use crate::render::start::Start;
use crate::render::trace::RayLoop;
use crate::render::{Pixel, Renderer, WorkspaceView};
use crate::shade::Color;
use crate::shade::sampler::Sampler;

impl<N: Number, A: Accel, const EFFECTS: u32> Renderer<'_, '_, N, A, EFFECTS> {
    /// Returns one pixel, linear, 65535 being white. The picture continues outside of its edges: in `f32` and `f64` to
    /// any pixel, in `fixed` to those below one and a half times its width and height. For pixels from there on, give
    /// [`linear_along`](Self::linear_along) a ray of [`ray_through`](Self::ray_through). This holds for rows, rectangles
    /// and cursors, too.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let background = renderer.linear(0, 0, &mut space.as_view(), &mut NoCount);
    /// assert_eq!(background, [0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn linear<C: Observer>(
        &self,
        x: u16,
        y: u16,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> [u16; 3] {
        Samples::trace([x, y], |_| self, space, count)
    }

    /// Returns the color along a ray of the caller's own, linear; 65535 is white. No lens acts on it, and effects draw
    /// the random points of the first sample of the first pixel.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let ray = renderer.primary_ray(0, 0)?;
    /// let seen = renderer.linear_along(&ray, &mut space.as_view(), &mut NoCount);
    /// assert_eq!(seen, [0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn linear_along<C: Observer>(
        &self,
        ray: &Ray<N>,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> [u16; 3] {
        space.work.clear();
        let ray_loop = RayLoop {
            from_camera: false,
            spread: no_spread(),
            ..self.ray_loop()
        };
        let mut radiance = Color::BLACK;
        let sampler = Sampler::new([0; 2], 0);
        while !ray_loop.step::<N, A, C, EFFECTS>(
            sampler,
            Start::Own(ray),
            &mut radiance,
            space,
            count,
        ) {}
        let seen = ray_loop.headroom::<EFFECTS>().limit(radiance);
        if C::ENABLED {
            count.event(Event::SampleFinished {
                at: None,
                radiance: seen.to_f64(),
            });
        }
        let shown = ray_loop.developed::<N, A, C, EFFECTS>(seen, space, count);
        self.to_linear(shown)
    }

    /// Returns one pixel in a display's form.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Rgb888, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let Rgb888(pixel) = renderer.pixel(0, 0, &mut space.as_view(), &mut NoCount);
    /// assert_eq!(pixel, [0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn pixel<P: Pixel, C: Observer>(
        &self,
        x: u16,
        y: u16,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> P {
        P::encode(
            self.linear(x, y, space, count),
            self.settings().dither.then_some([x, y]),
        )
    }

    /// A part of a row: as many pixels as `row` has, from column `x` on.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Rgb565, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let mut row = [Rgb565(0); 32];
    /// let middle = renderer.settings().height / 2;
    /// renderer.row(0, middle, &mut row, &mut space.as_view(), &mut NoCount);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn row<P: Pixel, C: Observer>(
        &self,
        x: u16,
        y: u16,
        row: &mut [P],
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) {
        for (column, pixel) in (x..=u16::MAX).zip(row) {
            *pixel = self.pixel(column, y, space, count);
        }
    }

    /// Any rectangle, pixel by pixel, row by row from its upper left corner.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{NoCount, Renderer, Rgb888, Scene, Workspace};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let mut pixels = 0;
    /// let sink = |_, _, Rgb888(_)| pixels += 1;
    /// renderer.rectangle([10, 20], [4, 3], &mut space.as_view(), &mut NoCount, sink);
    /// assert_eq!(pixels, 12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn rectangle<P: Pixel, C: Observer>(
        &self,
        corner: [u16; 2],
        size: [u16; 2],
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
        mut sink: impl FnMut(u16, u16, P),
    ) {
        for y in (corner[1]..=u16::MAX).take(size[1].into()) {
            for x in (corner[0]..=u16::MAX).take(size[0].into()) {
                sink(x, y, self.pixel(x, y, space, count));
            }
        }
    }
}
