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

/// The title of a chart of growth, its unit, and the figure of a row.
type GrowthChart = (&'static str, &'static str, fn(&Row) -> Option<f64>);

/// The charts of growth, in the order of [`CHARTS`].
const GROWTH: [GrowthChart; 4] = [
    (
        "primary rays per second on one thread",
        "rays per second",
        primary_rate,
    ),
    ("bytes of the structure", "bytes", |row| {
        Some(row.own_bytes as f64)
    }),
    ("most memory while building on one thread", "bytes", |row| {
        row.peak_bytes.map(|bytes| bytes as f64)
    }),
    ("seconds to set up on one thread", "seconds", |row| {
        Some(row.setup_seconds)
    }),
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
) -> Result<Vec<(&'static str, String)>, ChartError> {
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
    let [tests_name, rates_name, growth_names @ ..] = CHARTS;
    let mut charts = vec![
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
    ];
    let copied = match growth.instances {
        Some(_) => ", instances copied",
        None => "",
    };
    for (name, (what, unit, of)) in growth_names.into_iter().zip(GROWTH) {
        let title = title(&format!("{what}, over parts of the scene{copied}"));
        charts.push((name, curves(&title, "primitives", unit, &curve(of))?));
    }
    let marked = |svg: String| svg.replace("</svg>", &format!("{MARK}\n</svg>"));
    let charts = charts.into_iter().map(|(name, svg)| (name, marked(svg)));
    Ok(charts.collect())
}
