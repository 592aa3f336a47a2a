//! What a scene takes on a board, in flash and in RAM: a line an item, and what remains.
//!
//! Sizes of the blob and of working memory are exact. Code and call stack were measured on the
//! boards by the project's tests (`fixtures/recorded/board.json`), for two builds: a fast one, and one
//! with the feature `small`, both linked with `lto = "fat"` and `codegen-units = 1`. The call stack is
//! the larger of both, with every shape and effect: a bound for a scene that calls for fewer. Code is
//! that of the fast build, by shape and effect; what they take together beyond the sum of each is shared
//! out among them.
//!
//! On one board of each kind of core every part and structure was measured alone. What was measured
//! there stands for its kin, stretched by what everything, or a few parts, take here and there.

use super::{MemoryMap, grouped, working_memory};
use crate::blob::best_structures;
use crate::board::Board;
use gridel_core::accel::Entry;
use gridel_core::{Effects, Format, Kind, Rgb565, Scene, Structure, Vouched};
use serde::Serialize;
use std::collections::BTreeMap;

/// What the tests measured, by the name of a build.
const RECORDED: &str = include_str!("../../../fixtures/recorded/board.json");
/// The scene of every shape and effect.
const EVERYTHING: &str = "quick";
/// What each part is added to: triangles in diffuse light without shadows.
const BASE: &str = "base";
/// A program of two parts beside it.
const FEW: &str = "sphere, triangle, shadow";
/// Forms of storage that are parts as well.
const WIDER: [&str; 2] = ["wide-lattice", "wide-indices"];

/// How the names of builds end.
const FAST: &str = "";
const SMALL: &str = " small";
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
    pub flash: Account,
    pub ram: Account,
    /// A program of every shape and effect, built for speed.
    pub fast: Footprint,
    /// The same with the feature `small`.
    pub small: Footprint,
}

/// Bytes of a program that holds every shape and every effect.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Footprint {
    pub code: u64,
    pub call_stack: u64,
}

/// A structure of which nothing was measured on boards.
#[derive(Clone, Copy, Debug)]
pub struct NotMeasured(pub Structure);

/// One kind of memory: what there is, and what takes it.
#[derive(Clone, Debug, Serialize)]
pub struct Account {
    pub available: u64,
    /// Bytes of all items.
    pub used: u64,
    pub items: Vec<Item>,
}

/// Something that takes memory.
#[derive(Clone, Debug, Serialize)]
pub struct Item {
    pub what: String,
    pub bytes: u64,
}

impl Account {
    /// Bytes that are missing, 0 where all fits.
    pub fn missing(&self) -> u64 {
        self.used.saturating_sub(self.available)
    }

    /// Bytes that remain, 0 where it does not fit.
    pub fn remains(&self) -> u64 {
        self.available.saturating_sub(self.used)
    }

    fn add(&mut self, what: impl Into<String>, bytes: u64) {
        let what = what.into();
        self.used += bytes;
        self.items.push(Item { what, bytes });
    }
}

impl Ledger {
    /// The structures that were measured: those that firmware can vouch for.
    pub const STRUCTURES: [Structure; 4] = Vouched::STRUCTURES;

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
        let board = target.board;
        let structure = best_structures(scene).next().unwrap_or(Structure::List);
        let measured = Measured::of(board, format, structure).ok_or(NotMeasured(structure))?;
        let empty = |available| Account {
            available,
            used: 0,
            items: Vec::new(),
        };
        let (mut flash, mut ram) = (empty(target.flash), empty(target.ram));
        for part in MemoryMap::of(scene, blob).parts {
            if part.bytes > 0 {
                flash.add(format!("blob: {}", part.kind), part.bytes as u64);
            }
        }
        measured.code(scene, &mut flash);

        let words = working_memory(scene);
        let need = words
            .iter()
            .find(|need| need.word_bits == 32 && need.format == format.name());
        if let Some(need) = need {
            ram.add(
                format!("traversal stack, {} entries", scene.stack_depth()),
                need.stack as u64,
            );
            ram.add("work list", (need.workspace - need.stack) as u64);
        }
        let width = scene.view().width;
        let row = u64::from(width) * size_of::<Rgb565>() as u64;
        ram.add(format!("row of {width} pixels, RGB565"), row);
        let [fast, small] = [FAST, SMALL].map(|build| measured.everything(build));
        let is_bound = structure == Structure::DualSplit || measured.kin.0.core == board.core;
        let how = if is_bound { "at most" } else { "about" };
        ram.add(
            format!("call stack, {how}"),
            fast.call_stack.max(small.call_stack),
        );
        let (kin, kins_format) = measured.kin;
        Ok(Self {
            board: board.name,
            core: board.core,
            format: format.name(),
            structure: structure.name(),
            measured_on: format!("{} in {}", kin.core, kins_format.name()),
            flash,
            ram,
            fast,
            small,
        })
    }

    /// The builds that the figures hold for.
    pub fn holds_for(&self) -> String {
        let Self { fast, small, .. } = self;
        let own = format!("{} in {}", self.core, self.format);
        let stretched = match &self.measured_on {
            there if *there != own => {
                format!("\nParts were measured on a {there}, and stretched to what all take here.")
            }
            _ => String::new(),
        };
        format!(
            "For programs linked with lto = \"fat\" and codegen-units = 1. Code is that of opt-level = 3. The \
             call stack\nis enough for that, which takes {} bytes, and for the feature `small` with \
             opt-level = \"z\", which takes\n{}, and {} bytes of code at most. Other profiles were not \
             measured and may take more.{stretched}",
            grouped(fast.call_stack),
            grouped(small.call_stack),
            grouped(small.code)
        )
    }

    /// Why the scene does not fit: what is short, and by how much. `None` where it fits.
    pub fn shortage(&self) -> Option<String> {
        let accounts = [("flash", &self.flash), ("RAM", &self.ram)];
        let short: Vec<_> = accounts
            .into_iter()
            .filter(|(_, account)| account.missing() > 0)
            .map(|(what, account)| {
                format!(
                    "{} bytes of {what}, {} more than the {} there are",
                    grouped(account.used),
                    grouped(account.missing()),
                    grouped(account.available)
                )
            })
            .collect();
        (!short.is_empty()).then(|| format!("the scene takes {}", short.join(", and ")))
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

    fn ram_advice(&self, scene: &Scene<'_>) -> Vec<String> {
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
        let [fast, small] = [self.fast, self.small].map(|build| build.call_stack);
        if fast < small {
            steps.push(format!(
                "without the feature `small` the call stack takes {} bytes less",
                grouped(small - fast)
            ));
        }
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

    fn flash_advice(&self, scene: &Scene<'_>) -> Vec<String> {
        let mut steps = Vec::new();
        let items = self.flash.items.iter();
        let code: u64 = items
            .filter(|item| item.what.starts_with(CODE))
            .map(|item| item.bytes)
            .sum();
        if self.small.code < code {
            steps.push(format!(
                "with the feature `small` and opt-level = \"z\" code takes at most {} bytes in place of {}, \
                 and rays take longer",
                grouped(self.small.code),
                grouped(code)
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

/// What was measured for programs that walk a structure on a board.
struct Measured {
    recorded: BTreeMap<String, BTreeMap<String, u64>>,
    here: (&'static Board, Format),
    /// Where parts and structures were measured.
    kin: (&'static Board, Format),
    structure: Structure,
}

impl Measured {
    /// `None` for a structure that was not measured.
    fn of(board: &'static Board, format: Format, structure: Structure) -> Option<Self> {
        Ledger::STRUCTURES.contains(&structure).then(|| Self {
            recorded: serde_json::from_str(RECORDED).unwrap_or_default(),
            here: (board, format),
            kin: board.kin(format),
            structure,
        })
    }

    /// A figure of a scene's program; 0 where it was not measured.
    fn figure(
        &self,
        scene: &str,
        (board, format): (&Board, Format),
        structure: Structure,
        build: &str,
        figure: &str,
    ) -> u64 {
        let (format, structure) = (format.name(), structure.name());
        let key = format!("{scene} {} {format} {structure}{build}", board.name);
        let figures = self.recorded.get(&key);
        figures
            .and_then(|figures| figures.get(figure))
            .copied()
            .unwrap_or(0)
    }

    /// What a program of every shape and effect takes here.
    fn everything(&self, build: &str) -> Footprint {
        let stretched = |figure| {
            let everything =
                |place, structure| self.figure(EVERYTHING, place, structure, build, figure);
            let [here, there] =
                [self.here, self.kin].map(|it| everything(it, Structure::DualSplit));
            (everything(self.kin, self.structure) * here).div_ceil(there.max(1))
        };
        Footprint {
            code: stretched("code-bytes"),
            call_stack: stretched("call-stack-bytes"),
        }
    }

    /// Lists the code that a scene calls for.
    fn code(&self, scene: &Scene<'_>, flash: &mut Account) {
        let code = |scene: &str, place, structure| {
            self.figure(scene, place, structure, FAST, "code-bytes")
        };
        let of_part = |part: &str| code(part, self.kin, Structure::DualSplit);
        let (base, glass) = (of_part(BASE), of_part("glass"));
        let alone = |part: &str| match part {
            // It comes with glass.
            "absorption" => of_part(part).saturating_sub(glass),
            _ => of_part(part).saturating_sub(base),
        };
        let [here, there] =
            [self.here, self.kin].map(|it| code(EVERYTHING, it, Structure::DualSplit));
        let parts = Kind::ALL.map(Kind::name).into_iter().chain(WIDER);
        let sum: u64 = parts.chain(Effects::ALL.names()).map(alone).sum();
        // Together parts may take more than each alone: as much as they do where it was measured.
        let few = alone("sphere") + alone("shadow");
        let whole = |whole: u64, sum: u64| (whole.saturating_sub(base).max(sum), sum.max(1));
        let (all, few) = (whole(there, sum), whole(of_part(FEW), few));
        let (whole, sum) = if all.0 * few.1 > few.0 * all.1 {
            all
        } else {
            few
        };
        let few_here = code(FEW, self.here, Structure::DualSplit);
        let stretched = |bytes: u64| {
            let most = [(here, there), (few_here, of_part(FEW))]
                .map(|(here, there)| (bytes * here.max(there)).div_ceil(there.max(1)));
            most[0].max(most[1])
        };
        // Whatever a dearer walk takes, every scene needs.
        let walk = code(EVERYTHING, self.kin, self.structure).saturating_sub(there);
        flash.add(
            format!("{CODE}loading, triangles, diffuse light"),
            stretched(base + walk),
        );
        for part in scene.features() {
            let bytes = stretched((alone(part) * whole).div_ceil(sum));
            if bytes > 0 {
                flash.add(format!("{CODE}{part}"), bytes);
            }
        }
    }
}
