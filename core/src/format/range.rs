//! Errors for numbers that are out of their range.

use crate::format::{BlobError, Field, Location, Reason, SectionKind};

/// The ratio 1, with 30 fraction bits.
pub(crate) const ONE: i64 = 1 << 30;

/// The largest radiance, with 20 fraction bits.
pub(crate) const RADIANCE: i64 = i32::MAX as i64;

/// Returns an error unless a field of the header is at most `most`.
#[inline(always)]
pub(crate) fn at_most(field: Field, found: u32, most: u32) -> Result<(), BlobError> {
    in_header(field, found, 0, most)
}

/// Returns an error unless a field of the header is `expected`.
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
    /// Returns an error unless `found` lies in `low..=high`.
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

    /// Returns an error unless every one of `found` lies in `low..=high`.
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

    /// Returns an error with this reason unless a condition holds.
    pub(crate) fn ensure(self, holds: bool, reason: Reason) -> Result<(), BlobError> {
        if holds {
            return Ok(());
        }
        Err(Location::Record(self.section, self.index).invalid(reason))
    }
}

impl Location {
    /// Returns an error with this reason unless a condition holds.
    pub(crate) fn ensure(self, holds: bool, reason: Reason) -> Result<(), BlobError> {
        if holds {
            return Ok(());
        }
        Err(self.invalid(reason))
    }
}

/// The range of a field that its declaration states.
#[derive(Clone, Copy)]
pub(crate) struct FieldRange {
    pub(crate) field: Field,
    pub(crate) low: i64,
    pub(crate) high: i64,
}

/// A record whose fields are tested against the ranges that its declaration states.
pub(crate) trait Ranges {
    /// Returns an error unless every field lies in its range.
    fn check_ranges(&self, location: Location) -> Result<(), BlobError>;
}

/// A field: a number or an array of numbers.
pub(crate) trait Numbers {
    /// Replaces the result by an error unless all of the field lies in a range, or there is an error already.
    // One result for all fields of a record, because a result per field would use more call stack.
    fn test(&self, result: &mut Result<(), BlobError>, location: &Location, range: &FieldRange);
}

/// Tests a number; see [`Numbers::test`].
fn test(found: i64, result: &mut Result<(), BlobError>, location: &Location, range: &FieldRange) {
    if result.is_ok() && (found < range.low || found > range.high) {
        *result = Err(location.out_of_range(range.field, found, [range.low, range.high]));
    }
}

macro_rules! numbers {
    ($($number:ident)*) => {
        $(impl Numbers for $number {
            #[inline(always)]
            fn test(
                &self,
                result: &mut Result<(), BlobError>,
                location: &Location,
                range: &FieldRange,
            ) {
                test(i64::from(*self), result, location, range);
            }
        })*
    };
}

numbers!(u8 u16 u32 i16 i32 i64);

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    #[inline(always)]
    fn test(&self, result: &mut Result<(), BlobError>, location: &Location, range: &FieldRange) {
        for number in self {
            number.test(result, location, range);
        }
    }
}

impl At {
    /// The location of the record, for errors.
    #[inline(always)]
    pub(crate) fn location(self) -> Location {
        Location::Record(self.section, self.index)
    }
}
