//! The cost of accuracy in time. Sweeps settings, measures their pictures against a reference, and prints the results
//! as a table, as sentences and as plots.
//!
//! | file | what it does |
//! |---|---|
//! | `setting.rs` | what is swept |
//! | `bench.rs`, `plan.rs` | renders and compares; what later settings need |
//! | `truth.rs` | what pictures are compared with |
//! | `columns.rs` | the figures of a setting, in columns |
//! | `ratio.rs` | two times against each other |
//! | `frontier.rs`, `choice.rs` | settings that no other one beats; the best within limits |
//! | `effects.rs` | what each effect costs |
//! | `sentences.rs` | each parameter in one sentence |
//! | `answers.rs` | the answers in three sentences |
//! | `page.rs`, `page.html` | the page, and its template |
//! | `plot.rs` | the plot for documents |
//! | `instances.rs` | what became of instances |

mod answers;
mod bench;
mod choice;
mod columns;
mod effects;
mod frontier;
mod instances;
mod page;
mod plan;
#[cfg(not(target_family = "wasm"))]
mod plot;
mod ratio;
mod sentences;
mod setting;
#[cfg(test)]
mod test_results;
mod truth;

pub use answers::answers;
pub use bench::{Bench, Cost, ErrorParts, MeasureError, Point, Reference};
pub use choice::{Limits, cheapest, most_accurate};
pub use columns::COLUMNS;
pub use effects::{BOARD, EffectCost, effect_costs, given_up};
pub use frontier::{frontier, frontier_by};
pub use instances::instance_notes;
pub use page::{MOST_PICTURE_BYTES, PagePicture, page};
#[cfg(not(target_family = "wasm"))]
pub use plot::plot;
pub use ratio::ONCE;
pub use sentences::sentences;
pub use setting::{
    MOST_MEASURED_SAMPLES, Parameter, Setting, least_reference_samples, reference_setting, sweep,
};
pub use truth::Truth;

use crate::measure::InstanceCount;
use serde::{Deserialize, Serialize};

/// The measurements so far; a sweep writes them every few seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Identifies the sweep: the program's version, the scene, the picture's size, the structure, the reference.
    pub key: String,
    pub base: Setting,
    /// The treatment of the scene's instances; `None` without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instances: Option<InstanceCount>,
    pub reference: Reference,
    pub points: Vec<Point>,
    /// The cost of each effect, in the order in which to leave them out; empty until all is measured.
    #[serde(default)]
    pub effects: Vec<EffectCost>,
}

impl Results {
    /// Returns a point by its setting.
    pub fn point(&mut self, setting: &Setting) -> Option<&mut Point> {
        self.points.iter_mut().find(|p| p.setting == *setting)
    }

    /// Returns the point of the scene file's own setting.
    pub fn start(&self) -> Option<&Point> {
        self.points.iter().find(|it| it.setting == self.base)
    }
}
