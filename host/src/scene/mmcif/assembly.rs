//! The tables of assemblies.

use super::table::{Column, Table};
use crate::scene::molecule::{Group, Matrix, Operators};

/// Columns of `pdbx_struct_assembly_gen`.
pub(super) struct GroupColumns {
    assembly: Column,
    expression: Column,
    chains: Column,
}

impl GroupColumns {
    pub(super) fn of(table: &Table<'_>) -> Self {
        Self {
            assembly: table.column("assembly_id"),
            expression: table.column("oper_expression"),
            chains: table.column("asym_id_list"),
        }
    }

    /// Returns how many chains a row names, or a few more.
    pub(super) fn count_of_chains(&self, table: &Table<'_>) -> usize {
        1 + table.value([self.chains]).matches(',').count()
    }

    pub(super) fn read<'a>(&self, table: &Table<'a>) -> Group<'a> {
        let chains = table.value([self.chains]).split(',').map(str::trim);
        Group {
            assemblies: [table.value([self.assembly])].into(),
            chains: Some(chains.filter(|it| !it.is_empty()).collect()),
            operators: Operators::Expression(table.value([self.expression])),
            line: table.line,
        }
    }
}

/// Columns of `pdbx_struct_oper_list` and of `struct_ncs_oper`.
pub(super) struct OperatorColumns {
    name: Column,
    code: Column,
    /// Three rows of the matrix, each with its entry of the vector.
    rows: [[Column; 4]; 3],
}

impl OperatorColumns {
    pub(super) fn of(table: &Table<'_>) -> Self {
        let row = |row: usize| {
            let entry = |column: usize| table.column(&format!("matrix[{row}][{column}]"));
            let vector = table.column(&format!("vector[{row}]"));
            [entry(1), entry(2), entry(3), vector]
        };
        Self {
            name: table.column("id"),
            code: table.column("code"),
            rows: [row(1), row(2), row(3)],
        }
    }

    /// Returns whether the file lacks the atoms that an operator of `struct_ncs_oper` generates.
    pub(super) fn generates(&self, table: &Table<'_>) -> bool {
        table.value([self.code]).eq_ignore_ascii_case("generate")
    }

    pub(super) fn read<'a>(&self, table: &Table<'a>) -> Matrix<'a> {
        Matrix {
            name: table.value([self.name]),
            words: self.rows.map(|row| row.map(|column| table.value([column]))),
            line: table.line,
            again: None,
        }
    }
}
