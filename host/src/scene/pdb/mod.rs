//! The columns of a PDB file (format 3.3): ATOM, HETATM, MODEL, ENDMDL, END, CONECT, LINK, SSBOND, MTRIX and REMARK
//! 350. Atoms behind an END begin a model of their own, because programs of dynamics end their frames so.
//!
//! Columns are those of the format's description, counted from 1. The importer reads only what drawing needs, so it
//! accepts files that omit the rest or break its rules. Serial numbers may be `*****` or hexadecimal, and everything
//! after the coordinates may be missing.

mod biomt;
mod bonds;
mod columns;
mod mtrix;
mod names;

use super::importer::{Importer, Input};
use super::molecule::{self, Atom, Bond, Element, End, Model, Parsed, Site};
use super::text::{Source, Warnings};
use super::{Imported, SceneError};
use biomt::Assemblies;
use columns::columns;
use glam::DVec3;
use gridel_core::Up;
use mtrix::Generating;
use names::element_of_name;

pub(super) const IMPORTER: Importer = Importer {
    name: "PDB",
    about: "molecules in the columns of the Protein Data Bank",
    extensions: &["pdb", "ent"],
    // Molecules have no up; viewers show them along -z with y up.
    up: Up::Y,
    binary: false,
    example: "\
ATOM      1  N   CYS A   3      11.000   2.000   3.000  1.00  0.00           N
ATOM      2  CA  CYS A   3      12.400   2.000   3.000  1.00  0.00           C
END
",
    recognizes: |bytes| {
        const RECORDS: [&[u8]; 12] = [
            b"HEADER", b"OBSLTE", b"TITLE ", b"COMPND", b"AUTHOR", b"REMARK", b"CRYST1", b"MODEL ",
            b"ATOM  ", b"HETATM", b"SEQRES", b"ORIGX1",
        ];
        RECORDS.iter().any(|record| bytes.starts_with(record))
    },
    read,
};

/// Reads a PDB file. It has no camera and no lights; the compiler adds them.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    molecule::import(input, parse)
}

/// Reads all models.
///
/// # Errors
/// If a line of an atom is too short, or its coordinates are no finite numbers.
fn parse<'a>(source: &'a Source, warnings: &mut Warnings) -> Result<Parsed<'a>, SceneError> {
    parse_into(source, Parsed::default(), warnings)
}

/// Reads all models, and adds them to what there is.
pub(super) fn parse_into<'a>(
    source: &'a Source,
    mut parsed: Parsed<'a>,
    warnings: &mut Warnings,
) -> Result<Parsed<'a>, SceneError> {
    let mut assemblies = Assemblies::default();
    let mut generating = Generating::default();
    // The number that the file gives the next model, if the next atom starts one.
    let mut next_model = Some("1");
    for (number, line) in source.lines() {
        match columns(line, 1, 6).trim_end() {
            "ATOM" | "HETATM" => {
                let model = next_model.take().map(|text| Model {
                    number: text,
                    line: number,
                });
                if let Some(model) = model {
                    parsed.add_model(source, model)?;
                }
                let model = parsed.models.len() - 1;
                parsed.add(source, atom(source, number, line, model, warnings)?)?;
            }
            "REMARK" if columns(line, 7, 10).trim() == "350" => {
                assemblies.remark(source, number, columns(line, 11, 80), &mut parsed)?;
            }
            // Some programs leave ENDMDL out, or let atoms without a MODEL follow it.
            "MODEL" => next_model = Some(columns(line, 7, 80).trim()),
            "ENDMDL" | "END" => next_model = next_model.or(Some("without a number")),
            "CONECT" => {
                let from = columns(line, 7, 11).trim();
                for first in [12, 17, 22, 27] {
                    let to = columns(line, first, first + 4).trim();
                    if !from.is_empty() && !to.is_empty() {
                        let bond = Bond {
                            record: "CONECT",
                            line: number,
                            ends: [from, to].map(End::Serial),
                        };
                        parsed.add_bond(source, bond)?;
                    }
                }
            }
            "LINK" | "SSBOND" => {
                if let Some(bond) = bonds::stated(number, line) {
                    parsed.add_bond(source, bond)?;
                }
            }
            "MTRIX1" | "MTRIX2" | "MTRIX3" => {
                generating.row(source, number, line, &mut parsed)?;
            }
            _ => {}
        }
    }
    generating.finish(source, &mut parsed)?;
    Ok(parsed)
}

fn atom<'a>(
    source: &Source,
    number: usize,
    line: &'a str,
    model: usize,
    warnings: &mut Warnings,
) -> Result<Atom<'a>, SceneError> {
    let mut position = [0.0; 3];
    for (axis, value) in position.iter_mut().enumerate() {
        let name = ["x", "y", "z"][axis];
        let first = 31 + 8 * axis;
        let field = columns(line, first, first + 7);
        // A number that is cut off would still read as a number.
        if field.chars().count() < 8 {
            return Err(source.error_at(
                line,
                format!("the line ends before the {name} coordinate of its atom does"),
                format!(
                    "complete the line: {name} stands in columns {first} to {}",
                    first + 7
                ),
            ));
        }
        *value = source.number(
            field.trim(),
            &format!("the {name} coordinate (columns {first} to {})", first + 7),
        )?;
    }
    let field = columns(line, 13, 16);
    // Column 21 is blank in the format and the fourth letter of a name in its extensions.
    let residue = columns(line, 18, 21).trim();
    let element = match stated_symbol(line) {
        Some(symbol) => Element::from_symbol(symbol),
        None => element_of_name(field, residue, columns(line, 1, 6) == "HETATM"),
    };
    let of = ["of the atom ", field.trim()];
    let element = Element::or_unknown(element, of, (source, number), warnings);
    let segment = columns(line, 73, 76).trim();
    Ok(Atom {
        site: Site {
            element,
            position: DVec3::from_array(position),
        },
        line: number,
        model,
        serial: columns(line, 7, 11).trim(),
        name: field.trim(),
        altloc: columns(line, 17, 17).trim(),
        chain: columns(line, 22, 22).trim(),
        asym: columns(line, 22, 22).trim(),
        residue,
        number: columns(line, 23, 26).trim(),
        insertion: columns(line, 27, 27).trim(),
        label: "",
        // Charges and numbers of lines can stand there, too.
        segment: match has_letter(segment) {
            true => segment,
            false => "",
        },
    })
}

/// Returns the symbol of an atom's element, as the file states it, known or unknown. `None` where its columns are blank
/// or have something else: line numbers of old files, or a part of a longer word.
fn stated_symbol(line: &str) -> Option<&str> {
    let symbol = columns(line, 77, 78).trim();
    // A charge begins with a digit or a sign.
    let is_word = has_letter(columns(line, 79, 79));
    let is_known = || Element::from_symbol(symbol).is_some();
    (has_letter(symbol) && (!is_word || is_known())).then_some(symbol)
}

fn has_letter(text: &str) -> bool {
    text.contains(|c: char| c.is_ascii_alphabetic())
}
