//! Advice that makes a scene take less of a board's memory.

use super::memory::MemoryReport;
use crate::measure::bytes::board_memory;
use crate::table::grouped;
use gridel_core::accel::Entry;
use gridel_core::{Effects, Format, Kind, Scene};

impl MemoryReport {
    /// Suggests changes that save memory of the kind that is short, by the scene's own figures.
    /// `smaller` suggests what makes the blob smaller, which takes time.
    pub fn advice(&self, scene: &Scene<'_>, smaller: impl FnOnce() -> Option<String>) -> String {
        let mut steps = Vec::new();
        if self.ram.missing() > 0 {
            steps.extend(self.ram_advice(scene));
        }
        if self.flash.missing() > 0 {
            steps.extend(self.flash_advice(scene));
            steps.push(match smaller() {
                // Code is another matter: flagged sides take more of it.
                Some(smaller) => format!("of the blob itself, {smaller}"),
                None => String::from(
                    "give the scene file in place of the blob to see what makes it smaller",
                ),
            });
        }
        steps.join("; ")
    }

    /// Returns advice that saves RAM.
    pub fn ram_advice(&self, scene: &Scene<'_>) -> Vec<String> {
        let mut steps: Vec<String> = self.depth_advice(scene).into_iter().collect();
        steps.extend(self.small_advice());
        // Where flash is short, too, it is named there.
        if scene.stack_depth() > 0 && self.flash.missing() == 0 {
            steps.push(format!(
                "`--accel list` saves {} bytes of traversal stack and costs time",
                scene.stack_depth() * size_of::<Entry>()
            ));
        }
        steps.push(String::from("a narrower picture"));
        steps
    }

    /// Returns the bytes of waiting rays that are saved at a smaller depth, and without rays that wait.
    fn depth_advice(&self, scene: &Scene<'_>) -> Option<String> {
        let format = Format::from_name(self.format)?;
        let depth = scene.view().depth;
        let workspace = |depth: u8| board_memory(scene, format, depth).workspace;
        let saved = |depth_then: u8| workspace(depth).checked_sub(workspace(depth_then));
        let less = depth.checked_sub(1)?;
        let [by_one, by_all] = [less, 0].map(|it| saved(it).filter(|&bytes| bytes > 0));
        let all = by_all.filter(|_| less > 0).map_or(String::new(), |bytes| {
            format!(", and a ray depth of 0 {}", grouped(bytes))
        });
        Some(format!(
            "a ray depth of {less} in place of {depth} saves {} bytes{all}",
            grouped(by_one?)
        ))
    }

    /// Returns advice that makes the call stack smaller.
    pub fn call_stack_advice(&self, scene: &Scene<'_>) -> Vec<String> {
        let effects = scene.effects();
        let effects = (effects != Effects::NONE)
            .then(|| format!("a scene without some of its effects ({effects})"));
        self.small_advice().into_iter().chain(effects).collect()
    }

    /// Returns the bytes of call stack that are saved without the feature `small`.
    fn small_advice(&self) -> Option<String> {
        let stacks = self.fast.call_stack.zip(self.small.call_stack);
        let (fast, small) = stacks.filter(|(fast, small)| fast < small)?;
        Some(format!(
            "without the feature `small` the call stack takes {} bytes less",
            grouped(small - fast)
        ))
    }

    /// Returns advice that saves flash other than the blob's.
    pub fn flash_advice(&self, scene: &Scene<'_>) -> Vec<String> {
        let mut steps = Vec::new();
        let code = self.fast.code.zip(self.small.code);
        if let Some((fast, small)) = code.filter(|(fast, small)| small < fast) {
            steps.push(format!(
                "with the feature `small` and opt-level = \"z\" code takes {} bytes in place of {}, \
                 and rays take longer",
                grouped(small),
                grouped(fast)
            ));
        }
        if scene.vertices() > 1 << 16 {
            let saved = 6 * scene.count(Kind::Triangle);
            steps.push(format!(
                "at most 65,536 vertices would make indices narrower and save {} bytes",
                grouped(saved)
            ));
        }
        if scene.effects() != Effects::NONE {
            steps.push(format!(
                "a scene without some of its effects ({})",
                scene.effects()
            ));
        }
        steps
    }
}
