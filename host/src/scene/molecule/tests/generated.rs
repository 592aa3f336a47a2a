//! Copies of atoms that files state by operators alone.

use super::assembly::{assembled, chains, cif_of};
use super::*;
use crate::scene::Placement;

#[test]
fn operators_that_generate_atoms_are_warned_of_and_drawn_on_request() {
    let row = |axis: usize, number: u32, words: &str, given: &str| {
        format!("MTRIX{axis}{number:4}{words}        0.00000    {given}\n")
    };
    let [x, y, z] = [
        "  1.000000  0.000000  0.000000",
        "  0.000000  1.000000  0.000000",
        "  0.000000  0.000000  1.000000",
    ];
    let turned = "  0.000000 -1.000000  0.000000";
    let operator = |number, rows: [&str; 3], given: &str| {
        let rows = (1..).zip(rows);
        let rows = rows.map(|(axis, words)| row(axis, number, words, given));
        rows.collect::<String>()
    };
    let given = operator(1, [x, y, z], "1") + &operator(3, [turned, x, z], "1");
    let text = format!("{given}{}{}", operator(2, [turned, x, z], ""), chains(&[]));
    let sentence = "t.pdb:7: the file states 2 copies of its atoms by operators (MTRIX, struct_ncs_oper), of which one is \
                    drawn; `--assembly generated` draws all";
    assert_eq!(pdb(&text).unwrap().warnings, [sentence]);
    let imported = assembled("t.pdb", &text, "generated").unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    let [first, second] = &imported.scene.instances[..] else {
        panic!("{:?}", imported.scene.instances)
    };
    assert_eq!(first.placement, Placement::IDENTITY);
    assert_eq!(second.placement.point(DVec3::X), DVec3::Y);
    // Nothing is left out.
    let complete = format!("{given}{}", chains(&[]));
    assert_eq!(pdb(&complete).unwrap().warnings, [] as [&str; 0]);
}

#[test]
fn operators_of_mmcif_that_generate_atoms_are_warned_of() {
    let mut text = cif_of(&[]).replace("_pdbx_struct_oper_list", "_struct_ncs_oper");
    text = text.replace(
        "_struct_ncs_oper.id\n",
        "_struct_ncs_oper.id\n_struct_ncs_oper.code\n",
    );
    for (id, code) in [
        ("1", "given"),
        ("2", "generate"),
        ("3", "generate"),
        ("4", "given"),
        ("5", "given"),
        ("P", "given"),
    ] {
        text = text.replace(&format!("\n{id} "), &format!("\n{id} {code} "));
    }
    let text = text
        .replace("1 given C CA", "1 C CA")
        .replace("2 generate O", "2 O");
    let [warning] = &cif(&text).unwrap().warnings[..] else {
        panic!("{text}")
    };
    assert!(warning.contains("3 copies of its atoms"), "{warning}");
    let scene = assembled("t.cif", &text, "generated").unwrap().scene;
    assert_eq!(scene.instances.len(), 3);
}
