//! What a reader of the figures has to know about the instances of a scene.

use crate::measure::InstanceCount;
use crate::measure::board::programs::Programs;
use crate::table::{counted, grouped};

/// Sentences about what became of instances, and about costs that they have beside those of the table.
pub fn instance_notes(instances: &InstanceCount) -> Vec<String> {
    let mut notes = vec![format!("{}.", instances.text())];
    if let Some(parts) = instances.parts {
        let parts_text = counted(parts, "part");
        notes.extend(Programs::recorded().part_view().map(|bytes| {
            let bytes = grouped(bytes * parts as u64);
            format!("On a board the views of {parts_text} take at most {bytes} bytes of RAM more.")
        }));
        notes.push(String::from(
            "Instructions on boards are estimated from pictures without instances.",
        ));
    }
    notes
}
