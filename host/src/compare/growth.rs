//! Comparison of structures as a scene grows: the same comparison on ever larger parts of it.
//!
//! A scene grows by single primitives, so its instances are copied.

use super::{CompareError, Options, Row, compare};
use crate::scene::{Instances, Scene, Shape};
use glam::DVec3;
use serde::Serialize;
use std::borrow::Cow;

/// The comparison at several sizes, the whole scene's last.
#[derive(Clone, Debug, Serialize)]
pub struct Growth {
    /// `flatten` where the comparison keeps instances, which are copied here.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instances: Option<Instances>,
    pub steps: Vec<Step>,
}

/// One size.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    pub primitives: usize,
    pub rows: Vec<Row>,
}

/// The smallest part that is compared.
const SMALLEST: usize = 100;

/// Compares structures on parts of a scene: the 100, 300, 1000 and so on primitives nearest to its
/// middle, and all of them. The compiler frames each part, so that it fills the picture.
///
/// # Errors
/// As [`compare`], or if the instances of the scene are too many to be copied.
pub fn growth(
    scene: &Scene,
    options: &Options<'_>,
    progress: &dyn Fn(&str),
) -> Result<Growth, CompareError> {
    let instances = (!scene.instances.is_empty()).then_some(Instances::Flatten);
    let scene = &*copied(scene)?;
    let nearest = by_distance(scene);
    let mut steps = Vec::new();
    for size in sizes(nearest.len()) {
        let part = part(scene, &nearest[..size]);
        let about = |what: &str| progress(&format!("{size} primitives: {what}"));
        let comparison = compare(&part, options, &about)?;
        steps.push(Step {
            primitives: size,
            rows: comparison.rows,
        });
    }
    Ok(Growth { instances, steps })
}

/// Returns the number of steps that [`growth`] reports.
///
/// # Errors
/// If the instances of the scene are too many to be copied.
pub fn growth_steps(scene: &Scene, options: &Options<'_>) -> Result<u64, CompareError> {
    let scene = &*copied(scene)?;
    Ok(sizes(by_distance(scene).len()).len() as u64 * options.steps())
}

/// The scene with objects in place of instances.
fn copied(scene: &Scene) -> Result<Cow<'_, Scene>, CompareError> {
    scene.flattened().map_err(CompareError::Growth)
}

/// About three sizes in every two powers of ten, and the whole.
fn sizes(whole: usize) -> Vec<usize> {
    let tens = std::iter::successors(Some(SMALLEST), |size| size.checked_mul(10));
    tens.flat_map(|size| [size, 3 * size])
        .take_while(|&size| size < whole)
        .chain([whole])
        .collect()
}

/// A primitive: its object, and its triangle where that is a mesh.
type Part = (usize, usize);

/// All primitives, those nearest to the middle of the scene first.
fn by_distance(scene: &Scene) -> Vec<Part> {
    let mut places: Vec<(Part, DVec3)> = Vec::new();
    for (number, object) in scene.objects.iter().enumerate() {
        if let Shape::Mesh {
            vertices,
            triangles,
        } = &object.shape
        {
            places.extend(triangles.iter().enumerate().map(|(index, corners)| {
                let corners = corners.map(|corner| vertices[corner as usize]);
                (
                    (number, index),
                    (corners[0] + corners[1] + corners[2]) / 3.0,
                )
            }));
        }
        let middle = object.shape.middle();
        places.extend(middle.map(|place| ((number, 0), place)));
    }
    let (low, high) = places.iter().fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(low, high), (_, place)| (low.min(*place), high.max(*place)),
    );
    let middle = low.midpoint(high);
    places.sort_by(|a, b| {
        let distance = |place: &(Part, DVec3)| place.1.distance_squared(middle);
        distance(a).total_cmp(&distance(b)).then(a.0.cmp(&b.0))
    });
    places.into_iter().map(|(part, _)| part).collect()
}

/// The scene with some of its primitives, in scene-file order, and without its camera.
fn part(scene: &Scene, primitives: &[Part]) -> Scene {
    let mut primitives = primitives.to_vec();
    primitives.sort_unstable();
    let objects = primitives.chunk_by(|a, b| a.0 == b.0).map(|same| {
        let object = &scene.objects[same[0].0];
        let mut taken = object.clone();
        if let Shape::Mesh { triangles, .. } = &mut taken.shape {
            // All that an object has for each triangle.
            let (normals, coordinates) = (&mut taken.normals, &mut taken.attributes);
            for of_triangles in [
                triangles,
                &mut normals.triangles,
                &mut coordinates.triangles,
            ] {
                // An object without normals or coordinates has an empty list.
                if !of_triangles.is_empty() {
                    *of_triangles = same.iter().map(|&(_, index)| of_triangles[index]).collect();
                }
            }
        }
        taken
    });
    Scene {
        camera: None,
        objects: objects.collect(),
        environment: scene.environment.clone(),
        lights: scene.lights.clone(),
        materials: scene.materials.clone(),
        light_names: Vec::new(),
        light_forms: scene.light_forms.clone(),
        places: scene.places.clone(),
        tracks: Vec::new(),
        parts: Vec::new(),
        instances: Vec::new(),
        joints: Vec::new(),
        morph_targets: scene.morph_targets.clone(),
        ..*scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Object;
    use crate::shape::Sphere;

    #[test]
    fn sizes_end_with_the_whole() {
        assert_eq!(sizes(7), [7]);
        assert_eq!(sizes(100), [100]);
        assert_eq!(sizes(2833), [100, 300, 1000, 2833]);
        assert_eq!(
            sizes(300_000),
            [100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000]
        );
    }

    #[test]
    fn parts_are_the_nearest_primitives() {
        let whole = crate::sample::diamond(8.0);
        let nearest = by_distance(&whole);
        assert_eq!(nearest.len(), whole.objects.len());
        let some = part(&whole, &nearest[..40]);
        assert_eq!(some.objects.len(), 40);
        let center = |object: &Object| match object.shape {
            Shape::Sphere(Sphere { center, .. }) => center.length(),
            _ => panic!("a diamond is made of spheres"),
        };
        let farthest = some.objects.iter().map(center).fold(0.0, f64::max);
        let nearer = whole
            .objects
            .iter()
            .filter(|object| center(object) < farthest - 1e-9);
        assert!(nearer.count() <= 40);
    }

    /// A part of a mesh takes along what its triangles have: normals and texture coordinates.
    #[test]
    fn parts_of_meshes_keep_normals_and_coordinates_of_their_triangles() {
        let text = shaded_strip();
        let whole = crate::scene::read("a.obj".as_ref(), text.into(), &Default::default());
        let mut whole = whole.expect("a scene").scene;
        let mesh = &mut whole.objects[0];
        assert_eq!(mesh.normals.triangles.len(), 140);
        // Without a texture an importer drops coordinates.
        let coordinates = (0..140).map(|triangle| [0, 1, triangle % 3]);
        mesh.attributes.coordinates = vec![glam::DVec2::ZERO, glam::DVec2::X, glam::DVec2::Y];
        mesh.attributes.triangles = coordinates.collect();
        let some = part(&whole, &[(0, 139), (0, 7)]);
        let (some, mesh) = (&some.objects[0], &whole.objects[0]);
        let taken = |of_triangles: &[[u32; 3]]| [7, 139].map(|index: usize| of_triangles[index]);
        assert_eq!(some.normals.triangles, taken(&mesh.normals.triangles));
        assert_eq!(some.attributes.triangles, taken(&mesh.attributes.triangles));
        let options = Options {
            structures: vec![gridel_core::Structure::Bvh],
            size: [8, 6],
            repeats: 0,
            ..Options::default()
        };
        let growth = growth(&whole, &options, &|_| ()).expect("parts that compile");
        let sizes = growth.steps.iter().map(|step| step.primitives);
        assert_eq!(sizes.collect::<Vec<_>>(), [100, 140]);
    }

    /// A bent strip of 140 triangles with normals and texture coordinates.
    fn shaded_strip() -> String {
        use std::fmt::Write;
        let mut text = String::new();
        for place in 0..71 {
            let (x, z) = (f64::from(place), 0.01 * f64::from(place * place));
            for y in [0, 1] {
                let slope = -0.02 * x;
                let _ = writeln!(text, "v {x} {y} {z}\nvt {} {y}\nvn {slope} 0 1", x / 70.0);
            }
        }
        for place in 0..70 {
            let [a, b, c, d] = [1, 3, 4, 2].map(|corner| 2 * place + corner);
            for [a, b, c] in [[a, b, c], [a, c, d]] {
                let _ = writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}");
            }
        }
        text
    }
}
