//! The core's tests that run everywhere: on a host by `cargo test`, on a board with any output that it has. Needs the
//! feature `selftest`.
//!
//! A test does not depend on the machine that it runs on. A [`Host`] prints for it; the feature `std` has one, and
//! firmware supplies its own.
//!
//! ```text
//! let failures = gridel_core::selftest::run(&mut host);
//! ```

mod blob;
mod checks;
mod hits;
mod numbers;
mod picture;
mod scene;
#[cfg(any(test, feature = "std"))]
mod std_host;

pub use checks::Host;
#[cfg(any(test, feature = "std"))]
pub use std_host::StdHost;

#[cfg(test)]
pub(crate) use scene::TinyBlob;

use checks::Checks;

/// A named test.
type Case = (&'static str, fn(&mut Checks<'_>));

const CASES: [Case; 17] = [
    ("fixed: products and quotients", numbers::products),
    ("fixed: square roots", numbers::roots),
    ("f32: square roots", numbers::float_roots),
    ("fixed: signs of cross products", numbers::fixed_signs),
    ("f32, f64: signs of cross products", numbers::float_signs),
    ("all formats: slopes and unit vectors", numbers::vectors),
    ("all formats: the same bits as everywhere", numbers::bits),
    ("blob: reads what was written", blob::reads),
    ("blob: rejects every damage", blob::rejects),
    ("blob: errors teach", blob::explains),
    (
        "fixed: hits of every shape",
        hits::every_shape::<crate::Fixed>,
    ),
    ("f32: hits of every shape", hits::every_shape::<f32>),
    ("f64: hits of every shape", hits::every_shape::<f64>),
    ("pixels: encoding", picture::encoding),
    ("fixed: picture", picture::matches::<crate::Fixed>),
    ("f32: picture", picture::matches::<f32>),
    ("f64: picture", picture::matches::<f64>),
];

/// Runs all tests, prints a line for each, and returns the number of failed tests.
pub fn run(host: &mut dyn Host) -> usize {
    let mut failed = 0;
    for (name, case) in CASES {
        let mut checks = Checks::new(&mut *host, name);
        case(&mut checks);
        let failures = checks.failures;
        if failures == 0 {
            host.print(format_args!("ok      {name}"));
        } else {
            host.print(format_args!("FAILED  {name}: {failures} checks"));
            failed += 1;
        }
    }
    host.print(format_args!("{} tests, {failed} failed", CASES.len()));
    failed
}
