//! The types of arguments and results.

use core::ffi::c_void;

/// Marks a missing object, primitive or instance: of a ray that hits nothing, and the instance of a hit of the scene's
/// own objects. The header has it from `cbindgen.toml`.
pub const GRIDEL_NONE: u32 = 0xffff_ffff;

/// Words of a `gridel_scene`.
pub const GRIDEL_SCENE_WORDS: usize = 86;

/// Bytes of a stack that is deep enough for every scene.
pub const GRIDEL_STACK_BYTES_MAX: usize = 1928;

/// Bytes of a workspace that is large enough for every scene, in `fixed` and in `f32`.
pub const GRIDEL_WORKSPACE_BYTES_MAX: usize = 5120;

/// Bytes of a workspace that is large enough for every scene, in `f64`.
pub const GRIDEL_WORKSPACE_BYTES_MAX_F64: usize = 7680;

/// A scene: memory of the caller that `gridel_load` fills in. It refers to the blob, which stays where it is. It can be
/// moved and copied.
#[repr(C)]
pub struct gridel_scene {
    /// Reserved for the library.
    pub(crate) memory: [usize; GRIDEL_SCENE_WORDS],
}

/// Memory of the caller.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_buffer {
    /// The first byte.
    pub memory: *mut c_void,
    /// Its bytes.
    pub bytes: usize,
}

/// The properties and requirements of a scene.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_info {
    /// The origin of `gridel_ray`, in scene units.
    pub coordinate_origin: [f64; 3],
    /// A step of `gridel_ray` is 2 to this power scene units.
    pub coordinate_exponent: i32,
    /// Entries of the stack.
    pub stack_depth: u32,
    /// Objects, in scene-file order.
    pub objects: u32,
    /// Primitives of all objects.
    pub primitives: u32,
}

/// A ray in steps of scene coordinates, without floating point: see `gridel_info`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_ray {
    /// The origin.
    pub position: [i32; 3],
    /// Its direction, of any length but 0.
    pub direction: [i32; 3],
    /// The least distance of a hit from `position`, in a straight line.
    pub nearest: u64,
    /// The greatest distance; `UINT64_MAX` is endless.
    pub farthest: u64,
}

/// The first hit of a `gridel_ray`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_hit {
    /// The distance from the ray's position, in a straight line, in steps; `UINT64_MAX` if nothing is hit.
    pub distance: u64,
    /// The place that is hit, in steps; one beyond 32 bits is moved to their end.
    pub position: [i32; 3],
    /// The surface's normal, of length 2^30.
    pub normal: [i32; 3],
    /// The object, in scene-file order; `GRIDEL_NONE` if nothing is hit.
    pub object: u32,
    /// The primitive, in scene-file order over all objects.
    pub primitive: u32,
    /// The instance, in scene-file order; `GRIDEL_NONE` for the scene's own objects.
    pub instance: u32,
    /// 1 if the ray came from the side to which the normal points, else 0.
    pub front: u32,
}

/// A ray in scene units, in single precision.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_ray_f32 {
    /// The origin.
    pub origin: [f32; 3],
    /// Its direction, of any length but 0 for which the t of a hit is a number of this type.
    pub direction: [f32; 3],
    /// The least t of a hit, in multiples of the direction.
    pub t_min: f32,
    /// The greatest t, which can be infinite.
    pub t_max: f32,
}

/// The first hit of a `gridel_ray_f32`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_hit_f32 {
    /// The place on the ray, in multiples of the direction; infinite if nothing is hit.
    pub t: f32,
    /// The place that is hit, in scene units.
    pub point: [f32; 3],
    /// The surface's normal, of length 1.
    pub normal: [f32; 3],
    /// The object, in scene-file order; `GRIDEL_NONE` if nothing is hit.
    pub object: u32,
    /// The primitive, in scene-file order over all objects.
    pub primitive: u32,
    /// The instance, in scene-file order; `GRIDEL_NONE` for the scene's own objects.
    pub instance: u32,
    /// 1 if the ray came from the side to which the normal points, else 0.
    pub front: u32,
}

/// A ray in scene units, in double precision.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_ray_f64 {
    /// The origin.
    pub origin: [f64; 3],
    /// Its direction, of any length but 0 for which the t of a hit is a number of this type.
    pub direction: [f64; 3],
    /// The least t of a hit, in multiples of the direction.
    pub t_min: f64,
    /// The greatest t, which can be infinite.
    pub t_max: f64,
}

/// The first hit of a `gridel_ray_f64`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_hit_f64 {
    /// The place on the ray, in multiples of the direction; infinite if nothing is hit.
    pub t: f64,
    /// The place that is hit, in scene units.
    pub point: [f64; 3],
    /// The surface's normal, of length 1.
    pub normal: [f64; 3],
    /// The object, in scene-file order; `GRIDEL_NONE` if nothing is hit.
    pub object: u32,
    /// The primitive, in scene-file order over all objects.
    pub primitive: u32,
    /// The instance, in scene-file order; `GRIDEL_NONE` for the scene's own objects.
    pub instance: u32,
    /// 1 if the ray came from the side to which the normal points, else 0.
    pub front: u32,
}

/// A camera for the scene that it was made for; `gridel_camera_of` gives that of the scene file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_camera {
    /// The eye, in the library's own units.
    pub eye: [i64; 3],
    /// The vector from the eye to the middle of the picture; the three vectors have one scale.
    pub forward: [i32; 3],
    /// The vector from the middle to the right, as long as half of the picture's height.
    pub right: [i32; 3],
    /// The vector from the middle to the upper edge.
    pub up: [i32; 3],
    /// 0.
    pub reserved: u32,
}

/// A camera at one place that looks at another, in steps.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_look {
    /// The place of the camera.
    pub eye: [i32; 3],
    /// The place in the middle of its picture.
    pub target: [i32; 3],
    /// The direction that is upwards in the picture, of any length but 0.
    pub up: [i32; 3],
    /// The angle of the picture's height, in 2^-32 turn: at least 2 and below half a turn.
    pub field_of_view: u32,
}

/// A camera on a circle around a place, for example for a dial.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_circle {
    /// The place in the middle of its picture, in steps.
    pub target: [i32; 3],
    /// The distance of the camera, in steps.
    pub distance: u32,
    /// The angle by which it is turned around the axis that points up, counterclockwise as seen from above, in 2^-32
    /// turn.
    pub azimuth: u32,
    /// The angle by which it is raised, in 2^-32 turn; it can pass over the pole.
    pub elevation: u32,
    /// The angle of the picture's height, in 2^-32 turn: at least 2 and below half a turn.
    pub field_of_view: u32,
    /// The axis that points up: 1 for y, 2 for z.
    pub up_axis: u32,
}

/// A picture's settings; `gridel_picture_of` gives those of the scene file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_picture {
    /// Pixels from left to right.
    pub width: u16,
    /// Pixels from top to bottom.
    pub height: u16,
    /// Samples per pixel, 1 to 4096.
    pub samples: u16,
    /// Maximum number of secondary rays that follow each other, 0 to 32: off mirrors, through glass or alpha, diffuse.
    pub depth: u16,
    /// 1 to dither, else 0.
    pub dither: u16,
    /// A `gridel_pixel_format`.
    pub pixel_format: u16,
}

/// The form of a pixel in memory.
#[repr(u16)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum gridel_pixel_format {
    /// Three bytes: red, green, blue.
    Rgb888 = 0,
    /// 16 bits in the machine's order, aligned: 5 of red, the uppermost, 6 of green, 5 of blue.
    Rgb565 = 1,
}

/// A rectangle of a picture, in pixels from its upper left corner.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct gridel_rectangle {
    /// The first column.
    pub x: u16,
    /// The first row.
    pub y: u16,
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
}
