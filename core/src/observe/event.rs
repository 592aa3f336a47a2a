//! Events of rays, reported to an [`Observer::event`].
//!
//! Events come from the code that traces and renders, in the order of its work. Points, lengths and t are in units (see
//! [`Number`](crate::accel::Number)), t along the ray's major axis. Colors are linear, and 1 is display white. All are
//! the exact values of the number format.
//!
//! [`Observer::event`]: crate::Observer::event

use crate::format::Kind;

/// The purpose of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// A ray from the camera.
    Primary,
    /// A ray towards a light.
    Shadow,
    /// A ray off a mirror, or off glass.
    Reflected,
    /// A ray into glass or out of it.
    Refracted,
    /// A ray off a surface in a random direction.
    Diffuse,
    /// Off a rough mirror or rough glass, and from there through glass. The lights that it can hit were already
    /// reflected at the rough surface.
    Glossy,
    /// Off a rough mirror or rough glass with a roughness below 0.3, and from there through glass, where the sun of the
    /// environment is brighter than a blob holds. The sun was already reflected at the rough surface.
    Polished,
}

/// An event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The ray loop starts with a ray: one from the camera, or the last of those that were [sent] and are still
    /// waiting.
    ///
    /// [sent]: Event::Sent
    RayStarted {
        /// The purpose of the ray.
        kind: RayKind,
        /// Number of secondary rays that led to it, of which it is the last; 0 from the camera.
        depth: u8,
        /// The factor of its radiance.
        weight: [f64; 3],
    },
    /// The ray from the camera starts from a point of the lens.
    Lens {
        /// The point, in units.
        point: [f64; 3],
    },
    /// A query of a structure starts.
    Query {
        /// The start of the ray inside the kernels: its own origin, or where it reaches the scene's box. For a ray that
        /// passes the scene so far away that it has no start, its own origin.
        origin: [f64; 3],
        /// Its direction; the largest component is 1 or -1.
        slope: [f64; 3],
        /// The t of `origin` as the caller counts it.
        start_t: f64,
        /// The interval of the query, from `origin`. It is empty if the ray misses the scene.
        interval: [f64; 2],
        /// The interval in which hits of shapes without bounds count, from `origin`. It is empty in builds without them.
        far_interval: [f64; 2],
        /// True if any hit will do.
        any: bool,
    },
    /// A node or a cell is tested: the ray can hit its content if `span` is not empty.
    Tested {
        /// The node or cell.
        node: NodeId,
        /// The planes that were tested for it. `None` for a plane that was not, because it coincides with a plane
        /// around it, or is not worth a test.
        sides: Sides,
        /// The interval of the ray in it, from the query's origin; empty if the first number is greater.
        span: [f64; 2],
    },
    /// The node that was just tested is empty: the ray does not enter it.
    Empty(NodeId),
    /// A waiting node is dropped, because a hit was found before it.
    NodeSkipped {
        /// The node.
        node: NodeId,
        /// The distance at which the ray would enter it.
        enters: f64,
    },
    /// The ray goes into a node, a leaf or a cell.
    Opened(NodeId),
    /// The ray goes into an instance. Until [`InstanceLeft`](Event::InstanceLeft) events are those of its part: nodes
    /// and primitives are numbered in the part, and lengths and t are in the part's units.
    InstanceEntered {
        /// Its place among the scene's [instances](crate::Scene::instances).
        index: u32,
        /// The number of the part's first primitive among all of the scene.
        first_primitive: u32,
        /// The start of the mapped ray inside the kernels.
        origin: [f64; 3],
        /// Its direction; the largest component is 1 or -1.
        slope: [f64; 3],
        /// The interval of the query, from `origin`.
        interval: [f64; 2],
        /// The t of `origin`, counted from the query's origin, in the part's units.
        start_t: f64,
        /// The factor from t in the part to t in the scene.
        scale: f64,
    },
    /// The ray leaves the instance that it entered last.
    InstanceLeft {
        /// True if the nearest hit so far is in the instance.
        nearest: bool,
    },
    /// A primitive is tested.
    Candidate {
        /// Its kind.
        kind: Kind,
        /// Its number in scene-file order; in an instance, among the primitives of its part.
        primitive: u32,
        /// The places where the line of the ray enters and leaves it, from the query's origin. `None` if the ray does
        /// not hit it, or if it certainly lies behind the origin.
        crossing: Option<[f64; 2]>,
        /// True for the nearest hit so far.
        nearest: bool,
    },
    /// The answer of a query for any hit.
    Any(bool),
    /// The answer of a query for the nearest hit.
    Nearest(Option<QueryHit>),
    /// A light is considered at the hit.
    Light {
        /// Its number.
        number: u32,
        /// The cosine of the angle under which it shines on the surface; at or below 0 the surface faces away.
        cosine: f64,
    },
    /// The surface that was hit is shaded with a smooth normal.
    Smooth {
        /// The normal, of length 1, on the side from which the ray came.
        normal: [f64; 3],
    },
    /// The surface that was hit is shaded with the normal of a normal map.
    NormalMapped {
        /// The nearest texel, or the upper left one of the four that are mixed.
        texel: [u32; 2],
        /// The normal, of length 1, on the side from which the ray came.
        normal: [f64; 3],
    },
    /// The diffuse color of the surface that was hit is weighted by the colors of its vertices.
    VertexColor {
        /// The interpolated color: linear ratios.
        color: [f64; 3],
    },
    /// The diffuse color of the surface that was hit is weighted by that of a texture.
    Textured {
        /// The place in the texture, u to the right and v down.
        coordinates: [f64; 2],
        /// The number of times that the image is halved for this look-up; a fraction lies between two of its levels.
        level: f64,
        /// The nearest texel of the finer level, counted from the upper left one, or the upper left one of the four
        /// that are mixed.
        texel: [u32; 2],
        /// The texture's color: linear ratios.
        color: [f64; 3],
    },
    /// The surface that was hit belongs to a medium with a priority. Where both media are the same, a medium with a
    /// higher priority is around it, and the ray goes straight on.
    Boundary {
        /// The materials of the media on the near side and on the far side; `None` for the surroundings.
        media: [Option<u32>; 2],
    },
    /// The surface that was hit is partly transparent; the rest of the ray goes straight on.
    Alpha {
        /// The opaque part, 0 to 1.
        alpha: f64,
    },
    /// The light that was just considered, which the smooth normal faces, lies behind the triangle, and does not
    /// reach it.
    BehindTriangle,
    /// The light that was just considered has an area, and shines from a point of it.
    FromArea {
        /// The point, in units.
        point: [f64; 3],
    },
    /// The light that was just considered is the environment or the sun in it, and shines from a direction.
    FromEnvironment {
        /// The direction, of length 1.
        direction: [f64; 3],
        /// The place of the texel in the map, column and row; `None` for the sun.
        texel: Option<[u32; 2]>,
    },
    /// The ray hit nothing and brings the light of the environment.
    Environment {
        /// The place of the nearest texel in the map, column and row.
        texel: [u32; 2],
        /// True if the sun is there.
        sun: bool,
    },
    /// The light that was just considered does not shine in this direction, or not this far.
    Outside,
    /// The light that was just considered falls off with distance or angle.
    Fallen {
        /// The radiance that arrives, after shadows.
        arriving: [f64; 3],
    },
    /// The surface that was hit reflects ambient light.
    Ambient {
        /// The radiance that it reflects.
        radiance: [f64; 3],
    },
    /// The surface was hit by a diffuse or a glossy ray. It emits light that is already counted as light of its lights.
    EmittedByLight,
    /// The surface that was hit emits light.
    Emitted {
        /// Its radiance.
        radiance: [f64; 3],
    },
    /// Light for a shadow passes the glass that was just hit.
    Filtered {
        /// The part of it that remains.
        left: [f64; 3],
    },
    /// The radiance that a light adds to a surface, without the ray's weight.
    Lit {
        /// Its number.
        number: u32,
        /// Its diffuse part and its highlight.
        radiance: [f64; 3],
    },
    /// The ray passed glass that absorbed light on the way; or light for a shadow did, on the last part of its way.
    Absorbed {
        /// The part of the ray's weight, or of the light, that remains.
        weight: [f64; 3],
    },
    /// Radiance is added to the sample, with its weight.
    Added {
        /// The reason.
        source: Source,
        /// The radiance.
        radiance: [f64; 3],
    },
    /// A facet of a rough surface is drawn, at which the ray is mirrored and refracted.
    Facet {
        /// Its normal, of length 1, on the side from which the ray came.
        normal: [f64; 3],
    },
    /// Glass splits a ray.
    Split {
        /// The part that is reflected; 1 is total reflection.
        reflected: f64,
    },
    /// A ray is put on the work list.
    Sent {
        /// The purpose of the ray.
        kind: RayKind,
        /// The factor of its radiance.
        weight: [f64; 3],
    },
    /// A ray is not cast, because its effect would be too small.
    Dropped {
        /// The purpose that the ray would have had.
        kind: RayKind,
        /// The factor that its radiance would have had.
        weight: [f64; 3],
    },
    /// A ray at the largest depth hits a surface that could send others. They stay black.
    TooDeep,
    /// A sample is complete.
    SampleFinished {
        /// Its place in 1/256 pixel from the left and from the top of the picture; `None` for a ray
        /// of the caller's own.
        at: Option<[i32; 2]>,
        /// Its radiance, each channel limited to 0 to 1. The limit is 16 where effects act on the mean of samples, or
        /// need it to be right, and 4 with lights that have an area.
        radiance: [f64; 3],
    },
}

/// A node, a leaf or a cell: its name in the structure, and its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NodeId {
    /// Such as `pair` or `leaf`.
    pub what: &'static str,
    /// Counted from 0.
    pub number: u32,
}

impl NodeId {
    /// The name of the leaves of the hierarchy above instances.
    pub const INSTANCE: &'static str = "instance";
    /// The name of its other nodes.
    pub const INSTANCE_PAIR: &'static str = "pair of instances";
}

/// Planes of a box that were tested, in units: `[axis][lower, upper]`.
pub type Sides = [[Option<i16>; 2]; 3];

/// The reason why radiance is added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The ray hit nothing and brings the background.
    Background,
    /// A surface under ambient light and lights.
    Surface,
}

/// The result of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QueryHit {
    /// The t as the caller counts it.
    pub t: f64,
    /// The point.
    pub point: [f64; 3],
    /// The normal, of length 1.
    pub normal: [f64; 3],
    /// True if the ray came from the side to which the normal points.
    pub front: bool,
    /// The object.
    pub object: u32,
    /// The primitive.
    pub primitive: u32,
    /// The place of its instance among the scene's [instances](crate::Scene::instances).
    pub instance: Option<u32>,
    /// The surface lies within this length of the point, along the normal.
    pub error: f64,
}
