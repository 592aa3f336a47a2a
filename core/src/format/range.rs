//! Errors for numbers that are out of their range.

use crate::format::{BlobError, Field, Location, Reason, SectionKind};

/// An error unless a field of the header is at most `most`.
#[inline(always)]
pub(crate) fn at_most(field: Field, found: u32, most: u32) -> Result<(), BlobError> {
    in_header(field, found, 0, most)
}

/// An error unless a field of the header is `expected`.
#[inline(always)]
pub(crate) fn exactly(field: Field, found: u32, expected: u32) -> Result<(), BlobError> {
    in_header(field, found, expected, expected)
}

#[inline(always)]
fn in_header(field: Field, found: u32, low: u32, high: u32) -> Result<(), BlobError> {
    if found < low || found > high {
        let range = [low.into(), high.into()];
        return Err(Location::Header.out_of_range(field, found.into(), range));
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
        field: Field,
        found: i64,
        low: i64,
        high: i64,
    ) -> Result<(), BlobError> {
        if found < low || found > high {
            let Self { section, index } = self;
            let location = Location::Record(section, index);
            return Err(location.out_of_range(field, found, [low, high]));
        }
        Ok(())
    }

    /// An error unless every one of `found` lies in `low..=high`.
    pub(crate) fn all_within<T: Into<i64> + Copy>(
        self,
        field: Field,
        found: &[T],
        low: i64,
        high: i64,
    ) -> Result<(), BlobError> {
        found
            .iter()
            .try_for_each(|&value| self.within(field, value.into(), low, high))
    }

    /// An error for this reason unless a condition holds.
    pub(crate) fn ensure(self, holds: bool, reason: Reason) -> Result<(), BlobError> {
        if holds {
            return Ok(());
        }
        Err(Location::Record(self.section, self.index).invalid(reason))
    }
}

impl Location {
    /// An error for this reason unless a condition holds.
    pub(crate) fn ensure(self, holds: bool, reason: Reason) -> Result<(), BlobError> {
        if holds {
            return Ok(());
        }
        Err(self.invalid(reason))
    }
}

/// Errors for the header.
#[derive(Clone, Copy)]
pub(crate) struct InHeader;

/// Where a record lies, for errors.
pub(crate) trait Place: Copy {
    /// An error unless `found` lies in `low..=high`.
    fn number(self, field: Field, found: i64, low: i64, high: i64) -> Result<(), BlobError>;

    /// An error unless every one of `found` lies in `low..=high`.
    #[inline(always)]
    fn numbers<T: Into<i64> + Copy>(
        self,
        field: Field,
        found: &[T],
        low: i64,
        high: i64,
    ) -> Result<(), BlobError> {
        found
            .iter()
            .try_for_each(|&value| self.number(field, value.into(), low, high))
    }
}

impl Place for At {
    #[inline(always)]
    fn number(self, field: Field, found: i64, low: i64, high: i64) -> Result<(), BlobError> {
        self.within(field, found, low, high)
    }

    #[inline(always)]
    fn numbers<T: Into<i64> + Copy>(
        self,
        field: Field,
        found: &[T],
        low: i64,
        high: i64,
    ) -> Result<(), BlobError> {
        self.all_within(field, found, low, high)
    }
}

impl Place for InHeader {
    #[inline(always)]
    fn number(self, field: Field, found: i64, low: i64, high: i64) -> Result<(), BlobError> {
        if found < low || found > high {
            return Err(Location::Header.out_of_range(field, found, [low, high]));
        }
        Ok(())
    }
}

/// A record whose fields are tested against the ranges that its declaration states.
pub(crate) trait Ranges {
    /// An error unless every field lies in its range.
    fn check_ranges(&self, place: impl Place) -> Result<(), BlobError>;
}

/// A field: a number or an array of numbers.
pub(crate) trait Numbers {
    /// An error unless all of it lies in `low..=high`.
    fn within(&self, place: impl Place, field: Field, low: i64, high: i64)
    -> Result<(), BlobError>;
}

macro_rules! numbers {
    ($($number:ident)*) => {
        $(impl Numbers for $number {
            #[inline(always)]
            fn within(
                &self,
                place: impl Place,
                field: Field,
                low: i64,
                high: i64,
            ) -> Result<(), BlobError> {
                place.number(field, i64::from(*self), low, high)
            }
        })*
    };
}

numbers!(u8 u16 u32 i16 i32);

impl<T: Into<i64> + Copy, const N: usize> Numbers for [T; N] {
    #[inline(always)]
    fn within(
        &self,
        place: impl Place,
        field: Field,
        low: i64,
        high: i64,
    ) -> Result<(), BlobError> {
        place.numbers(field, self, low, high)
    }
}
