//! The charts of a comparison.

use super::findings::{bounced_rate, primary_rate, shadow_rate};
use super::{Comparison, Growth, Row};
use crate::report::chart::{ChartError, Curve, Series, bars, curves};

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
        bar("mirrored and refracted", &bounced_rate),
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
    Ok(vec![
        (
            "tests.svg",
            bars(&title("tests per ray"), "tests", &groups, &tests)?,
        ),
        (
            "rates.svg",
            bars(
                &title("rays per second on one thread"),
                "rays per second",
                &groups,
                &rates,
            )?,
        ),
        (
            "growth-rates.svg",
            curves(
                &grown("primary rays per second on one thread"),
                objects,
                "rays per second",
                &curve(primary_rate),
            )?,
        ),
        (
            "growth-bytes.svg",
            curves(
                &grown("bytes of the structure"),
                objects,
                "bytes",
                &curve(|row| Some(row.own_bytes as f64)),
            )?,
        ),
        (
            "growth-peak.svg",
            curves(
                &grown("most memory while building"),
                objects,
                "bytes",
                &curve(|row| row.peak_bytes.map(|bytes| bytes as f64)),
            )?,
        ),
        (
            "growth-setup.svg",
            curves(
                &grown("seconds to set up"),
                objects,
                "seconds",
                &curve(|row| Some(row.setup_seconds)),
            )?,
        ),
    ])
}
