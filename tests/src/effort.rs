//! How much is tested: a part in the ordinary run, all that the project promises on demand.

/// `quick`, or `full` where the environment says `GRIDEL_FULL=1`.
pub fn part_of(quick: usize, full: usize) -> usize {
    if std::env::var_os("GRIDEL_FULL").is_some_and(|value| value == "1") {
        full
    } else {
        quick
    }
}
