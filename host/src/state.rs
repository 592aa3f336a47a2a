//! Camera, lights, materials, meshes and instances of a blob at a time, as its tracks say.

use crate::blob::Blob;
use crate::morphed::{MorphError, morphed};
use bytemuck::Zeroable;
use gridel_core::format::instance::Instance;
use gridel_core::format::record::{Light, Material, Pair, View};
use gridel_core::format::track::TrackTarget;
use gridel_core::render::CameraError;
use gridel_core::{BlobError, Motion, PosesView, Scene, Tracks};

/// The parts of a scene that change with time, at some time.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// use gridel_core::Tracks;
/// use gridel_host::state::{State, ticks};
///
/// let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
///     [[track]]\ntarget = 'camera.orbit'\ntimes = [0, 4]\nvalues = [0, 360]";
/// let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// let blob = compile(&imported.scene, &Options::default())?.blob;
/// let scene = blob.scene()?;
/// let tracks = Tracks::from_bytes(blob.bytes())?;
/// // Seen from the side, after a quarter of a turn.
/// let state = State::at(&blob, &scene, &tracks, ticks(&tracks, 1.0)?)?;
/// let seen = state.apply(&scene)?;
/// assert!(seen.view().eye[0] > 0 && seen.view().eye[2] == 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub view: View,
    pub lights: Vec<Light>,
    pub materials: Vec<Material>,
    /// `None` where no instance hangs on a joint.
    pub poses: Option<Poses>,
    /// The blob with its meshes at the weights of their morph targets; `None` where they are at rest.
    pub morphed: Option<Blob>,
}

/// Instances where joints have moved them.
#[derive(Clone, Debug, PartialEq)]
pub struct Poses {
    instances: Vec<Instance>,
    /// The hierarchy above them.
    pairs: Vec<Pair>,
}

impl Poses {
    /// Returns the instances of a scene, as it was loaded, at a time in ticks; `None` where none hangs on a joint.
    ///
    /// # Errors
    /// If an instance leaves the scene's box, which those of a compiled scene do not, or the tracks are not those of
    /// the scene's blob.
    pub fn at(
        scene: &Scene<'_>,
        tracks: &Tracks<'_>,
        time: i32,
    ) -> Result<Option<Self>, BlobError> {
        let count = scene.instances().len();
        if count == 0 || tracks.joints().is_empty() {
            return Ok(None);
        }
        let mut motions = vec![Motion::REST; tracks.joints().len()];
        tracks.motions_at(time, &mut motions)?;
        let mut instances = scene.instances().to_vec();
        let mut pairs = vec![Pair::zeroed(); count];
        let mut order = vec![0; count];
        let mut poses = PosesView::at_rest(scene, &mut instances, &mut pairs, &mut order)?;
        tracks.place(scene, &motions, &mut poses)?;
        scene.with_poses(poses)?;
        pairs.truncate(count - 1);
        Ok(Some(Self::in_order(instances, pairs)))
    }

    /// Brings instances into the order of their leaves, as in a blob.
    fn in_order(instances: Vec<Instance>, mut pairs: Vec<Pair>) -> Self {
        /// The bit that makes a child a leaf.
        const LEAF: u32 = 1 << 31;
        if pairs.is_empty() {
            return Self { instances, pairs };
        }
        let mut ordered = Vec::with_capacity(instances.len());
        let children = pairs.iter_mut().flat_map(|pair| &mut pair.children);
        for child in children.filter(|child| **child & LEAF != 0) {
            let leaf = ordered.len() as u32;
            ordered.push(instances[(*child & !LEAF) as usize]);
            *child = LEAF | leaf;
        }
        Self {
            instances: ordered,
            pairs,
        }
    }

    /// Returns the scene with its instances here.
    ///
    /// # Errors
    /// If they are those of another scene.
    pub fn apply<'a>(&'a self, scene: &Scene<'a>) -> Result<Scene<'a>, BlobError> {
        scene.with_instances(&self.instances, &self.pairs)
    }
}

/// The reason why a scene has no state at a time.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The camera is invalid at this time, in seconds.
    #[error("at {seconds} s there is no picture: {source}")]
    Camera { seconds: f64, source: CameraError },
    /// An instance cannot be where it is led at this time, in seconds.
    #[error("at {seconds} s an instance cannot be placed: {source}")]
    Instances { seconds: f64, source: BlobError },
    /// A mesh cannot have the weights of this time, in seconds.
    #[error("at {seconds} s a mesh cannot take its shape: {source}")]
    Mesh { seconds: f64, source: MorphError },
    /// The tracks are of another blob.
    #[error(transparent)]
    Blob(#[from] BlobError),
}

impl State {
    /// Returns the state of a blob's scene at a time, in ticks of its tracks.
    ///
    /// # Errors
    /// If the camera would have no direction or would look along up, an instance leaves the scene's box, or the corners
    /// of a triangle come to lie on a line. Also if scene or tracks are those of another blob.
    pub fn at(
        blob: &Blob,
        scene: &Scene<'_>,
        tracks: &Tracks<'_>,
        time: i32,
    ) -> Result<Self, StateError> {
        let seconds = f64::from(time) / f64::from(tracks.ticks_per_second());
        let camera = tracks
            .camera_at(time)
            .map_err(|source| StateError::Camera { seconds, source })?;
        let view = camera.map_or(*scene.view(), |camera| camera.view(scene));
        let mut lights = scene.lights().to_vec();
        tracks.lights_at(scene, time, &mut lights)?;
        let mut materials = scene.materials().to_vec();
        tracks.materials_at(scene, time, &mut materials)?;
        let poses = Poses::at(scene, tracks, time)
            .map_err(|source| StateError::Instances { seconds, source })?;
        let mut weights = tracks.weights_at_rest().to_vec();
        tracks.weights_at(time, &mut weights)?;
        let morphed = match weights == tracks.weights_at_rest() {
            true => None,
            false => morphed(blob, scene, &weights)
                .map_err(|source| StateError::Mesh { seconds, source })?,
        };
        Ok(Self {
            view,
            lights,
            materials,
            poses,
            morphed,
        })
    }

    /// Returns how many bytes this takes, without the blob of meshes that have moved.
    pub fn bytes_without_meshes(&self) -> usize {
        let poses = self.poses.as_ref();
        size_of::<Self>()
            + size_of_val(&self.lights[..])
            + size_of_val(&self.materials[..])
            + poses.map_or(0, |it| {
                size_of_val(&it.instances[..]) + size_of_val(&it.pairs[..])
            })
    }

    /// Returns the scene in this state. Where meshes have moved, it is that of another blob.
    ///
    /// # Errors
    /// If a value is out of its range, which that of a track never is.
    pub fn apply<'a>(&'a self, scene: &Scene<'a>) -> Result<Scene<'a>, BlobError> {
        let scene = match &self.morphed {
            Some(blob) => blob.scene()?,
            None => *scene,
        };
        let scene = scene.with_view(&self.view)?.with_lights(&self.lights)?;
        let scene = scene.with_materials(&self.materials)?;
        match &self.poses {
            Some(poses) => poses.apply(&scene),
            None => Ok(scene),
        }
    }
}

/// Returns the materials of a scene with a trace of all that the tracks of its blob raise from 0.
/// [`Scene::with_materials`] of them makes a scene that requires the effects of all times.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// use gridel_core::Effects;
/// use gridel_host::state::raised_materials;
///
/// let file = "[material.pane]\ndiffuse = 1\n\
///     [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'pane'\n\
///     [[track]]\ntarget = 'material.pane.mirror'\ntimes = [0, 4]\nvalues = [0, 0.5]";
/// let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// let blob = compile(&imported.scene, &Options::default())?.blob;
/// let scene = blob.scene()?;
/// assert!(!scene.effects().contains(Effects::MIRROR));
/// let raised = raised_materials(&scene, blob.bytes());
/// assert!(scene.with_materials(&raised)?.effects().contains(Effects::MIRROR));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn raised_materials(scene: &Scene<'_>, blob: &[u8]) -> Vec<Material> {
    let mut materials = scene.materials().to_vec();
    // They were checked with the scene.
    let tracks = Tracks::from_bytes(blob).map_or(&[][..], |tracks| tracks.tracks());
    for track in tracks {
        let Some(material) = materials.get_mut(track.index as usize) else {
            continue;
        };
        let color = match track.target() {
            Some(TrackTarget::MaterialHighlight) => &mut material.highlight,
            Some(TrackTarget::MaterialMirror) => &mut material.mirror,
            Some(TrackTarget::MaterialTransmit) => &mut material.transmit,
            _ => continue,
        };
        if color.iter().all(|&channel| channel == 0) {
            *color = [1; 3];
        }
    }
    materials
}

/// A time before the first tick or after the last one.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the time {seconds} s is beyond the end of time; the times of this scene are from -{end} to {end}"
)]
pub struct TimeError {
    pub seconds: f64,
    /// The last whole second; the first is as long before 0.
    pub end: u32,
}

/// Returns the nearest tick to a time in seconds.
///
/// # Errors
/// If the time is beyond the first or the last tick, whose picture it would show.
pub fn ticks(tracks: &Tracks<'_>, seconds: f64) -> Result<i32, TimeError> {
    let rate = tracks.ticks_per_second();
    let tick = (seconds * f64::from(rate)).round();
    if tick.abs() <= i32::MAX.into() {
        return Ok(tick as i32);
    }
    let end = i32::MAX as u32 / rate;
    Err(TimeError { seconds, end })
}

/// Returns the moments while a shutter is open for some ticks from a time on: the middles of equal parts, in ticks. One
/// out of range is the first or the last tick.
///
/// ```
/// use gridel_host::state::exposed;
///
/// assert!(exposed(48_000, 800, 4).eq([48_100, 48_300, 48_500, 48_700]));
/// ```
pub fn exposed(start: i32, open: u32, moments: u16) -> impl Iterator<Item = i32> {
    let parts = i64::from(moments);
    (0..parts).map(move |part| {
        let after = i64::from(open) * (2 * part + 1) / (2 * parts);
        let time = i64::from(start) + after;
        time.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    })
}

#[cfg(test)]
mod tests;
