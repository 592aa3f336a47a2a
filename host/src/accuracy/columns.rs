//! The columns of settings in tables, the same on the page and in the terminal.

use super::bench::Point;
use crate::table::{grouped, significant};

/// The columns' titles.
pub const COLUMNS: [&str; 16] = [
    "ms",
    "spread",
    "RMSE",
    "sampling",
    "arithmetic",
    "largest",
    "pixels off",
    "SSIM",
    "FLIP",
    "other objects",
    "t, median",
    "t, largest",
    "rays per pixel",
    "tests per ray",
    "blob",
    "RAM",
];

/// A small figure, to five decimals.
pub(super) fn figure(value: f64) -> String {
    significant((value * 1e5).round() / 1e5)
}

/// An error in words, which is 0 only where there is none.
pub(super) fn error_figure(error: f64) -> String {
    match 0.0 < error && error < 5e-6 {
        true => String::from("less than 0.00001"),
        false => figure(error),
    }
}

impl Point {
    /// The setting's figures, column by column.
    pub fn cells(&self) -> [String; COLUMNS.len()] {
        let Self {
            errors,
            parts,
            cost,
            ..
        } = self;
        let share = |share: f64| format!("{share:.5}");
        [
            format!("{:.2}", 1e3 * cost.time()),
            cost.spread_text(),
            share(errors.rmse),
            share(parts.sampling),
            share(parts.arithmetic),
            share(errors.largest),
            grouped(errors.pixels_off),
            share(errors.ssim),
            share(errors.flip),
            grouped(errors.other_objects),
            significant((100.0 * errors.t_ulps[0]).round() / 100.0),
            significant(errors.t_ulps[1].round()),
            format!("{:.2}", self.rays_per_pixel()),
            format!("{:.1}", cost.tests as f64 / cost.rays.max(1) as f64),
            grouped(cost.blob_bytes),
            grouped(cost.working_bytes),
        ]
    }
}
