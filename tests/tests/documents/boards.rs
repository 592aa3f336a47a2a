//! Figures that the board tests recorded.

use super::{MEMORY, README, holds_table, text};
use gridel_core::{Format, Structure};
use gridel_host::measure::board::Board;
use gridel_host::measure::board::programs::{Footprint, Programs};
use gridel_host::table::grouped;

/// The records of the board tests.
pub fn boards() -> serde_json::Value {
    let recorded = text("fixtures/recorded/board.json");
    serde_json::from_str(&recorded).expect("a table")
}

/// Their records of a scene on a board, through dual-split nodes.
fn on_board(scene: &str, board: &str, format: &str) -> impl Fn(&str) -> u64 {
    of_build(format!("{scene} {board} {format} dual-split"))
}

/// Their records of a build.
fn of_build(build: String) -> impl Fn(&str) -> u64 {
    let recorded = boards();
    move |name| {
        let figure = recorded[&build][name].as_u64();
        figure.unwrap_or_else(|| panic!("no {name} of {build} is recorded"))
    }
}

/// A board's core and a number format.
fn place(board: &str, format: &str) -> String {
    let core = Board::named(board).expect("a board").core;
    format!("{core}, `{format}`")
}

fn cells(figure: &dyn Fn(&str) -> u64, names: &[&str]) -> String {
    let cells = names.iter().map(|name| grouped(figure(name)));
    cells.collect::<Vec<_>>().join(" | ")
}

/// Instructions, in millions.
fn millions(instructions: u64) -> String {
    format!("{:.1}", instructions as f64 / 1e6)
}

#[test]
fn readme_shows_recorded_memory_on_boards() {
    let mut table = String::from(
        "| scene | board | RAM, bytes | flash, bytes | per primary ray | per shadow ray | \
         picture, millions |\n|---|---|---|---|---|---|---|\n",
    );
    for (scene, shown, board, format) in [
        (
            "glass-chess-64",
            "glass chessboard",
            "stm32vldiscovery",
            "fixed",
        ),
        (
            "nanotube",
            "molecule, 2,800 spheres",
            "stm32vldiscovery",
            "fixed",
        ),
        ("torus-mesh", "mesh, 2,048 triangles", "microbit", "fixed"),
        ("glass-chess", "glass chessboard", "sifive_e", "fixed"),
        ("glass-chess", "glass chessboard", "mps2-an386", "f32"),
        ("quick", "six effects, 10 objects", "mps2-an500", "f64"),
    ] {
        let figure = on_board(scene, board, format);
        let figures = cells(
            &figure,
            &[
                "ram-bytes",
                "flash-bytes",
                "ray-instructions",
                "shadow-ray-instructions",
            ],
        );
        table += &format!(
            "| {shown} | {} | {figures} | {} |\n",
            place(board, format),
            millions(figure("picture-instructions"))
        );
    }
    holds_table(README, "memory", &table);
}

#[test]
fn memory_page_shows_recorded_pictures_and_rays() {
    let mut pictures = String::from(
        "| scene, board, format | call stack | RAM | flash | load | per primary ray | \
         per shadow ray | picture |\n|---|---|---|---|---|---|---|---|\n",
    );
    for (scene, board, format) in [
        ("glass-chess-64", "stm32vldiscovery", "fixed"),
        ("nanotube", "stm32vldiscovery", "fixed"),
        ("3dqb", "stm32vldiscovery", "fixed"),
        ("torus-mesh", "microbit", "fixed"),
        ("glass-chess", "microbit", "fixed"),
        ("glass-chess", "sifive_e", "fixed"),
        ("glass-chess", "mps2-an385", "fixed"),
        ("glass-chess", "mps2-an386", "f32"),
        ("glass-chess", "mps2-an505", "f32"),
        ("quick", "mps2-an386", "f32"),
        ("quick", "mps2-an500", "f64"),
    ] {
        let figures = [
            "stack-bound-bytes",
            "ram-bytes",
            "flash-bytes",
            "load-instructions",
            "ray-instructions",
            "shadow-ray-instructions",
            "picture-instructions",
        ];
        let figures = cells(&on_board(scene, board, format), &figures);
        pictures += &format!(
            "| {scene}, {board}, {} | {figures} |\n",
            place(board, format)
        );
    }
    holds_table(MEMORY, "boards", &pictures);

    let mut rays = String::from(
        "| board, format | call stack | call stack of casts | traversal stack | load | \
         per cast | per primary ray | per primary ray, 16 bits |\n|---|---|---|---|---|---|---|---|\n",
    );
    for (board, format) in [
        ("mps2-an386", "f32"),
        ("mps2-an386", "fixed"),
        ("mps2-an385", "fixed"),
        ("sifive_e", "fixed"),
        ("microbit", "fixed"),
    ] {
        let figures = [
            "ray-stack-bytes",
            "cast-stack-bytes",
            "workspace-bytes",
            "load-instructions",
            "cast-instructions",
            "ray-instructions",
        ];
        let wide = cells(&on_board("suzanne", board, format), &figures);
        let narrow = on_board("suzanne-16", board, format)("ray-instructions");
        rays += &format!(
            "| {} | {wide} | {} |\n",
            place(board, format),
            grouped(narrow)
        );
    }
    holds_table(MEMORY, "rays", &rays);
}

/// Returns the costs of programs with code for triangles and a part on the smallest board. There is a fast one, and one
/// of small code if it was built.
fn program(part: &str) -> Vec<Footprint> {
    let parts = match part {
        "base" => vec!["triangle"],
        "absorption" => vec!["triangle", "glass", "absorption"],
        "alpha" => vec!["triangle", "texture", "alpha"],
        "texture-levels" => vec!["triangle", "texture-levels", "texture"],
        "glossy" => vec!["triangle", "glossy", "mirror"],
        "nested" => vec!["triangle", "nested", "glass"],
        "area-light" => vec!["triangle", "falloff", "area-light"],
        "sphere, triangle, shadow" => vec!["triangle", "sphere", "shadow"],
        part => vec!["triangle", part],
    };
    let board = Board::named("stm32vldiscovery").expect("a board");
    let programs = Programs::recorded();
    let program = programs.get((board, Format::Fixed, Structure::DualSplit), &parts);
    let program = program.unwrap_or_else(|| panic!("no program of {parts:?} is recorded"));
    program.fast.into_iter().chain(program.small).collect()
}

#[test]
fn memory_page_shows_recorded_cost_of_shapes_and_effects() {
    let figure = |part: &str, figure: &str| {
        let figure = match figure {
            "code-bytes" => program(part)[0].code,
            "call-stack-bytes" => program(part)[0].call_stack,
            _ => on_board(part, "stm32vldiscovery", "fixed")(figure),
        };
        figure.cast_signed()
    };
    let parts = [
        ("base", ""),
        ("sphere", "base"),
        ("box", "base"),
        ("disc", "base"),
        ("cone", "base"),
        ("torus", "base"),
        ("plane", "base"),
        ("shadow", "base"),
        ("highlight", "base"),
        ("mirror", "base"),
        ("glass", "base"),
        ("absorption", "glass"),
        ("nested", "glass"),
        ("checker", "base"),
        ("smooth", "base"),
        ("normal-map", "base"),
        ("vertex-colors", "base"),
        ("texture", "base"),
        ("texture-levels", "texture"),
        ("alpha", "texture"),
        ("falloff", "base"),
        ("area-light", "falloff"),
        ("tone-mapping", "base"),
        ("emission", "base"),
        ("glossy", "mirror"),
        ("depth-of-field", "base"),
        ("indirect", "base"),
        ("environment", "base"),
        ("sphere, triangle, shadow", "base"),
    ];
    let mut table = String::from(
        "| part | code, bytes | call stack, bytes | instructions per picture |\n|---|---|---|---|\n",
    );
    for (part, without) in parts {
        let cell = |name: &str| match without {
            "" => grouped(figure(part, name)),
            _ => {
                let more = figure(part, name) - figure(without, name);
                let sign = if more < 0 { '-' } else { '+' };
                format!("{sign}{}", grouped(more.unsigned_abs()))
            }
        };
        let name = match part {
            "base" => "triangles in diffuse light",
            _ => part,
        };
        let [code, stack, work] =
            ["code-bytes", "call-stack-bytes", "picture-instructions"].map(cell);
        table += &format!("| {name} | {code} | {stack} | {work} |\n");
    }
    holds_table(MEMORY, "parts", &table);
}

#[test]
fn memory_page_shows_recorded_cost_per_hit() {
    let mut table = String::from("| what | instructions per hit |\n|---|---|\n");
    for (name, scene) in [
        ("colors of vertices", "vertex-colors"),
        ("bilinear texture, a palette", "texture"),
        ("the same between two levels", "texture-levels"),
        ("bilinear normal map, a palette", "normal-map"),
        ("light that is a sphere", "sphere-light"),
        ("light that is a rectangle", "rectangle-light"),
        ("the same from near by", "near-rectangle-light"),
        ("light that is a disc", "disc-light"),
    ] {
        let each = on_board(scene, "mps2-an386", "f32")("hit-instructions");
        table += &format!("| {name} | {each} |\n");
    }
    holds_table(MEMORY, "per-hit", &table);
}

#[test]
fn memory_page_shows_recorded_cost_of_small_code() {
    let mut table = String::from(
        "| build | code, bytes | vector table, bytes | call stack, bytes | load | \
         per primary ray | per shadow ray | picture |\n|---|---|---|---|---|---|---|---|\n",
    );
    let part = "sphere, triangle, shadow";
    for ((name, suffix), footprint) in [
        ("`opt-level = 3`, blob verified at start", ""),
        (
            "`small`, `opt-level = \"z\"`, blob verified at compile time",
            " small",
        ),
    ]
    .into_iter()
    .zip(program(part))
    {
        let recorded = of_build(format!("{part} stm32vldiscovery fixed dual-split{suffix}"));
        let figure = |name: &str| match name {
            "code-bytes" => footprint.code,
            "call-stack-bytes" => footprint.call_stack,
            _ => recorded(name),
        };
        let cells = [
            "code-bytes",
            "vector-bytes",
            "call-stack-bytes",
            "load-instructions",
            "ray-instructions",
            "shadow-ray-instructions",
            "picture-instructions",
        ]
        .map(|name| grouped(figure(name)));
        table += &format!("| {name} | {} |\n", cells.join(" | "));
    }
    holds_table(MEMORY, "small", &table);
}
