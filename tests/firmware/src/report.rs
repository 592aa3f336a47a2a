//! The report of a program to the host: one line per figure, a name and a number.

use crate::board::{exit, print};
use crate::measure::Cost;
use core::fmt;

/// Prints a figure.
pub fn line(name: &str, value: u64) {
    print(name);
    print(" ");
    digits(value);
    print("\n");
}

/// Prints the cost of a phase, as far as it is known.
pub fn cost(instructions: &str, stack: &str, cost: Cost) {
    if let Some(count) = cost.instructions {
        line(instructions, count);
    }
    if let Some(bytes) = cost.stack {
        line(stack, bytes as u64);
    }
}

/// Prints a number in the decimal system: without `core::fmt`, which takes more stack than tracing.
fn digits(value: u64) {
    let mut text = [b'0'; 20];
    let mut rest = value;
    let mut used = 1;
    for (place, digit) in text.iter_mut().rev().enumerate() {
        if rest > 0 {
            *digit = b'0' + (rest % 10) as u8;
            rest /= 10;
            used = place + 1;
        }
    }
    let first = text.len().saturating_sub(used);
    let text = text.get(first..).unwrap_or_default();
    print(core::str::from_utf8(text).unwrap_or_default());
}

/// Prints text that has to be put together, which takes more stack.
pub fn words(text: fmt::Arguments<'_>) {
    struct Host;
    impl fmt::Write for Host {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            print(text);
            Ok(())
        }
    }
    // The host takes everything.
    let _ = fmt::Write::write_fmt(&mut Host, text);
}

/// Ends the program with a reason.
pub fn fail(why: &str) -> ! {
    print("failed: ");
    print(why);
    print("\n");
    exit(1)
}
