//! The shapes: one file per shape holds the whole of its host code.
//!
//! The registry of shapes in the core, `shapes!`, names the files, so a shape that has none does not compile.
//! Triangles of a mesh share vertices, so [`scene`](crate::scene) reads meshes and
//! [`compile`](mod@crate::compile) snaps them.

mod analytic;
mod crossing;
mod direction;
#[doc(hidden)]
pub mod exact;
mod exact_map;
mod keys;
mod lattice;
#[doc(hidden)]
pub mod rounding;
mod snapped;
mod sphere;
pub(crate) mod transform;
mod triangle;

pub use analytic::{Analytic, Geometric, Map, Normal, Surface};
pub(crate) use direction::unit;
pub(crate) use exact_map::ExactMap;
pub(crate) use keys::Keys;
pub(crate) use lattice::{Lattice, exp2};
pub(crate) use snapped::displacement;
pub(crate) use sphere::SnappedSphere;
pub use sphere::Sphere;
pub use triangle::Triangle;

use glam::{DAffine3, DVec3};
use gridel_core::Kind;
use gridel_core::geometry::Geometry;
use std::ops::Deref;
use transform::{Mesh, Misfit, OUT_OF_RANGE};

macro_rules! registry {
    (
        forms { $($form:tt)* }
        records { $(
            $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal,
            [$field:ident: $module:ident::$record:ident], $section:tt;
        )* }
    ) => {
        $(
            mod $module;
            pub use $module::$record;
        )*

        /// A shape in world space. Solids are closed; a mesh is whatever its triangles are.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Shape {
            /// An indexed mesh; every triangle is a primitive. Counter-clockwise is the front.
            Mesh {
                vertices: Vec<DVec3>,
                triangles: Vec<[u32; 3]>,
            },
            /// A sphere.
            Sphere(Sphere),
            $($(#[doc = $doc])* $kind($record),)*
        }

        /// A primitive in units.
        #[derive(Clone, Debug)]
        pub enum Solid {
            /// Its corners, counter-clockwise as seen from the front.
            Triangle(Triangle),
            /// A sphere.
            Sphere(Sphere),
            $($(#[doc = $doc])* $kind($record),)*
        }

        /// Evaluates an expression for the shape, and another one for meshes.
        macro_rules! of_shape {
            ($shape:expr, $it:ident => $value:expr, $mesh:pat => $other:expr) => {
                match $shape {
                    $mesh => $other,
                    Shape::Sphere($it) => $value,
                    $(Shape::$kind($it) => $value,)*
                }
            };
        }

        impl Shape {
            /// The kinds of objects in scene files that are shapes, with their keys, in the order of error lists.
            pub(crate) fn kinds() -> impl Iterator<Item = &'static (&'static str, &'static [&'static str])> {
                Sphere::KINDS.iter()$(.chain($record::KINDS))*
            }

            /// Reads a kind of object; `None` if it is no shape.
            pub(crate) fn read<K: Keys>(kind: &str, keys: &K) -> Option<Result<Self, K::Error>> {
                let is = |kinds: &[(&str, &[&str])]| kinds.iter().any(|(name, _)| *name == kind);
                if is(Sphere::KINDS) {
                    return Some(Sphere::read(kind, keys).map(Self::Sphere));
                }
                $(if is($record::KINDS) {
                    return Some($record::read(kind, keys).map(Self::$kind));
                })*
                None
            }

            /// Returns the shape of other numbers.
            pub fn map(&self, by: &Map<'_>) -> Self {
                match self {
                    Self::Mesh {
                        vertices,
                        triangles,
                    } => Self::Mesh {
                        vertices: vertices.iter().map(|&vertex| (by.point)(vertex)).collect(),
                        triangles: triangles.clone(),
                    },
                    Self::Sphere(it) => Self::Sphere(it.map(by)),
                    $(Self::$kind(it) => Self::$kind(it.map(by)),)*
                }
            }

            /// The shape after a transform. Fronts stay fronts, also in a mirror.
            pub(crate) fn transformed(&self, by: &DAffine3) -> Result<Self, Misfit> {
                let mesh = |vertices: &[DVec3], triangles: &[[u32; 3]]| {
                    let (vertices, triangles) = transform::mesh(by, vertices, triangles)?;
                    Ok(Self::Mesh {
                        vertices,
                        triangles,
                    })
                };
                let moved = match self {
                    Self::Mesh {
                        vertices,
                        triangles,
                    } => mesh(vertices, triangles),
                    Self::Sphere(it) => it.transformed(by).map(Self::Sphere),
                    $(Self::$kind(it) => it.transformed(by).map(Self::$kind),)*
                };
                let moved = match self.as_mesh() {
                    Some((vertices, triangles)) => moved.or_else(|_| mesh(&vertices, &triangles)),
                    None => moved,
                };
                moved.and_then(|moved| match moved.is_finite() && moved.has_extent() {
                    true => Ok(moved),
                    false => Err(OUT_OF_RANGE),
                })
            }
        }

        impl Shape {
            /// Returns whether it has a box. Shapes without one lie outside of all structures.
            pub(crate) fn is_bounded(&self) -> bool {
                match self {
                    Self::Mesh { .. } | Self::Sphere(_) => true,
                    $(Self::$kind(_) => Kind::$kind.is_bounded(),)*
                }
            }
        }

        impl Solid {
            /// Returns whether it has a box.
            pub fn is_bounded(&self) -> bool {
                match self {
                    Self::Triangle(_) | Self::Sphere(_) => true,
                    $(Self::$kind(_) => Kind::$kind.is_bounded(),)*
                }
            }

            /// Returns a primitive of a blob.
            pub fn of(geometry: Geometry) -> Self {
                match geometry {
                    Geometry::Triangle(corners) => Self::Triangle(corners.map(snapped::units)),
                    Geometry::Sphere { center, radius } => {
                        Self::Sphere(Sphere::in_units(&SnappedSphere { center, radius }))
                    }
                    $(Geometry::$kind(record) => Self::$kind($record::in_units(&record)),)*
                }
            }

        }

        impl Deref for Solid {
            type Target = dyn Geometric;

            fn deref(&self) -> &(dyn Geometric + 'static) {
                match self {
                    Self::Triangle(it) => it,
                    Self::Sphere(it) => it,
                    $(Self::$kind(it) => it,)*
                }
            }
        }

        impl From<Solid> for Shape {
            fn from(solid: Solid) -> Self {
                match solid {
                    Solid::Triangle(corners) => Self::Mesh {
                        vertices: corners.to_vec(),
                        triangles: vec![[0, 1, 2]],
                    },
                    Solid::Sphere(sphere) => Self::Sphere(sphere),
                    $(Solid::$kind(shape) => Self::$kind(shape),)*
                }
            }
        }

        /// Returns the cost of an intersection test, relative to a triangle's.
        pub(crate) const fn test_cost(kind: Kind) -> f64 {
            match kind {
                Kind::Triangle => 1.0,
                Kind::Sphere => Sphere::TEST_COST,
                $(Kind::$kind => $record::TEST_COST,)*
            }
        }
    };
}

gridel_core::shapes!(registry);

impl Shape {
    /// Returns whether all numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        of_shape!(self, it => it.is_finite(),
            Self::Mesh { vertices, .. } => vertices.iter().all(|vertex| vertex.is_finite()))
    }

    /// Returns whether there is something of it.
    pub(crate) fn has_extent(&self) -> bool {
        of_shape!(self, it => it.has_extent(), Self::Mesh { .. } => true)
    }

    /// Its box; an inverted one for a mesh without triangles. Vertices that no triangle has do not count.
    pub(crate) fn bounds(&self) -> [DVec3; 2] {
        of_shape!(self, it => it.bounds(), Self::Mesh { vertices, triangles } => {
            let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            let corners = triangles.iter().flatten().map(|&corner| vertices[corner as usize]);
            corners.fold(none, |[low, high], it| [low.min(it), high.max(it)])
        })
    }

    /// Returns the largest `point.dot(direction)` over all points: the support function. An unbounded shape counts as
    /// its point; a mesh without triangles has minus infinity.
    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        of_shape!(self, it => it.support(direction), Self::Mesh { vertices, triangles } => {
            let corners = triangles.iter().flatten();
            let along = corners.map(|&corner| vertices[corner as usize].dot(direction));
            along.fold(f64::NEG_INFINITY, f64::max)
        })
    }

    /// Number of primitives that it is compiled to.
    pub fn primitives(&self) -> usize {
        match self {
            Self::Mesh { triangles, .. } => triangles.len(),
            _ => 1,
        }
    }

    /// Its middle; `None` for a mesh.
    pub(crate) fn middle(&self) -> Option<DVec3> {
        let [(first, _), (last, _)] =
            of_shape!(self, it => it.ends(), Self::Mesh { .. } => return None);
        Some(first.midpoint(last))
    }

    /// Returns the normals of flat faces. Their length is twice the face's area.
    pub(crate) fn faces(&self) -> Vec<DVec3> {
        of_shape!(self, it => it.faces(), Self::Mesh { vertices, triangles } => {
            let normal = |corners: &[u32; 3]| {
                let [a, b, c] = corners.map(|corner| vertices[corner as usize]);
                (b - a).cross(c - a)
            };
            triangles.iter().map(normal).collect()
        })
    }

    /// Vertices and triangles of the same surface, for transforms after which the shape is another.
    pub(crate) fn as_mesh(&self) -> Option<Mesh> {
        of_shape!(self, it => it.as_mesh(), Self::Mesh { .. } => None)
    }

    /// Returns the name that reports use.
    #[cfg(test)]
    pub(crate) fn kind(&self) -> &'static str {
        of_shape!(self, it => it.kind(), Self::Mesh { triangles, .. } => match triangles.len() {
            1 => "triangle",
            _ => "mesh",
        })
    }
}
