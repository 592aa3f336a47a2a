//! Scenes of NumPy's arrays.

use crate::arguments::invalid;
use glam::DVec3;
use gridel_host::scene::{self, Material, Object, Shape, SourceSpan};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

/// Vertices (n, 3) and faces (m, 3) of a mesh.
pub type Mesh<'py> = (PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, i64>);

/// A scene of meshes, each an object.
pub fn model(meshes: &[Mesh<'_>]) -> PyResult<scene::Scene> {
    let mut objects = Vec::new();
    for (number, (vertices, faces)) in meshes.iter().enumerate() {
        let rows = |values: &[f64]| -> Vec<DVec3> {
            let (rows, _) = values.as_chunks::<3>();
            rows.iter().map(|&row| DVec3::from_array(row)).collect()
        };
        let (vertices, faces) = (
            vertices.as_slice().map_err(invalid)?,
            faces.as_slice().map_err(invalid)?,
        );
        let vertices = rows(vertices);
        let (faces, _) = faces.as_chunks::<3>();
        if let Some(place) = vertices.iter().position(|vertex| !vertex.is_finite()) {
            return Err(invalid(format!(
                "mesh {number}: vertex {place} is not finite"
            )));
        }
        let count = vertices.len();
        let corner = |(place, face): (usize, &[i64; 3])| -> PyResult<[u32; 3]> {
            if face
                .iter()
                .any(|&corner| corner < 0 || corner >= count as i64)
            {
                return Err(invalid(format!(
                    "mesh {number}: face {place} is {face:?}; vertices are numbered 0 to {}",
                    count as i64 - 1
                )));
            }
            Ok(face.map(|corner| corner as u32))
        };
        let triangles = faces
            .iter()
            .enumerate()
            .map(corner)
            .collect::<PyResult<Vec<_>>>()?;
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
