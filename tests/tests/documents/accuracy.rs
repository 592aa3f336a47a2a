//! Costs of accuracy, as `gridel accuracy` recorded them.

use super::{BENCHMARKS, README, holds_table, text};
use serde_json::Value;

/// Settings that differ from the first in one parameter.
const SETTINGS: [(&str, Change); 11] = [
    ("1 sample per pixel", |_| ()),
    ("4 samples", |setting| setting.samples = 4),
    ("16 samples", |setting| setting.samples = 16),
    ("64 samples", |setting| setting.samples = 64),
    ("cutoff 1/32", |setting| setting.cutoff = 1.0 / 32.0),
    ("cutoff 0", |setting| setting.cutoff = 0.0),
    ("ray depth 2", |setting| setting.depth = 2),
    ("ray depth 0", |setting| setting.depth = 0),
    ("16 bits", |setting| setting.bits = 16),
    ("12 bits", |setting| setting.bits = 12),
    ("10 bits", |setting| setting.bits = 10),
];

type Change = fn(&mut Setting);

struct Setting {
    samples: u64,
    depth: u64,
    bits: u64,
    cutoff: f64,
}

impl Setting {
    fn is_that_of(&self, point: &Value) -> bool {
        let setting = &point["setting"];
        setting["format"] == "f32"
            && setting["samples"] == self.samples
            && setting["depth"] == self.depth
            && setting["lattice_bits"] == self.bits
            && setting["cutoff"] == self.cutoff
    }
}

/// A table of the settings with these names.
fn table(names: &[&str]) -> String {
    let recorded = text("fixtures/recorded/accuracy.json");
    let recorded: Value = serde_json::from_str(&recorded).expect("a sweep");
    let points = recorded["points"].as_array().expect("points");
    let mut table = String::from(
        "| setting | rays per pixel | RMSE | FLIP | rays that hit another object |\n\
         |---|---|---|---|---|\n",
    );
    for (name, change) in SETTINGS {
        if !names.contains(&name) {
            continue;
        }
        let mut setting = Setting {
            samples: 1,
            depth: 6,
            bits: 24,
            cutoff: 1.0 / 512.0,
        };
        change(&mut setting);
        let mut points = points.iter();
        let point = points.find(|point| setting.is_that_of(point)).expect(name);
        let (errors, cost) = (&point["errors"], &point["cost"]);
        let figure = |value: &Value| value.as_f64().expect("a figure");
        table += &format!(
            "| {name} | {:.1} | {:.4} | {:.4} | {} |\n",
            figure(&cost["rays"]) / figure(&cost["pixels"]),
            figure(&errors["rmse"]),
            figure(&errors["flip"]),
            errors["other_objects"]
        );
    }
    table
}

/// `GRIDEL_BLESS=1` writes the tables.
#[test]
fn documents_show_recorded_cost_of_accuracy() {
    holds_table(
        BENCHMARKS,
        "accuracy",
        &table(&SETTINGS.map(|(name, _)| name)),
    );
    let few = [
        "1 sample per pixel",
        "4 samples",
        "16 samples",
        "ray depth 2",
        "16 bits",
        "10 bits",
    ];
    holds_table(README, "accuracy", &table(&few));
}
