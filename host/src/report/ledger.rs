//! What a scene takes on a board, in flash and in RAM: a line an item, and what remains.
//!
//! Sizes of the blob and of working memory are exact. Code and call stack were measured on the
//! boards by the project's tests (`fixtures/recorded/board.json`), for a program that holds every
//! shape and every effect and walks dual-split nodes: bounds for one that holds what the scene calls
//! for and walks them, too, and estimates for other structures. On cores where each part was measured
//! alone, code is listed by shape and effect; what all of them take together beyond the sum of each
//! is shared out among them.

use super::{MemoryMap, grouped, working_memory};
use crate::blob::best_structures;
use crate::board::Board;
use crate::compile::taken;
use gridel_core::blob::record::{Sphere16, Sphere24, Vertex16, Vertex24};
use gridel_core::{Effects, Format, Kind, Rgb565, Scene, Structure};
use serde::Serialize;
use std::collections::BTreeMap;

/// What the tests measured, by the name of a build.
const RECORDED: &str = include_str!("../../../fixtures/recorded/board.json");
/// The scene of every shape and effect, and the board on which each was measured alone.
const EVERYTHING: &str = "quick";
const BY_PART: &str = "stm32vldiscovery";
/// What each part is added to: triangles in diffuse light without shadows.
const BASE: &str = "base";

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
    /// Whether code and call stack were measured with another structure, and are estimates.
    pub estimated: bool,
    pub flash: Account,
    pub ram: Account,
}

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
    /// The ledger of a scene that `blob` holds, in one of the board's number formats, through the
    /// best structure that the blob holds.
    pub fn of(scene: &Scene<'_>, blob: &[u8], target: &Target, format: Format) -> Self {
        let board = target.board;
        let structure = best_structures(scene).next().unwrap_or(Structure::List);
        let estimated = structure != Structure::DualSplit;
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
        let recorded = Recorded::read();
        recorded.code(scene, board, format, &mut flash);

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
        let stack = recorded.figure(EVERYTHING, board, format, "call-stack-bytes");
        let how = if estimated { "about" } else { "at most" };
        ram.add(format!("call stack, {how}"), stack);
        Self {
            board: board.name,
            core: board.core,
            format: format.name(),
            structure: structure.name(),
            estimated,
            flash,
            ram,
        }
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

    /// What would save memory of the kind that is short, by the scene's own figures.
    pub fn advice(&self, scene: &Scene<'_>) -> String {
        let mut steps = Vec::new();
        if self.ram.missing() > 0 {
            steps.extend(ram_advice(scene, self.format));
        }
        if self.flash.missing() > 0 {
            steps.extend(flash_advice(scene));
        }
        steps.join("; ")
    }
}

fn ram_advice(scene: &Scene<'_>, format: &str) -> Vec<String> {
    let view = scene.view();
    let place = if format == Format::F64.name() { 80 } else { 40 };
    let mut steps = Vec::new();
    let secondary = Effects::MIRROR.with(Effects::GLASS);
    if scene.effects().0 & secondary.0 != 0 && view.depth > 0 {
        steps.push(format!(
            "a ray depth of {} in place of {} saves {place} bytes, and a scene without mirrors and \
             glass {}",
            view.depth - 1,
            view.depth,
            place * (u64::from(view.depth) + 1)
        ));
    }
    steps.push(format!(
        "parts of rows in place of whole ones save up to {} bytes",
        2 * (u64::from(view.width) - 1)
    ));
    if scene.stack_depth() > 0 {
        steps.push(String::from(
            "`--accel list` does without a traversal stack and costs time",
        ));
    }
    steps
}

/// What a lattice of 16 bits saves of a blob's vertices and spheres.
pub fn narrower_storage(scene: &Scene<'_>) -> Option<String> {
    let saved =
        |count: usize, wide: usize, narrow: usize| taken(count * wide) - taken(count * narrow);
    let vertices = saved(
        scene.vertices(),
        size_of::<Vertex24>(),
        size_of::<Vertex16>(),
    );
    let spheres = saved(
        scene.count(Kind::Sphere),
        size_of::<Sphere24>(),
        size_of::<Sphere16>(),
    );
    let bytes = vertices + spheres;
    let stored = scene.header().storage_bits > 16 && bytes > 0;
    stored.then(|| format!("`--lattice-bits 16` saves {} bytes", grouped(bytes)))
}

fn flash_advice(scene: &Scene<'_>) -> Vec<String> {
    let mut steps = Vec::new();
    steps.extend(narrower_storage(scene));
    if scene.vertices() > 1 << 16 {
        let saved = 6 * scene.count(Kind::Triangle);
        steps.push(format!(
            "at most 65,536 vertices would make indices narrower and save {} bytes",
            grouped(saved)
        ));
    }
    let held = Structure::ALL.into_iter().filter(|&it| scene.holds(it));
    if held.filter(|&it| it != Structure::List).count() > 1 {
        steps.push(String::from(
            "a blob with one structure in place of several",
        ));
    } else if scene.stack_depth() > 0 {
        steps.push(String::from(
            "`--accel list` does without a hierarchy and costs time",
        ));
    }
    if scene.effects() != Effects::NONE {
        steps.push(format!(
            "a scene that does without some of its effects ({})",
            scene.effects()
        ));
    }
    steps.push(String::from("a scene with fewer primitives"));
    steps
}

struct Recorded(BTreeMap<String, BTreeMap<String, u64>>);

impl Recorded {
    fn read() -> Self {
        Self(serde_json::from_str(RECORDED).unwrap_or_default())
    }

    /// A figure of a scene's program; 0 where it was not measured.
    fn figure(&self, scene: &str, board: &Board, format: Format, figure: &str) -> u64 {
        let key = format!("{scene} {} {} dual-split", board.name, format.name());
        let figures = self.0.get(&key);
        figures
            .and_then(|figures| figures.get(figure))
            .copied()
            .unwrap_or(0)
    }

    /// Lists the code that a scene calls for.
    fn code(&self, scene: &Scene<'_>, board: &Board, format: Format, flash: &mut Account) {
        let everything = self.figure(EVERYTHING, board, format, "code-bytes");
        let by_part = Board::named(BY_PART).filter(|it| it.target == board.target);
        let Some(by_part) = by_part else {
            flash.add("code: every shape and effect, at most", everything);
            return;
        };
        let code = |part: &str| self.figure(part, by_part, format, "code-bytes");
        let (base, glass) = (code(BASE), code("glass"));
        let alone = |part: &str| match part {
            // It comes with glass.
            "absorption" => code(part).saturating_sub(glass),
            _ => code(part).saturating_sub(base),
        };
        let parts = Kind::ALL.map(Kind::name).into_iter();
        let sum: u64 = parts.chain(Effects::ALL.names()).map(alone).sum();
        let together = everything.saturating_sub(base).max(sum);
        flash.add("code: loading, triangles, diffuse light", base);
        for part in scene.features() {
            let bytes = (alone(part) * together).div_ceil(sum.max(1));
            if bytes > 0 {
                flash.add(format!("code: {part}"), bytes);
            }
        }
    }
}
