//! The scene's shapes as primitives on the lattice.

use super::CompileError;
use super::hierarchy::Primitive;
use super::lattice::Lattice;
use crate::report::grouped;
use crate::scene::{Object, Scene, Shape};
use glam::{DVec3, IVec3};
use gridel_core::Kind;
use gridel_core::blob::record::{Cone, Cuboid, Disc, UnitBox};
use serde::{Serialize, Serializer};
use std::collections::HashMap;

/// Most primitives in a blob.
const MOST: usize = 1 << 24;
/// Primitives that are left out and named; the rest are counted.
const NAMED: usize = 20;

/// A sphere in 1/256 unit.
#[derive(Clone, Copy, Debug)]
pub struct SnappedSphere {
    pub center: [i32; 3],
    pub radius: i32,
}

/// Primitives of all kinds, each in scene-file order.
#[derive(Debug, Default)]
pub struct Primitives {
    /// Distinct vertices of all meshes, in 1/256 unit.
    pub vertices: Vec<[i32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub spheres: Vec<SnappedSphere>,
    pub boxes: Vec<Cuboid>,
    pub discs: Vec<Disc>,
    pub cones: Vec<Cone>,
    /// For each kind, the numbers of its primitives in scene-file order.
    pub numbers: [Vec<u32>; 5],
    /// Primitives in the scene file, the collapsed ones included.
    pub total: u32,
    /// For each object, its first primitive.
    pub object_first: Vec<u32>,
    /// What the lattice leaves nothing of.
    pub collapsed: LeftOut,
    /// Triangles without area.
    pub without_area: LeftOut,
    /// The farthest that a point was moved, in scene units.
    pub largest_displacement: f64,
}

/// Primitives that a blob leaves out: the first of them by name, and how many there are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    names: Vec<String>,
    count: usize,
}

impl LeftOut {
    fn add(&mut self, name: String) {
        if self.names.len() < NAMED {
            self.names.push(name);
        }
        self.count += 1;
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// At most so many names, and how many there are beside them.
    pub fn names(&self, most: usize) -> Vec<String> {
        let mut names: Vec<_> = self.names.iter().take(most).cloned().collect();
        if self.count > names.len() {
            names.push(format!("and {} more", grouped(self.count - names.len())));
        }
        names
    }
}

impl Serialize for LeftOut {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.names(NAMED).serialize(serializer)
    }
}

/// The box of everything in a scene; a point for an empty one.
pub fn extent(scene: &Scene) -> (DVec3, DVec3) {
    let mut lowest = DVec3::INFINITY;
    let mut highest = DVec3::NEG_INFINITY;
    let mut add = |low: DVec3, high: DVec3| {
        lowest = lowest.min(low);
        highest = highest.max(high);
    };
    for object in &scene.objects {
        match &object.shape {
            Shape::Sphere { center, radius } => add(*center - *radius, *center + *radius),
            Shape::Mesh { vertices, .. } => vertices.iter().for_each(|&vertex| add(vertex, vertex)),
            Shape::Box { min, max } => add(*min, *max),
            Shape::Disc {
                center,
                normal,
                radius,
            } => {
                let reach = disc_reach(*normal) * *radius;
                add(*center - reach, *center + reach);
            }
            Shape::Cone {
                base,
                base_radius,
                apex,
                apex_radius,
            } => {
                let reach = disc_reach(*apex - *base);
                for (center, radius) in [(base, base_radius), (apex, apex_radius)] {
                    add(*center - reach * *radius, *center + reach * *radius);
                }
            }
        }
    }
    if lowest.x > highest.x {
        (DVec3::ZERO, DVec3::ZERO)
    } else {
        (lowest, highest)
    }
}

/// Whether all numbers of a shape are finite.
pub fn is_finite(shape: &Shape) -> bool {
    match shape {
        Shape::Sphere { center, radius } => center.is_finite() && radius.is_finite(),
        Shape::Mesh { vertices, .. } => vertices.iter().all(|vertex| vertex.is_finite()),
        Shape::Box { min, max } => min.is_finite() && max.is_finite(),
        Shape::Disc {
            center,
            normal,
            radius,
        } => center.is_finite() && normal.is_finite() && radius.is_finite(),
        Shape::Cone {
            base,
            base_radius,
            apex,
            apex_radius,
        } => {
            base.is_finite()
                && apex.is_finite()
                && base_radius.is_finite()
                && apex_radius.is_finite()
        }
    }
}

/// How far a unit disc with a normal reaches along each axis.
fn disc_reach(normal: DVec3) -> DVec3 {
    let normal = (normal / normal.abs().max_element()).normalize();
    (DVec3::ONE - normal * normal)
        .max(DVec3::ZERO)
        .map(f64::sqrt)
}

impl Primitives {
    /// Snaps everything.
    pub fn snap(scene: &Scene, lattice: &Lattice) -> Result<Self, CompileError> {
        let mut primitives = Self::default();
        let mut vertex_numbers = HashMap::new();
        for object in &scene.objects {
            primitives.object_first.push(primitives.total);
            primitives.add(object, lattice, &mut vertex_numbers)?;
        }
        Ok(primitives)
    }

    /// The box of every primitive, for the builder.
    pub fn boxes(&self) -> Vec<Primitive> {
        let of = |kind: Kind, count: usize, bounds: &dyn Fn(usize) -> UnitBox| -> Vec<Primitive> {
            (0..count)
                .map(|i| Primitive {
                    bounds: bounds(i),
                    kind,
                    index: i as u32,
                })
                .collect()
        };
        let triangle = |i: usize| {
            let corners = self.triangles[i].map(|v| IVec3::from(self.vertices[v as usize]));
            let lowest = corners[0].min(corners[1]).min(corners[2]);
            let highest = corners[0].max(corners[1]).max(corners[2]);
            UnitBox::around(lowest.into(), highest.into())
        };
        let sphere = |i: usize| {
            let SnappedSphere { center, radius } = self.spheres[i];
            UnitBox::around(center.map(|x| x - radius), center.map(|x| x + radius))
        };
        let cuboid = |i: usize| UnitBox::around(self.boxes[i].lowest, self.boxes[i].highest);
        [
            of(Kind::Triangle, self.triangles.len(), &triangle),
            of(Kind::Sphere, self.spheres.len(), &sphere),
            of(Kind::Box, self.boxes.len(), &cuboid),
            of(Kind::Disc, self.discs.len(), &|i| self.discs[i].bounds),
            of(Kind::Cone, self.cones.len(), &|i| self.cones[i].bounds),
        ]
        .concat()
    }

    /// The groups that a primitive is in, the largest first, as the parts of its object's name say
    /// (`A/CYS 3/CA` is the atom CA of the residue CYS 3 of the chain A), and its number.
    pub fn groups<'s>(&self, scene: &'s Scene, primitive: &Primitive) -> (Vec<&'s str>, u32) {
        let number = self.numbers[primitive.kind as usize][primitive.index as usize];
        let behind = self.object_first.partition_point(|&first| first <= number);
        let object = &scene.objects[behind - 1];
        (object.name.split('/').collect(), number)
    }

    fn add(
        &mut self,
        object: &Object,
        lattice: &Lattice,
        vertex_numbers: &mut HashMap<[i32; 3], u32>,
    ) -> Result<(), CompileError> {
        match &object.shape {
            Shape::Mesh {
                vertices,
                triangles,
            } => {
                let snapped: Vec<_> = vertices.iter().map(|&v| self.point(v, lattice)).collect();
                // Their numbers among all distinct ones, as soon as they are looked up.
                let mut numbers = vec![None; vertices.len()];
                for (number, triangle) in triangles.iter().enumerate() {
                    let corners = triangle.map(|vertex| snapped[vertex as usize]);
                    if is_degenerate(corners) {
                        self.total += 1;
                        let [a, b, c] = triangle.map(|vertex| vertices[vertex as usize]);
                        let name = format!("{} ({}, triangle {number})", object.name, object.place);
                        if (b - a).cross(c - a) == DVec3::ZERO {
                            self.without_area.add(name);
                        } else {
                            self.collapsed.add(name);
                        }
                    } else {
                        let triangle = triangle.map(|vertex| {
                            *numbers[vertex as usize].get_or_insert_with(|| {
                                let corner = snapped[vertex as usize];
                                *vertex_numbers.entry(corner).or_insert_with(|| {
                                    self.vertices.push(corner);
                                    self.vertices.len() as u32 - 1
                                })
                            })
                        });
                        self.triangles.push(triangle);
                        self.keep(Kind::Triangle);
                    }
                }
            }
            Shape::Sphere { center, radius } => {
                let center = self.point(*center, lattice);
                let radius = self.length(*radius, lattice);
                if radius == 0 {
                    self.collapse(object);
                } else {
                    self.spheres.push(SnappedSphere { center, radius });
                    self.keep(Kind::Sphere);
                }
            }
            Shape::Box { min, max } => {
                let (lowest, highest) = (self.point(*min, lattice), self.point(*max, lattice));
                self.boxes.push(Cuboid { lowest, highest });
                self.keep(Kind::Box);
            }
            Shape::Disc {
                center,
                normal,
                radius,
            } => {
                let center = self.point(*center, lattice);
                let radius = self.length(*radius, lattice);
                // The direction to a part in 2^24.
                let normal = *normal / normal.abs().max_element();
                let normal = (normal * f64::from(1 << 24))
                    .round()
                    .to_array()
                    .map(|x| x as i32);
                if radius == 0 {
                    self.collapse(object);
                } else {
                    let reach = disc_reach(DVec3::from_array(normal.map(f64::from)));
                    let bounds = around(&[(center, reach * f64::from(radius))]);
                    self.discs.push(Disc {
                        center,
                        normal,
                        radius,
                        bounds,
                    });
                    self.keep(Kind::Disc);
                }
            }
            Shape::Cone {
                base,
                base_radius,
                apex,
                apex_radius,
            } => {
                let (base, apex) = (self.point(*base, lattice), self.point(*apex, lattice));
                let base_radius = self.length(*base_radius, lattice);
                let apex_radius = self.length(*apex_radius, lattice);
                if base == apex || base_radius + apex_radius == 0 {
                    self.collapse(object);
                } else {
                    let axis = DVec3::from_array(apex.map(f64::from))
                        - DVec3::from_array(base.map(f64::from));
                    let reach = disc_reach(axis);
                    let bounds = around(&[
                        (base, reach * f64::from(base_radius)),
                        (apex, reach * f64::from(apex_radius)),
                    ]);
                    self.cones.push(Cone {
                        base,
                        apex,
                        base_radius,
                        apex_radius,
                        bounds,
                    });
                    self.keep(Kind::Cone);
                }
            }
        }
        if self.total as usize > MOST {
            let count = self.total as usize;
            return Err(CompileError::TooMany {
                what: "primitives",
                count,
                most: MOST,
            });
        }
        Ok(())
    }

    /// Gives the primitive that was just added its number.
    fn keep(&mut self, kind: Kind) {
        self.numbers[kind as usize].push(self.total);
        self.total += 1;
    }

    /// Passes over an object that the lattice leaves nothing of.
    fn collapse(&mut self, object: &Object) {
        self.total += 1;
        self.collapsed
            .add(format!("{} ({})", object.name, object.place));
    }

    fn point(&mut self, point: DVec3, lattice: &Lattice) -> [i32; 3] {
        let snapped = lattice.snap(point);
        self.displaced((lattice.place(snapped) - point).abs().max_element());
        snapped
    }

    fn length(&mut self, length: f64, lattice: &Lattice) -> i32 {
        let snapped = lattice.snap_length(length);
        self.displaced((f64::from(snapped) * lattice.unit() / 256.0 - length).abs());
        snapped
    }

    fn displaced(&mut self, distance: f64) {
        self.largest_displacement = self.largest_displacement.max(distance);
    }
}

/// Whether the corners lie on a line, exactly.
fn is_degenerate([a, b, c]: [[i32; 3]; 3]) -> bool {
    let edge = |to: [i32; 3]| [0, 1, 2].map(|k| i64::from(to[k]) - i64::from(a[k]));
    let (p, q) = (edge(b), edge(c));
    (0..3).all(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        p[i] * q[j] == p[j] * q[i]
    })
}

/// The box around points with a reach along each axis, rounded outward by more than the reach can
/// be off.
fn around(points: &[([i32; 3], DVec3)]) -> UnitBox {
    let ends = points.iter().map(|&(center, reach)| {
        let center = DVec3::from_array(center.map(f64::from));
        let slack = reach * 1e-9;
        (
            (center - reach - slack).floor(),
            (center + reach + slack).ceil(),
        )
    });
    let (lowest, highest) = ends
        .reduce(|(low, high), (other_low, other_high)| (low.min(other_low), high.max(other_high)))
        .unwrap_or_default();
    UnitBox::around(
        lowest.to_array().map(|x| x as i32),
        highest.to_array().map(|x| x as i32),
    )
}
