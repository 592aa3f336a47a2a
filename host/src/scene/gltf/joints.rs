//! Nodes that an animation moves, as joints of the meshes below them.
//!
//! A node has its own transform `T R S` (at rest `T0 R0 S0`) in a node that stands at `W` at rest. It moves its
//! children by `W (T R S) (T0 R0 S0)^-1 W^-1`. This is a rotation `W R R0^-1 W^-1` and a scale `S / S0` about the pivot
//! `W T0`, and a shift by `W (T - T0)`. All three are linear in the keys, so the keys are kept, with any interpolation
//! between them.

use super::Importer;
use super::animation::Motion;
use super::curve::Curve;
use super::place::{parts, transform};
use super::shared::MeshNode;
use crate::scene::{
    Interpolation, Joint, Key, LARGEST_SCALE, Placement, ScaleRange, Track, TrackTarget, extremes,
};
use crate::table::printable;
use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};
use gltf::Node;
use std::collections::HashMap;

/// Largest difference of a matrix from a rotation times a scale, and of a change of size from a uniform one.
const TOLERANCE: f64 = 1e-5;

/// The scale of a mesh that shrinks to nothing.
const NOTHING: f64 = 1.0 / 256.0;

impl Importer<'_> {
    /// Makes joints of the nodes that move meshes. `placed` has all nodes, each behind the one above it.
    pub(super) fn joints(&mut self, placed: &[MeshNode<'_>]) {
        // For each node, whether it or one below it has a mesh that can move.
        let mut carries = HashMap::new();
        for (node, _) in placed.iter().rev() {
            let below = node
                .children()
                .any(|child| carries.get(&child.index()) == Some(&true));
            let own = node.mesh().is_some() && node.skin().is_none();
            carries.insert(node.index(), own || below);
        }
        let worlds: HashMap<usize, &DMat4> = placed
            .iter()
            .map(|(node, world)| (node.index(), world))
            .collect();
        for (node, world) in placed {
            let number = node.index();
            let above = self.motion.parent(number);
            let mut joint = above.and_then(|above| self.joint_of.get(&above).copied());
            if carries.get(&number) == Some(&true) && self.motion.moves_itself(number) {
                let above = above.and_then(|above| worlds.get(&above).copied());
                let above = above.copied().unwrap_or(DMat4::IDENTITY);
                joint = self.joint(node, &above, world, joint).or(joint);
            }
            if let Some(joint) = joint {
                self.joint_of.insert(number, joint);
            }
        }
    }

    /// Makes a joint of a node, if its animation moves a mesh below. `above` and `world` are the transforms at rest of
    /// the node above it and of the node itself.
    fn joint(
        &mut self,
        node: &Node<'_>,
        above: &DMat4,
        world: &DMat4,
        parent: Option<usize>,
    ) -> Option<usize> {
        let number = node.index();
        let name = node.name();
        let mut own = Own::of(node, &self.motion, above);
        let above = parent.map_or(ScaleRange::REST, |it| self.scales[it]);
        let scales = own.limit(&above);
        let called = name.map_or_else(String::new, |name| format!(" {:?}", printable(name)));
        for warning in own.warnings {
            self.warn(format!("node {number}{called} {warning}"));
        }
        if own.curves.is_empty() {
            return None;
        }
        let joint = self.scene.joints.len();
        self.scales.push(scales);
        self.scene.joints.push(Joint {
            name: name.map_or_else(|| format!("node {number}"), str::to_owned),
            parent,
            pivot: world.w_axis.truncate(),
            place: self.place.clone(),
        });
        let place = &self.place;
        let tracks = own.curves.into_iter().map(|(target, curve)| Track {
            target,
            index: joint,
            interpolation: curve.interpolation,
            keys: curve.keys,
            place: place.clone(),
        });
        self.scene.tracks.extend(tracks);
        Some(joint)
    }
}

/// The own motion of a node.
#[derive(Default)]
struct Own {
    curves: Vec<(TrackTarget, Curve)>,
    /// Parts of the motion that cannot be shown, and what happens instead.
    warnings: Vec<&'static str>,
}

impl Own {
    /// The motion of a node in nodes that stand at `above` at rest.
    fn of(node: &Node<'_>, motion: &Motion, above: &DMat4) -> Self {
        let mut own = Self::default();
        let Some([translation, rotation, scale]) = motion.curves(node.index()) else {
            return own;
        };
        let linear = DMat3::from_mat4(*above);
        let parts = parts(node);
        if let Some(curve) = translation {
            let rest = transform(node).w_axis.truncate();
            own.add(
                TrackTarget::JointShift,
                curve.relative_to(rest.extend(0.0), linear),
                DVec4::ZERO,
            );
        }
        let turned = Placement::near(
            linear * linear.determinant().signum(),
            DVec3::ZERO,
            TOLERANCE,
        );
        match (rotation, &turned, parts) {
            (None, ..) => {}
            (Some(curve), Some(above), Some([_, rest, _])) => {
                let [outer, inner] = [above.rotation, DQuat::from_vec4(rest).inverse() * above.rotation.inverse()];
                let mapped = curve.map(|value| (outer * DQuat::from_array(value) * inner).to_array());
                own.add(TrackTarget::JointRotation, mapped, DVec4::W);
            }
            (Some(_), _, None) => own
                .warnings
                .push("has a sheared matrix; it does not turn"),
            _ => own.warnings.push(
                "turns below a node that is scaled unevenly or sheared, where most turns would bend it; it does not turn",
            ),
        }
        match (scale, parts) {
            (None, _) => {}
            (Some(curve), Some([_, _, rest])) => match even(curve, rest.truncate()) {
                Some((mapped, vanishes)) => {
                    if vanishes {
                        own.warnings.push("shrinks to nothing; it keeps 1/256 of its size");
                    }
                    own.add(TrackTarget::JointScale, mapped, DVec4::X);
                }
                None => own.warnings.push(
                    "grows unevenly, from nothing, beyond 64 times its size or to its mirror image; it keeps its size at rest",
                ),
            },
            (Some(_), None) => own
                .warnings
                .push("has a sheared matrix; it keeps its size at rest"),
        }
        own
    }

    /// Leaves the scale out if it cannot be composed with those `above`, and returns what they come to.
    fn limit(&mut self, above: &ScaleRange) -> ScaleRange {
        let is_scale = |target: TrackTarget| target == TrackTarget::JointScale;
        let curve = self.curves.iter().find(|(target, _)| is_scale(*target));
        let own = curve.map_or(ScaleRange::REST, |(_, curve)| {
            ScaleRange::of(curve.interpolation, &curve.keys)
        });
        let range = own.under(above);
        // Without a scale of its own it is at most as large as what it hangs on.
        if range.fault().is_none() || curve.is_none() {
            return range;
        }
        self.curves.retain(|(target, _)| !is_scale(*target));
        self.warnings.push(
            "grows with the nodes above it beyond 64 times its size; it keeps its size at rest",
        );
        ScaleRange::REST.under(above)
    }

    /// Adds a track, unless it stays at rest.
    fn add(&mut self, target: TrackTarget, curve: Curve, rest: DVec4) {
        let is_rest = |value: [f64; 4]| {
            let value = DVec4::from_array(value);
            let [own, other] = match target {
                // For no rotation, either of the two quaternions will do, whatever its length.
                TrackTarget::JointRotation => [rest, -rest].map(|it| it * value.length()),
                _ => [rest; 2],
            };
            let rounding = 1e-9 * value.length().max(own.length());
            value.abs_diff_eq(own, rounding) || value.abs_diff_eq(other, rounding)
        };
        let mut keys = curve.keys.iter();
        let stays = keys
            .all(|key| is_rest(key.value) && key.entering == [0.0; 4] && key.leaving == [0.0; 4]);
        if !stays {
            self.curves.push((target, curve));
        }
    }
}

/// The least of the first component from one key to the next.
fn least_between(interpolation: Interpolation, keys: &[Key]) -> f64 {
    extremes(interpolation, keys).fold(f64::INFINITY, f64::min)
}

/// Flattens a spline of scales between two keys that falls below [`NOTHING`] between them, so that it stays above.
fn lift(keys: &mut [Key]) {
    /// Halvings of the range of factors, which make an error of 2^-40.
    const HALVINGS: usize = 40;
    /// Rounding of keys that end at `NOTHING` is left alone.
    const LEAST: f64 = 0.99 * NOTHING;
    let [one, other] = keys else { return };
    let flattened = |factor: f64| {
        let (mut one, mut other) = (*one, *other);
        one.leaving[0] *= factor;
        other.entering[0] *= factor;
        [one, other]
    };
    let stays = |factor: f64| least_between(Interpolation::Cubic, &flattened(factor)) >= LEAST;
    if stays(1.0) {
        return;
    }
    // Without changes at the keys all values are between theirs.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match stays(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    [*one, *other] = flattened(low);
}

/// Returns the uniform scale of a sequence of scales, relative to that at rest, and whether it shrinks to nothing at
/// some time. `None` if it is not uniform.
fn even(curve: &Curve, rest: DVec3) -> Option<(Curve, bool)> {
    let inverse = rest.recip();
    if !inverse.is_finite() {
        return None;
    }
    let ratios = curve.map(|[x, y, z, _]| {
        let [x, y, z] = (DVec3::new(x, y, z) * inverse).to_array();
        [x, y, z, 0.0]
    });
    let mut vanishes = false;
    let values = ratios.keys.iter().map(|key| key.value[0].abs());
    let largest = values.fold(0.0, f64::max);
    for key in &ratios.keys {
        let [x, ..] = key.value;
        vanishes |= x < NOTHING;
        let is_even = [key.value, key.entering, key.leaving]
            .iter()
            .all(|[x, y, z, _]| {
                let tolerance = TOLERANCE * x.abs().max(largest);
                (x - y).abs() <= tolerance && (x - z).abs() <= tolerance
            });
        if !is_even || !(0.0..=LARGEST_SCALE).contains(&x) {
            return None;
        }
    }
    let least = least_between(curve.interpolation, &ratios.keys);
    if least < -TOLERANCE * largest {
        return None;
    }
    vanishes |= least < NOTHING;
    let mut mapped = ratios.map(|[x, ..]| [x, 0.0, 0.0, 0.0]);
    for key in &mut mapped.keys {
        key.value[0] = key.value[0].max(NOTHING);
    }
    if vanishes && curve.interpolation == Interpolation::Cubic {
        (1..mapped.keys.len()).for_each(|next| lift(&mut mapped.keys[next - 1..=next]));
    }
    Some((mapped, vanishes))
}
