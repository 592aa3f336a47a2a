//! The cost of accuracy in time. Sweeps settings, measures their pictures against a reference, and prints the results
//! as a table, as sentences and as plots.
//!
//! | file | what it does |
//! |---|---|
//! | `setting.rs` | what is swept |
//! | `bench.rs`, `plan.rs` | renders and compares; what later settings need |
//! | `truth.rs` | what pictures are compared with |
//! | `columns.rs` | the figures of a setting, in columns |
//! | `effects.rs` | what each effect costs |
//! | `answers.rs` | the answers in three sentences |
//! | `page.rs`, `page.html` | the page, and its template |
//! | `plot.rs` | the plot for documents |
//! | `instances.rs` | what became of instances |

mod answers;
mod bench;
mod columns;
mod effects;
mod instances;
mod page;
mod plan;
#[cfg(not(target_family = "wasm"))]
mod plot;
mod setting;
mod truth;

pub use answers::answers;
pub use bench::{Bench, Cost, ErrorParts, MeasureError, Point, Reference};
pub use columns::COLUMNS;
pub use effects::{BOARD, EffectCost, effect_costs, given_up};
pub use instances::instance_notes;
pub use page::{MOST_PICTURE_BYTES, PagePicture, page};
#[cfg(not(target_family = "wasm"))]
pub use plot::plot;
pub use setting::{
    MOST_MEASURED_SAMPLES, Parameter, Setting, least_reference_samples, reference_setting, sweep,
};
pub use truth::Truth;

use crate::measure::InstanceCount;
use crate::table::significant;
use serde::{Deserialize, Serialize};

/// The measurements so far; a sweep writes them every few seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Identifies the sweep: the program's version, the scene, the picture's size, the structure, the reference.
    pub key: String,
    pub base: Setting,
    /// The treatment of the scene's instances; `None` without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instances: Option<InstanceCount>,
    pub reference: Reference,
    pub points: Vec<Point>,
    /// The cost of each effect, in the order in which to leave them out; empty until all is measured.
    #[serde(default)]
    pub effects: Vec<EffectCost>,
}

impl Results {
    /// Returns a point by its setting.
    pub fn point(&mut self, setting: &Setting) -> Option<&mut Point> {
        self.points.iter_mut().find(|p| p.setting == *setting)
    }
}

/// Returns which points are on the Pareto frontier: no other dominates them. A point dominates another if its error is no
/// larger, its cost certainly no higher, and one of the two is better. Costs are those of [`Cost::is_below`].
pub fn frontier(points: &[Point]) -> Vec<bool> {
    frontier_by(points, |point| point.errors.rmse)
}

/// Returns the frontier by another error.
pub fn frontier_by(points: &[Point], error: impl Fn(&Point) -> f64) -> Vec<bool> {
    let dominates = |a: &Point, b: &Point| {
        let cheaper = a.is_cheaper(b);
        let costs_no_more = cheaper || a.same_work(b);
        let (a, b) = (error(a), error(b));
        costs_no_more && a <= b && (cheaper || a < b)
    };
    let is_best = |b: &Point| !points.iter().any(|a| dominates(a, b));
    points.iter().map(is_best).collect()
}

impl Point {
    /// Returns whether the point certainly costs less: by time where the repeats of both are distinct. Otherwise rays
    /// and tests decide, which repeat exactly and compare within a number format.
    fn is_cheaper(&self, other: &Self) -> bool {
        if self.cost.is_below(&other.cost) {
            return true;
        }
        let (own, others) = (&self.cost, &other.cost);
        self.setting.format == other.setting.format
            && !others.is_below(own)
            && own.rays <= others.rays
            && own.tests <= others.tests
            && !self.same_work(other)
    }

    /// Returns whether both cast the same rays and make the same tests in the same format, and their times
    /// do not differ.
    fn same_work(&self, other: &Self) -> bool {
        let work = |point: &Self| (point.setting.format, point.cost.rays, point.cost.tests);
        work(self) == work(other) && !other.cost.is_below(&self.cost)
    }
}

/// Limits of a search.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Largest root mean square error.
    pub error: f64,
    /// Most rays per pixel.
    pub rays: f64,
}

impl Limits {
    /// Limits of an error alone.
    pub fn of_error(error: f64) -> Self {
        Self {
            error,
            rays: f64::INFINITY,
        }
    }

    /// Returns whether a point is within.
    pub fn hold(&self, point: &Point) -> bool {
        point.errors.rmse <= self.error && point.rays_per_pixel() <= self.rays
    }
}

/// Returns the point with the smallest error that casts no more rays per pixel; of several the one with the fewest rays
/// and tests.
pub fn most_accurate<'p>(points: &'p [Point], rays: f64, board: Option<&str>) -> Option<&'p Point> {
    let key = |point: &&Point| {
        (
            point.errors.rmse,
            (point.cost.rays + point.cost.tests) as f64,
        )
    };
    points
        .iter()
        .filter(|point| point.rays_per_pixel() <= rays)
        .filter(|point| board.is_none_or(|board| point.instructions(board).is_some()))
        .min_by(|a, b| {
            let ((a, more), (b, less)) = (key(a), key(b));
            a.total_cmp(&b).then(more.total_cmp(&less))
        })
}

/// Returns the cheapest point whose root mean square error is within a bound. The cost is time on this machine, or the
/// upper estimate of instructions on a board.
pub fn cheapest<'p>(points: &'p [Point], most: f64, board: Option<&str>) -> Option<&'p Point> {
    cheapest_within(points, Limits::of_error(most), board)
}

/// Returns the cheapest point within limits of error and rays: see [`cheapest`].
pub fn cheapest_within<'p>(
    points: &'p [Point],
    limits: Limits,
    board: Option<&str>,
) -> Option<&'p Point> {
    let price = |point: &Point| match board {
        None => Some(point.cost.time()),
        Some(board) => point.instructions(board).map(|[_, most]| most),
    };
    points
        .iter()
        .filter(|point| limits.hold(point))
        .filter_map(|point| Some((price(point)?, point)))
        .min_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, point)| point)
}

/// Returns one sentence for each parameter that was changed: its cost and its saving.
pub fn sentences(base: &Setting, points: &[Point]) -> Vec<String> {
    let Some(start) = points.iter().find(|point| point.setting == *base) else {
        return Vec::new();
    };
    let alone = |parameter: Parameter| -> Vec<&Point> {
        let turned = points
            .iter()
            .filter(|p| p.setting.differs(base) == [parameter]);
        turned.chain([start]).collect()
    };
    let mut sentences = Vec::new();
    for point in alone(Parameter::Format) {
        if point.setting != *base {
            let ratio = Ratio::of(&point.cost, &start.cost);
            let time = match ratio.is_noise() {
                true => format!("shows {}", ratio.noise_text()),
                false => format!("takes {}", ratio.factor_text()),
            };
            sentences.push(format!(
                "`{}` instead of `{}` {time}, and {}.",
                point.setting.format.name(),
                base.format.name(),
                error_text(start.errors.rmse, point.errors.rmse, |ratio| ratio),
            ));
        }
    }
    type Position = fn(&Setting) -> f64;
    let numeric: [(Parameter, Position, f64, &str); 4] = [
        (
            Parameter::Samples,
            |s| -f64::from(s.samples).log2(),
            1.0,
            "Halving the samples per pixel",
        ),
        (
            Parameter::LatticeBits,
            |s| -f64::from(s.lattice_bits),
            4.0,
            "Giving up four bits of the lattice",
        ),
        (
            Parameter::Depth,
            |s| -f64::from(s.depth),
            1.0,
            "One reflection or refraction less",
        ),
        (
            Parameter::Cutoff,
            |s| s.cutoff.log2(),
            2.0,
            "A cut-off four times as high",
        ),
    ];
    for (parameter, place, step, what) in numeric {
        let mut turned: Vec<(f64, &Point)> = alone(parameter)
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
        let memory = if parameter == Parameter::LatticeBits {
            let saved = 1.0 - each(bytes);
            let verb = if saved < 0.0 { "adds" } else { "saves" };
            format!(", {verb} {} of the blob", part(saved.abs()))
        } else {
            String::new()
        };
        let ratio = Ratio::of(&last.cost, &first.cost).map(each);
        let time = match ratio.is_noise() {
            true => format!("shows {}", ratio.noise_text()),
            false => ratio.saving_text(),
        };
        sentences.push(format!(
            "{what} {time}{memory}, and {}, on average from {} to {}; that is {} of display white at the \
             first and {} at the last.",
            error_text(first.errors.rmse, last.errors.rmse, each),
            first.setting.value(parameter),
            last.setting.value(parameter),
            significant(round(first.errors.rmse)),
            significant(round(last.errors.rmse)),
        ));
    }
    sentences
}

/// A ratio of times, and its range by the repeats of both; `None` where one was timed once.
#[derive(Clone, Copy, Debug)]
struct Ratio {
    median: f64,
    ends: Option<[f64; 2]>,
}

impl Ratio {
    fn of(cost: &Cost, to: &Cost) -> Self {
        let ends = cost.interval().zip(to.interval());
        Self {
            median: cost.time() / to.time(),
            ends: ends.map(|([low, high], [least, most])| [low / most, high / least]),
        }
    }

    /// The ratio after a function that grows.
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self {
            median: function(self.median),
            ends: self.ends.map(|ends| ends.map(&function)),
        }
    }

    /// Returns whether it may as well be 1.
    fn is_noise(&self) -> bool {
        self.ends
            .is_some_and(|[low, high]| low <= 1.0 && 1.0 <= high)
    }

    fn noise_text(&self) -> String {
        let [low, high] = self.ends.unwrap_or([1.0; 2]);
        let noise = (high - 1.0).max(1.0 - low);
        format!("no difference in time beyond the noise of {}", part(noise))
    }

    fn factor_text(&self) -> String {
        let within = match self.ends {
            Some([low, high]) => format!("{low:.2} to {high:.2}"),
            None => String::from(ONCE),
        };
        format!("{} the time ({within})", factor(self.median))
    }

    fn saving_text(&self) -> String {
        let saves = self.median < 1.0;
        let share = |ratio: f64| 100.0 * (1.0 - ratio).abs();
        let within = match self.ends {
            Some(ends) => {
                let [mut low, mut high] = ends.map(share);
                if saves {
                    (low, high) = (high, low);
                }
                format!("{low:.0} to {high:.0} %")
            }
            None => String::from(ONCE),
        };
        let median = share(self.median);
        match saves {
            true => format!("saves {median:.0} % of the time ({within})"),
            false => format!("takes {median:.0} % more time ({within})"),
        }
    }
}

/// The text for times without repeats.
const ONCE: &str = "timed once, so its noise is unknown";

/// Says how an error changes; `each` returns the ratio per step.
fn error_text(from: f64, to: f64, each: impl Fn(f64) -> f64) -> String {
    match (from, to) {
        (0.0, 0.0) => String::from("leaves the error at 0"),
        (0.0, _) => format!("makes an error of {} out of none", significant(to)),
        _ => format!("makes the error {} as large", factor(each(to / from))),
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Errors;
    use gridel_core::{Effects, Format};

    const BASE: Setting = Setting {
        format: Format::F32,
        lattice_bits: 24,
        samples: 16,
        depth: 6,
        cutoff: 0.0,
        without: Effects::NONE,
    };

    fn point(setting: Setting, rmse: f64, seconds: &[f64], work: u64) -> Point {
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

    fn with(format: Format) -> Setting {
        Setting { format, ..BASE }
    }

    #[test]
    fn frontier_keeps_settings_whose_times_differ_by_noise() {
        // As right, and now one, now the other is faster: none dominates.
        let [slow, fast] = [&[1.0, 1.3, 4.9][..], &[1.1, 1.2, 1.25]];
        let points = [
            point(BASE, 0.1, slow, 100),
            point(with(Format::F64), 0.1, fast, 100),
        ];
        assert_eq!(frontier(&points), [true, true]);
        // A little more right, within noise: the times do not decide, and formats' tests differ in cost.
        let points = [
            point(BASE, 0.1, slow, 100),
            point(with(Format::F64), 0.09, fast, 90),
        ];
        assert_eq!(frontier(&points), [true, true]);
    }

    #[test]
    fn frontier_drops_what_is_slower_beyond_the_spread() {
        let points = [
            point(BASE, 0.1, &[1.0, 1.1, 1.2], 100),
            point(with(Format::F64), 0.1, &[1.3, 1.4, 9.0], 100),
        ];
        assert_eq!(frontier(&points), [true, false]);
    }

    #[test]
    fn frontier_goes_by_rays_and_tests_where_times_are_noise() {
        let fewer = Setting { depth: 5, ..BASE };
        let more = |seconds| point(BASE, 0.1, seconds, 100);
        let less = |seconds| point(fewer, 0.1, seconds, 90);
        assert_eq!(
            frontier(&[more(&[1.0, 1.5]), less(&[1.1, 1.6])]),
            [false, true]
        );
        // A single repeat has no spread.
        assert_eq!(frontier(&[more(&[1.0]), less(&[1.1])]), [false, true]);
        // Where times differ beyond their spread, they count.
        assert_eq!(
            frontier(&[more(&[1.0, 1.05]), less(&[1.1, 1.6])]),
            [true, false]
        );
    }

    #[test]
    fn sentences_carry_the_spread_of_times() {
        let half = Setting { samples: 8, ..BASE };
        let verdict_text = |base: &[f64], fixed: &[f64], halved: &[f64]| {
            let points = [
                point(BASE, 0.1, base, 100),
                point(with(Format::Fixed), 0.2, fixed, 100),
                point(half, 0.15, halved, 50),
            ];
            sentences(&BASE, &points).join("\n")
        };
        let text = verdict_text(&[1.0, 1.0, 1.1], &[2.0, 2.1, 2.2], &[0.55, 0.56, 0.6]);
        for part in [
            "takes 2.10 times the time (1.82 to 2.20)",
            "error 2.00 times as large",
            "saves 44 % of the time (40 to 50 %)",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let text = verdict_text(&[1.0, 1.0, 1.07], &[1.0, 1.02, 1.05], &[0.98, 1.02, 1.04]);
        for part in [
            "`fixed` instead of `f32` shows no difference in time beyond the noise of 7 %",
            "shows no difference in time beyond the noise of 8 %",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(!text.contains("saves"), "{text}");
        // More time is said to be more, and a single repeat to be one.
        let text = verdict_text(&[1.0, 1.0], &[2.0, 2.0], &[1.5, 1.6]);
        assert!(text.contains("takes 55 % more time (50 to 60 %)"), "{text}");
        let text = verdict_text(&[1.0], &[2.0], &[0.5]);
        let once = text.matches("timed once, so its noise is unknown").count();
        assert_eq!(once, 2, "{text}");
    }

    #[test]
    fn sentences_without_an_error_to_compare_name_it() {
        let points = [
            point(BASE, 0.0, &[1.0, 1.0], 100),
            point(with(Format::Fixed), 0.25, &[2.0, 2.0], 100),
            point(with(Format::F64), 0.0, &[2.0, 2.0], 100),
        ];
        let text = sentences(&BASE, &points).join("\n");
        assert!(text.contains("an error of 0.25 out of none"), "{text}");
        assert!(text.contains("leaves the error at 0"), "{text}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}
