//! The tests' part of every shape: one file for each, as on the host.

mod sample;
mod sphere;
mod triangle;

pub use sample::{Named, Room, Sample, lattice, lattice_point};

use crate::random::Random;
use glam::DVec3;
use gridel_core::Kind;
use gridel_host::scene::Shape;
use gridel_host::shape::exact::Real;
use gridel_host::shape::{Solid, Sphere, Triangle};

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
            use gridel_host::shape::$record;
        )*

        /// The names of all shapes.
        pub fn names() -> impl Iterator<Item = &'static Named> {
            Sphere::NAMES.iter().chain(Triangle::NAMES)$(.chain($record::NAMES))*
        }

        /// A shape of each kind, for pictures.
        pub fn examples() -> Vec<(&'static str, Shape)> {
            let mesh = Shape::Mesh {
                vertices: Triangle::example().to_vec(),
                triangles: vec![[0, 1, 2]],
            };
            vec![
                (Kind::Triangle.name(), mesh),
                (Kind::Sphere.name(), Shape::Sphere(Sphere::example())),
                $((Kind::$kind.name(), Shape::$kind($record::example())),)*
            ]
        }

        /// A random shape of a name, its numbers on the lattice.
        pub fn random(random: &mut Random, name: &str, room: Room) -> Solid {
            let is = |names: &[Named]| names.iter().any(|it| it.name == name);
            if is(Triangle::NAMES) {
                return Solid::Triangle(Triangle::random(random, name, room));
            }
            $(if is($record::NAMES) {
                return Solid::$kind($record::random(random, name, room));
            })*
            Solid::Sphere(Sphere::random(random, name, room))
        }

        /// The primitives of a shape.
        pub fn primitives(shape: &Shape) -> Vec<Solid> {
            match shape {
                Shape::Mesh { vertices, triangles } => {
                    let corners = |it: &[u32; 3]| it.map(|vertex| vertices[vertex as usize]);
                    triangles.iter().map(corners).map(Solid::Triangle).collect()
                }
                Shape::Sphere(it) => vec![Solid::Sphere(*it)],
                $(Shape::$kind(it) => vec![Solid::$kind(*it)],)*
            }
        }

        macro_rules! of_solid {
            ($solid:expr, $it:ident => $value:expr) => {
                match $solid {
                    Solid::Triangle($it) => $value,
                    Solid::Sphere($it) => $value,
                    $(Solid::$kind($it) => $value,)*
                }
            };
        }
    };
}

gridel_core::shapes!(registry);

/// See [`Sample::place`].
pub fn place(solid: &Solid, random: &mut Random) -> DVec3 {
    of_solid!(solid, it => it.place(random))
}

/// See [`Sample::own_direction`].
pub fn own_direction(solid: &Solid, random: &mut Random) -> DVec3 {
    of_solid!(solid, it => it.own_direction(random))
}

/// See [`Sample::surface_point`].
pub fn surface_point(solid: &Solid, random: &mut Random) -> DVec3 {
    of_solid!(solid, it => it.surface_point(random))
}

/// See [`Sample::distance`].
pub fn distance(solid: &Solid, point: DVec3) -> f64 {
    of_solid!(solid, it => it.distance(point))
}

/// See [`Sample::reach`].
pub fn reach(solid: &Solid, axis: usize, sign: f64) -> Real {
    of_solid!(solid, it => it.reach(axis, sign))
}
