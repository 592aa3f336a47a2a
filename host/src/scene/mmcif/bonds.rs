//! The table of bonds beyond those that distances imply.

use super::table::{Column, Table};
use crate::scene::molecule::{Bond, End};

/// Columns of `struct_conn`.
pub(super) struct BondColumns {
    kind: Column,
    symmetry: [Column; 2],
    ends: [EndColumns; 2],
}

struct EndColumns {
    /// Chain and number of the residue by its author, and by the archive.
    author: [Column; 2],
    archive: [Column; 2],
    insertion: Column,
    name: [Column; 2],
    altloc: Column,
}

impl BondColumns {
    pub(super) fn of(table: &Table<'_>) -> Self {
        let end = |n: usize| {
            let column = |name: &str| table.column(&format!("ptnr{n}_{name}"));
            EndColumns {
                author: [column("auth_asym_id"), column("auth_seq_id")],
                archive: [column("label_asym_id"), column("label_seq_id")],
                insertion: table.column(&format!("pdbx_ptnr{n}_PDB_ins_code")),
                name: [column("label_atom_id"), column("auth_atom_id")],
                altloc: table.column(&format!("pdbx_ptnr{n}_label_alt_id")),
            }
        };
        Self {
            kind: table.column("conn_type_id"),
            symmetry: ["ptnr1_symmetry", "ptnr2_symmetry"].map(|name| table.column(name)),
            ends: [end(1), end(2)],
        }
    }

    /// Returns the bond of a row, if it is one that is drawn.
    pub(super) fn read<'a>(&self, table: &Table<'a>) -> Option<Bond<'a>> {
        // Hydrogen bonds do not count, and a partner that symmetry moves is not where its atom is.
        let kind = table.value([self.kind]);
        let is_bond = ["covale", "disulf", "metalc"].iter().any(|bond| {
            kind.get(..bond.len())
                .is_some_and(|start| start.eq_ignore_ascii_case(bond))
        });
        let [first, second] = self.symmetry.map(|column| table.value([column]));
        (is_bond && first == second).then(|| Bond {
            record: "struct_conn",
            line: table.line,
            ends: self.ends.each_ref().map(|end| end.read(table)),
        })
    }
}

impl EndColumns {
    /// The author's names distinguish waters, too; but a row can lack them, and its other names count only together.
    fn read<'a>(&self, table: &Table<'a>) -> End<'a> {
        let [author, archive] =
            [self.author, self.archive].map(|it| it.map(|column| table.value([column])));
        let (name, altloc) = (table.value(self.name), table.value([self.altloc]));
        if author.contains(&"") && !archive[0].is_empty() {
            let [chain, number] = archive;
            return End::Label([chain, number, name, altloc]);
        }
        let [chain, number] = author;
        End::Name([chain, number, table.value([self.insertion]), name, altloc])
    }
}
