//! REMARK 350: the biological assemblies of a PDB file.

use super::columns;
use crate::scene::molecule::{Group, Matrix, Operators};

/// The state of reading remarks, which follow each other.
#[derive(Default)]
pub(super) struct Assemblies<'a> {
    /// The numbers of the assemblies that are open.
    open: Vec<&'a str>,
    /// How many groups at the end of the list are open: one for each assembly.
    groups: usize,
}

impl<'a> Assemblies<'a> {
    /// Reads a remark; `text` begins behind its number.
    pub(super) fn remark(&mut self, line: usize, text: &'a str, groups: &mut Vec<Group<'a>>) {
        let trimmed = text.trim();
        if let Some(names) = trimmed.strip_prefix("BIOMOLECULE:") {
            let names = names.split(',').map(str::trim);
            self.open = names.filter(|it| !it.is_empty()).collect();
            self.groups = 0;
        } else if let Some((head, names)) = trimmed.split_once("CHAINS:") {
            if !head.starts_with("AND") || self.groups == 0 {
                self.begin(line, groups);
            }
            let names = names.split(',').map(str::trim).filter(|it| !it.is_empty());
            // What files call chains without a name.
            let names = names.map(|name| if name == "NULL" { "" } else { name });
            let from = groups.len() - self.groups;
            for group in &mut groups[from..] {
                group.chains.get_or_insert_default().extend(names.clone());
            }
        } else if let Some(row) = trimmed.strip_prefix("BIOMT") {
            // The numbers stand in columns, of which the first two can touch.
            let row = columns(row, 1, 1);
            let offset = text.find("BIOMT").unwrap_or_default() + "BIOMT".len();
            let behind = &text[offset..];
            self.row(
                line,
                row,
                [columns(behind, 2, 5), columns(behind, 6, 80)],
                groups,
            );
        }
    }

    /// Begins a group of chains in each open assembly.
    fn begin(&mut self, line: usize, groups: &mut Vec<Group<'a>>) {
        if self.open.is_empty() {
            self.open.push("1");
        }
        groups.extend(self.open.iter().map(|assembly| Group {
            assembly,
            chains: None,
            operators: Operators::Listed(Vec::new()),
            line,
        }));
        self.groups = self.open.len();
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
        if self.groups == 0 {
            self.begin(line, groups);
        }
        let mut words = [""; 4];
        for (word, number) in words.iter_mut().zip(numbers.split_whitespace()) {
            *word = number;
        }
        let name = name.trim();
        let from = groups.len() - self.groups;
        for group in &mut groups[from..] {
            let Operators::Listed(matrices) = &mut group.operators else {
                continue;
            };
            match matrices.last_mut() {
                Some(last) if last.name == name && row > 0 => last.words[row] = words,
                _ => {
                    let mut matrix = Matrix {
                        name,
                        words: [[""; 4]; 3],
                        line,
                    };
                    matrix.words[row] = words;
                    matrices.push(matrix);
                }
            }
        }
    }
}
