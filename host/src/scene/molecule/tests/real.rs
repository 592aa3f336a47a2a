//! Molecules of the Protein Data Bank and other projects.

use super::*;
use crate::scene::{load, tests::samples};
use crate::shape::Sphere;
use std::collections::BTreeMap;

/// Elements as the facts have them, such as `C202 N55`.
fn elements(imported: &Imported) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for symbol in symbols(imported) {
        *counts.entry(symbol.to_owned()).or_default() += 1;
    }
    counts
}

#[test]
fn real_molecules_have_the_atoms_that_gemmi_finds() {
    let Some(facts) = samples::find("reference/molecule_facts_by_gemmi.csv") else {
        return;
    };
    let text = std::fs::read_to_string(facts).unwrap();
    let mut compared = 0;
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let name = fields[0].trim_start_matches("dev/");
        if !name.ends_with(".pdb") && !name.ends_with(".cif") {
            continue;
        }
        let Some(path) = samples::find(name) else {
            continue;
        };
        let imported = load(&path, &MoleculeOptions::default()).unwrap();
        // Of a capsid the file has one of 60 copies.
        let copies = usize::from(name.ends_with("2buk.pdb"));
        assert_eq!(imported.warnings.len(), copies, "{:?}", imported.warnings);
        // Gemmi counts every alternate location.
        if fields[5] != "0" {
            assert!(
                imported.scene.objects.len() < fields[4].parse::<usize>().unwrap(),
                "{name}"
            );
            continue;
        }
        let expected = fields[6].split(' ').map(|element| {
            let digits = element.find(|c: char| c.is_ascii_digit()).unwrap();
            (
                element[..digits].to_owned(),
                element[digits..].parse::<usize>().unwrap(),
            )
        });
        assert_eq!(elements(&imported), expected.collect(), "{name}");
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for object in &imported.scene.objects {
            let Shape::Sphere(Sphere { center, .. }) = object.shape else {
                panic!("{} is no atom", object.name)
            };
            (low, high) = (low.min(center), high.max(center));
        }
        let bounds: Vec<String> = low
            .to_array()
            .into_iter()
            .chain(high.to_array())
            .map(|c| format!("{c:.3}"))
            .collect();
        assert_eq!(bounds.join(" "), fields[7], "{name}");
        compared += 1;
    }
    println!("{compared} molecules compared");
}

#[test]
fn opsin_loses_the_second_of_its_alternate_locations() {
    let Some(path) = samples::find("molecules/3dqb.pdb") else {
        return;
    };
    let text = std::fs::read_to_string(&path).unwrap();
    let atoms = text
        .lines()
        .filter(|line| line.starts_with("ATOM") || line.starts_with("HETATM"));
    let expected = atoms
        .filter(|line| matches!(&line[16..17], " " | "A"))
        .count();
    let imported = load(&path, &MoleculeOptions::default()).unwrap();
    assert_eq!(imported.scene.objects.len(), expected);
}

#[test]
fn pdb_and_mmcif_of_one_structure_agree() {
    for (pdb, cif) in [("1crn.pdb", "1CRN.cif"), ("4hhb.pdb", "4hhb.cif")] {
        let paths = [pdb, cif].map(|name| samples::find(&format!("molecules/{name}")));
        let [Some(pdb), Some(cif)] = paths else {
            continue;
        };
        let [pdb, cif] = [pdb, cif].map(|path| load(&path, &MoleculeOptions::default()).unwrap());
        let atoms = |imported: &Imported| {
            let mut atoms: Vec<String> = imported
                .scene
                .objects
                .iter()
                .map(|o| format!("{} {:?}", o.name, o.shape))
                .collect();
            atoms.sort();
            atoms
        };
        assert_eq!(atoms(&pdb), atoms(&cif));
    }
}

#[test]
fn files_of_other_programs_get_all_bonds() {
    let options = MoleculeOptions {
        style: MoleculeStyle::BallAndStick,
        ..MoleculeOptions::default()
    };
    // An open chain has a bond less than atoms, and each of the 512 waters has two.
    for (name, atoms, bonds) in [("acrolein.pdb", 8, 7), ("liquid.pdb", 1536, 1024)] {
        let Some(path) = samples::find(&format!("molecules/{name}")) else {
            continue;
        };
        let objects = load(&path, &options).unwrap().scene.objects.len();
        assert_eq!(objects, atoms + 2 * bonds, "{name}");
    }
}
