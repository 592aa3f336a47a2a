//! The library for C: its header in both languages, its answers to wrong arguments, and its example on boards.

use crate::elf::{Elf, computes_in_floating_point, panics};
use crate::finder;
use crate::firmware::board;
use crate::plan::Plan;
use crate::scenes::{self, Compiled, repository};
use gridel_core::{
    Angle, Camera, Fixed, Format, List, NoCount, Number, Position, Scene, Settings, Stack,
    Structure, Up,
};
use gridel_core::{any_hit, closest_hit};
use gridel_host::compile::{self, Options};
use gridel_host::measure::board::Board;
use gridel_host::scene::load;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub fn plan(plan: &mut Plan) {
    for board in ["mps2-an386", "mps2-an385"].map(board) {
        plan.test_on("the_c_example_gives_the_hosts_bytes", board, board.format())
            .with_tool("arm-none-eabi-gcc")
            .in_full()
            .run(move || the_c_example_gives_the_hosts_bytes(board));
    }
    plan.test("c_functions_answer_wrong_arguments_with_codes")
        .with_tool("cc")
        .with_tool("c++")
        .in_full()
        .run(c_functions_answer_wrong_arguments_with_codes);
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("c-library")
        .join(name);
    fs::create_dir_all(&folder).expect("the target folder can be written to");
    folder
}

/// Runs a command, which has to succeed.
fn run(command: &mut Command) -> Output {
    let output = command.output().expect("the command runs");
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success(), "{command:?}: {out}{err}");
    output
}

/// Builds the example for a board, or for this machine.
fn build(name: &str, format: Format, scene: &Compiled, features: &str) -> PathBuf {
    let folder = folder(name);
    let (blob, program) = (folder.join("scene.gridel"), folder.join("example.elf"));
    fs::write(&blob, scene.blob.bytes()).expect("the target folder can be written to");
    let mut script = Command::new("sh");
    script
        .arg(repository().join("core/c/example/build.sh"))
        .args([name, format.name()])
        .args([&blob, &program])
        .arg(features)
        .env(
            "CARGO_TARGET_DIR",
            Path::new(env!("CARGO_TARGET_TMPDIR")).join("c-library"),
        );
    for (variable, _) in std::env::vars_os() {
        let name = variable.to_string_lossy();
        if name.ends_with("RUSTFLAGS")
            || name.starts_with("CARGO_PROFILE_")
            || name == "CARGO_BUILD_TARGET"
        {
            script.env_remove(&variable);
        }
    }
    run(&mut script);
    program
}

/// The example prints the host's rays and the host's picture, and nothing in it panics. On a core without floating point
/// nothing computes in it.
fn the_c_example_gives_the_hosts_bytes(board: &'static Board) {
    let (scene, format) = (scenes::quick(), board.format());
    let features = [&["dual-split"], &scene.features()[..]].concat().join(",");
    let program = build(board.name, format, &scene, &features);
    let mut emulator = Command::new("qemu-system-arm");
    emulator
        .args([
            "-M",
            board.name,
            "-nographic",
            "-monitor",
            "none",
            "-serial",
            "none",
        ])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(&program);
    let output = run(&mut emulator);
    let view = scene.blob.scene().expect("the compiler's own blob");
    let settings = Settings::of(&view);
    let header = format!("P6\n{} {}\n255\n", settings.width, settings.height).into_bytes();
    let expected = [
        &header[..],
        &scene.picture(format),
        &header,
        &orbited(&view, format),
    ]
    .concat();
    let rays = match format {
        Format::Fixed => rays::<Fixed>(&view),
        Format::F32 => rays::<f32>(&view),
        Format::F64 => rays::<f64>(&view),
    };
    // QEMU may print both on one of its streams.
    let all = [output.stdout, output.stderr].concat();
    let holds = |part: &[u8]| all.windows(part.len()).any(|bytes| bytes == part);
    assert!(
        holds(rays.as_bytes()),
        "{rays}\n{}",
        String::from_utf8_lossy(&all)
    );
    assert!(holds(&expected), "another picture than the host's");
    let elf = Elf::read(&program);
    let panicking = elf.functions(panics);
    assert!(
        panicking.is_empty(),
        "the example can panic: {panicking:#?}"
    );
    if format == Format::Fixed {
        let float = elf.functions(computes_in_floating_point);
        assert!(float.is_empty(), "soft floats: {float:#?}");
    }
    println!("{}: {} bytes of flash", board.name, elf.flash_bytes());
}

/// The picture that the example renders by a camera of its own, through brute force.
fn orbited(scene: &Scene<'_>, format: Format) -> Vec<u8> {
    let [eighth, sixteenth] = [8, 16].map(|whole| Angle::of_turn(1, whole));
    let distance = 8 << -scene.coordinate_exponent();
    let camera = Camera::orbit(Up::Y, Position([0; 3]), distance, eighth, sixteenth, eighth);
    let view = camera.expect("a camera").view(scene);
    let seen = scene.with_view(&view).expect("a view in its ranges");
    scenes::picture(&seen, Structure::List, format)
}

/// Returns the lines that the example prints of its rays, through brute force.
fn rays<N: Number>(scene: &Scene<'_>) -> String {
    let mut stack = Stack::<0>::new();
    let lines = (0..finder::RAYS).map(|turn| {
        let unit = 1 << -scene.coordinate_exponent();
        let direction = [turn - finder::RAYS / 2, -finder::RAYS / 2, 1];
        let ray = scene.ray_within::<N>(Position([0, 4 * unit, 0]), direction, [0, u64::MAX]);
        let ray = ray.expect("a ray");
        let any = any_hit::<N, List, _>(scene, &ray, stack.as_view(), &mut NoCount);
        let hit = closest_hit::<N, List, _>(scene, &ray, stack.as_view(), &mut NoCount);
        let (distance, object, normal) = hit.map_or((u64::MAX, u32::MAX, 0), |hit| {
            (
                scene.distance(&ray, &hit),
                hit.object,
                hit.normal[1].to_q30(),
            )
        });
        format!("{} {object} {normal} {}\n", distance as u32, u32::from(any))
    });
    lines.collect()
}

/// Null, misaligned and short: a program that compiles as C99 and as C++17, without warnings.
fn c_functions_answer_wrong_arguments_with_codes() {
    let scene = scenes::quick();
    let example = build(
        "host",
        Format::Fixed,
        &scene,
        "dual-split,all-shapes,all-effects,instances",
    );
    let folder = folder("host");
    let options = Options {
        structures: vec![Structure::List],
        ..Options::default()
    };
    let quick = load(&scenes::fixture_path("quick"), &Default::default()).expect("a fixture");
    let list = compile::compile(&quick.scene, &options)
        .expect("a fixture")
        .blob;
    fs::write(folder.join("list.gridel"), list.bytes())
        .expect("the target folder can be written to");
    // Hits in it are beyond single precision.
    let ball = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1e39\n";
    let far = gridel_host::scene::read("far.toml".as_ref(), ball.into(), &Default::default());
    let options = Options {
        structures: vec![Structure::DualSplit],
        ..Options::default()
    };
    let far = compile::compile(&far.expect("a scene").scene, &options).expect("a scene");
    let floor = "[[object]]\nkind = 'sphere'\ncenter = [0, 2, 0]\nradius = 3\n\
                 [[object]]\nkind = 'plane'\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n";
    let floor = gridel_host::scene::read("floor.toml".as_ref(), floor.into(), &Default::default());
    let floor = compile::compile(&floor.expect("a scene").scene, &options).expect("a scene");
    let arm = load(&scenes::fixture_path("robot-arm"), &Default::default()).expect("a fixture");
    let arm = compile::compile(&arm.scene, &options).expect("a fixture");
    for (name, compiled) in [("far", far), ("floor", floor), ("arm", arm)] {
        let path = folder.join(name).with_extension("gridel");
        fs::write(path, compiled.blob.bytes()).expect("the target folder can be written to");
    }
    // The example runs here, too.
    let output = run(&mut Command::new(example));
    let view = scene.blob.scene().expect("the compiler's own blob");
    assert!(output.stdout.ends_with(&orbited(&view, Format::Fixed)));

    let library = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c-library");
    let source = repository().join("core/c");
    for (compiler, language, standard) in [("cc", "c", "-std=c99"), ("c++", "c++", "-std=c++17")] {
        let program = folder.join(language);
        let mut compile = Command::new(compiler);
        compile
            .args([
                "-x",
                language,
                standard,
                "-Wall",
                "-Wextra",
                "-Werror",
                "-pedantic",
                "-g",
            ])
            .arg("-I")
            .arg(source.join("include"))
            .arg(source.join("tests/errors.c"))
            .args(["-x", "none"])
            .arg(host_library(&library))
            .args(["-lm", "-lpthread", "-ldl", "-o"])
            .arg(&program);
        run(&mut compile);
        let mut errors = Command::new(&program);
        let blobs = ["scene", "list", "far", "floor", "arm"];
        errors.args(blobs.map(|name| folder.join(name).with_extension("gridel")));
        let said = run(&mut errors);
        println!(
            "{language}: {}",
            String::from_utf8_lossy(&said.stdout).trim()
        );
    }
}

/// The library that the build for this machine wrote.
fn host_library(target: &Path) -> PathBuf {
    let version = run(Command::new("rustc").arg("-vV")).stdout;
    let version = String::from_utf8_lossy(&version).into_owned();
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    target
        .join(host.expect("rustc names its host"))
        .join("release/libgridel.a")
}
