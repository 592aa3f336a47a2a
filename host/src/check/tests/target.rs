//! Budgets on a target board, by the memory report.

use super::*;

/// A check of the ball on the smallest board, with more lines.
fn on_discovery(lines: &str) -> String {
    format!(
        "[[check]]\nscene = \"ball.toml\"\ntarget = \"stm32vldiscovery\"\nformats = [\"fixed\"]\n{lines}"
    )
}

fn found(report: &Report, what: &str) -> u64 {
    let mut findings = report.findings.iter();
    match findings.find(|it| it.what == what).map(|it| &it.found) {
        Some(Some(Figure::Count(count))) => *count,
        other => panic!("{what}: {other:?}"),
    }
}

#[test]
fn target_holds_a_scene_that_fits_by_the_memory_report() {
    let folder = Folder::new();
    let (_, report) = folder.run(&on_discovery(""));
    assert_eq!((report.passed(), report.failed()), (2, 0), "{report:?}");
    assert!(
        report.findings.iter().all(|it| {
            it.on.as_deref() == Some("stm32vldiscovery fixed") && it.allowed.is_some()
        })
    );
    // The figures are those of the report, and their own size is no budget's excess.
    let [flash, ram] = ["target flash", "target ram"].map(|what| found(&report, what));
    let budgets = |flash: u64, ram: u64| {
        on_discovery(&format!(
            "[check.budget]\nflash = {flash}\nram = {ram}\ncall_stack = 100_000\n"
        ))
    };
    let (_, report) = folder.run(&budgets(flash, ram));
    assert_eq!((report.passed(), report.failed()), (5, 0), "{report:?}");
    let (_, report) = folder.run(&budgets(flash - 1, ram - 1));
    assert_eq!((report.passed(), report.failed()), (3, 2), "{report:?}");
    for (what, found) in [("flash", flash), ("ram", ram)] {
        let finding = report.findings.iter().find(|it| it.what == what).unwrap();
        let why = why(finding);
        for part in [
            crate::table::grouped(found),
            crate::table::grouped(found - 1),
            String::from("what helps: "),
        ] {
            assert!(why.contains(&part), "{part}: {why}");
        }
    }
}

#[test]
fn target_budgets_show_in_every_form_of_the_report() {
    let folder = Folder::new();
    let (_, report) = folder.run(&on_discovery("budget = { call_stack = 1 }\n"));
    let finding = report.findings.iter().find(|it| it.what == "call_stack");
    assert!(why(finding.unwrap()).contains("at most 1 is allowed"));
    let table = report.table().to_string();
    let json = serde_json::to_string(&report).unwrap();
    let mut junit = Vec::new();
    report.write_junit(&mut junit).unwrap();
    let junit = String::from_utf8(junit).unwrap();
    for text in [&table, &json, &junit] {
        for what in ["target flash", "target ram", "call_stack"] {
            assert!(text.contains(what), "{what}: {text}");
        }
    }
    assert!(junit.contains("call_stack on stm32vldiscovery fixed") && junit.contains("<failure"));
}

#[test]
fn target_budgets_are_recorded_and_a_board_is_not() {
    let folder = Folder::new();
    let text = on_discovery("budget = { flash = 1, ram = 2, call_stack = 3 } # mine\n");
    let (manifest, report) = folder.run(&text);
    assert_eq!(report.failed(), 3);
    let recorded = record(&manifest, &report);
    assert!(recorded.left.is_empty(), "{:?}", recorded.left);
    keep(&recorded);
    let text = folder.text();
    assert!(text.contains("# mine") && text.contains("stm32vldiscovery"));
    let (_, report) = folder.run(&text);
    assert_eq!(report.failed(), 0, "{report:?}");

    // A figure that exceeds the board is not recorded.
    let wide = BALL
        .replace("width = 16", "width = 65535")
        .replace("height = 12", "height = 1024");
    fs::write(folder.path("ball.toml"), wide).unwrap();
    let (manifest, report) = folder.run(&on_discovery(""));
    let broken = report
        .findings
        .iter()
        .find(|it| it.what == "target ram")
        .unwrap();
    assert!(
        why(broken).contains("a narrower picture"),
        "{}",
        why(broken)
    );
    let recorded = record(&manifest, &report);
    assert_eq!(recorded.left, ["ball: target ram"]);
}

#[test]
fn target_without_figures_is_broken_and_says_why() {
    let folder = Folder::new();
    let (_, report) = folder.run(&on_discovery("accel = \"grid\"\n"));
    assert_eq!((report.passed(), report.failed()), (0, 1), "{report:?}");
    let why = why(&report.findings[0]);
    assert!(
        why.contains("grid was not measured on boards") && why.contains("dual-split"),
        "{why}"
    );
}

#[test]
fn target_takes_the_formats_that_the_board_computes() {
    let folder = Folder::new();
    for (board, formats, on) in [
        (
            "mps2-an386",
            "[\"f32\", \"fixed\", \"f64\"]",
            &["mps2-an386 f32", "mps2-an386 fixed"][..],
        ),
        ("microbit", "[\"f32\"]", &["microbit fixed"]),
    ] {
        let (_, report) = folder.run(&format!(
            "[[check]]\nscene = \"ball.toml\"\ntarget = \"{board}\"\nformats = {formats}\n"
        ));
        let mut found: Vec<_> = report
            .findings
            .iter()
            .filter_map(|it| it.on.as_deref())
            .collect();
        found.dedup();
        assert_eq!(found, on);
    }
}

#[test]
fn target_is_held_to_the_structure_and_the_size_of_the_check() {
    let folder = Folder::new();
    let imported = crate::scene::load_with(&folder.path("ball.toml"), &Default::default()).unwrap();
    let options = crate::compile::Options {
        structures: vec![
            gridel_core::Structure::DualSplit,
            gridel_core::Structure::Octree,
        ],
        ..Default::default()
    };
    let compiled = crate::compile::compile(&imported.scene, &options).unwrap();
    fs::write(folder.path("ball.gridel"), compiled.blob.bytes()).unwrap();
    let of_blob = |lines: &str| on_discovery(lines).replace("ball.toml", "ball.gridel");
    let (_, report) = folder.run(&of_blob("accel = \"octree\"\n"));
    assert!(
        why(&report.findings[0]).contains("octree was not measured on boards"),
        "{report:?}"
    );
    // A list takes more code than the nodes that are best, as in a blob of its own.
    let flash = |text: &str| found(&folder.run(text).1, "target flash");
    let code_of = |accel: &str| flash(&of_blob(&format!("accel = \"{accel}\"\n")));
    assert_ne!(code_of("list"), code_of("dual-split"));
    let ram = |text: &str| found(&folder.run(text).1, "target ram");
    let wide = "accel = \"dual-split\"\nsize = [640, 10]\n";
    let narrow = ram(&of_blob("accel = \"dual-split\"\nsize = [16, 12]\n"));
    assert_eq!(ram(&of_blob(wide)), narrow + 2 * (640 - 16));
}

/// As `--target` takes them.
#[test]
fn names_of_targets_can_have_capitals() {
    let manifest = Folder::new().manifest(&on_discovery("").replace("stm32vld", "STM32VLD"));
    let target = manifest.unwrap().checks[0].target;
    assert_eq!(target.map(|board| board.name), Some("stm32vldiscovery"));
}
