//! REMARK 350: the biological assemblies of a PDB file.

use super::columns::columns;
use crate::scene::molecule::{Group, Matrix, Operators};
use std::rc::Rc;

/// The state of reading remarks, which follow each other.
#[derive(Default)]
pub(super) struct Assemblies<'a> {
    /// The numbers of the assemblies that are open.
    open: Rc<[&'a str]>,
    /// True if a group is open, the last one.
    in_group: bool,
}

impl<'a> Assemblies<'a> {
    /// Reads a remark; `text` begins behind its number.
    pub(super) fn remark(&mut self, line: usize, text: &'a str, groups: &mut Vec<Group<'a>>) {
        let trimmed = text.trim();
        if let Some(names) = trimmed.strip_prefix("BIOMOLECULE:") {
            let names = names.split(',').map(str::trim);
            self.open = names.filter(|it| !it.is_empty()).collect();
            self.in_group = false;
        } else if let Some((head, names)) = trimmed.split_once("CHAINS:") {
            if !(head.starts_with("AND") && self.in_group) {
                self.begin(line, groups);
            }
            let names = names.split(',').map(str::trim).filter(|it| !it.is_empty());
            // Names of files for chains without a name.
            let names = names.map(|name| if name == "NULL" { "" } else { name });
            if let Some(group) = groups.last_mut() {
                group.chains.get_or_insert_default().extend(names);
            }
        } else if let Some(rest) = trimmed.strip_prefix("BIOMT") {
            // The row and the operator's number stand in columns, which can touch.
            let numbers = [columns(rest, 2, 5), columns(rest, 6, 80)];
            self.row(line, columns(rest, 1, 1), numbers, groups);
        }
    }

    /// Begins a group of chains in the open assemblies.
    fn begin(&mut self, line: usize, groups: &mut Vec<Group<'a>>) {
        if self.open.is_empty() {
            self.open = ["1"].into();
        }
        groups.push(Group {
            assemblies: Rc::clone(&self.open),
            chains: None,
            operators: Operators::Listed(Vec::new()),
            line,
        });
        self.in_group = true;
    }

    /// Takes in a row of a matrix: the operator's number, and four numbers.
    fn row(
        &mut self,
        line: usize,
        row: &str,
        [name, numbers]: [&'a str; 2],
        groups: &mut Vec<Group<'a>>,
    ) {
        let Some(row) = ["1", "2", "3"].iter().position(|it| *it == row) else {
            return;
        };
        if !self.in_group {
            self.begin(line, groups);
        }
        let mut words = [""; 4];
        for (word, number) in words.iter_mut().zip(numbers.split_whitespace()) {
            *word = number;
        }
        let name = name.trim();
        let Some(Operators::Listed(matrices)) = groups.last_mut().map(|it| &mut it.operators)
        else {
            return;
        };
        match matrices.last_mut() {
            Some(last) if last.name == name && row > 0 => last.words[row] = words,
            _ => {
                let mut matrix = Matrix {
                    name,
                    words: [[""; 4]; 3],
                    line,
                    again: None,
                };
                matrix.words[row] = words;
                matrices.push(matrix);
            }
        }
    }
}
