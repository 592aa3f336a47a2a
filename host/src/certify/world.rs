//! A blob for exact arithmetic: integers, and boxes around primitives.
//!
//! Lengths are in steps of the storage lattice, 1/256 unit.

use super::crossing::{Crossing, MANTLE};
use super::tree::{Bounds, Tree};
use gridel_core::format::instance::MATRIX_BITS;
use gridel_core::format::record::Material;
use gridel_core::geometry::Geometry;
use gridel_core::{Effects, Kind, Scene};
use std::collections::{HashMap, HashSet};

/// The effects that are known here.
pub const KNOWN: Effects = Effects::SHADOW
    .with(Effects::HIGHLIGHT)
    .with(Effects::MIRROR)
    .with(Effects::GLASS)
    .with(Effects::ABSORPTION)
    .with(Effects::CHECKER)
    .with(Effects::SMOOTH)
    .with(Effects::VERTEX_COLORS)
    .with(Effects::TEXTURE)
    .with(Effects::ALPHA)
    .with(Effects::NESTED)
    .with(Effects::FALLOFF)
    .with(Effects::AREA_LIGHT)
    .with(Effects::TONE_MAPPING)
    .with(Effects::EMISSION)
    .with(Effects::DEPTH_OF_FIELD)
    .with(Effects::INDIRECT)
    .with(Effects::ENVIRONMENT)
    .with(Effects::GLOSSY)
    .with(Effects::NORMAL_MAP)
    .with(Effects::TEXTURE_LEVELS);

/// No surface, and no instance.
pub const NONE: u32 = u32::MAX;

/// The reason why a scene cannot be certified.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unknown {
    /// None at present: it protects from an effect that the core has and that is not enclosed here.
    #[error("certify does not know the effect `{0}` yet")]
    Effect(&'static str),
    #[error("certify does not know the primitive {0} of the kind `{1}`")]
    Primitive(usize, &'static str),
}

/// A primitive.
#[derive(Clone, Debug)]
pub struct Solid {
    pub form: Form,
    /// Its number in scene-file order, which decides between hits at one place; of a part's with those before it.
    pub primitive: u32,
    pub object: u32,
    /// The surfaces that its parts lie in, planes and cylinders without ends. A ray hits primitives that share one at
    /// the same t.
    pub surfaces: [u32; 6],
    /// The first primitive of the very same form.
    pub twin: u32,
    pub paint: Paint,
}

impl Solid {
    /// Returns whether crossings of this and of another primitive of the space lie in one surface, at one t.
    pub fn meets_at_one_t<N>(&self, other: &Self, [own, its]: [&Crossing<N>; 2]) -> bool {
        let same_way = own.leaves == its.leaves;
        let surface = self.surfaces[usize::from(own.part)];
        let is_shared = surface != NONE && surface == other.surfaces[usize::from(its.part)];
        // A ray crosses a plane once; it crosses a curved surface once inward and once outward.
        let is_curved = matches!(self.form, Form::Cone(_)) && own.part == MANTLE;
        let twins = self.twin == other.twin && own.part == its.part;
        is_shared && (same_way || !is_curved) || twins && same_way
    }
}

/// The attributes of a triangle's corners other than positions and normals, as stored.
#[derive(Clone, Copy, Debug, Default)]
pub struct Paint {
    pub colors: Option<[[u8; 4]; 3]>,
    /// Texture coordinates with 20 fraction bits.
    pub coordinates: Option<[[i32; 2]; 3]>,
}

impl Paint {
    /// Returns whether a triangle has the same color everywhere.
    pub fn is_plain(&self) -> bool {
        self.colors.is_none() && self.coordinates.is_none()
    }
}

/// The form of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    Triangle {
        corners: [[i64; 3]; 3],
        /// A normal of any length, exactly.
        normal: [i64; 3],
        /// The normals of the corners, as they are stored.
        smooth: Option<[[i16; 2]; 3]>,
    },
    Sphere {
        center: [i64; 3],
        radius: i64,
    },
    Disc {
        center: [i64; 3],
        normal: [i64; 3],
        radius: i64,
    },
    Plane {
        point: [i64; 3],
        normal: [i64; 3],
    },
    Cuboid {
        lowest: [i64; 3],
        highest: [i64; 3],
    },
    Cone(Cone),
    Torus(Torus),
}

/// A cylinder, a cone or a frustum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cone {
    /// The center of the base.
    pub base: [i64; 3],
    /// The vector from there to the center of the other cap.
    pub axis: [i64; 3],
    pub base_radius: i64,
    pub apex_radius: i64,
}

/// A torus with a major radius above 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Torus {
    pub center: [i64; 3],
    pub axis: [i64; 3],
    pub major: i64,
    pub minor: i64,
}

/// A place where a part stands.
#[derive(Clone, Copy, Debug)]
pub struct PlacedPart {
    pub part: usize,
    /// The instance's number in scene-file order, which decides between hits at one place.
    pub number: u32,
    pub matrix: [[i64; 3]; 3],
    pub center: [i64; 3],
    pub exponent: i32,
}

/// The content of a space that has a box.
#[derive(Clone, Copy, Debug)]
pub enum Item {
    Solid(u32),
    Instance(u32),
}

/// The primitives of a scene or of a part, and a hierarchy of boxes around them.
#[derive(Clone, Debug, Default)]
pub struct Space {
    pub solids: Vec<Solid>,
    /// The primitives without a box.
    pub unbounded: Vec<u32>,
    pub tree: Tree<Item>,
    /// Surfaces and forms that light may pass: see [`Space::may_be_hidden`].
    passed: [HashSet<u32>; 2],
}

/// A whole scene.
pub struct World<'s> {
    pub scene: &'s Scene<'s>,
    pub own: Space,
    pub parts: Vec<Space>,
    pub placed: Vec<PlacedPart>,
    pub effects: Effects,
}

impl<'s> World<'s> {
    /// Reads a scene.
    ///
    /// # Errors
    /// If something of it is not known here.
    pub fn of(scene: &'s Scene<'s>) -> Result<Self, Unknown> {
        let effects = scene.effects_with_parts();
        let strange = effects.without(KNOWN);
        if let Some(name) = strange.names().next() {
            return Err(Unknown::Effect(name));
        }
        if strange != Effects::NONE {
            return Err(Unknown::Effect("of a later version"));
        }
        let mut parts = Vec::new();
        for (number, part) in scene.parts().iter().enumerate() {
            let first = scene.first_primitive_of_part(number).unwrap_or(0);
            parts.push(Space::of(
                scene,
                part,
                |own| (first + own, scene.object(first + own)),
                Vec::new(),
            )?);
        }
        let mut placed = Vec::new();
        let mut boxes = Vec::new();
        for (index, instance) in (0..).zip(scene.instances()) {
            let part = usize::from(instance.part);
            placed.push(PlacedPart {
                part,
                number: instance.number,
                matrix: instance.matrix.map(|row| row.map(i64::from)),
                center: instance.center.map(i64::from),
                exponent: i32::from(instance.exponent) - MATRIX_BITS as i32,
            });
            let around = scene.parts().get(part);
            let around = around.and_then(|part| instance.around(part.bounds()));
            boxes.extend(around.map(|around| (Bounds::of(&around), Item::Instance(index))));
        }
        let own = Space::of(scene, scene, |own| (own, scene.object(own)), boxes)?;
        Ok(Self {
            scene,
            own,
            parts,
            placed,
            effects,
        })
    }

    /// Returns the space of an instance, or the scene's own.
    pub fn space(&self, instance: u32) -> &Space {
        match self.placed.get(instance as usize) {
            Some(placed) => &self.parts[placed.part],
            None => &self.own,
        }
    }
}

/// Returns whether light may pass a material.
pub fn passes(material: &Material) -> bool {
    material.is_glass() || material.maps & Material::MAPS_ALPHA != 0
}

impl Space {
    /// Returns whether a crossing may be hidden by one of a primitive that light may pass and that comes first in the
    /// scene file.
    pub fn may_be_hidden<N>(&self, solid: &Solid, crossing: &Crossing<N>) -> bool {
        let [surfaces, twins] = &self.passed;
        let surface = solid.surfaces[usize::from(crossing.part)];
        surface != NONE && surfaces.contains(&surface) || twins.contains(&solid.twin)
    }

    fn of(
        whole: &Scene<'_>,
        scene: &Scene<'_>,
        numbers: impl Fn(u32) -> (u32, u32),
        mut boxes: Vec<(Bounds, Item)>,
    ) -> Result<Self, Unknown> {
        let mut space = Self::default();
        let mut surfaces = Surfaces::default();
        let mut twins = HashMap::new();
        for kind in Kind::ALL {
            for slot in 0..scene.count(kind) {
                let unknown = Unknown::Primitive(slot, kind.name());
                let geometry = scene.geometry(kind, slot).ok_or(unknown)?;
                let form = form(scene, slot, geometry);
                let (primitive, object) = numbers(scene.primitive(kind, slot as u32));
                let index = space.solids.len() as u32;
                let surfaces = surfaces.of(&form);
                let twin = *twins.entry(form).or_insert(index);
                if whole.material(object).is_some_and(passes) {
                    space.passed[0].extend(surfaces.iter().filter(|&&it| it != NONE));
                    space.passed[1].insert(twin);
                }
                space.solids.push(Solid {
                    form,
                    primitive,
                    object,
                    surfaces,
                    twin,
                    paint: match kind {
                        Kind::Triangle => Paint {
                            colors: scene.corner_colors(slot),
                            coordinates: scene.corner_coordinates(slot),
                        },
                        _ => Paint::default(),
                    },
                });
                match scene.primitive_bounds(kind, slot) {
                    Some(bounds) if kind.is_bounded() => {
                        boxes.push((Bounds::of(&bounds), Item::Solid(index)));
                    }
                    _ => space.unbounded.push(index),
                }
            }
        }
        space.tree = Tree::of(boxes);
        Ok(space)
    }
}

fn form(scene: &Scene<'_>, slot: usize, geometry: Geometry) -> Form {
    let wide = |v: [i32; 3]| v.map(i64::from);
    match geometry {
        Geometry::Triangle(corners) => {
            let corners = corners.map(wide);
            let edge = |to: usize| [0, 1, 2].map(|k| corners[to][k] - corners[0][k]);
            let (p, q) = (edge(1), edge(2));
            let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| p[i] * q[j] - p[j] * q[i]);
            Form::Triangle {
                corners,
                normal,
                smooth: scene.corner_normals(slot),
            }
        }
        Geometry::Sphere { center, radius } => Form::Sphere {
            center: wide(center),
            radius: radius.into(),
        },
        Geometry::Disc(disc) => Form::Disc {
            center: wide(disc.center),
            normal: wide(disc.normal),
            radius: disc.radius.into(),
        },
        Geometry::Plane(plane) => Form::Plane {
            point: wide(plane.point),
            normal: wide(plane.normal),
        },
        Geometry::Box(cuboid) => Form::Cuboid {
            lowest: wide(cuboid.lowest),
            highest: wide(cuboid.highest),
        },
        Geometry::Cone(cone) => Form::Cone(Cone {
            base: wide(cone.base),
            axis: [0, 1, 2].map(|k| i64::from(cone.apex[k]) - i64::from(cone.base[k])),
            base_radius: cone.base_radius.into(),
            apex_radius: cone.apex_radius.into(),
        }),
        // Squares of spheres' quadratics have no simple roots.
        Geometry::Torus(torus) if torus.major_radius == 0 => Form::Sphere {
            center: wide(torus.center),
            radius: torus.minor_radius.into(),
        },
        Geometry::Torus(torus) => Form::Torus(Torus {
            center: wide(torus.center),
            axis: reduced(wide(torus.axis)),
            major: torus.major_radius.into(),
            minor: torus.minor_radius.into(),
        }),
    }
}

/// The surfaces of a space that primitives may share, known by integers.
#[derive(Default)]
struct Surfaces(HashMap<Surface, u32>);

#[derive(PartialEq, Eq, Hash)]
enum Surface {
    /// A normal, and the distance along it.
    Plane([i64; 3], i128),
    /// An axis, its moment and a radius.
    Cylinder([i64; 3], [i128; 3], i64),
}

impl Surfaces {
    fn of(&mut self, form: &Form) -> [u32; 6] {
        let mut surfaces = [NONE; 6];
        match *form {
            Form::Triangle {
                corners: [point, ..],
                normal,
                ..
            }
            | Form::Disc {
                center: point,
                normal,
                ..
            }
            | Form::Plane { point, normal } => surfaces[0] = self.plane(point, normal),
            Form::Cuboid { lowest, highest } => {
                for (face, surface) in surfaces.iter_mut().enumerate() {
                    let side = if face % 2 == 0 { lowest } else { highest };
                    let mut normal = [0; 3];
                    normal[face / 2] = 1;
                    *surface = self.plane(side, normal);
                }
            }
            Form::Cone(Cone {
                base,
                axis,
                base_radius,
                apex_radius,
            }) => {
                if base_radius == apex_radius {
                    surfaces[0] = self.cylinder(base, axis, base_radius);
                }
                surfaces[1] = self.plane(base, axis);
                surfaces[2] = self.plane([0, 1, 2].map(|k| base[k] + axis[k]), axis);
            }
            Form::Sphere { .. } | Form::Torus(_) => {}
        }
        surfaces
    }

    fn plane(&mut self, point: [i64; 3], normal: [i64; 3]) -> u32 {
        let normal = line(normal);
        let along = (0..3).map(|k| i128::from(normal[k]) * i128::from(point[k]));
        self.number(normal, Surface::Plane(normal, along.sum()))
    }

    fn cylinder(&mut self, point: [i64; 3], axis: [i64; 3], radius: i64) -> u32 {
        let axis = line(axis);
        let product = |i: usize, j: usize| i128::from(point[i]) * i128::from(axis[j]);
        let moment = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| product(i, j) - product(j, i));
        self.number(axis, Surface::Cylinder(axis, moment, radius))
    }

    fn number(&mut self, direction: [i64; 3], surface: Surface) -> u32 {
        if direction == [0; 3] {
            return NONE;
        }
        let next = self.0.len() as u32;
        *self.0.entry(surface).or_insert(next)
    }
}

/// Returns the shortest vector of integers on the line of another one, of either sign.
fn line(vector: [i64; 3]) -> [i64; 3] {
    let first = vector.iter().find(|&&x| x != 0).map_or(1, |x| x.signum());
    reduced(vector).map(|x| x * first)
}

/// The shortest vector of integers with the same direction.
fn reduced(vector: [i64; 3]) -> [i64; 3] {
    let divisor = vector.iter().fold(0, |a, &b| gcd(a, b.unsigned_abs()));
    vector.map(|x| x / divisor.max(1) as i64)
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
