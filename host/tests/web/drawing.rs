//! Changes and failures while the page draws.

use crate::browser::Browser;
use crate::page::{
    Page, assert_no_message, choose, choose_format, content, explain, settle, shown,
};

/// Runs JavaScript with the page's own modules, and waits for its end.
fn with_modules(browser: &Browser, script: &str) -> String {
    browser.text(&format!(
        "return (async () => {{
             const {{ state, workers, shot, frameOf, size }} = await import('/state.js');
             const {{ move }} = await import('/camera.js');
             {script}
         }})()"
    ))
}

/// Counts what made the page begin a picture.
fn changes(browser: &Browser) -> String {
    with_modules(browser, "return state.change")
}

fn state(browser: &Browser) -> String {
    browser.text("return document.documentElement.dataset.state")
}

fn press_view(browser: &Browser, view: &str) {
    browser.script(&format!(
        "document.querySelector('[name=view][value={view}]').click()"
    ));
}

fn samples(browser: &Browser, id: &str, number: u32) {
    browser.script(&format!(
        "const list = document.getElementById('{id}');
         list.value = {number};
         list.dispatchEvent(new Event('change', {{ bubbles: true }}))"
    ));
}

pub fn errors_pass(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    // A picture that waits is drawn after one that fails.
    let drawn = with_modules(
        &browser,
        "const frames = [0, 1].map(() => frameOf(size()));
         const failing = workers.draw({ ...shot(), depth: 99 }, frames[0]).then(() => 'drawn', () => 'failed');
         const waiting = workers.draw({ ...shot(), samples: 1 }, frames[1]);
         return `${await failing}, ${typeof await waiting}`",
    );
    assert_eq!(drawn, "failed, number");
    assert_no_message(&browser);
}

pub fn views_switch(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    let first = shown(&browser);
    // Picture and error need the same pixels.
    samples(&browser, "samples", 256);
    browser.wait("document.getElementById('progress').value > 0");
    let before = changes(&browser);
    press_view(&browser, "error");
    press_view(&browser, "picture");
    assert_eq!(state(&browser), "drawing");
    assert_eq!(changes(&browser), before);
    samples(&browser, "samples", 1);
    settle(&browser);
    assert!(shown(&browser) == first);
    // The error is shown when the reference is drawn, and not before.
    samples(&browser, "reference", 64);
    browser
        .wait("document.getElementById('status').textContent.startsWith('Drawing the reference')");
    press_view(&browser, "error");
    std::thread::sleep(std::time::Duration::from_millis(100));
    assert_eq!(state(&browser), "drawing");
    settle(&browser);
    assert!(content(&browser, "status").contains("error eight times enlarged"));
    assert!(shown(&browser) != first);
    assert_no_message(&browser);
}

pub fn nothing_is_stale(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    let image = "document.getElementById('files').accept.split(',').includes('.hdr')";
    assert_eq!(browser.text(&format!("return {image}")), "true");
    // A camera at its limit leaves all as it is.
    with_modules(&browser, "await move({ zoom: 1000 })");
    settle(&browser);
    explain(&browser, [100, 120]);
    let before = changes(&browser);
    with_modules(&browser, "await move({ zoom: 1 })");
    assert_eq!(state(&browser), "done");
    assert_eq!(changes(&browser), before);
    assert!(!content(&browser, "summary").starts_with("Click"));
    // An explanation is that of the picture, and the report that of the structure.
    browser.wait("!document.getElementById('memory').hidden");
    choose_format(&browser, "f64");
    assert!(content(&browser, "summary").starts_with("Click"));
    let hidden = "return document.getElementById('explanation').hidden";
    assert_eq!(browser.text(hidden), "true");
    browser.script(
        "const structure = document.getElementById('structure');
         structure.value = 'bvh';
         structure.dispatchEvent(new Event('change', { bubbles: true }));",
    );
    let hidden = "return document.getElementById('memory').hidden";
    assert_eq!(browser.text(hidden), "true");
    browser.wait("!document.getElementById('memory').hidden");
    settle(&browser);
    assert_no_message(&browser);
}
