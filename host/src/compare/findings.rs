//! Sentences about where each structure is beaten.

use super::{Comparison, Row};
use crate::table::grouped;
use gridel_core::Structure;

/// A figure that is compared between rows.
struct Measure {
    name: &'static str,
    of: fn(&Row) -> Option<f64>,
    more_is_better: bool,
    /// `true` if it is a time, which needs several repeats.
    timed: bool,
}

impl Measure {
    const fn timed(name: &'static str, of: fn(&Row) -> Option<f64>, more_is_better: bool) -> Self {
        Self {
            name,
            of,
            more_is_better,
            timed: true,
        }
    }

    const fn counted(name: &'static str, of: fn(&Row) -> Option<f64>) -> Self {
        Self {
            name,
            of,
            more_is_better: false,
            timed: false,
        }
    }
}

const MEASURES: [Measure; 7] = [
    Measure::timed("primary rays per second", primary_rate, true),
    Measure::timed("shadow rays per second", shadow_rate, true),
    Measure::timed("bounced rays per second", bounced_rate, true),
    Measure::counted("tests per ray", tests),
    Measure::counted("bytes", |row| Some(row.own_bytes as f64)),
    Measure::timed("set-up", |row| Some(row.setup_seconds), false),
    Measure::counted("working RAM", |row| Some(row.stack_bytes as f64)),
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

/// Ratio below which figures count as equal: the noise of a shared machine.
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

/// Returns a sentence per structure: which others are better, and in times only if these were
/// repeated. The list needs no time to build and no memory, so its zeros do not count.
pub fn findings(comparison: &Comparison) -> Vec<String> {
    let list = Structure::List.name();
    let rejected = comparison.rejected.iter();
    let mut findings: Vec<_> = rejected.map(|rejected| rejected.why.clone()).collect();
    for row in &comparison.rows {
        if row.wrong.is_some() {
            findings.push(format!("{} is wrong", row.name));
            continue;
        }
        let mut beaten = Vec::new();
        let measures = MEASURES.into_iter();
        for measure in measures.filter(|it| !it.timed || comparison.repeats >= REPEATS) {
            let Measure {
                name,
                of,
                more_is_better,
                ..
            } = measure;
            let better_by = |other: &Row| {
                let (own, others) = (of(row)?, of(other)?);
                let factor = if more_is_better {
                    others / own
                } else {
                    own / others
                };
                (factor > NOISE).then_some(factor)
            };
            let rivals = comparison
                .rows
                .iter()
                .filter(|other| other.structure != list || row.structure == list)
                .filter_map(|other| Some((better_by(other)?, &other.name)));
            if let Some((factor, rival)) = rivals.max_by(|a, b| a.0.total_cmp(&b.0)) {
                beaten.push(format!("{name} by {rival} ({})", times(factor)));
            }
        }
        findings.push(if beaten.is_empty() {
            format!("{} is beaten nowhere", row.name)
        } else {
            format!("{} is beaten in {}", row.name, beaten.join(", "))
        });
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
