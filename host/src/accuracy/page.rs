//! A page that holds everything: plots, sentences, table, pictures. It loads nothing from anywhere.

use super::{Point, Results, frontier, frontier_by, instance_notes, sentences};
use crate::measure::board::core_names;
use crate::picture::write_png;
use crate::table::{counted, grouped, significant};
use base64::Engine;
use plotters::prelude::*;
use std::fmt::Write;
use std::io;

/// A picture of a setting beside what differs from the reference, as sRGB pixels.
#[derive(Clone, Debug)]
pub struct Comparison {
    pub name: String,
    pub picture: Vec<u8>,
    /// Empty for the reference.
    pub difference: Vec<u8>,
}

/// An error that is plotted.
type Metric = (&'static str, fn(&Point) -> f64);

const METRICS: [Metric; 3] = [
    ("RMSE of display values", |point| point.errors.rmse),
    ("FLIP", |point| point.errors.flip),
    ("1 - SSIM", |point| 1.0 - point.errors.ssim),
];

/// Writes the page.
///
/// # Errors
/// If a plot or a picture cannot be drawn.
pub fn page(
    scene: &str,
    size: [u16; 2],
    results: &Results,
    comparisons: &[Comparison],
) -> io::Result<String> {
    let mut page = String::from(HEAD);
    let name = escape(scene);
    let best = frontier(&results.points);
    let mut body = format!(
        "<title>Accuracy and time of {name}</title>\n<h1>What accuracy costs in time: {name}</h1>\n\
         <p>{} x {} pixels, one thread. The reference: f64, 24 lattice bits, ray depth 16, {} per \
         pixel.</p>\n",
        size[0],
        size[1],
        counted(results.reference.samples.into(), "sample")
    );
    if let Some(instances) = &results.instances {
        let notes = instance_notes(instances).join(" ");
        let _ = writeln!(body, "<p>{}</p>", code(&escape(&notes)));
    }
    body.push_str("<ul>\n");
    for sentence in sentences(&results.base, &results.points) {
        let _ = writeln!(body, "<li>{}</li>", code(&escape(&sentence)));
    }
    body.push_str(
        "</ul>\n<h2>Error against time</h2>\n<p>Times are medians; a bar spans the repeats. Nothing \
        beats the settings on the red line: no other is as right at a cost that is surely no higher. A \
        cost is higher where all repeats of one take longer than all of the other, or, where repeats \
        overlap, by rays and tests in the same number format. Numbers are those of the table; the \
        pointer shows the names. Rings mark what nothing beats by RMSE.</p>\n",
    );
    for metric in METRICS {
        body.push_str(&plot(metric, results, &best)?);
    }
    body.push_str(&table(results, &best));
    body.push_str(
        "<h2>Pictures</h2>\n<p>Below each: how display values differ from the \
        reference, eight times enlarged.</p>\n<div class=\"pictures\">\n",
    );
    for exhibit in comparisons {
        let _ = write!(body, "<figure>{}", image(size, &exhibit.picture)?);
        if !exhibit.difference.is_empty() {
            body.push_str(&image(size, &exhibit.difference)?);
        }
        let _ = writeln!(
            body,
            "<figcaption>{}</figcaption></figure>",
            escape(&exhibit.name)
        );
    }
    body.push_str("</div>\n</html>\n");
    page.push_str(&body);
    Ok(page)
}

const HEAD: &str = "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<style>\n\
    body { font: 15px/1.45 sans-serif; max-width: 1100px; margin: 2em auto; padding: 0 1em; }\n\
    table { border-collapse: collapse; font-size: 12px; }\n\
    td, th { padding: 2px 7px; text-align: right; white-space: nowrap; }\n\
    td:nth-child(2), th:nth-child(2) { text-align: left; }\n\
    tr:nth-child(even) { background: #f3f3f3; }\n\
    tr.best td:nth-child(2) { color: #b3001b; font-weight: bold; }\n\
    .pictures { display: flex; flex-wrap: wrap; gap: 12px; }\n\
    figure { margin: 0; font-size: 11px; }\n\
    figure img { display: block; image-rendering: pixelated; width: 192px; }\n\
    .scroll { overflow-x: auto; }\n\
    .front { font-size: 12px; color: #b3001b; }\n\
    svg { max-width: 100%; height: auto; }\n</style>\n";

fn escape(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

/// Marks what stands between backticks as code.
fn code(text: &str) -> String {
    let parts = text.split('`').enumerate();
    let marked = parts.map(|(number, part)| match number % 2 {
        0 => part.to_owned(),
        _ => format!("<code>{part}</code>"),
    });
    marked.collect()
}

fn image([width, height]: [u16; 2], pixels: &[u8]) -> io::Result<String> {
    let mut file = Vec::new();
    write_png(&mut file, [width.into(), height.into()], pixels, None)?;
    let data = base64::engine::general_purpose::STANDARD.encode(file);
    Ok(format!(
        "<img alt=\"\" src=\"data:image/png;base64,{data}\">"
    ))
}

/// A plot of an error against time, both by their logarithms.
fn plot((title, error): Metric, results: &Results, best: &[bool]) -> io::Result<String> {
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
        // The front goes by this plot's own error.
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
    let svg = svg.replace("</svg>", &format!("{names}</svg>"));
    let front: Vec<String> = fastest_first
        .into_iter()
        .map(|number| format!("{} {}", number + 1, escape(&results.points[number].name)))
        .collect();
    Ok(format!(
        "{svg}\n<p class=\"front\">On the line, the fastest first: {}.</p>\n",
        front.join("; ")
    ))
}

fn table(results: &Results, best: &[bool]) -> String {
    let mut table = String::from(
        "<h2>All settings</h2>\n<p>Black: what the scene file states; blue: one parameter changed; \
         gray: several. Errors are of display values from 0 to 1; t counts units of the last place \
         of single precision. Instructions per pixel on boards are estimates: the rays times the \
         least and the most that a ray of a recorded picture takes.</p>\n<div class=\"scroll\"><table>\n\
         <tr><th>#</th><th>setting</th><th>ms</th><th>spread</th><th>RMSE</th><th>largest</th>\
         <th>pixels off</th><th>SSIM</th><th>FLIP</th><th>other objects</th><th>t, median</th>\
         <th>t, largest</th><th>rays per pixel</th><th>tests per ray</th><th>blob</th><th>RAM</th>",
    );
    for board in core_names() {
        let _ = write!(table, "<th>{board}</th>");
    }
    table.push_str("</tr>\n");
    for (number, point) in results.points.iter().enumerate() {
        let (errors, cost) = (&point.errors, &point.cost);
        let class = if best[number] { " class=\"best\"" } else { "" };
        let _ = write!(
            table,
            "<tr{class}><td>{}</td><td>{}</td><td>{:.2}</td><td>{}</td><td>{:.5}</td><td>{:.4}</td>\
             <td>{}</td><td>{:.5}</td><td>{:.5}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2}</td>\
             <td>{:.1}</td><td>{}</td><td>{}</td>",
            number + 1,
            point.name,
            1e3 * cost.time(),
            cost.spread_text(),
            errors.rmse,
            errors.largest,
            grouped(errors.pixels_off),
            errors.ssim,
            errors.flip,
            grouped(errors.other_objects),
            significant((100.0 * errors.t_ulps[0]).round() / 100.0),
            significant(errors.t_ulps[1].round()),
            cost.rays as f64 / cost.pixels.max(1) as f64,
            cost.tests as f64 / cost.rays.max(1) as f64,
            grouped(cost.blob_bytes),
            grouped(cost.working_bytes),
        );
        for board in core_names() {
            let text = point
                .instructions(board)
                .map(|range| range.map(|n| grouped(n.round())).join(" to "));
            let _ = write!(table, "<td>{}</td>", text.unwrap_or_default());
        }
        table.push_str("</tr>\n");
    }
    table.push_str("</table></div>\n");
    table
}
