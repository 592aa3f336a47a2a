//! The memory report: what a scene takes on a board, in flash and in RAM, and what remains.
//!
//! Sizes of the blob and of working memory are exact. Code and call stack are those of programs that the
//! project's tests built for boards ([`Programs`]), in two profiles: a fast one, and one with the feature
//! `small`, both linked with `lto = "fat"` and `codegen-units = 1`. Code is that of the fast program; the
//! call stack is the larger of both. A program that was not built is bounded by the smallest with code
//! for more, and the report says so.
//!
//! On one board of each kind of core many programs were built. For other boards, and for structures other
//! than dual-split nodes, the figures are scaled by programs that were built for both.
//!
//! What is not known is no 0: it makes the sum unknown, and whether the scene fits undecided.

use super::programs::{Footprint, Known, Profile, Programs, parts};
use super::{MemoryMap, grouped, working_memory};
use crate::blob::best_structures;
use crate::board::Board;
use gridel_core::accel::Entry;
use gridel_core::{Effects, Format, Kind, Prevalidated, Rgb565, Scene, Structure};
use serde::Serialize;

/// A program that was built for every board, beside that of all parts.
const FEW: [&str; 3] = ["triangle", "sphere", "shadow"];

/// How items of code begin.
const CODE: &str = "code: ";

/// Memory of a board that a scene is to fit into.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    pub board: &'static Board,
    /// Bytes for the program, the board's or fewer.
    pub flash: u64,
    /// Bytes of RAM.
    pub ram: u64,
}

/// Flash and RAM of a scene on a board.
#[derive(Clone, Debug, Serialize)]
pub struct Ledger {
    pub board: &'static str,
    pub core: &'static str,
    pub format: &'static str,
    /// What walks the rays.
    pub structure: &'static str,
    /// The core and number format on which parts and structures were measured.
    pub measured_on: String,
    /// Whether the scene's own program was built and measured, in both profiles.
    pub measured: bool,
    pub flash: Account,
    pub ram: Account,
    /// The scene's program, built for speed.
    pub fast: Sizes,
    /// The same with the feature `small`.
    pub small: Sizes,
}

/// Bytes of a program; `None` for what is not known.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Sizes {
    pub code: Option<u64>,
    pub call_stack: Option<u64>,
}

/// Whether a scene fits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fit {
    Fits,
    /// What is short, and by how much.
    Short(String),
    /// What is not known.
    Undecided(String),
}

/// A structure of which nothing was measured on boards.
#[derive(Clone, Copy, Debug)]
pub struct NotMeasured(pub Structure);

/// One kind of memory: what there is, and what takes it.
#[derive(Clone, Debug, Serialize)]
pub struct Account {
    pub available: u64,
    /// Bytes of all items; `None` where one of them is not known.
    pub used: Option<u64>,
    pub items: Vec<Item>,
}

/// Something that takes memory.
#[derive(Clone, Debug, Serialize)]
pub struct Item {
    pub what: String,
    /// `None` where they are not known.
    pub bytes: Option<u64>,
}

impl Account {
    fn new(available: u64) -> Self {
        Self {
            available,
            used: Some(0),
            items: Vec::new(),
        }
    }

    /// Bytes of the items that are known.
    fn at_least(&self) -> u64 {
        self.items.iter().filter_map(|item| item.bytes).sum()
    }

    /// Bytes that are missing at the least, 0 where what is known fits.
    pub fn missing(&self) -> u64 {
        self.at_least().saturating_sub(self.available)
    }

    /// Bytes that remain, 0 where it does not fit; `None` where that is not known.
    pub fn remains(&self) -> Option<u64> {
        self.used.map(|used| self.available.saturating_sub(used))
    }

    /// The items that are not known.
    pub fn unknown(&self) -> impl Iterator<Item = &str> {
        let unknown = self.items.iter().filter(|item| item.bytes.is_none());
        unknown.map(|item| item.what.as_str())
    }

    fn add(&mut self, what: impl Into<String>, bytes: Option<u64>) {
        let what = what.into();
        self.used = self.used.zip(bytes).map(|(sum, bytes)| sum + bytes);
        self.items.push(Item { what, bytes });
    }
}

impl Ledger {
    /// The structures that were measured: those that firmware can vouch for.
    pub const STRUCTURES: [Structure; 4] = Prevalidated::STRUCTURES;

    /// The ledger of a scene that `blob` holds, in one of the board's number formats, through the
    /// best structure that the blob holds.
    ///
    /// # Errors
    /// If that is none of [`Self::STRUCTURES`].
    pub fn of(
        scene: &Scene<'_>,
        blob: &[u8],
        target: &Target,
        format: Format,
    ) -> Result<Self, NotMeasured> {
        Self::by(&Programs::recorded(), scene, blob, target, format)
    }

    /// The same, with figures of programs of one's own.
    fn by(
        programs: &Programs,
        scene: &Scene<'_>,
        blob: &[u8],
        target: &Target,
        format: Format,
    ) -> Result<Self, NotMeasured> {
        let board = target.board;
        let structure = best_structures(scene).next().unwrap_or(Structure::List);
        if !Self::STRUCTURES.contains(&structure) {
            return Err(NotMeasured(structure));
        }
        let called_for: Vec<&str> = scene.features().collect();
        let program = ScenesProgram {
            programs,
            here: (board, format),
            kin: board.kin(format),
            structure,
            parts: &called_for,
        };
        let (mut flash, mut ram) = (Account::new(target.flash), Account::new(target.ram));
        for part in MemoryMap::of(scene, blob).parts {
            if part.bytes > 0 {
                flash.add(format!("blob: {}", part.kind), Some(part.bytes as u64));
            }
        }
        program.list_code(&mut flash);

        let words = working_memory(scene);
        let need = words
            .iter()
            .find(|need| need.word_bits == 32 && need.format == format.name());
        ram.add(
            format!("traversal stack, {} entries", scene.stack_depth()),
            need.map(|need| need.stack as u64),
        );
        ram.add(
            "work list",
            need.map(|need| (need.workspace - need.stack) as u64),
        );
        let width = scene.view().width;
        let row = u64::from(width) * size_of::<Rgb565>() as u64;
        ram.add(format!("row of {width} pixels, RGB565"), Some(row));
        let stacks = PROFILES.map(|profile| program.call_stack(profile));
        let deepest = stacks[0].zip(stacks[1]);
        let measured = |known: Option<Known>| known.is_some_and(|known| known.measured);
        let all_measured = stacks.into_iter().all(measured);
        let how = match all_measured {
            true => "call stack",
            false => "call stack, at most",
        };
        ram.add(
            how,
            deepest.map(|(fast, small)| fast.bytes.max(small.bytes)),
        );
        let (kin, kins_format) = program.kin;
        let [fast, small] = PROFILES.map(|profile| Sizes {
            code: program.code(profile).map(|known| known.bytes),
            call_stack: program.call_stack(profile).map(|known| known.bytes),
        });
        Ok(Self {
            board: board.name,
            core: board.core,
            format: format.name(),
            structure: structure.name(),
            measured_on: format!("{} in {}", kin.core, kins_format.name()),
            measured: all_measured && measured(program.code(Profile::Fast)),
            flash,
            ram,
            fast,
            small,
        })
    }

    /// The builds that the figures hold for.
    pub fn holds_for(&self) -> String {
        let Self { fast, small, .. } = self;
        let bytes = |bytes: Option<u64>| bytes.map_or(String::from("unknown"), grouped);
        let own = format!("{} in {}", self.core, self.format);
        let how = match (&self.measured_on, self.measured) {
            (_, true) => String::from("\nThis program was built and measured."),
            (there, false) if *there != own => {
                format!("\nThe figures are scaled from those of a {there}.")
            }
            (_, false) => String::from(
                "\nThis program was not built: the figures are those of a program with code for more, an \
                 upper\nbound.",
            ),
        };
        format!(
            "For programs linked with lto = \"fat\" and codegen-units = 1. Code is that of opt-level = 3. The \
             call stack\nis enough for that, which takes {} bytes, and for the feature `small` with \
             opt-level = \"z\", which takes\n{}, and {} bytes of code. Other profiles were not \
             measured and may take more.{how}",
            bytes(fast.call_stack),
            bytes(small.call_stack),
            bytes(small.code)
        )
    }

    /// Whether the scene fits, and why not.
    pub fn fit(&self) -> Fit {
        let accounts = [("flash", &self.flash), ("RAM", &self.ram)];
        let short: Vec<_> = accounts
            .into_iter()
            .filter(|(_, account)| account.missing() > 0)
            .map(|(what, account)| {
                let least = match account.used {
                    Some(_) => "",
                    None => "at least ",
                };
                format!(
                    "{least}{} bytes of {what}, {} more than the {} there are",
                    grouped(account.at_least()),
                    grouped(account.missing()),
                    grouped(account.available)
                )
            })
            .collect();
        if !short.is_empty() {
            return Fit::Short(format!("the scene takes {}", short.join(", and ")));
        }
        match self.undecided() {
            Some(why) => Fit::Undecided(format!("whether the scene fits is undecided: {why}")),
            None => Fit::Fits,
        }
    }

    /// What is not known, and why. `None` where all is.
    pub fn undecided(&self) -> Option<String> {
        let accounts = [("flash", &self.flash), ("RAM", &self.ram)];
        let unknown: Vec<_> = accounts
            .into_iter()
            .flat_map(|(what, account)| {
                let items = account.unknown();
                items.map(move |item| format!("the bytes of {what} for `{item}`"))
            })
            .collect();
        (!unknown.is_empty()).then(|| {
            format!(
                "{} are unknown, because no such program was built for a {} in {} through {}",
                unknown.join(" and "),
                self.core,
                self.format,
                self.structure
            )
        })
    }

    /// What would save memory of the kind that is short, by the scene's own figures; `smaller` tells
    /// what makes the blob smaller, which takes time.
    pub fn advice(&self, scene: &Scene<'_>, smaller: impl FnOnce() -> Option<String>) -> String {
        let mut steps = Vec::new();
        if self.ram.missing() > 0 {
            steps.extend(self.ram_advice(scene));
        }
        if self.flash.missing() > 0 {
            steps.extend(self.flash_advice(scene));
            steps.push(match smaller() {
                // Code is another matter: flagged sides take more of it.
                Some(smaller) => format!("of the blob itself, {smaller}"),
                None => {
                    String::from("the scene file in place of the blob tells what makes it smaller")
                }
            });
        }
        steps.join("; ")
    }

    /// What makes RAM smaller.
    pub fn ram_advice(&self, scene: &Scene<'_>) -> Vec<String> {
        let view = scene.view();
        let place = if self.format == Format::F64.name() {
            80
        } else {
            40
        };
        let mut steps = Vec::new();
        let places = scene.effects().work_depth(view.depth) as u64;
        if places > 0 {
            steps.push(format!(
                "a ray depth of {} in place of {} saves {place} bytes, and a scene without mirrors and \
                 glass {}",
                view.depth - 1,
                view.depth,
                place * places
            ));
        }
        steps.extend(self.small_advice());
        // Where flash is short, too, it is named there.
        if scene.stack_depth() > 0 && self.flash.missing() == 0 {
            steps.push(format!(
                "`--accel list` saves {} bytes of traversal stack and costs time",
                scene.stack_depth() * size_of::<Entry>()
            ));
        }
        steps.push(String::from("a narrower picture"));
        steps
    }

    /// What makes the call stack smaller.
    pub fn call_stack_advice(&self, scene: &Scene<'_>) -> Vec<String> {
        let effects = scene.effects();
        let effects = (effects != Effects::NONE)
            .then(|| format!("a scene that does without some of its effects ({effects})"));
        self.small_advice().into_iter().chain(effects).collect()
    }

    /// What the call stack takes less without the feature `small`.
    fn small_advice(&self) -> Option<String> {
        let stacks = self.fast.call_stack.zip(self.small.call_stack);
        let (fast, small) = stacks.filter(|(fast, small)| fast < small)?;
        Some(format!(
            "without the feature `small` the call stack takes {} bytes less",
            grouped(small - fast)
        ))
    }

    /// What makes flash smaller, the blob apart.
    pub fn flash_advice(&self, scene: &Scene<'_>) -> Vec<String> {
        let mut steps = Vec::new();
        let code = self.fast.code.zip(self.small.code);
        if let Some((fast, small)) = code.filter(|(fast, small)| small < fast) {
            steps.push(format!(
                "with the feature `small` and opt-level = \"z\" code takes {} bytes in place of {}, \
                 and rays take longer",
                grouped(small),
                grouped(fast)
            ));
        }
        if scene.vertices() > 1 << 16 {
            let saved = 6 * scene.count(Kind::Triangle);
            steps.push(format!(
                "at most 65,536 vertices would make indices narrower and save {} bytes",
                grouped(saved)
            ));
        }
        if scene.effects() != Effects::NONE {
            steps.push(format!(
                "a scene that does without some of its effects ({})",
                scene.effects()
            ));
        }
        steps
    }
}

/// The scene's own sizes (depth of the stack, width, waiting rays) are constants of its program, which add
/// up to 0.8 % to code that was measured with others: this part is allowed for.
const OWN_SIZES: u64 = 100;

const PROFILES: [Profile; 2] = [Profile::Fast, Profile::Small];

/// The program of a scene on a board, by what is known of programs.
struct ScenesProgram<'p> {
    programs: &'p Programs,
    here: (&'static Board, Format),
    /// Where most programs were built.
    kin: (&'static Board, Format),
    structure: Structure,
    parts: &'p [&'p str],
}

impl ScenesProgram<'_> {
    fn code(&self, profile: Profile) -> Option<Known> {
        // What a structure adds to one program it adds to others.
        let code = self.figure(
            profile,
            |it| it.code,
            |bytes, [other, dual_split]| (bytes + other).saturating_sub(dual_split),
        );
        code.map(|code| Known {
            bytes: code.bytes + code.bytes.div_ceil(OWN_SIZES),
            ..code
        })
    }

    fn call_stack(&self, profile: Profile) -> Option<Known> {
        self.figure(
            profile,
            |it| it.call_stack,
            |bytes, [other, dual_split]| (bytes * other).div_ceil(dual_split.max(1)),
        )
    }

    /// A figure of the program; `through` makes it one for another structure, by the figures of all
    /// parts through that and through dual-split nodes.
    fn figure(
        &self,
        profile: Profile,
        figure: fn(&Footprint) -> u64,
        through: fn(u64, [u64; 2]) -> u64,
    ) -> Option<Known> {
        let Self {
            programs,
            here,
            kin,
            structure,
            parts: called_for,
        } = *self;
        let of = |(board, format): (&Board, Format), structure, parts: &[&str]| {
            programs.figure((board, format, structure), parts, profile, figure)
        };
        let built = |place, structure, parts: &[&str]| {
            let known = of(place, structure, parts).filter(|known| known.measured);
            known.map(|known| known.bytes)
        };
        if let Some(bytes) = built(here, structure, called_for) {
            return Some(Known {
                bytes,
                measured: true,
            });
        }
        let known = of(kin, Structure::DualSplit, called_for)?;
        let everything: Vec<&str> = parts().collect();
        let mut bytes = known.bytes;
        if structure != Structure::DualSplit {
            let both = [structure, Structure::DualSplit].map(|it| built(kin, it, &everything));
            let [Some(other), Some(dual_split)] = both else {
                return None;
            };
            bytes = through(bytes, [other, dual_split]);
        }
        if here != kin {
            let ratios = [&everything[..], &FEW].into_iter().filter_map(|parts| {
                let [here, there] = [here, kin].map(|it| built(it, Structure::DualSplit, parts));
                Some(here? as f64 / there?.max(1) as f64)
            });
            let ratio = ratios.reduce(f64::max)?;
            bytes = (bytes as f64 * ratio).ceil() as u64;
        }
        Some(Known {
            bytes,
            measured: known.measured && here == kin && structure == Structure::DualSplit,
        })
    }

    /// Lists the code of the fast program, by part as far as it can be told apart.
    fn list_code(&self, flash: &mut Account) {
        const COMMON: &str = "loading, diffuse light";
        let (board, format) = self.kin;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::BOARDS;
    use crate::compile::{Options, compile};

    const STRUCTURE: Structure = Structure::DualSplit;

    /// A ball under a light, on the smallest board, with programs of one's own.
    fn ledger(programs: &Programs, flash: u64) -> Ledger {
        let text = "light = [{ kind = \"directional\", direction = [0, 0, -1] }]\n\
                    object = [{ kind = \"sphere\", center = [0, 0, 0], radius = 1 }]\n";
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ball.toml");
        std::fs::write(&path, text).unwrap();
        let imported = crate::scene::load(&path, &Default::default()).unwrap();
        let compiled = compile(&imported.scene, &Options::default()).unwrap();
        let scene = compiled.blob.scene().unwrap();
        let features: Vec<&str> = scene.features().collect();
        assert_eq!(features, PARTS);
        let board = &BOARDS[0];
        let target = Target {
            board,
            flash,
            ram: board.ram,
        };
        Ledger::by(
            programs,
            &scene,
            compiled.blob.bytes(),
            &target,
            Format::Fixed,
        )
        .unwrap()
    }

    const PARTS: [&str; 3] = ["sphere", "wide-lattice", "shadow"];
    const SIZES: [Footprint; 2] = [
        Footprint {
            code: 30_000,
            call_stack: 1000,
        },
        Footprint {
            code: 20_000,
            call_stack: 1500,
        },
    ];

    fn programs(board: &'static Board, parts: &[&str], profiles: &[Profile]) -> Programs {
        let mut programs = Programs::default();
        for (profile, footprint) in PROFILES.into_iter().zip(SIZES) {
            if profiles.contains(&profile) {
                let place = (board, Format::Fixed, STRUCTURE);
                programs.insert(place, parts, profile, footprint);
            }
        }
        programs
    }

    fn bytes(account: &Account, word: &str) -> Option<u64> {
        let items = account
            .items
            .iter()
            .filter(|item| item.what.starts_with(word));
        items.map(|item| item.bytes).sum()
    }

    #[test]
    fn measured_program_is_told_exactly() {
        let ledger = ledger(&programs(&BOARDS[0], &PARTS, &PROFILES), 128 << 10);
        assert!(ledger.measured);
        assert_eq!(bytes(&ledger.flash, CODE), Some(30_300));
        assert_eq!(bytes(&ledger.ram, "call stack"), Some(1500));
        assert_eq!(ledger.fit(), Fit::Fits);
    }

    #[test]
    fn unknown_figures_are_unknown_and_leave_the_fit_undecided() {
        let elsewhere = programs(&BOARDS[1], &PARTS, &PROFILES);
        let fast = programs(&BOARDS[0], &PARTS, &PROFILES[..1]);
        let fewer = programs(&BOARDS[0], &PARTS[..2], &PROFILES);
        for (programs, code) in [
            (Programs::default(), None),
            (elsewhere, None),
            (fewer, None),
            (fast, Some(30_300)),
        ] {
            let ledger = ledger(&programs, 128 << 10);
            assert!(!ledger.measured);
            assert_eq!(bytes(&ledger.flash, CODE), code);
            assert_eq!(bytes(&ledger.ram, "call stack"), None);
            assert_eq!((ledger.ram.used, ledger.ram.remains()), (None, None));
            assert_eq!(ledger.flash.used.is_some(), code.is_some());
            match ledger.fit() {
                Fit::Undecided(why) => assert!(why.contains("call stack"), "{why}"),
                other => panic!("{other:?}"),
            }
            let json = serde_json::to_value(&ledger).unwrap();
            assert!(json["ram"]["used"].is_null() && json["small"]["call_stack"].is_null());
        }
    }

    /// What is known may be too much by itself.
    #[test]
    fn unknown_figures_do_not_hide_what_is_short() {
        let ledger = ledger(&Programs::default(), 100);
        match ledger.fit() {
            Fit::Short(why) => assert!(why.contains("at least"), "{why}"),
            other => panic!("{other:?}"),
        }
    }

    /// Other boards' figures are scaled by what was built on both, and unknown without.
    #[test]
    fn other_boards_are_scaled_or_unknown() {
        let mut recorded = programs(&BOARDS[0], &PARTS, &PROFILES);
        let program = |recorded: &Programs| {
            let scenes = ScenesProgram {
                programs: recorded,
                here: (&BOARDS[3], Format::Fixed),
                kin: BOARDS[3].kin(Format::Fixed),
                structure: STRUCTURE,
                parts: &PARTS,
            };
            scenes.code(Profile::Fast)
        };
        assert_eq!(program(&recorded), None);
        for (board, code) in [(&BOARDS[0], 40_000), (&BOARDS[3], 44_000)] {
            let place = (board, Format::Fixed, STRUCTURE);
            let footprint = Footprint { code, ..SIZES[0] };
            recorded.insert(place, &FEW, Profile::Fast, footprint);
        }
        let known = program(&recorded);
        assert_eq!(
            known.map(|it| (it.bytes, it.measured)),
            Some((33_330, false))
        );
    }
}
