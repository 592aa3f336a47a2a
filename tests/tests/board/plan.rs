//! The list of tests, made when the program starts. A test is ignored, with the reason, if its board cannot be emulated
//! here or its scene is missing.

use crate::firmware::missing_for;
use crate::scenes;
use gridel_core::Format;
use gridel_host::measure::board::Board;
use libtest_mimic::{Failed, Trial};
use std::collections::BTreeSet;
use std::env;
use std::process::Command;

/// The tests of this program.
#[derive(Default)]
pub struct Plan {
    pub trials: Vec<Trial>,
}

/// A test that is being added to the plan.
pub struct Planned<'p> {
    plan: &'p mut Plan,
    name: String,
    /// Boards that cannot be emulated for want of these.
    tools: BTreeSet<String>,
    scenes: BTreeSet<String>,
    in_full: bool,
    at_length: bool,
}

impl Plan {
    /// A test with a name.
    pub fn test(&mut self, name: impl Into<String>) -> Planned<'_> {
        Planned {
            plan: self,
            name: name.into(),
            tools: BTreeSet::new(),
            scenes: BTreeSet::new(),
            in_full: false,
            at_length: false,
        }
    }

    /// A test of one board in one number format.
    pub fn test_on(&mut self, name: &str, board: &Board, format: Format) -> Planned<'_> {
        let name = format!("{name}::{}::{}", board.name, format.name());
        self.test(name).on(board)
    }
}

impl Planned<'_> {
    /// Needs what emulates a board and builds programs for it.
    pub fn on(mut self, board: &Board) -> Self {
        self.tools.extend(missing_for(board));
        self
    }

    /// Needs a program of this machine.
    pub fn with_tool(mut self, name: &str) -> Self {
        let version = Command::new(name).arg("--version").output();
        if version.is_err() {
            self.tools.insert(name.into());
        }
        self
    }

    /// Needs a scene that does not belong to the repository.
    pub fn with_scene(mut self, path: &str) -> Self {
        if !scenes::real(path).exists() {
            self.scenes.insert(format!("{path} (see GRIDEL_SCENES)"));
        }
        self
    }

    /// Runs only with `GRIDEL_FULL=1`, or where boards are required or recorded.
    pub fn in_full(mut self) -> Self {
        self.in_full = true;
        self
    }

    /// Runs only with `GRIDEL_FULL=1`, or where boards are recorded.
    pub fn at_length(mut self) -> Self {
        self.at_length = true;
        self
    }

    /// [`in_full`](Self::in_full) if it is to run often, else [`at_length`](Self::at_length): for a test of many builds
    /// that runs often on one kind of core.
    pub fn in_full_if(self, often: bool) -> Self {
        match often {
            true => self.in_full(),
            false => self.at_length(),
        }
    }

    /// Adds the test.
    pub fn run(self, test: impl FnOnce() + Send + 'static) {
        let is_set = |name: &str| env::var_os(name).is_some_and(|value| value == "1");
        let required = is_set("GRIDEL_REQUIRE_BOARDS");
        let missing = |what: &BTreeSet<String>| Vec::from_iter(what.clone()).join(", ");
        let at_length = is_set("GRIDEL_FULL") || is_set("GRIDEL_RECORD_BOARDS");
        let full = required || at_length;
        let reason = if is_set("GRIDEL_WITHOUT_BOARDS") {
            Some(String::from("left out by GRIDEL_WITHOUT_BOARDS"))
        } else if !self.scenes.is_empty() {
            Some(format!("needs {}", missing(&self.scenes)))
        } else if !self.tools.is_empty() && !required {
            Some(format!("needs {}", missing(&self.tools)))
        } else if self.in_full && !full || self.at_length && !at_length {
            Some(String::from("runs with GRIDEL_FULL=1"))
        } else {
            None
        };
        let tools = self.tools;
        let trial = Trial::test(self.name, move || {
            if !tools.is_empty() {
                let missing = missing(&tools);
                return Err(Failed::from(format!("cannot be run without {missing}")));
            }
            test();
            Ok(())
        });
        self.plan.trials.push(match reason {
            Some(reason) => trial.with_kind(reason).with_ignored_flag(true),
            None => trial,
        });
    }
}
