//! What the benchmark against other libraries measured.

use super::{holds_table, text};
use gridel_host::report::grouped;

/// What was measured against the peers, as their benchmark recorded it. `GRIDEL_BLESS=1` writes it
/// anew.
#[test]
fn the_readme_shows_what_was_measured_against_peers() {
    let recorded = text("fixtures/recorded/peers.json");
    let table = peers(&serde_json::from_str(&recorded).expect("a run"));
    holds_table("peers", &table);
}

/// A run of the benchmark as a table: for each scene the rates of primary, bounce and shadow rays,
/// those of the first contender being 1.
fn peers(run: &serde_json::Value) -> String {
    let scenes: Vec<_> = run["scenes"].as_array().expect("scenes").iter().collect();
    let lines = |scene: &serde_json::Value| scene["lines"].as_array().expect("lines").clone();
    let rate =
        |line: &serde_json::Value, kind: usize| line["rates"][kind].as_f64().expect("a rate");
    let mut table = String::from("| |");
    for scene in &scenes {
        let primitives = scene["primitives"].as_u64().expect("a count");
        table += &format!(
            " {}, {} |",
            scene["scene"].as_str().expect("a name"),
            grouped(primitives)
        );
    }
    table += " bytes each | build, ms | wrong | leaks |\n|---|";
    table += &"---|".repeat(scenes.len() + 4);
    table.push('\n');
    for name in lines(scenes[0]).iter().map(|line| &line["contender"]) {
        table += &format!("| {} |", name.as_str().expect("a name"));
        let (mut wrong, mut leaks) = (0, None);
        let (mut bytes, mut build) = (String::new(), String::new());
        for scene in &scenes {
            let all = lines(scene);
            let Some(line) = all.iter().find(|line| line["contender"] == *name) else {
                table += " - |";
                continue;
            };
            let ratios =
                [0, 1, 2].map(|kind| format!("{:.2}", rate(line, kind) / rate(&all[0], kind)));
            table += &format!(" {} |", ratios.join(" / "));
            let misses = line["wrong"].as_array().expect("counts").iter();
            wrong += misses.filter_map(serde_json::Value::as_u64).sum::<u64>();
            leaks = leaks.or(line["leaks"].as_u64());
            if scene["scene"] == "bunny" {
                bytes = format!(
                    "{:.1}",
                    line["bytes_a_primitive"].as_f64().expect("a figure")
                );
                build = format!(
                    "{:.0}",
                    line["build_seconds"].as_f64().expect("a time") * 1e3
                );
            }
        }
        let leaks = leaks.map_or(String::from("-"), grouped);
        table += &format!(" {bytes} | {build} | {} | {leaks} |\n", grouped(wrong));
    }
    table
}
