//! The charts of a comparison.

use super::findings::{bounced_rate, primary_rate, shadow_rate};
use super::{Comparison, Growth, Row};
use crate::report::chart::{ChartError, Curve, Series, bars, curves};

/// The names of the files of all charts.
pub const CHARTS: [&str; 6] = [
    "tests.svg",
    "rates.svg",
    "growth-rates.svg",
    "growth-bytes.svg",
    "growth-peak.svg",
    "growth-setup.svg",
];

/// The comment in every chart, by which an earlier one is known.
const MARK: &str = "<!-- gridel compare -->";

/// Returns whether the content of a file is that of a chart.
///
/// ```
/// assert!(!gridel_host::compare::is_chart(b"<svg></svg>"));
/// ```
pub fn is_chart(content: &[u8]) -> bool {
    let mark = MARK.as_bytes();
    content.windows(mark.len()).any(|it| it == mark)
}

/// Draws all charts, and returns the names of files and their content. `name` is the scene's, for
/// the titles.
///
/// # Errors
/// If the drawing library has one.
pub fn charts(
    name: &str,
    comparison: &Comparison,
    growth: &Growth,
) -> Result<[(&'static str, String); CHARTS.len()], ChartError> {
    let groups: Vec<String> = comparison.rows.iter().map(|row| row.name.clone()).collect();
    let bar = |name: &str, of: &dyn Fn(&Row) -> Option<f64>| Series {
        name: name.to_owned(),
        values: comparison.rows.iter().map(of).collect(),
    };
    let mut tests = vec![
        bar("planes", &|row| Some(row.work?.all.planes)),
        bar("boxes", &|row| Some(row.work?.all.boxes)),
        bar("cells", &|row| Some(row.work?.all.cells)),
        bar("primitives", &|row| Some(row.work?.all.primitives)),
    ];
    if comparison.keeps_instances() {
        tests.push(bar("instances entered", &|row| row.work?.all.instances));
    }
    let rates = [
        bar("primary", &primary_rate),
        bar("shadow", &shadow_rate),
        bar("bounced", &bounced_rate),
    ];
    let curve = |of: fn(&Row) -> Option<f64>| -> Vec<Curve> {
        let curve = |name: &String| Curve {
            name: name.clone(),
            points: growth
                .steps
                .iter()
                .filter_map(|step| {
                    let mut rows = step.rows.iter();
                    let row = rows.find(|row| row.name == *name)?;
                    Some((step.primitives as f64, of(row)?))
                })
                .collect(),
        };
        groups.iter().map(curve).collect()
    };
    let title = |what: &str| format!("{name}: {what}");
    let copied = match growth.instances {
        Some(_) => ", instances copied",
        None => "",
    };
    let grown = |what: &str| title(&format!("{what}, over parts of the scene{copied}"));
    let objects = "primitives";
    let [
        tests_name,
        rates_name,
        growing_rates,
        growing_bytes,
        growing_peak,
        growing_setup,
    ] = CHARTS;
    let charts = [
        (
            tests_name,
            bars(&title("tests per ray"), "tests", &groups, &tests)?,
        ),
        (
            rates_name,
            bars(
                &title("rays per second on one thread"),
                "rays per second",
                &groups,
                &rates,
            )?,
        ),
        (
            growing_rates,
            curves(
                &grown("primary rays per second on one thread"),
                objects,
                "rays per second",
                &curve(primary_rate),
            )?,
        ),
        (
            growing_bytes,
            curves(
                &grown("bytes of the structure"),
                objects,
                "bytes",
                &curve(|row| Some(row.own_bytes as f64)),
            )?,
        ),
        (
            growing_peak,
            curves(
                &grown("most memory while building on one thread"),
                objects,
                "bytes",
                &curve(|row| row.peak_bytes.map(|bytes| bytes as f64)),
            )?,
        ),
        (
            growing_setup,
            curves(
                &grown("seconds to set up on one thread"),
                objects,
                "seconds",
                &curve(|row| Some(row.setup_seconds)),
            )?,
        ),
    ];
    Ok(charts.map(|(name, svg)| (name, svg.replace("</svg>", &format!("{MARK}\n</svg>")))))
}
