//! Files that fit into no memory.

use super::super::limit::check_size;
use super::super::parsed::Left;
use super::*;

/// The number of atoms, bonds, groups and operators that are read from a file where so much memory is left, or the
/// error.
fn parse_with(file: &str, text: &str, left: usize) -> Result<[usize; 4], String> {
    let source = Source::from_bytes(Path::new(file), text.into());
    let mut warnings = Warnings::default();
    let parsed = Parsed {
        left: Left(left),
        ..Parsed::default()
    };
    let parse = match file.ends_with("cif") {
        true => crate::scene::mmcif::parse_into,
        false => crate::scene::pdb::parse_into,
    };
    let parsed = parse(&source, parsed, &mut warnings).map_err(|it| it.to_string())?;
    Ok([
        parsed.atoms.len(),
        parsed.bonds.len(),
        parsed.groups.len(),
        parsed.operators.len(),
    ])
}

#[test]
fn bonds_and_assemblies_are_limited_as_atoms_are() {
    let atom = CYSTEINE.lines().next().unwrap();
    let bonds = format!(
        "{atom}\n{}",
        "CONECT    1    2    3    4    5\n".repeat(100)
    );
    let remarks = format!(
        "{atom}\n{}",
        "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A, B\nREMARK 350   BIOMT1   1  1 0 0 0\n"
            .repeat(100)
    );
    let groups = format!(
        "data_t\nloop_\n_pdbx_struct_assembly_gen.assembly_id\n_pdbx_struct_assembly_gen.oper_expression\n\
         _pdbx_struct_assembly_gen.asym_id_list\n{}",
        "1 1 A,B\n".repeat(100)
    );
    let operators: String = (0..100).map(|it| format!("{it}\n")).collect();
    let operators = format!("data_t\nloop_\n_pdbx_struct_oper_list.id\n{operators}");
    let models = "MODEL\n".to_owned() + atom + "\n";
    for (file, text, found, line) in [
        ("t.pdb", &bonds, [1, 400, 0, 0], "bonds"),
        ("t.pdb", &remarks, [1, 0, 100, 0], "assembly groups"),
        ("t.pdb", &models.repeat(100), [100, 0, 0, 0], "models"),
        ("t.cif", &groups, [0, 0, 100, 0], "assembly groups"),
        ("t.cif", &operators, [0, 0, 0, 100], "operators"),
    ] {
        assert_eq!(parse_with(file, text, 1 << 20), Ok(found), "{line}");
        let error = parse_with(file, text, 10_000).unwrap_err();
        assert!(
            error.contains(": the file lists more than fits into memory; before this line come")
                && error.contains(line),
            "{error}"
        );
    }
    // The names of one row are limited, too.
    let chains = groups.replacen("1 1 A,B", &format!("1 1 {}", "A,".repeat(1000)), 1);
    let error = parse_with("t.cif", &chains, 10_000).unwrap_err();
    assert_eq!(error, "t.cif:6: the file lists more than fits into memory");
}

#[test]
fn tables_of_too_many_columns_and_of_equal_ones_are_rejected() {
    let columns: String = (0..10_001)
        .map(|number| format!("_a.b{number}\n"))
        .collect();
    let text = format!("data_t\nloop_\n{columns}1\n");
    assert_eq!(
        cif(&text).unwrap_err().to_string(),
        "t.cif:10003: a table has more than 10,000 columns"
    );
    let twice = "data_t\nloop_\n_atom_site.id\n_atom_site.Cartn_x\n_Atom_site.cartn_X\n1 2 3\n";
    assert_eq!(
        cif(twice).unwrap_err().to_string(),
        "t.cif:5: a loop has the column _Atom_site.cartn_X twice"
    );
}

#[test]
fn molecules_too_large_name_their_atoms_or_their_bonds() {
    let source = Source::from_bytes(Path::new("t.pdb"), Vec::new());
    let error = |atoms, bonds| check_size(&source, atoms, bonds).unwrap_err();
    assert!(check_size(&source, 7_000_000, 200_000).is_ok());
    let alone = error(7_500_000, 0);
    assert!(
        alone.cause.starts_with("7,500,000 atoms take about 3.8 GB"),
        "{alone}"
    );
    assert!(!alone.remedy.contains("space-filling"), "{}", alone.remedy);
    assert!(!error(7_500_000, 9).cause.contains("bonds"));
    let crowded = error(1_000_000, 9_000_000);
    let begins = "9,000,000 bonds of 1,000,000 atoms take about 9.7 GB";
    assert!(crowded.cause.starts_with(begins), "{crowded}");
    assert!(crowded.remedy.contains("space-filling"));
}
