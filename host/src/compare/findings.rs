//! Sentences about the structures that do better than each.

use super::{Comparison, Row};
use crate::table::grouped;
use gridel_core::Structure;

/// A figure that is compared between rows.
struct Measure {
    /// A description of a row whose figure is worse, before `than` and after it.
    worse: [&'static str; 2],
    of: fn(&Row) -> Option<f64>,
    more_is_better: bool,
    /// `true` if it is a time, which needs several repeats.
    timed: bool,
}

impl Measure {
    const fn rate(rays: &'static str, of: fn(&Row) -> Option<f64>) -> Self {
        Self {
            worse: ["slower", rays],
            of,
            more_is_better: true,
            timed: true,
        }
    }

    const fn counted(worse: &'static str, of: fn(&Row) -> Option<f64>) -> Self {
        Self {
            worse: [worse, ""],
            of,
            more_is_better: false,
            timed: false,
        }
    }
}

const MEASURES: [Measure; 7] = [
    Measure::rate(" for primary rays", primary_rate),
    Measure::rate(" for shadow rays", shadow_rate),
    Measure::rate(" for bounced rays", bounced_rate),
    Measure::counted("more tests per ray", tests),
    Measure::counted("more bytes", |row| Some(row.own_bytes as f64)),
    Measure {
        timed: true,
        ..Measure::counted("slower to build", |row| Some(row.setup_seconds))
    },
    Measure::counted("more working RAM", |row| Some(row.stack_bytes as f64)),
];

/// Fewest repeats whose times are compared.
const REPEATS: usize = 3;

pub(super) fn primary_rate(row: &Row) -> Option<f64> {
    row.work?.primary.rays_per_second
}

pub(super) fn shadow_rate(row: &Row) -> Option<f64> {
    row.work?.shadow?.rays_per_second
}

pub(super) fn bounced_rate(row: &Row) -> Option<f64> {
    row.work?.bounced?.rays_per_second
}

/// Tests per ray, as [`gridel_core::Counters::tests`] counts them.
fn tests(row: &Row) -> Option<f64> {
    let all = row.work?.all;
    Some(all.boxes + all.cells + all.primitives)
}

/// Ratio up to which figures count as equal: the noise of a shared machine.
const NOISE: f64 = 1.03;

/// A factor with the digits that mean something.
fn times(factor: f64) -> String {
    match factor {
        _ if !factor.is_finite() => String::from("takes none"),
        1e6.. => String::from("more than a million times"),
        100.0.. => format!("{} times", grouped(factor.round())),
        10.0.. => format!("{factor:.1} times"),
        _ => format!("{factor:.2} times"),
    }
}

/// Returns a sentence per structure: which others are better, and in times only if these were repeated; a last one says
/// if they were not. The list needs no time to build and no memory, so its zeros do not count.
pub fn findings(comparison: &Comparison) -> Vec<String> {
    let are_timed = comparison.repeats >= REPEATS;
    let rejected = comparison.rejected.iter();
    let mut findings: Vec<_> = rejected.map(|rejected| rejected.why.clone()).collect();
    let rows = comparison.rows.iter();
    findings.extend(rows.map(|row| match row.wrong {
        Some(_) => format!("{} is wrong", row.name),
        None => finding(row, &comparison.rows, are_timed),
    }));
    if !are_timed {
        findings.push(format!(
            "times were not compared: fewer than {REPEATS} repeats"
        ));
    }
    findings
}

/// The sentence of a row, by its counts, and by times if they count.
fn finding(row: &Row, rows: &[Row], are_timed: bool) -> String {
    let list = Structure::List.name();
    let rivals = rows
        .iter()
        .filter(|other| other.structure != list || row.structure == list);
    let measures = MEASURES.into_iter().filter(|it| !it.timed || are_timed);
    let worse = measures.filter_map(|measure| {
        let factor = |other: &Row| {
            let (own, others) = ((measure.of)(row)?, (measure.of)(other)?);
            let factor = match measure.more_is_better {
                true => others / own,
                false => own / others,
            };
            (factor > NOISE).then_some(factor)
        };
        let better = rivals
            .clone()
            .filter_map(|other| Some((factor(other)?, &other.name)));
        let (factor, rival) = better.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let [what, on] = measure.worse;
        Some(format!("{what} than {rival}{on} ({})", times(factor)))
    });
    let worse: Vec<String> = worse.collect();
    let name = &row.name;
    if !worse.is_empty() {
        return format!("{name}: {}", worse.join(", "));
    }
    let figures = match are_timed {
        true => "time, tests per ray, bytes or working RAM",
        false => "tests per ray, bytes or working RAM",
    };
    format!("{name}: no other structure is more than 3 % better in {figures}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::RayCounts;

    #[test]
    fn factors_have_digits_that_mean_something() {
        let factors = [1.034, 12.34, 1234.5, 13_359_738.99, f64::INFINITY];
        assert_eq!(
            factors.map(times),
            [
                "1.03 times",
                "12.3 times",
                "1,235 times",
                "more than a million times",
                "takes none"
            ]
        );
    }

    fn row(structure: &'static str, own_bytes: usize, setup_seconds: f64) -> Row {
        Row {
            name: structure.to_owned(),
            structure,
            builder: None,
            sah_cost: None,
            setup_seconds,
            peak_bytes: None,
            own_bytes,
            blob_bytes: 1000 + own_bytes,
            longest_list: 1,
            stack_bytes: 12,
            wrong: None,
            work: None,
        }
    }

    /// Times that were not repeated are neither compared nor claimed to be.
    #[test]
    fn times_of_few_repeats_are_said_not_to_be_compared() {
        let mut comparison = Comparison {
            format: "f32",
            size: [8, 8],
            repeats: 2,
            primitives: 1,
            instances: None,
            rays: RayCounts {
                primary: 64,
                shadow: 0,
                bounced: 0,
            },
            listed: 64,
            rows: vec![row("bvh", 100, 2.0), row("wide", 200, 1.0)],
            rejected: Vec::new(),
            warnings: Vec::new(),
        };
        assert_eq!(
            findings(&comparison),
            [
                "bvh: no other structure is more than 3 % better in tests per ray, bytes or working RAM",
                "wide: more bytes than bvh (2.00 times)",
                "times were not compared: fewer than 3 repeats",
            ]
        );
        comparison.repeats = 3;
        assert_eq!(
            findings(&comparison),
            [
                "bvh: slower to build than wide (2.00 times)",
                "wide: more bytes than bvh (2.00 times)",
            ]
        );
        comparison.rows.pop();
        assert_eq!(
            findings(&comparison),
            [
                "bvh: no other structure is more than 3 % better in time, tests per ray, bytes or working RAM"
            ]
        );
    }
}
