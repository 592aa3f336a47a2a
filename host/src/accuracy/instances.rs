//! Notes for readers of the figures about the instances of a scene.

use crate::measure::InstanceCount;
use crate::measure::board::programs::Programs;
use crate::table::{counted, grouped};

/// Returns sentences about the treatment of instances, and about costs that are not in the table.
pub fn instance_notes(instances: &InstanceCount) -> Vec<String> {
    let mut notes = vec![format!("{}.", instances.text())];
    if let Some(parts) = instances.parts {
        let parts_text = counted(parts, "part");
        notes.extend(Programs::recorded().part_view(&["instances"]).map(|bytes| {
            let bytes = grouped(bytes * parts as u64);
            format!("On a board the views of {parts_text} take at most {bytes} bytes of RAM more.")
        }));
        notes.push(String::from(
            "Instructions on boards are estimated from pictures without instances.",
        ));
    }
    notes
}
