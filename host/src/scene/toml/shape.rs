//! The kinds of objects that are shapes.

use super::value::{Fields, Value};
use crate::scene::polygon::{self, MAX_CONCAVE};
use crate::scene::{Attributes, SceneError, Shape};
use crate::shape::Keys;
use glam::{DVec2, DVec3};

/// The most vertices that a face may have; that they differ is checked in quadratic time.
const MAX_CORNERS: usize = 1024;
const _: () = assert!(MAX_CORNERS <= MAX_CONCAVE);

/// Returns the keys of a kind of shape, without those of every object.
pub(super) fn keys(kind: &str) -> &'static [&'static str] {
    match kind {
        "triangle" => &["vertices", "colors", "coordinates", "morph"],
        "mesh" => &[
            "vertices",
            "faces",
            "smooth",
            "colors",
            "coordinates",
            "morph",
        ],
        _ => Shape::kinds()
            .find(|(name, _)| *name == kind)
            .map_or(&[], |(_, keys)| keys),
    }
}

pub(super) fn read(kind: &str, fields: &Fields<'_>) -> Result<Shape, SceneError> {
    match kind {
        "triangle" => triangle(fields),
        _ => Shape::read(kind, fields).unwrap_or_else(|| mesh(fields)),
    }
}

/// The colors and texture coordinates of a mesh or triangle, one for each vertex.
pub(super) fn attributes(shape: &Shape, fields: &Fields<'_>) -> Result<Attributes, SceneError> {
    let Shape::Mesh {
        vertices,
        triangles,
    } = shape
    else {
        return Ok(Attributes::default());
    };
    let as_many = |list: Value<'_>, found: usize, what: &str| {
        if found == vertices.len() {
            return Ok(());
        }
        Err(list.error(
            format!("there are {found} {what} and {} vertices", vertices.len()),
            "write one for each vertex, in the same order",
        ))
    };
    let mut attributes = Attributes::default();
    if let Some(list) = fields.get("colors") {
        let colors = list.items("`colors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]`")?;
        attributes.colors = colors.map(Value::reflectance).collect::<Result<_, _>>()?;
        as_many(list, attributes.colors.len(), "colors")?;
    }
    if let Some(list) = fields.get("coordinates") {
        let pairs = list.items("`coordinates = [[0, 1], [1, 1], [0, 0]]`")?;
        attributes.coordinates = pairs.map(pair).collect::<Result<_, _>>()?;
        as_many(list, attributes.coordinates.len(), "texture coordinates")?;
        attributes.triangles.clone_from(triangles);
    }
    Ok(attributes)
}

/// Two numbers.
pub(super) fn pair(value: Value<'_>) -> Result<DVec2, SceneError> {
    let mistyped = || value.mistyped("two numbers", "`[0.5, 1]`");
    let numbers = value
        .items("two numbers, such as `[0.5, 1]`")
        .map_err(|_| mistyped())?;
    let numbers: Vec<f64> = numbers.map(Value::number).collect::<Result<_, _>>()?;
    match numbers[..] {
        [u, v] => Ok(DVec2::new(u, v)),
        _ => Err(mistyped()),
    }
}

impl Keys for Fields<'_> {
    type Error = SceneError;

    fn require(&self, key: &'static str) -> Result<(), SceneError> {
        self.require(key).map(|_| ())
    }

    fn point(&self, key: &'static str) -> Result<DVec3, SceneError> {
        self.require(key)?.vector()
    }

    fn direction(&self, key: &'static str) -> Result<DVec3, SceneError> {
        self.require(key)?.direction()
    }

    fn length(&self, key: &'static str) -> Result<f64, SceneError> {
        self.require(key)?.positive()
    }

    fn error(&self, key: &'static str, cause: String, remedy: &str) -> SceneError {
        let value = self.require(key);
        value.map_or_else(|missing| missing, |value| value.error(cause, remedy))
    }
}

fn triangle(fields: &Fields<'_>) -> Result<Shape, SceneError> {
    let value = fields.require("vertices")?;
    let vertices = vertices(value)?;
    if vertices.len() != 3 {
        return Err(value.mistyped(
            "three points",
            "`vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]`",
        ));
    }
    if !polygon::has_area(&vertices) && fields.get("morph").is_none() {
        return Err(value.error(
            "the triangle has no area: its vertices lie on one line",
            "move one of the vertices off that line",
        ));
    }
    Ok(Shape::Mesh {
        vertices,
        triangles: vec![[0, 1, 2]],
    })
}

fn mesh(fields: &Fields<'_>) -> Result<Shape, SceneError> {
    let vertices = vertices(fields.require("vertices")?)?;
    let faces = fields.require("faces")?;
    let mut triangles = Vec::new();
    for face in faces.items("`faces = [[0, 1, 2], [0, 2, 3]]`")? {
        let corners = corners(face, vertices.len())?;
        let points: Vec<DVec3> = corners
            .iter()
            .map(|&corner| vertices[corner as usize])
            .collect();
        // What has an area at other weights has none here, perhaps.
        if let ([a, b, c], Some(_)) = (&corners[..], fields.get("morph")) {
            triangles.push([*a, *b, *c]);
            continue;
        }
        if !polygon::has_area(&points) {
            return Err(face.error(
                "this face has no area",
                "remove the face, or move its vertices off their line",
            ));
        }
        // It has few enough vertices to be cut, in any shape.
        let cut = polygon::triangulate(&points).filter(|cut| cut.exact);
        let cut = cut.ok_or_else(|| {
            face.error(
                "the outline of this face crosses itself",
                "list its vertices in the order in which they follow around the face",
            )
        })?;
        let named = |triangle: [u32; 3]| triangle.map(|corner| corners[corner as usize]);
        triangles.extend(cut.triangles.into_iter().map(named));
    }
    if triangles.is_empty() {
        return Err(faces.error("this mesh has no face", "add faces, or remove the mesh"));
    }
    Ok(Shape::Mesh {
        vertices,
        triangles,
    })
}

fn vertices(value: Value<'_>) -> Result<Vec<DVec3>, SceneError> {
    let points = value.items("`vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]`")?;
    points.map(Value::vector).collect()
}

/// The indices of a face's vertices: in range, and all different.
fn corners(face: Value<'_>, vertices: usize) -> Result<Vec<u32>, SceneError> {
    let indices = face.items("`faces = [[0, 1, 2], [0, 2, 3]]`")?;
    let count = indices.len();
    if !(3..=MAX_CORNERS).contains(&count) {
        return Err(face.error(
            format!("this face has {count} vertices; it must have from 3 to {MAX_CORNERS}"),
            "list the indices of its vertices, or divide the face into smaller ones",
        ));
    }
    let mut corners = Vec::with_capacity(count);
    for value in indices {
        let index = value.integer_in(0..=u32::MAX)?;
        if index as usize >= vertices {
            return Err(value.error(
                format!("this face uses vertex {index}, but there are only {vertices} vertices"),
                "count the vertices from 0",
            ));
        }
        if corners.contains(&index) {
            return Err(value.error(
                format!("this face uses vertex {index} twice"),
                "list each vertex of a face once; the last joins the first by itself",
            ));
        }
        corners.push(index);
    }
    Ok(corners)
}
