//! The path of a ray through a structure.

use super::Shown;
use super::words::{counted_were, precise, vector};
use crate::explain::walk::{Candidate, Culled, Plane, Side, Step, Tested, Verdict, Walk};
use crate::table::significant;
use glam::DVec3;
use std::fmt::{self, Formatter};

impl Shown<'_> {
    pub(super) fn walk(&self, f: &mut Formatter<'_>, walk: &Walk) -> fmt::Result {
        let [begin, end] = walk.interval;
        if begin > end {
            write!(f, "  The ray passes the scene's box")?;
        } else {
            write!(
                f,
                "  The ray's interval is {} to {}",
                along(walk, begin),
                along(walk, end)
            )?;
        }
        let any = if walk.any {
            "; any hit ends the query"
        } else {
            ""
        };
        write!(f, "{any}.")?;
        if walk.moved != 0.0 && begin <= end {
            let major = DVec3::from_array(walk.direction).abs().max_position();
            write!(
                f,
                " It begins at {}, at distance {}: along {}, the scene's box begins there.",
                vector(walk.start, significant),
                significant(walk.moved),
                ['x', 'y', 'z'][major],
            )?;
        }
        writeln!(f)?;
        for step in &walk.steps {
            match step {
                Step::Opened { place } => writeln!(f, "  {place}")?,
                Step::InstanceEntered { instance, part } => writeln!(
                    f,
                    "  {}: the ray goes on in part {part}, in whose coordinates the planes are",
                    self.instance(*instance)
                )?,
                Step::InstanceLeft { instance, nearest } => writeln!(
                    f,
                    "  {} is left, {}",
                    self.instance(*instance),
                    match nearest {
                        true => "with the closest hit so far",
                        false => "without a closer hit",
                    }
                )?,
                Step::Tested(tested) => writeln!(f, "    {}", tested_text(walk, tested))?,
                Step::GivenUp { place, enters, hit } => writeln!(
                    f,
                    "  {place} is skipped: it begins at {}, behind the hit at {}",
                    along(walk, *enters),
                    along(walk, *hit)
                )?,
                Step::Candidate(candidate) => {
                    writeln!(f, "    {}", self.candidate_text(walk, candidate))?;
                }
            }
        }
        if walk.unlisted > 0 {
            writeln!(
                f,
                "    {} not listed; primitives that are hit are listed all the same",
                counted_were(walk.unlisted, "further step")
            )?;
        }
        Ok(())
    }

    /// A primitive that was tested, and what came of it.
    fn candidate_text(&self, walk: &Walk, candidate: &Candidate) -> String {
        let along = |distance| along(walk, distance);
        let crossing = match candidate.crossing {
            Some([enter, leave]) if enter == leave => format!("is hit at {}", along(enter)),
            Some([enter, leave]) => format!("is hit from {} to {}", along(enter), along(leave)),
            None => String::from("is missed"),
        };
        let verdict = match candidate.verdict {
            Verdict::Missed => "",
            Verdict::NotInInterval => ", outside of the ray's interval",
            Verdict::Farther => ", behind the closest hit",
            Verdict::Nearest => ": the closest hit so far",
        };
        let (kind, primitive) = (candidate.kind, candidate.primitive);
        let object = match candidate.instance {
            Some(_) => format!(" of {}", self.object(candidate.object)),
            None => String::new(),
        };
        format!("{kind} {primitive}{object} {crossing}{verdict}")
    }
}

/// A node or cell that was tested, and what came of it.
fn tested_text(walk: &Walk, tested: &Tested) -> String {
    let along = |distance| along(walk, distance);
    let plane = |plane: &Plane| {
        let (axis, at) = (plane.axis, significant(plane.at));
        format!("{axis} = {at} at {}", along(plane.distance))
    };
    let place = format!("{}{}", tested.place, between(&tested.planes));
    match tested.culled {
        Some(Culled::Empty) => format!("{place} is empty"),
        Some(Culled::NotInVolume) => {
            format!("{place} is culled: the ray is not in it within its interval")
        }
        None => format!(
            "{place}: the ray is in it from {} to {}",
            along(tested.span[0]),
            along(tested.span[1])
        ),
        Some(Culled::Beside { leaves, enters }) => format!(
            "{place} is culled: the ray leaves at {} before it enters at {}",
            plane(&leaves),
            plane(&enters)
        ),
        Some(Culled::Outside { along: plane }) => format!(
            "{place} is culled: the ray is parallel to {} = {}, and outside",
            plane.axis,
            significant(plane.at)
        ),
        Some(Culled::BehindHit { enters, hit }) => format!(
            "{place} is culled: {} lies behind the hit at {}",
            plane(&enters),
            along(hit)
        ),
        Some(Culled::NotInInterval) => {
            format!("{place} is culled: it lies outside of the ray's interval")
        }
        Some(Culled::NotInParent {
            plane: crossed,
            around: [enter, leave],
        }) => format!(
            "{place} is culled: {} is outside of the ray's interval in the parent, {} to {}",
            plane(&crossed),
            along(enter),
            along(leave)
        ),
        Some(Culled::Margin) => {
            format!("{place} is culled by less than the rounding margin")
        }
    }
}

/// The planes of a test, if all are on one axis: what was tested is not all of a box.
fn between(planes: &[Plane]) -> String {
    let Some(axis) = planes.first().map(|plane| plane.axis) else {
        return String::new();
    };
    if planes.iter().any(|plane| plane.axis != axis) {
        return String::new();
    }
    let side = |side| planes.iter().find(|plane| plane.side == side);
    let bounds = [(Side::Lower, "from"), (Side::Upper, "to")].map(|(wanted, word)| {
        side(wanted).map_or(String::new(), |plane| {
            format!(" {word} {}", significant(plane.at))
        })
    });
    format!(" ({axis}{})", bounds.concat())
}

/// A distance, with the precision that it has from where the kernels start.
fn along(walk: &Walk, distance: f64) -> String {
    match walk.moved {
        0.0 => significant(distance),
        moved => precise(distance, 1e-4 * (distance - moved).abs()),
    }
}
