//! Meshes that morph on boards: vertices, normals, boxes and hits are the host's, and a pose costs little.

use crate::deform::{Moving, cast};
use crate::firmware::board;
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use crate::waves::{POSES, sum, sum_of_normals};
use gridel_core::deform::MorphTargets;
use gridel_core::format::record::{Vertex16, Vertex24};
use gridel_core::format::width::Vertex;
use gridel_core::{Format, Tracks};
use gridel_host::deformation::{self, HeapDeformation};
use gridel_host::measure::board::Board;

/// Instructions of two morph targets, normals and boxes of 1,000 triangles at most, on a Cortex-M4F.
const POSE: u64 = 600_000;

pub fn plan(plan: &mut Plan) {
    for (name, format, lattice_bits, rings, around) in [
        ("mps2-an386", Format::F32, 24, 20, 25),
        ("mps2-an385", Format::Fixed, 16, 20, 25),
        ("sifive_e", Format::Fixed, 16, 8, 8),
    ] {
        let board = board(name);
        plan.test_on("a_mesh_morphs", board, format)
            .in_full()
            .run(move || {
                let scene = scenes::morphing_torus(rings, around, lattice_bits);
                a_mesh_morphs(board, format, &scene, 2 * u64::from(rings * around));
            });
    }
}

fn a_mesh_morphs(board: &'static Board, format: Format, compiled: &Compiled, triangles: u64) {
    let hosts = match compiled.blob.scene().map(|it| it.header().storage_bits) {
        Ok(16) => on_the_host::<Vertex16>(compiled, format),
        _ => on_the_host::<Vertex24>(compiled, format),
    };
    let moving = Moving {
        program: "morph",
        step: "morph",
        most: POSE,
    };
    moving.check((board, format), compiled, &hosts, triangles);
}

/// Hits, their sum, and those of boxes and normals at each time.
fn on_the_host<V: Vertex>(compiled: &Compiled, format: Format) -> Vec<u64> {
    let (scene, blob) = (compiled.blob.scene(), compiled.blob.bytes());
    let scene = scene.expect("the compiler's own blob");
    let tracks = Tracks::from_bytes(blob).expect("tracks");
    let morph = MorphTargets::from_bytes(blob).expect("morph targets");
    let mut mesh: HeapDeformation<V> = deformation::of(&scene).expect("a deformation");
    let mut found = Vec::new();
    for number in 0..POSES {
        let mut weights = vec![0; morph.weights_at_rest().len()];
        let time = tracks.frame_time(number, 4);
        tracks.weights_at(time, &mut weights).expect("weights");
        mesh.morph(&scene, &morph, &weights).expect("a pose");
        let moved = scene.with_deformation(&mesh).expect("a scene");
        let casts = cast(format, &moved);
        let (boxes, normals) = (sum(mesh.pairs()), sum_of_normals(mesh.normals()));
        found.extend([casts.hits, casts.sum, boxes, normals].map(u64::from));
    }
    found
}
