//! Scenes of NumPy's arrays.

use crate::arguments::invalid;
use crate::hit_arrays::rows;
use glam::DVec3;
use gridel_host::scene::{self, Material, Object, Shape, SourceSpan};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

/// Vertices (n, 3) and faces (m, 3) of a mesh.
pub type Mesh<'py> = (PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, i64>);

/// Vertices and faces of a mesh, of a scene that was made of such.
pub type GivenMesh<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>);

/// The meshes of a scene.
pub fn given<'py>(py: Python<'py>, model: &scene::Scene) -> PyResult<Vec<GivenMesh<'py>>> {
    let meshes = model.objects.iter().filter_map(|object| {
        let Shape::Mesh {
            vertices,
            triangles,
        } = &object.shape
        else {
            return None;
        };
        let vertices = vertices.iter().map(DVec3::to_array).collect();
        let faces = triangles.iter().map(|face| face.map(i64::from)).collect();
        Some(rows(py, vertices).and_then(|vertices| Ok((vertices, rows(py, faces)?))))
    });
    meshes.collect()
}

/// Puts vertices of no triangle where the triangles are, so that they widen no scene.
fn gather(vertices: &mut Vec<DVec3>, triangles: &[[u32; 3]]) {
    let mut is_used = vec![false; vertices.len()];
    for &corner in triangles.as_flattened() {
        is_used[corner as usize] = true;
    }
    let Some(first) = is_used.iter().position(|&is_used| is_used) else {
        vertices.clear();
        return;
    };
    let place = vertices[first];
    for (vertex, is_used) in vertices.iter_mut().zip(is_used) {
        if !is_used {
            *vertex = place;
        }
    }
}

/// A scene of meshes, each an object. Vertices are finite, and faces name vertices.
pub fn model(meshes: &[Mesh<'_>]) -> PyResult<scene::Scene> {
    let mut objects = Vec::new();
    for (number, (vertices, faces)) in meshes.iter().enumerate() {
        let (vertices, faces) = (
            vertices.as_slice().map_err(invalid)?,
            faces.as_slice().map_err(invalid)?,
        );
        let (vertices, _) = vertices.as_chunks::<3>();
        let mut vertices: Vec<_> = vertices.iter().copied().map(DVec3::from_array).collect();
        let (faces, _) = faces.as_chunks::<3>();
        let triangles = faces.iter().map(|face| face.map(|corner| corner as u32));
        let triangles: Vec<_> = triangles.collect();
        gather(&mut vertices, &triangles);
        objects.push(Object {
            name: format!("mesh {number}"),
            material: 0,
            shape: Shape::Mesh {
                vertices,
                triangles,
            },
            place: SourceSpan::default(),
            normals: Default::default(),
            attributes: Default::default(),
        });
    }
    Ok(scene::Scene {
        materials: vec![Material::default()],
        objects,
        ..scene::Scene::default()
    })
}
