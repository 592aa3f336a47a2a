//! The amount of tests: a part in the ordinary run, all that the project promises on request.

use std::env;

/// Returns whether the environment requests all that the project promises, by `GRIDEL_FULL=1`.
pub fn full() -> bool {
    env::var_os("GRIDEL_FULL").is_some_and(|value| value == "1")
}

/// `quick`, or `full` where the environment says `GRIDEL_FULL=1`.
pub fn part_of(quick: usize, full: usize) -> usize {
    if self::full() { full } else { quick }
}

/// Returns the stride of the longest tests over many similar cases: 1 where the environment has
/// `GRIDEL_FULL=1`, or else 15: then every bit of a byte is met, in some byte.
pub fn step() -> usize {
    part_of(15, 1)
}

/// `count` where the environment says `GRIDEL_FULL=1`, or else a sixth of it: for the longest tests.
pub fn sixth_of(count: usize) -> usize {
    part_of(count.div_ceil(6), count)
}
