//! The scene's shapes as primitives on the lattice.

use super::cuts::{self, Sliver};
use super::flattened::{self, is_degenerate};
use super::records::{Added, Records};
use super::vertices::{Corner, Corners, MOST_COORDINATE, Vertices, corner_at};
use crate::compile::CompileError;
use crate::compile::hierarchy::node::Primitive;
use crate::compile::motion::morph::Motions;
use crate::compile::requirements::Requirements;
use crate::scene::{Object, Scene};
use crate::shape::{Lattice, Shape, Solid, displacement};
use crate::table::{grouped, printable};
use glam::{DVec3, IVec3};
use gridel_core::format::limits::FARTHEST_POINT;
use gridel_core::format::record::UnitBox;
use gridel_core::geometry::Geometry;
use gridel_core::{Effects, Kind};
use serde::{Serialize, Serializer};
use std::collections::HashMap;

/// Most primitives in a blob.
const MOST: usize = 1 << 24;
/// Primitives that are left out or moved far and named; the rest are counted.
const NAMED: usize = 20;
/// Displacement of a surface, in steps of the lattice, from which a warning is given.
const FAR_MOVED: f64 = 4.0;

/// Primitives of all kinds, each in scene-file order.
#[derive(Debug, Default)]
pub struct Primitives {
    /// Distinct vertices of all meshes, in 1/256 unit. Those that carry something else differ.
    pub vertices: Vec<[i32; 3]>,
    /// The attributes of each vertex other than its position; empty where no vertex has any.
    pub corners: Vec<Corner>,
    /// The motions of vertices by morph targets.
    pub motions: Motions,
    /// Objects whose vertices require effects, by name.
    pub requirements: Requirements,
    pub triangles: Vec<[u32; 3]>,
    pub records: Records,
    /// For each kind, the numbers of its primitives in scene-file order.
    pub numbers: [Vec<u32>; Kind::ALL.len()],
    /// Primitives in the scene file, the collapsed ones included.
    pub total: u32,
    /// For each object, its first primitive.
    pub object_first: Vec<u32>,
    /// Primitives that collapse on the lattice.
    pub collapsed: LeftOut,
    /// Triangles without area.
    pub without_area: LeftOut,
    /// Triangles whose corners lie on a line at rest, and leave it by a morph target.
    pub flat_at_rest: LeftOut,
    /// For each primitive in scene-file order, the largest distance between the given and the snapped surface, in 1/256
    /// unit. 0 for those that are left out.
    pub displacements: Vec<f32>,
    /// Primitives whose surface was moved by more than [`FAR_MOVED`] steps.
    pub far_moved: LeftOut,
    /// Triangles that are no longer triangles on the lattice.
    slivers: Vec<Sliver>,
    /// The motions of slivers' corners, by their places.
    sliver_motions: HashMap<[i32; 3], u32>,
    /// A primitive reaches beyond the lattice, because it had to be moved that far.
    pub needs_room: bool,
    /// True if closed meshes may lie in one plane.
    flat_meshes: bool,
}

/// Primitives that a blob leaves out, or that were moved far: the first of them by name, and how many
/// there are.
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

    pub(crate) fn add_all(&mut self, others: &Self) {
        others.names.iter().for_each(|name| self.add(name.clone()));
        self.count += others.count - others.names.len();
    }

    /// Returns their number.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns at most `most` names, and the number of the others.
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

impl Primitives {
    /// Snaps everything. Unless `flat_meshes`, a closed mesh that then lies in one plane is an error.
    pub fn snap(scene: &Scene, lattice: &Lattice, flat_meshes: bool) -> Result<Self, CompileError> {
        let mut primitives = Self {
            flat_meshes,
            ..Self::default()
        };
        let mut distinct = Vertices::default();
        for object in &scene.objects {
            primitives.object_first.push(primitives.total);
            primitives.add(scene, object, lattice, &mut distinct)?;
        }
        primitives.cut(&mut distinct)?;
        (primitives.vertices, primitives.corners) = distinct.into_parts();
        Ok(primitives)
    }

    /// Cuts the neighbors of slivers at the slivers' corners.
    fn cut(&mut self, distinct: &mut Vertices) -> Result<(), CompileError> {
        let places = |triangle: &[u32; 3]| triangle.map(|vertex| distinct.get(vertex).0);
        let cuts = cuts::Cuts::around(&self.slivers, self.triangles.iter().map(places));
        if cuts.is_empty() {
            return Ok(());
        }
        // Counted before they are made.
        let counts = self.triangles.iter().map(|it| cuts.count(places(it)));
        let others: usize = self.numbers.iter().map(Vec::len).sum();
        let pieces = counts.sum::<usize>() + others - self.triangles.len();
        if pieces > self.total as usize {
            return Err(CompileError::Slivers {
                collapsed: self.slivers.len(),
                pieces,
                most: self.total as usize,
            });
        }
        let triangles = std::mem::take(&mut self.triangles);
        let numbers = std::mem::take(&mut self.numbers[Kind::Triangle as usize]);
        for (triangle, number) in triangles.into_iter().zip(numbers) {
            let places = triangle.map(|vertex| distinct.get(vertex).0);
            let corners = triangle.map(|vertex| distinct.get(vertex).1);
            for piece in cuts.pieces(places) {
                let piece = piece.map(|place| {
                    let motion = self.sliver_motions.get(&place).copied();
                    let corner = corner_at((place, motion.unwrap_or(0)), places, corners);
                    distinct.number(place, corner)
                });
                self.triangles.push(piece);
                self.numbers[Kind::Triangle as usize].push(number);
            }
        }
        Ok(())
    }

    /// Returns the box of every primitive that has one, for the builder.
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
        let triangles = of(Kind::Triangle, self.triangles.len(), &triangle);
        let bounded = Kind::ALL.into_iter().filter(|kind| kind.is_bounded());
        let others = bounded.flat_map(|kind| {
            of(kind, self.records.count(kind), &|i| {
                self.records.bounds(kind, i)
            })
        });
        triangles.into_iter().chain(others).collect()
    }

    /// Returns a primitive in units.
    pub fn solid(&self, kind: Kind, index: usize) -> Solid {
        self.records.solid(kind, index).unwrap_or_else(|| {
            let corners = self.triangles[index].map(|vertex| self.vertices[vertex as usize]);
            Solid::of(Geometry::Triangle(corners))
        })
    }

    /// Returns the name of a primitive's object, and the primitive's number.
    pub fn object<'s>(&self, scene: &'s Scene, primitive: &Primitive) -> (&'s str, u32) {
        let number = self.numbers[primitive.kind as usize][primitive.index as usize];
        let behind = self.object_first.partition_point(|&first| first <= number);
        (&scene.objects[behind - 1].name, number)
    }

    fn add(
        &mut self,
        scene: &Scene,
        object: &Object,
        lattice: &Lattice,
        distinct: &mut Vertices,
    ) -> Result<(), CompileError> {
        match &object.shape {
            Shape::Mesh {
                vertices,
                triangles,
            } => self.add_mesh(scene, object, (vertices, triangles), lattice, distinct)?,
            shape => self.add_solid(object, shape, lattice)?,
        }
        self.check_count()
    }

    fn add_mesh(
        &mut self,
        scene: &Scene,
        object: &Object,
        (vertices, triangles): (&[DVec3], &[[u32; 3]]),
        lattice: &Lattice,
        distinct: &mut Vertices,
    ) -> Result<(), CompileError> {
        let snapped: Vec<_> = vertices.iter().map(|&v| lattice.snap(v)).collect();
        // Their numbers among all distinct ones without normals, as soon as they are looked up.
        let mut numbers = vec![None; vertices.len()];
        let texture = scene.materials[object.material].placing();
        let attributes = object.attributes.placed_on(texture);
        let all = Corners::of(&object.normals, &attributes, scene.display_values);
        let mut all = all.ok_or_else(|| CompileError::TextureCoordinates {
            object: format!("{} ({})", printable(&object.name), object.place),
            most: MOST_COORDINATE,
        })?;
        let targets = &scene.morph_targets;
        all.motions = self.motions.of(object, triangles, lattice, targets)?;
        let all = all;
        let (mut is_smooth, mut is_colored) = (false, false);
        let name_of = |number: usize| {
            let name = printable(&object.name);
            format!("{name} ({}, triangle {number})", object.place)
        };
        for (number, triangle) in triangles.iter().enumerate() {
            let given = triangle.map(|vertex| vertices[vertex as usize]);
            let corners = triangle.map(|vertex| snapped[vertex as usize]);
            let found = all.of_triangle(number, *triangle);
            let has_area = (given[1] - given[0]).cross(given[2] - given[0]) != DVec3::ZERO;
            if is_degenerate(corners) && !self.opens(corners, found) {
                let left_out = match has_area {
                    _ if self.unfolds(corners, found) => &mut self.flat_at_rest,
                    true => &mut self.collapsed,
                    false => &mut self.without_area,
                };
                left_out.add(name_of(number));
                self.slivers.push(corners);
                let moving = corners.into_iter().zip(found).filter(|it| it.1.motion > 0);
                self.sliver_motions
                    .extend(moving.map(|(place, corner)| (place, corner.motion)));
                self.leave_out();
                continue;
            }
            let displacement = [0, 1, 2]
                .map(|k: usize| displacement(lattice.in_fine(given[k]), corners[k]))
                .into_iter()
                .fold(0.0, f64::max);
            let triangle = if all.is_plain() {
                triangle.map(|vertex| {
                    *numbers[vertex as usize].get_or_insert_with(|| {
                        distinct.number(snapped[vertex as usize], Corner::default())
                    })
                })
            } else {
                is_smooth |= found[0].normal.is_some();
                is_colored |= found[0].color.is_some();
                [0, 1, 2].map(|k: usize| distinct.number(corners[k], found[k]))
            };
            self.triangles.push(triangle);
            self.keep(Kind::Triangle, displacement);
        }
        for (effect, is_required) in [
            (Effects::SMOOTH, is_smooth),
            (Effects::VERTEX_COLORS, is_colored),
        ] {
            if is_required {
                let name = format!("mesh {}", printable(&object.name));
                self.requirements.add(effect, name, &object.place);
            }
        }
        let is_still = all.motions.is_empty();
        if !self.flat_meshes && is_still && flattened::is_flattened((vertices, &snapped), triangles)
        {
            return Err(CompileError::Flattened {
                object: format!("{} ({})", printable(&object.name), object.place),
                step: lattice.step(),
            });
        }
        Ok(())
    }

    /// Adds a shape that is one primitive.
    fn add_solid(
        &mut self,
        object: &Object,
        shape: &Shape,
        lattice: &Lattice,
    ) -> Result<(), CompileError> {
        let name = || format!("{} ({})", printable(&object.name), object.place);
        let Some(Added {
            kind,
            displacement,
            fits,
        }) = self.records.add(shape, lattice)
        else {
            self.collapsed.add(name());
            self.leave_out();
            return Ok(());
        };
        if !fits && !kind.is_bounded() {
            return Err(CompileError::OutOfReach {
                object: name(),
                most: lattice.unit() * (FARTHEST_POINT >> 8) as f64,
            });
        }
        self.needs_room |= !fits;
        let steps = displacement / lattice.fine_steps();
        if steps > FAR_MOVED {
            self.far_moved
                .add(format!("{}: by {steps:.1} steps", name()));
        }
        self.keep(kind, displacement);
        Ok(())
    }

    /// Returns true if corners of a triangle that coincide at rest move apart, so that it then has an area.
    fn opens(&self, places: [[i32; 3]; 3], corners: [Corner; 3]) -> bool {
        let mut pairs = [(0, 1), (1, 2), (2, 0)].into_iter();
        pairs.any(|(one, other)| {
            let [motion, other_motion] = [one, other].map(|corner| corners[corner].motion);
            places[one] == places[other] && !self.motions.stay_together(motion, other_motion)
        })
    }

    /// Returns true if corners of a triangle that lie on a line at rest leave it by a morph target.
    fn unfolds(&self, places: [[i32; 3]; 3], corners: [Corner; 3]) -> bool {
        let side = |k: usize| {
            DVec3::from_array(std::array::from_fn(|axis| {
                f64::from(places[k][axis]) - f64::from(places[0][axis])
            }))
        };
        let motions = corners.map(|corner| corner.motion);
        self.motions.differences(motions).any(|[second, third]| {
            // What each weight adds to twice the area, and what its square does.
            let linear = side(1).cross(third) + second.cross(side(2));
            linear != DVec3::ZERO || second.cross(third) != DVec3::ZERO
        })
    }

    fn check_count(&self) -> Result<(), CompileError> {
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

    /// Returns the displacements in steps of the lattice.
    pub fn displacements_in_steps(&self, lattice: &Lattice) -> Vec<f32> {
        let fine_steps = lattice.fine_steps() as f32;
        let displacements = self.displacements.iter();
        displacements.map(|it| it / fine_steps).collect()
    }

    /// Gives the primitive that was just added its number. `displacement` is that of its surface in 1/256 unit.
    fn keep(&mut self, kind: Kind, displacement: f64) {
        self.numbers[kind as usize].push(self.total);
        self.displacements.push(rounded_up(displacement));
        self.total += 1;
    }

    /// Leaves out a primitive that collapses on the lattice.
    fn leave_out(&mut self) {
        self.displacements.push(0.0);
        self.total += 1;
    }
}

/// The least `f32` that is no less.
fn rounded_up(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x {
        nearest.next_up()
    } else {
        nearest
    }
}

#[cfg(test)]
mod tests {
    use crate::compile::{Options, compile};
    use crate::scene::{Scene, Shape, read};
    use glam::DVec3;
    use gridel_core::Effects;

    fn scene(file: &str) -> Scene {
        read("speck.toml".as_ref(), file.into(), &Default::default())
            .unwrap()
            .scene
    }

    #[test]
    fn what_the_lattice_leaves_out_requires_nothing() {
        let ball = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 9";
        let speck = "kind = 'triangle'\nvertices = [[0, 0, 0], [1e-9, 0, 0], [0, 1e-9, 0]]
            colors = ['#ff0000', '#ff0000', '#ff0000']";
        let own = scene(&format!("[[object]]\n{speck}\n{ball}"));
        let mut part = scene(&format!(
            "[[part]]\nname = 'p'\n[[part.object]]\n{speck}\n[[instance]]\npart = 'p'\n{ball}"
        ));
        // As OBJ and glTF files can have it; TOML rejects faces without area.
        let Shape::Mesh { vertices, .. } = &mut part.parts[0].objects[0].shape else {
            panic!("a triangle is a mesh");
        };
        vertices.fill(DVec3::ZERO);
        for scene in [own, part] {
            let compiled = compile(&scene, &Options::default()).unwrap();
            let effects = compiled.blob.scene().unwrap().header().effects;
            assert!(!Effects(effects).contains(Effects::VERTEX_COLORS));
            assert_eq!(compiled.report.largest_displacement, 0.0);
        }
    }
}
