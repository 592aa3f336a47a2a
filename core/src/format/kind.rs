//! The kinds of primitives. Only this file names them all.
//!
//! A shape is a file in [`geometry`](crate::geometry) and a line in the table below. Its code is a Cargo feature of the
//! same name, and so is that of the wider forms in which primitives are stored.

/// Passes the table of shapes to a macro. Triangles and spheres have several forms of records, for few bits and many,
/// alone and in clusters. Every other shape has one record. Its line states the kind, the number in the blob, the name
/// in tables and Cargo feature. Then come the slice of records, the module of `geometry` and record, and the section.
/// Arguments after the macro's name are passed on before the table.
#[doc(hidden)]
#[macro_export]
macro_rules! shapes {
    ($macro:ident $(, $rest:ident)*) => {
        $macro! {
            $($rest)*
            forms {
                /// A triangle of an indexed mesh.
                Triangle = 0, "triangle";
                /// A sphere.
                Sphere = 1, "sphere";
            }
            records {
                /// An axis-aligned box.
                Box = 2, "box", [boxes: cuboid::Cuboid], [Boxes = 10, "boxes"];
                /// A flat disc.
                Disc = 3, "disc", [discs: disc::Disc], [Discs = 11, "discs"];
                /// A capped cylinder, cone or frustum.
                Cone = 4, "cone", [cones: cone::Cone], [Cones = 12, "cones"];
                /// A torus.
                Torus = 5, "torus", [tori: torus::Torus], [Tori = 60, "tori"];
                /// An infinite plane.
                Plane = 6, "plane", [planes: plane::Plane], [Planes = 63, "planes"];
            }
        }
    };
}

pub(crate) use shapes;

macro_rules! kinds {
    (
        forms { $($(#[doc = $form_doc:literal])* $form:ident = $form_number:literal, $form_name:literal;)* }
        records { $($(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal, $record:tt, $section:tt;)* }
    ) => {
        /// The kinds of primitives, in the order of their slots.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(u32)]
        pub enum Kind {
            $($(#[doc = $form_doc])* $form = $form_number,)*
            $($(#[doc = $doc])* $kind = $number,)*
        }

        impl Kind {
            /// Kinds for which the word of a leaf has numbers: 7 marks a [node](crate::format::node::Child).
            pub(crate) const MOST: usize = 7;

            /// All kinds, in order.
            pub const ALL: [Kind; [$($form_number,)* $($number),*].len()] =
                {
                    let all = [$(Kind::$form,)* $(Kind::$kind),*];
                    assert!(all.len() <= Kind::MOST);
                    all
                };

            #[inline(always)]
            pub(crate) const fn from_number(number: u32) -> Option<Self> {
                match number {
                    $($form_number => Some(Kind::$form),)*
                    $($number => Some(Kind::$kind),)*
                    _ => None,
                }
            }

            /// Returns the name that tables use, and the Cargo feature.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Kind::$form => $form_name,)*
                    $(Kind::$kind => $name,)*
                }
            }

            /// Returns true if this build has the kind's code. Blobs with primitives of a kind without code are
            /// rejected.
            #[inline(always)]
            pub const fn is_available(self) -> bool {
                match self {
                    $(Kind::$form => cfg!(feature = $form_name),)*
                    $(Kind::$kind => cfg!(feature = $name),)*
                }
            }

            /// Returns true if leaves of [`Wide`](crate::accel) store primitives of the kind in clusters.
            pub const fn is_clustered(self) -> bool {
                match self {
                    $(Kind::$form => true,)*
                    $(Kind::$kind => false,)*
                }
            }
        }
    };
}

shapes!(kinds);
