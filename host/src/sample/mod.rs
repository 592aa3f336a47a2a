//! Sample scenes that are computed, not copied: molecules of carbon from their bond lengths, and
//! a sphere of triangles. Each can be written as a file that the importers read back.

mod diamond;
mod fullerene;
mod icosphere;
mod nanotube;
mod obj;
mod pdb;

pub use diamond::{DIAMOND_2_800, DIAMOND_27_000, diamond};
pub use fullerene::c60;
pub use icosphere::icosphere;
pub use nanotube::nanotube;
pub use obj::obj;
pub use pdb::{PdbError, pdb};

use crate::scene::molecule::{BoundingSphere, Element, Site, draw, perceive};
use crate::scene::{Camera, Light, MoleculeStyle, Scene, SourceSpan};
use glam::DVec3;

/// A molecule of carbon atoms at positions in angstroms.
fn carbon(positions: Vec<DVec3>, style: MoleculeStyle) -> Scene {
    let sites: Vec<Site> = positions
        .iter()
        .map(|&position| Site {
            element: Element::CARBON,
            position,
        })
        .collect();
    let bonds = match style {
        MoleculeStyle::SpaceFilling => Vec::new(),
        MoleculeStyle::BallAndStick => perceive(&sites).0,
    };
    let balls = sites
        .into_iter()
        .zip(1..)
        .map(|(site, number)| BoundingSphere {
            site,
            name: format!("C{number}"),
            place: SourceSpan::default(),
        })
        .collect();
    let (materials, objects) = draw(balls, style, &bonds);
    lit(
        Scene {
            materials,
            objects,
            ..Scene::default()
        },
        &positions,
        Element::CARBON.van_der_waals(),
    )
}

/// Adds a camera that sees all points with a margin, and two lights. A surface that both of them
/// and the ambient light reach is display white.
fn lit(scene: Scene, points: &[DVec3], margin: f64) -> Scene {
    let low = points
        .iter()
        .fold(DVec3::INFINITY, |low, point| low.min(*point));
    let high = points
        .iter()
        .fold(DVec3::NEG_INFINITY, |high, point| high.max(*point));
    let target = low.midpoint(high);
    let radius = points
        .iter()
        .fold(0.0, |r: f64, point| r.max(point.distance(target)))
        + margin;
    let fov_degrees: f64 = 40.0;
    // From here the cone of view touches the sphere around everything.
    let distance = radius / libm::sin(fov_degrees.to_radians() / 2.0);
    let eye = target + distance * DVec3::new(0.5, -1.0, 0.4).normalize();
    Scene {
        camera: Some(Camera {
            eye,
            target,
            up: DVec3::Z,
            fov_degrees,
        }),
        background: Some([0.05, 0.06, 0.08]),
        ambient: [0.15; 3],
        lights: vec![
            Light::Directional {
                direction: DVec3::new(0.3, 1.0, -1.0),
                color: [0.65; 3],
            },
            Light::Directional {
                direction: DVec3::new(-1.0, 0.5, -0.2),
                color: [0.2; 3],
            },
        ],
        ..scene
    }
}

#[cfg(test)]
mod tests;
