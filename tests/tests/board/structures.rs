//! Structures against each other, on the paper's sorts of scenes.

use crate::figures::Figures;
use crate::firmware::{Build, board};
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use gridel_core::{Format, Structure};
use std::sync::LazyLock;

pub fn plan(plan: &mut Plan) {
    for (name, format) in PAPER_BOARDS {
        // Twenty-five builds on each, sixteen of them for lists. The chessboard has every kind of list and shape that the
        // other scenes have.
        let often = format == Format::F32;
        plan.test_on("flagged_is_ahead_of_plain", board(name), format)
            .in_full_if(often)
            .run(move || flagged_is_ahead_of_plain(name, format));
        plan.test_on("lists_of_candidates", board(name), format)
            .in_full_if(often)
            .run(move || lists_of_candidates(name, format, |scene| scene == CHESS));
        plan.test_on("lists_of_candidates_of_more", board(name), format)
            .at_length()
            .run(move || lists_of_candidates(name, format, |scene| scene != CHESS));
    }
}

/// The paper's claim, on its own sorts of scenes: whole pictures take less with flagged sides.
fn flagged_is_ahead_of_plain(name: &str, format: Format) {
    const STRUCTURES: [Structure; 3] = [Structure::Bvh, Structure::Flagged, Structure::DualSplit];
    static SCENES: LazyLock<[Compiled; 3]> = LazyLock::new(|| scenes::papers(&STRUCTURES));
    let mut figures = Figures::new();
    for scene in SCENES.iter() {
        let [plain, flagged, dual] = STRUCTURES.map(|structure| {
            let spent = spent(name, format, structure, scene, &mut figures);
            spent.expect("short parts")
        });
        let about = format!("{} {}", scene.name, format.name());
        println!(
            "{about}: plain over flagged {:.3}, over dual-split {:.3}",
            plain / flagged,
            plain / dual
        );
        assert!(flagged < plain, "{about}: flagged sides do not pay");
    }
    figures.check();
}

/// Runs the grid and lists of candidates on a molecule that fills the picture, and on the paper's scenes that fit a
/// board's flash. `flagged_is_ahead_of_plain` records the cost of hierarchies there; the test `documents` compares.
fn lists_of_candidates(name: &str, format: Format, is_measured: fn(&str) -> bool) {
    use Structure::{Apex, CylinderCube, CylinderCubeEntry, CylinderCubeTight, DualSplit, Grid};
    // Gridels a side are those that the builder would find for its budget.
    let [chess, molecule, large] = scenes::PAPERS;
    let all = [
        (chess, Grid, None),
        (chess, CylinderCube, None),
        (chess, CylinderCubeTight, Some(12)),
        (chess, CylinderCubeEntry, Some(12)),
        (chess, Apex, None),
        (molecule, Grid, None),
        (molecule, CylinderCube, None),
        (molecule, CylinderCubeTight, Some(4)),
        (molecule, CylinderCubeEntry, Some(8)),
        (molecule, Apex, None),
        (large, Grid, None),
        (large, CylinderCubeEntry, Some(8)),
        (large, Apex, None),
        (scenes::CLOSE, Grid, None),
        (scenes::CLOSE, DualSplit, None),
        (scenes::CLOSE, Apex, None),
    ];
    let mut figures = Figures::new();
    for (scene, structure, gridels) in all {
        if is_measured(scene) {
            let scene = scenes::paper(scene, &[structure], gridels);
            spent(name, format, structure, &scene, &mut figures);
        }
    }
    figures.check();
}

/// The chessboard.
const CHESS: &str = scenes::PAPERS[0];

/// The boards and number formats on which the paper's scenes are measured.
const PAPER_BOARDS: [(&str, Format); 2] =
    [("mps2-an386", Format::F32), ("mps2-an385", Format::Fixed)];

/// Instructions of a picture, which must be the host's; `None` where a part of it takes longer than
/// the board's timer counts.
fn spent(
    name: &str,
    format: Format,
    structure: Structure,
    scene: &Compiled,
    figures: &mut Figures,
) -> Option<f64> {
    let build = Build::new(board(name), format, structure, scene);
    let program = build.program("picture");
    let report = program.run();
    let picture = program.file("picture.rgb");
    let hosts = scene.picture_through(structure, format);
    assert!(picture == hosts, "{build}: another picture");
    figures.add(&build.to_string(), &report);
    let spent = report.get("picture-instructions");
    spent.map(|&instructions| instructions as f64)
}
