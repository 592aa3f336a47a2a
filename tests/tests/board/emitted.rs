//! Modules of `gridel build --emit-rust`, and blobs that a program prevalidates.

use crate::figures::Figures;
use crate::firmware::{Build, board};
use crate::plan::Plan;
use crate::scenes::{self, Compiled};
use crate::{look_into, parts};
use gridel_core::{Format, Structure};
use gridel_host::compile::Names;
use gridel_host::emit::{self, Emitted};
use std::fs;
use std::path::Path;

pub fn plan(plan: &mut Plan) {
    plan.test("emitted_modules_run_or_do_not_compile")
        .on(board("stm32vldiscovery"))
        .in_full()
        .run(emitted_modules_run_or_do_not_compile);
    type Make = fn() -> Compiled;
    let prevalidated: [(&str, Make); 4] = [
        ("mps2-an385", scenes::quick),
        ("mps2-an385", scenes::molecule),
        ("microbit", scenes::quick),
        ("sifive_e", scenes::quick),
    ];
    for (number, (name, scene)) in prevalidated.into_iter().enumerate() {
        let test = format!("prevalidated_blobs_load_in_constant_time::{number}");
        plan.test_on(&test, board(name), Format::Fixed)
            .in_full()
            .run(move || prevalidated_blob_loads_in_constant_time(name, &scene()));
    }
}

/// A module of `gridel build --emit-rust` runs on a board. It does not compile with a blob other than the one that it
/// was written for, or with one that has no room.
fn emitted_modules_run_or_do_not_compile() {
    let discovery = board("stm32vldiscovery");
    let scene = parts::sphere_and_triangle();
    let view = scene.blob.scene().expect("the compiler's own blob");
    let names = Names {
        objects: vec!["ball".to_owned(), "slope".to_owned()],
        ..Names::default()
    };
    let mut emitted = Emitted {
        scene: &view,
        structure: Structure::DualSplit,
        format: Format::Fixed,
        blob: scene.blob.bytes(),
        names: &names,
        budget: Some((96 * 1024, discovery)),
    };
    let build = Build::new(discovery, Format::Fixed, Structure::DualSplit, &scene);
    let folder = build.folder("emitted");
    let features = [&["emitted"], &scene.features()[..]].concat();
    let outgrown = |features: &[&str], why: &str| {
        let errors = build.try_program("emitted", features).map(|_| ());
        let errors = errors.expect_err("it compiles all the same");
        assert!(errors.contains(why), "{errors}");
    };

    let write = |module: &str, blob: &Compiled| write_module(&folder, module, blob.blob.bytes());
    write(&emitted.module(), &scene);
    let program = build.program_with("emitted", &features);
    program.run();
    assert!(program.file("picture.rgb") == scene.picture(Format::Fixed));

    outgrown(
        &features[..features.len() - 1],
        "the scene requires `shadow`: enable that feature",
    );
    emitted.budget = Some((scene.blob.bytes().len() as u64 - 1, discovery));
    write(&emitted.module(), &scene);
    outgrown(&features, "the blob outgrew the flash of stm32vldiscovery");
    emitted.budget = None;
    let module = emitted.module();
    let mut damaged = scene.blob.bytes().to_vec();
    damaged[200] ^= 1;
    write_module(&folder, &module, &damaged);
    outgrown(&features, "the blob was damaged");
    write_module(&folder, &module, &scene.blob.bytes()[..10]);
    outgrown(&features, "the blob was cut off");
    for (why, other) in parts::outgrown() {
        write(&module, &other);
        outgrown(&features, why);
    }
    let [shallow, deep] = parts::deeper();
    let view = shallow.blob.scene().expect("the compiler's own blob");
    emitted.scene = &view;
    write(&emitted.module(), &deep);
    let features = [&["emitted"], &deep.features()[..]].concat();
    outgrown(&features, "the blob outgrew WORK_DEPTH");
}

/// Firmware that prevalidates its blob loads it in the same time, however long it is, and without the
/// code that proves the rest.
fn prevalidated_blob_loads_in_constant_time(name: &str, scene: &Compiled) {
    let mut figures = Figures::new();
    let build = Build::new(board(name), Format::Fixed, Structure::DualSplit, scene);
    let names = Names::default();
    let emitted = Emitted {
        scene: &scene.blob.scene().expect("the compiler's own blob"),
        structure: Structure::DualSplit,
        format: Format::Fixed,
        blob: scene.blob.bytes(),
        names: &names,
        budget: None,
    };
    let folder = build.folder("emitted");
    write_module(&folder, &emitted.module(), scene.blob.bytes());
    let features = [&["emitted"], &scene.features()[..]].concat();
    let program = build.program_with("emitted", &features);
    let mut report = program.run();
    assert!(program.file("picture.rgb") == scene.picture(Format::Fixed));
    look_into(
        &build,
        &program.elf(),
        board(name),
        Format::Fixed,
        &mut report,
    );
    let load = report["load-instructions"];
    assert!(load <= 6000, "{build}: {load} instructions to load");
    figures.add(&format!("{build} prevalidated"), &report);
    figures.check();
}

/// Writes what `gridel build --emit-rust` does.
fn write_module(folder: &Path, module: &str, blob: &[u8]) {
    fs::write(folder.join(emit::MODULE), module).expect("the target folder can be written to");
    fs::write(folder.join(emit::BLOB), blob).expect("the target folder can be written to");
}
