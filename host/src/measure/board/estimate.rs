//! Code and call stack of a scene's program: measured, bounded, or scaled from a similar core.

use super::Board;
use super::account::Account;
use super::programs::{Figure, Known, Profile, Programs, everything};
use gridel_core::{Format, Structure};

/// The parts of a program that was built for every board, besides that of all parts.
pub const FEW: [&str; 3] = ["triangle", "sphere", "shadow"];

/// Prefix of items of code.
pub const CODE: &str = "code: ";

/// The item of the call stack, or its prefix.
pub const CALL_STACK: &str = "call stack";

pub const PROFILES: [Profile; 2] = [Profile::Fast, Profile::Small];

/// The scene's own sizes (depth of the stack, width, waiting rays) are constants of its program. They add up to 0.8 %
/// to code that was measured with others, so the estimate adds this part.
const OWN_SIZES: u64 = 100;

/// The bytes by which they change the call stack: the alignment of frames.
const FRAME_ALIGNMENT: u64 = 8;

/// The program of a scene on a board, estimated from measured programs.
pub struct ProgramEstimate<'p> {
    pub programs: &'p Programs,
    pub here: (&'static Board, Format),
    /// A similar core, on which most programs were built.
    pub similar: (&'static Board, Format),
    pub structure: Structure,
    pub parts: &'p [&'p str],
}

impl ProgramEstimate<'_> {
    pub fn code(&self, profile: Profile) -> Option<Known> {
        // A structure adds the same to one program as to others.
        let code = self.figure(profile, Figure::Code, |bytes, [other, dual_split]| {
            (bytes + other).saturating_sub(dual_split)
        });
        code.map(|code| Known {
            bytes: code.bytes + code.bytes.div_ceil(OWN_SIZES),
            ..code
        })
    }

    pub fn call_stack(&self, profile: Profile) -> Option<Known> {
        let call_stack = self.figure(profile, Figure::CallStack, |bytes, [other, dual_split]| {
            (bytes * other).div_ceil(dual_split.max(1))
        });
        call_stack.map(|known| Known {
            bytes: known.bytes + FRAME_ALIGNMENT,
            ..known
        })
    }

    /// Returns true if the figures are upper bounds from other programs.
    pub fn is_bounded(&self) -> bool {
        let is_measured = |(board, format): (&Board, Format), structure| {
            let place = (board, format, structure);
            let known = self
                .programs
                .figure(place, self.parts, Profile::Fast, Figure::Code);
            known.is_some_and(|known| known.measured)
        };
        !is_measured(self.here, self.structure) && !is_measured(self.similar, Structure::DualSplit)
    }

    /// Returns a figure of the program. `through` converts it to another structure, by the figures of all parts through
    /// that one and through dual-split nodes.
    fn figure(
        &self,
        profile: Profile,
        figure: Figure,
        through: fn(u64, [u64; 2]) -> u64,
    ) -> Option<Known> {
        let Self {
            programs,
            here,
            similar,
            structure,
            parts: required,
        } = *self;
        let of = |(board, format): (&Board, Format), structure, parts: &[&str]| {
            programs.figure((board, format, structure), parts, profile, figure)
        };
        let built = |place, structure, parts: &[&str]| {
            let known = of(place, structure, parts).filter(|known| known.measured);
            known.map(|known| known.bytes)
        };
        if let Some(bytes) = built(here, structure, required) {
            return Some(Known {
                bytes,
                measured: true,
            });
        }
        let known = of(similar, Structure::DualSplit, required)?;
        let everything: Vec<&str> = everything().collect();
        let mut bytes = known.bytes;
        if structure != Structure::DualSplit {
            let both = [structure, Structure::DualSplit].map(|it| built(similar, it, &everything));
            let [Some(other), Some(dual_split)] = both else {
                return None;
            };
            bytes = through(bytes, [other, dual_split]);
        }
        if here != similar {
            let ratios = [&everything[..], &FEW].into_iter().filter_map(|parts| {
                let [here, there] =
                    [here, similar].map(|it| built(it, Structure::DualSplit, parts));
                Some(here? as f64 / there?.max(1) as f64)
            });
            let ratio = ratios.reduce(f64::max)?;
            bytes = (bytes as f64 * ratio).ceil() as u64;
        }
        Some(Known {
            bytes,
            measured: known.measured && here == similar && structure == Structure::DualSplit,
        })
    }

    /// Lists the code of the fast program, by part as far as parts can be separated.
    pub fn list_code(&self, flash: &mut Account) {
        const COMMON: &str = "loading, diffuse light";
        let (board, format) = self.similar;
        let place = (board, format, Structure::DualSplit);
        let Some(code) = self.code(Profile::Fast) else {
            flash.add(format!("{CODE}{COMMON}, {}", self.parts.join(", ")), None);
            return;
        };
        let how = match code.measured {
            true => "",
            false => ", at most",
        };
        let mut rest = code.bytes;
        let mut shares = Vec::new();
        for &part in self.parts {
            let share = self.programs.share(place, part, Profile::Fast);
            if let Some(share) = share.filter(|&share| 0 < share && share < rest) {
                rest -= share;
                shares.push((part, share));
            }
        }
        flash.add(format!("{CODE}{COMMON}{how}"), Some(rest));
        for (part, share) in shares {
            flash.add(format!("{CODE}{part}"), Some(share));
        }
    }
}
