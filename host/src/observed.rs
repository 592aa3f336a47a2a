//! Observed numbers of rays.

use gridel_core::{Counters, Observer, RayKind};
use std::any::Any;

/// Receives a ray that was cast: a [`Ray`](gridel_core::Ray) of some number format.
pub type RaySink<'s> = &'s mut dyn FnMut(RayKind, &dyn Any);

/// Counts, radiance and rays. One type for all of them: the code that traces rays through all structures is compiled
/// for every observer, in every number format.
#[derive(Default)]
pub struct Observed<'s> {
    pub counters: Counters,
    /// The sum of the radiance that rays brought to samples.
    pub radiance: [f64; 3],
    pub sink: Option<RaySink<'s>>,
}

impl Observer for Observed<'_> {
    fn planes(&mut self, number: u32) {
        self.counters.planes(number);
    }

    fn boxes(&mut self, number: u32) {
        self.counters.boxes(number);
    }

    fn primitives(&mut self, number: u32) {
        self.counters.primitives(number);
    }

    fn cells(&mut self, number: u32) {
        self.counters.cells(number);
    }

    fn instances(&mut self, number: u32) {
        self.counters.instances(number);
    }

    fn radiance(&mut self, brought: impl FnOnce() -> [f64; 3]) {
        for (sum, brought) in self.radiance.iter_mut().zip(brought()) {
            *sum += brought;
        }
    }

    fn ray<R: Any>(&mut self, kind: RayKind, ray: &R) {
        self.counters.ray(kind, ray);
        if let Some(sink) = &mut self.sink {
            sink(kind, ray);
        }
    }
}
