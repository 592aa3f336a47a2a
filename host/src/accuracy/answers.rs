//! The answers at the top of the page: the setting for a given error, the effect of the number format, and what to
//! leave out.

use super::columns::error_figure;
use super::ratio::{ONCE, Ratio};
use super::{Cost, Limits, Parameter, Point, Results, Truth, cheapest};
use crate::table::{counted, significant};
use gridel_core::Format;

/// Error bounds for the answers, the largest first.
const BOUNDS: [f64; 9] = [0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005];

/// Three sentences, or fewer where the results do not have the figures.
pub fn answers(results: &Results) -> Vec<String> {
    let Some(all) = results.start() else {
        return Vec::new();
    };
    let answers = [
        setting_answer(results),
        format_answer(results, all),
        saving_answer(results, all),
    ];
    answers.into_iter().flatten().collect()
}

/// The cheapest settings within two bounds, which differ.
fn setting_answer(results: &Results) -> Option<String> {
    let cheapest_within = |error| {
        let limits = Limits {
            error,
            rays: f64::INFINITY,
        };
        Some((error, cheapest(&results.points, limits, None)?))
    };
    let found = BOUNDS.into_iter().filter_map(cheapest_within);
    let mut found: Vec<(f64, &Point)> = found.collect();
    found.dedup_by(|later, earlier| later.1.name == earlier.1.name);
    // The two smallest bounds that settings keep; coarser ones are rarely useful.
    let kept = found.split_off(found.len().saturating_sub(2));
    let clauses: Vec<String> = kept
        .into_iter()
        .map(|(bound, point)| {
            let within = results.points.iter().filter(|it| it.errors.rmse <= bound);
            let rivals = within.filter(|it| !point.cost.is_below(&it.cost)).count();
            let rivals = match rivals.saturating_sub(1) {
                0 => String::new(),
                rivals => format!("; {} may be as fast", counted(rivals, "other setting")),
            };
            format!(
                "for an error (RMSE) of at most {bound} use {}: {}, error {}{rivals}",
                setting_text(results, point),
                time_text(&point.cost),
                error_figure(point.errors.rmse),
            )
        })
        .collect();
    let text = clauses.join("; ");
    (!text.is_empty()).then(|| format!("{}.", capital(&text)))
}

/// A setting's words, with the number format of the base where they name none.
fn setting_text(results: &Results, point: &Point) -> String {
    let words = point.setting.words(&results.base);
    match point.setting.format == results.base.format {
        true => format!("`{}`, {words}", point.setting.format.name()),
        false => words.replacen(
            point.setting.format.name(),
            &format!("`{}`", point.setting.format.name()),
            1,
        ),
    }
}

/// Returns what the other formats change at the scene file's own setting.
fn format_answer(results: &Results, all: &Point) -> Option<String> {
    let truth = results.reference.truth;
    let from = match truth {
        Truth::F64 => "`f64`",
        Truth::Exact => "the exact picture",
    };
    let clause = |format: Format| {
        let point = results.points.iter().find(|it| {
            it.setting.format == format
                && it
                    .setting
                    .differs(&results.base)
                    .iter()
                    .all(|it| *it == Parameter::Format)
        })?;
        let apart = match point.parts.arithmetic_largest {
            0.0 => match truth {
                Truth::F64 => String::from("draws the picture of `f64` exactly"),
                Truth::Exact => String::from("draws the exact picture"),
            },
            largest => format!(
                "differs from {from} by an RMSE of {} (largest difference {} of 255)",
                error_figure(point.parts.arithmetic),
                significant(255.0 * largest)
            ),
        };
        let own = format == results.base.format;
        let time = if own {
            String::new()
        } else {
            format!(" and {}", ratio_text(&point.cost, &all.cost))
        };
        Some(format!("`{}` {apart}{time}", format.name()))
    };
    let base = results.base.format;
    let others = Format::ALL
        .into_iter()
        .filter(|&it| it != base && (it != Format::F64 || truth == Truth::Exact));
    let clauses: Vec<String> = [base]
        .into_iter()
        .chain(others)
        .filter_map(clause)
        .collect();
    let text = clauses.join("; ");
    (!text.is_empty()).then(|| {
        format!(
            "The number format: {text}; samples and the other settings make an error of {}.",
            error_figure(all.parts.sampling)
        )
    })
}

/// The change of one parameter that adds the least error for the rays and tests that it saves.
fn saving_answer(results: &Results, all: &Point) -> Option<String> {
    let saved = |point: &Point| 1.0 - point.cost.work() / all.cost.work().max(1.0);
    let added = |point: &Point| {
        let lost = point.lost.map_or(0.0, |lost| lost.rmse);
        (point.errors.rmse - all.errors.rmse).max(lost).max(0.0)
    };
    let price = |point: &Point| added(point) / saved(point);
    let alone = results.points.iter().filter(|it| {
        let differs = it.setting.differs(&results.base);
        let single = matches!(differs[..], [one] if one != Parameter::Format);
        let one_effect = it.setting.without.names().count() <= 1;
        single && one_effect && saved(it) > 0.02
    });
    let Some(first) = alone.min_by(|a, b| price(a).total_cmp(&price(b))) else {
        return Some(String::from(
            "Nothing saves more than 2 % of the rays and tests when it is given up alone.",
        ));
    };
    let error = match added(first) {
        added if added < 5e-6 => String::from("adds no error"),
        added => format!("adds an error of {}", error_figure(added)),
    };
    Some(format!(
        "Give up first: {}, which saves {:.0} % of the rays and tests, {}, and {error}.",
        first.setting.words(&results.base),
        100.0 * saved(first),
        ratio_text(&first.cost, &all.cost),
    ))
}

fn time_text(cost: &Cost) -> String {
    let shown = |seconds: f64| match 1e3 * seconds {
        long if long >= 1.0 => format!("{long:.1}"),
        short => format!("{short:.4}"),
    };
    let time = shown(cost.time());
    match cost.interval() {
        Some([least, most]) => format!("{time} ms ({} to {})", shown(least), shown(most)),
        None => format!("{time} ms ({ONCE})"),
    }
}

/// Returns a sentence part that compares a time with another, with its range.
fn ratio_text(cost: &Cost, to: &Cost) -> String {
    let ratio = Ratio::of(cost, to);
    match ratio.ends {
        Some([low, high]) if ratio.is_noise() => {
            format!("shows no difference in time beyond the noise ({low:.2} to {high:.2} times)")
        }
        _ => format!("takes {}", ratio.factor_text()),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|it| it.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
