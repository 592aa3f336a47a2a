//! Charts as SVG: bars side by side, and curves on logarithmic axes.

use crate::table::significant;
use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use std::fmt::Display;

/// An error of drawing a chart, in the drawing library's own words.
#[derive(Debug, thiserror::Error)]
#[error("a chart cannot be drawn: {0}")]
pub struct ChartError(String);

fn failed(error: impl Display) -> ChartError {
    ChartError(error.to_string())
}

const SIZE: (u32, u32) = (1080, 540);
/// Width of the area left of the legend.
const CHART: u32 = 900;
/// Grid lines.
const GRID: RGBColor = RGBColor(222, 222, 222);
/// Colors that color-blind people can distinguish (Okabe and Ito, "Color universal design", 2008), in the order in
/// which series take them. After the last color they repeat, and curves get other dashes and marks.
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];

fn color(index: usize) -> RGBColor {
    COLORS[index % COLORS.len()]
}

/// Dashes of a curve and the gaps between them, in pixels; none the first time that colors are used.
fn dashes(index: usize) -> Option<(u32, u32)> {
    match index / COLORS.len() {
        0 => None,
        1 => Some((9, 5)),
        _ => Some((2, 4)),
    }
}

/// Returns whether the points of a curve are triangles. Others are discs, and rings when colors are used for
/// the third time.
fn is_triangular(index: usize) -> bool {
    index / COLORS.len() == 1
}

fn disc(index: usize) -> ShapeStyle {
    match index / COLORS.len() {
        0 => color(index).filled(),
        _ => color(index).stroke_width(2),
    }
}

fn triangle<C>(at: C, index: usize) -> TriangleMarker<C, u32> {
    TriangleMarker::new(at, 6, color(index).filled())
}

/// Numbers under a name.
#[derive(Clone, Debug)]
pub struct Series {
    pub name: String,
    /// Bars: one for each group, `None` for no bar. Curves: use [`Curve`].
    pub values: Vec<Option<f64>>,
}

/// Draws groups of bars on a logarithmic axis; each group has a bar of every series.
///
/// # Errors
/// If the drawing library has one.
pub fn bars(
    title: &str,
    unit: &str,
    groups: &[String],
    series: &[Series],
) -> Result<String, ChartError> {
    let values = || {
        series
            .iter()
            .flat_map(|s| s.values.iter().copied().flatten())
    };
    let largest = values().fold(1.0, f64::max);
    let smallest = values().filter(|&v| v > 0.0).fold(largest, f64::min);
    // Half a decade below the smallest, so that it is visible.
    let low = f64::powf(10.0, (smallest.log10() - 0.5).floor());
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (left_of_legend, beside) = root.split_horizontally(CHART);
        let mut chart = ChartBuilder::on(&left_of_legend)
            .caption(title, ("sans-serif", 22))
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(84)
            .build_cartesian_2d(0.0..groups.len() as f64, (low..largest * 2.0).log_scale())
            .map_err(failed)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .disable_x_axis()
            .bold_line_style(GRID)
            .light_line_style(WHITE)
            .y_desc(unit)
            .y_label_formatter(&|value| short(*value))
            .draw()
            .map_err(failed)?;
        let width = 0.84 / series.len().max(1) as f64;
        for (index, series) in series.iter().enumerate() {
            let bars = series
                .values
                .iter()
                .enumerate()
                .filter_map(|(group, value)| {
                    let left = group as f64 + 0.08 + width * index as f64;
                    let top = value.filter(|&value| value > 0.0)?;
                    let corners = [(left, low), (left + 0.92 * width, top)];
                    Some(Rectangle::new(corners, color(index).filled()))
                });
            chart.draw_series(bars).map_err(failed)?;
        }
        let names = groups.iter().enumerate().map(|(group, name)| {
            let place = chart.backend_coord(&(group as f64 + 0.5, low));
            (name.clone(), place)
        });
        let names: Vec<_> = names.collect();
        legend(
            &beside,
            series.iter().map(|series| &series.name),
            &|area, index, y| {
                let corners = [(8, y), (24, y + 12)];
                area.draw(&Rectangle::new(corners, color(index).filled()))
            },
        )?;
        // Long names share two lines.
        let style = ("sans-serif", 13).into_text_style(&root).pos(centered());
        for (index, (name, (x, y))) in names.into_iter().enumerate() {
            let line = if groups.len() > 6 {
                16 * (index % 2) as i32
            } else {
                0
            };
            root.draw_text(&name, &style, (x, y + 6 + line))
                .map_err(failed)?;
        }
        root.present().map_err(failed)?;
    }
    Ok(svg)
}

/// Points under a name, from left to right.
#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    pub points: Vec<(f64, f64)>,
}

/// Draws curves on two logarithmic axes.
///
/// # Errors
/// If the drawing library has one.
pub fn curves(title: &str, across: &str, up: &str, curves: &[Curve]) -> Result<String, ChartError> {
    let points = || curves.iter().flat_map(|curve| curve.points.iter());
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = || points().map(of).filter(|&value| value > 0.0);
        let high = values().fold(f64::MIN_POSITIVE, f64::max);
        (values().fold(high, f64::min), high)
    };
    let ((left, right), (low, high)) = (range(|p| p.0), range(|p| p.1));
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (left_of_legend, beside) = root.split_horizontally(CHART);
        let mut chart = ChartBuilder::on(&left_of_legend)
            .caption(title, ("sans-serif", 22))
            .margin(12)
            .x_label_area_size(46)
            .y_label_area_size(84)
            .build_cartesian_2d(
                (0.8 * left..1.25 * right).log_scale(),
                (0.7 * low..1.5 * high).log_scale(),
            )
            .map_err(failed)?;
        chart
            .configure_mesh()
            .bold_line_style(GRID)
            .light_line_style(WHITE)
            .x_desc(across)
            .y_desc(up)
            .x_label_formatter(&|value| short(*value))
            .y_label_formatter(&|value| short(*value))
            .draw()
            .map_err(failed)?;
        for (index, curve) in curves.iter().enumerate() {
            let visible = curve.points.iter().copied().filter(|point| point.1 > 0.0);
            let visible: Vec<_> = visible.collect();
            let style = color(index).stroke_width(2);
            match dashes(index) {
                None => chart.draw_series(LineSeries::new(visible.clone(), style)),
                Some((dash, gap)) => {
                    let line = DashedLineSeries::new(visible.clone(), dash, gap, style);
                    chart.draw_series(line)
                }
            }
            .map_err(failed)?;
            let points = visible.into_iter();
            if is_triangular(index) {
                chart.draw_series(points.map(|at| triangle(at, index)))
            } else {
                chart.draw_series(points.map(|at| Circle::new(at, 4, disc(index))))
            }
            .map_err(failed)?;
        }
        legend(
            &beside,
            curves.iter().map(|curve| &curve.name),
            &|area, index, y| {
                let ends = [(0, y + 6), (28, y + 6)];
                let style = color(index).stroke_width(2);
                match dashes(index) {
                    None => area.draw(&PathElement::new(ends, style)),
                    Some((dash, gap)) => area.draw(&DashedPathElement::new(ends, dash, gap, style)),
                }?;
                let middle = (14, y + 6);
                if is_triangular(index) {
                    area.draw(&triangle(middle, index))
                } else {
                    area.draw(&Circle::new(middle, 4, disc(index)))
                }
            },
        )?;
        root.present().map_err(failed)?;
    }
    Ok(svg)
}

type Area<'s> = DrawingArea<SVGBackend<'s>, Shift>;
type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Names the series next to the chart, each behind a sample that is drawn at its height.
fn legend<'n>(
    area: &Area<'_>,
    names: impl Iterator<Item = &'n String>,
    sample: &dyn Fn(&Area<'_>, usize, i32) -> Drawn,
) -> Result<(), ChartError> {
    let style = ("sans-serif", 14).into_text_style(area);
    for (index, name) in names.enumerate() {
        let y = 60 + 22 * index as i32;
        sample(area, index, y).map_err(failed)?;
        area.draw_text(name, &style, (34, y)).map_err(failed)?;
    }
    Ok(())
}

fn centered() -> plotters::style::text_anchor::Pos {
    use plotters::style::text_anchor::{HPos, Pos, VPos};
    Pos::new(HPos::Center, VPos::Top)
}

/// A number as axes write it: `300`, `20 k`, `1.5 M`.
fn short(value: f64) -> String {
    let (scaled, unit) = match value {
        v if v >= 1e9 => (v / 1e9, " G"),
        v if v >= 1e6 => (v / 1e6, " M"),
        v if v >= 1e3 => (v / 1e3, " k"),
        v => (v, ""),
    };
    // Three digits: enough for an axis, and what division left behind goes.
    let rounded = format!("{scaled:.2e}").parse().unwrap_or(scaled);
    if (f64::MIN_POSITIVE..1e-4).contains(&rounded) {
        return format!("{rounded:e}");
    }
    format!("{}{unit}", significant(rounded))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_short_numbers() {
        let numbers = [0.5, 1.0, 300.0, 2e4, 1.5e6, 3e9, 1e-4, 0.03, 2.5e-7, 0.0];
        assert_eq!(
            numbers.map(short),
            [
                "0.5", "1", "300", "20 k", "1.5 M", "3 G", "0.0001", "0.03", "2.5e-7", "0"
            ]
        );
    }

    #[test]
    fn charts_name_their_series() {
        let series = [Series {
            name: String::from("planes"),
            values: vec![Some(12.0), None],
        }];
        let groups = ["one", "other"].map(String::from);
        let svg = bars("tests per ray", "tests", &groups, &series).unwrap();
        for word in ["planes", "one", "other", "tests per ray"] {
            assert!(svg.contains(word), "{word}");
        }
        let curve = Curve {
            name: String::from("grid"),
            points: vec![(100.0, 2e6), (1000.0, 1e6)],
        };
        assert!(
            curves("growth", "objects", "rays", &[curve])
                .unwrap()
                .contains("grid")
        );
        assert!(curves("nothing", "objects", "rays", &[]).is_ok());
    }
}
