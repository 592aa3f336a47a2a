//! The type of every structure.

use crate::format::structure::structures;

macro_rules! types {
    ($(
        $(#[doc = $doc:literal])*
        $variant:ident = $number:literal, $name:literal, $field:ident in $($module:ident)::+,
            if $feature:meta;
    )*) => {
        $(pub use crate::accel::$($module)::+::$variant;)*
    };
}

structures!(types);
