mod assembly;
mod generated;
mod limits;
mod locations;
mod names;
mod real;
mod stated;

use super::*;
use crate::scene::{ImportOptions, MoleculeOptions, Shape};
use crate::shape::{Cone, Sphere};
use glam::DVec3;
use std::path::Path;

fn read(file: &str, text: &str, options: &MoleculeOptions) -> Result<Imported, SceneError> {
    let options = ImportOptions {
        molecule: *options,
        ..ImportOptions::default()
    };
    crate::scene::read(Path::new(file), text.into(), &options)
}

fn pdb(text: &str) -> Result<Imported, SceneError> {
    read("t.pdb", text, &MoleculeOptions::default())
}

fn cif(text: &str) -> Result<Imported, SceneError> {
    read("t.cif", text, &MoleculeOptions::default())
}

fn names(imported: &Imported) -> Vec<&str> {
    imported
        .scene
        .objects
        .iter()
        .map(|object| object.name.as_str())
        .collect()
}

/// The symbol of each atom's element.
fn symbols(imported: &Imported) -> Vec<&str> {
    imported
        .scene
        .objects
        .iter()
        .map(|object| imported.scene.materials[object.material].name.as_str())
        .collect()
}

const CYSTEINE: &str = "\
ATOM      1  N   CYS A   3      11.000   2.000   3.000  1.00  0.00           N
ATOM      2  CA ACYS A   3      12.400   2.000   3.000  0.50  0.00           C
ATOM      3  CA BCYS A   3      12.500   2.000   3.000  0.50  0.00           C
HETATM    4 FE   HEM B  10A     -1.000  20.000-300.000  1.00  0.00          FE3+
";

#[test]
fn pdb_columns_give_names_elements_and_places() {
    let imported = pdb(CYSTEINE).unwrap();
    assert_eq!(
        names(&imported),
        ["A/CYS 3/N", "A/CYS 3/CA", "B/HEM 10A/FE"]
    );
    assert_eq!(symbols(&imported), ["N", "C", "Fe"]);
    assert_eq!(imported.warnings, [] as [&str; 0]);
    let iron = &imported.scene.objects[2];
    assert_eq!(iron.place.line, 4);
    assert_eq!(
        iron.shape,
        Shape::Sphere(Sphere {
            center: DVec3::new(-1.0, 20.0, -300.0),
            radius: 2.44
        })
    );
    assert!(imported.scene.camera.is_none() && imported.scene.lights.is_empty());
}

#[test]
fn altloc_chooses_one_of_the_alternate_locations() {
    let with = |altloc| {
        read(
            "t.pdb",
            CYSTEINE,
            &MoleculeOptions {
                altloc,
                ..MoleculeOptions::default()
            },
        )
    };
    let carbon = |altloc| match with(altloc).unwrap().scene.objects[1].shape {
        Shape::Sphere(Sphere { center, .. }) => center.x,
        _ => f64::NAN,
    };
    assert_eq!(
        (carbon(None), carbon(Some('A')), carbon(Some('B'))),
        (12.4, 12.4, 12.5)
    );
    let error = with(Some('C')).unwrap_err();
    assert_eq!(
        error.to_string(),
        "t.pdb: model 1 has no alternate location C"
    );
    assert_eq!(error.remedy, "choose one of A, B");
}

#[test]
fn model_is_chosen_by_its_place_in_the_file() {
    let atom = |x: f64| format!("ATOM      1  C   UNK A   1    {x:8.3}   0.000   0.000\n");
    let text = format!(
        "MODEL 7\n{}ENDMDL\nMODEL 9\n{}MODEL 9\n{}ENDMDL\n{}END\n",
        atom(1.0),
        atom(2.0),
        atom(3.0),
        atom(4.0)
    );
    for model in 1..=4 {
        let scene = read(
            "t.pdb",
            &text,
            &MoleculeOptions {
                model,
                ..MoleculeOptions::default()
            },
        )
        .unwrap()
        .scene;
        assert_eq!(scene.objects.len(), 1);
        let Shape::Sphere(Sphere { center, .. }) = scene.objects[0].shape else {
            panic!()
        };
        assert_eq!(center.x, model as f64);
    }
    for model in [0, 5] {
        let error = read(
            "t.pdb",
            &text,
            &MoleculeOptions {
                model,
                ..MoleculeOptions::default()
            },
        )
        .unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("t.pdb: there is no model {model}, since the file has 4")
        );
        assert!(
            error
                .remedy
                .ends_with("numbers them 7, 9, 9, without a number)"),
            "{}",
            error.remedy
        );
    }
}

#[test]
fn pdb_names_give_elements() {
    let symbol = |record: &str, name: &str| {
        let text = format!("{record:<6}    1 {name} UNK A   1       0.000   0.000   0.000\n");
        symbols(&pdb(&text).unwrap())[0].to_owned()
    };
    let expected = [
        ("ATOM", " CA ", "C"),
        ("ATOM", "CA  ", "C"),
        ("HETATM", "CA  ", "Ca"),
        ("HETATM", "CAA ", "C"),
        ("HETATM", " CAA", "C"),
        ("ATOM", "HG11", "H"),
        ("ATOM", "1HB ", "H"),
        ("ATOM", "Xe  ", "Xe"),
        ("ATOM", "Na  ", "Na"),
        ("HETATM", "CL1 ", "Cl"),
        ("ATOM", " OH2", "O"),
        ("HETATM", "FE  ", "Fe"),
        ("ATOM", " Q1 ", "X"),
    ];
    for (record, name, element) in expected {
        assert_eq!(symbol(record, name), element, "{record} {name}");
    }
}

#[test]
fn element_columns_that_are_filled_rule_out_the_name() {
    let read = |name: &str, end: &str| {
        let text =
            format!("HETATM    1 {name} UNX A   1       0.000   0.000   0.000  1.00  0.00{end}\n");
        let imported = pdb(&text).unwrap();
        (symbols(&imported)[0].to_owned(), imported.warnings)
    };
    let unknown = "t.pdb:1: the element of the atom \"UNK\" is unknown; it is drawn in pink";
    for end in [
        "           X",
        "          X ",
        "           X1+",
        "          XX",
    ] {
        let expected = (String::from("X"), vec![String::from(unknown)]);
        assert_eq!(read(" UNK", end), expected, "{end:?}");
        assert_eq!(read("UNK ", end), expected, "{end:?}");
        assert_eq!(read(" CA ", end).0, "X", "{end:?}");
    }
    assert_eq!(read(" UNK", "").0, "X");
    // Line numbers of old files, long names of segments, charges alone.
    for end in ["      1ABC1042", "      PROTEINX", "            1+", ""] {
        assert_eq!(read(" CA ", end), (String::from("C"), vec![]), "{end:?}");
    }
    assert_eq!(read(" UNK", "          FE2+").0, "Fe");
}

#[test]
fn pdb_faults_name_line_and_cause() {
    let fault = |text: &str| pdb(text).unwrap_err().to_string();
    assert_eq!(fault(""), "t.pdb: the file has no atoms");
    assert_eq!(
        fault("REMARK\nATOM\n"),
        "t.pdb:2: the line ends before the x coordinate of its atom does"
    );
    let line = CYSTEINE.lines().next().unwrap();
    assert_eq!(
        fault(&line[..53]),
        "t.pdb:1: the line ends before the z coordinate of its atom does"
    );
    assert_eq!(
        fault(&line.replace("  2.000", "  2.0x0")),
        "t.pdb:1: the y coordinate (columns 39 to 46) is \"2.0x0\", which is not a number"
    );
    assert_eq!(
        fault(&line.replace("  2.000", "    nan")),
        "t.pdb:1: the y coordinate (columns 39 to 46) is \"nan\", which is not a finite number"
    );
}

#[test]
fn bonds_are_stated_or_perceived() {
    let text =
        format!("{CYSTEINE}CONECT    1    2    4\nCONECT    2    1\nCONECT    1   99    3\n");
    let options = MoleculeOptions {
        style: MoleculeStyle::BallAndStick,
        ..MoleculeOptions::default()
    };
    let imported = read("t.pdb", &text, &options).unwrap();
    assert_eq!(
        names(&imported)[3..],
        [
            "A/CYS 3/N to A/CYS 3/CA",
            "A/CYS 3/CA to A/CYS 3/N",
            "A/CYS 3/N to B/HEM 10A/FE",
            "B/HEM 10A/FE to A/CYS 3/N"
        ]
    );
    assert_eq!(symbols(&imported)[3..], ["N", "C", "N", "Fe"]);
    let Shape::Cone(Cone {
        base,
        apex,
        base_radius,
        apex_radius,
    }) = imported.scene.objects[4].shape
    else {
        panic!()
    };
    assert_eq!((base, apex.x), (DVec3::new(12.4, 2.0, 3.0), 11.7));
    assert_eq!(base_radius, apex_radius);
}

const ATOM_SITE: &str = "\
data_t
loop_
_atom_site.group_PDB
_atom_site.id
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_alt_id
_atom_site.label_comp_id
_atom_site.label_asym_id
_atom_site.auth_asym_id
_atom_site.auth_seq_id
_atom_site.pdbx_PDB_ins_code
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
_atom_site.pdbx_PDB_model_num
ATOM 1 C \"C1'\" . A A X 001 ? 1.5 2 3e0 1
HETATM 2 FE FE . HEM B Y 7 A -1.25(3) 0 .5 1
ATOM 3 C 1E5 . A A X 1 ? 0 0 0 2
";

#[test]
fn mmcif_atoms_take_the_numbers_of_the_author() {
    let imported = cif(ATOM_SITE).unwrap();
    assert_eq!(names(&imported), ["X/A 001/C1'", "Y/HEM 7A/FE"]);
    assert_eq!(symbols(&imported), ["C", "Fe"]);
    let Shape::Sphere(Sphere { center, .. }) = imported.scene.objects[1].shape else {
        panic!()
    };
    assert_eq!(center, DVec3::new(-1.25, 0.0, 0.5));
    assert_eq!(imported.scene.objects[1].place.line, 18);
    let second = MoleculeOptions {
        model: 2,
        ..MoleculeOptions::default()
    };
    assert_eq!(
        names(&read("t.cif", ATOM_SITE, &second).unwrap()),
        ["X/A 1/1E5"]
    );
}

#[test]
fn mmcif_without_a_loop_gives_one_atom() {
    let text = "data_x\n_cell.length_a 1\n_atom_site.type_symbol C\n_atom_site.Cartn_x 1\n_atom_site.Cartn_y 2\n\
                _atom_site.Cartn_z 3\n_atom_site.label_atom_id CA\n_exptl.method X\n";
    let imported = cif(text).unwrap();
    assert_eq!(
        (names(&imported), imported.scene.objects[0].place.line),
        (vec!["CA"], 3)
    );
}

#[test]
fn mmcif_bonds_are_read_except_to_hydrogens_and_copies() {
    let text = format!(
        "{ATOM_SITE}loop_\n_struct_conn.conn_type_id\n_struct_conn.ptnr1_auth_asym_id\n\
         _struct_conn.ptnr1_auth_seq_id\n_struct_conn.ptnr1_label_atom_id\n_struct_conn.ptnr2_auth_asym_id\n\
         _struct_conn.ptnr2_auth_seq_id\n_struct_conn.pdbx_ptnr2_PDB_ins_code\n_struct_conn.ptnr2_label_atom_id\n\
         _struct_conn.ptnr1_symmetry\n_struct_conn.ptnr2_symmetry\n\
         metalc X 001 \"C1'\" Y 7 A FE 1_555 1_555\n"
    );
    let options = MoleculeOptions {
        style: MoleculeStyle::BallAndStick,
        ..MoleculeOptions::default()
    };
    let count = |text: &str| read("t.cif", text, &options).unwrap().scene.objects.len();
    assert_eq!(count(&text), 4);
    assert_eq!(count(&text.replace("metalc X", "hydrog X")), 2);
    assert_eq!(count(&text.replace("1_555 1_555", "1_555 2_655")), 2);
}

/// The nitrogen of a histidine binds zinc at one of its two alternate locations, and a sulfur whose location is open.
#[test]
fn mmcif_bonds_name_their_alternate_location() {
    let atoms = ATOM_SITE.split("ATOM 1").next().unwrap();
    let text = format!(
        "{atoms}HETATM 1 ZN ZN . ZN B Y 7 ? 0 0 0 1\nATOM 2 N NE2 A HIS A X 1 ? 10 0 0 1\n\
         ATOM 3 N NE2 B HIS A X 1 ? 2 0 0 1\nATOM 4 S SG A CYS A X 2 ? 0 6 0 1\nloop_\n\
         _struct_conn.conn_type_id\n_struct_conn.ptnr1_auth_asym_id\n_struct_conn.ptnr1_auth_seq_id\n\
         _struct_conn.ptnr1_label_atom_id\n_struct_conn.pdbx_ptnr1_label_alt_id\n\
         _struct_conn.ptnr2_auth_asym_id\n_struct_conn.ptnr2_auth_seq_id\n_struct_conn.ptnr2_label_atom_id\n\
         _struct_conn.pdbx_ptnr2_label_alt_id\nmetalc X 1 NE2 B Y 7 ZN ?\nmetalc Y 7 ZN . X 2 SG .\n"
    );
    let sticks = |text: &str, altloc| {
        let options = MoleculeOptions {
            style: MoleculeStyle::BallAndStick,
            altloc,
            ..MoleculeOptions::default()
        };
        let imported = read("t.cif", text, &options).unwrap();
        let sticks = names(&imported).into_iter().map(String::from);
        (
            sticks.filter(|it| it.contains(" to ")).collect::<Vec<_>>(),
            imported.warnings,
        )
    };
    let sulfur = ["Y/ZN 7/ZN to X/CYS 2/SG", "X/CYS 2/SG to Y/ZN 7/ZN"];
    let nitrogen = ["Y/ZN 7/ZN to X/HIS 1/NE2", "X/HIS 1/NE2 to Y/ZN 7/ZN"];
    assert_eq!(
        sticks(&text, None),
        (sulfur.map(String::from).to_vec(), vec![])
    );
    let both = [nitrogen, sulfur].concat();
    assert_eq!(sticks(&text, Some('B')).0, both);
    let missing = text.replace("NE2 B Y 7", "NE2 C Y 7");
    assert_eq!(
        sticks(&missing, None).1,
        [
            "t.cif:31: struct_conn names the atom X/1/NE2 at the alternate location C, which the file lacks; the bond is left out"
        ]
    );
}

#[test]
fn mmcif_faults_name_line_and_cause() {
    let fault = |text: &str| cif(text).unwrap_err().to_string();
    assert_eq!(fault("data_x\n"), "t.cif: the file has no atoms");
    assert_eq!(
        fault(&ATOM_SITE.replace(" 3e0 1", " 3x0 1")),
        "t.cif:17: Cartn_z is \"3x0\", which is not a number"
    );
    assert_eq!(
        fault(&ATOM_SITE.replace("1.5 2 3e0", "? 2 3")),
        "t.cif:17: an atom has no Cartn_x"
    );
    assert_eq!(
        fault(ATOM_SITE.trim_end_matches(" 0 2\n")),
        "t.cif:19: a row of _atom_site has 12 of 14 values"
    );
    assert_eq!(
        fault("data_x\n_cell.a\n"),
        "t.cif:2: the item _cell.a has no value"
    );
    assert_eq!(
        fault("data_x\nloop_\n_atom_site_label\n_atom_site_fract_x\nC1 0.5\n"),
        "t.cif: the atoms have no Cartesian coordinates, as in CIF files of small molecules"
    );
    for (tag, category) in [
        ("_atom_site_Cartn_x", "_atom_site_Cartn_x"),
        (
            "_chem_comp_atom.pdbx_model_Cartn_x_ideal",
            "_chem_comp_atom",
        ),
    ] {
        let error = cif(&format!("data_x\nloop_\n{tag}\n0.5\n")).unwrap_err();
        let cause = format!("the atoms stand in {category},");
        assert!(error.cause.starts_with(&cause), "{error}");
    }
}

#[test]
fn frames_that_end_alone_separates_are_models() {
    let atom = |x: f64| format!("ATOM      1  C   UNK A   1    {x:8.3}   0.000   0.000\n");
    let text: String = (1..=100).map(|x| atom(f64::from(x)) + "END\n").collect();
    for model in [1, 100] {
        let options = MoleculeOptions {
            model,
            ..MoleculeOptions::default()
        };
        let imported = read("t.pdb", &text, &options).unwrap();
        assert_eq!(imported.scene.objects.len(), 1);
        let Shape::Sphere(Sphere { center, .. }) = imported.scene.objects[0].shape else {
            panic!()
        };
        assert_eq!(center.x, model as f64);
        let line = if model == 1 { 3 } else { 1 };
        assert_eq!(
            imported.warnings,
            [format!(
                "t.pdb:{line}: the file has 100 models, of which model {model} is drawn; `--model N` \
                 chooses another"
            )]
        );
    }
}

#[test]
fn bonds_to_atoms_that_the_file_lacks_are_warned_of() {
    let atoms = "ATOM      1  C   UNK A   1       1.000   0.000   0.000\n\
                 ATOM      2  C   UNK A   1       2.500   0.000   0.000\n";
    for (connections, expected) in [
        ("CONECT    1    2\n", &[][..]),
        (
            "CONECT    1    2\nCONECT    1    9    8\nCONECT    7    1\n",
            &[
                "t.pdb:4: CONECT names the atom 9, which the file lacks; the bond is left out (and 2 times more)",
            ],
        ),
    ] {
        let text = format!("{atoms}{connections}");
        let imported = read("t.pdb", &text, &MoleculeOptions::default()).unwrap();
        assert_eq!(imported.warnings, expected);
    }
}
