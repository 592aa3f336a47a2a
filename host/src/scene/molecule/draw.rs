//! Atoms and bonds as spheres and cylinders.

use super::element::Element;
use super::parsed::Site;
use crate::scene::{Diffuse, Material, MoleculeStyle, Object, Shape, SourceSpan};
use crate::shape::{Cone, Sphere};
use std::collections::HashMap;

/// The size of balls in units of the van der Waals radius, and the radius of sticks in angstroms.
/// They are the defaults of the molecule viewer Jmol.
const BALL: f64 = 0.23;
const STICK: f64 = 0.15;

/// An atom with its name and place.
pub(crate) struct BoundingSphere {
    pub(crate) site: Site,
    pub(crate) name: String,
    pub(crate) place: SourceSpan,
}

/// Makes spheres of atoms, one object each, and then two half cylinders of each bond, in the
/// colors of the atoms at their ends. Materials are one for each element, in the order of their
/// first atom, named by its symbol. Their places are those of these atoms.
pub(crate) fn draw(
    balls: Vec<BoundingSphere>,
    style: MoleculeStyle,
    bonds: &[[u32; 2]],
) -> (Vec<Material>, Vec<Object>) {
    let mut materials = Vec::new();
    let mut index: HashMap<Element, usize> = HashMap::new();
    let of_ball: Vec<usize> = balls
        .iter()
        .map(|ball| {
            *index.entry(ball.site.element).or_insert_with(|| {
                materials.push(Material {
                    place: ball.place.clone(),
                    ..material(ball.site.element)
                });
                materials.len() - 1
            })
        })
        .collect();
    let scale = match style {
        MoleculeStyle::SpaceFilling => 1.0,
        MoleculeStyle::BallAndStick => BALL,
    };
    let mut sticks = Vec::with_capacity(2 * bonds.len());
    for &[a, b] in bonds {
        for [near, far] in [[a, b], [b, a]].map(|ends| ends.map(|end| end as usize)) {
            let [base, end] = [near, far].map(|end| balls[end].site.position);
            let apex = base.midpoint(end);
            if base != apex {
                sticks.push(Object {
                    name: format!("{} to {}", balls[near].name, balls[far].name),
                    material: of_ball[near],
                    shape: Shape::Cone(Cone {
                        base,
                        base_radius: STICK,
                        apex,
                        apex_radius: STICK,
                    }),
                    place: balls[near].place.clone(),
                    normals: Default::default(),
                    attributes: Default::default(),
                });
            }
        }
    }
    let mut objects: Vec<Object> = balls
        .into_iter()
        .zip(of_ball)
        .map(|(ball, material)| Object {
            name: ball.name,
            material,
            shape: Shape::Sphere(Sphere {
                center: ball.site.position,
                radius: scale * ball.site.element.van_der_waals(),
            }),
            place: ball.place,
            normals: Default::default(),
            attributes: Default::default(),
        })
        .collect();
    objects.extend(sticks);
    (materials, objects)
}

/// The element's color, with a small highlight that lets a sphere look round.
fn material(element: Element) -> Material {
    Material {
        name: element.symbol().to_owned(),
        diffuse: Diffuse::Plain(element.color()),
        highlight: [0.2; 3],
        shininess: 32,
        ..Material::default()
    }
}
