//! Shared parts of the firmware's programs: the scene in flash, the board, and measuring on it.
//!
//! | program | what it does |
//! |---|---|
//! | `picture` | renders the scene's picture into a file of the host, and counts what it and single rays cost |
//! | `primary` | traces one ray per pixel and counts the hits |
//! | `casts` | casts rays of its own, without a camera, and counts the hits |
//! | `everywhere` | renders in every number format through every structure |
//! | `emitted` | renders from what `gridel build --emit-rust` wrote |
//! | `selftest` | runs the core's own tests |
//! | `bare` | renders and talks to nobody: what it links is what a product would flash |
//! | `range` | casts rays down onto the scene and prints how far they go, in scene coordinates |
//! | `orbit` | turns a camera around the scene in 64 frames |
//! | `arm` | bends the joints of an arm of instances, and casts rays from its hand |
//! | `deform` | moves the vertices of a mesh, refits its boxes and casts rays, and counts what that costs |
//! | `morph` | moves a mesh by the weights of its morph targets and casts rays, and counts what that costs |
//! | `example` | the README's example |
//!
//! The first five run in QEMU, or in Node, and print what they measured, a line each: a name and
//! a number. Blob, board, number format and structure are chosen when they are built:
//!
//! ```text
//! GRIDEL_BLOB=/path/to/scene.gridel GRIDEL_BOARD=mps2-an386 cargo run --release \
//!     --target thumbv7em-none-eabihf --features f32,dual-split --bin picture
//! ```
#![no_std]

pub mod arm;
pub mod board;
pub mod casts;
pub mod finder;
pub mod measure;
#[cfg(all(feature = "bvh", feature = "triangle"))]
pub mod mesh;
pub mod orbit;
pub mod rays;
pub mod report;
pub mod scene;
pub mod waves;

#[cfg(target_arch = "arm")]
pub use cortex_m_rt as rt;
#[cfg(target_arch = "riscv32")]
pub use riscv_rt as rt;

#[cfg(all(target_arch = "arm", feature = "small"))]
unsafe extern "C" {
    /// The handler of cortex-m-rt for an interrupt without one.
    fn DefaultHandler();
}

/// The interrupts of the board's chip, as a crate for that chip would list them; none is used. Without such
/// a list cortex-m-rt makes room for 240.
#[cfg(all(target_arch = "arm", feature = "small"))]
#[unsafe(link_section = ".vector_table.interrupts")]
#[unsafe(no_mangle)]
pub static __INTERRUPTS: [unsafe extern "C" fn(); scene::INTERRUPTS] =
    [DefaultHandler; scene::INTERRUPTS];

/// Makes a function the whole program. It gets the program's memory, which lies outside the stack, so that the linker
/// counts it.
#[macro_export]
macro_rules! program {
    ($run:path, $memory:ty) => {
        static mut MEMORY: $memory = <$memory>::new();

        #[cfg(target_os = "none")]
        #[$crate::rt::entry]
        fn main() -> ! {
            // SAFETY: nothing runs before `main`, and it runs once.
            $run(unsafe { &mut *&raw mut MEMORY });
            $crate::board::exit(0)
        }

        #[cfg(target_os = "linux")]
        #[unsafe(no_mangle)]
        extern "C" fn main() -> i32 {
            // SAFETY: the C library calls this, once.
            $run(unsafe { &mut *&raw mut MEMORY });
            0
        }

        #[cfg(target_arch = "wasm32")]
        #[unsafe(no_mangle)]
        extern "C" fn start() {
            // SAFETY: the host calls this, once.
            $run(unsafe { &mut *&raw mut MEMORY });
        }

        // Nothing panics: the tests look for what a panic would need.
        #[cfg(not(target_os = "linux"))]
        #[panic_handler]
        fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
            $crate::board::exit(101)
        }
    };
}
