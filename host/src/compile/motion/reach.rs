//! Reach of moving instances: a box that holds a placed part at all times of the tracks of its joints.
//!
//! Each joint has a range of rotations, scales and shifts, and all of them are taken together, at rest and at any time.
//! Keys bound the values between them: those of a spline together with its Bézier control points. Rotations about one
//! axis sweep a cylinder about it, others a sphere about the pivot.

use super::room::{MARGIN, Swept};
use crate::scene::{
    Interpolation, Joint, JointTracks, LARGEST_SCALE, LEAST_SCALE, Placement, ScaleRange, Scene,
    Track, control_points,
};
use crate::shape::Lattice;
use glam::{DQuat, DVec3, DVec4};
use gridel_core::format::record::UnitBox;

/// Largest difference of the axes of rotations about one axis.
const SAME_AXIS: f64 = 1e-6;

/// Bound of how far rounding takes the matrix and the scale of a joint off, in radians.
const ROUNDING: f64 = 1.0 / (1 << 23) as f64;

/// How far a pivot is off in whole coordinate steps: half a step along each axis.
const PIVOT_OFF: f64 = 0.867;

/// How far a shift is off in whole coordinate steps, along each axis half a step at the keys, 1/8 by their tangents and
/// half a step between them.
const SHIFT_OFF: f64 = 2.0;

/// The reach of a scene's instances.
#[derive(Debug, Default)]
pub struct Reach {
    /// The box that instances sweep, and the room that the scene states.
    swept: Swept,
    /// How far the integers of motions take an instance off at most, in coordinate steps.
    steps: f64,
    /// For each instance, its least and its greatest scale relative to that at rest.
    pub scales: Vec<[f64; 2]>,
}

impl Reach {
    /// Returns the reach of a scene whose parts lie in these boxes.
    pub fn of(scene: &Scene, parts: &[[DVec3; 2]]) -> Self {
        let tracks = JointTracks::of(scene);
        let joints = scene.joints.iter().zip(&tracks);
        let ranges: Vec<Range> = joints.map(|(joint, it)| Range::of(joint, it)).collect();
        let mut reach = Self {
            scales: Vec::with_capacity(scene.instances.len()),
            ..Self::default()
        };
        scene
            .room
            .into_iter()
            .for_each(|room| reach.swept.add(room));
        let size = size_at_rest(scene, parts);
        for instance in &scene.instances {
            let mut scales = [1.0; 2];
            if let Some(joint) = instance.joint.filter(|_| scene.is_placed(instance)) {
                let mut region = Region::of(parts[instance.part], &instance.placement);
                // The rest of the margin is for the rounding of boxes.
                let mut spare = size * MARGIN / 4.0;
                let chain = std::iter::successors(Some(joint), |&it| scene.joints[it].parent);
                let mut steps = 0.0;
                for joint in chain {
                    region = region.moved(&ranges[joint], &mut spare);
                    steps = ranges[joint].off(steps);
                    let [least, greatest] = ranges[joint].scale;
                    scales = [scales[0] * least, scales[1] * greatest];
                }
                reach.swept.add(region.corners);
                reach.steps = reach.steps.max(steps);
            }
            let limit = |scale: f64| scale.clamp(LEAST_SCALE, LARGEST_SCALE);
            reach.scales.push(scales.map(limit));
        }
        reach
    }

    /// Returns the box around an extent and all that instances sweep. `step` returns the length of a coordinate step on
    /// a lattice around such a box.
    pub fn extent(
        &self,
        extent: (DVec3, DVec3),
        bits: u8,
        step: impl Fn(&Lattice, [DVec3; 2]) -> f64,
    ) -> (DVec3, DVec3) {
        /// Rounds until a box holds the steps of its own lattice. A coarser lattice seldom has longer steps.
        const ROUNDS: usize = 8;
        let mut swept = self.swept;
        let mut whole = swept.extent(extent, bits);
        if self.steps == 0.0 {
            return whole;
        }
        for _ in 0..ROUNDS {
            let corners = [whole.0, whole.1];
            // An extent without a lattice is reported later.
            let lattice = Lattice::around(corners, bits, 0).ok();
            let off = lattice.map_or(0.0, |it| self.off(step(&it, corners)));
            if off <= swept.off {
                break;
            }
            swept.off = off;
            whole = swept.extent(extent, bits);
        }
        whole
    }

    /// Widens a box on the lattice to where instances reach with coordinate steps of this length.
    pub fn around(&self, bounds: UnitBox, lattice: &Lattice, step: f64) -> UnitBox {
        let swept = Swept {
            off: self.off(step),
            ..self.swept
        };
        let swept = swept.on_lattice(lattice);
        swept.map_or(bounds, |swept| bounds.union(&swept))
    }

    /// Returns how far motion in coordinate steps of this length takes an instance off, in scene units.
    pub fn off(&self, step: f64) -> f64 {
        self.steps * step
    }
}

/// The rotations of a joint, without small ones.
#[derive(Clone, Copy, Debug)]
enum Turn {
    None,
    About(DVec3),
    Any,
}

/// The rotations of a joint.
#[derive(Clone, Copy, Debug)]
struct Turns {
    turn: Turn,
    /// Largest angle of the small rotations that come with these, in radians.
    off: f64,
}

impl Turns {
    const NONE: Self = Self {
        turn: Turn::None,
        off: 0.0,
    };
}

/// The longest side of the box around all instances on joints, at rest.
fn size_at_rest(scene: &Scene, parts: &[[DVec3; 2]]) -> f64 {
    let moving = scene.instances.iter();
    let moving = moving.filter(|it| it.joint.is_some() && scene.is_placed(it));
    let boxes = moving.map(|it| Region::of(parts[it.part], &it.placement).corners);
    let around = boxes.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    around.map_or(0.0, |[low, high]| (high - low).max_element())
}

/// All that a joint does at some time, and its rest.
#[derive(Clone, Copy, Debug)]
struct Range {
    pivot: DVec3,
    turns: Turns,
    scale: [f64; 2],
    shift: [DVec3; 2],
}

impl Range {
    fn of(joint: &Joint, tracks: &JointTracks<'_>) -> Self {
        let scale = tracks.scale.map_or(ScaleRange::REST, |track| {
            ScaleRange::of(track.interpolation, &track.keys)
        });
        let shift = tracks.shift.map_or([DVec3::ZERO; 2], |track| {
            let points = track.control_points().map(DVec4::truncate);
            points.fold([DVec3::ZERO; 2], |[low, high], it| {
                [low.min(it), high.max(it)]
            })
        });
        Self {
            pivot: joint.pivot,
            turns: tracks.rotation.map_or(Turns::NONE, turns),
            scale: scale.ends(),
            shift,
        }
    }

    /// Returns how far a place is off after a joint's motion, in coordinate steps, given how far it was off before.
    /// Pivot and shift are whole steps. A pivot that is off moves a place by the difference of the motion from none.
    fn off(&self, before: f64) -> f64 {
        let [least, greatest] = self.scale;
        let turned = match self.turns.turn {
            Turn::None => self.turns.off,
            _ => 2.0,
        };
        let change = (1.0 - least).max(greatest - 1.0) + greatest * turned;
        let shift = match self.shift == [DVec3::ZERO; 2] {
            true => 0.0,
            false => SHIFT_OFF,
        };
        before * greatest + change.min(1.0 + greatest) * PIVOT_OFF + shift
    }
}

/// The rotations of a track.
fn turns(track: &Track) -> Turns {
    // Linear ways are those between rotations, whatever the lengths of their quaternions.
    let points = track.control_points();
    let imaginary = points.map(|it| match track.interpolation {
        Interpolation::Cubic => it.truncate(),
        _ => DVec4::from(DQuat::from_vec4(it).normalize()).truncate(),
    });
    let longest = imaginary.clone().fold(DVec3::ZERO, |longest, it| {
        match it.length_squared() > longest.length_squared() {
            true => it,
            false => longest,
        }
    });
    let shortest = shortest(track);
    // The rotation by a quaternion of length 1 has twice the angle whose sine is the length of its imaginary part.
    let angle = |off: f64| 2.0 * libm::asin((off / shortest).min(1.0));
    let is_small = |off: f64| off == 0.0 || (off <= SAME_AXIS && off < shortest);
    if is_small(longest.length()) {
        return Turns {
            turn: Turn::None,
            off: match longest == DVec3::ZERO {
                true => 0.0,
                false => angle(longest.length()),
            },
        };
    }
    let axis = longest.normalize();
    let across = imaginary.map(|it| it.cross(axis).length());
    let across = across.fold(0.0, f64::max);
    match across {
        0.0 => Turns {
            turn: Turn::About(axis),
            off: 0.0,
        },
        _ if is_small(across) => Turns {
            turn: Turn::About(axis),
            off: angle(across),
        },
        // A spline through quaternions of nearly no length, all about one axis.
        _ if across <= SAME_AXIS * SAME_AXIS => Turns {
            turn: Turn::About(axis),
            off: 0.0,
        },
        _ => Turns {
            turn: Turn::Any,
            off: 0.0,
        },
    }
}

/// A length that quaternions between the keys of a track, with those of length 1 of linear ones, do not fall below; at
/// most 0 where a spline can be that short.
fn shortest(track: &Track) -> f64 {
    if track.interpolation != Interpolation::Cubic {
        // Parts of two quaternions on the shorter way between them add up to at most the root of 2.
        return std::f64::consts::FRAC_1_SQRT_2;
    }
    let lengths = track.keys.windows(2).map(|pair| {
        let points: Vec<DVec4> = control_points(track.interpolation, pair).collect();
        let along = points.iter().sum::<DVec4>().normalize_or_zero();
        let lengths = points.iter().map(|point| along.dot(*point));
        lengths.fold(f64::INFINITY, f64::min)
    });
    let ends = track
        .keys
        .iter()
        .map(|key| DVec4::from_array(key.value).length());
    lengths.chain(ends).fold(f64::INFINITY, f64::min)
}

/// A box and a sphere that both hold a part.
#[derive(Clone, Copy, Debug)]
struct Region {
    corners: [DVec3; 2],
    center: DVec3,
    radius: f64,
}

impl Region {
    /// The box of a part where it is placed.
    fn of([low, high]: [DVec3; 2], placement: &Placement) -> Self {
        let half = (high - low) * 0.5;
        let matrix = placement.matrix();
        let reach = matrix.x_axis.abs() * half.x
            + matrix.y_axis.abs() * half.y
            + matrix.z_axis.abs() * half.z;
        let center = placement.point(low.midpoint(high));
        Self {
            corners: [center - reach, center + reach],
            center,
            radius: half.length() * placement.scale,
        }
    }

    /// Returns the region after a joint's motion. Small rotations may use up to `spare` of the margin.
    fn moved(&self, range: &Range, spare: &mut f64) -> Self {
        let Range {
            pivot,
            turns,
            scale: [least, greatest],
            shift,
        } = *range;
        let Self {
            corners: [low, high],
            center,
            radius,
        } = self
            .seen_from(pivot)
            .turned_off(range, spare)
            .turned(turns.turn);
        let scaled = Self {
            corners: [
                (low * least).min(low * greatest),
                (high * least).max(high * greatest),
            ],
            center: center * least.midpoint(greatest),
            radius: radius * greatest + center.length() * (greatest - least) * 0.5,
        };
        let [from, to] = shift.map(|shift| pivot + shift);
        Self {
            corners: [scaled.corners[0] + from, scaled.corners[1] + to],
            center: scaled.center + from.midpoint(to),
            radius: scaled.radius + (to - from).length() * 0.5,
        }
        .trimmed()
    }

    /// Returns the region relative to a place.
    fn seen_from(&self, place: DVec3) -> Self {
        Self {
            corners: self.corners.map(|corner| corner - place),
            center: self.center - place,
            ..*self
        }
    }

    /// Returns the region that small rotations about the origin, and the rounding of a joint's motion, sweep. The part
    /// that lies in the margin is left out.
    fn turned_off(&self, range: &Range, spare: &mut f64) -> Self {
        let rests = matches!(range.turns.turn, Turn::None) && range.turns.off == 0.0;
        let rounding = match rests && range.scale == [1.0; 2] {
            true => 0.0,
            false => ROUNDING,
        };
        let [low, high] = self.corners;
        let farthest = low.abs().max(high.abs()).length();
        let by = (range.turns.off + rounding) * farthest.min(self.center.length() + self.radius);
        if by <= *spare {
            *spare -= by;
            return *self;
        }
        Self {
            corners: [low - by, high + by],
            radius: self.radius + by,
            ..*self
        }
    }

    /// Returns the region that rotations about the origin sweep.
    fn turned(&self, turn: Turn) -> Self {
        let [low, high] = self.corners;
        let corner = |number: usize| {
            let side = |axis: usize| if number >> axis & 1 == 0 { low } else { high };
            DVec3::new(side(0).x, side(1).y, side(2).z)
        };
        let farthest = |distance: &dyn Fn(DVec3) -> f64| {
            let corners = (0..8).map(|number| distance(corner(number)));
            let of_box = corners.fold(0.0, f64::max);
            of_box.min(distance(self.center) + self.radius)
        };
        let ball = farthest(&DVec3::length);
        let ball = Self {
            corners: [DVec3::splat(-ball), DVec3::splat(ball)],
            center: DVec3::ZERO,
            radius: ball,
        };
        let axis = match turn {
            Turn::None => return *self,
            Turn::Any => return ball,
            Turn::About(axis) => axis,
        };
        let along = |place: DVec3| axis * axis.dot(place);
        let around = farthest(&|place| (place - along(place)).length());
        let sides = [axis * low, axis * high];
        let [bottom, top] = [
            sides[0].min(sides[1]).element_sum(),
            sides[0].max(sides[1]).element_sum(),
        ];
        let height = axis.dot(self.center);
        let (bottom, top) = (
            bottom.max(height - self.radius),
            top.min(height + self.radius),
        );
        let wide = (DVec3::ONE - axis * axis).max(DVec3::ZERO).map(f64::sqrt) * around;
        let ends = [axis * bottom, axis * top];
        let drum = Self {
            corners: [ends[0].min(ends[1]) - wide, ends[0].max(ends[1]) + wide],
            center: axis * bottom.midpoint(top),
            radius: libm::hypot(around, (top - bottom) * 0.5),
        };
        match drum.radius < ball.radius {
            true => drum,
            false => Self {
                center: ball.center,
                radius: ball.radius,
                ..drum
            },
        }
        .trimmed()
    }

    /// Returns the region without the parts of the box outside of the sphere.
    fn trimmed(self) -> Self {
        let [low, high] = self.corners;
        Self {
            corners: [
                low.max(self.center - self.radius),
                high.min(self.center + self.radius),
            ],
            ..self
        }
    }
}

#[cfg(test)]
mod tests;
