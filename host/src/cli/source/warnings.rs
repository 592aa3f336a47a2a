//! What the compiler did to a scene that its author would want to know.

use gridel_host::compile::{LATTICE_BITS, Report};
use gridel_host::table::grouped;

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
