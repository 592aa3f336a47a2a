//! Records what the renderer reports.

use gridel_core::{Event, Observer};

/// Records events, but not every primitive of a long list that a ray passes by.
#[derive(Default)]
pub(super) struct Recorder {
    /// Samples whose events are still recorded; only the end of later ones is.
    samples_left: usize,
    pub(super) events: Vec<Event>,
    /// For each query, what was counted alone.
    pub(super) unlisted: Vec<Unlisted>,
    /// The zero of the kernels' count on a ray of the caller's own, in units along its major axis.
    pub(super) begin: f64,
    /// Recorded steps of the current query.
    steps: usize,
}

/// Steps of a query that are counted and not listed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Unlisted {
    pub(super) opened: usize,
    pub(super) candidates: usize,
    /// Tests of nodes and cells.
    pub(super) others: usize,
}

/// Steps of a query that are kept, not counting hits of candidates. A walk through a hierarchy has some hundreds, brute
/// force as many as there are primitives.
const MOST_STEPS: usize = 20_000;

impl Recorder {
    /// Records no more than the color of the samples after the first `samples`.
    pub(super) fn of_first(samples: usize) -> Self {
        Self {
            samples_left: samples,
            ..Self::default()
        }
    }
}

impl Observer for Recorder {
    const ENABLED: bool = true;

    fn event(&mut self, event: Event) {
        if let Event::SampleFinished { .. } = event {
            self.samples_left = self.samples_left.saturating_sub(1);
            self.events.push(event);
            return;
        }
        if self.samples_left == 0 {
            return;
        }
        match event {
            Event::Query { .. } => {
                self.steps = 0;
                self.unlisted.push(Unlisted::default());
            }
            Event::Tested { .. }
            | Event::Empty(_)
            | Event::Opened(_)
            | Event::NodeSkipped { .. }
            | Event::Candidate { crossing: None, .. } => {
                self.steps += 1;
                if self.steps > MOST_STEPS {
                    let Some(unlisted) = self.unlisted.last_mut() else {
                        return;
                    };
                    match event {
                        Event::Opened(_) => unlisted.opened += 1,
                        Event::Candidate { .. } => unlisted.candidates += 1,
                        // It belongs to the test of its node.
                        Event::Empty(_) => {}
                        _ => unlisted.others += 1,
                    }
                    return;
                }
            }
            _ => {}
        }
        self.events.push(event);
    }
}
