//! The cheapest setting within an error bound.

use super::arguments::Arguments;
use crate::cli::arguments::quoted;
use clap::ValueEnum;
use gridel_host::accuracy::{Point, Results, cheapest};
use gridel_host::table::counted;
use serde::Serialize;

/// The setting that was asked for.
#[derive(Serialize)]
pub struct Choice {
    pub name: String,
    pub rmse: f64,
    /// How surely it is the cheapest, where time on this machine decides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<String>,
    pub build: String,
    pub render: String,
}

/// The cheapest setting within the bound that was asked for, as options.
pub fn choice(arguments: &Arguments, stem: &str, results: &Results) -> Option<Choice> {
    let most = arguments.max_error?;
    let point = cheapest(&results.points, most, arguments.board.as_deref())?;
    let setting = &point.setting;
    let stated = setting.cutoff == results.base.cutoff && arguments.cutoff.is_none();
    let cutoff = match stated {
        true => String::new(),
        false => format!(" --cutoff {}", setting.cutoff),
    };
    let quality = arguments.quality.and_then(|it| it.to_possible_value());
    let quality = quality.map_or(String::new(), |it| format!(" --quality {}", it.get_name()));
    let [blob, picture] = ["gridel", "png"].map(|end| quoted(&format!("{stem}.{end}")));
    Some(Choice {
        name: point.name.clone(),
        rmse: point.errors.rmse,
        noise: arguments
            .board
            .is_none()
            .then(|| noise(point, &results.points, most)),
        build: format!(
            "gridel build {}{} -o {blob} --accel {}{quality} --lattice-bits {}{cutoff}",
            quoted(&arguments.scene.to_string_lossy()),
            arguments.import.written(),
            arguments.accel.name(),
            setting.lattice_bits
        ),
        render: format!(
            "gridel render {blob} -o {picture} --format {} --samples {} --depth {}",
            setting.format.name(),
            setting.samples,
            setting.depth
        ),
    })
}

/// How surely a point is the fastest within a bound.
fn noise(fastest: &Point, points: &[Point], most: f64) -> String {
    let Some(repeats) = fastest.cost.interval() else {
        return String::from(", timed once, so its noise is unknown");
    };
    let within = points.iter().filter(|point| point.errors.rmse <= most);
    let others = within.filter(|point| !fastest.cost.is_below(&point.cost));
    let [least, largest] = repeats.map(|seconds| 1e3 * seconds);
    let took = format!(" in {least:.2} to {largest:.2} ms");
    match others.count().saturating_sub(1) {
        0 => took,
        others => format!(
            "{took}; {} within the bound differ from it by no more than the noise",
            counted(others, "other setting")
        ),
    }
}
