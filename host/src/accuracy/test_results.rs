//! Results for tests, without a picture.

use super::{Cost, ErrorParts, Point, Reference, Results, Setting, Truth};
use crate::measure::Errors;
use gridel_core::{Effects, Format};

pub const BASE: Setting = Setting {
    format: Format::F32,
    lattice_bits: 24,
    samples: 16,
    depth: 6,
    cutoff: 0.0,
    without: Effects::NONE,
};

pub fn point(setting: Setting, rmse: f64, seconds: &[f64], work: u64) -> Point {
    Point {
        name: setting.name(),
        setting,
        errors: Errors {
            rmse,
            largest: rmse,
            pixels_off: 0,
            ssim: 1.0,
            flip: 0.0,
            other_objects: 0,
            t_ulps: [0.0; 2],
        },
        parts: ErrorParts {
            sampling: rmse,
            arithmetic: 0.0,
            arithmetic_largest: 0.0,
            open: 0,
        },
        lost: None,
        cost: Cost {
            seconds: seconds.to_vec(),
            pixels: 100,
            rays: work,
            tests: 10 * work,
            blob_bytes: 1000,
            working_bytes: 100,
        },
    }
}

pub fn with(format: Format) -> Setting {
    Setting { format, ..BASE }
}

pub fn results(points: Vec<Point>) -> Results {
    Results {
        key: String::new(),
        base: BASE,
        instances: None,
        reference: Reference {
            samples: 32,
            cutoff: 0.0,
            truth: Truth::F64,
            open: 0,
            pixels: Vec::new(),
            hits: Vec::new(),
        },
        points,
        effects: Vec::new(),
    }
}
