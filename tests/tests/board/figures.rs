//! Recorded figures, and whether they grew.

use crate::scenes::repository;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;
use std::{env, fs};

type Table = BTreeMap<String, BTreeMap<String, u64>>;

/// Counts that follow from the scene and are no cost.
const NO_COST: [&str; 4] = ["rays", "hits", "facing", "shadows"];

/// Figures by build and name.
#[derive(Default)]
pub struct Figures(Table);

impl Figures {
    pub fn new() -> Self {
        Self::default()
    }

    pub fn add(&mut self, build: &str, report: &BTreeMap<String, u64>) {
        let costs = report
            .iter()
            .filter(|(name, _)| !NO_COST.contains(&name.as_str()))
            .map(|(name, &value)| (name.clone(), value));
        self.0.entry(build.into()).or_default().extend(costs);
    }

    /// Fails where a figure exceeds the recorded one by more than 2 %, or none is recorded.
    /// With `--nocapture` prints all of them. With `GRIDEL_RECORD_BOARDS=1` records them instead.
    pub fn check(&self) {
        static FILE: Mutex<()> = Mutex::new(());
        let _one_at_a_time = FILE.lock().unwrap_or_else(|poison| poison.into_inner());
        let mut recorded: Table = fs::read(path())
            .ok()
            .map(|bytes| {
                serde_json::from_slice(&bytes).expect("fixtures/recorded/board.json is a table")
            })
            .unwrap_or_default();
        if env::var_os("GRIDEL_RECORD_BOARDS").is_some_and(|value| value == "1") {
            for (build, report) in &self.0 {
                recorded
                    .entry(build.clone())
                    .or_default()
                    .extend(report.clone());
            }
            let text = serde_json::to_string_pretty(&recorded).expect("a table of integers");
            fs::write(path(), text + "\n").expect("the fixtures can be written to");
            return;
        }
        let verbose = env::args().any(|argument| argument == "--nocapture");
        let mut grown = Vec::new();
        for (build, report) in &self.0 {
            for (name, &value) in report {
                let before = recorded.get(build).and_then(|report| report.get(name));
                let change = before.map_or(String::from("not recorded"), |&before| {
                    let percent = 100.0 * (value as f64 / before.max(1) as f64 - 1.0);
                    format!("{percent:+.1} %")
                });
                let line = format!("{build}: {name} {value} ({change})");
                if verbose {
                    println!("{line}");
                }
                if before.is_none_or(|&before| value > before + before / 50) {
                    grown.push(line);
                }
            }
        }
        assert!(
            grown.is_empty(),
            "grew by more than 2 % (GRIDEL_RECORD_BOARDS=1 records them):\n{}",
            grown.join("\n")
        );
    }
}

fn path() -> PathBuf {
    repository().join("fixtures/recorded/board.json")
}

/// Boards are compared with the recorded figures. An entry of a grid has two bytes, and is looked up
/// among its list: that alone takes more.
pub fn loading_takes_less_than_40_instructions_a_byte() {
    let recorded = fs::read(path()).expect("fixtures/recorded/board.json");
    let recorded: Table = serde_json::from_slice(&recorded).expect("a table of integers");
    for (build, report) in &recorded {
        let figures = (report.get("load-instructions"), report.get("blob-bytes"));
        let (Some(&load), Some(&bytes)) = figures else {
            continue;
        };
        let most = if build.ends_with("grid") { 60.0 } else { 40.0 };
        let spent = load as f64 / bytes as f64;
        assert!(spent < most, "{build}: {spent:.1} instructions per byte");
    }
}
