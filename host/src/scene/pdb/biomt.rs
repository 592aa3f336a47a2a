//! REMARK 350: the biological assemblies of a PDB file.

use super::columns::columns;
use crate::scene::SceneError;
use crate::scene::molecule::{Group, Matrix, Operators, Parsed};
use crate::scene::text::Source;
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
    ///
    /// # Errors
    /// If it does not fit into memory.
    pub(super) fn remark(
        &mut self,
        source: &Source,
        line: usize,
        text: &'a str,
        parsed: &mut Parsed<'a>,
    ) -> Result<(), SceneError> {
        let trimmed = text.trim();
        if let Some(names) = trimmed.strip_prefix("BIOMOLECULE:") {
            let names = names.split(',').map(str::trim);
            self.open = names.filter(|it| !it.is_empty()).collect();
            self.in_group = false;
            parsed.spend_names(source, line, self.open.len())?;
        } else if let Some((head, names)) = trimmed.split_once("CHAINS:") {
            if !(head.starts_with("AND") && self.in_group) {
                self.begin(source, line, parsed)?;
            }
            let names = names.split(',').map(str::trim).filter(|it| !it.is_empty());
            // Names of files for chains without a name.
            let names = names.map(|name| if name == "NULL" { "" } else { name });
            parsed.spend_names(source, line, names.clone().count())?;
            if let Some(group) = parsed.groups.last_mut() {
                group.chains.get_or_insert_default().extend(names);
            }
        } else if let Some(rest) = trimmed.strip_prefix("BIOMT") {
            // The row and the operator's number stand in columns, which can touch.
            let numbers = [columns(rest, 2, 5), columns(rest, 6, 80)];
            if let Some(row) = ["1", "2", "3"]
                .iter()
                .position(|it| *it == columns(rest, 1, 1))
            {
                if !self.in_group {
                    self.begin(source, line, parsed)?;
                }
                // Each row may begin an operator.
                parsed.spend_operator(source, line)?;
                add_row(line, row, numbers, &mut parsed.groups);
            }
        }
        Ok(())
    }

    /// Begins a group of chains in the open assemblies.
    fn begin(
        &mut self,
        source: &Source,
        line: usize,
        parsed: &mut Parsed<'a>,
    ) -> Result<(), SceneError> {
        if self.open.is_empty() {
            self.open = ["1"].into();
        }
        self.in_group = true;
        let group = Group {
            assemblies: Rc::clone(&self.open),
            chains: None,
            operators: Operators::Listed(Vec::new()),
            line,
        };
        parsed.add_group(source, group)
    }
}

/// Adds a row of a matrix to the last group: the operator's number, and four numbers.
fn add_row<'a>(line: usize, row: usize, [name, numbers]: [&'a str; 2], groups: &mut [Group<'a>]) {
    let mut words = [""; 4];
    for (word, number) in words.iter_mut().zip(numbers.split_whitespace()) {
        *word = number;
    }
    let name = name.trim();
    let Some(Operators::Listed(matrices)) = groups.last_mut().map(|it| &mut it.operators) else {
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
