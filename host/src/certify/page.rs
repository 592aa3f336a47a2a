//! The page about a certified picture. It loads nothing from anywhere.

use super::report::Report;
use crate::report::{escape, picture_url};
use crate::table::{counted, grouped};
use std::fmt::Write;
use std::io;

/// The pictures of a page, as sRGB pixels.
#[derive(Clone, Copy, Debug)]
pub struct Pictures<'p> {
    pub map: &'p [u8],
    pub exact: &'p [u8],
}

/// Writes the page. `explain` is the command that explains a pixel, up to its place.
///
/// # Errors
/// If a picture cannot be encoded.
pub fn page(
    name: &str,
    report: &Report,
    pictures: &Pictures<'_>,
    explain: &str,
) -> io::Result<String> {
    let mut page = String::from(HEAD);
    let name = escape(name);
    // Writing to a string cannot fail.
    let _ = write!(
        page,
        "<title>Certified pixels of {name}</title>\n<h1>Certified pixels: {name}</h1>\n<p class=\"lead\">{}</p>\n\
         <p>The blob defines one exact picture: its geometry, camera, samples, lights and effects in real \
         arithmetic. A pixel is proved if an interval around its exact value gives one 8-bit value. It is the \
         sampled picture that is certified, with {} per pixel and ray depth {}, not the integral behind it.</p>\n",
        escape(&sentence(report)),
        counted(report.samples.into(), "sample"),
        report.ray_depth,
    );
    page.push_str(&formats(report, explain));
    let _ = write!(
        page,
        "<div class=\"pictures\"><figure>{}<figcaption>What is known: gray, proved equal in all formats; \
         orange, one format proved different by 1/255; red, by more; blue, open.</figcaption></figure>\n\
         <figure>{}<figcaption>The exact picture.</figcaption></figure></div>\n",
        image(report.size, pictures.map)?,
        image(report.size, pictures.exact)?,
    );
    page.push_str(&reasons(report, explain));
    page.push_str(&widths(report));
    page.push_str("</html>\n");
    Ok(page)
}

/// Returns the result in one sentence.
pub fn sentence(report: &Report) -> String {
    format!(
        "{} % of {} pixels are proved: {} with 53 bits, {} with 128 and {} with 256.",
        percent(report.proved, report.pixels),
        grouped(report.pixels),
        grouped(report.proved_with_bits[0].1),
        grouped(report.proved_with_bits[1].1),
        grouped(report.proved_with_bits[2].1),
    )
}

/// Returns a part of pixels in percent, rounded down: 100 means all of them.
fn percent(count: usize, pixels: usize) -> String {
    let thousandths = count as u64 * 100_000 / pixels.max(1) as u64;
    format!("{}.{:03}", thousandths / 1000, thousandths % 1000)
}

fn formats(report: &Report, explain: &str) -> String {
    let mut table = String::from(
        "<h2>Number formats</h2>\n<div class=\"wide\"><table><tr><th>format<th>proved equal<th>proved different\
         <th>open<th>largest proved error<th>explain it</tr>\n",
    );
    for format in &report.formats {
        let command = format.worst.map_or(String::new(), |[x, y]| {
            format!(
                "<code>{}</code>",
                escape(&format!("{explain}{x},{y} --format {}", format.format))
            )
        });
        let _ = writeln!(
            table,
            "<tr><td>{}<td>{} ({} %)<td>{}<td>{}<td>{}/255<td>{command}</tr>",
            format.format,
            grouped(format.equal),
            percent(format.equal, report.pixels),
            grouped(format.different),
            grouped(format.open),
            format.max_proved_error,
        );
    }
    table.push_str("</table></div>\n");
    for format in &report.formats {
        let name = format.format;
        let pixels = format.different_pixels.iter();
        let commands = pixels.map(|it| {
            let [x, y] = it.pixel;
            format!("{explain}{x},{y} --format {name}")
        });
        table.push_str(&list(
            &format!("pixels of {name} that are different"),
            commands,
        ));
    }
    table
}

/// Commands that a list of the page shows.
const LISTED: usize = 1_000;

/// A list of commands that unfolds; nothing for none.
fn list(what: &str, commands: impl ExactSizeIterator<Item = String>) -> String {
    let count = commands.len();
    if count == 0 {
        return String::new();
    }
    let mut list = format!(
        "<details><summary>All {} {what}</summary>\n<ul>\n",
        grouped(count)
    );
    if count > LISTED {
        list = format!(
            "<details><summary>The first {} of {} {what}</summary>\n<ul>\n",
            grouped(LISTED),
            grouped(count)
        );
    }
    for command in commands.take(LISTED) {
        let _ = writeln!(list, "<li><code>{}</code>", escape(&command));
    }
    list.push_str("</ul>\n");
    if count > LISTED {
        let more = grouped(count - LISTED);
        let _ = writeln!(list, "<p>{more} more are in the JSON report.</p>");
    }
    list + "</details>\n"
}

fn reasons(report: &Report, explain: &str) -> String {
    if report.reasons.is_empty() {
        return String::from("<h2>Open pixels</h2>\n<p>There are none.</p>\n");
    }
    let mut table = String::from(
        "<h2>Open pixels</h2>\n<p>On the boundary: 256 bits cannot tell the exact ray from one that lies exactly \
         between two outcomes.</p>\n<div class=\"wide\"><table><tr><th>reason<th>pixels<th>on the boundary\
         <th>explain the first</tr>\n",
    );
    for reason in &report.reasons {
        let first = reason.open_pixels.first();
        let command = first.map_or(String::new(), |it| {
            let [x, y] = it.pixel;
            format!(
                "<code>{}</code>",
                escape(&format!("{explain}{x},{y} --interval"))
            )
        });
        let _ = writeln!(
            table,
            "<tr><td>{}<td>{}<td>{}<td>{command}</tr>",
            reason.text,
            grouped(reason.pixels),
            grouped(reason.on_boundary),
        );
    }
    table.push_str("</table></div>\n");
    for reason in &report.reasons {
        let commands = reason.open_pixels.iter().map(|it| {
            let [x, y] = it.pixel;
            format!("{explain}{x},{y} --interval")
        });
        table.push_str(&list(&format!("open pixels: {}", reason.text), commands));
    }
    table
}

/// Bars of the widths of intervals; their lengths are logarithmic, so that few pixels are visible
/// too.
fn widths(report: &Report) -> String {
    let mut chart = String::from(
        "<h2>Widths of the intervals</h2>\n<p>Pixels by the width of their widest channel, of linear values from 0 \
         to 1. The bars are logarithmic.</p>\n<table class=\"bars\">\n",
    );
    let log = |count: usize| libm::log10(1.0 + count as f64);
    let most = report
        .widths
        .iter()
        .map(|it| log(it.pixels))
        .fold(1.0, f64::max);
    for width in report.widths.iter().filter(|it| it.pixels > 0) {
        let _ = writeln!(
            chart,
            "<tr><th>up to 10<sup>{}</sup><td><span style=\"width:{:.1}%\"></span><td>{}</tr>",
            width.power,
            100.0 * log(width.pixels) / most,
            grouped(width.pixels),
        );
    }
    chart + "</table>\n"
}

fn image(size: [u16; 2], pixels: &[u8]) -> io::Result<String> {
    let url = picture_url(size, pixels)?;
    let [width, height] = shown_size(size);
    Ok(format!(
        "<img alt=\"\" width=\"{width}\" height=\"{height}\" src=\"{url}\">"
    ))
}

/// The size at which a picture is shown: small ones are enlarged by a whole number.
fn shown_size(size: [u16; 2]) -> [u32; 2] {
    const USUAL: u32 = 480;
    let [width, height] = size.map(u32::from);
    let by = (USUAL / width.max(height).max(1)).max(1);
    [width * by, height * by]
}

const HEAD: &str = "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
    <meta name=\"viewport\" content=\"width=device-width\">\n<style>\n\
    :root { color-scheme: light dark; }\n\
    body { font: 15px/1.5 sans-serif; max-width: 1000px; margin: 2em auto; padding: 0 1em; }\n\
    .lead { font-size: 1.25em; }\n\
    .wide { overflow-x: auto; }\n\
    table { border-collapse: collapse; }\n\
    td, th { padding: 3px 10px; text-align: left; border-bottom: 1px solid #8884; white-space: nowrap; }\n\
    .bars { width: 100%; }\n.bars td:nth-child(2) { width: 70%; }\n\
    .bars span { display: block; height: 0.9em; background: #4a78c8; }\n\
    .pictures { display: flex; flex-wrap: wrap; gap: 1.5em; }\nfigure { margin: 0; max-width: 100%; }\n\
    img { max-width: 100%; height: auto; image-rendering: pixelated; }\nfigcaption { max-width: 34em; }\n</style>\n";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_are_enlarged() {
        assert_eq!(shown_size([48, 36]), [480, 360]);
        assert_eq!(shown_size([320, 240]), [320, 240]);
        assert_eq!(shown_size([4000, 1]), [4000, 1]);
    }

    #[test]
    fn a_part_of_all_pixels_is_never_shown_as_all() {
        assert_eq!(percent(1 << 22, 1 << 22), "100.000");
        assert_eq!(percent((1 << 22) - 1, 1 << 22), "99.999");
        assert_eq!(percent(69, 1000), "6.900");
        assert_eq!(percent(0, 0), "0.000");
    }

    #[test]
    fn lists_say_how_many_more_there_are() {
        let commands = |count: usize| (0..count).map(|it| format!("explain <{it}>"));
        assert_eq!(list("pixels", commands(0)), "");
        let few = list("pixels", commands(2));
        assert!(few.contains("All 2 pixels") && few.contains("<li><code>explain &lt;1&gt;"));
        let many = list("pixels", commands(1_234));
        assert_eq!(many.matches("<li>").count(), LISTED);
        assert!(many.contains("The first 1,000 of 1,234 pixels") && many.contains("234 more"));
    }
}
