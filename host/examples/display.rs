//! Draws a scene on a display that `embedded-graphics` drives, here a simulated one, and saves
//! what it shows:
//!
//! ```text
//! cargo run --release -p gridel-host --example display -- fixtures/glass-chess.toml display.png
//! ```
//!
//! With a driver of a real display in place of `SimulatorDisplay`, `draw` is what firmware does.

use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, Rectangle};
use embedded_graphics::text::Text;
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use gridel_core::accel::MAX_STACK_DEPTH;
use gridel_core::render::{MAX_RAY_DEPTH, Renderer, Settings, Workspace};
use gridel_core::{DualSplit, Effects, NoCount, Scene};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{MoleculeOptions, load};
use std::error::Error;
use std::path::Path;

/// Pixels of the display.
pub const SIZE: [u16; 2] = [240, 135];
/// Height of the line of text at its lower edge.
pub const CAPTION: u32 = 15;

/// The picture, and below it what it shows. Colours are dithered, since there are few.
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
    let renderer = Renderer::<f32, DualSplit, { Effects::ALL.0 }>::new(scene, settings)?;
    let mut space = Workspace::<f32, MAX_STACK_DEPTH, { MAX_RAY_DEPTH + 1 }>::new();
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
    let mut display = SimulatorDisplay::new(Size::new(SIZE[0].into(), SIZE[1].into()));
    let caption = format!("{scene}, {} bytes", compiled.blob.bytes().len());
    draw(&checked, &caption, &mut display)?;
    let pixels = display.to_rgb_output_image(&OutputSettings::default());
    pixels.save_png(output)?;
    Ok(())
}
