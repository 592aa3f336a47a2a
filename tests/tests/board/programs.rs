//! Code and call stacks of linked programs, from which the memory report is made, and tests of the report.
//!
//! They are recorded in the package of the host, `host/src/measure/board/programs.json`.

use crate::combinations;
use crate::elf::Elf;
use crate::firmware::Build;
use crate::measured_in_full;
use crate::parts;
use crate::plan::Plan;
use crate::scenes::{self, Compiled, repository};
use gridel_core::{Format, Rgb565, Structure};
use gridel_host::measure::board::Board;
use gridel_host::measure::board::programs::{Footprint, Profile, ProgramKey, Programs, everything};
use gridel_host::measure::board::{MemoryReport, Rendering, Target};
use gridel_host::measure::board_memory;
use std::path::PathBuf;
use std::sync::Mutex;
use std::{env, fs};

pub fn plan(plan: &mut Plan) {
    for (board, format) in measured_in_full() {
        plan.test_on("programs_take_what_is_recorded", board, format)
            .at_length()
            .run(move || programs_take_what_is_recorded(board, format));
        if is_recording() {
            // The report holds what was recorded when the host was compiled.
            continue;
        }
        // Ten builds on each kind of core, and eight for scenes whose parts others have, too.
        plan.test_on("memory_report_is_within_5_percent", board, format)
            .with_scene(CRAMBIN)
            .with_scene(SUZANNE)
            .in_full_if(board.core == "Cortex-M3")
            .run(move || memory_report_is_within_5_percent(board, format, &usual_scenes()));
        plan.test_on("memory_report_is_within_5_percent_of_more", board, format)
            .at_length()
            .run(move || memory_report_is_within_5_percent(board, format, &more_scenes()));
        plan.test_on("memory_report_bounds_programs_beyond", board, format)
            .at_length()
            .run(move || memory_report_bounds_programs_beyond(board, format));
    }
}

/// Programs that were linked.
#[derive(Default)]
pub struct Linked(Vec<LinkedProgram>);

struct LinkedProgram {
    name: String,
    place: ProgramKey<'static>,
    parts: Vec<String>,
    profile: Profile,
    footprint: Footprint,
}

impl Linked {
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a program with code for some parts.
    pub fn add(&mut self, build: &Build<'_>, features: &[&str], scene: &Compiled, elf: &Elf) {
        let (board, format, structure) = build.place();
        let board = Board::named(board.name).expect("a board of the host's");
        let all: Vec<&str> = everything().collect();
        let parts = match features {
            ["everything", more @ ..] => [&all, more].concat(),
            _ => features.to_vec(),
        };
        self.0.push(LinkedProgram {
            name: build.to_string(),
            place: (board, format, structure),
            parts: parts.into_iter().map(String::from).collect(),
            profile: build.profile(),
            footprint: footprint(build, elf, scene),
        });
    }

    /// Fails where a program takes 2 % more than is recorded, or is not recorded. With
    /// `GRIDEL_RECORD_BOARDS=1` records them instead.
    pub fn check(&self) {
        if is_recording() {
            return self.record();
        }
        let recorded = Programs::recorded();
        let mut grown = Vec::new();
        for program in &self.0 {
            let before = recorded.get(program.place, &program.parts());
            let before = before.and_then(|before| before.footprint(program.profile));
            let within = before.is_some_and(|before| {
                let grew = |found: u64, before: u64| found > before + before / 50;
                let found = program.footprint;
                !grew(found.code, before.code) && !grew(found.call_stack, before.call_stack)
            });
            if !within {
                let (name, parts) = (&program.name, program.parts.join(" "));
                let found = program.footprint;
                grown.push(format!("{name}, {parts}: {found:?}, recorded {before:?}"));
            }
        }
        assert!(
            grown.is_empty(),
            "grew by more than 2 % (GRIDEL_RECORD_BOARDS=1 records them):\n{}",
            grown.join("\n")
        );
    }

    fn record(&self) {
        static FILE: Mutex<()> = Mutex::new(());
        let _one_at_a_time = FILE.lock().unwrap_or_else(|poison| poison.into_inner());
        let text = fs::read(path()).expect("a table of programs");
        let mut recorded: Programs = serde_json::from_slice(&text).expect("a table of programs");
        // Removes programs that once had code for all parts, before there were more; they are not built any more.
        let all: Vec<&str> = everything().collect();
        let has_all = |parts: &[&str]| all.iter().all(|part| parts.contains(part));
        recorded.retain(|parts| !parts.contains(&"display-values") || has_all(parts));
        for program in &self.0 {
            let (place, parts) = (program.place, program.parts());
            recorded.insert(place, &parts, program.profile, program.footprint);
        }
        let text = serde_json::to_string_pretty(&recorded).expect("a table of integers");
        fs::write(path(), text + "\n").expect("the table can be written to");
    }
}

impl LinkedProgram {
    fn parts(&self) -> Vec<&str> {
        self.parts.iter().map(String::as_str).collect()
    }
}

fn is_recording() -> bool {
    env::var_os("GRIDEL_RECORD_BOARDS").is_some_and(|value| value == "1")
}

fn path() -> PathBuf {
    repository().join("host/src/measure/board/programs.json")
}

/// Flash for code, the deepest call stack, and RAM for the view of a part.
pub fn footprint(build: &Build<'_>, elf: &Elf, scene: &Compiled) -> Footprint {
    let path = elf.deepest_path();
    let path = path.unwrap_or_else(|why| panic!("{build}: no bound on its stack: {why}"));
    let view = scene.blob.scene().expect("the compiler's own blob");
    let parts = view.parts().len() as u64;
    let part_view = (parts > 0).then(|| {
        let (_, format, _) = build.place();
        let workspace = board_memory(&view, format, view.view().depth).workspace as u64;
        let row = u64::from(view.view().width) * size_of::<Rgb565>() as u64;
        (elf.static_bytes() - workspace - row).div_ceil(parts)
    });
    Footprint {
        code: elf.flash_bytes() - scene.blob.bytes().len() as u64,
        call_stack: path.bytes,
        part_view,
    }
}

/// The fast program of a scene on a board, or that of small code.
fn build<'s>(
    board: &'static Board,
    format: Format,
    scene: &'s Compiled,
    profile: Profile,
) -> Build<'s> {
    let build = Build::new(board, format, Structure::DualSplit, scene);
    match profile {
        Profile::Fast => build,
        Profile::Small => build.small(),
    }
}

/// Parts that usual scenes require, with coordinates of 24 bits as they are by default.
fn programs_take_what_is_recorded(board: &'static Board, format: Format) {
    let mut linked = Linked::new();
    for (shapes, effects) in combinations::usual() {
        let scene = parts::combination(&shapes, &effects);
        for profile in [Profile::Fast, Profile::Small] {
            let build = build(board, format, &scene, profile);
            let elf = build.program("bare").elf();
            linked.add(&build, &scene.features(), &scene, &elf);
        }
    }
    linked.check();
}

/// A protein, and a mesh.
const CRAMBIN: &str = "molecules/1crn.pdb";
const SUZANNE: &str = "meshes/suzanne.obj";

/// All effects, glass, a protein, a mesh, and balls and sticks.
fn usual_scenes() -> Vec<Compiled> {
    let fixture = |name| scenes::by_default(name, &scenes::fixture_path(name));
    vec![
        fixture("quick"),
        fixture("glass-chess"),
        scenes::by_default("1crn", &scenes::real(CRAMBIN)),
        scenes::by_default("suzanne", &scenes::real(SUZANNE)),
        parts::combination(&["sphere", "cone"], &["shadow", "highlight"]),
    ]
}

fn more_scenes() -> Vec<Compiled> {
    let c60 = repository().join("fixtures/c60.pdb");
    vec![
        scenes::by_default("cornell", &scenes::fixture_path("cornell")),
        scenes::by_default("sky", &scenes::fixture_path("sky")),
        scenes::by_default("studio", &scenes::fixture_path("studio")),
        scenes::by_default("robot-arm", &scenes::fixture_path("robot-arm")),
        scenes::by_default("c60", &c60),
        parts::combination(&["sphere"], &["shadow"]),
        parts::combination(&["box"], &["shadow", "highlight"]),
    ]
}

/// The flash, the RAM and the call stack in the memory report are enough for the linked program,
/// and at most 5 % more.
fn memory_report_is_within_5_percent(board: &'static Board, format: Format, all: &[Compiled]) {
    let mut wrong = Vec::new();
    for scene in all {
        let (reported, linked) = reported_and_linked(board, format, scene);
        let names = ["flash", "RAM", "call stack"];
        for ((name, reported), linked) in names.into_iter().zip(reported).zip(linked) {
            let line = format!(
                "{} on {}: {reported} bytes of {name} reported, {linked} linked, {:+.1} %",
                scene.name,
                board.name,
                100.0 * (reported as f64 / linked as f64 - 1.0)
            );
            println!("{line}");
            if reported < linked || 100 * reported > 105 * linked {
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Programs that were not recorded are bounded. The host's documentation states how far beyond the true figures the
/// bounds lie (`gridel_host::measure::board::programs`).
fn memory_report_bounds_programs_beyond(board: &'static Board, format: Format) {
    let mut wrong = Vec::new();
    for (shapes, effects) in [
        (&["triangle", "disc", "cone"][..], &["shadow"][..]),
        (&["box", "cone"], &["shadow", "mirror"]),
        (&["triangle", "sphere", "cone"], &["shadow", "highlight"]),
        (&["sphere"], &["glass"]),
        (&["triangle", "box", "disc"], &["highlight", "checker"]),
    ] {
        let scene = parts::combination(shapes, effects);
        let (reported, linked) = reported_and_linked(board, format, &scene);
        let names = ["flash", "RAM", "call stack"];
        for ((name, reported), linked) in names.into_iter().zip(reported).zip(linked) {
            let line = format!(
                "{} {} on {}: {reported} bytes of {name} reported, {linked} linked, {:+.1} %",
                shapes.join(" "),
                effects.join(" "),
                board.name,
                100.0 * (reported as f64 / linked as f64 - 1.0)
            );
            println!("{line}");
            if reported < linked {
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Flash, RAM and call stack of a scene: the figures of the memory report, and those of its linked programs.
/// Flash and static memory are those of the fast program, the call stack is the larger of both.
fn reported_and_linked(
    board: &'static Board,
    format: Format,
    scene: &Compiled,
) -> ([u64; 3], [u64; 3]) {
    let view = scene.blob.scene().expect("the compiler's own blob");
    let target = Target {
        board,
        flash: board.flash,
        ram: board.ram,
    };
    let report = MemoryReport::of(
        &view,
        scene.blob.bytes(),
        &target,
        &Rendering::of(&view, format),
    )
    .expect("dual-split nodes");
    let sizes = [report.fast, report.small].map(|sizes| sizes.call_stack.expect("known"));
    // The program leaves all at rest.
    let moves = |what: &str| {
        what.starts_with("moved instances")
            || what.starts_with("motions of")
            || what.ends_with("tracks change them")
    };
    let of_moves = report.ram.items.iter().filter(|item| moves(&item.what));
    let of_moves: u64 = of_moves.filter_map(|item| item.bytes).sum();
    let reported = [
        report.flash.used.expect("known"),
        report.ram.used.expect("known") - of_moves,
        sizes[0].max(sizes[1]),
    ];
    let [fast, small] = [Profile::Fast, Profile::Small].map(|profile| {
        let build = build(board, format, scene, profile);
        let elf = build.program("bare").elf();
        (footprint(&build, &elf, scene), elf)
    });
    let call_stack = fast.0.call_stack.max(small.0.call_stack);
    let linked = [
        fast.1.flash_bytes(),
        fast.1.static_bytes() + call_stack,
        call_stack,
    ];
    (reported, linked)
}
