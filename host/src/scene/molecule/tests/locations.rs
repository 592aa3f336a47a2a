//! Alternate locations, and the residues that have them.

use super::*;

/// Names and x of the atoms that are drawn.
fn drawn(file: &str, text: &str, altloc: Option<char>) -> Vec<(String, f64)> {
    let options = MoleculeOptions {
        altloc,
        ..MoleculeOptions::default()
    };
    let imported = read(file, text, &options).unwrap();
    let objects = imported.scene.objects.into_iter();
    objects
        .map(|it| match it.shape {
            Shape::Sphere(Sphere { center, .. }) => (it.name, center.x),
            _ => panic!("{} is no atom", it.name),
        })
        .collect()
}

fn of_pdb(atoms: &[(&str, &str, f64)], altloc: Option<char>) -> Vec<f64> {
    let line = |&(name, residue, x): &(&str, &str, f64)| {
        format!(
            "ATOM      1 {name}{residue} A   1    {x:8.3}   0.000   0.000  1.00  0.00           C\n"
        )
    };
    let text: String = atoms.iter().map(line).collect();
    let drawn = drawn("t.pdb", &text, altloc);
    drawn.into_iter().map(|(_, x)| x).collect()
}

#[test]
fn atoms_that_lack_the_location_of_their_residue_keep_their_first_one() {
    let apart = [
        (" N  ", " SER", 0.0),
        (" CA ", "ASER", 1.0),
        (" CA ", "BSER", 2.0),
        (" CB ", "CSER", 3.0),
        (" CB ", "DSER", 4.0),
    ];
    assert_eq!(of_pdb(&apart, None), [0.0, 1.0, 3.0]);
    assert_eq!(of_pdb(&apart, Some('B')), [0.0, 2.0, 3.0]);
    assert_eq!(of_pdb(&apart, Some('D')), [0.0, 1.0, 4.0]);
    let chained = [
        (" CA ", "ASER", 1.0),
        (" CA ", "BSER", 2.0),
        (" CB ", "BSER", 3.0),
        (" CB ", "CSER", 4.0),
    ];
    assert_eq!(of_pdb(&chained, None), [1.0, 3.0]);
    assert_eq!(of_pdb(&chained, Some('B')), [2.0, 3.0]);
    // What is requested does not mix with its alternatives.
    assert_eq!(of_pdb(&chained, Some('A')), [1.0, 4.0]);
    assert_eq!(of_pdb(&chained, Some('C')), [1.0, 4.0]);
    let cut = [
        (" CB ", "ASER", 1.0),
        (" CB ", "BSER", 2.0),
        (" OG ", "ASER", 3.0),
    ];
    assert_eq!(of_pdb(&cut, Some('B')), [2.0]);
    // Atoms of another kind of residue in its place do not count.
    let kinds = [
        (" CA ", "APRO", 1.0),
        (" CG ", "APRO", 2.0),
        (" CA ", "BSER", 3.0),
        (" OG ", "BSER", 4.0),
    ];
    assert_eq!(of_pdb(&kinds, None), [1.0, 2.0]);
    assert_eq!(of_pdb(&kinds, Some('B')), [3.0, 4.0]);
}

#[test]
fn waters_without_numbers_are_residues_of_their_own() {
    let head = "data_t\nloop_\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_alt_id\n\
                _atom_site.label_comp_id\n_atom_site.auth_asym_id\n_atom_site.label_asym_id\n\
                _atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
    let count = |rows: &str| drawn("t.cif", &format!("{head}{rows}"), None).len();
    // The third repeats the first one's name and location.
    let rows = "O O A HOH X W . 0 0 0\nO O B HOH X W . 5 0 0\nO O A HOH X W . 10 0 0\n";
    assert_eq!(count(rows), 2);
    let chains = "O O A HOH X W . 0 0 0\nO O B HOH X V . 5 0 0\n";
    assert_eq!(count(chains), 2);
    let one = "O O A HOH X W 7 0 0 0\nO O B HOH X W 7 5 0 0\n";
    assert_eq!(count(one), 1);
}

#[test]
fn segments_distinguish_residues_of_chains_without_a_name() {
    let water = |x: f64, altloc: char, end: &str| {
        format!(
            "HETATM    1  O  {altloc}HOH     1    {x:8.3}   0.000   0.000  1.00  0.00      {end}\n"
        )
    };
    let count = |ends: [&str; 2]| {
        let text = water(0.0, 'A', ends[0]) + &water(50.0, 'B', ends[1]);
        drawn("t.pdb", &text, None).len()
    };
    assert_eq!(count(["WA   O", "WB   O"]), 2);
    assert_eq!(count(["WA   O", "WA   O"]), 1);
    assert_eq!(count(["     O", "     O"]), 1);
    // Charges of other programs.
    assert_eq!(count(["0.41 O", "0.39 O"]), 1);
    let again = water(0.0, 'A', "") + &water(50.0, 'B', "") + &water(90.0, 'A', "");
    assert_eq!(drawn("t.pdb", &again, None).len(), 2);
}
