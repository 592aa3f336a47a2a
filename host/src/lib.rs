//! The host side of Gridel: scene files to blobs, blobs to pictures and hits.
//!
//! | to do | look in |
//! |---|---|
//! | read a scene file, of any format | [`scene`] |
//! | make a sample scene | [`sample`] |
//! | compile a scene into a blob | [`compile`] |
//! | hold a blob and check it | [`blob`] |
//! | hold scenes to recorded pictures and to budgets | [`check`] |
//! | measure errors, rays, time and bytes | [`measure`] |
//! | know the boards that blobs are for | [`measure::board`] |
//! | write a blob as a Rust module | [`emit`] |
//! | render a blob on all cores | [`render`], then [`picture`] to encode what comes out |
//! | change the camera and the lights of a blob | [`scene::Camera::in_blob`], [`scene::Light::in_blob`] |
//! | know a scene at a time of its tracks | [`state`] |
//! | move the vertices of a mesh | [`deformation`], [`morphed`] |
//! | compare structures on a scene | [`compare`] |
//! | put parts of a picture together, and pictures into an animation | [`merge`], [`animation`] |
//! | trace rays of the caller | [`trace`], and [`npy`] for NumPy's files |
//! | explain a ray or a pixel | [`explain`] |
//! | view a scene live, from coarse to fine | [`view`] |
//! | measure what accuracy costs in time | [`accuracy`] |
//! | hold a scene to what is promised | [`verify`] |
//! | enclose the exact picture | [`certify`] |
//! | draw charts and heat maps | [`report`] |
//! | know a shape, on the lattice and exactly | [`shape`] |
//! | find objects that a number format cannot resolve | [`resolution`] |
//!
//! The program `gridel` is a thin layer over this library: everything that it does can be done from here.
//!
//! ```
//! use gridel_core::{Format, Settings, Structure};
//! use gridel_host::compile::{Options, compile};
//! use gridel_host::render::{Job, render};
//! use gridel_host::scene::read;
//!
//! let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1";
//! let imported = read("ball.toml".as_ref(), file.into(), &Default::default())?;
//! let blob = compile(&imported.scene, &Options::default())?.blob;
//! let scene = blob.scene()?;
//! let settings = Settings {
//!     width: 16,
//!     height: 12,
//!     ..Settings::of(&scene)
//! };
//! let job = Job::whole(Format::F32, Structure::DualSplit, settings);
//! let picture = render(&scene, &job, &|| ())?;
//! assert_eq!(picture.pixels.len(), 16 * 12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
pub mod accuracy;
pub mod animation;
pub mod blob;
mod blob_view;
pub mod certify;
pub mod check;
pub mod compare;
pub mod compile;
pub mod deformation;
pub mod emit;
pub mod explain;
mod explained;
pub mod layer;
pub mod measure;
pub mod merge;
pub mod morphed;
pub mod npy;
mod observed;
pub mod openexr;
#[doc(hidden)]
pub mod output;
mod palette;
pub mod picture;
pub mod picture_rays;
#[doc(hidden)]
pub mod random;
pub mod render;
pub mod report;
pub mod resolution;
pub mod sample;
pub mod scene;
pub mod shape;
#[doc(hidden)]
pub mod simd;
pub mod srgb;
pub mod state;
#[doc(hidden)]
pub mod table;
pub mod trace;
pub mod verify;
pub mod view;

pub use explained::explained;
