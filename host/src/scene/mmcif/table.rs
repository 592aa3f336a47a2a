//! Tables of CIF, row by row.

use crate::scene::SceneError;
use crate::scene::text::Source;
use crate::table::grouped;

/// The most columns of a table. The largest of the dictionaries has some hundreds.
const MOST_COLUMNS: usize = 10_000;

/// The index of a column.
pub(super) type Column = Option<usize>;

/// The category of a tag.
pub(super) fn category(tag: &str) -> &str {
    tag.split('.').next().unwrap_or("")
}

/// A row of a table and the names of its columns.
#[derive(Default)]
pub(super) struct Table<'a> {
    pub(super) tags: Vec<&'a str>,
    pub(super) row: Vec<&'a str>,
    pub(super) line: usize,
}

impl<'a> Table<'a> {
    /// Adds a column, unless there are too many: a name can be shorter than the memory of its column.
    pub(super) fn add_column(
        &mut self,
        source: &Source,
        tag: &'a str,
        line: usize,
    ) -> Result<(), SceneError> {
        if self.tags.len() == MOST_COLUMNS {
            let cause = format!("a table has more than {} columns", grouped(MOST_COLUMNS));
            let error = source.error(cause, "split the table, or leave columns out");
            return Err(error.at_line(line));
        }
        self.tags.push(tag);
        Ok(())
    }

    pub(super) fn is_of(&self, wanted: &str) -> bool {
        self.tags
            .first()
            .is_some_and(|tag| category(tag).eq_ignore_ascii_case(wanted))
    }

    /// The index of a column.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.tags.iter().position(|tag| {
            tag.split_once('.')
                .is_some_and(|(_, item)| item.eq_ignore_ascii_case(name))
        })
    }

    /// The first value of these columns that is there and not left open, or else an empty one.
    pub(super) fn value<const N: usize>(&self, columns: [Option<usize>; N]) -> &'a str {
        let values = columns
            .into_iter()
            .flatten()
            .filter_map(|column| self.row.get(column).copied());
        values
            .into_iter()
            .find(|value| !value.is_empty())
            .unwrap_or("")
    }
}
