//! Requests.

use crate::problem::Problem;
use gridel_core::{Effects, Format, Structure};
use gridel_host::scene::{Camera, effect_named};
use serde::{Deserialize, Deserializer, de::Error};

/// A request of a page; `bytes` is what comes with it.
#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case")]
pub enum Request {
    /// Returns the choices.
    About,
    /// Forgets all files.
    ClearFiles,
    /// Keeps a file; `bytes` is its content.
    AddFile { path: String },
    /// Compiles a scene of the files. The answer is the blob.
    Compile(Compile),
    /// Loads the blob `bytes` into a place; `name` is that of a file, which errors name.
    Load { slot: usize, name: Option<String> },
    /// Moves the camera.
    Move(Move),
    /// Begins a picture.
    Begin(Begin),
    /// Draws so many more of its pixels. The answer has four words of 32 bits per pixel. They are column and row; color
    /// as 0x00BBGGRR, or work; linear red and green; linear blue and the block's width and height.
    Step { blocks: usize },
    /// Compares two linear pictures, the first being the reference.
    Errors,
    /// Shows how two linear pictures differ, eight times enlarged, as sRGB.
    Difference,
    /// The colors of a heat map, for the work of all pixels.
    HeatMap,
    /// Explains a pixel. Names come from the scene file, if one was compiled.
    Explain {
        shot: ShotOf,
        pixel: [u16; 2],
        compile: Option<Compile>,
    },
    /// The memory report of a board.
    Memory(Memory),
    /// The picture of linear pixels as a PNG file.
    Png { width: u16, height: u16 },
}

/// Options for compiling a scene.
#[derive(Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Compile {
    pub name: String,
    pub structure: StructureName,
    pub lattice_bits: u8,
    /// Effects that are left out.
    #[serde(default)]
    pub without: Vec<EffectName>,
}

/// A scene on a board.
#[derive(Deserialize)]
pub struct Memory {
    pub board: String,
    pub format: Option<FormatName>,
    /// The chosen structure; another replaces it if it was not measured on boards.
    pub structure: StructureName,
    /// Options for compiling the scene for it; without them it is the blob of the picture.
    pub compile: Option<Compile>,
}

/// A motion of the camera.
#[derive(Deserialize)]
pub struct Move {
    pub slot: usize,
    /// The camera now; the scene's own without one.
    pub camera: Option<CameraOf>,
    /// Radians to the right and up.
    #[serde(default)]
    pub orbit: [f64; 2],
    /// Heights of the picture to the right and up.
    #[serde(default)]
    pub pan: [f64; 2],
    /// Steps nearer.
    #[serde(default)]
    pub zoom: f64,
}

/// A share of a picture.
#[derive(Deserialize)]
pub struct Begin {
    pub shot: ShotOf,
    /// The number of this worker, and the number of workers.
    pub share: [usize; 2],
}

/// A picture to draw.
#[derive(Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ShotOf {
    pub slot: usize,
    pub camera: Option<CameraOf>,
    pub format: FormatName,
    pub structure: StructureName,
    pub width: u16,
    pub height: u16,
    pub samples: u16,
    pub depth: u8,
    #[serde(default)]
    pub heat_map: bool,
}

/// Eye, target, up, and the field of view in degrees.
#[derive(Clone, Copy, Deserialize)]
pub struct CameraOf([f64; 10]);

impl From<CameraOf> for Camera {
    fn from(CameraOf([ex, ey, ez, tx, ty, tz, ux, uy, uz, fov_degrees]): CameraOf) -> Self {
        Self {
            eye: [ex, ey, ez].into(),
            target: [tx, ty, tz].into(),
            up: [ux, uy, uz].into(),
            fov_degrees,
        }
    }
}

/// A number format by its name.
#[derive(Clone, Copy)]
pub struct FormatName(pub Format);

impl<'de> Deserialize<'de> for FormatName {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let name = String::deserialize(from)?;
        let found = Format::from_name(&name);
        let unknown = || D::Error::custom(format!("there is no number format `{name}`"));
        found.map(Self).ok_or_else(unknown)
    }
}

/// An effect by its name.
#[derive(Clone, Copy)]
pub struct EffectName(pub Effects);

impl<'de> Deserialize<'de> for EffectName {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let name = String::deserialize(from)?;
        let found = effect_named(&name);
        let unknown = || D::Error::custom(format!("there is no effect `{name}`"));
        found.map(Self).ok_or_else(unknown)
    }
}

/// A structure by its name.
#[derive(Clone, Copy)]
pub struct StructureName(pub Structure);

impl<'de> Deserialize<'de> for StructureName {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let name = String::deserialize(from)?;
        let found = Structure::from_name(&name);
        let unknown = || D::Error::custom(format!("there is no structure `{name}`"));
        found.map(Self).ok_or_else(unknown)
    }
}

/// A request and its bytes.
pub fn split(input: &[u8]) -> Result<(Request, &[u8]), Problem> {
    let short = || Problem::fault("the request ends before its text");
    let (length, rest) = input.split_first_chunk().ok_or_else(short)?;
    let length = u32::from_le_bytes(*length) as usize;
    let (json, bytes) = rest.split_at_checked(length).ok_or_else(short)?;
    let request = serde_json::from_slice(json).map_err(Problem::fault)?;
    Ok((request, bytes))
}
