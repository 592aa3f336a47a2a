//! A page that is served, and what tests do with it.

use crate::browser::Browser;
use crate::program::{self, Folder};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A page that is served, and files of a test.
pub struct Page {
    pub folder: PathBuf,
    pub files: Folder,
    pub server: Child,
    pub url: String,
}

impl Page {
    pub fn serve(folder: &Path) -> Self {
        let files = Folder::new();
        for name in ["glass-chess", "quick"] {
            let scene = program::fixture(name);
            files.write(&format!("{name}.toml"), &scene);
        }
        let folder = folder.canonicalize().unwrap();
        let mut command = files.command(&["web", "--port", "0", "--dir"]);
        let mut server = command.arg(&folder).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        let mut lines = BufReader::new(server.stdout.take().unwrap());
        lines.read_line(&mut line).unwrap();
        let url = line.split(' ').next().unwrap().to_owned();
        assert!(url.starts_with("http://127.0.0.1:"), "{line}");
        Self {
            folder,
            files,
            server,
            url,
        }
    }

    /// A browser that shows the page, once the first picture is compared.
    pub fn open(&self) -> Browser {
        let browser = Browser::open();
        browser.post("/url", &json!({"url": self.url}));
        settle(&browser);
        browser
    }

    /// The sRGB pixels of the program's picture.
    pub fn rendered(&self, arguments: &[&str]) -> Vec<u8> {
        let all = [&["render", "-o", "picture.ppm"], arguments].concat();
        self.files.done(&all);
        let file = self.files.read("picture.ppm");
        let header = file.split_inclusive(|&byte| byte == b'\n').take(3);
        let length: usize = header.map(<[u8]>::len).sum();
        file[length..].to_vec()
    }

    /// Waits until the browser has saved a file with these bytes. It may be there, without all of them, before.
    pub fn expect_saved(&self, name: &str, expected: &[u8]) {
        let path = self.files.path(name);
        let begun = Instant::now();
        loop {
            let saved = std::fs::read(&path);
            if matches!(&saved, Ok(bytes) if bytes == expected) {
                return;
            }
            if begun.elapsed() > Duration::from_secs(30) {
                let found = saved.map(|bytes| bytes.len());
                panic!(
                    "{name}: not the {} bytes expected: {found:?}",
                    expected.len()
                );
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        drop(self.server.kill());
        drop(self.server.wait());
    }
}

/// Waits until what was asked for is drawn and compared.
pub fn settle(browser: &Browser) {
    let begun = Instant::now();
    loop {
        match browser
            .text("return document.documentElement.dataset.state ?? ''")
            .as_str()
        {
            "done" => return,
            "error" => panic!("{}", content(browser, "error-text")),
            _ => {}
        }
        assert!(begun.elapsed() < Duration::from_secs(90), "no picture");
        std::thread::sleep(Duration::from_millis(20));
    }
}

pub fn content(browser: &Browser, id: &str) -> String {
    browser.text(&format!(
        "return document.getElementById('{id}').textContent"
    ))
}

/// The pixels that the canvas shows, three bytes each.
pub fn shown(browser: &Browser) -> Vec<u8> {
    let text = browser.text(
        "const canvas = document.getElementById('canvas');
         const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
         let text = '';
         for (let at = 0; at < data.length; at += 4) text += String.fromCharCode(data[at], data[at + 1], data[at + 2]);
         return btoa(text);",
    );
    STANDARD.decode(text).unwrap()
}

pub fn choose(browser: &Browser, id: &str, value: &str) {
    browser.click(&format!("//*[@id='{id}']"));
    let option = browser.id(&format!("//*[@id='{id}']/option[@value='{value}']"));
    browser.post(&format!("/element/{option}/click"), &json!({}));
    // A list that is open would take the next key.
    let chosen = format!("document.getElementById('{id}').value === '{value}'");
    browser.wait(&chosen);
    settle(browser);
}

pub fn choose_format(browser: &Browser, format: &str) {
    browser.click(&format!(
        "//label[input[@name='format'][@value='{format}']]"
    ));
    settle(browser);
}

/// Opens a file of the test.
pub fn open(page: &Page, browser: &Browser, name: &str) {
    browser.script("document.documentElement.dataset.state = 'wait'");
    let path = page.files.path(name).display().to_string();
    browser.fill("//*[@id='files']", &path);
}

/// Explains a pixel, by its column and row.
pub fn explain(browser: &Browser, [column, row]: [u16; 2]) {
    browser.script(&format!(
        "document.getElementById('explanation').textContent = '';
         document.getElementById('pixel-x').value = {column};
         document.getElementById('pixel-y').value = {row};
         document.getElementById('explain').click()"
    ));
    browser.wait("document.getElementById('explanation').textContent");
}

pub fn assert_no_message(browser: &Browser) {
    let messages = browser.post("/se/log", &json!({"type": "browser"}));
    assert_eq!(messages, json!([]));
}
