//! Bonds that files state.

use super::*;

/// The sticks of a file, by the atoms that they join, and the warnings.
fn sticks(file: &str, text: &str) -> (Vec<String>, Vec<String>) {
    let options = MoleculeOptions {
        style: MoleculeStyle::BallAndStick,
        ..MoleculeOptions::default()
    };
    let imported = read(file, text, &options).unwrap();
    let sticks = names(&imported).into_iter().map(String::from);
    let sticks = sticks.filter(|it| it.contains(" to ")).step_by(2);
    (sticks.collect(), imported.warnings)
}

/// Two chains whose names the author and the archive exchange, far apart.
fn exchanged(rows: &str, columns: &str) -> String {
    format!(
        "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_asym_id\n\
         _atom_site.label_seq_id\n_atom_site.auth_asym_id\n_atom_site.auth_seq_id\n_atom_site.Cartn_x\n\
         _atom_site.Cartn_y\n_atom_site.Cartn_z\n{rows}loop_\n_struct_conn.conn_type_id\n{columns}"
    )
}

#[test]
fn ends_with_names_of_the_archive_alone_are_compared_with_those() {
    let columns = "_struct_conn.ptnr1_label_asym_id\n_struct_conn.ptnr1_label_seq_id\n\
                   _struct_conn.ptnr1_label_atom_id\n_struct_conn.ptnr2_label_asym_id\n\
                   _struct_conn.ptnr2_label_seq_id\n_struct_conn.ptnr2_label_atom_id\n\
                   disulf A 5 SG A 9 SG\n";
    let rows = "S SG A 5 B 5 0 0 0\nS SG A 9 B 9 9 0 0\nS SG B 5 A 5 50 0 0\nS SG B 9 A 9 70 0 0\n";
    let (found, warnings) = sticks("t.cif", &exchanged(rows, columns));
    assert_eq!(found, ["B/5/SG to B/9/SG"]);
    assert_eq!(warnings, [] as [&str; 0]);
    let rows = "S SG A 5 X 105 0 0 0\nS SG A 9 X 109 9 0 0\n";
    let (found, warnings) = sticks("t.cif", &exchanged(rows, columns));
    assert_eq!(found, ["X/105/SG to X/109/SG"]);
    assert_eq!(warnings, [] as [&str; 0]);
    let (found, warnings) = sticks("t.cif", &exchanged(rows, &columns.replace("A 9", "A 7")));
    assert_eq!(found, [] as [&str; 0]);
    assert_eq!(
        warnings,
        ["t.cif:22: struct_conn names the atom A/7/SG, which the file lacks; the bond is left out"]
    );
}

#[test]
fn ambiguous_ends_are_left_out_with_a_warning() {
    let atom = |serial: &str, x: u32| {
        format!(
            "HETATM{serial:>5}  C   LIG A{x:4}    {x:4}.000   0.000   0.000  1.00  0.00           C\n"
        )
    };
    let all = [("1", 0), ("*****", 20), ("*****", 40), ("2", 60)];
    let atoms: String = all.map(|(serial, x)| atom(serial, x)).concat();
    let text = format!("{atoms}CONECT    1*****    2\n");
    let (found, warnings) = sticks("t.pdb", &text);
    assert_eq!(found, ["A/LIG 0/C to A/LIG 60/C"]);
    assert_eq!(
        warnings,
        [
            "t.pdb:5: CONECT names the atom *****, but several atoms have this name; the bond is left out"
        ]
    );
    let text = text.replacen("*****  C", "    9  C", 1);
    let (found, warnings) = sticks("t.pdb", &text);
    assert_eq!((found.len(), warnings.len()), (2, 0));
}

#[test]
fn links_and_disulfides_are_bonds() {
    let atoms = "HETATM    1 ZN    ZN A   1       0.000   0.000   0.000  1.00  0.00          ZN\n\
                 ATOM      2  SG  CYS A   2      12.900   0.000   0.000  1.00  0.00           S\n\
                 ATOM      3  SG  CYS B   3A     22.900   9.900   0.000  1.00  0.00           S\n";
    let link = "LINK        ZN    ZN A   1                 SG  CYS A   2     1555   1555  2.90\n";
    let bridge = "SSBOND   1 CYS A    2    CYS B    3A                         1555   1555  2.90\n";
    let both = ["A/ZN 1/ZN to A/CYS 2/SG", "A/CYS 2/SG to B/CYS 3A/SG"];
    let (found, warnings) = sticks("t.pdb", &format!("{link}{bridge}{atoms}"));
    assert_eq!(found, both);
    assert_eq!(warnings, [] as [&str; 0]);
    // Symmetry moves an end.
    let moved = link.replace("1555   1555", "1555   2655");
    let (found, warnings) = sticks("t.pdb", &format!("{moved}{bridge}{atoms}"));
    assert_eq!(found, both[1..]);
    assert_eq!(warnings, [] as [&str; 0]);
    let missing = link.replace("SG  CYS A   2", "S   CYS A   2");
    assert_eq!(
        sticks("t.pdb", &format!("{missing}{atoms}")).1,
        ["t.pdb:1: LINK names the atom A/2/S, which the file lacks; the bond is left out"]
    );
}
