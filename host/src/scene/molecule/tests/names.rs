//! Elements from the names of atoms, in PDB files that do not state them.

use super::*;

/// The symbol of an atom without an element column.
fn symbol(record: &str, name: &str, residue: &str) -> String {
    let text = format!("{record:<6}    1 {name} {residue} A   1       0.000   0.000   0.000\n");
    symbols(&pdb(&text).unwrap())[0].to_owned()
}

#[test]
fn ions_are_named_like_their_residue() {
    for (name, residue, element) in [
        ("CL  ", " CL", "Cl"),
        ("NA  ", " NA", "Na"),
        ("CA  ", " CA", "Ca"),
        (" CA ", " CA", "Ca"),
        ("CU  ", "CU1", "Cu"),
        ("CD  ", " CD", "Cd"),
        ("HG  ", " HG", "Hg"),
        ("CO  ", "3CO", "Co"),
        ("NI  ", " NI", "Ni"),
        ("CS  ", " CS", "Cs"),
        ("Na+ ", "Na+", "Na"),
        ("CL- ", "CL-", "Cl"),
        ("CA  ", "ALA", "C"),
        (" CA ", "ALA", "C"),
        (" C  ", "  C", "C"),
        (" N  ", " DN", "N"),
    ] {
        assert_eq!(symbol("ATOM", name, residue), element, "{name} {residue}");
    }
    for (name, residue, element) in [("HG  ", " HG", "Hg"), ("CD  ", " CD", "Cd")] {
        assert_eq!(symbol("HETATM", name, residue), element, "{name}");
    }
}

#[test]
fn names_of_four_characters_are_of_elements_of_one_letter() {
    for (name, element) in [
        ("HG21", "H"),
        ("HO5'", "H"),
        ("HE21", "H"),
        ("HD11", "H"),
        ("HF12", "H"),
        ("HB2A", "H"),
        ("CD12", "C"),
        ("CE1A", "C"),
        ("CO2'", "C"),
        ("NE21", "N"),
        ("OS1'", "O"),
        ("CL12", "Cl"),
        ("SE12", "Se"),
        ("FE12", "Fe"),
        ("ZN12", "Zn"),
        ("Hg12", "Hg"),
        // Shorter names leave the second column to the symbol.
        ("HG  ", "Hg"),
        ("CD1 ", "Cd"),
        ("NI  ", "Ni"),
    ] {
        assert_eq!(symbol("HETATM", name, "LIG"), element, "{name}");
    }
}
