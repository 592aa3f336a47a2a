//! The core's tests that run everywhere: on a host by `cargo test`, on a board through whatever
//! it can print with. Needs the feature `selftest`.
//!
//! A test knows nothing of where it runs. What it wants of the world is a [`Host`]; the feature
//! `std` has one, and a board's firmware brings its own.
//!
//! ```text
//! let failures = gridel_core::selftest::run(&mut host);
//! ```

mod blob;
mod hits;
mod numbers;
mod picture;
mod scene;
#[cfg(any(test, feature = "std"))]
mod std_host;

#[cfg(any(test, feature = "std"))]
pub use std_host::StdHost;

#[cfg(test)]
pub(crate) use scene::TinyBlob;

use crate::accel::Number;
use core::ffi::CStr;
use core::fmt;

/// What the tests want of the machine that runs them.
pub trait Host {
    /// Prints a line.
    fn print(&mut self, line: fmt::Arguments<'_>);
    /// Keeps bytes under a name, where a person can look at them. May do nothing.
    fn save(&mut self, name: &CStr, bytes: &[u8]);
}

/// A named test.
type Case = (&'static str, fn(&mut Checks<'_>));

const CASES: [Case; 16] = [
    ("fixed: products and quotients", numbers::products),
    ("fixed: square roots", numbers::roots),
    ("fixed: signs of cross products", numbers::fixed_signs),
    ("f32, f64: signs of cross products", numbers::float_signs),
    ("all formats: slopes and unit vectors", numbers::vectors),
    ("all formats: the same bits as everywhere", numbers::bits),
    ("blob: reads what was written", blob::reads),
    ("blob: refuses every damage", blob::refuses),
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

/// Runs all tests, prints a line for each, and returns how many failed.
pub fn run(host: &mut dyn Host) -> usize {
    let mut failed = 0;
    for (name, case) in CASES {
        let mut checks = Checks {
            host: &mut *host,
            name,
            failures: 0,
        };
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

/// Failures of one test that are printed in full.
const SHOWN: u32 = 5;

/// Checks of one test: a failure is printed, and the test goes on.
struct Checks<'h> {
    host: &'h mut dyn Host,
    name: &'static str,
    failures: u32,
}

impl Checks<'_> {
    /// Checks that `found` is `expected`.
    fn equal<T: PartialEq + fmt::Debug>(
        &mut self,
        what: fmt::Arguments<'_>,
        found: T,
        expected: T,
    ) {
        self.that(
            what,
            found == expected,
            format_args!("is {found:?} and should be {expected:?}"),
        );
    }

    /// Checks that `found` lies within `tolerance` of `expected`.
    fn near(&mut self, what: fmt::Arguments<'_>, found: f64, expected: f64, tolerance: f64) {
        // A NaN is not near anything.
        let near = (found - expected).abs() <= tolerance;
        self.that(
            what,
            near,
            format_args!("is {found} and should be {expected} within {tolerance}"),
        );
    }

    /// Checks a condition; `why` is what else is the case.
    fn that(&mut self, what: fmt::Arguments<'_>, holds: bool, why: fmt::Arguments<'_>) {
        if holds {
            return;
        }
        self.failures += 1;
        if self.failures <= SHOWN {
            let name = self.name;
            self.host.print(format_args!("  {name}: {what} {why}"));
        }
    }
}

/// Numbers that look random and are the same on every machine (Marsaglia, "Xorshift RNGs", 2003).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// An integer of at most `bits` bits and a sign; every magnitude is about as likely.
    fn integer(&mut self, bits: u32) -> i64 {
        let width = self.next() % u64::from(bits) + 1;
        let magnitude = (self.next() >> (64 - width)) as i64;
        if self.next() & 1 == 0 {
            magnitude
        } else {
            -magnitude
        }
    }
}

/// Where the hash of no bytes stands.
const FNV_START: u32 = 0x811c_9dc5;

/// FNV-1a over more bytes.
fn hash(start: u32, bytes: impl IntoIterator<Item = u8>) -> u32 {
    bytes.into_iter().fold(start, |state, byte| {
        (state ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    })
}

/// The name of a number format.
fn name<N: Number>() -> &'static str {
    N::FORMAT.name()
}
