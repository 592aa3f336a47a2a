//! The parts of a blob, a line each.

use gridel_core::scene::part_blobs;
use gridel_core::{Kind, Scene};
use gridel_host::table::{counted, grouped};
use serde::Serialize;

#[derive(Serialize)]
pub struct PartLine {
    /// Instances that place it.
    instances: usize,
    primitives: usize,
    /// Bytes of its own blob.
    bytes: usize,
    stack_depth: usize,
}

impl PartLine {
    pub fn all(scene: &Scene<'_>, blob: &[u8]) -> Vec<Self> {
        let mut instances = vec![0; scene.parts().len()];
        for instance in scene.instances() {
            instances[usize::from(instance.part)] += 1;
        }
        // They were checked with the scene.
        let blobs = part_blobs(blob).into_iter().flatten();
        let parts = scene.parts().iter().zip(blobs).zip(instances);
        let line = |((part, blob), instances): ((&Scene<'_>, &[u8]), usize)| Self {
            instances,
            primitives: Kind::ALL.map(|kind| part.count(kind)).iter().sum(),
            bytes: blob.len(),
            stack_depth: part.stack_depth(),
        };
        parts.map(line).collect()
    }

    pub fn text(&self, number: usize) -> String {
        let Self {
            instances,
            primitives,
            bytes,
            stack_depth,
        } = self;
        format!(
            "{number}: {} of {}, {} bytes, stack depth {stack_depth}",
            counted(*instances, "instance"),
            counted(*primitives, "primitive"),
            grouped(*bytes)
        )
    }
}
