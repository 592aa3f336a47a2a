//! A walk's path into an instance and out of it.

use super::step::{Step, Verdict};
use super::{InUnits, Inside, Walk, instance_name};
use crate::trace::Frame;
use gridel_core::{Event, Scene};

impl Walk {
    /// Goes into an instance.
    pub(super) fn enter(&mut self, scene: &Scene<'_>, event: &Event) {
        let &Event::InstanceEntered {
            index,
            first_primitive,
            origin,
            slope,
            interval,
            start_t,
            scale,
        } = event
        else {
            return;
        };
        let placed = scene.instances().get(index as usize);
        let Some((instance, part)) = placed.and_then(|instance| {
            let part = scene.parts().get(usize::from(instance.part))?;
            Some((instance, part))
        }) else {
            return;
        };
        let outer = self.ray;
        // The hierarchy above several instances has reported it before.
        let entered = instance_name(instance.number);
        if matches!(self.steps.last(), Some(Step::Opened { place }) if *place == entered) {
            self.steps.pop();
        }
        self.inside = Some(Inside {
            instance: instance.number,
            first_primitive,
            outer,
            start_t,
            scale,
            step: self.steps.len(),
        });
        self.ray = InUnits {
            frame: Frame::of(part),
            start: origin,
            slope,
            moved: outer.moved + start_t * scale * outer.scale,
            scale: scale * outer.scale,
            interval,
            limit: interval[1],
            around: interval,
            ..outer
        };
        self.steps.push(Step::InstanceEntered {
            instance: instance.number,
            part: instance.part.into(),
        });
    }

    /// Leaves the instance.
    pub(super) fn leave(&mut self, nearest: bool) {
        let Some(inside) = self.inside.take() else {
            return;
        };
        let met = self.ray.limit;
        self.ray = inside.outer;
        if nearest {
            self.ray.limit = inside.scale * (inside.start_t + met);
        } else {
            // In the scene another hit is as near.
            for step in &mut self.steps[inside.step..] {
                if let Step::Candidate(candidate) = step
                    && candidate.verdict == Verdict::Nearest
                {
                    candidate.verdict = Verdict::Farther;
                }
            }
        }
        self.steps.push(Step::InstanceLeft {
            instance: inside.instance,
            nearest,
        });
    }
}
