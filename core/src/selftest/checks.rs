//! Checks that print failures, and computations that tests share.

use crate::accel::Number;
use core::ffi::CStr;
use core::fmt;

/// The machine that runs the tests.
pub trait Host {
    /// Prints a line.
    fn print(&mut self, line: fmt::Arguments<'_>);
    /// Saves bytes under a name, where a person can look at them. An implementation can do nothing.
    fn save(&mut self, name: &CStr, bytes: &[u8]);
}

/// Failures of one test that are printed in full.
const SHOWN: u32 = 5;

/// Checks of one test: a failure is printed, and the test continues.
pub(super) struct Checks<'h> {
    pub(super) host: &'h mut dyn Host,
    name: &'static str,
    pub(super) failures: u32,
}

impl<'h> Checks<'h> {
    pub(super) fn new(host: &'h mut dyn Host, name: &'static str) -> Self {
        Self {
            host,
            name,
            failures: 0,
        }
    }

    /// Checks that `found` is `expected`.
    pub(super) fn equal<T: PartialEq + fmt::Debug>(
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
    pub(super) fn near(
        &mut self,
        what: fmt::Arguments<'_>,
        found: f64,
        expected: f64,
        tolerance: f64,
    ) {
        // A NaN is not near anything.
        let near = (found - expected).abs() <= tolerance;
        self.that(
            what,
            near,
            format_args!("is {found} and should be {expected} within {tolerance}"),
        );
    }

    /// Checks a condition; `why` describes the failure.
    pub(super) fn that(&mut self, what: fmt::Arguments<'_>, holds: bool, why: fmt::Arguments<'_>) {
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

/// Pseudo-random numbers, the same on every machine (Marsaglia, "Xorshift RNGs", 2003).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Returns an integer of at most `bits` bits and a sign; every magnitude is about equally
    /// likely.
    pub(super) fn integer(&mut self, bits: u32) -> i64 {
        let width = self.next() % u64::from(bits) + 1;
        let magnitude = (self.next() >> (64 - width)) as i64;
        if self.next() & 1 == 0 {
            magnitude
        } else {
            -magnitude
        }
    }
}

/// The hash of no bytes.
pub(super) const FNV_START: u32 = 0x811c_9dc5;

/// Adds bytes to an FNV-1a hash.
pub(super) fn hash(start: u32, bytes: impl IntoIterator<Item = u8>) -> u32 {
    bytes.into_iter().fold(start, |state, byte| {
        (state ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    })
}

/// The name of a number format.
pub(super) fn name<N: Number>() -> &'static str {
    N::FORMAT.name()
}
