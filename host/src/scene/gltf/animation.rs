//! The animations of a glTF file: tracks of its camera and its lights, and curves of its other nodes.
//!
//! A node's own translation and rotation keep their keys. Where nodes above it move as well, or tracks do not have such
//! an interpolation, they are sampled [`RATE`] times per second and at their keys.

use super::ancestry::Ancestry;
use super::buffers::Buffers;
use super::curve::{Curve, key_count, seconds, tick};
use super::place::{parts, transform};
use crate::scene::placement::rotation_and_scale;
use crate::scene::size::Keys;
use crate::scene::{
    CauseAndRemedy, Interpolation, Key, SceneError, SourceSpan, TICKS_PER_SECOND, Track,
    TrackTarget,
};
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3, DVec4};
use gltf::animation::Property;
use gltf::{Animation, Document, Node};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

/// Samples per second of a motion that has no keys of its own.
const RATE: f64 = 60.0;

/// Most samples of a motion; longer ones are sampled less often.
const MOST_SAMPLES: f64 = 65_536.0;

/// Most samples of all curves of a file.
const MOST_SAMPLES_OF_ALL: usize = 1 << 20;

/// Most steps of sampling: each sample, and each key, takes one for each node on the way up. They take seconds.
const MOST_STEPS: usize = 1 << 25;

/// The moving properties of a node.
#[derive(Clone, Debug, Default)]
struct NodeCurves {
    translation: Option<Curve>,
    rotation: Option<Curve>,
    scale: Option<Curve>,
    /// One for each morph target.
    weights: Option<Vec<Curve>>,
}

/// A node at rest.
struct Rest {
    matrix: DMat4,
    /// Translation, rotation and scale.
    parts: [DVec4; 3],
}

/// The animation that is read, by the nodes that it moves.
#[derive(Default)]
pub(super) struct Motion {
    nodes: HashMap<usize, NodeCurves>,
    ancestry: Ancestry,
    /// Each node in the one above, at rest.
    rest: Vec<Rest>,
    /// Channels that are not read, and why.
    pub(super) left_out: Vec<String>,
    /// Number of samples of all curves.
    samples: usize,
    /// Number of steps of sampling.
    steps: usize,
    /// The least samples per second of a curve, if any was sampled.
    pub(super) least_rate: Option<f64>,
}

impl Motion {
    /// Reads an animation.
    pub(super) fn read(
        path: &Path,
        document: &Document,
        animation: Option<&Animation<'_>>,
        buffers: &Buffers<'_>,
    ) -> Result<Self, SceneError> {
        let mut motion = Self {
            ancestry: Ancestry::of(document),
            rest: document.nodes().map(|node| Rest::of(&node)).collect(),
            ..Self::default()
        };
        let targets = targets(document);
        let targets_of = |node: &Node<'_>| node.mesh().map_or(0, |mesh| targets[mesh.index()]);
        let channels = || animation.into_iter().flat_map(Animation::channels);
        let mut keys = Keys::default();
        for (number, channel) in channels().enumerate() {
            let count = key_count(&channel, targets_of(&channel.target().node()));
            keys.add(count).map_err(|excess| {
                let animation = channel.animation().index();
                SceneError::new(
                    path,
                    format!("up to channel {number}, animation {animation} has {excess}"),
                    "export a shorter animation, or with fewer keys per second, or leave it out with `--animation none`",
                )
            })?;
        }
        let channels = channels();
        for (number, channel) in channels.enumerate() {
            let target = channel.target();
            let moves = motion.nodes.entry(target.node().index()).or_default();
            let property = target.property();
            let curve = match property {
                Property::MorphTargetWeights => None,
                Property::Translation => Some(&mut moves.translation),
                Property::Rotation => Some(&mut moves.rotation),
                Property::Scale => Some(&mut moves.scale),
            };
            let error = |cause: String| {
                SceneError::new(
                    path,
                    format!(
                        "animation {}, channel {number} of node {}: {cause}",
                        channel.animation().index(),
                        target.node().index()
                    ),
                    "export the animation again, or leave it out with `--animation none`",
                )
            };
            let mut found = match curve {
                Some(_) => vec![Curve::read(&channel, buffers)?],
                None => Curve::weights(&channel, targets_of(&target.node()), buffers)?,
            };
            for curve in &mut found {
                curve.check(property).map_err(error)?;
                curve.round_times();
            }
            let node = target.node().index();
            if curve.is_none() && found.is_empty() {
                let sentence = format!(
                    "the animation moves weights of node {node}, whose mesh has no morph targets"
                );
                motion.left_out.push(sentence);
                continue;
            }
            let twice = match curve {
                Some(curve) => std::mem::replace(curve, found.pop()).is_some(),
                None => moves.weights.replace(found).is_some(),
            };
            if twice {
                let sentence = format!(
                    "the animation has two channels for one property of node {node}, of which the last is read"
                );
                motion.left_out.push(sentence);
            }
        }
        let nodes = &motion.nodes;
        let moves = |node| nodes.get(&node).is_some_and(NodeCurves::moves);
        motion.ancestry.mark(moves);
        Ok(motion)
    }

    /// Returns whether nothing moves.
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The weights of a node's morph targets, if they change.
    pub(super) fn weights(&self, node: usize) -> Option<&[Curve]> {
        self.nodes.get(&node)?.weights.as_deref()
    }

    /// Returns whether a node, or one above it, moves.
    pub(super) fn moves(&self, node: usize) -> bool {
        self.ancestry.moves(node)
    }

    pub(super) fn moves_itself(&self, node: usize) -> bool {
        self.nodes.get(&node).is_some_and(NodeCurves::moves)
    }

    /// The translation, rotation and scale of a node that moves.
    pub(super) fn curves(&self, node: usize) -> Option<[Option<&Curve>; 3]> {
        let moves = self.nodes.get(&node)?;
        let all = [&moves.translation, &moves.rotation, &moves.scale];
        Some(all.map(Option::as_ref))
    }

    /// The node above a node.
    pub(super) fn parent(&self, node: usize) -> Option<usize> {
        self.ancestry.parent(node)
    }

    /// Returns translation, rotation and scale of a node in the one above it.
    fn local_parts(&self, node: usize, seconds: f64) -> (DVec3, DQuat, DVec3) {
        let curves = self.curves(node).unwrap_or_default();
        let properties = [Property::Translation, Property::Rotation, Property::Scale];
        let [translation, rotation, scale] = [0, 1, 2].map(|part: usize| match curves[part] {
            Some(curve) => DVec4::from_array(curve.at(seconds, properties[part])),
            None => self.rest[node].parts[part],
        });
        let rotation = DQuat::from_vec4(rotation).normalize();
        (translation.truncate(), rotation, scale.truncate())
    }

    /// Returns the transform of a node in the one above it.
    fn local(&self, node: usize, seconds: f64) -> DMat4 {
        if !self.moves_itself(node) {
            return self.rest[node].matrix;
        }
        let (translation, rotation, scale) = self.local_parts(node, seconds);
        DMat4::from_scale_rotation_translation(scale, rotation, translation)
    }

    /// Returns the transform of a node in the scene.
    fn world(&self, node: usize, seconds: f64) -> DMat4 {
        let locals = self.ancestry.chain(node).map(|it| self.local(it, seconds));
        locals.fold(DMat4::IDENTITY, |world, local| local * world)
    }

    /// The transform in the scene of what is above a node.
    fn above(&self, node: usize, seconds: f64) -> DMat4 {
        let parent = self.parent(node);
        parent.map_or(DMat4::IDENTITY, |parent| self.world(parent, seconds))
    }

    /// The rotation of a camera at a node, whose own scale does not count.
    fn camera_rotation(&self, node: usize, seconds: f64) -> DQuat {
        let (_, rotation, _) = self.local_parts(node, seconds);
        turned(&(self.above(node, seconds) * DMat4::from_quat(rotation)))
    }

    /// Counts steps before they are taken.
    fn count_steps(&mut self, steps: usize) -> Result<(), CauseAndRemedy> {
        self.steps = self.steps.saturating_add(steps);
        if self.steps <= MOST_STEPS {
            return Ok(());
        }
        Err(CauseAndRemedy::new(
            format!(
                "cameras and lights that move take more than {MOST_STEPS} steps: one for each sample, and for each key, \
                 of each node above them"
            ),
            String::from(
                "put them below fewer nodes, animate fewer lights, shorten the animation, or leave it out with \
                 `--animation none`",
            ),
        ))
    }

    /// The times at which a node is sampled.
    fn sample_times(&mut self, node: usize) -> Result<Vec<f64>, CauseAndRemedy> {
        let depth = self.ancestry.depth(node);
        self.count_steps(depth)?;
        let curves = self.ancestry.chain(node).filter_map(|it| self.curves(it));
        let keys = curves.flatten().flatten().map(|curve| curve.keys.len());
        self.count_steps(keys.sum())?;
        let moves = self.ancestry.chain(node);
        let moves = moves.filter_map(|it| self.nodes.get(&it));
        let curves = moves.flat_map(|it| [&it.translation, &it.rotation, &it.scale]);
        let mut ticks = BTreeSet::new();
        for curve in curves.flatten() {
            ticks.extend(curve.keys.iter().map(|key| tick(key.seconds)));
            if curve.interpolation == Interpolation::Step {
                // The value before a key stays until it.
                let later = curve.keys.iter().skip(1);
                ticks.extend(later.map(|key| tick(key.seconds) - 1));
            }
        }
        if let (Some(&first), Some(&last)) = (ticks.first(), ticks.last()) {
            let span = (last - first) as f64;
            let seconds = span / f64::from(TICKS_PER_SECOND);
            let steps = (seconds * RATE).ceil().clamp(0.0, MOST_SAMPLES);
            let between = (1..steps as u32).map(|step| f64::from(step) / steps);
            ticks.extend(between.map(|share| first + (share * span).round() as i64));
            let rate = if steps < MOST_SAMPLES {
                RATE
            } else {
                steps / seconds
            };
            self.least_rate = Some(self.least_rate.map_or(rate, |least| least.min(rate)));
        }
        self.samples += ticks.len();
        if self.samples > MOST_SAMPLES_OF_ALL {
            return Err(CauseAndRemedy::new(
                format!(
                    "cameras and lights below nodes that move take more than {MOST_SAMPLES_OF_ALL} samples"
                ),
                String::from(
                    "animate fewer lights, shorten the animation, move the lights themselves, or leave the animation \
                     out with `--animation none`",
                ),
            ));
        }
        self.count_steps(ticks.len().saturating_mul(depth))?;
        Ok(ticks.into_iter().map(seconds).collect())
    }

    /// The tracks of a camera at a node; none if it stands still.
    pub(super) fn camera(
        &mut self,
        node: usize,
        place: &SourceSpan,
    ) -> Result<Vec<Track>, CauseAndRemedy> {
        if !self.moves(node) {
            return Ok(Vec::new());
        }
        self.count_steps(self.ancestry.depth(node))?;
        let track = |target, curve: Curve| Track {
            target,
            index: 0,
            interpolation: curve.interpolation,
            keys: curve.keys,
            place: place.clone(),
        };
        let [eye, rotation] = if let Some(own) = self.own_curves(node) {
            own
        } else {
            let times = self.sample_times(node)?;
            let eye = |&seconds: &f64| {
                let world = self.world(node, seconds);
                Key::of_vector(seconds, world.transform_point3(DVec3::ZERO))
            };
            let rotation = |&seconds: &f64| Key {
                seconds,
                value: self.camera_rotation(node, seconds).to_array(),
                ..Key::default()
            };
            let linear = |keys| Curve {
                interpolation: Interpolation::Linear,
                keys,
            };
            [
                linear(times.iter().map(eye).collect()),
                linear(times.iter().map(rotation).collect()),
            ]
        };
        Ok(vec![
            track(TrackTarget::CameraEye, eye),
            track(TrackTarget::CameraRotation, rotation),
        ])
    }

    /// Returns position and rotation of a node with its own keys, if no node above it moves.
    fn own_curves(&self, node: usize) -> Option<[Curve; 2]> {
        if !self.moves_alone(node) {
            return None;
        }
        let moves = self.nodes.get(&node)?;
        let above = DAffine3::from_mat4(self.above(node, 0.0));
        let world = self.world(node, 0.0);
        let still = |value: [f64; 4]| Curve {
            interpolation: Interpolation::Step,
            keys: vec![Key {
                seconds: first_time(moves),
                value,
                ..Key::default()
            }],
        };
        let eye = match &moves.translation {
            Some(curve) => curve.placed(&above),
            None => {
                let [x, y, z] = world.transform_point3(DVec3::ZERO).to_array();
                still([x, y, z, 0.0])
            }
        };
        let rotation = match &moves.rotation {
            Some(curve) => {
                let above = rotation_of(above.matrix3)?;
                curve.map(|value| (above * DQuat::from_array(value)).to_array())
            }
            None => still(self.camera_rotation(node, 0.0).to_array()),
        };
        Some([eye, rotation])
    }

    /// Returns true if no node above a node moves.
    fn moves_alone(&self, node: usize) -> bool {
        !self.parent(node).is_some_and(|above| self.moves(above))
    }

    /// Returns whether a node that moves keeps its direction: it is neither turned nor scaled.
    pub(super) fn keeps_direction(&self, node: usize) -> bool {
        let is_kept = |moves: &NodeCurves| moves.rotation.is_none() && moves.scale.is_none();
        self.moves_alone(node) && self.nodes.get(&node).is_some_and(is_kept)
    }

    /// Returns the direction in which a node shines with its own keys, if it turns in steps and nothing else changes
    /// it. (A smooth turn is not the straight way between two directions, so that it is sampled.)
    fn own_direction(&self, node: usize) -> Option<Curve> {
        let moves = self.nodes.get(&node).filter(|it| it.scale.is_none())?;
        let rotation = moves.rotation.as_ref()?;
        if rotation.interpolation != Interpolation::Step || !self.moves_alone(node) {
            return None;
        }
        let above = self.above(node, 0.0);
        let (_, _, scale) = self.local_parts(node, 0.0);
        Some(rotation.map(|value| {
            let forward = DQuat::from_array(value) * (scale * -DVec3::Z);
            let [x, y, z] = above.transform_vector3(forward).to_array();
            [x, y, z, 0.0]
        }))
    }

    /// The track of a light at a node, if it moves.
    pub(super) fn light(
        &mut self,
        node: usize,
        index: usize,
        directional: bool,
        place: &SourceSpan,
    ) -> Result<Option<Track>, CauseAndRemedy> {
        if !self.moves(node) || directional && self.keeps_direction(node) {
            return Ok(None);
        }
        self.count_steps(self.ancestry.depth(node))?;
        let own = match directional {
            true => self.own_direction(node),
            false => self.own_curves(node).map(|[eye, _]| eye),
        };
        let curve = match own {
            Some(curve) => curve,
            None => {
                let times = self.sample_times(node)?;
                let key = |seconds: f64| {
                    let world = self.world(node, seconds);
                    let vector = match directional {
                        true => world.transform_vector3(-DVec3::Z),
                        false => world.transform_point3(DVec3::ZERO),
                    };
                    Key::of_vector(seconds, vector)
                };
                Curve {
                    interpolation: Interpolation::Linear,
                    keys: times.into_iter().map(key).collect(),
                }
            }
        };
        let aims = curve.keys.iter().all(|key| key.vector() != DVec3::ZERO);
        Ok((aims || !directional).then(|| Track {
            target: match directional {
                true => TrackTarget::LightDirection,
                false => TrackTarget::LightPosition,
            },
            index,
            interpolation: curve.interpolation,
            keys: curve.keys,
            place: place.clone(),
        }))
    }
}

impl NodeCurves {
    /// Returns whether the node itself moves, not its weights alone.
    fn moves(&self) -> bool {
        self.translation.is_some() || self.rotation.is_some() || self.scale.is_some()
    }
}

impl Rest {
    fn of(node: &Node<'_>) -> Self {
        let matrix = transform(node);
        // A matrix that is sheared or flat has none. That it moves is more than glTF allows.
        let parts = parts(node).unwrap_or_else(|| {
            let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
            let rotation = match rotation.is_finite() {
                true => rotation,
                false => DQuat::IDENTITY,
            };
            [translation.extend(0.0), rotation.into(), scale.extend(0.0)]
        });
        Self { matrix, parts }
    }
}

/// Returns the number of morph targets of each mesh.
fn targets(document: &Document) -> Vec<usize> {
    let meshes = document.meshes().map(|mesh| {
        let targets = mesh.primitives().map(|it| it.morph_targets().len());
        targets.max().unwrap_or(0)
    });
    meshes.collect()
}

/// The time of a node's first key.
fn first_time(moves: &NodeCurves) -> f64 {
    let curves = [&moves.translation, &moves.rotation, &moves.scale];
    let keys = curves.into_iter().flatten().flat_map(|curve| &curve.keys);
    keys.map(|key| key.seconds).fold(f64::INFINITY, f64::min)
}

/// Returns the rotation of a camera that looks along -z of a node, with y upwards as far as possible.
fn turned(world: &DMat4) -> DQuat {
    let back = world.transform_vector3(DVec3::Z).normalize_or(DVec3::Z);
    let right = world.transform_vector3(DVec3::Y).cross(back);
    let right = right.normalize_or(back.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back))
}

/// Returns the rotation of a matrix that scales equally in all directions; `None` for another.
fn rotation_of(matrix: DMat3) -> Option<DQuat> {
    /// Tolerance of single precision.
    const TOLERANCE: f64 = 1e-6;
    rotation_and_scale(matrix, TOLERANCE).map(|(rotation, _)| rotation)
}
