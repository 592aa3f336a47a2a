//! The web page in a browser without a window (Chromium), with real events, served by `gridel web`. Ignored unless
//! `GRIDEL_WEB` names the folder of a built page; `just web-test` builds it and runs this.

#[allow(dead_code)]
#[path = "cli/program.rs"]
mod program;

#[allow(dead_code)]
#[path = "browser/mod.rs"]
mod browser;

#[path = "web/page.rs"]
mod page;

#[path = "web/opening.rs"]
mod opening;

#[path = "web/choosing.rs"]
mod choosing;

#[path = "web/drawing.rs"]
mod drawing;

use flate2::Compression;
use flate2::write::GzEncoder;
use libtest_mimic::{Arguments, Failed, Trial};
use page::{Page, assert_no_message, choose, choose_format, content, explain, open, settle, shown};
use serde_json::json;
use std::io::{Cursor, Write};
use std::path::PathBuf;
use std::time::Duration;

/// The most that the whole page may take, each file compressed.
const MOST_BYTES: usize = 1_500_000;

const SHIFT: &str = "\u{e008}";
const RIGHT: &str = "\u{e014}";
const UP: &str = "\u{e013}";

/// A name, and what runs with a page that is served.
type Test = (&'static str, fn(&Page));

fn main() {
    let page = std::env::var_os("GRIDEL_WEB").map(PathBuf::from);
    let needs = match (&page, browser::is_missing()) {
        (None, _) => "needs a built page: GRIDEL_WEB",
        (_, true) => browser::NEEDS,
        _ => "",
    };
    let is_required = page.is_some() && browser::is_required();
    let tests: [Test; 19] = [
        ("web_page_is_small", page_is_small),
        ("web_page_draws_the_pixels_of_the_program", pixels_equal),
        ("web_page_follows_mouse_and_keys", camera_follows),
        ("web_page_measures_explains_and_saves", answers),
        ("web_page_opens_files_and_shows_errors", opening::files_open),
        (
            "web_page_keeps_the_scene_before_a_broken_one",
            opening::scene_stays,
        ),
        (
            "web_page_stops_compiling_for_another_scene",
            opening::compiling_stops,
        ),
        (
            "web_page_rejects_large_pictures_and_keeps_the_scene",
            choosing::large_pictures_fail,
        ),
        (
            "web_page_starts_workers_that_failed_again",
            choosing::workers_start_again,
        ),
        (
            "web_page_lists_scenes_beside_a_broken_one",
            choosing::broken_scenes_are_passed,
        ),
        (
            "web_page_names_files_that_cannot_be_read",
            choosing::unreadable_files_are_named,
        ),
        (
            "web_page_keeps_settings_chosen_while_it_opens",
            choosing::choices_stay,
        ),
        ("web_page_fits_low_windows", choosing::pictures_fit),
        ("web_page_answers_while_it_draws", answers_soon),
        ("web_page_draws_after_an_error", drawing::errors_pass),
        (
            "web_page_switches_views_without_drawing_again",
            drawing::views_switch,
        ),
        (
            "web_page_shows_nothing_of_other_settings",
            drawing::nothing_is_stale,
        ),
        (
            "web_page_stops_measuring_and_restores_settings",
            sweep_stops,
        ),
        (
            "web_page_fits_phones_and_names_everything",
            page_is_accessible,
        ),
    ];
    let trials = tests.map(|(name, test)| {
        let page = page.clone();
        let trial = Trial::test(name, move || {
            let Some(folder) = page.filter(|_| needs.is_empty()) else {
                return Err(Failed::from(needs));
            };
            test(&Page::serve(&folder));
            Ok(())
        });
        let is_ignored = !needs.is_empty() && !is_required;
        trial.with_kind(needs).with_ignored_flag(is_ignored)
    });
    let mut arguments = Arguments::from_args();
    // Each has a browser of its own, which takes all cores.
    arguments.test_threads = Some(1);
    libtest_mimic::run(&arguments, trials.into()).exit();
}

fn page_is_small(page: &Page) {
    let mut bytes = 0;
    let mut folders = vec![page.folder.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
            encoder.write_all(&std::fs::read(&path).unwrap()).unwrap();
            bytes += encoder.finish().unwrap().len();
        }
    }
    println!("the page takes {bytes} bytes, compressed");
    assert!(bytes <= MOST_BYTES, "{bytes}");
}

fn pixels_equal(page: &Page) {
    let browser = page.open();
    let times = browser.text("const { seen, picture } = document.documentElement.dataset; return `${seen} and ${picture}`");
    println!("glass chess: first seen and drawn {times} ms after loading began");
    let chess = "glass-chess.toml";
    assert_eq!(
        shown(&browser),
        page.rendered(&[chess, "--format", "f32", "--accel", "dual-split"])
    );

    choose(&browser, "sample", "quick.toml");
    for (format, structure) in [
        ("fixed", "dual-split"),
        ("f32", "wide"),
        ("f32", "list"),
        ("f64", "bvh"),
        ("f64", "octree"),
    ] {
        choose_format(&browser, format);
        choose(&browser, "structure", structure);
        let expected = page.rendered(&["quick.toml", "--format", format, "--accel", structure]);
        assert!(shown(&browser) == expected, "{format} {structure}");
    }

    // Fewer bits, more samples, another depth and size, one effect less.
    browser.fill("//*[@id='bits']", &"\u{e012}".repeat(12));
    settle(&browser);
    choose(&browser, "samples", "4");
    choose(&browser, "structure", "flagged");
    choose(&browser, "size", "0.5");
    browser.click("//*[@id='effects']//label[input/@value='shadow']");
    settle(&browser);
    let size = browser.text(
        "const { width, height } = document.getElementById('canvas'); return `${width}x${height}`",
    );
    let setting = [
        "quick.toml",
        "--format",
        "f64",
        "--accel",
        "flagged",
        "--lattice-bits",
        "12",
        "--samples",
        "4",
        "--without",
        "shadow",
        "--size",
        &size,
    ];
    assert!(shown(&browser) == page.rendered(&setting));

    // The work of each pixel is the program's too.
    browser.click("//label[input/@value='work']");
    settle(&browser);
    page.rendered(&[&setting[..], &["--heat-map", "work.png"]].concat());
    let png = png::Decoder::new(Cursor::new(page.files.read("work.png")));
    let mut reader = png.read_info().unwrap();
    let mut map = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut map).unwrap();
    assert!(shown(&browser) == map);
    // Counting measures no errors and no time.
    for id in ["rmse", "largest", "different", "time"] {
        assert_eq!(content(&browser, id), "-", "{id}");
    }
    assert_no_message(&browser);
}

fn camera_follows(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    let first = shown(&browser);
    let canvas = browser.element("//*[@id='canvas']");
    let compare = || {
        settle(&browser);
        // The camera as the program takes it, in a comment.
        let toml = content(&browser, "camera");
        let options = toml.lines().next().unwrap().trim_start_matches("# ");
        let options: Vec<_> = options.split(' ').collect();
        let common = ["quick.toml", "--format", "f32", "--accel", "dual-split"];
        let picture = page.rendered(&[&common[..], &options].concat());
        assert!(shown(&browser) == picture, "{toml}");
        assert!(picture != first);
        picture
    };
    let begin = "document.documentElement.dataset.state = 'wait'";
    browser.script(begin);
    browser.drag(&canvas, [60, -20]);
    let dragged = compare();
    browser.script(begin);
    browser.keys(&[UP, RIGHT, "+"]);
    browser.wait("document.documentElement.dataset.state === 'done'");
    std::thread::sleep(Duration::from_millis(300));
    let turned = compare();
    assert!(turned != dragged);
    let wheel = json!({"type": "wheel", "id": "wheel", "actions": [
        {"type": "scroll", "x": 0, "y": 0, "deltaX": 0, "deltaY": -200, "duration": 0, "origin": canvas}]});
    browser.script(begin);
    browser.post("/actions", &json!({"actions": [wheel]}));
    assert!(compare() != turned);
    // Shift and an arrow pan.
    let before = content(&browser, "camera");
    let target = |toml: &str| {
        toml.lines()
            .find(|it| it.starts_with("target"))
            .unwrap()
            .to_owned()
    };
    let pan = json!({"type": "key", "id": "keys", "actions": [
        {"type": "keyDown", "value": SHIFT}, {"type": "keyDown", "value": RIGHT},
        {"type": "keyUp", "value": RIGHT}, {"type": "keyUp", "value": SHIFT}]});
    browser.script(begin);
    browser.post("/actions", &json!({"actions": [pan]}));
    compare();
    assert_ne!(target(&content(&browser, "camera")), target(&before));
    // The first camera again, by its key, whatever moves are under way.
    browser.script(begin);
    browser.keys(&[UP, RIGHT, RIGHT, UP, "+", RIGHT, "r"]);
    settle(&browser);
    std::thread::sleep(Duration::from_millis(300));
    settle(&browser);
    assert!(shown(&browser) == first);
    assert_no_message(&browser);
}

fn answers(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    assert_ne!(content(&browser, "rmse"), "-");
    assert!(content(&browser, "reference-text").contains("f64, 24 lattice bits"));
    // Errors are 0 in the reference's own setting, and not with few bits.
    choose_format(&browser, "f64");
    assert_eq!(content(&browser, "rmse"), "0");
    browser.fill("//*[@id='bits']", &"\u{e012}".repeat(14));
    settle(&browser);
    let rmse: f64 = content(&browser, "rmse").parse().unwrap();
    assert!(rmse > 0.0, "{rmse}");
    browser.fill("//*[@id='bits']", &"\u{e014}".repeat(14));
    settle(&browser);

    // All number formats, one after the other.
    browser.click("//*[@id='measure']");
    browser.wait("document.getElementById('measure').textContent === 'Measure all'");
    settle(&browser);
    let rows = content(&browser, "rows");
    for format in ["fixed", "f32", "f64"] {
        assert!(rows.contains(&format!("{format}, 24 bits")), "{rows}");
    }

    // A click explains what the program explains.
    let canvas = browser.element("//*[@id='canvas']");
    browser.script("document.getElementById('canvas').scrollIntoView({block: 'center'})");
    browser.point(&canvas, true);
    browser.wait("!document.getElementById('explanation').hidden");
    let pixel = browser.text("return `${document.getElementById('pixel-x').value},${document.getElementById('pixel-y').value}`");
    let explained = page.files.done(&[
        "explain",
        "quick.toml",
        "--pixel",
        &pixel,
        "--format",
        "f64",
        "--accel",
        "dual-split",
    ]);
    assert_eq!(content(&browser, "explanation").trim(), explained.trim());

    // Files are those of the program, too.
    let downloads = json!({"behavior": "allow", "downloadPath": page.files.path("")});
    browser.command("Page.setDownloadBehavior", downloads);
    browser.wait("document.getElementById('memory').textContent.includes('dual-split')");
    let report = content(&browser, "memory");
    let expected = page.files.path("expected.gridel").display().to_string();
    page.files.done(&["build", "quick.toml", "-o", &expected]);
    browser.click("//*[@id='save-blob']");
    page.expect_saved("quick.gridel", &page.files.read("expected.gridel"));
    // The report is of the blob that was saved.
    let board = "stm32vldiscovery";
    let inspect = ["inspect", "quick.gridel", "--target", board];
    let inspected = page.files.done(&inspect);
    assert!(inspected.contains(report.trim()), "{report}\n{inspected}");
    assert!(report.contains("name-text"), "{report}");
    page.files.done(&[
        "render",
        "quick.toml",
        "--format",
        "f64",
        "-o",
        "expected.png",
    ]);
    browser.click("//*[@id='save-picture']");
    page.expect_saved("quick.png", &page.files.read("expected.png"));
    browser.click("//*[@id='save-memory']");
    page.expect_saved("quick-stm32vldiscovery.txt", report.as_bytes());

    // A blob that is saved right after a change has it.
    std::fs::remove_file(page.files.path("quick.gridel")).unwrap();
    browser.script(
        "const bits = document.getElementById('bits');
         bits.value = 12;
         bits.dispatchEvent(new Event('change', { bubbles: true }));
         document.getElementById('save-blob').click()",
    );
    let build = ["build", "quick.toml", "--lattice-bits", "12", "-o"];
    page.files.done(&[&build[..], &[&expected]].concat());
    page.expect_saved("quick.gridel", &page.files.read("expected.gridel"));
    settle(&browser);

    // Pixels outside of the picture are errors.
    for (column, message) in [
        ("320", "Column 320 is not in the picture"),
        ("-1", "Column -1 is not in the picture"),
        ("1.5", "Column 1.5 is not in the picture"),
        ("", "Column has no number"),
    ] {
        browser.script(&format!(
            "document.getElementById('pixel-x').value = '{column}';
             document.getElementById('explain').click()"
        ));
        let summary = content(&browser, "summary");
        assert!(summary.starts_with(message), "{summary}");
        assert!(summary.ends_with("from 0 to 319."), "{summary}");
    }

    // Instances have their names.
    page.files.write(
        "two.toml",
        b"[[part]]\nname = 'ball'\n[[part.object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
          [[instance]]\npart = 'ball'\nname = 'left one'\n\
          [[instance]]\npart = 'ball'\nname = 'right one'\ntranslate = [3, 0, 0]\n",
    );
    open(page, &browser, "two.toml");
    settle(&browser);
    explain(&browser, [100, 120]);
    let explained = page
        .files
        .done(&["explain", "two.toml", "--pixel", "100,120"]);
    assert!(explained.contains("left one"), "{explained}");
    let text = content(&browser, "explanation");
    assert!(text.contains("left one"), "{text}");
    assert_no_message(&browser);
}

fn answers_soon(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    let first = shown(&browser);
    // What is drawn fast before must not make the page draw much of what follows at once.
    choose_format(&browser, "f64");
    choose_format(&browser, "f32");
    browser.script(
        "const progress = document.getElementById('progress');
         window.shares = new Set();
         setInterval(() => window.shares.add(progress.value), 20)",
    );
    let samples = |number: u32| {
        browser.script(&format!(
            "document.documentElement.dataset.state = 'wait';
             const samples = document.getElementById('samples');
             samples.value = {number};
             samples.dispatchEvent(new Event('change', {{ bubbles: true }}))"
        ));
    };
    samples(256);
    // Many steps come before the end.
    browser.wait("[...window.shares].filter((it) => it > 0 && it < 0.9).length > 8");
    let state = browser.text("return document.documentElement.dataset.state");
    assert_eq!(state, "drawing");
    // The first ones are small.
    let first_share = "return Math.min(...[...window.shares].filter((it) => it > 0))";
    let first_share: f64 = browser.text(first_share).parse().unwrap();
    assert!(first_share < 0.02, "{first_share}");
    browser
        .wait("document.getElementById('status').textContent.startsWith('Drawing, 256 samples')");
    // A picture is saved once it is finished.
    let downloads = json!({"behavior": "allow", "downloadPath": page.files.path("")});
    browser.command("Page.setDownloadBehavior", downloads);
    browser.click("//*[@id='save-picture']");
    let waits = "The picture will be saved when it is finished";
    assert!(content(&browser, "status").contains(waits));
    samples(1);
    settle(&browser);
    assert!(shown(&browser) == first);
    let setting = ["--format", "f32", "--accel", "dual-split"];
    let render = ["render", "quick.toml", "-o", "expected.png"];
    page.files.done(&[&render[..], &setting].concat());
    page.expect_saved("quick.png", &page.files.read("expected.png"));
    assert!(!content(&browser, "status").contains(waits));
    assert_no_message(&browser);
}

fn sweep_stops(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    choose(&browser, "samples", "4");
    browser.script("document.getElementById('sweep').value = 'bits'");
    let bits = || browser.text("return document.getElementById('bits').value");
    let button = "document.getElementById('measure').textContent";
    let begin = || {
        browser.script("document.documentElement.dataset.state = 'wait'");
        browser.click("//*[@id='measure']");
        browser.wait("document.getElementById('bits').value < 24");
        assert_eq!(browser.text(&format!("return {button}")), "Stop");
    };
    let stopped = || {
        browser.wait(&format!("{button} === 'Measure all'"));
        settle(&browser);
        assert_eq!(bits(), "24");
    };
    begin();
    browser.click("//*[@id='measure']");
    stopped();
    begin();
    browser.script("document.getElementById('canvas').focus()");
    browser.keys(&[RIGHT]);
    stopped();
    // What was changed meanwhile stays.
    begin();
    choose(&browser, "samples", "2");
    stopped();
    assert_eq!(content(&browser, "status").matches("2 samples").count(), 1);
    assert_no_message(&browser);
}

fn page_is_accessible(page: &Page) {
    let browser = page.open();
    assert_eq!(browser.text(browser::UNNAMED), "0");
    // The picture and every control are reached by the Tab key.
    let reached = browser.text(
        "return [...document.querySelectorAll('canvas, select, button, input')].filter((it) => it.tabIndex < 0).length",
    );
    assert_eq!(reached, "0");
    browser.is_whole_on_a_dark_phone();
    assert_no_message(&browser);
}
