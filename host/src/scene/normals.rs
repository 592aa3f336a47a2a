//! Normals that a mesh is shaded with: those of its file, or computed from its faces.

use super::morph::{Displacements, NormalChanges};
use crate::shape::transform::to_size_one;
use crate::shape::unit;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::collections::HashMap;
use std::str::FromStr;

/// The normals that a mesh is shaded with, for each corner of each triangle; empty for those of its faces.
///
/// ```
/// use glam::DVec3;
/// use gridel_host::scene::Normals;
///
/// let roof = [DVec3::Y, DVec3::Z, -DVec3::Z, DVec3::new(4.0, 1.0, 0.0)];
/// let triangles = [[0, 1, 3], [0, 3, 2]];
/// assert!(Normals::computed(&roof, &triangles, 60.0).is_flat());
/// assert!(!Normals::computed(&roof, &triangles, 120.0).is_flat());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Normals {
    /// Normals of length 1.
    pub vectors: Vec<DVec3>,
    /// For each triangle, which of the vectors its corners have; [`Normals::FLAT`] for one that is flat. As many as the
    /// mesh has, or none.
    pub triangles: Vec<[u32; 3]>,
    /// Changes of the vectors by morph targets, at most one for each target.
    pub changes: Vec<NormalChanges>,
}

/// The normals with which meshes are shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NormalsChoice {
    /// The normals of the file, if it has some.
    #[default]
    File,
    /// The normals of the faces.
    Flat,
    /// Computed ones, smooth where faces meet at less than this angle in degrees.
    Smooth(f64),
}

impl FromStr for NormalsChoice {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let degrees = |text: &str| text.parse().ok().filter(|it| (0.0..=180.0).contains(it));
        match (text, text.strip_prefix("smooth=").and_then(degrees)) {
            ("file", _) => Ok(Self::File),
            ("flat", _) => Ok(Self::Flat),
            (_, Some(degrees)) => Ok(Self::Smooth(degrees)),
            _ => Err(
                "write file, flat, or smooth= and an angle from 0 to 180 degrees, such as smooth=40",
            ),
        }
    }
}

/// Largest angle in radians at which a normal of a file counts as that of its face: less than a step of a display.
const SAME: f64 = 1.0 / 1024.0;

impl Normals {
    /// Stands for the normals of a triangle's corners that has none but its own.
    pub const FLAT: [u32; 3] = [u32::MAX; 3];

    /// Returns whether all triangles are shaded with their own normals.
    pub fn is_flat(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Returns the normals of a file: of any length, turned to the front of their triangles. A triangle is flat where a
    /// normal is zero or not finite, or all are those of its face.
    pub fn given(
        vectors: Vec<DVec3>,
        corners: Vec<[u32; 3]>,
        mesh: (&[DVec3], &[[u32; 3]]),
    ) -> Self {
        Self::kept(vectors, corners, mesh, false)
    }

    /// Like [`given`](Self::given); a mesh that `moves` keeps normals that are those of the face at rest.
    pub(super) fn kept(
        vectors: Vec<DVec3>,
        mut corners: Vec<[u32; 3]>,
        (vertices, triangles): (&[DVec3], &[[u32; 3]]),
        moves: bool,
    ) -> Self {
        let mut vectors: Vec<DVec3> = vectors.into_iter().map(length_one).collect();
        let (count, mut opposite) = (vectors.len(), HashMap::new());
        for (normals, triangle) in corners.iter_mut().zip(triangles) {
            let found = normals.map(|it| vectors.get(it as usize).copied().unwrap_or(DVec3::ZERO));
            let face = face_normal(vertices, triangle);
            let are = |normal: DVec3| found.iter().all(|it| (*it - normal).length() <= SAME);
            let is_face = !moves && (are(face) || are(-face));
            if is_face || found.contains(&DVec3::ZERO) || face == DVec3::ZERO {
                *normals = Self::FLAT;
            } else if found.iter().all(|it| it.dot(face) < 0.0) {
                // Wound the other way round.
                for it in normals {
                    *it = *opposite.entry(*it).or_insert_with(|| {
                        vectors.push(-vectors[*it as usize]);
                        vectors.len() as u32 - 1
                    });
                }
            }
        }
        debug_assert!(vectors.len() <= 2 * count);
        Self::unless_flat(vectors, corners)
    }

    /// Computes normals that are smooth across edges where two faces meet at less than `degrees`. The normal at a
    /// vertex is the mean of such faces, weighted by their angles there. Vertices are the same where their coordinates
    /// are.
    pub fn computed(vertices: &[DVec3], triangles: &[[u32; 3]], degrees: f64) -> Self {
        Self::computed_for((vertices, triangles), degrees, &[])
    }

    /// Like [`computed`](Self::computed), for a mesh that morph targets displace. A triangle is flat that has the normal
    /// of its face in all poses.
    pub(super) fn computed_for(
        (vertices, triangles): (&[DVec3], &[[u32; 3]]),
        degrees: f64,
        displacements: &[Displacements],
    ) -> Self {
        if degrees <= 0.0 {
            return Self::default();
        }
        let places = same_places(vertices);
        let faces: Vec<DVec3> = triangles
            .iter()
            .map(|it| face_normal(vertices, it))
            .collect();
        let least_cosine = libm::cos(degrees.clamp(0.0, 180.0).to_radians());
        let corner = |triangle: usize, corner: usize| places[triangles[triangle][corner] as usize];
        // Groups of corners: of one vertex and joined across smooth edges.
        let mut groups = Groups::new(3 * triangles.len());
        for edge in shared_edges(triangles, &places) {
            let [(a, p), (b, q)] = edge;
            if faces[a].dot(faces[b]) > least_cosine || faces[a] == faces[b] {
                // They run along the edge in opposite directions.
                groups.join(3 * a + p, 3 * b + (q + 1) % 3);
                groups.join(3 * a + (p + 1) % 3, 3 * b + q);
            }
        }
        let mut sums = vec![DVec3::ZERO; 3 * triangles.len()];
        for (number, face) in faces.iter().enumerate() {
            for place in 0..3 {
                let at = |k: usize| vertices[corner(number, (place + k) % 3) as usize];
                let group = groups.of(3 * number + place);
                sums[group] += *face * angle(at(1) - at(0), at(2) - at(0));
            }
        }
        let mut numbers = vec![u32::MAX; sums.len()];
        let mut vectors = Vec::new();
        let mut corners = Vec::with_capacity(triangles.len());
        for number in 0..triangles.len() {
            corners.push([0, 1, 2].map(|place| {
                let group = groups.of(3 * number + place);
                if numbers[group] == u32::MAX {
                    numbers[group] = vectors.len() as u32;
                    vectors.push(sums[group]);
                }
                numbers[group]
            }));
        }
        let moves = !displacements.is_empty();
        let mut normals = Self::kept(vectors, corners, (vertices, triangles), moves);
        if moves {
            normals.flatten_faces((vertices, triangles), displacements);
        }
        normals
    }

    /// The normals after a transform of the mesh.
    #[must_use]
    pub(crate) fn transformed(&self, by: &DAffine3) -> Self {
        let (cofactors, mirrored) = cofactors(by.matrix3);
        let wind = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
        let turned: Vec<DVec3> = self
            .vectors
            .iter()
            .map(|it| length_one(cofactors * *it))
            .collect();
        let lost = |corners: &[u32; 3]| {
            let normal = |it: &u32| turned.get(*it as usize).is_none_or(|it| *it == DVec3::ZERO);
            corners.iter().any(normal)
        };
        let corners = self.triangles.iter().map(wind);
        let corners = corners
            .map(|it| if lost(&it) { Self::FLAT } else { it })
            .collect();
        let mut all = Self::unless_flat(turned, corners);
        if !all.is_flat() {
            let change = |(normal, change): (&DVec3, &DVec3)| {
                let length = (cofactors * *normal).length();
                match length > 0.0 {
                    true => cofactors * *change / length,
                    false => DVec3::ZERO,
                }
            };
            let changes = self.changes.iter().map(|it| NormalChanges {
                target: it.target,
                vectors: self.vectors.iter().zip(&it.vectors).map(change).collect(),
            });
            all.changes = changes.collect();
        }
        all
    }

    /// Makes triangles flat whose normals turn as their faces do. A flat one has the normal of its face at all weights;
    /// a smooth one has an interpolated normal between them.
    fn flatten_faces(
        &mut self,
        (vertices, triangles): (&[DVec3], &[[u32; 3]]),
        displacements: &[Displacements],
    ) {
        let mut left: Vec<usize> = (0..self.triangles.len()).collect();
        left.retain(|&number| self.triangles[number] != Self::FLAT);
        for pose in poses(displacements.len()) {
            if left.is_empty() {
                return;
            }
            let displaced = |(number, vertex): (usize, &DVec3)| {
                let all = displacements.iter().zip(&pose);
                all.fold(*vertex, |sum, (it, weight)| {
                    sum + *weight * it.vectors[number]
                })
            };
            let moved: Vec<DVec3> = vertices.iter().enumerate().map(displaced).collect();
            let means = self.means(&moved, triangles);
            left.retain(|&number| {
                let face = face_normal(&moved, &triangles[number]);
                let mut normals = self.triangles[number].iter().map(|it| means[*it as usize]);
                face == DVec3::ZERO || normals.all(|it| (it - face).length() <= SAME)
            });
        }
        for number in left {
            self.triangles[number] = Self::FLAT;
        }
        if self.triangles.iter().all(|it| *it == Self::FLAT) {
            *self = Self::default();
        }
    }

    /// Computes how the normals change where vertices are displaced: they turn with the mean of the faces around.
    pub(super) fn turn_with(
        &mut self,
        (vertices, triangles): (&[DVec3], &[[u32; 3]]),
        displacements: &[Displacements],
    ) {
        if self.is_flat() || displacements.is_empty() {
            return;
        }
        let rest = self.means(vertices, triangles);
        let changes = displacements
            .iter()
            .map(|Displacements { target, vectors }| {
                let displaced: Vec<_> =
                    vertices.iter().zip(vectors).map(|(a, b)| *a + *b).collect();
                let means = self.means(&displaced, triangles);
                let turned = |(number, normal): (usize, &DVec3)| {
                    let [from, to] = [rest[number], means[number]];
                    let has_both = from != DVec3::ZERO && to != DVec3::ZERO;
                    let turned = has_both.then(|| DQuat::from_rotation_arc(from, to) * *normal);
                    turned.map_or(DVec3::ZERO, |turned| turned - *normal)
                };
                NormalChanges {
                    target: *target,
                    vectors: self.vectors.iter().enumerate().map(turned).collect(),
                }
            });
        let changes: Vec<_> = changes.collect();
        let known = |it: &NormalChanges| self.changes.iter().any(|own| own.target == it.target);
        let missing: Vec<_> = changes.into_iter().filter(|it| !known(it)).collect();
        self.changes.extend(missing);
    }

    /// For each normal, the mean of the faces that have it, weighted by their angles; zero where there is none.
    fn means(&self, vertices: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.vectors.len()];
        for (normals, triangle) in self.triangles.iter().zip(triangles) {
            let face = face_normal(vertices, triangle);
            for (place, &normal) in normals.iter().enumerate() {
                let at = |k: usize| vertices[triangle[(place + k) % 3] as usize];
                if let Some(sum) = sums.get_mut(normal as usize) {
                    *sum += face * angle(at(1) - at(0), at(2) - at(0));
                }
            }
        }
        sums.into_iter().map(length_one).collect()
    }

    fn unless_flat(vectors: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Self {
        if triangles.iter().all(|it| *it == Self::FLAT) {
            return Self::default();
        }
        Self {
            vectors,
            triangles,
            changes: Vec::new(),
        }
    }
}

/// Returns the poses in which faces are compared: that at rest, one for each of some displacements, and two of all
/// together. Each is a weight for each displacement. Faces that are parallel in a pose of no special weights are so in
/// all: the angle between them follows polynomials of the weights.
fn poses(count: usize) -> impl Iterator<Item = Vec<f64>> {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let alone = (0..count).map(move |one| {
        let weights = (0..count).map(|it| f64::from(u8::from(it == one)));
        weights.collect()
    });
    let together = [1.0, -1.0].map(|sign| {
        let weights = (1..=count).map(|it| sign * (0.25 + (it as f64 * GOLDEN).fract()));
        weights.collect()
    });
    std::iter::once(vec![0.0; count])
        .chain(alone)
        .chain(together)
}

/// Returns the matrix that turns normals where `matrix` moves points, and whether that mirrors. Outward stays outward.
/// The matrix is the inverse transposed, times the magnitude of the determinant.
pub(super) fn cofactors(matrix: DMat3) -> (DMat3, bool) {
    let DMat3 {
        x_axis: x,
        y_axis: y,
        z_axis: z,
    } = to_size_one(matrix).1;
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let mirrors = cofactors.x_axis.dot(x) < 0.0;
    let sign = if mirrors { -1.0 } else { 1.0 };
    (cofactors * sign, mirrors)
}

/// Returns the vector at length 1, or zero where it has no direction.
fn length_one(vector: DVec3) -> DVec3 {
    if vector == DVec3::ZERO || !vector.is_finite() {
        return DVec3::ZERO;
    }
    unit(vector)
}

/// The normal of a triangle, of length 1; zero without an area.
fn face_normal(vertices: &[DVec3], triangle: &[u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|vertex| vertices[vertex as usize]);
    let (p, q) = (length_one(b - a), length_one(c - a));
    length_one(p.cross(q))
}

/// The angle between two vectors.
fn angle(a: DVec3, b: DVec3) -> f64 {
    let (a, b) = (length_one(a), length_one(b));
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// For each vertex, the first one with its coordinates.
fn same_places(vertices: &[DVec3]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(vertices.len());
    let numbered = (0..).zip(vertices);
    numbered
        .map(|(number, vertex)| {
            // Zero has two signs.
            let bits = vertex.to_array().map(|x| (x + 0.0).to_bits());
            *first.entry(bits).or_insert(number)
        })
        .collect()
}

/// A side of a triangle: the triangle, and the corner that it begins at.
type Side = (usize, usize);

/// The edges at which exactly two triangles meet that run along it in opposite directions: both, side by side.
fn shared_edges(triangles: &[[u32; 3]], places: &[u32]) -> Vec<[Side; 2]> {
    let mut sides: Vec<([u32; 2], bool, Side)> = Vec::with_capacity(3 * triangles.len());
    for (number, triangle) in triangles.iter().enumerate() {
        for corner in 0..3 {
            let [from, to] = [corner, (corner + 1) % 3].map(|it| places[triangle[it] as usize]);
            let ends = [from.min(to), from.max(to)];
            sides.push((ends, from < to, (number, corner)));
        }
    }
    sides.sort_unstable();
    let edges = sides.chunk_by(|a, b| a.0 == b.0);
    let pairs = edges.filter_map(|sides| match sides {
        [first, second] if first.1 != second.1 => Some([first.2, second.2]),
        _ => None,
    });
    pairs.collect()
}

/// Corners that share a normal.
struct Groups {
    /// For each corner another one of its group, or itself.
    leads_to: Vec<u32>,
}

impl Groups {
    fn new(corners: usize) -> Self {
        Self {
            leads_to: (0..corners as u32).collect(),
        }
    }

    /// Returns the first corner of a corner's group, which represents it.
    fn of(&mut self, corner: usize) -> usize {
        let mut corner = corner;
        while self.leads_to[corner] as usize != corner {
            let next = self.leads_to[corner] as usize;
            self.leads_to[corner] = self.leads_to[next];
            corner = next;
        }
        corner
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.leads_to[a.max(b)] = a.min(b) as u32;
    }
}

#[cfg(test)]
mod tests;
