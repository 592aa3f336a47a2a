//! The reasons why pixels are open.

use serde::{Deserialize, Serialize};

/// A reason why a comparison is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[repr(u8)]
pub enum Reason {
    /// It is open which surface a ray hits: at an edge, or where surfaces meet.
    Hit = 1,
    /// It is open whether a surface is in a shadow.
    Shadow,
    /// It is open on which side of a surface a light is, because the surface faces it edge on.
    Terminator,
    /// It is open whether light is totally reflected.
    CriticalAngle,
    /// It is open in which cell of a checkerboard a point lies.
    Checker,
    /// It is open whether a ray's weight suffices to trace it.
    Cutoff,
    /// It is open to which side of a triangle a ray leaves, because the smooth normal decides its direction.
    Smooth,
    /// It is open where a ray crosses a surface that it runs along.
    Grazing,
    /// Too many outcomes to follow.
    Branches,
    /// It is open which of two 8-bit values is nearer, though everything else is known.
    Rounding,
    /// It is open which texel a point shows, or how texels are weighted there.
    Texture,
    /// It is open in which direction a random ray leaves, or a random point lies.
    Sampling,
    /// It is open whether a random facet sends a ray off its surface.
    Facet,
    /// It is open whether a light is so near that a point of it is drawn by solid angle.
    Near,
    /// The bounds are so wide that nothing follows from them.
    Width,
}

impl Reason {
    pub const ALL: [Self; 15] = [
        Self::Hit,
        Self::Shadow,
        Self::Terminator,
        Self::CriticalAngle,
        Self::Checker,
        Self::Cutoff,
        Self::Smooth,
        Self::Grazing,
        Self::Branches,
        Self::Rounding,
        Self::Texture,
        Self::Sampling,
        Self::Facet,
        Self::Near,
        Self::Width,
    ];

    pub fn of_number(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|&it| it as u8 == number)
    }

    /// Returns the reason in words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Hit => "edge of a hit, or surfaces that meet",
            Self::Shadow => "edge of a shadow",
            Self::Terminator => "light at a right angle to the normal",
            Self::CriticalAngle => "critical angle of total reflection",
            Self::Checker => "boundary of a checkerboard's cells",
            Self::Cutoff => "cutoff of secondary rays",
            Self::Smooth => "ray level with a smooth triangle",
            Self::Grazing => "ray along a surface",
            Self::Branches => "too many open comparisons",
            Self::Rounding => "rounding to 8 bits",
            Self::Texture => "boundary of texels or of their weights",
            Self::Sampling => "axes of a random direction",
            Self::Facet => "ray level with a rough surface",
            Self::Near => "distance up to which lights are drawn by solid angle",
            Self::Width => "bounds too wide",
        }
    }
}
