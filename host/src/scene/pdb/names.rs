//! The elements of atoms in files that do not state them.

use super::columns::columns;
use crate::scene::molecule::Element;

/// Symbols of two letters with which a name of four characters can begin, although it could be a hydrogen, carbon,
/// nitrogen, oxygen, phosphorus or sulfur: no usual name of these begins so.
const FULL: [&str; 12] = [
    "CL", "CR", "CU", "NI", "PR", "PT", "PU", "SE", "SI", "SM", "SN", "SR",
];

/// Returns the element from the four columns of an atom's name, whose first two are the symbol,
/// right-justified: ` CA ` is a carbon, `CA  ` is calcium. An ion has the name of its residue.
pub(super) fn element_of_name(field: &str, residue: &str, hetero: bool) -> Option<Element> {
    let name = field.trim();
    // The wwPDB's name for an atom of an unknown element; it is neither uranium nor nitrogen.
    if name == "UNK" {
        return None;
    }
    if let Some(ion) = ion(name, residue) {
        return Some(ion);
    }
    let letters = field.trim_start_matches(|c: char| c.is_whitespace() || c.is_ascii_digit());
    let (one, two, rest) = (
        columns(letters, 1, 1),
        columns(letters, 1, 2),
        columns(letters, 3, 4),
    );
    let is_symbol =
        |symbol: &str| symbol.len() == 2 && symbol.ends_with(|c: char| c.is_ascii_alphabetic());
    // Many programs start all names in the first column. So two letters are a symbol only in two cases. The second is a
    // small letter; or no more letters follow and the atom is not in a biopolymer, whose elements have one letter.
    let written_small = two.ends_with(|c: char| c.is_ascii_lowercase());
    let organic = one.starts_with(['H', 'C', 'N', 'O', 'P', 'S']);
    let no_biopolymer = hetero || !organic;
    let alone = letters.len() == field.len() && !rest.contains(|c: char| c.is_ascii_alphabetic());
    // A name that fills its columns leaves none to tell symbols of one letter from those of two, as in `HG21`.
    let is_full = name.chars().count() == 4 && organic && !FULL.contains(&two);
    if is_symbol(two) && (written_small || (alone && no_biopolymer && !is_full)) {
        Element::from_symbol(two).or_else(|| Element::from_symbol(one))
    } else {
        Element::from_symbol(one)
    }
}

/// The element of an ion: its symbol has two letters, and its residue is named like it, as in `CL`, `Na+` and `CU1`.
fn ion(name: &str, residue: &str) -> Option<Element> {
    let letters = |text| str::trim_matches(text, |c: char| !c.is_ascii_alphabetic());
    let symbol = letters(name);
    let is_ion = symbol.len() == 2 && symbol.eq_ignore_ascii_case(letters(residue));
    is_ion.then(|| Element::from_symbol(symbol)).flatten()
}
