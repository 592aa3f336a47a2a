//! The layouts of all sections, with those of shapes.

use crate::format::kind::shapes;
use crate::format::layout::{SectionLayout, Stored};
use crate::format::section::sections;
use crate::format::{SectionKind, cluster, environment, instance, lens, light_form, record, track};

macro_rules! layouts {
    ($(
        $(#[doc = $doc:expr])*
        $kind:ident = $number:literal, $name:literal, [$($form:ty),*], $record:literal of $owner:literal;
    )*) => {
        impl SectionKind {
            /// Returns what the section holds, as `FORMAT.md` shows it.
            ///
            /// ```
            /// use gridel_core::format::SectionKind;
            ///
            /// let [light] = SectionKind::Lights.layout().records else {
            ///     panic!("lights have one form")
            /// };
            /// assert_eq!(light.bytes, 40);
            /// ```
            pub const fn layout(self) -> SectionLayout {
                match self {
                    $(SectionKind::$kind => SectionLayout {
                        doc: &[$($doc),*],
                        records: &[$(<$form as Stored>::LAYOUT),*],
                    },)*
                }
            }
        }
    };
}

shapes!(sections, layouts);
