//! The scene in flash, and the memory, number format and structure to trace it with.

use gridel_core::{BlobError, Renderer, Rgb888, Scene, Workspace};

include!(concat!(env!("OUT_DIR"), "/limits.rs"));

/// The scene blob.
pub static BLOB: &[u8] = gridel_core::include_blob!(concat!(env!("OUT_DIR"), "/scene.gridel"));

#[cfg(feature = "f32")]
pub type Number = f32;
#[cfg(feature = "f64")]
pub type Number = f64;
#[cfg(feature = "fixed")]
pub type Number = gridel_core::Fixed;

#[cfg(feature = "apex")]
pub type Accel = gridel_core::Apex;
#[cfg(feature = "bvh")]
pub type Accel = gridel_core::Bvh;
#[cfg(feature = "cylinder-cube")]
pub type Accel = gridel_core::CylinderCube;
#[cfg(feature = "cylinder-cube-tight")]
pub type Accel = gridel_core::CylinderCubeTight;
#[cfg(feature = "cylinder-cube-entry")]
pub type Accel = gridel_core::CylinderCubeEntry;
#[cfg(feature = "dual-split")]
pub type Accel = gridel_core::DualSplit;
#[cfg(feature = "flagged")]
pub type Accel = gridel_core::Flagged;
#[cfg(feature = "grid")]
pub type Accel = gridel_core::Grid;
#[cfg(feature = "list")]
pub type Accel = gridel_core::List;

/// The scene of [`BLOB`], proved now.
#[cfg(any(not(feature = "prevalidated"), feature = "instances"))]
pub fn load(blob: &'static [u8]) -> Result<Scene<'static>, BlobError> {
    Scene::from_bytes(blob)
}

/// The scene of [`BLOB`], proved while the program was compiled; a blob with parts cannot be.
#[cfg(all(feature = "prevalidated", not(feature = "instances")))]
pub fn load(_: &'static [u8]) -> Result<Scene<'static>, BlobError> {
    static PREVALIDATED: gridel_core::Prevalidated<'static> =
        match gridel_core::Prevalidated::of(BLOB) {
            Ok(prevalidated) => prevalidated,
            Err(_) => panic!("the blob was damaged"),
        };
    Scene::prevalidated(core::hint::black_box(PREVALIDATED))
}

/// Memory for the views of parts: none where no code places them.
#[cfg(not(feature = "instances"))]
#[derive(Default)]
pub struct PartViews;

#[cfg(not(feature = "instances"))]
impl PartViews {
    pub const fn new() -> Self {
        Self
    }

    /// The scene of [`BLOB`].
    pub fn load(&mut self, blob: &'static [u8]) -> Result<Scene<'_>, BlobError> {
        load(blob)
    }
}

/// Memory for the views of parts.
#[cfg(feature = "instances")]
#[derive(Default)]
pub struct PartViews(gridel_core::Parts<'static, PARTS>);

#[cfg(feature = "instances")]
impl PartViews {
    pub const fn new() -> Self {
        Self(gridel_core::Parts::new())
    }

    /// The scene of [`BLOB`] with its parts, which are proved now in small code, too.
    pub fn load(&mut self, blob: &'static [u8]) -> Result<Scene<'_>, BlobError> {
        self.0.load(blob)?;
        Scene::with_parts(blob, &self.0)
    }
}

/// A workspace that is exactly large enough.
pub type Space = Workspace<Number, STACK_DEPTH, WORK_DEPTH>;
/// The memory of programs that render rows of a picture into files of the host.
pub struct PictureMemory {
    pub space: Space,
    pub row: [Rgb888; WIDTH],
}

impl PictureMemory {
    #[expect(clippy::new_without_default, reason = "it is made at compile time")]
    pub const fn new() -> Self {
        Self {
            space: Space::new(),
            row: [Rgb888([0; 3]); WIDTH],
        }
    }
}

/// The renderer for the scene.
pub type SceneRenderer<'s> = Renderer<'s, 's, Number, Accel, EFFECTS>;
