//! Checks of the feature `strict-ranges`: numbers stay in their ranges.

use core::cell::Cell;

std::thread_local! {
    static WRAPS: Cell<bool> = const { Cell::new(false) };
}

/// Panics where a number left its range, except in [`let_numbers_wrap`].
#[track_caller]
pub(super) fn check(in_range: bool) {
    assert!(in_range || WRAPS.get(), "a number left its range");
}

/// Runs a function in which this thread's numbers wrap, as they do without the feature `strict-ranges`. For blobs that
/// are not proved.
pub fn let_numbers_wrap<T>(run: impl FnOnce() -> T) -> T {
    let before = WRAPS.replace(true);
    let result = run();
    WRAPS.set(before);
    result
}
