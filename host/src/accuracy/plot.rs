//! The plot of all settings for documents: a picture without a script.

use super::{Point, Results, frontier, frontier_by};
use crate::report::escape;
use crate::table::significant;
use plotters::prelude::*;
use std::fmt::Write;
use std::io;

/// Returns a plot of the RMSE against time, both by their logarithms, as SVG.
///
/// # Errors
/// If it cannot be drawn.
pub fn plot(results: &Results) -> io::Result<String> {
    let title = "RMSE of display values";
    let error = |point: &Point| point.errors.rmse;
    let best = frontier(&results.points);
    const SIZE: (u32, u32) = (1060, 520);
    let base = &results.base;
    let places: Vec<(f64, f64)> = results
        .points
        .iter()
        .map(|point| (1e3 * point.cost.time().max(1e-9), error(point).max(1e-7)))
        .collect();
    let repeats = results.points.iter().flat_map(|point| &point.cost.seconds);
    let repeats = repeats.map(|seconds| 1e3 * seconds.max(1e-9));
    let ends = |all: &mut dyn Iterator<Item = f64>| {
        let (low, high) = all.fold((f64::INFINITY, 0.0_f64), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        (low / 1.25)..(high * 1.6)
    };
    let times = ends(&mut repeats.chain(places.iter().map(|place| place.0)));
    let errors = ends(&mut places.iter().map(|place| place.1));
    let (mut svg, mut names) = (String::new(), String::new());
    let mut fastest_first = Vec::new();
    let draw = |svg: &mut String| -> Result<(), Box<dyn std::error::Error>> {
        let area = SVGBackend::with_string(svg, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&area)
            .caption(title, ("sans-serif", 20))
            .margin(10)
            .x_label_area_size(42)
            .y_label_area_size(72)
            .build_cartesian_2d(times.log_scale(), errors.log_scale())?;
        chart
            .configure_mesh()
            .x_desc("milliseconds per frame, one thread")
            .y_desc(title)
            .x_label_formatter(&|x| significant((x * 1e3).round() / 1e3))
            .y_label_formatter(&|y| format!("{y:.1e}"))
            .light_line_style(RGBColor(240, 240, 240))
            .draw()?;
        // The front uses this plot's own error.
        let unbeaten = frontier_by(&results.points, error);
        fastest_first.extend((0..places.len()).filter(|&number| unbeaten[number]));
        fastest_first.sort_by(|&a, &b| places[a].0.total_cmp(&places[b].0));
        let front: Vec<(f64, f64)> = fastest_first.iter().map(|&number| places[number]).collect();
        chart.draw_series(LineSeries::new(front.iter().copied(), RGBColor(179, 0, 27)))?;
        for (number, (&place, point)) in places.iter().zip(&results.points).enumerate() {
            let turned = point.setting.differs(base).len();
            let color = match turned {
                0 => RGBColor(0, 0, 0),
                1 => RGBColor(31, 99, 180),
                _ => RGBColor(130, 150, 130),
            };
            if let Some(repeats) = point.cost.interval() {
                let bar = repeats.map(|seconds| (1e3 * seconds.max(1e-9), place.1));
                chart.draw_series(LineSeries::new(bar, color))?;
            }
            chart.draw_series([Circle::new(place, 4, color.filled())])?;
            let color = if front.contains(&place) {
                RGBColor(179, 0, 27)
            } else {
                RGBColor(90, 90, 90)
            };
            let font = ("sans-serif", 10).into_font().color(&color);
            let label = Text::new((number + 1).to_string(), (6, -5), font);
            chart.draw_series([EmptyElement::at(place) + label])?;
            let (x, y) = chart.backend_coord(&place);
            // Names appear where the pointer is: all at once they would cover the points.
            let _ = writeln!(
                names,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"7\" fill=\"transparent\"><title>{} {}: {} ms, {}</title></circle>",
                number + 1,
                escape(&point.name),
                significant(place.0),
                significant(place.1)
            );
            if best.get(number).copied().unwrap_or(false) {
                chart.draw_series([Circle::new(place, 7, RGBColor(179, 0, 27).stroke_width(1))])?;
            }
        }
        area.present()?;
        Ok(())
    };
    draw(&mut svg).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(svg.replace("</svg>", &format!("{names}</svg>")))
}
