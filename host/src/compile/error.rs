//! Errors of the compiler.

use crate::scene::{SceneError, SourceSpan};
use glam::DVec3;
use gridel_core::BlobError;
use gridel_core::format::limits::MAX_MEDIA;
use gridel_core::render::CameraError;

/// Errors of the compiler.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum CompileError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    #[error("{object} has a coordinate or a length that is infinite or not a number")]
    NotFinite { object: String },
    #[error("{object} names {lost} that the scene does not have")]
    #[diagnostic(help(
        "number materials, and corners of triangles, within the scene's and the mesh's lists"
    ))]
    Reference { object: String, lost: &'static str },
    #[error("the scene's size is {size:e}, which no lattice can hold")]
    #[diagnostic(help("scale the scene to a size between 1e-250 and 1e250"))]
    Extent { size: f64 },
    #[error(
        "the scene lies at ({:e}, {:e}, {:e}) and is only {size:e} large; with a lattice as fine as that it \
         must lie within {most:.1e} of the origin on each axis",
        .middle.x, .middle.y, .middle.z
    )]
    #[diagnostic(help("move the scene nearer to the origin, or use fewer `--lattice-bits`"))]
    TooFar { middle: DVec3, size: f64, most: f64 },
    #[error(
        "{object}: the closed mesh lies in one plane on the lattice, whose step is {step:e}, so it has \
         no inside left"
    )]
    #[diagnostic(help(
        "use more `--lattice-bits`, scale the mesh up across that plane, or put it into a scene of its \
         own"
    ))]
    Flattened { object: String, step: f64 },
    #[error(
        "{collapsed} triangles collapse on the lattice; cutting their neighbors, so that meshes stay \
         closed, makes {pieces} primitives, more than the {most} that the file has"
    )]
    #[diagnostic(help(
        "use more `--lattice-bits`, of which there are at most 24, scale the mesh less unevenly, or leave out what is too \
         small to be seen"
    ))]
    Slivers {
        collapsed: usize,
        pieces: usize,
        most: usize,
    },
    #[error("the morph target {target} has a weight at rest, or a range of weights, beyond ±64")]
    #[diagnostic(help("use smaller weights, and larger displacements"))]
    Weight { target: String },
    #[error("the morph target {target} displaces a vertex by more than {most:.3e} scene units")]
    #[diagnostic(help("use smaller displacements, and larger weights"))]
    Displacement { target: String, most: f64 },
    #[error("{object} has texture coordinates of {most} repetitions of its texture or more")]
    #[diagnostic(help(
        "move the coordinates towards 0, or let the texture's `scale` make them smaller"
    ))]
    TextureCoordinates { object: String, most: f64 },
    #[error("the smallest form of the textures takes {bytes} bytes, and the budget is {most}")]
    #[diagnostic(help("allow more `--texture-bytes`, or remove textures"))]
    TextureBytes { bytes: u64, most: u64 },
    #[error("{object} is more than {most:.3e} scene units from the middle of the other objects")]
    #[diagnostic(help("move it nearer, or add an object beside it"))]
    OutOfReach { object: String, most: f64 },
    #[error(
        "the camera's eye is more than {reach:.3e} scene units from ({}, {}, {}) along an axis, where the \
         blob's coordinates end",
        .from.x, .from.y, .from.z
    )]
    #[diagnostic(help("move the eye nearer, or give the scene file in place of the blob"))]
    EyeOutOfReach { reach: f64, from: DVec3 },
    #[error("{source}")]
    #[diagnostic(help("change the camera's `eye`, `target`, `up` or `fov`"))]
    Camera { source: CameraError },
    #[error(
        "{material}: a plane's checkerboard has cells larger than {most:.3e}, 4 times the scene"
    )]
    #[diagnostic(help("make the cells smaller, or give the plane one color"))]
    CheckerSize { material: String, most: f64 },
    #[error("{count} materials have a priority, more than the {MAX_MEDIA} that a blob can hold")]
    #[diagnostic(help("remove `priority` from glass that touches no other glass"))]
    Media { count: usize },
    #[error(
        "{light}: its {what} of {length:.3e} scene units is more than {most:.3e}, which the scene's lattice holds"
    )]
    #[diagnostic(help("make it smaller, or make the scene larger"))]
    LightForm {
        light: String,
        what: &'static str,
        length: f64,
        most: f64,
    },
    #[error(
        "{light} is {times:.3e} times too bright: it would light a scene of this size beyond all limits"
    )]
    #[diagnostic(help("make it less bright, lower `exposure`, or make the scene larger"))]
    LightTooBright { light: String, times: f64 },
    #[error("the {what} has a channel of {value:.4e}; it must be at most {most}")]
    #[diagnostic(help("make the light darker, or lower `exposure`"))]
    TooBright { what: String, value: f64, most: f64 },
    #[error("tone mapping is for linear colors, and those of the scene are display values")]
    #[diagnostic(help(
        "leave `--tone-mapping` out, or write the scene as TOML with linear colors"
    ))]
    ToneMapping,
    #[error("{place}: track of {target}: {cause}")]
    #[diagnostic(help("{remedy}"))]
    Track {
        place: SourceSpan,
        target: String,
        cause: String,
        remedy: String,
    },
    #[error("{bits} lattice bits are not possible")]
    #[diagnostic(help("use 10 to 24"))]
    LatticeBits { bits: u8 },
    #[error("a room of {room} scene units is not possible")]
    #[diagnostic(help("use a number of at least 0 for how far vertices can move"))]
    Room { room: f64 },
    #[error("the scene has {count} {what}, more than the {most} that a blob can hold")]
    #[diagnostic(help("split the scene into several blobs"))]
    TooMany {
        what: &'static str,
        count: usize,
        most: usize,
    },
    #[error("the scene has {count} {what}, more than the {most} that a blob can hold")]
    #[diagnostic(help(
        "copy the instances with `--instances flatten`, or split the scene into several blobs"
    ))]
    TooManyPlaced {
        what: &'static str,
        count: usize,
        most: usize,
    },
    #[error(
        "the {what} lies {distance:.3e} scene units from a scene of {size:.3e}: too far for the number formats"
    )]
    #[diagnostic(help("{remedy}"))]
    FarAway {
        what: String,
        distance: f64,
        size: f64,
        remedy: &'static str,
    },
    #[error(
        "the `{what}` of the camera is {found:.3e} scene units; at most {most:.3e} are possible"
    )]
    #[diagnostic(help("write a smaller `{what}` in `[camera]`"))]
    Lens {
        what: &'static str,
        found: f64,
        most: f64,
    },
    #[error(
        "the table of {structure}{size} takes {at_least}{needed} bytes, more than its budget of \
         {budget}"
    )]
    #[diagnostic(help("{remedy}"))]
    OverBudget {
        structure: &'static str,
        /// Such as ` with 4 gridels per side` or ` with 8 by 8 by 2 cells`.
        size: String,
        needed: u64,
        /// `at least ` where the whole was not counted.
        at_least: &'static str,
        budget: u64,
        remedy: &'static str,
    },
    #[error(
        "building the table of {structure}{size} takes up to {needed} bytes of memory, more than {most}"
    )]
    #[diagnostic(help(
        "ask for fewer gridels with `--gridels`, or raise `--budget` to {needed} if the machine has as much memory"
    ))]
    OverMemory {
        structure: &'static str,
        /// Such as ` with 64 gridels per side`.
        size: String,
        needed: u64,
        most: u64,
    },
    #[error(
        "the instance {instance} names a part or a joint that the scene does not have, or is not placed by finite \
         numbers"
    )]
    #[diagnostic(help("place it by a rotation of length 1, a scale above 0 and a translation"))]
    Instance { instance: String },
    #[error("the joint {name} {cause}")]
    #[diagnostic(help("{remedy}"))]
    Joint {
        name: String,
        cause: String,
        remedy: &'static str,
    },
    #[error("{object} has no box, so it cannot be in the part {part}, whose instances have one")]
    #[diagnostic(help("make it an object of the scene itself"))]
    UnboundedPart { object: String, part: String },
    #[error(
        "the instance {instance} has a scale of {scale:.1e}, too small for the scene's lattice, which is {size:.1e} wide \
         to hold all that moves and its `room`"
    )]
    #[diagnostic(help(
        "use a scale of at least {least:.1e}, or bring nearer what is far away: an object, another instance, a track \
         or the `room`"
    ))]
    SmallInstance {
        instance: String,
        size: f64,
        scale: f64,
        least: f64,
    },
    #[error(
        "the joints of the instance {instance} shrink it to {shrinks:.1e} of its size at rest, too small for the scene"
    )]
    #[diagnostic(help(
        "give their tracks of `scale` values whose product is at least {least:.1e}, bring nearer what is far away, or \
         use `--instances flatten`"
    ))]
    ShrinkingInstance {
        instance: String,
        shrinks: f64,
        least: f64,
    },
    #[error("the instance {instance} has a scale of {scale:e}, which no lattice can hold")]
    #[diagnostic(help("use a scale of at least {least:e}"))]
    TinyInstance {
        instance: String,
        scale: f64,
        least: f64,
    },
    #[error("the instance {instance} {cause}")]
    #[diagnostic(help(
        "keep the scales of tracks smaller, and the objects of the part near the part's origin"
    ))]
    LargeInstance {
        instance: String,
        cause: &'static str,
    },
    #[error("the part {part}: {source}")]
    #[diagnostic(help("move its objects nearer to the part's origin"))]
    FarPart {
        part: String,
        #[source]
        source: Box<CompileError>,
    },
    #[error("the compiled blob is invalid: {0}")]
    #[diagnostic(help("this is a fault of gridel: report it with the scene file"))]
    Blob(#[from] BlobError),
    #[error("the blob would have {bytes} bytes, {over} more than --max-bytes allows")]
    #[diagnostic(help("{advice}"))]
    TooLarge {
        bytes: u64,
        over: u64,
        advice: String,
    },
}
