//! The number formats.

/// The arithmetic of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Format {
    /// Integers only: no floating-point instruction from the camera to the pixel.
    Fixed,
    /// IEEE 754 single precision.
    F32,
    /// IEEE 754 double precision.
    F64,
}

impl Format {
    /// All formats, in the order of their names.
    pub const ALL: [Format; 3] = [Format::Fixed, Format::F32, Format::F64];

    /// Returns the name that command lines and tables use.
    pub const fn name(self) -> &'static str {
        match self {
            Format::Fixed => "fixed",
            Format::F32 => "f32",
            Format::F64 => "f64",
        }
    }

    /// Returns the format of a [name](Self::name).
    ///
    /// ```
    /// use gridel_core::Format;
    ///
    /// assert_eq!(Format::from_name("fixed"), Some(Format::Fixed));
    /// assert_eq!(Format::from_name("float"), None);
    /// ```
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }
}
