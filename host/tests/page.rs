//! The page of `gridel accuracy` in a browser without a window (Chromium), with real events of mouse and keyboard
//! (chromedriver). Ignored where either is missing, unless `GRIDEL_REQUIRE_BROWSER` is 1.

#[allow(dead_code)]
#[path = "cli/program.rs"]
mod program;

use libtest_mimic::{Arguments, Failed, Trial};
use program::Folder;
use serde_json::{Value, json};
use std::env;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// How long an answer may take.
const LIMIT: Duration = Duration::from_secs(90);

/// Keys, as WebDriver names them.
const TAB: &str = "\u{e004}";
const ENTER: &str = "\u{e007}";
const LEFT: &str = "\u{e012}";
const RIGHT: &str = "\u{e014}";

fn main() {
    let is_missing = ["chromedriver", "chromium"].iter().any(|tool| {
        let paths = env::var_os("PATH").unwrap_or_default();
        !env::split_paths(&paths).any(|path| path.join(tool).is_file())
    });
    let required = env::var_os("GRIDEL_REQUIRE_BROWSER").is_some_and(|value| value == "1");
    let needs = "needs chromium and chromedriver";
    let trial = Trial::test("accuracy_page_answers_mouse_and_keyboard", move || {
        if is_missing {
            return Err(Failed::from(needs));
        }
        page_answers();
        Ok(())
    });
    let kind = if is_missing { needs } else { "" };
    let trial = trial
        .with_kind(kind)
        .with_ignored_flag(is_missing && !required);
    libtest_mimic::run(&Arguments::from_args(), vec![trial]).exit();
}

/// A browser, and the session of its driver.
struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

impl Browser {
    fn open() -> Self {
        // The driver chooses a port, and names it when it is ready.
        let mut driver = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(driver.stdout.take().unwrap()).lines();
        let ready = lines.find_map(|line| {
            let line = line.unwrap();
            let (_, port) = line.split_once("successfully on port ")?;
            port.trim_end_matches('.').parse().ok()
        });
        // What it writes later is read, so that it never waits.
        std::thread::spawn(move || lines.for_each(drop));
        let mut browser = Self {
            driver,
            port: ready.unwrap(),
            session: String::new(),
        };
        let switches = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--window-size=1280,1000",
        ];
        let wanted = json!({"capabilities": {"alwaysMatch": {
            "goog:chromeOptions": {"args": switches},
            "goog:loggingPrefs": {"browser": "ALL"},
        }}});
        let session = browser.call("POST", "/session", &wanted);
        browser.session = format!("/session/{}", session["sessionId"].as_str().unwrap());
        browser
    }

    /// One request of the WebDriver protocol.
    fn call(&self, method: &str, path: &str, body: &Value) -> Value {
        let body = body.to_string();
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(LIMIT)).unwrap();
        write!(
            stream,
            "{method} {}{path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\
             Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
            self.session,
            body.len()
        )
        .unwrap();
        let mut reader = BufReader::new(stream);
        let (mut line, mut length) = (String::new(), 0);
        while reader.read_line(&mut line).unwrap() > 2 {
            let lower = line.to_ascii_lowercase();
            if let Some(bytes) = lower.strip_prefix("content-length:") {
                length = bytes.trim().parse().unwrap();
            }
            line.clear();
        }
        let mut answer = vec![0; length];
        reader.read_exact(&mut answer).unwrap();
        let mut answer: Value = serde_json::from_slice(&answer).unwrap();
        let value = answer["value"].take();
        assert!(value["error"].is_null(), "{method} {path}: {value}");
        value
    }

    fn post(&self, path: &str, body: &Value) -> Value {
        self.call("POST", path, body)
    }

    fn script(&self, script: &str) -> Value {
        self.post("/execute/sync", &json!({"script": script, "args": []}))
    }

    fn text(&self, script: &str) -> String {
        let value = self.script(script);
        value
            .as_str()
            .map_or_else(|| value.to_string(), str::to_owned)
    }

    fn keys(&self, keys: &[&str]) {
        let presses = keys
            .iter()
            .flat_map(|key| ["keyDown", "keyUp"].map(|kind| json!({"type": kind, "value": key})));
        let presses: Vec<_> = presses.collect();
        let source = json!({"type": "key", "id": "keys", "actions": presses});
        self.post("/actions", &json!({"actions": [source]}));
    }

    fn element(&self, xpath: &str) -> Value {
        self.post("/element", &json!({"using": "xpath", "value": xpath}))
    }

    /// Moves the pointer to an element, and clicks on it if asked to.
    fn point(&self, element: &Value, click: bool) {
        let mut moves =
            vec![json!({"type": "pointerMove", "duration": 0, "origin": element, "x": 0, "y": 0})];
        if click {
            moves.push(json!({"type": "pointerDown", "button": 0}));
            moves.push(json!({"type": "pointerUp", "button": 0}));
        }
        let source = json!({"type": "pointer", "id": "mouse",
            "parameters": {"pointerType": "mouse"}, "actions": moves});
        self.post("/actions", &json!({"actions": [source]}));
    }

    fn click(&self, xpath: &str) {
        let element = self.element(xpath);
        self.post(
            "/execute/sync",
            &json!({
                "script": "arguments[0].scrollIntoView({block: 'center'})", "args": [element],
            }),
        );
        self.point(&element, true);
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The driver ends the browser with the session.
        if !self.session.is_empty() && !std::thread::panicking() {
            self.call("DELETE", "", &json!({}));
        }
        drop(self.driver.kill());
        drop(self.driver.wait());
    }
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
    let slider = browser.element("//*[@id='slider']");
    let slider = slider.as_object().unwrap().values().next().unwrap();
    browser.post(
        &format!("/element/{}/value", slider.as_str().unwrap()),
        &json!({"text": LEFT}),
    );
    let border = "return document.getElementById('wipe').style.getPropertyValue('--at')";
    assert_eq!(browser.text(border), "49%");
    browser.click("//button[@aria-label='Compare without shadow']");
    assert_eq!(browser.text(RIGHT_PICTURE), "without shadow");
    std::thread::sleep(Duration::from_millis(300));
    let largest = browser.text("return document.getElementById('difference').dataset.largest");
    assert!(largest.parse::<u32>().unwrap() > 16, "{largest}");

    // A phone's width scrolls in no direction but down, in the dark, too.
    let emulate = |command: &str, parameters: Value| {
        browser.post(
            "/goog/cdp/execute",
            &json!({"cmd": command, "params": parameters}),
        )
    };
    let dark = json!({"features": [{"name": "prefers-color-scheme", "value": "dark"}]});
    emulate("Emulation.setEmulatedMedia", dark);
    let phone = json!({"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": true});
    emulate("Emulation.setDeviceMetricsOverride", phone);
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(
        browser.text("return document.documentElement.scrollWidth"),
        "390"
    );
    let back = "return getComputedStyle(document.body).backgroundColor";
    assert_eq!(browser.text(back), "rgb(21, 23, 26)");

    // Everything that can be reached has a name, and nothing went wrong.
    let unnamed = "return [...document.querySelectorAll('button, select, input, canvas, img, [role=button], [role=region]')]
        .filter((it) => !(it.ariaLabel || it.alt || it.labels?.length || it.textContent.trim()
            || it.getAttribute('aria-labelledby'))).length";
    assert_eq!(browser.text(unnamed), "0");
    assert_eq!(
        browser.post("/se/log", &json!({"type": "browser"})),
        json!([])
    );
}
