//! Columns of a line.

/// The columns `first` to `last` of a line, counted from 1; fewer where the line is shorter.
pub(super) fn columns(line: &str, first: usize, last: usize) -> &str {
    let offset = |column: usize| {
        if line.is_ascii() {
            column.min(line.len())
        } else {
            line.char_indices()
                .nth(column)
                .map_or(line.len(), |(offset, _)| offset)
        }
    };
    &line[offset(first - 1)..offset(last)]
}
