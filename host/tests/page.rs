//! The page of `gridel accuracy` in a browser without a window (Chromium), with real events of mouse and keyboard
//! (chromedriver). Ignored where either is missing, unless `GRIDEL_REQUIRE_BROWSER` is 1.

#[allow(dead_code)]
#[path = "cli/program.rs"]
mod program;

#[allow(dead_code)]
#[path = "browser/mod.rs"]
mod browser;

use browser::Browser;
use libtest_mimic::{Arguments, Failed, Trial};
use program::Folder;
use serde_json::json;
use std::time::Duration;

/// Keys, as WebDriver names them.
const TAB: &str = "\u{e004}";
const ENTER: &str = "\u{e007}";
const LEFT: &str = "\u{e012}";
const RIGHT: &str = "\u{e014}";

fn main() {
    let is_missing = browser::is_missing();
    let trial = Trial::test("accuracy_page_answers_mouse_and_keyboard", move || {
        if is_missing {
            return Err(Failed::from(browser::NEEDS));
        }
        page_answers();
        Ok(())
    });
    let kind = if is_missing { browser::NEEDS } else { "" };
    let trial = trial
        .with_kind(kind)
        .with_ignored_flag(is_missing && !browser::is_required());
    libtest_mimic::run(&Arguments::from_args(), vec![trial]).exit();
}

const SHOWN: &str = "return document.querySelector('#card h3').textContent";
const RIGHT_PICTURE: &str =
    "return document.getElementById('right').selectedOptions[0].textContent";

fn page_answers() {
    let folder = Folder::with_quick();
    folder.done(&[
        "accuracy",
        "quick.toml",
        "--size",
        "16x12",
        "--repeat",
        "2",
        "-o",
        "out",
    ]);
    assert!(folder.read("out/page.html").len() < 5 << 20);
    let browser = Browser::open();
    let url = format!("file://{}", folder.path("out/page.html").display());
    browser.post("/url", &json!({"url": url}));
    assert_eq!(
        browser.text("return document.documentElement.dataset.ready"),
        "1"
    );
    let count = |selector: &str| {
        let script = format!("return document.querySelectorAll('{selector}').length");
        browser.script(&script).as_u64().unwrap()
    };
    assert_eq!(count(".answers li"), 3);
    let settings = count(".point");
    assert!(settings > 40 && count(".front-label") > 1);

    // By keyboard: the two switches, then the chart, in which arrows go from setting to setting.
    browser.script("document.body.focus()");
    browser.keys(&[TAB, TAB, TAB]);
    let focused = "return document.activeElement.getAttribute('class')";
    assert!(browser.text(focused).contains("point"));
    let first = browser.text(SHOWN);
    browser.keys(&[RIGHT]);
    let second = browser.text(SHOWN);
    assert_ne!(first, second);
    browser.keys(&[ENTER]);
    assert_eq!(browser.text(RIGHT_PICTURE), second);
    browser.keys(&[LEFT]);
    assert_eq!(browser.text(SHOWN), first);

    // Other axes: boards show the settings whose format was measured there.
    browser.click("//label[input/@value='flip']");
    browser.click("//label[input/@value='cortex-m3']");
    let on_board = count(".point");
    assert!(0 < on_board && on_board < settings, "{on_board}");
    assert!(
        browser
            .text("return document.getElementById('chart-note').textContent")
            .contains("not measured")
    );
    browser.click("//label[input/@value='rays']");
    assert_eq!(count(".point"), settings);

    // By mouse: pointing shows, a click compares.
    let point = browser.element(
        "//*[@id='chart']//*[contains(@class, 'front-label')]/preceding::*[@data-number][1]",
    );
    browser.point(&point, false);
    browser.point(&point, true);
    assert_eq!(browser.text(SHOWN), browser.text(RIGHT_PICTURE));

    // The slider, and the pictures of an effect.
    browser.fill("//*[@id='slider']", LEFT);
    let border = "return document.getElementById('wipe').style.getPropertyValue('--at')";
    assert_eq!(browser.text(border), "49%");
    browser.click("//button[@aria-label='Compare without shadow']");
    assert_eq!(browser.text(RIGHT_PICTURE), "without shadow");
    std::thread::sleep(Duration::from_millis(300));
    let largest = browser.text("return document.getElementById('difference').dataset.largest");
    assert!(largest.parse::<u32>().unwrap() > 16, "{largest}");

    // A phone's width scrolls in no direction but down, in the dark, too.
    browser.is_whole_on_a_dark_phone();

    // Everything that can be reached has a name, and nothing went wrong.
    assert_eq!(browser.text(browser::UNNAMED), "0");
    assert_eq!(
        browser.post("/se/log", &json!({"type": "browser"})),
        json!([])
    );
}
