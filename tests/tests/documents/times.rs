//! Measurements of `gridel compare` on a host: the paper's scenes, and how structures fare as one grows.

use super::{PAPER, STRUCTURES, holds_table, text};
use gridel_host::table::grouped;
use serde_json::Value;

/// The output of `gridel compare --json`.
fn recorded(scene: &str) -> Value {
    let recorded = text(&format!("fixtures/recorded/compare/{scene}.json"));
    serde_json::from_str(&recorded).expect("a comparison")
}

fn rows(comparison: &Value) -> &Vec<Value> {
    let rows = comparison["rows"].as_array().expect("rows");
    for row in rows {
        assert!(row["wrong"].is_null(), "{row}");
    }
    rows
}

fn row<'c>(comparison: &'c Value, structure: &str) -> Option<&'c Value> {
    let mut rows = rows(comparison).iter();
    rows.find(|row| row["structure"] == structure)
}

fn rate(row: &Value, rays: &str) -> Option<f64> {
    row["work"][rays]["rays_per_second"].as_f64()
}

/// Two digits, or all before the point.
fn short(figure: f64) -> String {
    match figure {
        10.0.. => grouped(figure.round() as u64),
        1.0.. => format!("{figure:.1}"),
        0.1.. => format!("{figure:.2}"),
        _ => format!("{figure:.3}"),
    }
}

/// Time per ray relative to `bvh`, and the time to build.
#[test]
fn paper_page_shows_recorded_times() {
    let scenes = ["glass-chess", "diamond", "diamond-large"].map(recorded);
    let mut table = String::from("| structure |");
    for scene in &scenes {
        let primitives = grouped(scene["primitives"].as_u64().expect("a count"));
        table += &format!(" {primitives} objects: primary, shadow, bounced | build, ms |");
    }
    table += "\n|---|---|---|---|---|---|---|\n";
    for name in rows(&scenes[0]).iter().map(|row| &row["structure"]) {
        let name = name.as_str().expect("a name");
        table += &format!("| `{name}` |");
        for scene in &scenes {
            let (bvh, Some(row)) = (row(scene, "bvh").expect("a row"), row(scene, name)) else {
                table += " - | - |";
                continue;
            };
            let times = ["primary", "shadow", "bounced"].map(|rays| {
                let times = rate(bvh, rays)
                    .zip(rate(row, rays))
                    .map(|(bvh, own)| bvh / own);
                times.map_or(String::from("-"), |times| format!("{times:.2}"))
            });
            let setup = 1e3 * row["setup_seconds"].as_f64().expect("a time");
            table += &format!(" {} | {} |", times.join(", "), short(setup));
        }
        table += "\n";
    }
    holds_table(PAPER, "paper-times", &table);
}

/// Rates and bytes of growing parts of one scene. One step is left out, so that eight columns remain.
#[test]
fn structures_page_shows_recorded_growth() {
    let report = recorded("growth");
    let steps = report["growth"]["steps"].as_array().expect("steps");
    let shown = steps.iter().filter(|step| step["primitives"] != 300);
    let steps: Vec<_> = shown.collect();
    let mut table = String::from("| structure |");
    for step in &steps {
        let primitives = grouped(step["primitives"].as_u64().expect("a count"));
        table += &format!(" {primitives} |");
    }
    table += &format!("\n|---|{}\n", "---|".repeat(steps.len()));
    for name in rows(&report).iter().map(|row| &row["structure"]) {
        let name = name.as_str().expect("a name");
        table += &format!("| `{name}` |");
        for step in &steps {
            let Some(row) = row(step, name) else {
                table += " - |";
                continue;
            };
            let millions = rate(row, "primary").expect("a rate") / 1e6;
            let bytes = row["own_bytes"].as_u64().expect("bytes");
            table += &format!(" {}, {} |", short(millions), short(bytes as f64 / 1e3));
        }
        table += "\n";
    }
    holds_table(STRUCTURES, "growth", &table);
}
