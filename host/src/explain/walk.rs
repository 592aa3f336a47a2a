//! A query's way through a structure, in scene units, and why it left out what it left out.

use crate::trace::Frame;
use gridel_core::Event;
use gridel_core::event::{Place, Sides};
use serde::Serialize;

/// One query: a ray and its way. Distances are scene units along the ray, counted from
/// `origin`.
#[derive(Clone, Debug, Serialize)]
pub struct Walk {
    /// Where the ray starts; if it started far away, where it comes to the scene's box.
    pub origin: [f64; 3],
    /// Of length 1.
    pub direction: [f64; 3],
    /// What of the ray counts.
    pub interval: [f64; 2],
    /// Whether any hit would do.
    pub any: bool,
    pub steps: Vec<Step>,
    /// Nodes, leaves and cells that were gone into.
    pub opened: usize,
    /// Those that were tested and left out.
    pub culled: usize,
    /// Primitives that were tested.
    pub candidates: usize,
    /// How far `origin` is from where the ray starts: 0 unless it starts before the scene's box.
    pub moved: f64,
    #[serde(skip)]
    ray: InUnits,
}

/// The ray in units, for the planes of boxes.
#[derive(Clone, Copy, Debug)]
struct InUnits {
    frame: Frame,
    origin: [f64; 3],
    slope: [f64; 3],
    /// Scene units of a unit of t.
    scale: f64,
    /// The nearest hit so far.
    limit: f64,
    /// From where to where the ray is in the node that it went into last.
    around: [f64; 2],
}

/// One step of a walk.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "step", rename_all = "kebab-case")]
pub enum Step {
    Tested(Tested),
    /// A node that was put off, and then lay behind a hit.
    GivenUp {
        place: String,
        enters: f64,
        hit: f64,
    },
    Opened {
        place: String,
    },
    Candidate(Candidate),
}

/// A node or cell that was tested.
#[derive(Clone, Debug, Serialize)]
pub struct Tested {
    pub place: String,
    /// Planes that were tested, in scene coordinates.
    pub planes: Vec<Plane>,
    /// From where to where the ray is in it.
    pub span: [f64; 2],
    /// Why the ray does not go into it; `None` if it may.
    pub culled: Option<Culled>,
}

/// A plane of a box, and where the ray crosses it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Plane {
    pub axis: char,
    /// Which of the box's sides on the axis it is.
    pub side: Side,
    pub at: f64,
    /// Infinite where the ray runs along the plane.
    #[serde(serialize_with = "finite")]
    pub distance: f64,
    /// Whether the ray goes into the slab here, and not out of it.
    pub entry: bool,
}

/// A side of a box on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    Lower,
    Upper,
}

fn finite<S: serde::Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    value.is_finite().then_some(*value).serialize(serializer)
}

/// Why a ray does not go into a node.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "reason", rename_all = "kebab-case")]
pub enum Culled {
    /// It leaves the box through one plane before it enters through another.
    Beside { leaves: Plane, enters: Plane },
    /// It runs along the box, outside of it.
    Outside { along: Plane },
    /// It enters the box behind the hit that it has.
    BehindHit { enters: Plane, hit: f64 },
    /// The box lies before what of the ray counts, or behind it.
    NotInInterval,
    /// It crosses the plane where it is not in the node around the box, whose span that is.
    NotInParent { plane: Plane, around: [f64; 2] },
    /// No plane tells: the span is empty by less than culling allows for rounding.
    Margin,
    /// What was tested has no planes on the axes: the ray is not in it where it counts.
    NotInVolume,
    /// It holds nothing.
    Empty,
}

/// A primitive that was tested.
#[derive(Clone, Debug, Serialize)]
pub struct Candidate {
    pub kind: &'static str,
    pub primitive: u32,
    /// Where the ray's line enters and leaves it.
    pub crossing: Option<[f64; 2]>,
    pub verdict: Verdict,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The line does not meet it.
    Missed,
    /// The line meets it where the ray does not count.
    NotInInterval,
    /// A nearer hit is known.
    Farther,
    /// The nearest hit so far.
    Nearest,
}

impl Walk {
    /// A walk that begins with a query; `None` for other events.
    pub(super) fn begin(frame: &Frame, event: &Event) -> Option<Self> {
        let &Event::Query {
            origin,
            slope,
            moved,
            interval,
            any,
        } = event
        else {
            return None;
        };
        let norm = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
        let scale = norm * frame.length(1.0);
        Some(Self {
            origin: frame.place(origin).to_array(),
            direction: slope.map(|x| x / norm),
            interval: interval.map(|t| t * scale),
            any,
            steps: Vec::new(),
            opened: 0,
            culled: 0,
            candidates: 0,
            moved: moved * scale,
            ray: InUnits {
                frame: *frame,
                origin,
                slope,
                scale,
                limit: interval[1],
                around: interval,
            },
        })
    }

    /// A length along the ray in scene units, from one along its major axis in units.
    pub(super) fn distance(&self, t: f64) -> f64 {
        t * self.ray.scale
    }

    /// Takes a step, if the event is one.
    pub(super) fn take(&mut self, event: &Event) {
        let ray = self.ray;
        let step = match *event {
            Event::Opened(place) => {
                self.opened += 1;
                let place = name(place);
                let span = self.steps.iter().rev().find_map(|step| match step {
                    Step::Tested(tested) if tested.place == place => Some(tested.span),
                    _ => None,
                });
                if let Some(span) = span {
                    self.ray.around = span.map(|t| t / ray.scale);
                }
                Step::Opened { place }
            }
            Event::Tested { place, sides, span } => {
                let tested = ray.tested(place, sides, span, self.interval);
                self.culled += usize::from(tested.culled.is_some());
                Step::Tested(tested)
            }
            Event::Empty(place) => {
                if let Some(Step::Tested(last)) = self.steps.last_mut()
                    && last.place == name(place)
                    && last.culled.is_none()
                {
                    last.culled = Some(Culled::Empty);
                    self.culled += 1;
                }
                return;
            }
            Event::GivenUp { place, enters } => Step::GivenUp {
                place: name(place),
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
                    Some([enter, leave]) => {
                        let [first, last] = self.interval.map(|t| t / ray.scale);
                        let counts = |t: f64| first <= t && t <= last;
                        if counts(enter) || counts(leave) {
                            Verdict::Farther
                        } else {
                            Verdict::NotInInterval
                        }
                    }
                };
                if let (Verdict::Nearest, Some([enter, leave])) = (verdict, crossing) {
                    let first = self.interval[0] / ray.scale;
                    self.ray.limit = if enter >= first { enter } else { leave };
                }
                Step::Candidate(Candidate {
                    kind: kind.name(),
                    primitive,
                    crossing: crossing.map(|c| c.map(|t| t * ray.scale)),
                    verdict,
                })
            }
            _ => return,
        };
        self.steps.push(step);
    }

    /// The primitive that was the nearest when the walk ended.
    pub fn met(&self) -> Option<&Candidate> {
        self.steps.iter().rev().find_map(|step| match step {
            Step::Candidate(candidate) if candidate.verdict == Verdict::Nearest => Some(candidate),
            _ => None,
        })
    }
}

fn name(place: Place) -> String {
    format!("{} {}", place.what, place.number)
}

impl InUnits {
    fn tested(&self, place: Place, sides: Sides, span: [f64; 2], interval: [f64; 2]) -> Tested {
        let mut planes = Vec::new();
        for (axis, sides) in sides.iter().enumerate() {
            for (side, plane) in sides.iter().enumerate() {
                planes.extend(plane.map(|plane| self.plane(axis, side, plane)));
            }
        }
        let culled = (span[0] > span[1]).then(|| self.reason(&planes, span, interval));
        Tested {
            place: name(place),
            planes,
            span: span.map(|t| t * self.scale),
            culled,
        }
    }

    fn plane(&self, axis: usize, side: usize, plane: i16) -> Plane {
        let away = f64::from(plane) - self.origin[axis];
        let slope = self.slope[axis];
        // Along the plane the ray is inside of its slab for ever, or never.
        let inside = (side == 0) == (away <= 0.0) || away == 0.0;
        let (distance, entry) = if slope == 0.0 {
            let never = if inside { -1.0 } else { 1.0 };
            (never * f64::INFINITY, true)
        } else {
            (away / slope * self.scale, (side == 0) == (slope > 0.0))
        };
        let mut corner = [0.0; 3];
        corner[axis] = f64::from(plane);
        Plane {
            axis: ['x', 'y', 'z'][axis],
            side: [Side::Lower, Side::Upper][side],
            at: self.frame.place(corner).to_array()[axis],
            distance,
            entry,
        }
    }

    /// Why a span is empty, by the planes that were tested.
    fn reason(&self, planes: &[Plane], span: [f64; 2], interval: [f64; 2]) -> Culled {
        if planes.is_empty() {
            return Culled::NotInVolume;
        }
        let by_distance = |a: &&Plane, b: &&Plane| a.distance.total_cmp(&b.distance);
        let enters = planes.iter().filter(|p| p.entry).max_by(by_distance);
        let leaves = planes.iter().filter(|p| !p.entry).min_by(by_distance);
        if let Some(&along) = enters.filter(|plane| plane.distance == f64::INFINITY) {
            return Culled::Outside { along };
        }
        if let (Some(&enters), Some(&leaves)) = (enters, leaves)
            && enters.distance > leaves.distance
        {
            return Culled::Beside { leaves, enters };
        }
        let hit = self.limit * self.scale;
        let begins = span[0] * self.scale;
        if let Some(&enters) = enters
            && self.limit * self.scale < interval[1]
            && begins.max(enters.distance) > hit
        {
            return Culled::BehindHit { enters, hit };
        }
        let begins_late = enters.is_some_and(|plane| plane.distance > interval[1]);
        let ends_early = leaves.is_some_and(|plane| plane.distance < interval[0]);
        if begins_late || ends_early {
            return Culled::NotInInterval;
        }
        let [first, last] = self.around.map(|t| t * self.scale);
        let late = enters.filter(|plane| plane.distance > last);
        let early = leaves.filter(|plane| plane.distance < first);
        late.or(early)
            .map_or(Culled::Margin, |&plane| Culled::NotInParent {
                plane,
                around: [first, last],
            })
    }
}
