//! The results as text and as a table of comma-separated values.

use super::choice::Choice;
use super::folder::PAGE;
use gridel_host::accuracy::{
    BOARD, COLUMNS, Point, Results, answers, frontier, instance_notes, sentences,
};
use gridel_host::measure::board as boards;
use gridel_host::table::{Align, Table, counted, significant};
use std::fmt::Write;
use std::path::Path;

/// Returns the results for people.
pub fn text(folder: &Path, size: [u16; 2], results: &Results, choice: Option<&Choice>) -> String {
    let best = frontier(&results.points);
    let figures = COLUMNS.into_iter().map(|title| (title, Align::Right));
    let names = [("", Align::Left), ("setting", Align::Left)];
    let mut table = Table::new(names.into_iter().chain(figures));
    for (point, best) in results.points.iter().zip(best) {
        let star = String::from(if best { "*" } else { "" });
        table.row([star, point.name.clone()].into_iter().chain(point.cells()));
    }
    let mut text = format!(
        "{}, {} x {} pixels; * no other setting has a smaller error at a cost that is surely not higher\n{table}\n",
        counted(results.points.len(), "setting"),
        size[0],
        size[1]
    );
    // Writing to a string cannot fail.
    for note in results.instances.iter().flat_map(instance_notes) {
        let _ = writeln!(text, "{note}");
    }
    text.push_str(&effects(results));
    for sentence in answers(results) {
        let _ = writeln!(text, "{sentence}");
    }
    text.push('\n');
    for sentence in sentences(results) {
        let _ = writeln!(text, "{sentence}");
    }
    let _ = writeln!(
        text,
        "\n{}: answers, chart and pictures",
        folder.join(PAGE).display()
    );
    if let Some(choice) = choice {
        let _ = writeln!(
            text,
            "\nThe best within the limits is {}, with an RMSE of {} and {} rays per pixel{}:\n  {}\n  {}",
            choice.name,
            significant(choice.rmse),
            significant(choice.rays_per_pixel),
            choice.noise.as_deref().unwrap_or_default(),
            choice.build,
            choice.render
        );
    }
    text
}

/// Returns the cost of each effect; empty for a scene that calls for none.
fn effects(results: &Results) -> String {
    if results.effects.is_empty() {
        return String::new();
    }
    let memory = format!("flash, RAM of {BOARD}");
    let mut table = Table::new([
        ("effect", Align::Left),
        ("RMSE without", Align::Right),
        ("FLIP", Align::Right),
        ("rays per pixel", Align::Right),
        ("tests", Align::Right),
        ("time", Align::Right),
        ("instructions", Align::Right),
        (&memory, Align::Right),
    ]);
    for cost in &results.effects {
        table.row([
            cost.effect.clone(),
            format!("{:.5}", cost.lost.rmse),
            format!("{:.4}", cost.lost.flip),
            format!("{:.2}", cost.rays),
            format!("{:.1}", cost.tests),
            cost.time_text(),
            cost.instructions_text(),
            cost.memory_text(),
        ]);
    }
    format!(
        "Effects, in the order in which to give them up, and what each of them costs\n{table}\n"
    )
}

/// Returns the results for spreadsheets.
pub fn csv(points: &[Point]) -> String {
    let mut csv = String::from(
        "name,format,lattice_bits,samples,depth,cutoff,without,rmse,sampling,arithmetic,largest,pixels_off,ssim,flip,\
         other_objects,t_ulps_median,t_ulps_largest,seconds,spread,rays,tests,pixels,blob_bytes,\
         working_bytes",
    );
    for board in boards::core_names() {
        let _ = write!(csv, ",{board}_least,{board}_most");
    }
    csv.push('\n');
    for point in points {
        let Point {
            name,
            setting,
            errors,
            cost,
            ..
        } = point;
        let _ = write!(
            csv,
            "{name},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
            setting.format.name(),
            setting.lattice_bits,
            setting.samples,
            setting.depth,
            setting.cutoff,
            setting.without.names().collect::<Vec<_>>().join(" "),
            errors.rmse,
            point.parts.sampling,
            point.parts.arithmetic,
            errors.largest,
            errors.pixels_off,
            errors.ssim,
            errors.flip,
            errors.other_objects,
            errors.t_ulps[0],
            errors.t_ulps[1],
            cost.time(),
            cost.spread()
                .map_or(String::new(), |spread| spread.to_string()),
            cost.rays,
            cost.tests,
            cost.pixels,
            cost.blob_bytes,
            cost.working_bytes
        );
        for board in boards::core_names() {
            match point.instructions(board) {
                Some([least, most]) => {
                    let _ = write!(csv, ",{least:.0},{most:.0}");
                }
                None => csv.push_str(",,"),
            }
        }
        csv.push('\n');
    }
    csv
}
