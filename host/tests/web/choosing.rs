//! Choices of sizes, files, and settings while a scene is opened.

use crate::browser::Browser;
use crate::page::{Page, assert_no_message, choose, content, open, settle, shown};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

const BALL: &str = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
const FAILED: &str = "document.documentElement.dataset.state === 'error'";

fn value(browser: &Browser, id: &str) -> String {
    browser.text(&format!("return document.getElementById('{id}').value"))
}

/// JavaScript that chooses values in one go.
fn choosing(values: &[(&str, &str)]) -> String {
    let values = json!(values);
    format!(
        "document.documentElement.dataset.state = 'wait';
         for (const [id, value] of {values}) {{
           const it = document.getElementById(id);
           it.value = value;
           it.dispatchEvent(new Event('change', {{ bubbles: true }}));
         }}"
    )
}

/// A scene whose picture is too large leaves the scene before as it was, with its figures.
pub fn large_pictures_fail(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    let first = shown(&browser);
    for (width, height, remedy) in [(8192, 8193, "choose half"), (65535, 65535, "gridel render")] {
        let scene = format!("[render]\nwidth = {width}\nheight = {height}\n{BALL}");
        page.files.write("large.toml", scene.as_bytes());
        open(page, &browser, "large.toml");
        browser.wait(FAILED);
        let error = content(&browser, "error-text");
        let size = format!("large.toml, {width} x {height} pixels");
        assert!(error.contains(&size) && error.contains(remedy), "{error}");
        assert_eq!(error.contains("choose half"), width == 8192, "{error}");
        // The scene before is drawn again.
        browser.wait("document.getElementById('rmse').textContent !== '-'");
        assert!(shown(&browser) == first);
        assert!(content(&browser, "status").starts_with("quick.toml"));
        assert_eq!(
            browser.text("return document.title").split(':').next(),
            Some("quick.toml")
        );
        assert_eq!(value(&browser, "sample"), "quick.toml");
        assert!(content(&browser, "rows").contains("f32, 24 bits"));
    }
    assert_no_message(&browser);
}

/// A worker that cannot be started is an error, and is started again when the page needs it.
pub fn workers_start_again(page: &Page) {
    let browser = page.open();
    browser.script(
        "window.isDown = true;
         window.Worker = class extends Worker {
           constructor(name) { super(window.isDown ? 'none.js' : name); }
         }",
    );
    browser.script(&choosing(&[("structure", "cylinder-cube-entry")]));
    browser.wait("document.getElementById('status').textContent.startsWith('Compiling')");
    browser.script(&choosing(&[("sample", "quick.toml")]));
    browser.wait(FAILED);
    let error = content(&browser, "error-text");
    assert!(error.contains("worker.js cannot be loaded"), "{error}");
    // What is tried again fails, too.
    browser.wait("document.getElementById('sample').value === 'glass-chess.toml'");
    std::thread::sleep(std::time::Duration::from_secs(1));
    browser.script("window.isDown = false");
    choose(&browser, "sample", "quick.toml");
    let expected = page.rendered(&["quick.toml", "--format", "f32", "--accel", "dual-split"]);
    assert!(shown(&browser) == expected);
    choose(&browser, "structure", "bvh");
    let expected = page.rendered(&["quick.toml", "--format", "f32", "--accel", "bvh"]);
    assert!(shown(&browser) == expected);
}

/// Each of several scene files can be chosen, also if the first one is broken.
pub fn broken_scenes_are_passed(page: &Page) {
    let browser = page.open();
    let folder = page.files.path("many");
    std::fs::create_dir(&folder).unwrap();
    let names = ["c.toml", "a.toml", "e.toml", "b.toml", "d.toml"];
    for name in names {
        std::fs::write(folder.join(name), BALL).unwrap();
    }
    std::fs::write(folder.join("a.toml"), "x = 1\n").unwrap();
    browser.script("document.documentElement.dataset.state = 'wait'");
    let data =
        json!({"items": [], "files": [folder.display().to_string()], "dragOperationsMask": 1});
    for kind in ["dragEnter", "dragOver", "drop"] {
        let event = json!({"type": kind, "x": 200, "y": 200, "data": data});
        browser.command("Input.dispatchDragEvent", event);
    }
    browser.wait(FAILED);
    let error = content(&browser, "error-text");
    assert!(error.contains("many/a.toml:1"), "{error}");
    // By the alphabet, and none of them is shown.
    let listed = "return [...document.getElementById('main').options].map((it) => it.value.slice(5)).filter(Boolean).join(' ')";
    assert_eq!(browser.text(listed), "a.toml b.toml c.toml d.toml e.toml");
    assert_eq!(value(&browser, "main"), "");
    assert_eq!(value(&browser, "sample"), "glass-chess.toml");
    choose(&browser, "main", "many/b.toml");
    assert!(content(&browser, "status").starts_with("many/b.toml"));
    let ball = shown(&browser);
    assert!(ball == page.rendered(&["many/b.toml", "--format", "f32", "--accel", "dual-split"]));
    // A broken one leaves the one that is shown chosen.
    browser.script(&choosing(&[("main", "many/a.toml")]));
    browser.wait(FAILED);
    assert_eq!(value(&browser, "main"), "many/b.toml");
    assert!(shown(&browser) == ball);
    assert_no_message(&browser);
}

/// Files that cannot be read are left out with a warning, unless they are the scene.
pub fn unreadable_files_are_named(page: &Page) {
    let browser = page.open();
    browser.script(
        "const own = File.prototype.arrayBuffer;
         File.prototype.arrayBuffer = function () {
           return this.name.startsWith('lost') ? Promise.reject(new DOMException('no access.', 'NotReadableError')) : own.call(this);
         }",
    );
    let give = |files: &[(&str, &str)]| {
        let files = json!(files);
        browser.script(&format!(
            "document.documentElement.dataset.state = 'wait';
             const dataTransfer = new DataTransfer();
             for (const [name, text] of {files}) dataTransfer.items.add(new File([text], name));
             document.body.dispatchEvent(new DragEvent('drop', {{ bubbles: true, dataTransfer }}))"
        ));
    };
    give(&[("ball.toml", BALL), ("lost.png", "")]);
    settle(&browser);
    let warnings = content(&browser, "warnings");
    let cause = "lost.png cannot be read: no access;";
    assert!(warnings.contains(cause), "{warnings}");
    let import = "[[object]]\nkind = 'import'\nfile = 'lost.obj'\n";
    for files in [
        &[("lost.obj", "")][..],
        &[("in.toml", import), ("lost.obj", "")],
    ] {
        give(files);
        browser.wait(FAILED);
        let error = content(&browser, "error-text");
        assert!(
            error.contains("lost.obj cannot be read: no access\n"),
            "{error}"
        );
    }
    // Without the error, the focus is in the picture, or where it was.
    for id in ["canvas", "board"] {
        browser.script(&format!("document.getElementById('{id}').focus()"));
        browser.script("document.getElementById('error').hidden = false");
        browser.click("//*[@id='error-close']");
        assert_eq!(browser.text("return document.activeElement.id"), id);
    }
    assert_no_message(&browser);
}

/// Settings that are chosen while a scene is opened are those of the new scene, if it can have them.
pub fn choices_stay(page: &Page) {
    let browser = page.open();
    let chosen = [("structure", "bvh"), ("samples", "4"), ("depth", "2")];
    let values = [&[("sample", "quick.toml")][..], &chosen].concat();
    browser.script(&choosing(&values));
    settle(&browser);
    for (id, kept) in chosen {
        assert_eq!(value(&browser, id), kept);
    }
    let setting = [
        "--format",
        "f32",
        "--accel",
        "bvh",
        "--samples",
        "4",
        "--depth",
        "2",
    ];
    assert!(shown(&browser) == page.rendered(&[&["quick.toml"][..], &setting].concat()));
    // What was chosen before is not.
    choose(&browser, "sample", "glass-chess.toml");
    assert_eq!(value(&browser, "structure"), "dual-split");
    // A blob has its own structures.
    page.files.done(&[
        "build",
        "quick.toml",
        "-o",
        "one.gridel",
        "--accel",
        "dual-split",
    ]);
    let blob = STANDARD.encode(page.files.read("one.gridel"));
    browser.script(&format!(
        "const dataTransfer = new DataTransfer();
         const bytes = Uint8Array.from(atob('{blob}'), (it) => it.charCodeAt(0));
         dataTransfer.items.add(new File([bytes], 'one.gridel'));
         document.body.dispatchEvent(new DragEvent('drop', {{ bubbles: true, dataTransfer }}));
         {}",
        choosing(&[("structure", "wide"), ("samples", "2")])
    ));
    settle(&browser);
    assert_eq!(value(&browser, "structure"), "dual-split");
    assert!(
        content(&browser, "reference-text").starts_with("Reference: the blob itself in f64, 24")
    );
    assert_no_message(&browser);
}

/// The first picture fits low windows, with room to scroll beside it.
pub fn pictures_fit(page: &Page) {
    let browser = Browser::open();
    for (width, height, is_phone, most) in [(1280, 500, false, 425.0), (740, 360, true, 250.0)] {
        let window =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": is_phone});
        browser.command("Emulation.setDeviceMetricsOverride", window);
        browser.post("/url", &json!({"url": page.url}));
        settle(&browser);
        let tall = "return document.getElementById('canvas').getBoundingClientRect().height";
        let tall: f64 = browser.text(tall).parse().unwrap();
        assert!(tall > 200.0 && tall <= most, "{tall}");
    }
    // Shares tell few pixels from none, and most from all.
    let shares = browser.text(
        "return import('/table.js').then(({ shareText }) => [0, 0.00003, 0.25, 0.99998, 1].map(shareText).join(', '))",
    );
    assert_eq!(shares, "0 %, 0.003 %, 25.00 %, 99.998 %, 100 %");
    assert_no_message(&browser);
}
