//! The declaration of records: a struct, its layout, and the ranges of its fields.
//!
//! A layout is a constant that no reader uses, so firmware does not hold it. A test prints the layouts into
//! `FORMAT.md`.

/// The layout of a record, or of a part of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Its size.
    pub bytes: usize,
    /// Its parts.
    pub form: Form,
}

/// The form of a layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A number of the type with this name.
    Number(&'static str),
    /// An array of one layout, at rising offsets.
    Array(usize, &'static Layout),
    /// Fields.
    Record(&'static RecordLayout),
}

/// The fields of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordLayout {
    /// Its name.
    pub name: &'static str,
    /// The lines of its documentation.
    pub doc: &'static [&'static str],
    /// In ascending order of their offsets.
    pub fields: &'static [FieldLayout],
}

/// A field of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldLayout {
    /// Its name; a number in a record whose only field has none.
    pub name: &'static str,
    /// The lines of its documentation.
    pub doc: &'static [&'static str],
    /// Its first byte, from the record's start.
    pub offset: usize,
    /// Its layout.
    pub layout: Layout,
    /// The smallest and the largest valid number, where loading tests the field against a constant range.
    pub valid: Option<[i64; 2]>,
}

/// The content of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionLayout {
    /// The lines of its documentation.
    pub doc: &'static [&'static str],
    /// The forms that the compiler gives to its records. All records of a section have one form.
    pub records: &'static [Layout],
}

/// A type whose values lie in a blob.
pub trait Stored: Copy {
    /// Its layout.
    const LAYOUT: Layout;
}

macro_rules! numbers {
    ($($number:ident)*) => {
        $(impl Stored for $number {
            const LAYOUT: Layout = Layout {
                bytes: size_of::<$number>(),
                form: Form::Number(stringify!($number)),
            };
        })*
    };
}

numbers!(u8 u16 u32 i16 i32 i64 f64);

impl<T: Stored, const N: usize> Stored for [T; N] {
    const LAYOUT: Layout = Layout {
        bytes: size_of::<Self>(),
        form: Form::Array(N, &T::LAYOUT),
    };
}

/// Declares records. Every record states its size, `#[bytes(..)]`, so that a change cannot alter it by accident. The
/// offsets of its fields are in `FORMAT.md`. A field with `#[valid(FIELD: RANGE)]` is tested by
/// [`check_ranges`](crate::format::range::Ranges), which names it `FIELD` in errors.
macro_rules! records {
    ($(
        $(#[doc = $doc:literal])*
        #[derive($($derive:ident),*)]
        #[repr($($repr:tt)*)]
        #[bytes($bytes:literal)]
        $visibility:vis struct $name:ident $fields:tt $(;)?
    )*) => {$(
        $crate::format::layout::structure! {
            $(#[doc = $doc])*
            #[derive($($derive),*)]
            #[repr($($repr)*)]
            $visibility struct $name $fields
        }

        const _: () = assert!(size_of::<$name>() == $bytes);
    )*};
}

macro_rules! structure {
    (
        $(#[doc = $doc:literal])*
        #[derive($($derive:ident),*)]
        #[repr($($repr:tt)*)]
        $visibility:vis struct $name:ident {$(
            $(#[doc = $field_doc:literal])*
            $(#[valid($field:ident: $range:expr)])?
            $field_visibility:vis $field_name:ident: $type:ty,
        )*}
    ) => {
        $(#[doc = $doc])*
        #[derive($($derive),*)]
        #[repr($($repr)*)]
        $visibility struct $name {
            $($(#[doc = $field_doc])* $field_visibility $field_name: $type,)*
        }

        impl $crate::format::layout::Stored for $name {
            const LAYOUT: $crate::format::layout::Layout = $crate::format::layout::Layout {
                bytes: size_of::<Self>(),
                form: $crate::format::layout::Form::Record(&$crate::format::layout::RecordLayout {
                    name: stringify!($name),
                    doc: &[$($doc),*],
                    fields: &[$($crate::format::layout::FieldLayout {
                        name: stringify!($field_name),
                        doc: &[$($field_doc),*],
                        offset: core::mem::offset_of!($name, $field_name),
                        layout: <$type as $crate::format::layout::Stored>::LAYOUT,
                        valid: $crate::format::layout::valid!($($range)?),
                    }),*],
                }),
            };
        }

        impl $crate::format::range::Ranges for $name {
            #[inline(always)]
            fn check_ranges(
                &self,
                location: $crate::format::Location,
            ) -> Result<(), $crate::format::BlobError> {
                #[allow(unused_mut, reason = "some records have no ranges")]
                let mut result = Ok(());
                $($({
                    const RANGE: core::ops::RangeInclusive<i64> = $range;
                    const FIELD: $crate::format::range::FieldRange = $crate::format::range::FieldRange {
                        field: $crate::format::Field::$field,
                        low: *RANGE.start(),
                        high: *RANGE.end(),
                    };
                    $crate::format::range::Numbers::test(
                        &{ self.$field_name }, &mut result, &location, &FIELD,
                    );
                })?)*
                let _ = location;
                result
            }
        }
    };
    (
        $(#[doc = $doc:literal])*
        #[derive($($derive:ident),*)]
        #[repr($($repr:tt)*)]
        $visibility:vis struct $name:ident (
            $(#[doc = $field_doc:literal])*
            $field_visibility:vis $type:ty
        )
    ) => {
        $(#[doc = $doc])*
        #[derive($($derive),*)]
        #[repr($($repr)*)]
        $visibility struct $name($(#[doc = $field_doc])* $field_visibility $type);

        impl $crate::format::layout::Stored for $name {
            const LAYOUT: $crate::format::layout::Layout = $crate::format::layout::Layout {
                bytes: size_of::<Self>(),
                form: $crate::format::layout::Form::Record(&$crate::format::layout::RecordLayout {
                    name: stringify!($name),
                    doc: &[$($doc),*],
                    fields: &[$crate::format::layout::FieldLayout {
                        name: "0",
                        doc: &[$($field_doc),*],
                        offset: 0,
                        layout: <$type as $crate::format::layout::Stored>::LAYOUT,
                        valid: None,
                    }],
                }),
            };
        }
    };
}

/// The range of a field, if it has one.
macro_rules! valid {
    () => {
        None
    };
    ($range:expr) => {{
        const RANGE: core::ops::RangeInclusive<i64> = $range;
        Some([*RANGE.start(), *RANGE.end()])
    }};
}

pub(crate) use {records, structure, valid};
