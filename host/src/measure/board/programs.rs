//! Code and call stack of programs that were built for boards. The keys are board, number format and structure, and the
//! shapes, wider forms of storage and effects that a program has code for.
//!
//! The board tests write `programs.json`. Code is not a sum: the size of a part depends on the compiler's work on the
//! rest, by some percent of the program. So a program that was built is reported exactly. One that was not has
//! upper bounds.

use super::Board;
use super::bounds::{self, Parts};
use crate::measure::median;
use gridel_core::{Effects, Format, Kind, Structure};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The figures that the tests recorded.
const RECORDED: &str = include_str!("programs.json");
/// Placed parts, which scenes of a single blob have no code for.
const INSTANCES: &str = "instances";
/// Forms of storage and of colors that programs have code for, or have not.
const FORMS: [&str; 4] = ["wide-lattice", "wide-indices", INSTANCES, "display-values"];

/// Bytes of a linked program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Footprint {
    /// Flash without the blob: vectors, code, constants.
    pub code: u64,
    /// The deepest call path.
    pub call_stack: u64,
    /// RAM for the view of a part, where the program places parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part_view: Option<u64>,
}

/// A kind of figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    Code,
    CallStack,
}

impl Footprint {
    fn figure(&self, figure: Figure) -> u64 {
        match figure {
            Figure::Code => self.code,
            Figure::CallStack => self.call_stack,
        }
    }
}

/// The build profile of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    /// `opt-level = 3`.
    Fast,
    /// `opt-level = "z"` with the feature `small`.
    Small,
}

/// A program in both profiles, as far as it was built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Program {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fast: Option<Footprint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub small: Option<Footprint>,
}

impl Program {
    /// Returns its footprint in a profile.
    pub fn footprint(&self, profile: Profile) -> Option<Footprint> {
        match profile {
            Profile::Fast => self.fast,
            Profile::Small => self.small,
        }
    }
}

/// Programs by what they have code for, of a board, number format and structure.
type Built = BTreeMap<String, Program>;

/// All programs that were built.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Programs(BTreeMap<String, Built>);

/// The board, the number format and the structure of a program.
pub type ProgramKey<'p> = (&'p Board, Format, Structure);

/// A figure of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Known {
    pub bytes: u64,
    /// True if that very program was built. If not, it takes at most these bytes.
    pub measured: bool,
}

impl Programs {
    /// Returns the programs that the tests recorded.
    pub fn recorded() -> Self {
        serde_json::from_str(RECORDED).expect("a test reads the recorded programs")
    }

    /// Returns the program that was built with code for some parts and no others.
    pub fn get(&self, program_key: ProgramKey<'_>, parts: &[&str]) -> Option<&Program> {
        self.at(program_key)?.get(&key(parts))
    }

    /// Adds a program, and replaces earlier figures.
    pub fn insert(
        &mut self,
        program_key: ProgramKey<'_>,
        parts: &[&str],
        profile: Profile,
        footprint: Footprint,
    ) {
        let built = self.0.entry(key_text(program_key)).or_default();
        let program = built.entry(key(parts)).or_default();
        match profile {
            Profile::Fast => program.fast = Some(footprint),
            Profile::Small => program.small = Some(footprint),
        }
    }

    /// Keeps the programs whose parts a function accepts.
    pub fn retain(&mut self, keep: impl Fn(&[&str]) -> bool) {
        for built in self.0.values_mut() {
            built.retain(|key, _| keep(&key.split(' ').collect::<Vec<_>>()));
        }
    }

    fn at(&self, program_key: ProgramKey<'_>) -> Option<&Built> {
        self.0.get(&key_text(program_key))
    }

    /// Returns a figure of a program with code for some parts: measured, or an upper bound from other programs. `None` if
    /// none has code for all parts.
    pub fn figure(
        &self,
        program_key: ProgramKey<'_>,
        parts: &[&str],
        profile: Profile,
        figure: Figure,
    ) -> Option<Known> {
        let built = self.at(program_key)?;
        let of = |program: &Program| Some(program.footprint(profile)?.figure(figure));
        if let Some(bytes) = built.get(&key(parts)).and_then(of) {
            return Some(Known {
                bytes,
                measured: true,
            });
        }
        let known = built.iter();
        let known = known.filter_map(|(key, program)| Some((bits(key.split(' ')), of(program)?)));
        let known: Vec<_> = known.collect();
        let parts = bits(parts.iter().copied());
        let mut bound = bounds::from_more(&known, parts)?;
        // The call stack is that of the deepest path, to which most parts add nothing.
        if figure == Figure::Code {
            bound = bounds::from_less(&known, parts).map_or(bound, |sum| bound.min(sum));
        }
        Some(Known {
            bytes: bound.ceil() as u64,
            measured: false,
        })
    }

    /// Returns the RAM for the view of a part in a program with code for some parts, which is the same on all boards:
    /// measured, or at most that of programs with code for more. `None` where no such program was built.
    pub fn part_view(&self, parts: &[&str]) -> Option<u64> {
        let own = key(parts);
        let holds = |built: &str| {
            let built: Vec<&str> = built.split(' ').collect();
            parts.iter().all(|part| built.contains(part))
        };
        self.largest_part_view(|built| built == own)
            .or_else(|| self.largest_part_view(holds))
    }

    /// The largest view of a part among the programs whose key a function accepts.
    fn largest_part_view(&self, accepts: impl Fn(&str) -> bool) -> Option<u64> {
        let programs = self.0.values().flatten();
        let programs = programs.filter(|(key, _)| accepts(key));
        let footprints = programs.flat_map(|(_, program)| [program.fast, program.small]);
        footprints.flatten().filter_map(|it| it.part_view).max()
    }

    /// Returns the median of the bytes that a part adds, over programs that were built with and without it. `None`
    /// where there is no such pair.
    pub fn share(&self, program_key: ProgramKey<'_>, part: &str, profile: Profile) -> Option<u64> {
        let built = self.at(program_key)?;
        let code = |program: &Program| program.footprint(profile).map(|it| it.code);
        let added: Vec<f64> = built
            .iter()
            .filter_map(|(name, program)| {
                let parts: Vec<&str> = name.split(' ').collect();
                if !parts.contains(&part) {
                    return None;
                }
                let rest: Vec<&str> = parts.into_iter().filter(|it| *it != part).collect();
                let without = built.get(&key(&rest)).and_then(code)?;
                Some(code(program)?.saturating_sub(without) as f64)
            })
            .collect();
        median(&added).map(|bytes| bytes.round() as u64)
    }
}

/// Returns all that a program can have code for, in the order of the report.
pub fn parts() -> impl Iterator<Item = &'static str> {
    let kinds = Kind::ALL.map(Kind::name);
    kinds.into_iter().chain(FORMS).chain(Effects::ALL.names())
}

/// Returns all of them but instances: what the firmware's feature `everything` has code for.
pub fn everything() -> impl Iterator<Item = &'static str> {
    parts().filter(|&part| part != INSTANCES)
}

/// Returns parts as bits.
fn bits<'p>(required: impl Iterator<Item = &'p str>) -> Parts {
    let place = |part| parts().position(|it| it == part);
    required
        .filter_map(place)
        .fold(0, |bits, place| bits | 1 << place)
}

/// Returns the name of a program: its parts in their order.
fn key(required: &[&str]) -> String {
    let required = parts().filter(|part| required.contains(part));
    required.collect::<Vec<_>>().join(" ")
}

fn key_text((board, format, structure): ProgramKey<'_>) -> String {
    format!("{} {} {}", board.name, format.name(), structure.name())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::board::BOARDS;

    const PROGRAM: ProgramKey<'static> = (&BOARDS[0], Format::Fixed, Structure::DualSplit);

    fn programs(all: &[(&[&str], u64)]) -> Programs {
        let mut programs = Programs::default();
        for &(parts, code) in all {
            let footprint = Footprint {
                code,
                call_stack: 100,
                part_view: None,
            };
            programs.insert(PROGRAM, parts, Profile::Fast, footprint);
        }
        programs
    }

    fn code(programs: &Programs, parts: &[&str]) -> Option<Known> {
        programs.figure(PROGRAM, parts, Profile::Fast, Figure::Code)
    }

    #[test]
    fn program_that_was_built_is_reported_exactly() {
        let programs = programs(&[(&["sphere"], 1000), (&["sphere", "shadow"], 1200)]);
        let known = code(&programs, &["shadow", "sphere"]);
        assert_eq!(known.map(|it| (it.bytes, it.measured)), Some((1200, true)));
    }

    #[test]
    fn views_of_parts_are_those_of_the_program_or_of_programs_with_more() {
        let mut programs = Programs::default();
        for (board, parts, view) in [
            (0, &["sphere", INSTANCES][..], 196),
            (1, &["sphere", INSTANCES], 200),
            (0, &["sphere", "shadow", "mirror", INSTANCES], 332),
        ] {
            let footprint = Footprint {
                code: 1,
                call_stack: 1,
                part_view: Some(view),
            };
            let place = (&BOARDS[board], Format::Fixed, Structure::DualSplit);
            programs.insert(place, parts, Profile::Fast, footprint);
        }
        let view = |parts: &[&str]| programs.part_view(parts);
        assert_eq!(view(&[INSTANCES, "sphere"]), Some(200));
        assert_eq!(view(&["sphere", "shadow", INSTANCES]), Some(332));
        assert_eq!(view(&[INSTANCES]), Some(332));
        assert_eq!(view(&["torus", INSTANCES]), None);
    }

    #[test]
    fn program_that_was_not_built_takes_at_most_the_smaller_bound() {
        let mut all = vec![
            (&["sphere"][..], 1000),
            (&["sphere", "shadow", "mirror"], 1500),
        ];
        let known = code(&programs(&all), &["sphere", "shadow"]);
        assert_eq!(known.map(|it| (it.bytes, it.measured)), Some((1500, false)));
        all.extend([(&["disc"][..], 900), (&["disc", "shadow"], 1100)]);
        let programs = programs(&all);
        let known = code(&programs, &["sphere", "shadow"]);
        assert_eq!(known.map(|it| (it.bytes, it.measured)), Some((1200, false)));
    }

    #[test]
    fn bounds_of_recorded_programs_by_the_others_are_near() {
        let recorded = Programs::recorded();
        let mut excess = Vec::new();
        for (place, built) in &recorded.0 {
            for profile in [Profile::Fast, Profile::Small] {
                for (name, program) in built {
                    let Some(footprint) = program.footprint(profile) else {
                        continue;
                    };
                    let mut others = recorded.clone();
                    others.0.get_mut(place).unwrap().remove(name);
                    let others = others.0[place].iter();
                    let known = others.filter_map(|(key, program)| {
                        let code = program.footprint(profile)?.code;
                        Some((bits(key.split(' ')), code))
                    });
                    let known: Vec<_> = known.collect();
                    let parts = bits(name.split(' '));
                    if let Some(sum) = bounds::from_less(&known, parts) {
                        excess.push(sum / footprint.code as f64);
                    }
                }
            }
        }
        excess.sort_unstable_by(f64::total_cmp);
        let below = excess.iter().filter(|&&it| it < 1.0).count();
        assert!(
            excess.len() > 250 && below * 100 < 3 * excess.len(),
            "{below}"
        );
        assert!(
            0.92 < excess[0] && excess[excess.len() - 1] < 1.36,
            "{excess:?}"
        );
    }

    #[test]
    fn share_of_a_part_is_the_mean_of_two_middle_values() {
        let programs = programs(&[
            (&["sphere"], 1000),
            (&["sphere", "shadow"], 1100),
            (&["sphere", "mirror"], 2000),
            (&["sphere", "shadow", "mirror"], 2300),
        ]);
        let share = programs.share(PROGRAM, "shadow", Profile::Fast);
        assert_eq!(share, Some(200));
    }

    #[test]
    fn program_beyond_all_that_were_built_is_unknown() {
        let programs = programs(&[(&["sphere"], 1000)]);
        assert_eq!(code(&programs, &["sphere", "shadow"]), None);
        let small = programs.figure(PROGRAM, &["sphere"], Profile::Small, Figure::Code);
        assert_eq!(small, None);
        let elsewhere = (&BOARDS[1], Format::Fixed, Structure::DualSplit);
        let figure = programs.figure(elsewhere, &["sphere"], Profile::Fast, Figure::Code);
        assert_eq!(figure, None);
    }

    /// The records can be read, and the name of every program consists of parts.
    #[test]
    fn recorded_programs_have_known_parts() {
        let recorded: Programs = serde_json::from_str(RECORDED).unwrap();
        assert!(!recorded.0.is_empty());
        for name in recorded.0.values().flat_map(Built::keys) {
            let parts: Vec<&str> = name.split(' ').collect();
            assert_eq!(&key(&parts), name);
        }
    }
}
