//! MTRIX: operators that generate the rest of the asymmetric unit from the atoms of the file.

use super::columns::columns;
use crate::scene::SceneError;
use crate::scene::molecule::{Matrix, Parsed};
use crate::scene::text::Source;

/// The state of reading rows, which follow each other.
#[derive(Default)]
pub(super) struct Generating<'a> {
    /// An operator whose atoms the file may list.
    open: Option<Matrix<'a>>,
    is_given: bool,
}

impl<'a> Generating<'a> {
    /// Reads a row of an operator.
    ///
    /// # Errors
    /// If it does not fit into memory.
    pub(super) fn row(
        &mut self,
        source: &Source,
        line: usize,
        text: &'a str,
        parsed: &mut Parsed<'a>,
    ) -> Result<(), SceneError> {
        let Some(row @ 0..=2) = columns(text, 6, 6)
            .bytes()
            .next()
            .map(|it| it.wrapping_sub(b'1'))
        else {
            return Ok(());
        };
        let name = columns(text, 8, 10).trim();
        if self
            .open
            .as_ref()
            .is_none_or(|it| it.name != name || row == 0)
        {
            self.finish(source, parsed)?;
            self.open = Some(Matrix {
                name,
                words: [[""; 4]; 3],
                line,
                again: None,
            });
        }
        let fields = [[11, 20], [21, 30], [31, 40], [46, 55]];
        if let Some(open) = &mut self.open {
            open.words[usize::from(row)] = fields.map(|[a, b]| columns(text, a, b).trim());
        }
        self.is_given |= columns(text, 60, 60) == "1";
        Ok(())
    }

    /// Adds the open operator, unless the file lists its atoms.
    ///
    /// # Errors
    /// If it does not fit into memory.
    pub(super) fn finish(
        &mut self,
        source: &Source,
        parsed: &mut Parsed<'a>,
    ) -> Result<(), SceneError> {
        let is_given = std::mem::take(&mut self.is_given);
        match self.open.take() {
            Some(open) if !is_given => parsed.add_generating(source, open),
            _ => Ok(()),
        }
    }
}
