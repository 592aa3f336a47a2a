//! The setting within the requested limits.

use super::arguments::Arguments;
use crate::cli::arguments::quoted;
use clap::ValueEnum;
use gridel_core::Effects;
use gridel_host::accuracy::{Limits, ONCE, Point, Results, cheapest, most_accurate};
use gridel_host::table::counted;
use serde::Serialize;

/// The requested setting.
#[derive(Serialize)]
pub struct Choice {
    pub name: String,
    pub rmse: f64,
    pub rays_per_pixel: f64,
    /// The certainty that the setting is the cheapest, if time on this machine decides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<String>,
    pub build: String,
    pub render: String,
}

/// Returns the setting within the requested limits, as options: the cheapest where an error is given, else the most
/// accurate.
pub fn choice(arguments: &Arguments, stem: &str, results: &Results) -> Option<Choice> {
    let board = arguments.board.as_deref();
    let limits = Limits {
        error: arguments.max_error.unwrap_or(f64::INFINITY),
        rays: arguments.max_rays.unwrap_or(f64::INFINITY),
    };
    let point = match (arguments.max_error, arguments.max_rays) {
        (None, None) => None,
        (None, Some(rays)) => most_accurate(&results.points, rays, board),
        (Some(_), _) => cheapest(&results.points, limits, board),
    }?;
    let setting = &point.setting;
    let stated = setting.cutoff == results.base.cutoff && arguments.cutoff.is_none();
    let cutoff = match stated {
        true => String::new(),
        false => format!(" --cutoff {}", setting.cutoff),
    };
    let names = setting.without.names().collect::<Vec<_>>().join(",");
    let without = match setting.without {
        Effects::NONE => String::new(),
        _ => format!(" --without {names}"),
    };
    let quality = arguments.quality.and_then(|it| it.to_possible_value());
    let quality = quality.map_or(String::new(), |it| format!(" --quality {}", it.get_name()));
    let [blob, picture] = ["gridel", "png"].map(|end| quoted(&format!("{stem}.{end}")));
    Some(Choice {
        name: point.name.clone(),
        rmse: point.errors.rmse,
        rays_per_pixel: point.rays_per_pixel(),
        noise: (arguments.board.is_none() && arguments.max_error.is_some())
            .then(|| noise(point, &results.points, limits)),
        build: format!(
            "gridel build {}{}{without} -o {blob} --accel {}{quality} --lattice-bits {}{cutoff}",
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

/// Returns how certain it is that a point is the fastest within a bound.
fn noise(fastest: &Point, points: &[Point], limits: Limits) -> String {
    let Some(repeats) = fastest.cost.interval() else {
        return format!(", {ONCE}");
    };
    let within = points.iter().filter(|point| limits.hold(point));
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
