//! Advice that makes a scene take less of a board's memory.

use super::memory::MemoryReport;
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
        let view = scene.view();
        let place = if self.format == Format::F64.name() {
            80
        } else {
            40
        };
        let mut steps = Vec::new();
        let places = scene.effects().work_depth(view.depth) as u64;
        if places > 0 {
            steps.push(format!(
                "a ray depth of {} in place of {} saves {place} bytes, and a scene without mirrors and \
                 glass {}",
                view.depth - 1,
                view.depth,
                place * places
            ));
        }
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
