//! What accuracy costs in time: settings are swept, their pictures measured against a reference, and
//! what comes out is told as a table, as sentences, as plots.
//!
//! `setting.rs` says what is swept, `measure.rs` renders and compares (`flip.rs` as an eye would),
//! `boards.rs` knows what a picture costs on boards, `page.rs` draws.

pub mod boards;
mod flip;
mod measure;
mod page;
mod setting;
mod ssim;

pub use measure::{
    Bench, Cost, Errors, MeasureError, Point, Reference, difference_picture, reference_setting,
};
pub use page::{Exhibit, page};
pub use setting::{Lever, Setting, least_reference_samples, sweep};

use crate::report::significant;
use serde::{Deserialize, Serialize};

/// What was measured so far; what a sweep writes down after every step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Of what: the program's version, the scene, the picture's size, the structure, the reference.
    pub key: String,
    pub base: Setting,
    pub reference: Reference,
    pub points: Vec<Point>,
}

impl Results {
    /// A point by its setting.
    pub fn point(&mut self, setting: &Setting) -> Option<&mut Point> {
        self.points.iter_mut().find(|p| p.setting == *setting)
    }
}

/// Which points nothing beats: no other is as fast and as right, and better in one of the two.
pub fn frontier(points: &[Point]) -> Vec<bool> {
    let beats = |a: &Point, b: &Point| {
        let (time, error) = (a.cost.time() - b.cost.time(), a.errors.rmse - b.errors.rmse);
        time <= 0.0 && error <= 0.0 && (time < 0.0 || error < 0.0)
    };
    let unbeaten = |b: &Point| !points.iter().any(|a| beats(a, b));
    points.iter().map(unbeaten).collect()
}

/// The cheapest point whose root mean square error is within a bound: by time on this machine, or
/// by instructions on a board, at the most that they may be.
pub fn cheapest<'p>(points: &'p [Point], most: f64, board: Option<&str>) -> Option<&'p Point> {
    let price = |point: &Point| match board {
        None => Some(point.cost.time()),
        Some(board) => boards::instructions(board, point).map(|[_, most]| most),
    };
    points
        .iter()
        .filter(|point| point.errors.rmse <= most)
        .filter_map(|point| Some((price(point)?, point)))
        .min_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, point)| point)
}

/// One sentence for each lever that was turned: what it costs and what it saves.
pub fn sentences(base: &Setting, points: &[Point]) -> Vec<String> {
    let Some(start) = points.iter().find(|point| point.setting == *base) else {
        return Vec::new();
    };
    let alone = |lever: Lever| -> Vec<&Point> {
        let turned = points.iter().filter(|p| p.setting.differs(base) == [lever]);
        turned.chain([start]).collect()
    };
    let mut sentences = Vec::new();
    for point in alone(Lever::Format) {
        if point.setting != *base {
            sentences.push(format!(
                "`{}` instead of `{}` takes {} the time and makes the error {} as large.",
                point.setting.format.name(),
                base.format.name(),
                factor(point.cost.time() / start.cost.time()),
                factor(point.errors.rmse / start.errors.rmse),
            ));
        }
    }
    type Place = fn(&Setting) -> f64;
    let numeric: [(Lever, Place, f64, &str); 4] = [
        (
            Lever::Samples,
            |s| -f64::from(s.samples).log2(),
            1.0,
            "Halving the samples a pixel",
        ),
        (
            Lever::LatticeBits,
            |s| -f64::from(s.lattice_bits),
            4.0,
            "Giving up four bits of the lattice",
        ),
        (
            Lever::Depth,
            |s| -f64::from(s.depth),
            1.0,
            "One reflection or refraction less",
        ),
        (
            Lever::Cutoff,
            |s| s.cutoff.log2(),
            2.0,
            "A cut-off four times as high",
        ),
    ];
    for (lever, place, step, what) in numeric {
        let mut turned: Vec<(f64, &Point)> = alone(lever)
            .into_iter()
            .map(|point| (place(&point.setting), point))
            .filter(|(place, _)| place.is_finite())
            .collect();
        turned.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let (Some((from, first)), Some((to, last))) = (turned.first(), turned.last()) else {
            continue;
        };
        if from == to {
            continue;
        }
        let each = |ratio: f64| ratio.powf(step / (to - from));
        let bytes = last.cost.blob_bytes as f64 / first.cost.blob_bytes as f64;
        let memory = if lever == Lever::LatticeBits {
            format!(", and {} of the blob", part(1.0 - each(bytes)))
        } else {
            String::new()
        };
        sentences.push(format!(
            "{what} saves {} of the time{memory}, and makes the error {} as large, on average from {} \
             to {}; that is {} of display white at the first and {} at the last.",
            part(1.0 - each(last.cost.time() / first.cost.time())),
            factor(each(last.errors.rmse / first.errors.rmse)),
            first.setting.value(lever),
            last.setting.value(lever),
            significant(round(first.errors.rmse)),
            significant(round(last.errors.rmse)),
        ));
    }
    sentences
}

fn round(value: f64) -> f64 {
    (value * 1e5).round() / 1e5
}

fn factor(ratio: f64) -> String {
    format!("{ratio:.2} times")
}

fn part(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}
