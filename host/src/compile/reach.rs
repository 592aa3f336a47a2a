//! How far instances move: a box that holds a placed part at all times of the tracks of its joints.
//!
//! Each joint has a range of rotations, scales and shifts, and all of them are taken together, at rest and at any time.
//! Keys bound the values between them: those of a spline together with its Bézier control points. Rotations about one
//! axis sweep a cylinder about it, others a sphere about the pivot.

use crate::scene::{
    Interpolation, Joint, JointTracks, Key, LARGEST_SCALE, LEAST_SCALE, Placement, Scene, Track,
};
use crate::shape::Lattice;
use glam::{DQuat, DVec3, DVec4};
use gridel_core::format::record::UnitBox;

/// Largest difference of the axes of rotations about one axis.
const SAME_AXIS: f64 = 1e-6;

/// By what part of its size room is widened: some units for the rounding of boxes.
const MARGIN: f64 = 1.0 / 4096.0;

/// How far the instances of a scene move.
#[derive(Debug, Default)]
pub struct Reach {
    /// The box around all that moves, and the room that the scene states.
    pub bounds: Option<[DVec3; 2]>,
    /// For each instance, its least and its greatest scale relative to that at rest.
    pub scales: Vec<[f64; 2]>,
}

impl Reach {
    /// The reach of a scene whose parts lie in these boxes.
    pub fn of(scene: &Scene, parts: &[[DVec3; 2]]) -> Self {
        let tracks = JointTracks::of(scene);
        let joints = scene.joints.iter().zip(&tracks);
        let ranges: Vec<Range> = joints.map(|(joint, it)| Range::of(joint, it)).collect();
        let mut reach = Self {
            bounds: scene.room,
            scales: Vec::with_capacity(scene.instances.len()),
        };
        for instance in &scene.instances {
            let mut scales = [1.0; 2];
            if let Some(joint) = instance.joint.filter(|_| scene.is_placed(instance)) {
                let mut region = Region::of(parts[instance.part], &instance.placement);
                let chain = std::iter::successors(Some(joint), |&it| scene.joints[it].parent);
                for joint in chain {
                    region = region.moved(&ranges[joint]);
                    let [least, greatest] = ranges[joint].scale;
                    scales = [scales[0] * least, scales[1] * greatest];
                }
                let [low, high] = reach.bounds.unwrap_or(region.corners);
                let [own_low, own_high] = region.corners;
                reach.bounds = Some([low.min(own_low), high.max(own_high)]);
            }
            let limit = |scale: f64| scale.clamp(LEAST_SCALE, LARGEST_SCALE);
            reach.scales.push(scales.map(limit));
        }
        reach.bounds = reach.bounds.map(|[low, high]| {
            let margin = DVec3::splat((high - low).max_element() * MARGIN);
            [low - margin, high + margin]
        });
        reach
    }

    /// The box around a scene's extent and this.
    pub fn around(&self, (lowest, highest): (DVec3, DVec3)) -> (DVec3, DVec3) {
        let [low, high] = self.bounds.unwrap_or([lowest, highest]);
        (low.min(lowest), high.max(highest))
    }

    /// The box around a scene's box and this, on its lattice.
    pub fn box_around(&self, own: UnitBox, lattice: &Lattice) -> UnitBox {
        let Some([low, high]) = self.bounds else {
            return own;
        };
        let units = |place: DVec3| (place - lattice.origin) / lattice.unit();
        // The casts saturate.
        let (low, high) = (units(low).floor().to_array(), units(high).ceil().to_array());
        let side = |axis: usize| [(low[axis] as i16).max(-i16::MAX), high[axis] as i16];
        own.union(&UnitBox([side(0), side(1), side(2)]))
    }
}

/// The rotations of a joint.
#[derive(Clone, Copy, Debug)]
enum Turn {
    None,
    About(DVec3),
    Any,
}

/// All that a joint does at some time, and its rest.
#[derive(Clone, Copy, Debug)]
struct Range {
    pivot: DVec3,
    turn: Turn,
    scale: [f64; 2],
    shift: [DVec3; 2],
}

impl Range {
    fn of(joint: &Joint, tracks: &JointTracks<'_>) -> Self {
        let scale = tracks.scale.map_or([1.0; 2], |track| {
            let points = control_points(track).map(|it| it.x.clamp(LEAST_SCALE, LARGEST_SCALE));
            points.fold([1.0; 2], |[least, greatest]: [f64; 2], it| {
                [least.min(it), greatest.max(it)]
            })
        });
        let shift = tracks.shift.map_or([DVec3::ZERO; 2], |track| {
            let points = control_points(track).map(DVec4::truncate);
            points.fold([DVec3::ZERO; 2], |[low, high], it| {
                [low.min(it), high.max(it)]
            })
        });
        Self {
            pivot: joint.pivot,
            turn: tracks.rotation.map_or(Turn::None, turn),
            scale,
            shift,
        }
    }
}

/// Points whose convex hull holds all values of a track.
fn control_points(track: &Track) -> impl Iterator<Item = DVec4> + Clone {
    let vector = DVec4::from_array;
    let keys = track.keys.iter().map(move |key| vector(key.value));
    let cubic = track.interpolation == Interpolation::Cubic;
    let pairs = track.keys.windows(2).filter(move |_| cubic);
    let between = pairs.flat_map(move |pair: &[Key]| {
        let third = (pair[1].seconds - pair[0].seconds) / 3.0;
        [
            vector(pair[0].value) + vector(pair[0].leaving) * third,
            vector(pair[1].value) - vector(pair[1].entering) * third,
        ]
    });
    keys.chain(between)
}

/// The rotations of a track.
fn turn(track: &Track) -> Turn {
    // Linear ways are those between rotations, whatever the lengths of their quaternions.
    let points = control_points(track).map(|it| match track.interpolation {
        Interpolation::Cubic => it,
        _ => DQuat::from_vec4(it).normalize().into(),
    });
    let imaginary = points.map(DVec4::truncate);
    let longest = imaginary.clone().fold(DVec3::ZERO, |longest, it| {
        match it.length_squared() > longest.length_squared() {
            true => it,
            false => longest,
        }
    });
    if longest.length() <= SAME_AXIS {
        return Turn::None;
    }
    let axis = longest.normalize();
    match imaginary
        .clone()
        .all(|it| it.cross(axis).length() <= SAME_AXIS)
    {
        true => Turn::About(axis),
        false => Turn::Any,
    }
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

    /// Returns the region after a joint's motion.
    fn moved(&self, range: &Range) -> Self {
        let Range {
            pivot,
            turn,
            scale: [least, greatest],
            shift,
        } = *range;
        let Self {
            corners: [low, high],
            center,
            radius,
        } = self.seen_from(pivot).turned(turn);
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
