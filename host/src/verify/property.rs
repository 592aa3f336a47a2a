//! The properties that hold for every scene, and their violations.

use gridel_core::{Format, Number, Structure};
use serde::Serialize;

/// A property that holds for every scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Property {
    /// Every structure gives the list's answer, bit for bit.
    Structures,
    /// Any hit and closest hit agree on whether there is a hit.
    AnyHit,
    /// Hits are those of exact arithmetic, where it finds them, within [`STEPS`](super::judge::STEPS).
    Answers,
    /// Numbers of a hit are finite, its t lies in the interval, its normal has the length 1.
    Numbers,
    /// A ray that starts at a hit does not hit the same surface again, and one that starts inside of a solid leaves it.
    SelfHits,
    /// A point in shadow by `f64` is not lit in another format.
    Shadows,
    /// No ray leaves a closed mesh unseen.
    Leaks,
}

impl Property {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 7] = [
        Self::Structures,
        Self::AnyHit,
        Self::Answers,
        Self::Numbers,
        Self::SelfHits,
        Self::Shadows,
        Self::Leaks,
    ];

    /// Returns the property in words, for reports.
    pub const fn text(self) -> &'static str {
        match self {
            Property::Structures => "every structure agrees with brute force, bit for bit",
            Property::AnyHit => "any hit and closest hit agree on whether there is a hit",
            Property::Answers => "hits agree with exact arithmetic",
            Property::Numbers => "hits are finite and in the interval; normals have length 1",
            Property::SelfHits => "secondary rays do not hit the surface that they leave",
            Property::Shadows => "every shadow of `f64` is there in the other formats",
            Property::Leaks => "no ray leaves a closed mesh without a hit",
        }
    }
}

/// A violation of a property.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    pub property: Property,
    pub format: Format,
    pub structure: Structure,
    /// The fault, as a clause.
    pub what: String,
}

impl Fault {
    pub(super) fn of<N: Number>(property: Property, structure: Structure, what: String) -> Self {
        Self {
            property,
            format: N::FORMAT,
            structure,
            what,
        }
    }
}

/// Tests of a property at a hit: not everything can be tested at every hit.
#[derive(Clone, Debug, Default)]
pub struct Tested {
    /// Number of tests.
    pub tests: u64,
    pub faults: Vec<Fault>,
}
