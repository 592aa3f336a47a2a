use super::*;
use crate::scene::SceneError;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// A ball, and a manifest beside it.
struct Folder(TempDir);

const BALL: &str = r#"
background = 0.5
camera = { eye = [0, 0, 4], target = [0, 0, 0] }
render = { width = 16, height = 12 }
light = [{ kind = "point", position = [3, 4, 5] }]
object = [{ kind = "sphere", center = [0, 0, 0], radius = 1 }]
"#;

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("ball.toml"), BALL).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn manifest(&self, text: &str) -> Result<Manifest, SceneError> {
        fs::write(self.path("check.toml"), text).unwrap();
        Manifest::read(&self.path("check.toml"))
    }

    fn run(&self, text: &str) -> (Manifest, Report) {
        let manifest = self.manifest(text).unwrap();
        let steps = std::cell::Cell::new(0);
        let report = run(&manifest, &|| steps.set(steps.get() + 1));
        assert!(steps.get() <= manifest.steps());
        (manifest, report)
    }

    /// The manifest as it is now.
    fn text(&self) -> String {
        fs::read_to_string(self.path("check.toml")).unwrap()
    }
}

fn why(finding: &Finding) -> &str {
    match &finding.outcome {
        Outcome::Held | Outcome::Recorded => "",
        Outcome::Broken(why) | Outcome::NotRun(why) => why,
    }
}

fn record(blessed: &Blessed) {
    blessed.files().unwrap().keep().unwrap();
}

#[test]
fn mistakes_name_line_cause_and_remedy() {
    let folder = Folder::new();
    for (text, line, cause, remedy) in [
        (
            "",
            1,
            "this manifest has no `[[check]]`",
            "add a line `[[check]]`",
        ),
        (
            "check = []",
            1,
            "this manifest has no `[[check]]`",
            "add a line `[[check]]`",
        ),
        (
            "[[check]]\nscene = \".\"\nhash = {}",
            2,
            "is a folder, and no scene",
            "path of a scene file",
        ),
        (
            "[[check]]\nname = \"a\"\nscene = \"lost/..\"\nhash = {}",
            3,
            "is a folder, and no scene",
            "",
        ),
        (
            "[[check]]\nscene = \"ball.toml\"\nhash = {}\n[[check]]\nscene = \"b.toml\"\n\
             reference = \"./ball.toml\"",
            6,
            "ball.toml is a scene",
            "another name",
        ),
        (
            "[[check]]\nscene = \"a\"\nbudget = {}\nformats = [\"f64\"]",
            1,
            "expects nothing",
            "add `hash = {}`",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"\nelf = \"e\"",
            1,
            "expects nothing",
            "`board`",
        ),
        (
            "[[check]]\nscene = \"a\"\nhash = { f32 = \"zz\" }",
            3,
            "`zz` is not a picture hash",
            "--bless",
        ),
        (
            "[[check]]\nname = \"a\"",
            1,
            "has no `scene`",
            "add a line `scene",
        ),
        (
            "[[check]]\nscene = \"a\"\nbugdet = {}",
            3,
            "this check has no key `bugdet`",
            "did you mean `budget`?",
        ),
        (
            "[[check]]\nscene = \"a\"\n[check.budget]\nblob_byte = 3",
            4,
            "this budget has no key `blob_byte`",
            "did you mean `blob_bytes`?",
        ),
        (
            "[[check]]\nscene = \"a\"\nbudget = { blob_bytes = -3 }",
            3,
            "`blob_bytes` is -3",
            "write a number from 0",
        ),
        (
            "[[check]]\nscene = \"a\"\nformats = [\"f33\"]",
            3,
            "`formats` is \"f33\"",
            "did you mean \"f32\"?",
        ),
        (
            "[[check]]\nscene = \"a\"\nformats = [\"f32\", \"f32\"]",
            3,
            "none of them twice",
            "",
        ),
        (
            "[[check]]\nscene = \"a\"\nhash = { fixed = \"\" }",
            3,
            "this hash table has no key `fixed`",
            "The keys are f32",
        ),
        (
            "[[check]]\nscene = \"a\"\naccel = \"flaged\"",
            3,
            "no acceleration structure \"flaged\"",
            "did you mean \"flagged\"?",
        ),
        (
            "[[check]]\nscene = \"a\"\nsize = [1]",
            3,
            "a width and a height",
            "[640, 480]",
        ),
        (
            "[[check]]\nscene = \"a\"\nsize = [0, 1]",
            3,
            "it must be from 1",
            "",
        ),
        (
            "[[check]]\nscene = \"a\"\nsize = [999, 1]",
            3,
            "64 times",
            "",
        ),
        (
            "[[check]]\nscene = \"a\"\ntolerance = {}",
            3,
            "without a `reference`",
            "",
        ),
        (
            "[[check]]\nscene = \"x/a.toml\"\nhash = {}\n[[check]]\nscene = \"a.obj\"\nhash = {}",
            4,
            "two checks have the name \"a\"",
            "another `name`",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"",
            3,
            "this board has no program",
            "`elf = ...`",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"\nelf = \"e\"\ntarget = \"t\"",
            6,
            "needs no `target`",
            "remove the key",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"\nelf = \"e\"\nfirmware = \"f\"",
            5,
            "both",
            "remove one",
        ),
    ] {
        let error = folder.manifest(text).unwrap_err();
        assert_eq!(error.line, Some(line), "{text}: {error}");
        assert!(error.cause.contains(cause), "{text}: {error}");
        assert!(error.remedy.contains(remedy), "{text}: {}", error.remedy);
    }
}

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
        (report.held(), report.broken(), report.not_run()),
        (2, 6, 0)
    );
    let blessed = bless(&manifest, &report);
    assert!(blessed.left.is_empty());
    assert_eq!(folder.text(), text);
    record(&blessed);
    let new = folder.text();
    let diff = blessed.diff();
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
        (report.held(), report.broken()),
        (8, 0),
        "{}",
        report.table()
    );
    assert_eq!(bless(&manifest, &report).diff(), "");
}

/// The picture changes, and nothing else does.
#[test]
fn another_picture_is_broken_and_shown() {
    let folder = Folder::new();
    let text = "[[check]]\nscene = \"ball.toml\"\nhash = {}\nreference = \"ball.png\"\n";
    let (manifest, report) = folder.run(text);
    assert_eq!(report.broken(), 2);
    assert!(why(&report.findings[1]).contains("ball.png cannot be read"));
    record(&bless(&manifest, &report));
    let (_, report) = folder.run(&folder.text());
    assert_eq!((report.held(), report.broken()), (2, 0));

    fs::write(folder.path("ball.toml"), BALL.replace("= 0.5", "= 0.51")).unwrap();
    let (_, report) = folder.run(&folder.text());
    assert_eq!(report.broken(), 2, "{}", report.table());
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
        (report.held(), report.broken()),
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
    assert_eq!(report.findings[1].outcome, Outcome::Held);
}

#[test]
fn what_cannot_be_read_is_broken_and_the_rest_goes_on() {
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
    assert_eq!((report.held(), report.broken()), (1, 4));
    for (finding, cause) in report.findings.iter().zip([
        "missing.toml cannot be read",
        "broken.gridel: ",
        "bad.toml:1: `object` holds an integer",
        "`lattice_bits` is for scene files",
    ]) {
        assert!(why(finding).contains(cause), "{}", why(finding));
    }
    // None of that can be recorded.
    let blessed = bless(&manifest, &report);
    assert_eq!((blessed.left.len(), blessed.diff().as_str()), (4, ""));
}

/// Broken pictures of all checks and boards lie in one folder.
#[test]
fn evidence_has_names_of_its_own() {
    let folder = Folder::new();
    let check =
        |name: &str| format!("[[check]]\nscene = \"ball.toml\"\nname = \"{name}\"\nhash = {{}}\n");
    let board = "[[check.board]]\nmachine = \"c\"\nelf = \"e\"\n";
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

#[cfg(unix)]
mod boards {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    /// A program in place of the emulator.
    fn emulator(folder: &Folder, script: &str) -> String {
        let path = folder.path("emulator");
        let version = "if [ \"$1\" = --version ]; then exit 0; fi";
        fs::write(&path, format!("#!/bin/sh\n{version}\n{script}\n")).unwrap();
        fs::set_permissions(&path, PermissionsExt::from_mode(0o755)).unwrap();
        path.display().to_string()
    }

    fn board(emulator: &str, rest: &str) -> String {
        format!(
            "[[check]]\nscene = \"ball.toml\"\n[[check.board]]\nmachine = \"toy\"\n\
             emulator = \"{emulator}\"\nelf = \"program.elf\"\n{rest}\n"
        )
    }

    #[test]
    fn figures_are_held_and_recorded() {
        let folder = Folder::new();
        fs::write(folder.path("program.elf"), "\x7fELF").unwrap();
        let toy = emulator(
            &folder,
            "echo noise; echo loops 12; echo bytes 500; printf abc >p",
        );
        let text = board(
            &toy,
            "budget = { loops = 12, bytes = 400, lost = 1 } # all\npicture = \"p\"",
        );
        let (manifest, report) = folder.run(&text);
        assert_eq!(
            (report.held(), report.broken(), report.not_run()),
            (1, 3, 0)
        );
        let whys: Vec<_> = report.findings.iter().map(why).collect();
        assert!(
            whys[0].contains("bytes is 500, and at most 400"),
            "{whys:?}"
        );
        assert!(
            whys[2].contains("does not print the figure \"lost\""),
            "{whys:?}"
        );
        assert!(
            whys[3].contains("has 3 bytes and the host's 576"),
            "{whys:?}"
        );
        let blessed = bless(&manifest, &report);
        assert_eq!(blessed.left, ["ball: lost", "ball: picture"]);
        record(&blessed);
        let recorded = "budget = { loops = 12, bytes = 500, lost = 1 } # all";
        assert!(folder.text().contains(recorded), "{}", folder.text());
    }

    #[test]
    fn failures_are_broken_and_what_is_missing_is_not_run() {
        let folder = Folder::new();
        let first = |text: &str| folder.run(text).1.findings.remove(0);
        let budget = "budget = { loops = 1 }\nseconds = 1";
        let toy = emulator(&folder, "echo no luck >&2; exit 3");
        let missing = first(&board(&toy, budget));
        assert!(matches!(&missing.outcome, Outcome::NotRun(why) if why.contains("program.elf")));
        fs::write(folder.path("program.elf"), "\x7fELF").unwrap();
        let missing = first(&board("no-such-emulator", budget));
        assert!(matches!(&missing.outcome, Outcome::NotRun(why) if why.contains("not installed")));
        fs::write(folder.path("program.elf"), BALL).unwrap();
        let text = first(&board(&toy, budget));
        assert!(
            matches!(&text.outcome, Outcome::Broken(why) if why.contains("is not an ELF file"))
        );
        fs::write(folder.path("program.elf"), "\x7fELF").unwrap();
        let failed = first(&board(&toy, budget));
        assert!(matches!(&failed.outcome, Outcome::Broken(why) if why.contains("no luck")));
        let toy = emulator(&folder, "exec sleep 60");
        let endless = first(&board(&toy, budget));
        assert!(matches!(&endless.outcome, Outcome::Broken(why) if why.contains("after 1 s")));
    }
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

#[test]
fn documented_example_is_a_valid_manifest() {
    let document = include_str!("../../docs/CHECK.md");
    let (_, example) = document.split_once("```toml\n").unwrap();
    let (example, _) = example.split_once("```").unwrap();
    let manifest = Folder::new().manifest(example).unwrap();
    assert_eq!(manifest.checks[0].boards[0].budget.len(), 2);
}

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
    assert_eq!((report.held(), report.broken()), (2, 0), "{report:?}");
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
    assert_eq!((report.held(), report.broken()), (5, 0), "{report:?}");
    let (_, report) = folder.run(&budgets(flash - 1, ram - 1));
    assert_eq!((report.held(), report.broken()), (3, 2), "{report:?}");
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
    assert_eq!(report.broken(), 3);
    let blessed = bless(&manifest, &report);
    assert!(blessed.left.is_empty(), "{:?}", blessed.left);
    record(&blessed);
    let text = folder.text();
    assert!(text.contains("# mine") && text.contains("stm32vldiscovery"));
    let (_, report) = folder.run(&text);
    assert_eq!(report.broken(), 0, "{report:?}");

    // What is too large for the board is not recorded.
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
    let blessed = bless(&manifest, &report);
    assert_eq!(blessed.left, ["ball: target ram"]);
}

#[test]
fn target_without_figures_is_broken_and_says_why() {
    let folder = Folder::new();
    let (_, report) = folder.run(&on_discovery("accel = \"grid\"\n"));
    assert_eq!((report.held(), report.broken()), (0, 1), "{report:?}");
    let why = why(&report.findings[0]);
    assert!(
        why.contains("`grid`") && why.contains("dual-split"),
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
        let mut told: Vec<_> = report
            .findings
            .iter()
            .filter_map(|it| it.on.as_deref())
            .collect();
        told.dedup();
        assert_eq!(told, on);
    }
}

#[test]
fn target_mistakes_name_the_boards() {
    let folder = Folder::new();
    let check = "[[check]]\nscene = \"ball.toml\"\n";
    for (lines, parts) in [
        ("target = \"stm32\"\n", ["stm32vldiscovery", "sifive_e"]),
        (
            "budget = { ram = 8192 }\n",
            ["`ram` is a budget on a board", "microbit"],
        ),
        (
            "budget = { call_stack = 1 }\n",
            ["`call_stack`", "target = ..."],
        ),
        (
            "target = \"microbit\"\nbudget = { flash = -1 }\n",
            ["flash", "0"],
        ),
    ] {
        let error = folder.manifest(&format!("{check}{lines}")).unwrap_err();
        let text = format!("{error} {}", miette::Diagnostic::help(&error).unwrap());
        for part in parts {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
