//! A browser without a window (Chromium), with real events of mouse and keyboard (chromedriver).

use serde_json::{Value, json};
use std::env;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// How long an answer may take.
const LIMIT: Duration = Duration::from_secs(90);

/// The programs that tests of pages need, in words.
pub const NEEDS: &str = "needs chromium and chromedriver";

/// Returns whether the browser or its driver is not installed.
pub fn is_missing() -> bool {
    ["chromedriver", "chromium"].iter().any(|tool| {
        let paths = env::var_os("PATH").unwrap_or_default();
        !env::split_paths(&paths).any(|path| path.join(tool).is_file())
    })
}

/// Returns whether a missing browser is a failure.
pub fn is_required() -> bool {
    env::var_os("GRIDEL_REQUIRE_BROWSER").is_some_and(|value| value == "1")
}

/// Counts what can be reached and has no name.
pub const UNNAMED: &str = "return [...document.querySelectorAll('button, select, input, canvas, img, [role=button], [role=region]')]
    .filter((it) => !(it.ariaLabel || it.alt || it.labels?.length || it.textContent.trim()
        || it.getAttribute('aria-labelledby'))).length";

/// A browser, and the session of its driver.
pub struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

impl Browser {
    pub fn open() -> Self {
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

    pub fn post(&self, path: &str, body: &Value) -> Value {
        self.call("POST", path, body)
    }

    pub fn script(&self, script: &str) -> Value {
        self.post("/execute/sync", &json!({"script": script, "args": []}))
    }

    pub fn text(&self, script: &str) -> String {
        let value = self.script(script);
        value
            .as_str()
            .map_or_else(|| value.to_string(), str::to_owned)
    }

    pub fn keys(&self, keys: &[&str]) {
        let presses = keys
            .iter()
            .flat_map(|key| ["keyDown", "keyUp"].map(|kind| json!({"type": kind, "value": key})));
        let presses: Vec<_> = presses.collect();
        let source = json!({"type": "key", "id": "keys", "actions": presses});
        self.post("/actions", &json!({"actions": [source]}));
    }

    pub fn element(&self, xpath: &str) -> Value {
        self.post("/element", &json!({"using": "xpath", "value": xpath}))
    }

    /// Moves the pointer to an element, and clicks on it if asked to.
    pub fn point(&self, element: &Value, click: bool) {
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

    /// The id of an element, which paths of requests name.
    pub fn id(&self, xpath: &str) -> String {
        let element = self.element(xpath);
        let id = element.as_object().unwrap().values().next().unwrap();
        id.as_str().unwrap().to_owned()
    }

    /// Types into an element; for a choice of files, their paths.
    pub fn fill(&self, xpath: &str, text: &str) {
        let path = format!("/element/{}/value", self.id(xpath));
        self.post(&path, &json!({"text": text}));
    }

    /// A command of the browser's own protocol.
    pub fn command(&self, command: &str, parameters: Value) -> Value {
        let body = json!({"cmd": command, "params": parameters});
        self.post("/goog/cdp/execute", &body)
    }

    /// Shows the page on a phone, in the dark: it scrolls in no direction but down, and its background is dark.
    pub fn is_whole_on_a_dark_phone(&self) {
        let dark = json!({"features": [{"name": "prefers-color-scheme", "value": "dark"}]});
        self.command("Emulation.setEmulatedMedia", dark);
        let phone = json!({"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": true});
        self.command("Emulation.setDeviceMetricsOverride", phone);
        std::thread::sleep(Duration::from_millis(300));
        assert_eq!(
            self.text("return document.documentElement.scrollWidth"),
            "390"
        );
        let back = "return getComputedStyle(document.body).backgroundColor";
        assert_eq!(self.text(back), "rgb(21, 23, 26)");
    }

    /// Waits until a condition holds.
    pub fn wait(&self, condition: &str) {
        let begun = Instant::now();
        while self.text(&format!("return Boolean({condition})")) != "true" {
            assert!(begun.elapsed() < LIMIT, "never came: {condition}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Presses, moves and releases the mouse, from an element's middle by some pixels.
    pub fn drag(&self, element: &Value, [x, y]: [i32; 2]) {
        let moves = json!([
            {"type": "pointerMove", "duration": 0, "origin": element, "x": 0, "y": 0},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerMove", "duration": 50, "origin": element, "x": x / 2, "y": y / 2},
            {"type": "pointerMove", "duration": 50, "origin": element, "x": x, "y": y},
            {"type": "pointerUp", "button": 0},
        ]);
        let source = json!({"type": "pointer", "id": "mouse",
            "parameters": {"pointerType": "mouse"}, "actions": moves});
        self.post("/actions", &json!({"actions": [source]}));
    }

    pub fn click(&self, xpath: &str) {
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
