//! Options that several commands have, and how their values are written.
//!
//! | file | what it holds |
//! |---|---|
//! | `scene.rs` | how a scene file is read and compiled |
//! | `view.rs` | from where a scene is seen |
//! | `light.rs` | changes of lights |
//! | `structures.rs` | how structures are built |
//! | `target.rs` | boards and their memory |
//! | `values.rs` | names, sizes, ranges and vectors |

mod light;
mod scene;
mod structures;
mod target;
mod values;
mod view;

pub use light::LightChange;
pub use scene::{
    GeometryOptions, ImportOptions, SceneOptions, TargetPoint, scene_help, scene_long_help,
};
pub use structures::{StructureOptions, check_hierarchy, check_quality, check_room};
pub use target::TargetOptions;
pub use values::{
    aov, builder, bytes, cutoff, distinct, distinct_or, format, frames, number, open_seconds,
    quoted, rows, seconds, size, structure, threads,
};

use clap::Args;
use gridel_core::format::limits::{MAX_RAY_DEPTH, MAX_SAMPLES};
use gridel_core::{Format, Scene, Settings, Structure};
use gridel_host::compile::Quality;
use values::first_given;

/// Options of tracing.
#[derive(Args, Clone, Debug)]
pub struct TraceOptions {
    /// Number format
    #[arg(long, value_name = "NAME", value_parser = format(), default_value = "f32")]
    pub format: Format,

    /// Acceleration structure [default: the best that the blob holds; for a scene file, render and
    /// trace build wide, view builds wide, flagged and bvh, and explain builds dual-split]
    #[arg(long, value_name = "NAME", value_parser = structure())]
    pub accel: Option<Structure>,

    /// Time to spend on building wide, for a scene file [default: good]
    #[arg(long, value_name = "NAME")]
    pub quality: Option<Quality>,
}

/// Options of pictures that replace the scene's settings.
#[derive(Args, Clone, Debug)]
pub struct PictureOptions {
    /// Size of the whole picture, such as 640x480 [default: that of the scene]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u16; 2]>,

    /// Samples per pixel, 1 to 4096 [default: that of the scene]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=i64::from(MAX_SAMPLES))
    )]
    samples: Option<u16>,

    /// Reflections and refractions of a ray, and its bounces of indirect light, 0 to 32 [default:
    /// that of the scene]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u8).range(0..=MAX_RAY_DEPTH as i64)
    )]
    depth: Option<u8>,
}

impl PictureOptions {
    /// Returns the name of an option that has no effect on a ray of the user's own, if one was given.
    pub fn of_pixels(&self) -> Option<&'static str> {
        first_given([
            (self.size.is_some(), "--size"),
            (self.samples.is_some(), "--samples"),
        ])
    }

    /// Returns the settings for a scene's picture, without dither.
    pub fn settings(&self, scene: &Scene<'_>) -> Settings {
        let stated = Settings::of(scene);
        let [width, height] = self.size.unwrap_or([stated.width, stated.height]);
        Settings {
            width,
            height,
            samples: self.samples.unwrap_or(stated.samples),
            depth: self.depth.unwrap_or(stated.depth),
            dither: false,
        }
    }
}
