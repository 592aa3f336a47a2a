//! Reads XYZ: molecules as an element and a position for each atom, in angstroms.
//!
//! A frame is a line with its number of atoms, a comment line, and a line per atom. That line has the symbol or atomic
//! number, x, y, z, and columns that are not needed. The frames of a trajectory are models, of which one is drawn; the
//! others are counted, and not read further. Files in extended XYZ are rejected if their first columns differ from
//! these.

use super::importer::{Importer, Input};
use super::molecule::{self, Atom, Element, Model, Parsed, Site};
use super::text::{Source, Warnings};
use super::{Imported, SceneError};
use crate::table::shortened;
use glam::DVec3;
use gridel_core::Up;

pub(super) const IMPORTER: Importer = Importer {
    name: "XYZ",
    about: "molecules of elements and positions",
    extensions: &["xyz"],
    // As PDB.
    up: Up::Y,
    binary: false,
    example: "3\nwater\nO 0 0 0\nH 0.9572 0 0\nH -0.24 0.9266 0\n",
    recognizes: |bytes| {
        let mut lines = bytes.split(|&byte| byte == b'\n');
        let mut words = |number| -> Vec<&str> {
            let line = lines.nth(number).and_then(|line| str::from_utf8(line).ok());
            line.unwrap_or_default().split_whitespace().collect()
        };
        let (count, atom) = (words(0), words(1));
        let are_numbers = |words: &[&str]| words.iter().all(|it| it.parse::<f64>().is_ok());
        count.len() == 1
            && count[0].parse::<usize>().is_ok()
            && atom.len() >= 4
            && are_numbers(&atom[1..4])
    },
    read,
};

/// Reads an XYZ file. It has no camera and no lights; the compiler adds them.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let chosen = input.options.molecule.model;
    molecule::import(input, |source, warnings| parse(source, chosen, warnings))
}

/// Reads the frame that is chosen, counted from 1, and counts all.
///
/// # Errors
/// If a frame has fewer lines than it announces, or a coordinate is no finite number.
fn parse<'a>(
    source: &'a Source,
    chosen: usize,
    warnings: &mut Warnings,
) -> Result<Parsed<'a>, SceneError> {
    let mut parsed = Parsed::default();
    let mut lines = source.lines();
    while let Some((line, text)) = lines.next() {
        // Many files end with empty lines.
        let Some(word) = text.split_whitespace().next() else {
            continue;
        };
        let count = word.parse::<usize>().map_err(|_| {
            let cause = format!(
                "{word:?} is not a number of atoms, with which a frame begins",
                word = shortened(word)
            );
            let remedy = match parsed.models.last() {
                Some(Model { line, .. }) => format!(
                    "check the number of atoms in line {line}, behind which this line comes"
                ),
                None => String::from(
                    "write the number of atoms, a line of comment, and `element x y z` for each",
                ),
            };
            source.error_at(word, cause, remedy)
        })?;
        parsed.add_model(source, Model { number: "", line })?;
        let model = parsed.models.len() - 1;
        let mut next = |done: usize| {
            lines.next().ok_or_else(|| {
                let cause = format!("the file ends behind {done} of the {count} atoms of a frame");
                source
                    .error(cause, "copy the file again, or correct the number of atoms")
                    .at_line(line)
            })
        };
        if count == 0 {
            lines.next();
            continue;
        }
        let (_, comment) = next(0)?;
        if model + 1 != chosen {
            (0..count).try_for_each(|done| next(done).map(drop))?;
            continue;
        }
        check_columns(source, comment)?;
        for done in 0..count {
            let (line, text) = next(done)?;
            parsed.add(source, atom(source, line, text, model, warnings)?)?;
        }
    }
    Ok(parsed)
}

/// Rejects extended XYZ whose first columns are not element and position.
fn check_columns(source: &Source, comment: &str) -> Result<(), SceneError> {
    const USUAL: [&str; 2] = ["species:S:1:pos:R:3", "Z:I:1:pos:R:3"];
    let Some(properties) = value_of(comment, "Properties") else {
        return Ok(());
    };
    let begins = |usual: &str| {
        let rest = properties.strip_prefix(usual);
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()))
    };
    if USUAL.into_iter().any(begins) {
        return Ok(());
    }
    let end = properties
        .find(char::is_whitespace)
        .unwrap_or(properties.len());
    Err(source.error_at(
        &properties[..end],
        "the first columns of the atoms are not element and position",
        format!("write the file with the columns {} first", USUAL[0]),
    ))
}

/// Returns what follows a key and its equals sign, around which spaces are allowed.
fn value_of<'a>(comment: &'a str, key: &str) -> Option<&'a str> {
    let mut found = comment.match_indices(key).filter_map(|(at, _)| {
        let (before, after) = (&comment[..at], &comment[at + key.len()..]);
        let is_word = !before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let value = after.trim_start().strip_prefix('=')?;
        is_word.then(|| {
            value
                .trim_start()
                .trim_start_matches(['"', '\''])
                .trim_start()
        })
    });
    found.next()
}

fn atom<'a>(
    source: &Source,
    line: usize,
    text: &'a str,
    model: usize,
    warnings: &mut Warnings,
) -> Result<Atom<'a>, SceneError> {
    let mut words = text.split_whitespace();
    let mut next = |what: &str| {
        words.next().ok_or_else(|| {
            let cause = format!("the line of an atom has no {what}");
            let remedy = "write `element x y z`, and check the number of atoms before it";
            source.error_at(text, cause, remedy)
        })
    };
    let name = next("element")?;
    let mut position = [0.0; 3];
    for (value, axis) in position.iter_mut().zip(["x", "y", "z"]) {
        let what = format!("{axis} coordinate");
        *value = source.number(next(&what)?, &format!("the {what} of an atom"))?;
    }
    let element = match name.parse::<u8>() {
        Ok(number) => Element::from_number(number),
        Err(_) => Element::from_symbol(name),
    };
    let of = ["of the atom ", name];
    let element = Element::or_unknown(element, of, (source, line), warnings);
    Ok(Atom {
        site: Site {
            element,
            position: DVec3::from_array(position),
        },
        line,
        model,
        name,
        ..Atom::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::tests::samples::{self, load};
    use crate::scene::{ImportOptions, MoleculeOptions, MoleculeStyle, Shape, read};
    use crate::shape::Sphere;
    use std::path::Path;

    fn read_with(text: &str, molecule: MoleculeOptions) -> Result<Imported, SceneError> {
        let options = ImportOptions {
            molecule,
            ..ImportOptions::default()
        };
        read(Path::new("t.xyz"), text.into(), &options)
    }

    fn model(text: &str, model: usize) -> Result<Imported, SceneError> {
        let options = MoleculeOptions {
            model,
            ..MoleculeOptions::default()
        };
        read_with(text, options)
    }

    #[track_caller]
    fn symbols(imported: &Imported) -> String {
        let scene = &imported.scene;
        let name = |object: &crate::scene::Object| scene.materials[object.material].name.clone();
        scene.objects.iter().map(name).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn atoms_are_drawn_as_those_of_other_molecules() {
        let imported = model(IMPORTER.example, 1).unwrap();
        assert_eq!(imported.warnings, [] as [&str; 0]);
        assert!(imported.kinds.molecules);
        assert_eq!(symbols(&imported), "O H H");
        let oxygen = &imported.scene.objects[0];
        assert_eq!((oxygen.name.as_str(), oxygen.place.line), ("O", 3));
        assert!(matches!(
            oxygen.shape,
            Shape::Sphere(Sphere { radius: 1.52, .. })
        ));
        let sticks = read_with(
            IMPORTER.example,
            MoleculeOptions {
                style: MoleculeStyle::BallAndStick,
                ..MoleculeOptions::default()
            },
        );
        // Two half cylinders for each of two bonds.
        assert_eq!(sticks.unwrap().scene.objects.len(), 3 + 4);
    }

    #[test]
    fn atomic_numbers_labels_charges_and_extra_columns_are_read() {
        let text = "6\n\n8 0 0 0\nH1 1 0 0 0.4\n26 3 0 0 1 2 3\nfe3+\t5 0 0\n\u{a0}CL 7 0 0 x\nD 9 0 0\n\n\n";
        let imported = model(text, 1).unwrap();
        assert_eq!(symbols(&imported), "O H Fe Fe Cl H");
        assert_eq!(imported.warnings, [] as [&str; 0]);
        let unknown = model("3\n\nXx 0 0 0\n0 3 0 0\n110 6 0 0\n", 1).unwrap();
        assert_eq!(symbols(&unknown), "X X X");
        assert_eq!(unknown.warnings.len(), 3);
        assert_eq!(
            unknown.warnings[0],
            "t.xyz:3: the element of the atom \"Xx\" is unknown; it is drawn in pink"
        );
    }

    #[test]
    fn one_frame_is_drawn_and_the_others_are_warned_of() {
        let text = "1\nfirst\nC 1 0 0\n0\nnothing\n1\nthird\nN 3 0 0\n";
        let first = model(text, 1).unwrap();
        assert_eq!(symbols(&first), "C");
        assert_eq!(
            first.warnings,
            [
                "t.xyz:4: the file has 3 models, of which model 1 is drawn; `--model N` chooses another"
            ]
        );
        assert_eq!(symbols(&model(text, 3).unwrap()), "N");
        let fault = |text: &str, number: usize| model(text, number).unwrap_err();
        assert_eq!(
            fault(text, 2).to_string(),
            "t.xyz: model 2 of the file has no atoms"
        );
        let beyond = fault(text, 4);
        assert_eq!(
            beyond.to_string(),
            "t.xyz: there is no model 4, since the file has 3"
        );
        assert_eq!(
            beyond.remedy,
            "choose a model from 1 to 3, counted in file order"
        );
    }

    #[test]
    #[rustfmt::skip]
    fn faults_name_line_cause_and_remedy() {
        for (text, cause) in [
            ("", "t.xyz: the file has no atoms"),
            ("\n\n", "t.xyz: the file has no atoms"),
            ("0\n\n", "t.xyz: model 1 of the file has no atoms"),
            ("two\n", "t.xyz:1: \"two\" is not a number of atoms, with which a frame begins"),
            ("-1\n", "t.xyz:1: \"-1\" is not a number of atoms, with which a frame begins"),
            ("1\n\nC 0 0 0\nC 0 0 0\n", "t.xyz:4: \"C\" is not a number of atoms, with which a frame begins"),
            ("2\n\nC 0 0 0\n", "t.xyz:1: the file ends behind 1 of the 2 atoms of a frame"),
            ("1\n", "t.xyz:1: the file ends behind 0 of the 1 atoms of a frame"),
            ("18446744073709551615\n\nC 0 0 0\n", "t.xyz:1: the file ends behind 1 of the 18446744073709551615 atoms of a frame"),
            ("1\n\nC 0 0\n", "t.xyz:3: the line of an atom has no z coordinate"),
            ("1\n\n\n", "t.xyz:3: the line of an atom has no element"),
            ("1\n\nC 0 inf 0\n", "t.xyz:3: the y coordinate of an atom is \"inf\", which is not a finite number"),
            ("1\n\n1 C 0 0 0\n", "t.xyz:3: the x coordinate of an atom is \"C\", which is not a number"),
            ("1\nProperties=id:I:1:species:S:1:pos:R:3\n1 C 0 0 0\n", "t.xyz:2: the first columns of the atoms are not element and position"),
            ("1\nProperties = pos:R:3:Z:I:1\n1 0 0 6\n", "t.xyz:2: the first columns of the atoms are not element and position"),
            ("1\nProperties=species:S:1:pos:R:30\nC 0 0 0\n", "t.xyz:2: the first columns of the atoms are not element and position"),
        ] {
            let error = model(text, 1).unwrap_err();
            assert_eq!(error.to_string(), cause, "{text:?}");
            assert!(!error.remedy.is_empty());
        }
        for properties in [
            "species:S:1:pos:R:3",
            "\"species:S:1:pos:R:3:forces:R:3\"",
            "Z:I:1:pos:R:3 pbc=\"T T T\"",
        ] {
            for is in ["=", " = ", " =", "=  "] {
                let text = format!("1\nLattice=\"1 0 0\" Properties{is}{properties}\n6 0 0 0\n");
                assert_eq!(symbols(&model(&text, 1).unwrap()), "C", "{properties}");
            }
        }
        let other = "1\nMyProperties=pos:R:3 Properties of a carbon\n6 0 0 0\n";
        assert_eq!(symbols(&model(other, 1).unwrap()), "C");
    }

    #[test]
    fn real_molecules_have_the_atoms_that_gemmi_finds() {
        for (name, atoms, warnings) in [
            ("caffeine", 24, 0),
            ("fullerene", 60, 0),
            ("trajectory", 9, 1),
        ] {
            let Some(path) = samples::find(&format!("molecules/{name}.xyz")) else {
                continue;
            };
            let imported = load(&path).unwrap();
            assert_eq!(imported.scene.objects.len(), atoms, "{name}");
            assert_eq!(imported.warnings.len(), warnings, "{:?}", imported.warnings);
        }
    }
}
