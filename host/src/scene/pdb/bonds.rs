//! LINK and SSBOND: bonds beyond those that the residues imply.

use super::columns::columns;
use crate::scene::molecule::{Bond, End};

/// Returns the bond of a LINK or SSBOND, unless symmetry moves one of its ends: it is not where its atom is.
pub(super) fn stated(number: usize, line: &str) -> Option<Bond<'_>> {
    let field = |first: usize, last: usize| columns(line, first, last).trim();
    let [first, second] = [field(60, 65), field(67, 72)];
    if first != second {
        return None;
    }
    let (record, ends) = match field(1, 6) {
        "LINK" => {
            // Name, alternate location, residue, chain, number and insertion code follow each other.
            let end = |at: usize| {
                [
                    field(at + 9, at + 9),
                    field(at + 10, at + 13),
                    field(at + 14, at + 14),
                    field(at, at + 3),
                    field(at + 4, at + 4),
                ]
            };
            ("LINK", [end(13), end(43)])
        }
        _ => {
            let end = |at: usize| {
                [
                    field(at, at),
                    field(at + 2, at + 5),
                    field(at + 6, at + 6),
                    "SG",
                    "",
                ]
            };
            ("SSBOND", [end(16), end(30)])
        }
    };
    Some(Bond {
        record,
        line: number,
        ends: ends.map(End::Name),
    })
}
