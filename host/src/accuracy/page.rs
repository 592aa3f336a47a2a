//! A page that holds everything: answers, chart, pictures, tables. It loads nothing from anywhere.
//!
//! `page.html` is the template, with the page's style and script; its marks `{{NAME}}` are replaced here.

use super::columns::figure;
use super::{
    COLUMNS, EffectCost, Parameter, Point, Results, Setting, Truth, answers, frontier, frontier_by,
    instance_notes, sentences,
};
use crate::measure::board::core_names;
use crate::report::{escape, picture_url};
use crate::table::{counted, grouped};
use gridel_core::format::limits::MAX_RAY_DEPTH;
use serde_json::json;
use std::collections::HashMap;
use std::fmt::Write;
use std::io;

const TEMPLATE: &str = include_str!("page.html");

/// Most bytes of all pictures of a page. Those of the front come first, then those of parameters that were changed
/// alone; pictures beyond are left out, and the page says so.
pub const MOST_PICTURE_BYTES: usize = 3 << 20;

/// The picture of a setting, as sRGB pixels.
#[derive(Clone, Debug)]
pub struct PagePicture {
    /// The name of its setting; empty for the reference.
    pub name: String,
    pub pixels: Vec<u8>,
}

/// Writes the page. A setting whose picture is missing has none on the page.
///
/// # Errors
/// If a picture cannot be encoded.
pub fn page(
    scene: &str,
    size: [u16; 2],
    results: &Results,
    pictures: &[PagePicture],
) -> io::Result<String> {
    let name = escape(scene);
    let mut about = format!(
        "{} x {} pixels, one thread. The reference: {}, 24 lattice bits, ray depth {MAX_RAY_DEPTH}, cutoff {}, {} per \
         pixel. Errors are of display values from 0 to 1.",
        size[0],
        size[1],
        match results.reference.truth {
            Truth::F64 => "<code>f64</code>",
            Truth::Exact => "the exact picture that <code>gridel certify</code> proves",
        },
        power(results.reference.cutoff),
        counted(results.reference.samples.into(), "sample")
    );
    if results.reference.open > 0 {
        let open = grouped(results.reference.open);
        let _ = write!(
            about,
            " Open pixels of it, which stand in the middle of what is known: {open}."
        );
    }
    if let Some(instances) = &results.instances {
        let notes = instance_notes(instances).join(" ");
        let _ = write!(about, " {}", code(&escape(&notes)));
    }
    let list = |sentences: Vec<String>| -> String {
        let items = sentences.iter();
        items
            .map(|it| format!("<li>{}</li>\n", code(&escape(it))))
            .collect()
    };
    let notes = format!(
        "<ul>\n{}</ul>\n<p>Sampling error: {truth} of a setting against the reference; it is what samples, depth, \
         cut-off, lattice and left-out effects do. Arithmetic error: the picture of the setting's number format against \
         {truth} of the same setting. Both are RMSEs, and need not add up.</p>\n{NOTES}",
        list(sentences(results)),
        truth = code(results.reference.truth.picture()),
    );
    let parts = [
        ("SCENE", name),
        ("ABOUT", about),
        ("ANSWERS", list(answers(results))),
        ("EFFECTS", effects(results)),
        ("FRONT", front(results)),
        ("TABLE", table(results)),
        ("NOTES", notes),
        ("DATA", data(size, results, pictures)?),
    ];
    // Marks are looked for in the template alone, not in what replaces them.
    let mut pieces = TEMPLATE.split("{{");
    let mut page = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (mark, rest) = piece.split_once("}}").unwrap_or((piece, ""));
        let text = parts.iter().find(|(name, _)| *name == mark);
        page.push_str(text.map_or("", |(_, text)| text));
        page.push_str(rest);
    }
    Ok(page)
}

const NOTES: &str = "<p>A bar spans the repeats of a time, or the least and the most instructions that rays of recorded pictures take. \
    A time is higher where all repeats of one take longer than all of the other; where repeats overlap, rays and tests \
    decide within a number format. The instructions of an effect are those of the rays that it sends; what a hit costs \
    beside them, MEMORY.md states. t counts units of the last place of single precision. SSIM is structural similarity, \
    1 for equal pictures; FLIP is the mean difference that an eye sees.</p>\n";

/// A number, as a power of two if it is one.
fn power(number: f64) -> String {
    let exponent = number.log2();
    match exponent.fract() {
        0.0 => format!("2<sup>{exponent}</sup>"),
        _ => number.to_string(),
    }
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

/// Returns the parameter that differs from the scene file's setting, as the page's colors name it.
fn parameter(setting: &Setting, base: &Setting) -> &'static str {
    match setting.differs(base)[..] {
        [] => "base",
        [Parameter::Format] => "format",
        [Parameter::LatticeBits] => "lattice-bits",
        [Parameter::Samples] => "samples",
        [Parameter::Depth] => "depth",
        [Parameter::Cutoff] => "cutoff",
        [Parameter::Effects] => "effects",
        _ => "several",
    }
}

/// The page's figures and pictures, as JSON that may stand in a script.
fn data(size: [u16; 2], results: &Results, pictures: &[PagePicture]) -> io::Result<String> {
    let base = &results.base;
    let best = frontier(&results.points);
    let mut images = Images::default();
    let reference = pictures.iter().find(|it| it.name.is_empty());
    let reference = match reference {
        Some(it) => images.add(size, &it.pixels)?,
        None => None,
    };
    let mut order: Vec<usize> = (0..results.points.len()).collect();
    order.sort_by_key(|&number| {
        let turned = results.points[number].setting.differs(base).len();
        (turned > 0, !best[number], turned)
    });
    let mut numbers = vec![None; results.points.len()];
    let by_name: HashMap<&str, &PagePicture> =
        pictures.iter().map(|it| (it.name.as_str(), it)).collect();
    for number in order {
        if let Some(it) = by_name.get(results.points[number].name.as_str()) {
            numbers[number] = images.add(size, &it.pixels)?;
        }
    }
    let points = results.points.iter().zip(&numbers).map(|(point, picture)| {
        let (errors, cost) = (&point.errors, &point.cost);
        let ms = 1e3 * cost.time().max(1e-9);
        let range = cost.interval().map_or([ms; 2], |it| it.map(|s| 1e3 * s.max(1e-9)));
        let boards: serde_json::Map<String, serde_json::Value> = core_names()
            .into_iter()
            .filter_map(|board| Some((board.to_owned(), json!(point.instructions(board)?))))
            .collect();
        json!({
            "name": point.name, "words": point.setting.words(base), "parameter": parameter(&point.setting, base),
            "rmse": errors.rmse, "flip": errors.flip, "ssim": (1.0 - errors.ssim).max(0.0),
            "sampling": point.parts.sampling, "arithmetic": point.parts.arithmetic,
            "ms": ms, "range": range, "rays": point.rays_per_pixel(), "boards": boards,
            "bytes": cost.blob_bytes, "ram": cost.working_bytes, "picture": picture,
        })
    });
    let data = json!({
        "points": points.collect::<Vec<_>>(),
        "fronts": {
            "rmse": best,
            "flip": frontier_by(&results.points, |it| it.errors.flip),
            "ssim": frontier_by(&results.points, |it| 1.0 - it.errors.ssim),
        },
        "boards": core_names(),
        "pictures": images.images,
        "reference": reference,
    });
    // A script ends at the first end mark, also within a text.
    Ok(data.to_string().replace('<', "\\u003c"))
}

/// Encoded pictures, each once, within [`MOST_PICTURE_BYTES`].
#[derive(Default)]
struct Images {
    images: Vec<String>,
    numbers: HashMap<Vec<u8>, usize>,
    bytes: usize,
}

impl Images {
    /// The number of a picture; `None` where there is no room for it.
    fn add(&mut self, size: [u16; 2], pixels: &[u8]) -> io::Result<Option<usize>> {
        if let Some(&number) = self.numbers.get(pixels) {
            return Ok(Some(number));
        }
        let image = picture_url(size, pixels)?;
        // The reference is always there, so that differences have something to differ from.
        if !self.images.is_empty() && self.bytes + image.len() > MOST_PICTURE_BYTES {
            return Ok(None);
        }
        self.bytes += image.len();
        self.images.push(image);
        let number = self.images.len() - 1;
        self.numbers.insert(pixels.to_vec(), number);
        Ok(Some(number))
    }
}

/// The table of the front, the fastest first.
fn front(results: &Results) -> String {
    let mut table = String::from(
        "<table><caption>By RMSE and time, the fastest first: each has less error than those above it, or costs that \
         are not surely higher.</caption>\n<thead><tr><th scope=\"col\">setting</th><th scope=\"col\">format</th>\
         <th scope=\"col\">RMSE</th><th scope=\"col\">sampling error</th><th scope=\"col\">arithmetic error</th>\
         <th scope=\"col\">ms</th><th scope=\"col\">spread</th><th scope=\"col\">rays per pixel</th></tr></thead>\n<tbody>",
    );
    let best = frontier(&results.points);
    let points = results.points.iter().zip(best);
    let mut points: Vec<&Point> = points.filter_map(|(it, best)| best.then_some(it)).collect();
    points.sort_by(|a, b| a.cost.time().total_cmp(&b.cost.time()));
    for point in points {
        let cost = &point.cost;
        let _ = writeln!(
            table,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2}</td><td>{}</td><td>{:.2}</td></tr>",
            escape(&point.setting.words(&results.base)),
            point.setting.format.name(),
            figure(point.errors.rmse),
            figure(point.parts.sampling),
            figure(point.parts.arithmetic),
            1e3 * cost.time(),
            cost.spread_text(),
            point.rays_per_pixel(),
        );
    }
    table + "</tbody></table>"
}

/// The section of effects; empty for a scene that calls for none.
fn effects(results: &Results) -> String {
    if results.effects.is_empty() {
        return String::new();
    }
    let work = results.start().map_or(1.0, Point::work_per_pixel);
    let worst = results.effects.iter().map(|it| it.lost.rmse);
    let worst = worst.fold(1e-9, f64::max);
    let mut text = format!(
        "\n<section aria-labelledby=\"effects-title\">\n<h2 id=\"effects-title\">What each effect costs</h2>\n\
         <div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-labelledby=\"effects-title\"><table><caption>The picture \
         without an effect against the picture with it, and what is saved. Leave out the upper ones first: they change the \
         picture least for the rays and tests that they save. Instructions per pixel, flash and RAM are those of {}.\
         </caption>\n<thead><tr><th scope=\"col\">effect</th><th scope=\"col\">RMSE without</th><th scope=\"col\">FLIP</th>\
         <th scope=\"col\">rays and tests</th><th scope=\"col\">time</th><th scope=\"col\">instructions</th>\
         <th scope=\"col\">flash, RAM</th><th scope=\"col\">without it</th></tr></thead>\n<tbody>",
        super::BOARD
    );
    for cost in &results.effects {
        let saved = (cost.rays + cost.tests) / work.max(f64::MIN_POSITIVE);
        let _ = writeln!(
            text,
            "<tr><th scope=\"row\">{}</th><td>{}<span class=\"bar\" style=\"width:{:.0}%\"></span></td><td>{}</td>\
             <td>{:.0} %<span class=\"bar cost\" style=\"width:{:.0}%\"></span></td><td>{}</td><td>{}</td><td>{}</td>\
             <td class=\"text\">{} <button type=\"button\" data-setting=\"{}\" aria-label=\"Compare without {}\">compare</button></td></tr>",
            escape(&cost.effect),
            figure(cost.lost.rmse),
            100.0 * cost.lost.rmse / worst,
            figure(cost.lost.flip),
            100.0 * saved,
            (100.0 * saved).clamp(0.0, 100.0),
            cost.time_text(),
            cost.instructions_text(),
            cost.memory_text(),
            escape(&cost.shown_without),
            escape(&cost.without),
            escape(&cost.effect),
        );
    }
    text + "</tbody></table></div>\n</section>\n"
}

impl EffectCost {
    /// Returns the part of the time that is saved, or its range.
    pub fn time_text(&self) -> String {
        let percent = |part: f64| (100.0 * part).round();
        match self.time_range {
            Some([low, high]) if low <= 0.0 && 0.0 <= high => String::from("noise"),
            Some([low, high]) => format!("{} to {} %", percent(low), percent(high)),
            None => format!("{} %, once", percent(self.time)),
        }
    }

    /// Returns the least and the most instructions per pixel of the rays that it sends.
    pub fn instructions_text(&self) -> String {
        let known = self
            .instructions
            .map(|range| range.map(|it| grouped(it.max(0.0).round() as u64)));
        let none = match self.rays > 0.0 {
            true => "unknown",
            false => "no rays",
        };
        known.map_or(String::from(none), |[least, most]| match least == most {
            true => least,
            false => format!("{least} to {most}"),
        })
    }

    /// Bytes of flash and of RAM.
    pub fn memory_text(&self) -> String {
        let text = |bytes: i64| match bytes < 0 {
            true => format!("-{}", grouped(bytes.unsigned_abs())),
            false => grouped(bytes.unsigned_abs()),
        };
        let flash = self.flash.map_or(String::from("unknown"), text);
        format!("{flash}, {}", text(self.ram))
    }
}

fn table(results: &Results) -> String {
    let best = frontier(&results.points);
    let mut table = String::from(
        "<table><caption>A star marks what nothing beats by RMSE and time. Instructions per pixel on boards are \
         estimates.</caption>\n<thead><tr>",
    );
    let columns = ["setting", ""].into_iter().chain(COLUMNS);
    for column in columns.chain(core_names()) {
        let _ = write!(table, "<th scope=\"col\">{column}</th>");
    }
    table.push_str("</tr></thead>\n<tbody>");
    for (point, best) in results.points.iter().zip(best) {
        let star = String::from(if best { "*" } else { "" });
        let boards = core_names().into_iter().map(|board| {
            let range = point.instructions(board);
            let text = range.map(|range| range.map(|n| grouped(n.round())).join(" to "));
            text.unwrap_or_default()
        });
        let _ = write!(table, "<tr><th scope=\"row\">{}</th>", escape(&point.name));
        for cell in [star].into_iter().chain(point.cells()).chain(boards) {
            let _ = write!(table, "<td>{cell}</td>");
        }
        table.push_str("</tr>\n");
    }
    table + "</tbody></table>"
}
