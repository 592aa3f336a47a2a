//! The memory report: the flash and RAM of a scene on a board, by part, and the rest.
//!
//! Sizes of the blob and of working memory are exact. Code and call stack are those of programs that the project's
//! tests built for boards ([`Programs`]). They are built in two profiles: a fast one, and one with the feature `small`,
//! both linked with `lto = "fat"` and `codegen-units = 1`. Code is that of the fast program; the call stack is the
//! larger of both. A program that was not built is bounded by others, and the report says so.
//!
//! On one board of each kind of core many programs were built. For other boards, and for structures other
//! than dual-split nodes, the figures are scaled by programs that were built for both.
//!
//! An unknown figure does not count as 0: the sum becomes unknown, and so does whether the scene fits.

use super::Board;
use super::account::Account;
use super::estimate::{CALL_STACK, CODE, PROFILES, ProgramEstimate};
use super::programs::{Known, Profile, Programs};
use super::rendering::Rendering;
use super::working;
use crate::measure::bytes::{MemoryMap, board_memory};
use crate::state::raised_materials;
use crate::table::{counted, grouped};
use gridel_core::format::track::Track;
use gridel_core::{Prevalidated, Rgb565, Scene, Structure, Tracks};
use serde::Serialize;

/// Why figures of code and call stack are upper bounds.
pub const NOT_BUILT: &str =
    "the figures are upper bounds from other programs, as its own was not built";

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
pub struct MemoryReport {
    pub board: &'static str,
    pub core: &'static str,
    pub format: &'static str,
    /// The structure that rays walk through.
    pub structure: &'static str,
    /// The core and number format on which parts and structures were measured.
    pub measured_on: String,
    /// The emulated board whose core is of the same kind and whose figures these are, if it is not the board itself.
    pub kind: Option<&'static str>,
    /// True if tracks move the camera, lights or materials: the code that plays these is not counted.
    pub plays_tracks: bool,
    /// True if the scene's own program was built and measured, in both profiles.
    pub measured: bool,
    /// True if the figures of code and call stack are upper bounds from other programs.
    pub is_bounded: bool,
    pub flash: Account,
    pub ram: Account,
    /// The scene's program, built for speed.
    pub fast: Sizes,
    /// The report with the feature `small`.
    pub small: Sizes,
}

/// Bytes of a program; `None` for unknown figures.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Sizes {
    pub code: Option<u64>,
    pub call_stack: Option<u64>,
}

/// The verdict whether a scene fits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fit {
    Fits,
    /// The kinds of memory that are short, and by how much.
    Short(String),
    /// The parts that are not known.
    Undecided(String),
}

/// The item of places for waiting rays.
pub const WORK_LIST: &str = "work list";

/// A structure that was not measured on boards.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("{} was not measured on boards: nothing is known of its code and call stack", .0.name())]
pub struct NotMeasured(pub Structure);

impl NotMeasured {
    /// Returns the remedy: the structures that were measured.
    pub fn remedy(&self) -> String {
        let measured = MemoryReport::STRUCTURES.map(Structure::name).join(", ");
        format!("build the scene for one of {measured} instead")
    }
}

impl MemoryReport {
    /// The structures that were measured: those that firmware can prevalidate.
    pub const STRUCTURES: [Structure; 4] = Prevalidated::STRUCTURES;

    /// Returns the report of a scene in `blob`, as a program renders it.
    ///
    /// # Errors
    /// If the structure is not one of [`Self::STRUCTURES`].
    ///
    /// ```
    /// # use gridel_host::compile::{Options, compile};
    /// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
    /// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
    /// # let blob = compile(&imported.scene, &Options::default())?.blob;
    /// # let scene = blob.scene()?;
    /// use gridel_core::Format;
    /// use gridel_host::measure::board::{Board, Fit, MemoryReport, Rendering, Target};
    ///
    /// let board = Board::named("stm32vldiscovery").ok_or("unknown board")?;
    /// let target = Target {
    ///     board,
    ///     flash: board.flash,
    ///     ram: board.ram,
    /// };
    /// let rendering = Rendering::of(&scene, Format::Fixed);
    /// let report = MemoryReport::of(&scene, blob.bytes(), &target, &rendering)?;
    /// assert!(matches!(report.fit(), Fit::Fits));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(
        scene: &Scene<'_>,
        blob: &[u8],
        target: &Target,
        rendering: &Rendering,
    ) -> Result<Self, NotMeasured> {
        // Firmware plays the blob's tracks as well.
        let raised = raised_materials(scene, blob);
        let moving = scene.with_materials(&raised);
        let moving = moving.as_ref().unwrap_or(scene);
        Self::by(&Programs::recorded(), moving, blob, target, rendering)
    }

    /// Returns the report with figures of programs of your own.
    fn by(
        programs: &Programs,
        scene: &Scene<'_>,
        blob: &[u8],
        target: &Target,
        rendering: &Rendering,
    ) -> Result<Self, NotMeasured> {
        let board = target.board;
        let &Rendering {
            format,
            structure,
            width,
        } = rendering;
        if !Self::STRUCTURES.contains(&structure) {
            return Err(NotMeasured(structure));
        }
        let required: Vec<&str> = scene.features().collect();
        let program = ProgramEstimate {
            programs,
            here: (board.measured_on(), format),
            similar: board.similar(format),
            structure,
            parts: &required,
        };
        let (mut flash, mut ram) = (Account::new(target.flash), Account::new(target.ram));
        for part in MemoryMap::of(scene, blob).parts {
            if part.bytes > 0 {
                flash.add(format!("blob: {}", part.kind), Some(part.bytes as u64));
            }
        }
        program.list_code(&mut flash);
        for row in working::rows(programs, scene, blob) {
            ram.add(row.what, row.bytes);
        }
        let need = board_memory(scene, format, scene.view().depth);
        ram.add(
            format!("traversal stack, {}", counted(scene.stack_depth(), "entry")),
            Some(need.stack as u64),
        );
        ram.add(WORK_LIST, Some((need.workspace - need.stack) as u64));
        let row = u64::from(width) * size_of::<Rgb565>() as u64;
        ram.add(format!("row of {width} pixels, RGB565"), Some(row));
        let stacks = PROFILES.map(|profile| program.call_stack(profile));
        let deepest = stacks[0].zip(stacks[1]);
        let measured = |known: Option<Known>| known.is_some_and(|known| known.measured);
        let all_measured = stacks.into_iter().all(measured);
        let how = match all_measured {
            true => "",
            false => ", at most",
        };
        ram.add(
            format!("{CALL_STACK}{how}"),
            deepest.map(|(fast, small)| fast.bytes.max(small.bytes)),
        );
        let (similar, its_format) = program.similar;
        let [fast, small] = PROFILES.map(|profile| Sizes {
            code: program.code(profile).map(|known| known.bytes),
            call_stack: program.call_stack(profile).map(|known| known.bytes),
        });
        Ok(Self {
            board: board.name,
            core: board.core,
            format: format.name(),
            structure: structure.name(),
            measured_on: format!("{} in {}", similar.core, its_format.name()),
            kind: (!board.is_emulated()).then_some(board.measured),
            plays_tracks: plays_tracks(blob),
            measured: all_measured && measured(program.code(Profile::Fast)),
            is_bounded: program.is_bounded(),
            flash,
            ram,
            fast,
            small,
        })
    }

    /// Bytes of the code of one part, such as an effect, in the fast program; `None` where no programs were built with
    /// and without it.
    pub fn code_of(&self, part: &str) -> Option<u64> {
        let name = format!("{CODE}{part}");
        let item = self.flash.items.iter().find(|item| item.what == name);
        item.and_then(|item| item.bytes)
    }

    /// Returns the builds that the figures hold for.
    pub fn holds_for(&self) -> String {
        let Self { fast, small, .. } = self;
        let bytes = |bytes: Option<u64>| bytes.map_or(String::from("unknown"), grouped);
        let own = match self.kind.and_then(Board::named) {
            Some(kind) => format!("{} in {}", kind.core, self.format),
            None => format!("{} in {}", self.core, self.format),
        };
        let how = match (&self.measured_on, self.measured) {
            (_, true) => String::from("\nThis program was built and measured."),
            (there, false) if *there != own => {
                format!("\nThe figures are scaled from those of a {there}.")
            }
            (_, false) => String::from(
                "\nThis program was not built: the figures are upper bounds from other programs.",
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
        ) + &self.kind_of_core()
            + match self.plays_tracks {
                true => {
                    "\nThe code that plays tracks of camera, lights and materials is not counted."
                }
                false => "",
            }
    }

    /// Names the board that the figures come from, where it is another one.
    fn kind_of_core(&self) -> String {
        let Some(kind) = self.kind.and_then(Board::named) else {
            return String::new();
        };
        format!(
            "\nThe {}'s core is a {}. The figures are those of {}, a {} in QEMU: a core of the same kind.\n\
             A start-up program of the chip's maker takes flash of its own.",
            self.board, self.core, kind.name, kind.core
        )
    }

    /// Returns whether the scene fits, and why not.
    pub fn fit(&self) -> Fit {
        let accounts = [("flash", &self.flash), ("RAM", &self.ram)];
        let short: Vec<_> = accounts
            .into_iter()
            .filter(|(_, account)| account.missing() > 0)
            .collect();
        let undecided = |why: String| format!("whether the scene fits is undecided: {why}");
        if short.is_empty() {
            return match self.undecided() {
                Some(why) => Fit::Undecided(undecided(why)),
                None => Fit::Fits,
            };
        }
        let shortages = short.iter().map(|(what, account)| {
            let how = match account.used {
                None => "at least ",
                Some(_) if self.may_fit(account) => "at most ",
                Some(_) => "",
            };
            format!(
                "{how}{} bytes of {what}, {} more than the {} there are",
                grouped(account.at_least()),
                grouped(account.missing()),
                grouped(account.available)
            )
        });
        let shortages: Vec<_> = shortages.collect();
        let takes = format!("the scene takes {}", shortages.join(", and "));
        match short.iter().all(|(_, account)| self.may_fit(account)) {
            true => Fit::Undecided(undecided(format!("{takes}, and {NOT_BUILT}"))),
            false => Fit::Short(takes),
        }
    }

    /// Returns true if memory may be enough although it is less than the figures, because those of code and call stack
    /// are upper bounds.
    pub fn may_fit(&self, account: &Account) -> bool {
        let is_bound = |what: &str| what.starts_with(CODE) || what.starts_with(CALL_STACK);
        let bounds = account.items.iter().filter(|item| is_bound(&item.what));
        let bounds: u64 = bounds.filter_map(|item| item.bytes).sum();
        self.is_bounded && account.at_least() - bounds <= account.available
    }

    /// Returns the parts that are not known, and why; `None` if all are.
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
}

/// Returns true if a blob has tracks of the camera, lights or materials.
fn plays_tracks(blob: &[u8]) -> bool {
    // They were checked with the scene.
    let tracks = Tracks::from_bytes(blob).map_or(&[][..], |tracks| tracks.tracks());
    let mut targets = tracks.iter().filter_map(Track::target);
    targets.any(|it| it.is_of_camera() || it.is_of_light() || it.is_of_material())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::measure::board::BOARDS;
    use crate::measure::board::estimate::{CODE, FEW};
    use crate::measure::board::programs::Footprint;
    use gridel_core::Format;

    const STRUCTURE: Structure = Structure::DualSplit;

    /// A ball under a light, on the smallest board, with programs made for this test.
    fn report(programs: &Programs, flash: u64) -> MemoryReport {
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
        MemoryReport::by(
            programs,
            &scene,
            compiled.blob.bytes(),
            &target,
            &Rendering::of(&scene, Format::Fixed),
        )
        .unwrap()
    }

    const PARTS: [&str; 3] = ["sphere", "wide-lattice", "shadow"];
    const SIZES: [Footprint; 2] = [
        Footprint {
            code: 30_000,
            call_stack: 1000,
            part_view: None,
        },
        Footprint {
            code: 20_000,
            call_stack: 1500,
            part_view: None,
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
    fn measured_program_is_reported_with_what_its_own_sizes_add() {
        let report = report(&programs(&BOARDS[0], &PARTS, &PROFILES), 128 << 10);
        assert!(report.measured);
        assert_eq!(bytes(&report.flash, CODE), Some(30_300));
        assert_eq!(bytes(&report.ram, "call stack"), Some(1508));
        assert_eq!(report.fit(), Fit::Fits);
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
            let report = report(&programs, 128 << 10);
            assert!(!report.measured);
            assert_eq!(bytes(&report.flash, CODE), code);
            assert_eq!(bytes(&report.ram, "call stack"), None);
            assert_eq!((report.ram.used, report.ram.remains()), (None, None));
            assert_eq!(report.flash.used.is_some(), code.is_some());
            match report.fit() {
                Fit::Undecided(why) => assert!(why.contains("call stack"), "{why}"),
                other => panic!("{other:?}"),
            }
            let json = serde_json::to_value(&report).unwrap();
            assert!(json["ram"]["used"].is_null() && json["small"]["call_stack"].is_null());
        }
    }

    /// The known part can exceed the board alone.
    #[test]
    fn unknown_figures_do_not_hide_what_is_short() {
        let report = report(&Programs::default(), 100);
        match report.fit() {
            Fit::Short(why) => assert!(why.contains("at least"), "{why}"),
            other => panic!("{other:?}"),
        }
    }

    /// Other boards' figures are scaled by what was built on both, and unknown without.
    #[test]
    fn other_boards_are_scaled_or_unknown() {
        let mut recorded = programs(&BOARDS[0], &PARTS, &PROFILES);
        let program = |recorded: &Programs| {
            let scenes = ProgramEstimate {
                programs: recorded,
                here: (&BOARDS[3], Format::Fixed),
                similar: BOARDS[3].similar(Format::Fixed),
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
