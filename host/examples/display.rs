//! Draws a scene on a display that `embedded-graphics` drives, here one in memory, and saves
//! what it shows:
//!
//! ```text
//! cargo run --release -p gridel-host --example display -- fixtures/glass-chess.toml display.png
//! ```
//!
//! With a driver of a real display in place of `Screen`, `draw` is what firmware does.

use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
use embedded_graphics::image::GetPixel;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::raw::{LittleEndian, RawU16};
use embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, Rectangle};
use embedded_graphics::text::Text;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::{Renderer, Settings, Workspace};
use gridel_core::{DualSplit, Effects, NoCount, Scene};
use gridel_host::compile::{Options, compile};
use gridel_host::picture::write_png;
use gridel_host::scene::{MoleculeOptions, load};
use std::error::Error;
use std::fs::File;
use std::path::Path;

/// Pixels of the display.
pub const SIZE: [u16; 2] = [240, 135];
/// Height of the line of text at its lower edge.
pub const CAPTION: u32 = 15;

const BYTES: usize = buffer_size::<Rgb565>(SIZE[0] as usize, SIZE[1] as usize);
/// A display in memory.
pub type Screen =
    Framebuffer<Rgb565, RawU16, LittleEndian, { SIZE[0] as usize }, { SIZE[1] as usize }, BYTES>;

/// The picture, and below it what it shows. Colors are dithered, since there are few.
pub fn draw<D: DrawTarget<Color = Rgb565>>(
    scene: &Scene<'_>,
    caption: &str,
    display: &mut D,
) -> Result<(), Box<dyn Error>>
where
    D::Error: Error + 'static,
{
    let [width, height] = SIZE;
    let settings = Settings {
        width,
        height: height - CAPTION as u16,
        dither: true,
        ..Settings::of(scene)
    };
    let renderer = Renderer::<f32, DualSplit, { Effects::ALL.0 }>::with_settings(scene, settings)?;
    let mut space = Workspace::<f32, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let mut space = space.as_view();
    renderer.check_workspace(&space)?;

    let everything = display.bounding_box();
    renderer.draw(&everything, display, &mut space, &mut NoCount)?;
    let below = Point::new(0, settings.height.into());
    Rectangle::new(below, Size::new(width.into(), CAPTION))
        .into_styled(PrimitiveStyle::with_fill(Rgb565::BLACK))
        .draw(display)?;
    let style = MonoTextStyle::new(&FONT_6X10, Rgb565::WHITE);
    Text::new(caption, below + Point::new(4, 10), style).draw(display)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(scene), Some(output)) = (arguments.next(), arguments.next()) else {
        return Err("give a scene file, and the PNG file to write".into());
    };
    let imported = load(Path::new(&scene), &MoleculeOptions::default())?;
    let compiled = compile(&imported.scene, &Options::default())?;
    let checked = compiled.blob.scene()?;
    let mut display = Screen::new();
    let caption = format!("{scene}, {} bytes", compiled.blob.bytes().len());
    draw(&checked, &caption, &mut display)?;
    let points = display.bounding_box().points();
    let pixels = points
        .filter_map(|point| display.pixel(point))
        .flat_map(|color| {
            let color = Rgb888::from(color);
            [color.r(), color.g(), color.b()]
        });
    let pixels: Vec<u8> = pixels.collect();
    write_png(
        &mut File::create(output)?,
        SIZE.map(u32::from),
        &pixels,
        None,
    )?;
    Ok(())
}
