//! Figures that the benchmark against other libraries recorded.

use super::boards::boards;
use super::{BENCHMARKS, README, holds_table, text};
use gridel_host::table::grouped;
use serde_json::Value;

/// The contender whose rates are 1.
const UNIT: &str = "obvhs Bvh2";

/// A run of the benchmark: its scenes in order.
struct Run(Value);

impl Run {
    fn recorded() -> Self {
        let recorded = text("fixtures/recorded/peers.json");
        Self(serde_json::from_str(&recorded).expect("a run"))
    }

    fn scenes(&self) -> Vec<&Value> {
        self.0["scenes"]
            .as_array()
            .expect("scenes")
            .iter()
            .collect()
    }

    fn contenders(&self) -> Vec<&str> {
        let lines = self.scenes()[0]["lines"].as_array().expect("lines").iter();
        let names = lines.map(|line| line["contender"].as_str().expect("a name"));
        names.collect()
    }
}

fn line<'r>(scene: &'r Value, contender: &str) -> Option<&'r Value> {
    let mut lines = scene["lines"].as_array().expect("lines").iter();
    lines.find(|line| line["contender"] == contender)
}

/// The name of a scene and its primitives.
fn heading(scene: &Value) -> String {
    let primitives = scene["primitives"].as_u64().expect("a count");
    let name = scene["scene"].as_str().expect("a name");
    format!("{name}, {}", grouped(primitives))
}

/// Relative rates of primary, bounce and shadow rays.
fn rates(scene: &Value, contender: &str) -> String {
    let Some(own) = line(scene, contender) else {
        return String::from("-");
    };
    let unit = line(scene, UNIT).expect("the unit");
    let rate = |line: &Value, kind: usize| line["rates"][kind].as_f64().expect("a rate");
    let ratios = [0, 1, 2].map(|kind| format!("{:.2}", rate(own, kind) / rate(unit, kind)));
    ratios.join(" / ")
}

/// Bytes per primitive, milliseconds of the build, wrong answers and leaks.
fn costs(scenes: &[&Value], contender: &str) -> [String; 4] {
    let bunny = scenes.iter().find(|scene| scene["scene"] == "bunny");
    let bunny = line(bunny.expect("the bunny"), contender).expect("a line");
    let figure = |name: &str| bunny[name].as_f64().expect("a figure");
    let lines = || scenes.iter().filter_map(|scene| line(scene, contender));
    let wrong = lines().flat_map(|line| line["wrong"].as_array().expect("counts"));
    let wrong: u64 = wrong.filter_map(Value::as_u64).sum();
    let leaks = lines().find_map(|line| line["leaks"].as_u64());
    [
        format!("{:.1}", figure("bytes_a_primitive")),
        format!("{:.0}", 1e3 * figure("build_seconds")),
        grouped(wrong),
        leaks.map_or(String::from("-"), grouped),
    ]
}

/// `GRIDEL_BLESS=1` writes the tables.
#[test]
fn benchmarks_page_shows_recorded_peers() {
    let run = Run::recorded();
    let scenes = run.scenes();
    let headings: Vec<_> = scenes.iter().map(|scene| heading(scene)).collect();
    let mut speed = format!(
        "| contender | {} |\n|---|{}\n",
        headings.join(" | "),
        "---|".repeat(scenes.len())
    );
    let mut table = String::from(
        "| contender | bytes per triangle | build, ms | wrong answers | leaks |\n|---|---|---|---|---|\n",
    );
    for contender in run.contenders() {
        let rates: Vec<_> = scenes.iter().map(|scene| rates(scene, contender)).collect();
        speed += &format!("| {contender} | {} |\n", rates.join(" | "));
        table += &format!(
            "| {contender} | {} |\n",
            costs(&scenes, contender).join(" | ")
        );
    }
    holds_table(BENCHMARKS, "peers", &speed);
    holds_table(BENCHMARKS, "peers-costs", &table);
}

#[test]
fn readme_shows_recorded_speed_against_peers() {
    let run = Run::recorded();
    let scenes = run.scenes();
    let shown = ["bunny", "4YVS"].map(|name| {
        let mut scenes = scenes.iter();
        *scenes.find(|scene| scene["scene"] == name).expect(name)
    });
    let mut table = String::from(
        "| library | bunny, 69,451 triangles | molecule, 26,430 spheres | bytes per triangle | \
         build, ms | leaks |\n|---|---|---|---|---|---|\n",
    );
    for (contender, name) in [
        ("gridel wide, 24 bits, good", "**Gridel**, `wide`"),
        ("Embree 3 robust", "Embree 3, robust"),
        (UNIT, "obvhs, `Bvh2`"),
        ("obvhs CwBvh", "obvhs, `CwBvh`"),
        ("parry3d TriMesh", "parry3d"),
        ("bvh", "bvh"),
    ] {
        let rates = shown.map(|scene| rates(scene, contender)).join(" | ");
        let [bytes, build, _, leaks] = costs(&scenes, contender);
        table += &format!("| {name} | {rates} | {bytes} | {build} | {leaks} |\n");
    }
    holds_table(README, "speed", &table);
}

/// Libraries on boards: the others' figures are recorded, and Gridel's are those of the board tests.
#[test]
fn benchmarks_page_shows_recorded_peers_on_boards() {
    let recorded = text("fixtures/recorded/peers-boards.json");
    let recorded: Value = serde_json::from_str(&recorded).expect("peers");
    let boards = boards();
    let mut table = String::from(
        "| library | Cortex-M4F | Cortex-M3 | heap, bytes | stack, bytes |\n|---|---|---|---|---|\n",
    );
    let mut row = |name: &str, figures: [&Value; 4]| {
        let figures = figures.map(|figure| grouped(figure.as_u64().expect("a figure")));
        table += &format!("| {name} | {} |\n", figures.join(" | "));
    };
    let of = |board: &str, format: &str, name: &str| {
        boards[format!("suzanne {board} {format} dual-split")][name].as_u64()
    };
    let stack = ["ray-stack-bytes", "workspace-bytes"];
    let stack: Option<u64> = stack
        .iter()
        .map(|name| of("mps2-an385", "fixed", name))
        .sum();
    row(
        "Gridel, `f32` on the M4F, `fixed` on the M3",
        [
            &of("mps2-an386", "f32", "ray-instructions").into(),
            &of("mps2-an385", "fixed", "ray-instructions").into(),
            &0.into(),
            &stack.into(),
        ],
    );
    for (name, peer) in recorded.as_object().expect("peers") {
        let figures = ["Cortex-M4F", "Cortex-M3", "heap", "stack"];
        row(name, figures.map(|figure| &peer[figure]));
    }
    holds_table(BENCHMARKS, "peers-boards", &table);
}
