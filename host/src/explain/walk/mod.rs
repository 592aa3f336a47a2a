//! A query's path through a structure, in scene units, and why it skipped nodes.

mod inside;
mod planes;
mod step;

pub use step::{Candidate, Culled, Plane, Side, Step, Tested, Verdict};

use super::recorder::Unlisted;
use crate::shape::rounding;
use crate::trace::{Frame, SceneRay};
use glam::DVec3;
use gridel_core::observe::event::NodeId;
use gridel_core::{Event, Format, Kind, Scene};
use serde::Serialize;

/// One query: a ray and its walk. Distances are scene units along the ray, counted from `origin`.
#[derive(Clone, Debug, Serialize)]
pub struct Walk {
    /// The origin as it was given: the caller's, the camera's, or the point that a secondary ray
    /// starts from.
    pub origin: [f64; 3],
    /// Direction of length 1.
    pub direction: [f64; 3],
    /// The interval of the ray that counts.
    pub interval: [f64; 2],
    /// The start of the kernels: `origin`, or the first point that is within the scene's box along the ray's major
    /// axis. Along the others it need not be. `origin` if the ray passes the box far away.
    pub start: [f64; 3],
    /// Distance of `start`: 0 unless the ray starts before the scene's box, and comes near it.
    pub moved: f64,
    /// True if any hit suffices.
    pub any: bool,
    /// The first 20,000, and all primitives that are hit.
    pub steps: Vec<Step>,
    /// The number of further steps.
    pub unlisted: usize,
    /// Nodes, leaves and cells that were entered.
    pub opened: usize,
    /// Nodes, leaves and cells that were tested and not entered, among the steps that are listed.
    pub culled: usize,
    /// Primitives that were tested.
    pub candidates: usize,
    #[serde(skip)]
    ray: InUnits,
    #[serde(skip)]
    inside: Option<Inside>,
}

/// The instance that a walk is in.
#[derive(Clone, Copy, Debug)]
struct Inside {
    instance: u32,
    first_primitive: u32,
    /// The ray in the scene.
    outer: InUnits,
    /// t in the scene is `scale * (start_t + t)`, counted from the outer ray's start.
    start_t: f64,
    scale: f64,
    /// The step with which the instance was entered.
    step: usize,
}

/// A ray as it was given, in scene units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Given {
    pub origin: DVec3,
    /// The given direction, of any length; `None` if the kernels' own is equal.
    pub direction: Option<DVec3>,
    /// The distance from the origin at which the kernels count 0, in units along the major axis: a ray from far away
    /// starts nearer for them.
    pub begin: f64,
}

impl Given {
    pub fn new(ray: &SceneRay, begin: f64) -> Self {
        Self {
            origin: ray.origin,
            direction: Some(ray.direction),
            begin,
        }
    }

    /// Returns a ray along the direction of the kernels.
    pub fn from_origin(origin: DVec3) -> Self {
        Self {
            origin,
            direction: None,
            begin: 0.0,
        }
    }
}

/// Returns a direction divided by its largest component, and the length of that.
fn along_major(direction: DVec3) -> (DVec3, f64) {
    let slope = direction / direction.abs().max_element();
    (slope, slope.length())
}

/// The ray in units, for the planes of boxes; its t counts from where the kernels start.
#[derive(Clone, Copy, Debug)]
struct InUnits {
    frame: Frame,
    format: Format,
    start: [f64; 3],
    slope: [f64; 3],
    /// Distance of the start, in scene units.
    moved: f64,
    /// Scene units of a unit of t.
    scale: f64,
    /// The zero of the kernels' count: see [`Given::begin`].
    begin: f64,
    /// The distance of the start from the line of the ray as it was given, in scene units.
    aside: f64,
    /// The increase of that distance per scene unit along the ray.
    turned: f64,
    /// The interval that counts.
    interval: [f64; 2],
    /// The interval that counts for shapes without bounds.
    far_interval: [f64; 2],
    /// The nearest hit so far.
    limit: f64,
    /// The interval of the ray in the node that it entered last.
    around: [f64; 2],
}

impl InUnits {
    /// Returns the verdict on a primitive of a kind that is hit there and is not the nearest one.
    fn verdict_of_other(&self, kind: Kind, [enter, leave]: [f64; 2]) -> Verdict {
        let [first, last] = match kind.is_bounded() {
            true => self.interval,
            false => self.far_interval,
        };
        let counts = |t: f64| first <= t && t <= last;
        match counts(enter) || counts(leave) {
            true => Verdict::Farther,
            false => Verdict::NotInInterval,
        }
    }
}

impl Walk {
    /// A walk that begins with a query; `None` for other events.
    pub(super) fn begin(
        frame: &Frame,
        format: Format,
        given: Option<Given>,
        event: &Event,
    ) -> Option<Self> {
        let &Event::Query {
            origin: start,
            slope,
            start_t: moved,
            interval,
            far_interval,
            any,
        } = event
        else {
            return None;
        };
        let rounded = DVec3::from_array(slope);
        let given = given.unwrap_or_else(|| {
            let origin = DVec3::from_array(start) - moved * rounded;
            Given::from_origin(frame.place(origin.to_array()))
        });
        let (exact, norm) = along_major(given.direction.unwrap_or(rounded));
        let direction = exact / norm;
        let scale = norm * frame.length(1.0);
        let moved = (given.begin + moved) * scale;
        let place = frame.place(start);
        Some(Self {
            origin: given.origin.to_array(),
            direction: direction.to_array(),
            interval: interval.map(|t| moved + t * scale),
            start: place.to_array(),
            moved,
            any,
            steps: Vec::new(),
            unlisted: 0,
            opened: 0,
            culled: 0,
            candidates: 0,
            ray: InUnits {
                frame: *frame,
                format,
                start,
                slope,
                moved,
                scale,
                begin: given.begin,
                aside: (given.origin + moved * direction).distance(place),
                turned: direction.distance(rounded.normalize()),
                interval,
                far_interval,
                limit: interval[1],
                around: interval,
            },
            inside: None,
        })
    }

    /// Counts steps that are not listed.
    pub(super) fn leave_out(&mut self, unlisted: Unlisted) {
        let Unlisted {
            opened,
            candidates,
            others,
        } = unlisted;
        self.opened += opened;
        self.candidates += candidates;
        self.unlisted += opened + candidates + others;
    }

    /// The distance of a parameter as the caller counts it, in units along the major axis.
    pub(super) fn distance(&self, t: f64) -> f64 {
        (self.ray.begin + t) * self.ray.scale
    }

    /// Returns the place of a hit in scene coordinates, given in units. Where the point stands for a farther one of the
    /// same plane, the number format has only the distance right.
    pub(super) fn place(&self, frame: &Frame, distance: f64, point: [f64; 3]) -> [f64; 3] {
        // A point that stands for a farther one is more than a quarter of the longest length less 8 units away from
        // it: see `Plane` of the core.
        let apart = match self.ray.format {
            Format::Fixed => f64::powi(2.0, 15),
            Format::F32 | Format::F64 => f64::powi(2.0, 44),
        };
        let point = frame.place(point);
        let on_ray = DVec3::from_array(self.origin) + distance * DVec3::from_array(self.direction);
        let is_near = (point - on_ray).abs().max_element() < frame.length(apart);
        if is_near { point } else { on_ray }.to_array()
    }

    /// Returns how far `origin + distance * direction` may be from the point that the kernels compute there. The
    /// kernels round the ray and the point, and double precision rounds this sum.
    pub(super) fn rounding(&self, distance: f64, point: [f64; 3]) -> f64 {
        let ray = &self.ray;
        let inside = (distance - self.moved).abs();
        let largest = |v: [f64; 3]| v.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let units = largest(point)
            .max(largest(ray.start))
            .max(distance.abs() / ray.frame.length(1.0));
        // The sum over start, t from either place, and point, on three axes.
        let kernels = 8.0 * ray.frame.length(rounding::step(ray.format, units));
        let sum = largest(self.origin) + largest(self.start) + distance.abs();
        ray.aside + ray.turned * inside + kernels + 8.0 * f64::EPSILON * sum
    }

    /// Records a step, if the event is one.
    pub(super) fn record(&mut self, scene: &Scene<'_>, event: &Event) {
        let ray = self.ray;
        let mut step = match *event {
            Event::InstanceEntered { .. } => {
                self.enter(scene, event);
                return;
            }
            Event::InstanceLeft { nearest } => {
                self.leave(nearest);
                return;
            }
            Event::Opened(place) => {
                self.opened += 1;
                let place = name(scene, place);
                let first = self.inside.map_or(0, |inside| inside.step);
                let span = self.steps[first..]
                    .iter()
                    .rev()
                    .find_map(|step| match step {
                        Step::Tested(tested) if tested.place == place => Some(tested.units),
                        _ => None,
                    });
                if let Some(span) = span {
                    self.ray.around = span;
                }
                Step::Opened { place }
            }
            Event::Tested { node, sides, span } => {
                let tested = ray.tested(name(scene, node), sides, span);
                self.culled += usize::from(tested.culled.is_some());
                Step::Tested(tested)
            }
            Event::Empty(place) => {
                if let Some(Step::Tested(last)) = self.steps.last_mut()
                    && last.place == name(scene, place)
                    && last.culled.is_none()
                {
                    last.culled = Some(Culled::Empty);
                    self.culled += 1;
                }
                return;
            }
            Event::NodeSkipped { node, enters } => Step::GivenUp {
                place: name(scene, node),
                enters: enters * ray.scale,
                hit: ray.limit * ray.scale,
            },
            Event::Candidate {
                kind,
                primitive,
                crossing,
                nearest,
            } => {
                self.candidates += 1;
                let verdict = match crossing {
                    None => Verdict::Missed,
                    Some(_) if nearest => Verdict::Nearest,
                    Some(crossing) => ray.verdict_of_other(kind, crossing),
                };
                if let (Verdict::Nearest, Some([enter, leave])) = (verdict, crossing) {
                    self.ray.limit = if enter >= ray.interval[0] {
                        enter
                    } else {
                        leave
                    };
                }
                let first = self.inside.map_or(0, |inside| inside.first_primitive);
                let primitive = first.wrapping_add(primitive);
                Step::Candidate(Candidate {
                    kind: kind.name(),
                    primitive,
                    object: scene.object(primitive),
                    instance: self.inside.map(|inside| inside.instance),
                    crossing: crossing.map(|c| c.map(|t| t * ray.scale)),
                    verdict,
                })
            }
            _ => return,
        };
        step.count_from(ray.moved);
        self.steps.push(step);
    }

    /// Returns the primitive that was the nearest when the walk ended.
    pub fn met(&self) -> Option<&Candidate> {
        self.steps.iter().rev().find_map(|step| match step {
            Step::Candidate(candidate) if candidate.verdict == Verdict::Nearest => Some(candidate),
            _ => None,
        })
    }
}

fn instance_name(number: u32) -> String {
    format!("{} {number}", NodeId::INSTANCE)
}

fn name(scene: &Scene<'_>, place: NodeId) -> String {
    let NodeId { what, number } = place;
    match scene.instances().get(number as usize) {
        Some(instance) if what == NodeId::INSTANCE => instance_name(instance.number),
        // A leaf of `wide`, whose number is its place in the blob, unlike that of a primitive.
        _ if Kind::ALL.iter().any(|kind| kind.name() == what) => format!("{what} leaf {number}"),
        _ => format!("{what} {number}"),
    }
}
