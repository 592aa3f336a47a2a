//! Builders of hierarchies: the paper's, simple ones to compare with, and the best for a compiler that has time.
//!
//! | file | builders |
//! |---|---|
//! | `../sah.rs` | top down by the surface area heuristic, swept or binned |
//! | `insertion.rs` | the paper's: one primitive after the other, by the least increase of volume |
//! | `pairing.rs` | bottom up, pairs at random or nearest |
//! | `modelled.rs` | the groups of the scene file |
//! | `reinsertion.rs` | swept, then improved by taking subtrees out and putting them back |
//! | `tree.rs` | the tree that all but the first build, and how it becomes a hierarchy |
//!
//! All are bounded. None takes more than `O(n log n)` steps per level or pass, some hundred bytes per primitive, and
//! [`MAX_LEVELS`](gridel_core::format::limits::MAX_LEVELS) levels. Where a tree would be deeper, its subtrees are
//! halved instead. Two builders, which are there to be compared, can take up to `n^2` steps: nearest pairing where many
//! boxes coincide, and reinsertion where most overlap.

mod insertion;
mod modelled;
mod pairing;
mod reinsertion;
mod tree;

use crate::compile::hierarchy::node::{Node, Primitive};
use crate::compile::hierarchy::sah::{self, Splits};

/// A way to build a hierarchy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Builder {
    /// Top down by the surface area heuristic: all splits where there are few primitives, 32 bins
    /// where there are many.
    #[default]
    Sah,
    /// Like [`Sah`](Self::Sah), with bins throughout.
    Binned,
    /// The hierarchy of [`Sah`](Self::Sah), improved by reinsertion: takes longest, and is best for boxes.
    Reinsertion,
    /// The paper's: each primitive enters at the root and goes where it adds least volume.
    Insertion,
    /// Bottom up: the nearest two become one.
    NearestPairing,
    /// Bottom up: any two become one.
    RandomPairing,
    /// The groups of the scene file: objects of OBJ, chains and residues of molecules.
    Modelled,
}

impl Builder {
    /// All builders, the default first.
    pub const ALL: [Builder; 7] = [
        Builder::Sah,
        Builder::Binned,
        Builder::Reinsertion,
        Builder::Insertion,
        Builder::NearestPairing,
        Builder::RandomPairing,
        Builder::Modelled,
    ];

    /// Returns the name that command lines and tables use.
    pub const fn name(self) -> &'static str {
        match self {
            Builder::Sah => "sah",
            Builder::Binned => "binned",
            Builder::Reinsertion => "reinsertion",
            Builder::Insertion => "insertion",
            Builder::NearestPairing => "nearest-pairing",
            Builder::RandomPairing => "random-pairing",
            Builder::Modelled => "modelled",
        }
    }
}

/// Builds a hierarchy and puts the primitives in the order of its leaves; `None` without primitives. `object` gives the
/// name of a primitive's object, and the primitive's number in scene-file order. Builders other than the first two make
/// leaves of the usual size where `leaf_size` is larger.
pub fn build<'g>(
    builder: Builder,
    primitives: &mut [Primitive],
    leaf_size: usize,
    object: impl Fn(&Primitive) -> (&'g str, u32),
) -> Option<Node> {
    if primitives.len() < 2 {
        return sah::build(primitives, Splits::Swept, leaf_size);
    }
    let tree = match builder {
        Builder::Sah => return sah::build(primitives, Splits::Swept, leaf_size),
        Builder::Binned => return sah::build(primitives, Splits::Binned, leaf_size),
        Builder::Reinsertion => {
            let root = sah::build(primitives, Splits::Swept, leaf_size)?;
            reinsertion::improve(&root)
        }
        Builder::Insertion => insertion::build(primitives),
        Builder::NearestPairing => pairing::nearest(primitives),
        Builder::RandomPairing => pairing::random(primitives),
        Builder::Modelled => modelled::build(primitives, object),
    };
    Some(tree.finish(primitives))
}

#[cfg(test)]
mod tests;
