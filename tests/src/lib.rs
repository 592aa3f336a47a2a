//! Shared parts of the whole-program tests: scenes, rays, and answers that are independent of the
//! core.

/// The example of the package's page compiles.
#[cfg(doctest)]
#[doc = include_str!("../../core/README.md")]
struct CorePage;

pub mod agreement;
pub mod bounds;
pub mod cases;
pub mod effort;
pub mod exact_box;
pub mod fuzz;
pub mod judge;
pub mod measured;
pub mod moved;
pub mod query;
pub mod scenes;
pub mod shapes;

pub use gridel_host::random;
pub use gridel_host::shape::exact;
pub use gridel_host::verify::rays;

/// Calls a function that is generic over the number format for each of them.
#[macro_export]
macro_rules! every_format {
    ($function:ident($($argument:expr),* $(,)?)) => {{
        $function::<gridel_core::Fixed>($($argument),*);
        $function::<f32>($($argument),*);
        $function::<f64>($($argument),*);
    }};
}
