//! Events of rays, reported to an [`Observer::event`].
//!
//! Events come from the very code that traces and renders, in the order in which it works. Points,
//! lengths and t are in units (see [`Number`](crate::accel::Number)), t along the ray's major axis; colors
//! are linear, 1 being display white. All are exactly what the number format holds.
//!
//! [`Observer::event`]: crate::Observer::event

use crate::format::Kind;

/// The purpose of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the camera.
    Primary,
    /// Towards a light.
    Shadow,
    /// Off a mirror, or off glass.
    Reflected,
    /// Into glass or out of it.
    Refracted,
    /// Off a surface in a random direction.
    Diffuse,
    /// Off a rough mirror or rough glass, and from there through glass: the lights that it may meet were reflected where
    /// it was sent.
    Glossy,
}

/// Something that happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The ray loop takes up a ray: one from the camera, or the last of those that were [sent] and
    /// not yet taken up.
    ///
    /// [sent]: Event::Sent
    RayStarted {
        /// The purpose of the ray.
        kind: RayKind,
        /// How many reflections and refractions led to it.
        depth: u8,
        /// The factor of its radiance.
        weight: [f64; 3],
    },
    /// The ray from the camera starts from a point of the lens.
    Lens {
        /// The point, in units.
        point: [f64; 3],
    },
    /// A structure is asked what a ray meets.
    Query {
        /// Where the ray starts inside of the kernels: its own origin, or where it comes to the
        /// scene's box.
        origin: [f64; 3],
        /// Its direction; the largest component is 1 or -1.
        slope: [f64; 3],
        /// The t of `origin` as the caller counts it.
        start_t: f64,
        /// The interval that counts, from `origin`. It is empty where the scene cannot be met.
        interval: [f64; 2],
        /// True if any hit will do.
        any: bool,
    },
    /// A node or a cell is tested: the ray can meet what is in it if `span` is not empty.
    Tested {
        /// The part that is tested.
        place: NodeId,
        /// The planes that were tested for it. `None` for one that was not, because it coincides
        /// with a plane around it, or is not worth it.
        sides: Sides,
        /// From where to where the ray is in it, from the query's origin; empty if the first is
        /// greater.
        span: [f64; 2],
    },
    /// The node that was just tested is empty: the ray does not enter it.
    Empty(NodeId),
    /// A node that was put off is given up, because a hit was found before it.
    NodeSkipped {
        /// The part that is given up.
        place: NodeId,
        /// Where the ray would enter it.
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
        /// Where the mapped ray starts inside of the kernels.
        origin: [f64; 3],
        /// Its direction; the largest component is 1 or -1.
        slope: [f64; 3],
        /// The interval that counts, from `origin`.
        interval: [f64; 2],
        /// The t of `origin`, counted from the query's origin, in the part's units.
        start_t: f64,
        /// What t in the part is multiplied with for t in the scene.
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
        /// Where the line of the ray enters and leaves it, from the query's origin; `None` if it
        /// does not meet it, or was seen to meet it behind the origin before that was computed.
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
        /// The cosine of the angle under which it shines on the surface; at or below 0 the surface
        /// is turned away.
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
        /// Where the texture is looked up, u to the right and v down.
        coordinates: [f64; 2],
        /// How often the image is halved to what is looked up; a fraction lies between two of its levels.
        level: f64,
        /// The nearest texel of the finer level, counted from the upper left one, or the upper left one of the four that
        /// are mixed.
        texel: [u32; 2],
        /// The texture's color: linear ratios.
        color: [f64; 3],
    },
    /// The surface that was hit is that of a medium with a priority. Where both media are the same, a medium with a higher
    /// priority is around it, and the ray goes straight on.
    Boundary {
        /// The materials of the media on the near side and on the far side; `None` for the surroundings.
        media: [Option<u32>; 2],
    },
    /// The surface that was hit is there in part; the rest of the ray goes straight on.
    Alpha {
        /// How much of it is there, 0 to 1.
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
    /// The ray met nothing and brings the light of the environment.
    Environment {
        /// The place of the nearest texel in the map, column and row.
        texel: [u32; 2],
        /// True if the sun is there.
        sun: bool,
    },
    /// The light that was just considered does not shine in this direction, or not so far.
    Outside,
    /// The light that was just considered falls off with distance or angle.
    Fallen {
        /// The radiance that arrives, after shadows.
        arriving: [f64; 3],
    },
    /// The surface that was hit, by a diffuse or a glossy ray, sends out light that its lights have brought already.
    EmittedByLight,
    /// The surface that was hit sends out light of its own.
    Emitted {
        /// Its radiance.
        radiance: [f64; 3],
    },
    /// Light for a shadow comes through the glass that was just met.
    Filtered {
        /// The part of it that is left.
        left: [f64; 3],
    },
    /// The radiance that a light adds to a surface, without the ray's weight.
    Lit {
        /// Its number.
        number: u32,
        /// Its diffuse part and its highlight.
        radiance: [f64; 3],
    },
    /// The ray came through glass that took up light on the way.
    Absorbed {
        /// The part of the ray's weight that is left.
        weight: [f64; 3],
    },
    /// Radiance is added to the sample, its weight included.
    Added {
        /// Why.
        source: Source,
        /// How much.
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
    /// A ray is not cast, because it could change too little.
    Dropped {
        /// The purpose that the ray would have had.
        kind: RayKind,
        /// The factor that its radiance would have had.
        weight: [f64; 3],
    },
    /// A ray meets a mirror or glass at the largest depth. Its reflection or refraction stays black.
    TooDeep,
    /// A sample is done.
    SampleFinished {
        /// Its place in 1/256 pixel from the left and from the top of the picture; `None` for a ray
        /// of the caller's own.
        place: Option<[i32; 2]>,
        /// Its radiance, each channel limited to 0 to 1; to 16 where effects act on the mean of samples, or
        /// need it to be right.
        radiance: [f64; 3],
    },
}

/// A node, a leaf or a cell: what a structure calls it, and its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NodeId {
    /// Such as `pair` or `leaf`.
    pub what: &'static str,
    /// Counted from 0.
    pub number: u32,
}

/// Planes of a box that were tested, in units: `[axis][lower, upper]`.
pub type Sides = [[Option<i16>; 2]; 3];

/// Why radiance is added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The ray met nothing and brings the background.
    Background,
    /// A surface under ambient light and lights.
    Surface,
}

/// The result of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QueryHit {
    /// As the caller counts it.
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
