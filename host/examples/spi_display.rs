//! Renders row by row for a display on an SPI bus: two bytes per pixel, the upper one first, in
//! chunks that a DMA channel sends while the next one is rendered.
//!
//! ```text
//! cargo run --release -p gridel-host --example spi_display -- fixtures/quick.toml panel.png
//! ```
//!
//! [`show`] is what firmware does: it allocates nothing. In place of a [`Panel`], which stands for
//! a display of the ST7789 family and its bus, it is given the board's own.

use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::WorkspaceView;
use gridel_core::{
    Accel, DualSplit, Effects, NoCount, Number, Renderer, Rgb565, Settings, Workspace,
};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{MoleculeOptions, load};
use std::error::Error;
use std::path::Path;

/// Bytes that the DMA channel sends at a time. Two such buffers are all that lies between the
/// tracer and the display.
pub const CHUNK: usize = 128;

/// A buffer that the bus and the renderer hand to each other; on a board it is a static.
pub type Buffer = &'static mut [u8; CHUNK];

/// The operations of a board's SPI peripheral with DMA.
pub trait Bus {
    /// Sends a command and its arguments, with the data line low for the command.
    fn command(&mut self, command: u8, arguments: &[u8]);
    /// Starts to send the first bytes of a buffer as data. Waits for the buffer that is on its way
    /// and hands it back to be filled.
    fn exchange(&mut self, full: Buffer, bytes: usize) -> Buffer;
}

/// The columns of a window to write to.
const COLUMNS: u8 = 0x2a;
/// Its rows.
const ROWS: u8 = 0x2b;
/// The following bytes are pixels.
const WRITE: u8 = 0x2c;

/// Renders the picture and sends it; `row` has as many pixels as the picture is wide. Returns the
/// buffer that is free at the end.
pub fn show<N: Number, A: Accel, const EFFECTS: u32>(
    renderer: &Renderer<'_, '_, N, A, EFFECTS>,
    row: &mut [Rgb565],
    space: &mut WorkspaceView<'_, N>,
    mut buffer: Buffer,
    bus: &mut impl Bus,
) -> Buffer {
    let Settings { width, height, .. } = renderer.settings();
    // From 0 to the last, both included.
    let span = |pixels: u16| {
        let [high, low] = (pixels - 1).to_be_bytes();
        [0, 0, high, low]
    };
    bus.command(COLUMNS, &span(width));
    bus.command(ROWS, &span(height));
    bus.command(WRITE, &[]);
    let mut filled = 0;
    for y in 0..height {
        renderer.row(0, y, row, space, &mut NoCount);
        for byte in row.iter().flat_map(|pixel| pixel.0.to_be_bytes()) {
            buffer[filled] = byte;
            filled += 1;
            if filled == CHUNK {
                buffer = bus.exchange(buffer, filled);
                filled = 0;
            }
        }
    }
    if filled > 0 {
        buffer = bus.exchange(buffer, filled);
    }
    buffer
}

/// A display and its bus, as far as pictures are concerned.
pub struct Panel {
    /// The buffer that is being sent.
    on_its_way: Option<Buffer>,
    /// The width of the window.
    pub width: usize,
    /// The height of the window.
    pub height: usize,
    /// The display's memory.
    pub memory: Vec<Rgb565>,
    /// Bytes of each chunk that was sent.
    pub chunks: Vec<usize>,
}

impl Panel {
    /// A display whose DMA channel owns a buffer.
    pub fn new(buffer: Buffer) -> Self {
        Self {
            on_its_way: Some(buffer),
            width: 0,
            height: 0,
            memory: Vec::new(),
            chunks: Vec::new(),
        }
    }

    /// Saves what the display shows.
    fn save(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let file = std::fs::File::create(path)?;
        let mut encoder = png::Encoder::new(file, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        // As displays widen their colors: the upper bits again below.
        let wide = |code: u16, bits: u32| (code << (8 - bits) | code >> (2 * bits - 8)) as u8;
        let pixels = self.memory.iter().flat_map(|&Rgb565(pixel)| {
            let (red, green, blue) = (pixel >> 11, pixel >> 5 & 63, pixel & 31);
            [wide(red, 5), wide(green, 6), wide(blue, 5)]
        });
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&pixels.collect::<Vec<u8>>())?;
        writer.finish()?;
        Ok(())
    }
}

impl Bus for Panel {
    fn command(&mut self, command: u8, arguments: &[u8]) {
        let pixels = |last: &[u8]| match last {
            [.., high, low] => usize::from(u16::from_be_bytes([*high, *low])) + 1,
            _ => 0,
        };
        match command {
            COLUMNS => self.width = pixels(arguments),
            ROWS => self.height = pixels(arguments),
            _ => self.memory.clear(),
        }
    }

    fn exchange(&mut self, full: Buffer, bytes: usize) -> Buffer {
        let pixels = full[..bytes].chunks_exact(2);
        self.memory
            .extend(pixels.map(|pixel| Rgb565(u16::from_be_bytes([pixel[0], pixel[1]]))));
        self.chunks.push(bytes);
        self.on_its_way.replace(full).expect("one of two buffers")
    }
}

/// Renders a scene file onto a panel.
pub fn panel(scene: &Path) -> Result<Panel, Box<dyn Error>> {
    let imported = load(scene, &MoleculeOptions::default())?;
    let compiled = compile(&imported.scene, &Options::default())?;
    let scene = compiled.blob.scene()?;
    let settings = Settings {
        width: 160,
        height: 128,
        dither: true,
        ..Settings::of(&scene)
    };
    let renderer = Renderer::<f32, DualSplit, { Effects::ALL.0 }>::with_settings(&scene, settings)?;
    let mut space = Workspace::<f32, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let mut space = space.as_view();
    renderer.check_workspace(&space)?;
    let [first, second] = [(); 2].map(|()| Box::leak(Box::new([0; CHUNK])));
    let mut panel = Panel::new(first);
    show(
        &renderer,
        &mut [Rgb565(0); 160],
        &mut space,
        second,
        &mut panel,
    );
    Ok(panel)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(scene), Some(output)) = (arguments.next(), arguments.next()) else {
        return Err("give a scene file, and the PNG file to write".into());
    };
    panel(Path::new(&scene))?.save(Path::new(&output))
}
