//! The kinds of primitives there are: the one place that names them all.
//!
//! The code of each is a Cargo feature of the same name, and so is that of the wider forms in which
//! they are stored.

macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $variant:ident = $number:literal, $name:literal;)*) => {
        /// The kinds of primitives, in the order of their slots.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum Kind {
            $($(#[doc = $doc])* $variant = $number,)*
        }

        impl Kind {
            /// All kinds, in order.
            pub const ALL: [Kind; [$($number),*].len()] = [$(Kind::$variant),*];

            #[inline(always)]
            pub(crate) const fn from_number(number: u32) -> Option<Self> {
                match number {
                    $($number => Some(Kind::$variant),)*
                    _ => None,
                }
            }

            /// The name that tables use, and the Cargo feature.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Kind::$variant => $name,)*
                }
            }

            /// Whether this build holds the kind's code. A blob that holds primitives of a kind
            /// without code is refused.
            #[inline(always)]
            pub const fn is_available(self) -> bool {
                match self {
                    $(Kind::$variant => cfg!(feature = $name),)*
                }
            }
        }
    };
}

kinds! {
    /// A triangle of an indexed mesh.
    Triangle = 0, "triangle";
    /// A sphere.
    Sphere = 1, "sphere";
    /// An axis-aligned box.
    Box = 2, "box";
    /// A flat disc.
    Disc = 3, "disc";
    /// A capped cylinder, cone or frustum.
    Cone = 4, "cone";
}
