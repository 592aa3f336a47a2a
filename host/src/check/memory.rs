//! The memory of a scene on a board that is not emulated. Compares figures of the memory report with the board's memory
//! and with budgets.

use super::manifest::Budget;
use super::report::{Figure, Key, Outcome};
use super::run::{Compared, Run};
use crate::measure::board::{
    Account, Board, MemoryReport, NOT_BUILT, Rendering, Target, working_bytes,
};
use crate::table::grouped;
use gridel_core::{Format, Scene, Structure};

impl Run<'_> {
    /// Holds the scene to its `target` in each number format that the board computes.
    pub(super) fn memory(&mut self, scene: &Scene<'_>, structure: Structure, blob: &[u8]) {
        let Some(board) = self.check.target else {
            return;
        };
        for format in formats(board, &self.check.formats) {
            let rendering = Rendering {
                format,
                structure,
                width: self.settings(scene).width,
            };
            self.memory_in(board, &rendering, scene, blob);
        }
    }

    /// Compares the working memory of pictures with its budget, if it has one.
    pub(super) fn working_memory(&mut self, scene: &Scene<'_>, format: Format, blob: &[u8]) {
        const WHAT: &str = "working_bytes";
        let Some(most) = self.check.budget.working_bytes.map(Figure::Count) else {
            return;
        };
        let on = Some(format.name().to_owned());
        match working_bytes(scene, blob, format, scene.view().depth) {
            Some(bytes) => self.budget(on, WHAT, Figure::Count(bytes), Some(most)),
            None => {
                let why = String::from("the views of parts were not measured");
                self.push(on, WHAT, None, Some(most), Outcome::Failed(why));
            }
        }
    }

    fn memory_in(
        &mut self,
        board: &'static Board,
        rendering: &Rendering,
        scene: &Scene<'_>,
        blob: &[u8],
    ) {
        let on = || Some(format!("{} {}", board.name, rendering.format.name()));
        let target = Target {
            board,
            flash: board.flash,
            ram: board.ram,
        };
        let report = match MemoryReport::of(scene, blob, &target, rendering) {
            Ok(report) => report,
            Err(error) => {
                let why = format!("{error}; {}", error.remedy());
                self.push(on(), "target", None, None, Outcome::Failed(why));
                return;
            }
        };
        let unknown = report.undecided().unwrap_or_default();
        for (what, account) in [("target flash", &report.flash), ("target ram", &report.ram)] {
            let outcome = match account.used {
                _ if account.missing() > 0 => {
                    let help = help(&report, what, scene);
                    let most = match report.may_fit(account) {
                        true => "at most ",
                        false => "",
                    };
                    Outcome::Failed(format!(
                        "the scene takes {most}{} bytes more than the {} of {}; what helps: {help}",
                        grouped(account.missing()),
                        grouped(account.available),
                        board.name,
                    ))
                }
                None => Outcome::Failed(format!("whether it fits is undecided: {unknown}")),
                Some(_) => Outcome::Passed,
            };
            let found = account.used.map(Figure::Count);
            let available = Some(Figure::Count(account.available));
            self.push(on(), what, found, available, outcome);
        }
        let Budget {
            ram,
            flash,
            call_stack,
            ..
        } = self.check.budget;
        let stack = report.fast.call_stack.zip(report.small.call_stack);
        let used = |account: &Account| account.used;
        let budgets = [
            ("flash", flash, used(&report.flash)),
            ("ram", ram, used(&report.ram)),
            (
                "call_stack",
                call_stack,
                stack.map(|(fast, small)| fast.max(small)),
            ),
        ];
        for (what, most, found) in budgets {
            let Some(most) = most else {
                continue;
            };
            let allowed = Figure::Count(most);
            let Some(found) = found else {
                let why = format!("whether {what} is within its budget is undecided: {unknown}");
                self.push(on(), what, None, Some(allowed), Outcome::Failed(why));
                continue;
            };
            let keys = ["budget", what].map(|name| Key::Name(name.into()));
            let help = help(&report, what, scene);
            let compared = Compared {
                what,
                found: Figure::Count(found),
                most: Some(allowed),
            };
            self.held_to(on(), compared, keys.into(), Some(help));
        }
    }
}

/// Returns advice that makes a figure smaller.
fn help(report: &MemoryReport, what: &str, scene: &Scene<'_>) -> String {
    let mut steps = match what {
        "call_stack" => report.call_stack_advice(scene),
        "ram" | "target ram" => report.ram_advice(scene),
        _ => report.flash_advice(scene),
    };
    if report.is_bounded {
        steps.insert(0, format!("build the program and measure it: {NOT_BUILT}"));
    }
    if what.ends_with("flash") {
        let blob = "a smaller blob: `gridel build --max-bytes` says what makes it smaller";
        steps.push(String::from(blob));
    }
    steps.join("; ")
}

/// The formats of a check that a board computes itself, or the board's own if it computes none of them.
fn formats(board: &Board, asked: &[Format]) -> Vec<Format> {
    let computed: Vec<Format> = asked
        .iter()
        .copied()
        .filter(|format| board.formats.contains(format))
        .collect();
    match computed.is_empty() {
        true => vec![board.format()],
        false => computed,
    }
}
