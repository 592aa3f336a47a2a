//! How much is tested: a part in the ordinary run, all that the project promises on demand.

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
/// `GRIDEL_FULL=1`, or else 3.
pub fn step() -> usize {
    if third_of(3) == 3 { 1 } else { 3 }
}

/// `count` where the environment says `GRIDEL_FULL=1`, or else a third of it: for the longest tests.
pub fn third_of(count: usize) -> usize {
    part_of(count.div_ceil(3), count)
}
