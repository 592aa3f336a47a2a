//! Renders the frames of a turning camera for a display on an SPI bus, alongside other tasks.
//!
//! Two tasks share two buffers of a row each. `render` fills one of them, while the DMA channel of the SPI peripheral
//! sends the other for `send`. `render` traces so many rays, then lets other tasks run. No task waits longer for it
//! than those rays take, and no row waits for the bus unless the bus is slower than the rays.
//!
//! The board is an nRF52840-DK. A display of the ST7789 family has its clock on P0.26, its data on P0.27 and its
//! data/command line on P1.08: these pins lead to the kit's headers alone. See the display's data sheet for its
//! initialization.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use embassy_executor::Spawner;
use embassy_futures::yield_now;
use embassy_nrf::gpio::{Level, Output, OutputDrive};
use embassy_nrf::spim::{self, Spim};
use embassy_nrf::{bind_interrupts, peripherals};
use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::zerocopy_channel::{Channel, Receiver, Sender};
use gridel_core::scene::coordinate_steps;
use gridel_core::{
    Angle, Camera, DualSplit, Effects, Fixed, NoCount, Position, Renderer, Rgb565, Scene, Settings,
    Up, Workspace, include_blob,
};
use static_cell::StaticCell;

/// Flash starts it at a multiple of 4 bytes.
static BLOB: &[u8] = include_blob!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../fixtures/blobs/dual-split.gridel"
));

const WIDTH: u16 = 160;
const HEIGHT: u16 = 120;

/// Rays between two chances for other tasks: some milliseconds.
const RAYS: u32 = 16;

/// A row in the format of displays: two bytes per pixel, the upper one first.
type Row = [u8; 2 * WIDTH as usize];

bind_interrupts!(struct Interrupts {
    SPIM3 => spim::InterruptHandler<peripherals::SPI3>;
});

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    // Two buffers: one row is rendered while another is sent.
    static BUFFERS: StaticCell<[Row; 2]> = StaticCell::new();
    static CHANNEL: StaticCell<Channel<'static, NoopRawMutex, Row>> = StaticCell::new();
    let chip = embassy_nrf::init(Default::default());
    let mut config = spim::Config::default();
    config.frequency = spim::Frequency::M32;
    let bus = Spim::new_txonly(chip.SPI3, Interrupts, chip.P0_26, chip.P0_27, config);
    let is_data = Output::new(chip.P1_08, Level::Low, OutputDrive::Standard);
    let channel = CHANNEL.init(Channel::new(BUFFERS.init([[0; 2 * WIDTH as usize]; 2])));
    let (rows, filled) = channel.split();
    if let (Ok(render), Ok(send)) = (render(rows), send(filled, bus, is_data)) {
        spawner.spawn(render);
        spawner.spawn(send);
    }
}

/// Renders one frame after the other, a few rays at a time.
#[embassy_executor::task]
async fn render(mut rows: Sender<'static, NoopRawMutex, Row>) {
    // A stack of 24 entries and a ray depth of 8 are enough for this blob: `gridel inspect` states both.
    static SPACE: StaticCell<Workspace<Fixed, 24, 9>> = StaticCell::new();
    let space = SPACE.init(Workspace::new());
    let Ok(scene) = Scene::from_bytes(BLOB) else {
        return;
    };
    let settings = Settings {
        width: WIDTH,
        height: HEIGHT,
        samples: 1,
        ..Settings::of(&scene)
    };
    let distance = coordinate_steps(scene.coordinate_exponent(), 8, 1);
    let Some(distance) = distance.map(i32::unsigned_abs) else {
        return;
    };
    let [raised, seen] = [16, 8].map(|whole| Angle::of_turn(1, whole));
    let mut azimuth = Angle(0);
    loop {
        azimuth = azimuth.plus(Angle::of_turn(1, 90));
        let camera = Camera::orbit(Up::Y, Position([0; 3]), distance, azimuth, raised, seen);
        let Ok(view) = camera.map(|camera| camera.view(&scene)) else {
            return;
        };
        let Ok(turned) = scene.with_view(&view) else {
            return;
        };
        let renderer = Renderer::<Fixed, DualSplit, { Effects::AVAILABLE.0 }>::with_settings(
            &turned, settings,
        );
        let Ok(renderer) = renderer else { return };
        if renderer.check_workspace(&space.as_view()).is_err() {
            return;
        }
        for y in 0..HEIGHT {
            // Waits until the bus is done with one of the two buffers.
            let row = rows.send().await;
            let mut cursor = renderer.cursor([0, y], [WIDTH, 1], space.as_view());
            while !cursor.is_done() {
                cursor.step(RAYS, &mut NoCount, |x, _, Rgb565(pixel)| {
                    let place = row.chunks_exact_mut(2).nth(x.into());
                    if let Some(place) = place {
                        place.copy_from_slice(&pixel.to_be_bytes());
                    }
                });
                yield_now().await;
            }
            rows.send_done();
        }
    }
}

/// Sends rows to the display, while others are rendered.
#[embassy_executor::task]
async fn send(
    mut filled: Receiver<'static, NoopRawMutex, Row>,
    mut bus: Spim<'static>,
    mut is_data: Output<'static>,
) {
    // To write pixels from the window's upper left corner on.
    const WRITE: u8 = 0x2c;
    let mut row_of_frame = 0;
    loop {
        let row = filled.receive().await;
        if row_of_frame == 0 {
            is_data.set_low();
            if bus.write(&[WRITE]).await.is_err() {
                return;
            }
            is_data.set_high();
        }
        // The DMA channel reads the buffer; meanwhile the other task renders into the other one.
        if bus.write_from_ram(row).await.is_err() {
            return;
        }
        filled.receive_done();
        row_of_frame = (row_of_frame + 1) % HEIGHT;
    }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    cortex_m::peripheral::SCB::sys_reset()
}
