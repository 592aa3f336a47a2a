//! Events in their order, as samples and rays.

use super::Subject;
use super::explanation::{Explanation, Ray, Sample, kind_name};
use super::recorder::{Recorder, Unlisted};
use super::walk::{Given, Walk};
use crate::trace::Frame;
use gridel_core::{Event, Format, RayKind, Scene};
use std::slice::Iter;

impl Explanation {
    /// Puts events in order.
    pub(super) fn of(
        scene: &Scene<'_>,
        format: Format,
        subject: &Subject,
        recorder: &Recorder,
    ) -> Self {
        let mut explanation = Explanation::default();
        let mut reader = Reader::new(scene, format, subject, recorder);
        for event in &recorder.events {
            if let Event::SampleFinished { at, radiance } = *event {
                explanation.samples.push(reader.finish(at, radiance));
            } else {
                reader.take(event);
            }
        }
        explanation
    }
}

/// A sample, as far as its events were read.
struct Reader<'t> {
    scene: &'t Scene<'t>,
    frame: Frame,
    format: Format,
    /// The rays from the camera, or the requested one.
    first: Given,
    sample: Sample,
    /// The rays that wait, by who sent them: the last is taken up first.
    waiting: Vec<usize>,
    /// True if the current query is a light's.
    light: bool,
    /// The parts of the queries to come that are not listed.
    unlisted: Iter<'t, Unlisted>,
}

impl<'t> Reader<'t> {
    fn new(
        scene: &'t Scene<'t>,
        format: Format,
        subject: &Subject,
        recorder: &'t Recorder,
    ) -> Self {
        let frame = Frame::of(scene);
        Self {
            scene,
            frame,
            format,
            first: match subject {
                Subject::Ray(ray) => Given::new(ray, recorder.begin),
                Subject::Pixel(_) => {
                    let eye = scene.view().eye.map(|x| x as f64 / 8192.0);
                    Given::from_origin(frame.place(eye))
                }
            },
            sample: Sample::default(),
            waiting: Vec::new(),
            light: false,
            unlisted: recorder.unlisted.iter(),
        }
    }

    fn finish(&mut self, place: Option<[i32; 2]>, radiance: [f64; 3]) -> Sample {
        self.waiting.clear();
        self.light = false;
        let mut sample = std::mem::take(&mut self.sample);
        sample.place = place.map(|place| place.map(|subpixels| f64::from(subpixels) / 256.0));
        sample.radiance = radiance;
        sample
    }

    fn take(&mut self, event: &Event) {
        match *event {
            Event::RayStarted {
                kind,
                depth,
                weight,
            } => self.ray(kind, depth, weight),
            _ => {
                let current = self.sample.rays.len().wrapping_sub(1);
                if matches!(event, Event::Sent { .. }) {
                    self.waiting.push(current);
                }
                let is_query = matches!(event, Event::Query { .. });
                let unlisted = is_query.then(|| self.unlisted.next()).flatten();
                let Self {
                    scene,
                    frame,
                    format,
                    light,
                    ..
                } = self;
                // The first ray of a sample is the one from the camera, or the requested one.
                let first = (current == 0 && !*light).then_some(self.first);
                if let Some(ray) = self.sample.rays.last_mut() {
                    // Through a lens it starts from there.
                    let from = ray.from_lens.map(|point| Given::from_origin(point.into()));
                    let given = first.map(|first| from.unwrap_or(first));
                    let begin = |event: &Event| {
                        let mut walk = Walk::begin(frame, *format, given, event)?;
                        walk.leave_out(unlisted.copied().unwrap_or_default());
                        Some(walk)
                    };
                    ray.record(scene, frame, begin, event, light);
                }
            }
        }
    }

    fn ray(&mut self, kind: RayKind, depth: u8, weight: [f64; 3]) {
        let parent = self.waiting.pop();
        let number = self.sample.rays.len();
        if let Some(parent) = parent {
            self.sample.rays[parent].children.push(number);
        }
        self.light = false;
        self.sample.rays.push(Ray {
            kind: kind_name(kind),
            parent,
            depth,
            weight,
            ..Ray::default()
        });
    }
}
