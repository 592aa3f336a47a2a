//! Findings, their evidence, and the figures that are recorded.

use super::*;

#[test]
fn broken_figures_are_recorded_and_nothing_else_changes() {
    let folder = Folder::new();
    let text = r#"# The ball.
[[check]]
scene = "ball.toml" # in this folder
formats = ["fixed", "f64"]
samples = 2
hash = {}

[check.budget] # of the board
blob_bytes = 1_000_000 # plenty
stack_entries = 0
working_bytes = 1 # too small
tests_per_ray = 0.25
"#;
    let (manifest, report) = folder.run(text);
    assert_eq!(
        (report.passed(), report.failed(), report.not_run()),
        (2, 6, 0)
    );
    let recorded = record(&manifest, &report);
    assert!(recorded.left.is_empty());
    assert_eq!(folder.text(), text);
    keep(&recorded);
    let new = folder.text();
    let diff = recorded.diff();
    assert!(diff.contains("-working_bytes = 1 # too small\n"), "{diff}");
    assert!(
        new.contains("blob_bytes = 1_000_000 # plenty\nstack_entries = 0\n"),
        "{new}"
    );
    for line in new
        .lines()
        .zip(text.lines())
        .filter(|(new, old)| new != old)
    {
        let changes = [
            "hash = { fixed = \"",
            "working_bytes = ",
            "tests_per_ray = ",
        ];
        assert!(
            changes.iter().any(|change| line.0.starts_with(change)),
            "{line:?}"
        );
        assert_eq!(
            line.0.split_once('#').map(|(_, comment)| comment),
            line.1.split_once('#').map(|(_, comment)| comment)
        );
    }
    // And now everything holds, in both formats.
    let (manifest, report) = folder.run(&new);
    assert_eq!(
        (report.passed(), report.failed()),
        (8, 0),
        "{}",
        report.table()
    );
    assert_eq!(record(&manifest, &report).diff(), "");
}

#[test]
fn recording_keeps_line_ends() {
    let folder = Folder::new();
    let plain = "# by hand\n[[check]]\nscene = \"ball.toml\"\nhash = {} # new\n\n# end\n";
    let mixed = plain.replacen('\n', "\r\n", 4);
    for text in [plain.replace('\n', "\r\n"), mixed, plain.to_owned()] {
        let (manifest, report) = folder.run(&text);
        let recorded = record(&manifest, &report);
        keep(&recorded);
        let new = folder.text();
        let ends = |text: &str| -> Vec<bool> {
            let lines = text.split_inclusive('\n');
            lines.map(|line| line.ends_with("\r\n")).collect()
        };
        assert_eq!(ends(&new), ends(&text), "{new:?}");
        assert_ne!(new, text);
        // One line changes.
        let diff = recorded.diff();
        assert_eq!(
            diff.lines().filter(|it| it.starts_with('-')).count(),
            2,
            "{diff}"
        );
    }
}

/// The picture changes, and nothing else does.
#[test]
fn another_picture_is_broken_and_shown() {
    let folder = Folder::new();
    let text = "[[check]]\nscene = \"ball.toml\"\nhash = {}\nreference = \"ball.png\"\n";
    let (manifest, report) = folder.run(text);
    assert_eq!(report.failed(), 2);
    assert!(why(&report.findings[1]).contains("ball.png cannot be read"));
    keep(&record(&manifest, &report));
    let (_, report) = folder.run(&folder.text());
    assert_eq!((report.passed(), report.failed()), (2, 0));

    fs::write(folder.path("ball.toml"), BALL.replace("= 0.5", "= 0.51")).unwrap();
    let (_, report) = folder.run(&folder.text());
    assert_eq!(report.failed(), 2, "{}", report.table());
    for finding in &report.findings {
        let evidence = finding.evidence.as_ref().unwrap();
        assert_eq!(evidence.name, "ball-f32");
        let mut png = Vec::new();
        let expected = evidence.expected.as_ref().unwrap();
        evidence.rendered.write_beside(expected, &mut png).unwrap();
        let path = folder.path("beside.png");
        fs::write(&path, png).unwrap();
        let beside = Image::read(&path).unwrap();
        assert_eq!(beside.size, [48, 12]);
        // The first pixel is background in all three; it is what differs.
        let panel = |number: usize| beside.pixels[3 * 16 * number];
        assert_eq!((panel(0), panel(1), panel(2)), (188, 189, 255));
    }
    // Within a tolerance the reference holds again.
    let text = folder.text();
    let tolerant = format!("{text}tolerance = {{ channel = 1 }}\n");
    let (_, report) = folder.run(&tolerant);
    assert_eq!(
        (report.passed(), report.failed()),
        (1, 1),
        "{}",
        report.table()
    );
    let tolerant = format!("{text}tolerance = {{ pixels = 191 }}\n");
    let (_, report) = folder.run(&tolerant);
    let found = match report.findings[1].found {
        Some(Figure::Count(found)) => found,
        _ => panic!("{:?}", report.findings[1]),
    };
    assert!((1..=191).contains(&found));
    assert_eq!(report.findings[1].outcome, Outcome::Passed);
}

#[test]
fn unreadable_files_fail_and_other_checks_go_on() {
    let folder = Folder::new();
    fs::write(folder.path("broken.gridel"), "GRIDEL, or not").unwrap();
    fs::write(folder.path("bad.toml"), "object = 3").unwrap();
    let text = "
        [[check]]\nscene = \"missing.toml\"\nhash = {}
        [[check]]\nscene = \"broken.gridel\"\nhash = {}
        [[check]]\nscene = \"bad.toml\"\nhash = {}
        [[check]]\nname = \"blob\"\nscene = \"broken.gridel\"\nlattice_bits = 16\nhash = {}
        [[check]]\nscene = \"ball.toml\"\nbudget = { blob_bytes = 5000 }";
    let (manifest, report) = folder.run(text);
    assert_eq!((report.passed(), report.failed()), (1, 4));
    for (finding, cause) in report.findings.iter().zip([
        "missing.toml cannot be read",
        "broken.gridel is an invalid blob: ",
        "bad.toml:1: `object` holds an integer",
        "`lattice_bits` is for scene files",
    ]) {
        assert!(why(finding).contains(cause), "{}", why(finding));
    }
    // None of that can be recorded.
    let recorded = record(&manifest, &report);
    assert_eq!((recorded.left.len(), recorded.diff().as_str()), (4, ""));
}

/// Broken pictures of all checks and boards lie in one folder.
#[test]
fn evidence_has_names_of_its_own() {
    let folder = Folder::new();
    let check =
        |name: &str| format!("[[check]]\nscene = \"ball.toml\"\nname = \"{name}\"\nhash = {{}}\n");
    let board = "[[check.board]]\nmachine = \"c\"\nelf = \"e\"\nbudget = { x = 1 }\n";
    let text = ["a/b", "a b", "A:B"].map(check).concat() + board + board;
    let manifest = folder.manifest(&text).unwrap();
    let names: Vec<_> = manifest.evidence().collect();
    let expected = ["a-b-f32", "a-b-f32-2", "A-B-f32-3", "A-B-c", "A-B-c-2"];
    assert_eq!(names, expected);
    let (_, report) = folder.run(&text);
    let found = report.findings.iter().filter_map(|it| it.evidence.as_ref());
    let found: Vec<_> = found.map(|evidence| evidence.name.as_str()).collect();
    assert_eq!(found, expected[..3]);
}

#[test]
fn junit_names_suites_cases_and_reasons() {
    let folder = Folder::new();
    let text = "[[check]]\nname = \"a <ball>\"\nscene = \"ball.toml\"\n\
                budget = { blob_bytes = 1, stack_entries = 9 }";
    let (_, report) = folder.run(text);
    let mut xml = Vec::new();
    report.write_junit(&mut xml).unwrap();
    let xml = String::from_utf8(xml).unwrap();
    for part in [
        "<testsuites name=\"gridel check\" tests=\"2\" skipped=\"0\" failures=\"1\" errors=\"0\">",
        "<testsuite name=\"a &lt;ball&gt;\" tests=\"2\" skipped=\"0\" failures=\"1\" errors=\"0\">",
        "<testcase name=\"blob_bytes\" classname=\"a &lt;ball&gt;\">",
        "<property name=\"allowed\" value=\"1\"/>",
        "<failure message=\"",
    ] {
        assert!(xml.contains(part), "{part} in {xml}");
    }
    let tags = |start: &str| xml.matches(start).count();
    for tag in ["testsuites", "testsuite", "testcase", "properties"] {
        let (open, close) = (format!("<{tag} "), format!("</{tag}>"));
        let open = tags(&open) + tags(&format!("<{tag}>"));
        assert_eq!(open, tags(&close), "{tag} in {xml}");
    }
    assert!(xml.contains("blob_bytes is"), "{xml}");
}

/// While they are recorded, a missing file is not the cause.
#[test]
fn formats_that_differ_are_named_where_their_reference_is_not_recorded() {
    let folder = Folder::new();
    let scene = BALL.replace("width = 16, height = 12", "width = 160, height = 120");
    fs::write(folder.path("ball.toml"), scene).unwrap();
    let text = "[[check]]\nscene = \"ball.toml\"\nformats = [\"fixed\", \"f64\"]\nreference = \"one.png\"\n";
    let (manifest, mut report) = folder.run(text);
    assert!(why(&report.findings[0]).contains("let `gridel check --bless`"));
    let recorded = record(&manifest, &report);
    recorded.note_in(&mut report);
    assert_eq!((report.failed(), report.recorded()), (2, 0));
    for finding in &report.findings {
        let why = why(finding);
        let expected = "the picture on f64 differs from another one by more than the `tolerance`";
        assert!(why.contains(expected) && !why.contains("--bless"), "{why}");
    }
}

/// If two pictures differ, neither would pass with the other as its reference.
#[test]
fn pictures_that_differ_are_not_recorded_as_one_reference() {
    let folder = Folder::new();
    fs::write(folder.path("dark.toml"), BALL.replace("= 0.5", "= 0.4")).unwrap();
    let check = |scene: &str, tolerance: &str| {
        // Two paths of one file.
        let path = if scene == "dark" { "./" } else { "" };
        format!("[[check]]\nscene = \"{scene}.toml\"\nreference = \"{path}one.png\"\n{tolerance}")
    };
    let both = |tolerance: &str| check("ball", tolerance) + &check("dark", tolerance);
    for _ in 0..2 {
        let (manifest, mut report) = folder.run(&both(""));
        let recorded = record(&manifest, &report);
        assert!(
            recorded.left[0].contains("name a file for each"),
            "{:?}",
            recorded.left
        );
        assert_eq!((recorded.left.len(), recorded.diff().as_str()), (1, ""));
        recorded.note_in(&mut report);
        assert_eq!(report.recorded(), 0, "{}", report.table());
        // The same where one of them passes with the reference that is there.
        let (manifest, mut report) = folder.run(&check("ball", ""));
        let recorded = record(&manifest, &report);
        keep(&recorded);
        recorded.note_in(&mut report);
        assert_eq!(report.failed(), 0, "{}", report.table());
    }

    fs::remove_file(folder.path("one.png")).unwrap();
    let (manifest, _) = folder.run(&both("tolerance = { channel = 40 }\n"));
    keep(&record(&manifest, &run(&manifest, &|| ())));
    let (_, report) = folder.run(&folder.text());
    assert_eq!(
        (report.passed(), report.failed()),
        (2, 0),
        "{}",
        report.table()
    );

    // No tolerance helps where the sizes differ.
    fs::remove_file(folder.path("one.png")).unwrap();
    let other = check("dark", "size = [8, 6]\n");
    let (manifest, report) = folder.run(&(check("ball", "size = [16, 12]\n") + &other));
    let left = record(&manifest, &report).left.join("\n");
    assert!(left.contains("has another size than another one"), "{left}");
    assert!(!left.contains("tolerance"), "{left}");
}

#[test]
fn gray_references_are_compared() {
    let folder = Folder::new();
    let pixel = [188, 255];
    for (color, channels) in [
        (png::ColorType::Grayscale, 1),
        (png::ColorType::GrayscaleAlpha, 2),
    ] {
        let file = fs::File::create(folder.path("gray.png")).unwrap();
        let mut encoder = png::Encoder::new(file, 16, 12);
        encoder.set_color(color);
        let mut writer = encoder.write_header().unwrap();
        writer
            .write_image_data(&pixel[..channels].repeat(16 * 12))
            .unwrap();
        writer.finish().unwrap();
        let text = "[[check]]\nscene = \"ball.toml\"\nreference = \"gray.png\"\n";
        let (_, report) = folder.run(text);
        // The background is that gray, and the ball is not.
        assert!(
            why(&report.findings[0]).contains("pixels differ"),
            "{}",
            report.table()
        );
        assert!(matches!(
            report.findings[0].found,
            Some(Figure::Count(1..100))
        ));
    }
}

#[test]
fn what_the_lattice_leaves_out_is_a_warning() {
    let folder = Folder::new();
    let speck = BALL.replace(
        "object = [",
        "object = [{ kind = \"sphere\", center = [9e6, 0, 0], radius = 1e6 }, ",
    );
    fs::write(folder.path("ball.toml"), speck).unwrap();
    let (_, report) =
        folder.run("[[check]]\nscene = \"ball.toml\"\nhash = {}\nlattice_bits = 16\n");
    assert_eq!(report.warnings.len(), 1, "{:?}", report.warnings);
    assert!(report.warnings[0].contains("too small for the lattice, left out"));
}

#[test]
fn a_manifest_that_changed_meanwhile_is_not_written_over() {
    let folder = Folder::new();
    let text = "[[check]]\nscene = \"ball.toml\"\nhash = {}\n";
    let (manifest, report) = folder.run(text);
    let edited = format!("# edited\n{text}");
    fs::write(folder.path("check.toml"), &edited).unwrap();
    let (path, error) = record(&manifest, &report).files().unwrap_err();
    assert_eq!(path, folder.path("check.toml"));
    assert!(error.to_string().contains("has changed"), "{error}");
    assert_eq!(folder.text(), edited);
}

#[test]
fn figures_that_differ_little_are_shown_in_full() {
    let folder = Folder::new();
    let with = |most: &str| {
        format!("[[check]]\nscene = \"ball.toml\"\nbudget = {{ tests_per_ray = {most} }}\n")
    };
    let (_, report) = folder.run(&with("0.0"));
    let Some(Figure::Mean(mean)) = report.findings[0].found else {
        panic!("{report:?}");
    };
    let most = mean - 1e-9;
    let (_, report) = folder.run(&with(&most.to_string()));
    let expected = format!("tests_per_ray is {mean}, and at most {most} is allowed");
    assert_eq!(why(&report.findings[0]), expected);
}

#[test]
fn transparent_references_are_rejected() {
    let folder = Folder::new();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 16, 12);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0; 16 * 12 * 4]).unwrap();
    writer.finish().unwrap();
    fs::write(folder.path("r.png"), bytes).unwrap();
    let (_, report) = folder.run(
        "[[check]]\nscene = \"ball.toml\"\nreference = \"r.png\"\ntolerance = { channel = 255 }\n",
    );
    assert!(
        why(&report.findings[0]).contains("transparent"),
        "{report:?}"
    );
}
