//! What light does in a scene, as a set: the scene pays for these and for nothing else.

use crate::format::limits::work_depth;
use core::fmt;

/// A set of effects.
///
/// The compiler writes into a blob the set that its scene calls for. The ray loop is compiled for
/// a set given as a constant, and each effect's code can be left out by its Cargo feature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Effects(pub u32);

impl Effects {
    /// None: surfaces have their diffuse colour under unshadowed lights.
    pub const NONE: Effects = Effects(0);
    /// Objects stand in each other's light: a shadow ray a light and hit.
    pub const SHADOW: Effects = Effects(1 << 0);
    /// Highlights of the lights.
    pub const HIGHLIGHT: Effects = Effects(1 << 1);
    /// Mirrors: one more ray a hit.
    pub const MIRROR: Effects = Effects(1 << 2);
    /// Glass: up to two more rays a hit, and shadows through it.
    pub const GLASS: Effects = Effects(1 << 3);
    /// Glass that takes up light along the way.
    pub const ABSORPTION: Effects = Effects(1 << 4);
    /// Checkerboards.
    pub const CHECKER: Effects = Effects(1 << 5);

    /// Every effect, with its name and Cargo feature.
    pub const NAMED: [(Effects, &'static str); 6] = [
        (Effects::SHADOW, "shadow"),
        (Effects::HIGHLIGHT, "highlight"),
        (Effects::MIRROR, "mirror"),
        (Effects::GLASS, "glass"),
        (Effects::ABSORPTION, "absorption"),
        (Effects::CHECKER, "checker"),
    ];

    /// All effects that there are.
    pub const ALL: Effects = Effects(0x3f);

    /// The effects whose code this build holds.
    pub const AVAILABLE: Effects = {
        let mut set = 0;
        if cfg!(feature = "shadow") {
            set |= Effects::SHADOW.0;
        }
        if cfg!(feature = "highlight") {
            set |= Effects::HIGHLIGHT.0;
        }
        if cfg!(feature = "mirror") {
            set |= Effects::MIRROR.0;
        }
        if cfg!(feature = "glass") {
            set |= Effects::GLASS.0;
        }
        if cfg!(feature = "absorption") {
            set |= Effects::ABSORPTION.0;
        }
        if cfg!(feature = "checker") {
            set |= Effects::CHECKER.0;
        }
        Effects(set)
    };

    /// Whether all of `other` are in this set.
    pub const fn contains(self, other: Effects) -> bool {
        self.0 & other.0 == other.0
    }

    /// This set without those of `other`.
    pub const fn without(self, other: Effects) -> Effects {
        Effects(self.0 & !other.0)
    }

    /// This set and that of `other`.
    pub const fn with(self, other: Effects) -> Effects {
        Effects(self.0 | other.0)
    }

    /// Whether rays cause others that have to wait.
    pub(crate) const fn cast_rays(self) -> bool {
        self.0 & Effects::MIRROR.with(Effects::GLASS).0 != 0
    }

    /// Places for waiting rays that pictures with these effects need at a ray depth: see [`work_depth`].
    pub const fn work_depth(self, depth: u8) -> usize {
        if depth > 0 && self.cast_rays() {
            work_depth(depth)
        } else {
            0
        }
    }

    /// The names of the effects in this set.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        Self::NAMED
            .into_iter()
            .filter(move |(effect, _)| self.contains(*effect))
            .map(|(_, name)| name)
    }
}

impl fmt::Display for Effects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::NONE {
            return f.write_str("none");
        }
        for (position, name) in self.names().enumerate() {
            if position > 0 {
                f.write_str(", ")?;
            }
            f.write_str(name)?;
        }
        Ok(())
    }
}
