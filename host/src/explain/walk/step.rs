//! The steps of a query's path.

use serde::{Serialize, Serializer};

/// One step of a walk.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "step", rename_all = "kebab-case")]
pub enum Step {
    Tested(Tested),
    /// A node that was postponed, and then lay behind a hit.
    GivenUp {
        place: String,
        enters: f64,
        hit: f64,
    },
    Opened {
        place: String,
    },
    /// The ray enters an instance. The planes of the steps up to `InstanceLeft` are in the part's own coordinates, and
    /// its nodes have their own numbers. Distances stay those of the ray.
    InstanceEntered {
        /// In scene-file order.
        instance: u32,
        part: u32,
    },
    InstanceLeft {
        instance: u32,
        /// True if the nearest hit so far is in it.
        nearest: bool,
    },
    Candidate(Candidate),
}

/// A node or cell that was tested.
#[derive(Clone, Debug, Serialize)]
pub struct Tested {
    pub place: String,
    /// Planes that were tested, in scene coordinates.
    pub planes: Vec<Plane>,
    /// The interval of the ray in it.
    pub span: [f64; 2],
    /// The span in units, as the kernels compute it.
    #[serde(skip)]
    pub(super) units: [f64; 2],
    /// The reason why the ray does not enter it; `None` if it may.
    pub culled: Option<Culled>,
}

/// A plane of a box, and where the ray crosses it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Plane {
    pub axis: char,
    /// The side of the box on the axis.
    pub side: Side,
    pub at: f64,
    /// Infinite where the ray runs along the plane.
    #[serde(serialize_with = "finite")]
    pub distance: f64,
    /// True if the ray enters the slab here; false if it leaves it.
    pub entry: bool,
}

/// A side of a box on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    Lower,
    Upper,
}

fn finite<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    value.is_finite().then_some(*value).serialize(serializer)
}

/// The reason why a ray does not enter a node.
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
    /// No single plane is the cause: the span is empty by less than culling allows for rounding.
    Margin,
    /// A volume without planes on the axes: the ray is not in it within its interval.
    NotInVolume,
    /// It holds nothing.
    Empty,
}

/// A primitive that was tested.
#[derive(Clone, Debug, Serialize)]
pub struct Candidate {
    pub kind: &'static str,
    pub primitive: u32,
    pub object: u32,
    /// The instance in scene-file order; `None` for the scene's own objects.
    pub instance: Option<u32>,
    /// The t where the ray's line enters and leaves it.
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
    /// A nearer hit was found before.
    Farther,
    /// The nearest hit so far.
    Nearest,
}

impl Step {
    /// Counts distances from the ray's origin, and no longer from where the kernels start.
    pub(super) fn count_from(&mut self, moved: f64) {
        match self {
            Self::Tested(tested) => {
                for plane in &mut tested.planes {
                    plane.distance += moved;
                }
                tested.span = tested.span.map(|t| t + moved);
                if let Some(culled) = &mut tested.culled {
                    culled.count_from(moved);
                }
            }
            Self::GivenUp { enters, hit, .. } => {
                *enters += moved;
                *hit += moved;
            }
            Self::Opened { .. } | Self::InstanceEntered { .. } | Self::InstanceLeft { .. } => {}
            Self::Candidate(candidate) => {
                candidate.crossing = candidate.crossing.map(|c| c.map(|t| t + moved));
            }
        }
    }
}

impl Culled {
    fn count_from(&mut self, moved: f64) {
        match self {
            Self::Beside { leaves, enters } => {
                leaves.distance += moved;
                enters.distance += moved;
            }
            Self::Outside { along } => along.distance += moved,
            Self::BehindHit { enters, hit } => {
                enters.distance += moved;
                *hit += moved;
            }
            Self::NotInParent { plane, around } => {
                plane.distance += moved;
                *around = around.map(|t| t + moved);
            }
            Self::NotInInterval | Self::Margin | Self::NotInVolume | Self::Empty => {}
        }
    }
}
