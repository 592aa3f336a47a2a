//! Pictures on displays that `embedded-graphics` drives, in all of its colors.
//!
//! [`Renderer::draw`] streams a rectangle to the display without a buffer. With a
//! [`Cursor`](crate::render::Cursor), pixels go there as they become ready, a bounded number of rays at a
//! time: hand each to [`DrawTarget::draw_iter`] as a `Pixel`.

use crate::accel::{Accel, Number};
use crate::observe::count::Observer;
use crate::render::encoding::{Pixel, luminance, quantize};
use crate::render::renderer::Renderer;
use crate::render::workspace::WorkspaceView;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::{
    Bgr555, Bgr565, Bgr666, Bgr888, BinaryColor, Gray2, Gray4, Gray8, Rgb555, Rgb565, Rgb666,
    Rgb888, RgbColor,
};
use embedded_graphics_core::prelude::{DrawTarget, GrayColor, PixelColor};
use embedded_graphics_core::primitives::Rectangle;

/// Colors of three channels, in any order and width.
macro_rules! pixels_of_rgb {
    ($($color:ident),*) => {$(
        impl Pixel for $color {
            fn encode([red, green, blue]: [u16; 3], dither: Option<[u16; 2]>) -> Self {
                let channel = |linear, most: u8| quantize(linear, most.into(), dither) as u8;
                Self::new(
                    channel(red, Self::MAX_R),
                    channel(green, Self::MAX_G),
                    channel(blue, Self::MAX_B),
                )
            }
        }
    )*};
}

pixels_of_rgb!(
    Rgb555, Bgr555, Rgb565, Bgr565, Rgb666, Bgr666, Rgb888, Bgr888
);

/// Grays, by the luminance of the color.
macro_rules! pixels_of_gray {
    ($($color:ident),*) => {$(
        impl Pixel for $color {
            fn encode(linear: [u16; 3], dither: Option<[u16; 2]>) -> Self {
                let white = Self::WHITE.luma();
                Self::new(quantize(luminance(linear), white.into(), dither) as u8)
            }
        }
    )*};
}

pixels_of_gray!(Gray2, Gray4, Gray8);

/// On if white is nearer than black; use it with dithering.
impl Pixel for BinaryColor {
    fn encode(linear: [u16; 3], dither: Option<[u16; 2]>) -> Self {
        Self::from(quantize(luminance(linear), 1, dither) > 0)
    }
}

impl<N: Number, A: Accel, const EFFECTS: u32> Renderer<'_, '_, N, A, EFFECTS> {
    /// Draws a rectangle of the picture at the same place of a display, row by row and without a buffer. Pixels outside
    /// the picture or the display are not traced. To draw elsewhere, pass a translated display.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use embedded_graphics_core::Pixel;
    /// use embedded_graphics_core::pixelcolor::Rgb565;
    /// use embedded_graphics_core::prelude::{DrawTarget, OriginDimensions, Size};
    /// use gridel_core::{NoCount, Renderer, Scene, Workspace};
    ///
    /// /// Counts pixels in place of showing them.
    /// struct Display(usize);
    ///
    /// impl OriginDimensions for Display {
    ///     fn size(&self) -> Size {
    ///         Size::new(16, 8)
    ///     }
    /// }
    ///
    /// impl DrawTarget for Display {
    ///     type Color = Rgb565;
    ///     type Error = core::convert::Infallible;
    ///
    ///     fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
    ///         self.0 += pixels.into_iter().count();
    ///         Ok(())
    ///     }
    /// }
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let renderer = Renderer::new(&scene)?;
    /// let mut space = Workspace::for_any_scene();
    /// let mut display = Display(0);
    /// let whole = embedded_graphics_core::primitives::Rectangle::new(Default::default(), display.size());
    /// renderer.draw(&whole, &mut display, &mut space.as_view(), &mut NoCount)?;
    /// assert_eq!(display.0, 16 * 8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The errors of the display.
    pub fn draw<D, C>(
        &self,
        area: &Rectangle,
        display: &mut D,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> Result<(), D::Error>
    where
        D: DrawTarget<Color: Pixel + PixelColor>,
        C: Observer,
    {
        let settings = self.settings();
        let size = Size::new(settings.width.into(), settings.height.into());
        let area = area
            .intersection(&Rectangle::new(Point::zero(), size))
            .intersection(&display.bounding_box());
        // Inside the picture, so 0 to 65535.
        let pixels = area
            .rows()
            .flat_map(|y| area.columns().map(move |x| [x as u16, y as u16]));
        let colors = pixels.map(|[x, y]| self.pixel::<D::Color, C>(x, y, space, count));
        display.fill_contiguous(&area, colors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics_core::pixelcolor::raw::RawU16;

    /// The display's own type holds the same bits as this crate's type.
    #[test]
    fn colors_are_those_of_plain_pixels() {
        for step in 0..=1000_u32 {
            let channel = |factor: u32| (step * factor * 13 % 65_536) as u16;
            let linear = [channel(1), channel(3), channel(5)];
            for dither in [None, Some([3, 5])] {
                let crate::Rgb565(plain) = crate::Rgb565::encode(linear, dither);
                assert_eq!(
                    RawU16::from(Rgb565::encode(linear, dither)),
                    RawU16::new(plain)
                );
                let color = Bgr565::encode(linear, dither);
                let expected = [plain >> 11, plain >> 5 & 63, plain & 31];
                assert_eq!([color.r(), color.g(), color.b()].map(u16::from), expected);
                let crate::Rgb888(plain) = crate::Rgb888::encode(linear, dither);
                let color = Bgr888::encode(linear, dither);
                assert_eq!([color.r(), color.g(), color.b()], plain);
            }
        }
    }

    /// Gray stays gray, and half of the pixels of a dithered surface of middle gray are on.
    #[test]
    fn grays_go_by_luminance() {
        for linear in (0..=u16::MAX).step_by(7) {
            let crate::Rgb888([code, ..]) = crate::Rgb888::encode([linear; 3], None);
            assert_eq!(Gray8::encode([linear; 3], None).luma(), code);
        }
        assert!(Gray8::encode([0, u16::MAX, 0], None) > Gray8::encode([u16::MAX, 0, 0], None));
        // The linear value of sRGB code 127.5.
        let middle = 14_032;
        let places = (0..64).map(|place| [place & 7, place >> 3]);
        let on = places.filter(|&place| BinaryColor::encode([middle; 3], Some(place)).is_on());
        assert_eq!(on.count(), 32);
    }
}
