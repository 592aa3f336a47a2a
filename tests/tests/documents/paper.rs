//! The paper's tables beside ours.

use super::{holds_table, text};
use gridel_host::report::grouped;

/// The paper's tables beside ours, as the test `tables` recorded them.
#[test]
fn the_readme_shows_the_papers_tables() {
    let recorded = text("fixtures/recorded/structures.json");
    let recorded: serde_json::Value = serde_json::from_str(&recorded).expect("tables");
    let scenes = &recorded["256 by 256 pixels"];
    let scenes = ["glass-chess", "diamond", "diamond-large"].map(|name| &scenes[name]);
    let whole = |value: &serde_json::Value| value.as_u64().expect("a count");
    let count = |scene: &serde_json::Value, structure: &str, what: &str| {
        let count = scene["a ray"][structure][what].as_f64();
        count.unwrap_or_else(|| panic!("no {what} of {structure}"))
    };

    let mut hierarchies = String::from(
        "| objects, theirs / ours | time, theirs | planes a ray, boxes | below the root | slabs | \
         below the root | bytes, boxes | slabs |\n|---|---|---|---|---|---|---|---|\n",
    );
    for scene in scenes {
        let paper = &scene["paper"];
        let (plain, flagged) = (whole(&paper["plain"]), whole(&paper["flagged"]));
        hierarchies += &format!(
            "| {} / {} | {plain} : {flagged} = {:.2} |",
            grouped(whole(&paper["objects"])),
            grouped(whole(&scene["primitives"])),
            plain as f64 / flagged as f64
        );
        for (plain, flagged, root) in [("bvh", "flagged", 6.0), ("slabs", "flagged-slabs", 14.0)] {
            let [plain, flagged] = [plain, flagged].map(|name| count(scene, name, "planes"));
            let below = (plain - root) / (flagged - root);
            hierarchies += &format!(
                " {plain:.1} : {flagged:.1} = {:.2} | {below:.2} |",
                plain / flagged
            );
        }
        for (plain, flagged) in [("bvh", "flagged"), ("slabs", "flagged-slabs")] {
            let bytes = |name| grouped(count(scene, name, "bytes") as u64);
            hierarchies += &format!(" {} : {} |", bytes(plain), bytes(flagged));
        }
        hierarchies += "\n";
    }
    holds_table("paper-hierarchies", &hierarchies);

    let mut cubes = String::from("| |");
    for scene in scenes {
        let primitives = grouped(whole(&scene["primitives"]));
        cubes += &format!(" {primitives} objects: planes, cells, objects | longest list | bytes |");
    }
    cubes += "\n|---|---|---|---|---|---|---|---|---|---|\n";
    for structure in [
        "grid 4x4x4",
        "grid",
        "octree",
        "cylinder-cube",
        "cylinder-cube-tight",
        "cylinder-cube-entry",
        "apex",
        "ray-classes",
        "bvh",
        "flagged",
        "dual-split",
        "spheres",
    ] {
        cubes += &format!("| `{structure}` |");
        for scene in scenes {
            let count = |what| count(scene, structure, what);
            cubes += &format!(
                " {:.1}, {:.1}, {:.1} | {} | {} |",
                count("planes"),
                count("cells"),
                count("objects"),
                grouped(count("longest list") as u64),
                grouped(count("bytes") as u64)
            );
        }
        cubes += "\n";
    }
    holds_table("paper-cube", &cubes);
}

/// What the paper's cylinder cube takes, as the test `cylinder_cube` recorded it.
#[test]
fn the_readme_explains_the_papers_loss() {
    let recorded = text("fixtures/recorded/cylinder-cube.toml");
    let recorded: toml::Table = toml::from_str(&recorded).expect("figures");
    let mut table = String::from(
        "| objects | lists | count | objects a list | longest | entries | 2 bytes | 4 bytes | \
         8 bytes |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for scene in ["glass-chess", "diamond-2800", "diamond-27000"] {
        let figure = |name: &str| {
            let figure = recorded[scene][name].as_integer();
            figure.expect("a figure") as u64
        };
        for (kind, name) in [
            ("opposite", "3 n^4"),
            ("all", "15 n^4"),
            ("tight", "15 n^4, tight"),
        ] {
            let of = |what: &str| figure(&format!("{kind}-{what}"));
            let (lists, entries) = (of("lists"), of("entries"));
            table += &format!(
                "| {} | {name} | {} | {:.1} | {} | {} | {} | {} | {} |\n",
                grouped(figure("objects")),
                grouped(lists),
                entries as f64 / lists as f64,
                grouped(of("longest")),
                grouped(entries),
                grouped(2 * entries),
                grouped(4 * entries),
                grouped(8 * entries)
            );
        }
    }
    holds_table("paper-loss", &table);
}
