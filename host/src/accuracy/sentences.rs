//! The cost and the saving of each parameter in one sentence.

use super::columns::error_figure;
use super::ratio::{Ratio, factor, part};
use super::{Parameter, Point, Results, Setting};
use crate::table::significant;

/// Returns one sentence for each parameter that was changed: its cost and its saving.
pub fn sentences(results: &Results) -> Vec<String> {
    let Some(start) = results.start() else {
        return Vec::new();
    };
    let (base, points) = (&results.base, &results.points);
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
            error_figure(first.errors.rmse),
            error_figure(last.errors.rmse),
        ));
    }
    sentences
}

/// Says how an error changes; `each` returns the ratio per step.
fn error_text(from: f64, to: f64, each: impl Fn(f64) -> f64) -> String {
    match (from, to) {
        (0.0, 0.0) => String::from("leaves the error at 0"),
        (0.0, _) => format!("makes an error of {} out of none", significant(to)),
        (_, 0.0) => format!("removes an error of {}", significant(from)),
        _ => format!("makes the error {} as large", factor(each(to / from))),
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_results::{BASE, point, results, with};
    use super::*;
    use gridel_core::Format;

    #[test]
    fn sentences_carry_the_spread_of_times() {
        let half = Setting { samples: 8, ..BASE };
        let verdict_text = |base: &[f64], fixed: &[f64], halved: &[f64]| {
            let points = vec![
                point(BASE, 0.1, base, 100),
                point(with(Format::Fixed), 0.2, fixed, 100),
                point(half, 0.15, halved, 50),
            ];
            sentences(&results(points)).join("\n")
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
        let points = vec![
            point(BASE, 0.0, &[1.0, 1.0], 100),
            point(with(Format::Fixed), 0.25, &[2.0, 2.0], 100),
            point(with(Format::F64), 0.0, &[2.0, 2.0], 100),
        ];
        let text = sentences(&results(points)).join("\n");
        assert!(text.contains("an error of 0.25 out of none"), "{text}");
        assert!(text.contains("leaves the error at 0"), "{text}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}
