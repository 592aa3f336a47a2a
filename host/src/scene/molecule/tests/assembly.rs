//! Biological assemblies.

use super::*;
use crate::scene::{Instances, Placement};

/// A file as an assembly.
pub(super) fn assembled(file: &str, text: &str, wanted: &str) -> Result<Imported, SceneError> {
    let options = ImportOptions {
        assembly: Some(wanted.to_owned()),
        ..ImportOptions::default()
    };
    crate::scene::read(Path::new(file), text.into(), &options)
}

/// Three chains of an atom each, with these remarks before them.
pub(super) fn chains(remarks: &[&str]) -> String {
    let remarks = remarks.iter().map(|it| format!("REMARK 350 {it}\n"));
    let mut text: String = remarks.collect();
    for (number, chain) in ["A", "B", "C"].iter().enumerate() {
        let serial = number + 1;
        text.push_str(&format!(
            "ATOM  {serial:5}  CA  CYS {chain}   3      {serial:2}.000   2.000   3.000  1.00  0.00           C\n"
        ));
    }
    text
}

const IDENTITY: [&str; 3] = [
    "  BIOMT1   1  1.000000  0.000000  0.000000        0.00000",
    "  BIOMT2   1  0.000000  1.000000  0.000000        0.00000",
    "  BIOMT3   1  0.000000  0.000000  1.000000        0.00000",
];

/// A third of a turn about z, rounded, and a step along x.
const TURN: [&str; 3] = [
    "  BIOMT1   2 -0.500000 -0.866025  0.000000       10.00000",
    "  BIOMT2   2  0.866025 -0.500000  0.000000        0.00000",
    "  BIOMT3   2  0.000000  0.000000  1.000000        0.00000",
];

fn remarks<'a>(parts: &[&[&'a str]]) -> Vec<&'a str> {
    parts.concat()
}

#[test]
fn identity_alone_stays_objects() {
    let head = ["BIOMOLECULE: 1", "APPLY THE FOLLOWING TO CHAINS: A, B"];
    let text = chains(&remarks(&[&head, &IDENTITY]));
    let imported = assembled("t.pdb", &text, "1").unwrap();
    assert_eq!(names(&imported), ["A/CYS 3/CA", "B/CYS 3/CA"]);
    assert!(imported.scene.parts.is_empty() && imported.scene.instances.is_empty());
    let whole = pdb(&text).unwrap();
    assert_eq!(whole.scene.objects.len(), 3);
    assert!(whole.kinds.assemblies);
}

#[test]
fn chains_with_operators_are_parts() {
    let text = chains(&remarks(&[
        &[
            "BIOMOLECULE: 1",
            "APPLY THE FOLLOWING TO CHAINS: A,",
            "                   AND CHAINS: B",
        ],
        &IDENTITY,
        &TURN,
        &["APPLY THE FOLLOWING TO CHAINS: C"],
        &IDENTITY,
        &["BIOMOLECULE: 2", "APPLY THE FOLLOWING TO CHAINS: A"],
        &TURN,
    ]));
    let imported = assembled("t.pdb", &text, "1").unwrap();
    let scene = &imported.scene;
    assert_eq!(names(&imported), ["C/CYS 3/CA"]);
    let [part] = &scene.parts[..] else {
        panic!("{:?}", scene.parts)
    };
    assert_eq!((part.name.as_str(), part.objects.len()), ("chains A B", 2));
    assert_eq!(part.objects[0].material, scene.objects[0].material);
    let [first, second] = &scene.instances[..] else {
        panic!("{:?}", scene.instances)
    };
    assert_eq!(
        (first.name.as_str(), first.placement),
        ("1", Placement::IDENTITY)
    );
    assert_eq!(second.name, "2");
    let placed = second.placement.point(DVec3::new(1.0, 0.0, 0.0));
    let expected = DVec3::new(9.5, 0.75_f64.sqrt(), 0.0);
    assert!((placed - expected).length() < 1e-6, "{placed}");
    let turn = second.placement.matrix();
    let square = turn * turn.transpose();
    assert!(square.abs_diff_eq(glam::DMat3::IDENTITY, 1e-14), "{square}");

    let second = assembled("t.pdb", &text, "2").unwrap().scene;
    assert_eq!((second.parts.len(), second.instances.len()), (1, 1));
    assert_eq!(second.flattened().unwrap().objects[0].name, "2/A/CYS 3/CA");
}

#[test]
fn remarks_without_headings_hold_for_all_chains() {
    let text = chains(&remarks(&[&IDENTITY, &TURN]));
    let scene = assembled("t.pdb", &text, "1").unwrap().scene;
    assert_eq!(scene.parts[0].objects.len(), 3);
    assert_eq!(scene.instances.len(), 2);
}

#[test]
fn flattening_leaves_no_instances() {
    let text = chains(&remarks(&[&IDENTITY, &TURN]));
    let options = ImportOptions {
        assembly: Some(String::from("1")),
        instances: Instances::Flatten,
        ..ImportOptions::default()
    };
    let scene = crate::scene::read(Path::new("t.pdb"), text.into(), &options);
    let scene = scene.unwrap().scene;
    assert_eq!((scene.objects.len(), scene.instances.len()), (6, 0));
}

#[test]
fn faults_of_remarks_name_line_cause_and_remedy() {
    let head = ["BIOMOLECULE: 1", "APPLY THE FOLLOWING TO CHAINS: A"];
    let with = |rows: &[&str]| chains(&remarks(&[&head, rows]));
    let mirror = [
        "  BIOMT1   2 -1.000000  0.000000  0.000000        0.00000",
        "  BIOMT2   2  0.000000  1.000000  0.000000        0.00000",
        "  BIOMT3   2  0.000000  0.000000  1.000000        0.00000",
    ];
    let scaled = [
        "  BIOMT1   2  1.100000  0.000000  0.000000        0.00000",
        "  BIOMT2   2  0.000000  1.100000  0.000000        0.00000",
        "  BIOMT3   2  0.000000  0.000000  1.100000        0.00000",
    ];
    let wordy = [
        "  BIOMT1   2  1.000000  zero      0.000000        0.00000",
        "  BIOMT2   2  0.000000  1.000000  0.000000        0.00000",
        "  BIOMT3   2  0.000000  0.000000  1.000000        0.00000",
    ];
    for (text, wanted, line, cause, remedy) in [
        (
            with(&IDENTITY),
            "3",
            None,
            "there is no assembly \"3\"",
            "choose one of 1",
        ),
        (
            chains(&[]),
            "1",
            None,
            "the file states none",
            "leave `--assembly` out",
        ),
        (
            with(&IDENTITY[..2]),
            "1",
            Some(3),
            "operator 1 lacks some",
            "complete",
        ),
        (
            with(&mirror),
            "1",
            Some(3),
            "operator 2 mirrors the molecule",
            "repair",
        ),
        (
            with(&scaled),
            "1",
            Some(3),
            "operator 2 is no rotation",
            "repair",
        ),
        (
            with(&wordy),
            "1",
            Some(3),
            "a number of operator 2 is \"zero\"",
            "decimal",
        ),
        (
            with(&[]),
            "1",
            None,
            "assembly 1 places no atoms",
            "leave `--assembly` out",
        ),
    ] {
        let error = assembled("t.pdb", &text, wanted).unwrap_err();
        assert_eq!(error.line, line, "{error}\n{text}");
        assert!(error.cause.contains(cause), "{error}\n{text}");
        assert!(error.remedy.contains(remedy), "{}", error.remedy);
        // No option selects the assembly, so nothing is wrong.
        assert!(pdb(&text).is_ok());
    }
}

#[test]
fn operators_of_one_name_are_rejected_with_both_lines() {
    let head = ["BIOMOLECULE: 1", "APPLY THE FOLLOWING TO CHAINS: A"];
    let text = chains(&remarks(&[&head, &IDENTITY, &TURN, &TURN]));
    let error = assembled("t.pdb", &text, "1").unwrap_err();
    let cause = "two operators have the name 2; the first is in line 6";
    assert_eq!((error.cause.as_str(), error.line), (cause, Some(9)));
    assert!(pdb(&text).is_ok());
    // Groups have numbers of their own.
    let second = ["APPLY THE FOLLOWING TO CHAINS: B"];
    let text = chains(&remarks(&[
        &head, &IDENTITY, &TURN, &second, &IDENTITY, &TURN,
    ]));
    assert!(assembled("t.pdb", &text, "1").is_ok());

    let text = cif_of(&[["1", "1", "A"], ["2", "2", "A"]]);
    let row = "2 0 -1 0 0 1 0 0 0 0 0 1 0\n";
    let line = text[..text.find(row).unwrap()].lines().count() + 1;
    let doubled = text.replace(row, &format!("{row}{}", row.replace("1 0\n", "1 9\n")));
    let error = assembled("t.cif", &doubled, "2").unwrap_err();
    let cause = format!("two operators have the name 2; the first is in line {line}");
    assert_eq!((error.cause, error.line), (cause, Some(line + 1)));
    // Nothing is wrong where no assembly uses it, or both are the same.
    assert!(assembled("t.cif", &doubled, "1").is_ok() && cif(&doubled).is_ok());
    let same = text.replace(row, &format!("{row}{row}"));
    assert!(assembled("t.cif", &same, "2").is_ok());
}

#[test]
fn chain_without_atoms_is_worth_a_warning() {
    let text = chains(&remarks(&[
        &["APPLY THE FOLLOWING TO CHAINS: A, X, Y"],
        &IDENTITY,
    ]));
    let imported = assembled("t.pdb", &text, "1").unwrap();
    assert_eq!(
        imported.warnings,
        ["t.pdb:1: the assembly names 2 chains without atoms, such as \"X\""]
    );
}

/// Atoms of the chains A and B (by their authors X and X), and the operators 1 to 5 and P. Operators 1 to 5 are turns
/// about z by 0, 90, 180 and 270 degrees, and a step along z. P is a step along x.
pub(super) fn cif_of(groups: &[[&str; 3]]) -> String {
    let mut text = String::from(
        "data_t\nloop_\n_pdbx_struct_assembly_gen.assembly_id\n\
         _pdbx_struct_assembly_gen.oper_expression\n_pdbx_struct_assembly_gen.asym_id_list\n",
    );
    for [assembly, expression, chains] in groups {
        text.push_str(&format!("{assembly} '{expression}' {chains}\n"));
    }
    text.push_str("loop_\n_pdbx_struct_oper_list.id\n");
    for row in 1..=3 {
        for column in 1..=3 {
            text.push_str(&format!("_pdbx_struct_oper_list.matrix[{row}][{column}]\n"));
        }
        text.push_str(&format!("_pdbx_struct_oper_list.vector[{row}]\n"));
    }
    text.push_str(
        "1 1 0 0 0 0 1 0 0 0 0 1 0\n2 0 -1 0 0 1 0 0 0 0 0 1 0\n3 -1 0 0 0 0 -1 0 0 0 0 1 0\n\
         4 0 1 0 0 -1 0 0 0 0 0 1 0\n5 1 0 0 0 0 1 0 0 0 0 1 7\nP 1 0 0 50 0 1 0 0 0 0 1 0\n\
         loop_\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n\
         _atom_site.label_asym_id\n_atom_site.auth_asym_id\n\
         _atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n\
         1 C CA A X 1 0 0\n2 O O B X 2.2 0 0\n",
    );
    text
}

/// Returns where the first atom of chain A stands in an assembly with this expression.
fn places(expression: &str) -> Vec<DVec3> {
    let text = cif_of(&[["1", expression, "A"]]);
    let scene = assembled("t.cif", &text, "1").unwrap().scene;
    let place = |it: &crate::scene::Instance| it.placement.point(DVec3::X);
    scene.instances.iter().map(place).collect()
}

#[test]
fn expressions_are_lists_and_products() {
    let [x, y] = [DVec3::X, DVec3::Y];
    let far = DVec3::new(50.0, 0.0, 0.0);
    let up = DVec3::new(0.0, 0.0, 7.0);
    for (expression, expected) in [
        ("1,2", vec![x, y]),
        ("(1-4)", vec![x, y, -x, -y]),
        ("(1,3-4)", vec![x, -x, -y]),
        ("P", vec![far + x]),
        ("(1,2)(5)", vec![x + up, y + up]),
        // The rightmost is first: a step along x that is then turned.
        ("(2)(P)", vec![DVec3::new(0.0, 51.0, 0.0)]),
        ("(P)(2)", vec![far + y]),
        ("P(1-2)", vec![far + x, far + y]),
        (
            " ( 1 , 2 ) ( P,5 ) ",
            vec![far + x, x + up, DVec3::new(0.0, 51.0, 0.0), y + up],
        ),
    ] {
        assert_eq!(places(expression), expected, "{expression}");
    }
}

#[test]
fn chains_are_those_of_the_archive() {
    let text = cif_of(&[
        ["1", "1,2", "B"],
        ["PAU", "1", "A"],
        ["PAU", "2", "A"],
        ["PAU", "1,2", "B"],
    ]);
    let scene = assembled("t.cif", &text, "1").unwrap().scene;
    assert_eq!(scene.parts[0].name, "chain B");
    assert_eq!(scene.parts[0].objects[0].name, "X/O");
    // Chains that the same operators copy are one part.
    let scene = assembled("t.cif", &text, "PAU").unwrap().scene;
    assert_eq!((scene.parts.len(), scene.instances.len()), (1, 2));
    assert_eq!(scene.parts[0].name, "chains A B");
    let error = assembled("t.cif", &text, "2").unwrap_err();
    assert_eq!(error.remedy, "choose one of 1, PAU");
}

#[test]
fn faults_of_expressions_name_line_cause_and_remedy() {
    for (expression, cause) in [
        ("", "are empty"),
        ("9", "there is no operator \"9\""),
        ("(1-6)", "there is no operator \"6\""),
        ("(4-1)", "no range of numbers"),
        ("(1-", "not closed"),
        ("((1)(2)", "inside of each other"),
        ("(1)(2))", "one too many"),
        ("1,,2", "empty place"),
        ("()", "empty place"),
        (&"(1)".repeat(17), "more than 16 factors"),
        ("(1-4000000000)", "more than 65535 operators"),
        (
            "(1-4)(1-4)(1-4)(1-4)(1-4)(1-4)(1-4)(1-4)",
            "more than 65535 operators",
        ),
    ] {
        let text = cif_of(&[["1", expression, "A"]]);
        let error = assembled("t.cif", &text, "1").unwrap_err();
        assert_eq!(error.line, Some(6), "{error}");
        assert!(error.cause.contains(cause), "{error}");
        assert!(!error.remedy.is_empty());
        assert!(cif(&text).is_ok());
    }
}

#[test]
fn groups_are_counted_together() {
    let groups = [["1", "(1-4)(1-4)(1-4)(1-4)(1-4)(1-4)(1-4)", "A"]; 4];
    let text = cif_of(&groups);
    let error = assembled("t.cif", &text, "1").unwrap_err();
    assert_eq!(error.line, Some(9));
    let text = cif_of(&groups[..3]);
    let scene = assembled("t.cif", &text, "1").unwrap().scene;
    assert_eq!((scene.parts.len(), scene.instances.len()), (1, 3 << 14));
}

#[test]
fn balls_and_sticks_are_copied_with_their_bonds() {
    let text = cif_of(&[["1", "1,2", "A,B"], ["2", "1,2", "A"], ["2", "1,3", "B"]]);
    let options = |wanted: &str| ImportOptions {
        molecule: MoleculeOptions {
            style: MoleculeStyle::BallAndStick,
            ..MoleculeOptions::default()
        },
        assembly: Some(wanted.to_owned()),
        ..ImportOptions::default()
    };
    let read = |wanted: &str| {
        let read = crate::scene::read(Path::new("t.cif"), text.clone().into(), &options(wanted));
        read.unwrap().scene
    };
    let together = read("1");
    let kinds: Vec<_> = together.parts[0]
        .objects
        .iter()
        .map(|it| it.shape.kind())
        .collect();
    assert_eq!(kinds, ["sphere", "sphere", "cylinder", "cylinder"]);
    // No bond joins atoms that are copied apart.
    let apart = read("2");
    let counts: Vec<_> = apart.parts.iter().map(|it| it.objects.len()).collect();
    assert_eq!(counts, [1, 1]);
    let material = &apart.materials[apart.parts[1].objects[0].material];
    assert_eq!(material.name, "O");
}

#[test]
fn capsid_has_sixty_instances() {
    let Some(path) = crate::scene::tests::samples::find("molecules/2buk.pdb") else {
        return;
    };
    let options = ImportOptions {
        assembly: Some(String::from("1")),
        ..ImportOptions::default()
    };
    let scene = crate::scene::load_with(&path, &options).unwrap().scene;
    assert_eq!((scene.parts.len(), scene.instances.len()), (1, 60));
    // An icosahedron: all copies are as far from the middle.
    let objects = &scene.parts[0].objects;
    let own: DVec3 = objects.iter().filter_map(|it| it.shape.middle()).sum();
    let own = own / objects.len() as f64;
    let places: Vec<_> = scene
        .instances
        .iter()
        .map(|it| it.placement.point(own))
        .collect();
    let middle = places.iter().sum::<DVec3>() / 60.0;
    for place in places {
        assert!(((place - middle).length() / (own - middle).length() - 1.0).abs() < 1e-3);
    }
}

#[test]
fn damaged_assemblies_are_read_or_rejected_with_a_remedy() {
    let head = ["BIOMOLECULE: 1", "APPLY THE FOLLOWING TO CHAINS: A, B"];
    let pdb = chains(&remarks(&[&head, &IDENTITY, &TURN]));
    let cif = cif_of(&[["1", "(1-3)(P,5)", "A,B"], ["2", "1", "A"]]);
    let random = &mut crate::random::Random(6);
    for (file, text) in [("t.pdb", pdb), ("t.cif", cif)] {
        let check = |bytes: &[u8]| {
            let text = String::from_utf8_lossy(bytes);
            match assembled(file, &text, "1") {
                Ok(imported) => {
                    let scene = imported.scene;
                    assert!(scene.instances.iter().all(|it| it.placement.is_valid()));
                    assert!(scene.flattened().is_ok(), "{text}");
                }
                Err(error) => assert!(!error.cause.is_empty() && !error.remedy.is_empty()),
            }
        };
        let bytes = text.as_bytes();
        (0..bytes.len()).for_each(|end| check(&bytes[..end]));
        for _ in 0..2000 {
            let mut bytes = bytes.to_vec();
            let at = random.below(bytes.len());
            bytes[at] = b"0123456789-.,() \nABPe;'"[random.below(23)];
            check(&bytes);
        }
    }
}
