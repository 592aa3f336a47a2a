//! Errors for numbers that are out of their range.

use crate::format::{BlobError, SectionKind};

/// An error unless `found` lies in `0..=most`.
pub(crate) fn at_most(field: &'static str, found: u64, most: u64) -> Result<(), BlobError> {
    if found > most {
        return Err(BlobError::Header {
            field,
            found,
            expected: most,
        });
    }
    Ok(())
}

/// An error unless `found` is `expected`.
pub(crate) fn exactly(field: &'static str, found: u64, expected: u64) -> Result<(), BlobError> {
    if found != expected {
        return Err(BlobError::Header {
            field,
            found,
            expected,
        });
    }
    Ok(())
}

/// Errors for the records of one section.
#[derive(Clone, Copy)]
pub(crate) struct At {
    pub(crate) section: SectionKind,
    pub(crate) index: usize,
}

impl At {
    /// An error unless `found` lies in `low..=high`.
    pub(crate) fn within(
        self,
        what: &'static str,
        found: i64,
        low: i64,
        high: i64,
    ) -> Result<(), BlobError> {
        let expected = if found < low { low } else { high };
        if found < low || found > high {
            let Self { section, index } = self;
            return Err(BlobError::Record {
                section,
                index,
                what,
                found,
                expected,
            });
        }
        Ok(())
    }

    /// An error unless every one of `found` lies in `low..=high`.
    pub(crate) fn all_within<T: Into<i64> + Copy>(
        self,
        what: &'static str,
        found: &[T],
        low: i64,
        high: i64,
    ) -> Result<(), BlobError> {
        found
            .iter()
            .try_for_each(|&value| self.within(what, value.into(), low, high))
    }
}
