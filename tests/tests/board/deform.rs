//! Meshes that deform on boards: boxes and hits are the host's, and a refit costs little.

use crate::casts::Casts;
use crate::figures::Figures;
use crate::firmware::{Build, board};
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use crate::waves::{POSES, pose, sum};
use gridel_core::format::record::{Vertex16, Vertex24};
use gridel_core::format::width::Vertex;
use gridel_core::{Bvh, Deformation, Fixed, Format, Scene, Stack, Structure};
use gridel_host::measure::Deforming;
use gridel_host::measure::board::Board;
use std::collections::BTreeMap;

/// Instructions of a refit of 1,000 triangles at most, on a Cortex-M4F.
const REFIT: u64 = 200_000;

/// Bytes of stack at most while boxes are computed again, the scene's views included.
const STACK: u64 = 1024;

pub fn plan(plan: &mut Plan) {
    for (name, format, lattice_bits) in [
        ("mps2-an386", Format::F32, 24),
        ("mps2-an386", Format::F32, 16),
        ("mps2-an386", Format::Fixed, 24),
        ("mps2-an385", Format::Fixed, 16),
        ("microbit", Format::Fixed, 16),
        ("sifive_e", Format::Fixed, 16),
    ] {
        let board = board(name);
        // The RAM of a microbit holds fewer.
        let [rings, around] = match name {
            "microbit" => [10, 10],
            "sifive_e" => [8, 8],
            _ => [20, 25],
        };
        let test = format!("a_mesh_deforms::{lattice_bits}_bits");
        plan.test_on(&test, board, format).in_full().run(move || {
            let scene = scenes::deforming_torus(rings, around, lattice_bits);
            a_mesh_deforms(board, format, &scene, 2 * u64::from(rings * around));
        });
    }
}

fn a_mesh_deforms(board: &'static Board, format: Format, compiled: &Compiled, triangles: u64) {
    let hosts = match compiled.blob.scene().map(|it| it.header().storage_bits) {
        Ok(16) => on_the_host::<Vertex16>(compiled, format),
        _ => on_the_host::<Vertex24>(compiled, format),
    };
    let moving = Moving {
        program: "deform",
        step: "refit",
        most: REFIT,
    };
    let report = moving.check((board, format), compiled, &hosts, triangles);
    let stack = report["refit-stack-bytes"];
    assert!(stack <= STACK, "{stack} bytes of stack");
}

/// A program that moves a mesh and casts rays at each pose.
pub struct Moving {
    pub program: &'static str,
    /// The step that is measured for each pose.
    pub step: &'static str,
    /// Instructions of it at most, for 1,000 triangles on a Cortex-M4F.
    pub most: u64,
}

impl Moving {
    /// Runs the program: what it finds is the host's, and it takes the memory that is stated. Returns its figures.
    pub fn check(
        &self,
        (board, format): (&'static Board, Format),
        compiled: &Compiled,
        hosts: &[u64],
        triangles: u64,
    ) -> BTreeMap<String, u64> {
        let build = Build::new(board, format, Structure::Bvh, compiled);
        let program = build.program(self.program);
        let (mut found, mut report) = (Vec::new(), BTreeMap::new());
        for (name, value) in program.lines() {
            if ["hits", "sum", "boxes", "normals"].contains(&&*name) {
                found.push(value);
            } else {
                report.insert(name, value);
            }
        }
        assert_eq!(found, hosts, "{build}");
        let scene = compiled.blob.scene().expect("the compiler's own blob");
        let [told] = Deforming::all(&scene, compiled.blob.bytes())[..] else {
            panic!("{build}: the scene has no room")
        };
        assert_eq!(report["deformation-bytes"], told.bytes as u64, "{build}");
        let panicking = program.elf().functions(crate::elf::panics);
        assert!(panicking.is_empty(), "{build} can panic: {panicking:#?}");
        let instructions = report[&format!("{}-instructions", self.step)];
        println!(
            "{build}: {} instructions per triangle",
            instructions / triangles
        );
        if board.core == "Cortex-M4F" {
            let most = self.most * triangles / 1000;
            assert!(instructions <= most, "{build}: {instructions} instructions");
        }
        let mut figures = Figures::new();
        figures.add(&format!("{} {build}", self.program), &report);
        figures.check();
        report
    }
}

/// Casts the programs' rays on the host.
pub fn cast(format: Format, moved: &Scene<'_>) -> Casts {
    let (mut casts, mut stack) = (Casts::default(), Stack::<48>::new());
    match format {
        Format::F32 => casts.run::<f32, Bvh>(moved, stack.as_view()),
        Format::F64 => casts.run::<f64, Bvh>(moved, stack.as_view()),
        Format::Fixed => casts.run::<Fixed, Bvh>(moved, stack.as_view()),
    }
    casts
}

/// Hits, their sum and that of the boxes at each pose.
fn on_the_host<V: Vertex>(compiled: &Compiled, format: Format) -> Vec<u64> {
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let mut mesh: Box<Deformation<V, 512, 1024>> =
        Box::new(Deformation::of(&scene).expect("a deformation"));
    let rest: &[V] = scene.stored_vertices().expect("vertices of this type");
    let mut found = Vec::new();
    for number in 0..POSES {
        pose(rest, mesh.vertices_mut(), number);
        mesh.refit(&scene).expect("a pose");
        let moved = scene.with_deformation(&mesh).expect("a scene");
        let casts = cast(format, &moved);
        let boxes = sum(mesh.pairs());
        found.extend([casts.hits, casts.sum, boxes].map(u64::from));
    }
    found
}
