//! Camera, lights and materials of a blob at a time, as its tracks say.

use gridel_core::format::record::{Light, Material, View};
use gridel_core::render::CameraError;
use gridel_core::{BlobError, Scene, Tracks};

/// What of a scene changes with time, at some time.
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
/// let state = State::at(&scene, &tracks, ticks(&tracks, 1.0))?;
/// let seen = state.apply(&scene)?;
/// assert!(seen.view().eye[0] > 0 && seen.view().eye[2] == 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub view: View,
    pub lights: Vec<Light>,
    pub materials: Vec<Material>,
}

/// Why a scene has no state at a time.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The camera is none at this time, in seconds.
    #[error("at {seconds} s there is no picture: {source}")]
    Camera { seconds: f64, source: CameraError },
    /// The tracks are of another blob.
    #[error(transparent)]
    Blob(#[from] BlobError),
}

impl State {
    /// The state of a scene at a time, in ticks of its tracks.
    ///
    /// # Errors
    /// If the camera comes to look nowhere or along the direction that points up, or the tracks are not those of the
    /// scene's blob.
    pub fn at(scene: &Scene<'_>, tracks: &Tracks<'_>, time: i32) -> Result<Self, StateError> {
        let camera = tracks
            .camera_at(time)
            .map_err(|source| StateError::Camera {
                seconds: f64::from(time) / f64::from(tracks.ticks_per_second()),
                source,
            })?;
        let view = camera.map_or(*scene.view(), |camera| camera.view(scene));
        let mut lights = scene.lights().to_vec();
        tracks.lights_at(scene, time, &mut lights)?;
        let mut materials = scene.materials().to_vec();
        tracks.materials_at(scene, time, &mut materials)?;
        Ok(Self {
            view,
            lights,
            materials,
        })
    }

    /// The scene in this state.
    ///
    /// # Errors
    /// If a value is out of its range, which that of a track never is.
    pub fn apply<'a>(&'a self, scene: &Scene<'a>) -> Result<Scene<'a>, BlobError> {
        let scene = scene.with_view(&self.view)?.with_lights(&self.lights)?;
        scene.with_materials(&self.materials)
    }
}

/// The nearest tick to a time in seconds; one out of range is the first or the last.
pub fn ticks(tracks: &Tracks<'_>, seconds: f64) -> i32 {
    // The cast saturates.
    (seconds * f64::from(tracks.ticks_per_second())).round() as i32
}
