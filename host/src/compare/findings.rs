//! Where each structure is beaten, in plain words.

use super::{Comparison, Row};
use gridel_core::Structure;

/// What is compared between rows: a name, what comes of it, and whether more is better.
type Measure = (&'static str, fn(&Row) -> Option<f64>, bool);

const MEASURES: [Measure; 6] = [
    ("primary rays a second", primary_rate, true),
    ("secondary rays a second", secondary_rate, true),
    ("tests a ray", tests, false),
    ("bytes", |row| Some(row.own_bytes as f64), false),
    ("set-up", |row| Some(row.setup_seconds), false),
    ("working RAM", |row| Some(row.stack_bytes as f64), false),
];

pub(super) fn primary_rate(row: &Row) -> Option<f64> {
    row.work?.primary.rays_per_second
}

pub(super) fn secondary_rate(row: &Row) -> Option<f64> {
    row.work?.secondary?.rays_per_second
}

/// Planes, cells and primitives: everything that a ray is tested against.
fn tests(row: &Row) -> Option<f64> {
    let all = row.work?.all;
    Some(all.planes + all.cells + all.objects)
}

/// What counts as equal: the noise of a shared machine.
const NOISE: f64 = 1.03;

/// For each structure, by what it is beaten; the list, which takes nothing to make and to hold, is
/// passed over where it comes to that.
pub fn findings(comparison: &Comparison) -> Vec<String> {
    let list = Structure::List.name();
    let refused = comparison.refused.iter();
    let mut findings: Vec<_> = refused.map(|refused| refused.why.clone()).collect();
    for row in &comparison.rows {
        if row.wrong.is_some() {
            findings.push(format!("{} is wrong", row.name));
            continue;
        }
        let mut beaten = Vec::new();
        for (what, of, more_is_better) in MEASURES {
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
                let factor = if factor.is_finite() {
                    format!("{factor:.2} times")
                } else {
                    String::from("takes none")
                };
                beaten.push(format!("{what} by {rival} ({factor})"));
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
