//! Checks that the indices by which a scene's items refer to each other are in range. Importers make only such scenes,
//! but programs can make others.

use super::error::CompileError;
use crate::scene::{
    Attributes, LARGEST_WEIGHT, MorphTarget, Normals, Object, Scene, Shape, TrackTarget,
};
use crate::table::printable;
use glam::DVec3;

/// Checks materials of objects, corners of meshes, and what tracks move. (`joints` checks joints.)
pub fn check(scene: &Scene) -> Result<(), CompileError> {
    for object in scene.all_objects() {
        if let Some(lost) = lost(object, scene) {
            return Err(CompileError::Reference {
                object: printable(&object.name),
                lost,
            });
        }
    }
    for MorphTarget {
        name,
        weight,
        range,
        ..
    } in &scene.morph_targets
    {
        if ![*weight, range[0], range[1]]
            .iter()
            .all(|it| it.abs() <= LARGEST_WEIGHT)
        {
            return Err(CompileError::Weight {
                target: printable(name),
            });
        }
    }
    for track in &scene.tracks {
        let target = track.target;
        let (what, count) = if target.is_of_material() {
            ("material", scene.materials.len())
        } else if target.is_of_light() {
            ("light", scene.lights.len())
        } else if target == TrackTarget::MorphWeight {
            ("morph target", scene.morph_targets.len())
        } else {
            ("", usize::MAX)
        };
        let cause = if track.keys.is_empty() {
            String::from("the track has no keys")
        } else if track.index >= count {
            format!("there is no {what} {}", track.index)
        } else {
            continue;
        };
        return Err(CompileError::Track {
            place: track.place.clone(),
            target: scene.target_of(track),
            cause,
            remedy: String::from("give at least one key, and the number of an item of the scene"),
        });
    }
    Ok(())
}

/// Returns what an object refers to and the scene lacks.
fn lost(object: &Object, scene: &Scene) -> Option<&'static str> {
    if object.material >= scene.materials.len() {
        return Some("a material");
    }
    let Shape::Mesh {
        vertices,
        triangles,
    } = &object.shape
    else {
        return None;
    };
    let Normals {
        vectors,
        triangles: normals,
        changes,
    } = &object.normals;
    let Attributes {
        colors,
        coordinates,
        triangles: placed,
        displacements,
    } = &object.attributes;
    let of_all = |of: &[[u32; 3]]| of.is_empty() || of.len() == triangles.len();
    if !holds(vertices.len(), triangles, None) {
        Some("a vertex")
    } else if !of_all(normals) || !holds(vectors.len(), normals, Some(Normals::FLAT)) {
        Some("a normal")
    } else if !colors.is_empty() && colors.len() < vertices.len() {
        Some("the color of a vertex")
    } else if !of_all(placed) || !holds(coordinates.len(), placed, Some(Attributes::NONE)) {
        Some("texture coordinates")
    } else if !displacements
        .iter()
        .all(|it| is_whole((it.target, &it.vectors), vertices.len(), scene))
        || !changes
            .iter()
            .all(|it| is_whole((it.target, &it.vectors), vectors.len(), scene))
    {
        Some("a finite displacement of a vertex, or a morph target")
    } else {
        None
    }
}

/// Returns true if the scene has the morph target, and it has `count` changes, all finite.
fn is_whole((target, changes): (usize, &[DVec3]), count: usize, scene: &Scene) -> bool {
    let finite = changes.iter().all(|it| it.is_finite());
    target < scene.morph_targets.len() && changes.len() == count && finite
}

/// Returns true if a list of this length has an item for all corners but those of triangles equal to `none`.
fn holds(length: usize, triangles: &[[u32; 3]], none: Option<[u32; 3]>) -> bool {
    let mut named = triangles.iter().filter(|&&it| Some(it) != none).flatten();
    named.all(|&corner| (corner as usize) < length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::scene::{Interpolation, Key, Material, Track, TrackTarget};
    use glam::{DVec2, DVec3};

    fn triangle() -> Scene {
        Scene {
            materials: vec![Material::default()],
            objects: vec![Object {
                name: String::from("sail"),
                material: 0,
                shape: Shape::Mesh {
                    vertices: vec![DVec3::X, DVec3::Y, DVec3::Z],
                    triangles: vec![[0, 1, 2]],
                },
                normals: Default::default(),
                attributes: Default::default(),
                place: Default::default(),
            }],
            ..Scene::default()
        }
    }

    #[test]
    fn scenes_that_name_what_they_lack_are_rejected() {
        let options = Options::default();
        let named = |change: &dyn Fn(&mut Object)| {
            let mut scene = triangle();
            change(&mut scene.objects[0]);
            compile(&scene, &options)
                .map(|_| ())
                .unwrap_err()
                .to_string()
        };
        assert!(compile(&triangle(), &options).is_ok());
        let mesh = |triangles: Vec<[u32; 3]>| Shape::Mesh {
            vertices: vec![DVec3::X, DVec3::Y, DVec3::Z],
            triangles,
        };
        assert!(named(&|it| it.material = 1).contains("sail names a material"));
        assert!(named(&|it| it.shape = mesh(vec![[0, 1, 3]])).contains("a vertex"));
        let short = Normals {
            vectors: vec![DVec3::X],
            triangles: vec![[0, 0, 1]],
            changes: Vec::new(),
        };
        assert!(named(&|it| it.normals = short.clone()).contains("a normal"));
        let colors = vec![[1.0; 3]; 2];
        assert!(named(&|it| it.attributes.colors = colors.clone()).contains("the color"));
        let placed = Attributes {
            coordinates: vec![DVec2::ZERO],
            triangles: vec![[0, 0, 1]],
            ..Attributes::default()
        };
        assert!(named(&|it| it.attributes = placed.clone()).contains("texture coordinates"));
    }

    #[test]
    fn tracks_of_what_is_not_there_are_rejected() {
        let cause = |target, index, keys: &[Key]| {
            let mut scene = triangle();
            scene.tracks.push(Track {
                target,
                index,
                interpolation: Interpolation::Step,
                keys: keys.to_vec(),
                place: Default::default(),
            });
            compile(&scene, &Options::default())
                .map(|_| ())
                .unwrap_err()
                .to_string()
        };
        let key = [Key::of_vector(0.0, DVec3::ONE)];
        assert!(cause(TrackTarget::LightColor, 0, &key).contains("no light 0"));
        assert!(cause(TrackTarget::MaterialDiffuse, 1, &key).contains("no material 1"));
        assert!(cause(TrackTarget::CameraEye, 0, &[]).contains("no keys"));
    }
}
