//! Changes of the compiler to a scene that its author would want to know.

use gridel_core::Effects;
use gridel_host::compile::{LATTICE_BITS, Report};
use gridel_host::scene::{self, Scene};
use gridel_host::table::{grouped, printable};
use std::path::Path;

/// Names the primitives that the lattice moves far.
pub fn far_moved(report: &Report, lattice_bits: u8) -> Option<String> {
    const NAMED: usize = 3;
    if report.far_moved.count() == 0 {
        return None;
    }
    let remedy = if lattice_bits < *LATTICE_BITS.end() {
        "use more `--lattice-bits`"
    } else {
        "make them thicker or larger"
    };
    Some(format!(
        "the lattice moves the surfaces of some solids by several steps, {}; {remedy}",
        report.far_moved.names(NAMED).join(", ")
    ))
}

/// Says which names the blob lacks or has in part.
pub fn names_changed(report: &Report) -> Option<String> {
    let names = report.names?;
    if names.left_out {
        return Some(String::from(
            "the names are left out, because the blob would exceed `--max-bytes`; raise it to keep them",
        ));
    }
    (names.shortened > 0).then(|| {
        format!(
            "{} cut to 255 bytes in the blob; give shorter names",
            match names.shortened {
                1 => String::from("1 name is"),
                many => format!("{} names are", grouped(many)),
            }
        )
    })
}

/// Leaves effects out of the scene of a file, and reports what each of them loses.
pub fn leave_out(scene: &mut Scene, path: &Path, effects: &[Effects]) -> Vec<String> {
    let file = path.display();
    let lost = effects
        .iter()
        .map(|&effect| match scene::leave_out(scene, effect) {
            None => format!("{file}: the scene does not call for {effect}, so nothing is left out"),
            Some(names) => format!(
                "{file}: without {effect}{}: {}",
                lost_by(&names),
                scene::shown_without(effect)
            ),
        });
    lost.collect()
}

/// Names what loses an effect.
fn lost_by(names: &[String]) -> String {
    const NAMED: usize = 5;
    let shown: Vec<_> = names
        .iter()
        .take(NAMED)
        .map(|name| printable(name))
        .collect();
    let more = match names.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    match shown.is_empty() {
        true => String::new(),
        false => format!(" ({}{more})", shown.join(", ")),
    }
}
