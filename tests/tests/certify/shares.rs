//! The share of proved pixels, for the fixtures and for scenes from elsewhere, and its table in EXACT.md.

use super::{certified, fixtures, settings};
use gridel_host::certify::{Enclosed, Reason};
use gridel_tests::effort::{full, part_of};
use gridel_tests::scenes;

const DOCUMENT: &str = include_str!("../../../host/docs/EXACT.md");

/// Scenes from elsewhere, and whether something in them is glass.
const REAL: [(&str, bool); 13] = [
    ("spd/balls.nff", false),
    ("spd/balls_s2.nff", false),
    ("spd/balls_s5.nff.gz", false),
    ("spd/gears.nff", true),
    ("spd/jacks.nff", false),
    ("spd/mount.nff", true),
    ("spd/sample.nff", false),
    ("spd/sombrero.nff", false),
    ("spd/teapot.nff", false),
    ("spd/tetra.nff", false),
    ("spd/tetra_s3.nff", false),
    ("meshes/spot.obj", false),
    ("molecules/3dqb.pdb", false),
];

/// The least proved part of the fixtures and real scenes.
const LEAST: f64 = 0.99;
/// The least proved part of the Standard Procedural Databases without glass.
const LEAST_WITHOUT_GLASS: f64 = 0.999;

fn row(name: &str, [width, height]: [u16; 2], pixels: &[Enclosed]) -> String {
    let open = pixels.iter().filter(|it| it.proved().is_none());
    let open: Vec<Reason> = open.filter_map(Enclosed::reason).collect();
    let share = 100.0 * (pixels.len() - open.len()) as f64 / pixels.len() as f64;
    let mut reasons = Vec::new();
    for reason in Reason::ALL {
        let count = open.iter().filter(|&&it| it == reason).count();
        if count > 0 {
            reasons.push(format!("{count}: {}", reason.text()));
        }
    }
    let reasons = match reasons.is_empty() {
        true => String::from("none"),
        false => reasons.join("; "),
    };
    format!("| {name} | {width} x {height} | {share:.3} % | {reasons} |")
}

/// The rows of the table in the document.
fn rows() -> Vec<&'static str> {
    let (_, table) = DOCUMENT
        .split_once("<!-- certified scenes -->\n")
        .expect("a table");
    let (table, _) = table.split_once("<!-- end -->").expect("an end");
    table.lines().skip(2).collect()
}

/// With `GRIDEL_FULL=1` the table is measured again; otherwise small pictures of some scenes replace large ones of
/// all.
#[test]
fn the_share_of_proved_pixels_is_as_large_as_promised() {
    let mut measured = Vec::new();
    let mut wrong = Vec::new();
    let mut measure = |name: &str, scene, size: [u16; 2], least: f64| {
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let size = if full() { size } else { [32, 24] };
        let pixels = certified(&scene, &settings(&scene, size, 1));
        let row = row(name, size, &pixels);
        let proved = pixels.iter().filter(|it| it.proved().is_some()).count();
        // One pixel of a small picture is more than what may be open.
        if ((proved + part_of(2, 0)) as f64) < least * pixels.len() as f64 {
            wrong.push(row.clone());
        }
        eprintln!("{row}");
        measured.push(row);
    };
    for (name, scene) in fixtures() {
        if name == "glass-chess" {
            measure("glass-chess", scene.clone(), [400, 300], LEAST);
        }
        measure(&name, scene, [256, 256], LEAST);
    }
    for (path, has_glass) in REAL.into_iter().step_by(part_of(3, 1)) {
        let Some(file) = scenes::real(path) else {
            continue;
        };
        let is_plain = path.starts_with("spd/") && !has_glass;
        let least = if is_plain { LEAST_WITHOUT_GLASS } else { LEAST };
        let (_, name) = path.split_once('/').expect("a folder");
        measure(name, scenes::read(&file), [256, 256], least);
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    if full() {
        let rows = rows();
        let stale = measured.iter().filter(|row| !rows.contains(&row.as_str()));
        let stale: Vec<&String> = stale.collect();
        assert!(
            stale.is_empty(),
            "rows of EXACT.md differ: {stale:#?}\nall:\n{}",
            measured.join("\n")
        );
    }
}

/// The table has every scene, and no share below the promised one.
#[test]
fn the_table_of_proved_pixels_is_complete() {
    let rows = rows();
    let fixtures = fixtures().map(|(name, _)| name);
    let real = REAL
        .iter()
        .filter_map(|(path, _)| path.split_once('/'))
        .map(|(_, name)| name.to_owned());
    for name in fixtures.chain(real) {
        let found = rows
            .iter()
            .filter(|row| row.starts_with(&format!("| {name} |")));
        assert!(found.count() >= 1, "EXACT.md has no row of {name}");
    }
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let share: f64 = cells[3].trim_end_matches(" %").parse().expect("a share");
        let is_plain = REAL
            .iter()
            .any(|(path, glass)| !glass && path.strip_prefix("spd/") == Some(cells[1]));
        let least = if is_plain { LEAST_WITHOUT_GLASS } else { LEAST };
        assert!(share >= 100.0 * least, "{row}");
    }
}
