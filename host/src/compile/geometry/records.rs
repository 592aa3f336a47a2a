//! Records of all shapes, each kind in scene-file order.

use crate::compile::section::{Section, section, three_bytes};
use crate::shape::{self, Analytic, Lattice, Shape, SnappedSphere, Solid};
use gridel_core::format::SectionKind;
use gridel_core::format::record::{Sphere16, Sphere24, UnitBox, Vertex16};
use gridel_core::geometry::Geometry;
use gridel_core::{Kind, geometry};

/// The result of adding a shape.
pub struct Added {
    pub kind: Kind,
    /// Largest distance between the given and the snapped surface, in 1/256 unit.
    pub displacement: f64,
    /// True if its box lies in the range of box coordinates.
    pub fits: bool,
}

macro_rules! registry {
    (
        forms { $($form:tt)* }
        records { $(
            $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal,
            [$field:ident: $module:ident::$record:ident], [$section:ident = $id:literal, $section_name:literal];
        )* }
    ) => {
        /// Records of all shapes, each kind in scene-file order.
        #[derive(Debug, Default)]
        pub struct Records {
            pub spheres: Vec<SnappedSphere>,
            $(pub $field: Vec<geometry::$module::$record>,)*
        }

        impl Records {
            /// Snaps a shape that is no mesh; `None` if the lattice leaves nothing of it.
            pub fn add(&mut self, shape: &Shape, lattice: &Lattice) -> Option<Added> {
                match shape {
                    Shape::Mesh { .. } => None,
                    Shape::Sphere(it) => add(Kind::Sphere, it, lattice, &mut self.spheres),
                    $(Shape::$kind(it) => add(Kind::$kind, it, lattice, &mut self.$field),)*
                }
            }

            pub fn count(&self, kind: Kind) -> usize {
                match kind {
                    Kind::Triangle => 0,
                    Kind::Sphere => self.spheres.len(),
                    $(Kind::$kind => self.$field.len(),)*
                }
            }

            /// Returns a primitive in units; `None` for a triangle.
            pub fn solid(&self, kind: Kind, index: usize) -> Option<Solid> {
                Some(Solid::of(match kind {
                    Kind::Triangle => return None,
                    Kind::Sphere => {
                        let SnappedSphere { center, radius } = self.spheres[index];
                        Geometry::Sphere { center, radius }
                    }
                    $(Kind::$kind => Geometry::$kind(self.$field[index]),)*
                }))
            }

            /// Returns the box of a primitive; an empty one for a triangle.
            pub fn bounds(&self, kind: Kind, index: usize) -> UnitBox {
                match kind {
                    Kind::Triangle => UnitBox([[0; 2]; 3]),
                    Kind::Sphere => shape::Sphere::record_bounds(&self.spheres[index]),
                    $(Kind::$kind => shape::$record::record_bounds(&self.$field[index]),)*
                }
            }

            /// Returns the sections of all kinds, each in the order of its slots.
            pub fn sections(&self, bits: u8, slots: &[Vec<u32>]) -> Vec<Section> {
                let slots = |kind: Kind| &slots[kind as usize][..];
                vec![
                    spheres(bits, &in_order(&self.spheres, slots(Kind::Sphere))),
                    $(section(
                        SectionKind::$section,
                        &in_order(&self.$field, slots(Kind::$kind)),
                    ),)*
                ]
            }
        }
    };
}

gridel_core::shapes!(registry);

fn add<S: Analytic>(
    kind: Kind,
    shape: &S,
    lattice: &Lattice,
    records: &mut Vec<S::Record>,
) -> Option<Added> {
    let snapped = shape.snapped(lattice)?;
    records.push(snapped.record);
    Some(Added {
        kind,
        displacement: snapped.displacement,
        fits: snapped.fits,
    })
}

pub fn in_order<T: Copy>(records: &[T], slots: &[u32]) -> Vec<T> {
    slots.iter().map(|&index| records[index as usize]).collect()
}

/// Returns spheres in the narrowest form that a lattice of this many bits allows.
fn spheres(bits: u8, spheres: &[SnappedSphere]) -> Section {
    if bits <= 16 {
        let narrow = spheres.iter().map(|sphere| Sphere16 {
            center: Vertex16(sphere.center.map(|x| (x >> 8) as i16)),
            radius: (sphere.radius >> 8) as u16,
        });
        return section(SectionKind::Spheres, &narrow.collect::<Vec<_>>());
    }
    let three_bytes = |x: i32| three_bytes(x as u32);
    let wide = spheres.iter().map(|sphere| Sphere24 {
        center: sphere.center.map(three_bytes),
        radius: three_bytes(sphere.radius),
    });
    section(SectionKind::Spheres, &wide.collect::<Vec<_>>())
}
