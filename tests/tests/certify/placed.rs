//! Primitives where instances place them, and the hits of a line on them.

use super::levels::stretch;
use super::numbers::{black, fraction, one, real};
use gridel_core::format::instance::{Instance, MATRIX_BITS};
use gridel_core::scene::Footprint;
use gridel_core::{Kind, Scene};
use gridel_host::shape::Solid;
use gridel_host::shape::exact::{
    Line, Real, Vector, along, cross, dot, minus, norm, scaled, unit, vector,
};

pub struct Placed {
    pub solid: Solid,
    pub primitive: u32,
    /// The number of its instance, which decides before the primitive; `None` comes before all.
    pub instance: Option<u32>,
    pub object: u32,
    /// The normals of a triangle's corners, as they are stored.
    pub normals: Option<[[i16; 2]; 3]>,
    /// The colors of a triangle's corners, as they are stored.
    pub colors: Option<[[u8; 4]; 3]>,
    /// The texture coordinates of a triangle's corners, as they are stored.
    pub coordinates: Option<[[i32; 2]; 3]>,
    /// In units of its part.
    pub bounds: Option<[[f64; 2]; 3]>,
    /// The placement of its part, if it belongs to one.
    pub map: Option<Map>,
}

/// A matrix, and the place that becomes the part's origin.
#[derive(Clone)]
pub struct Map {
    pub rows: [Vector; 3],
    pub center: Vector,
    /// The binary logarithm of its scale.
    pub stretch: i32,
    /// The instance's number in scene-file order.
    pub number: u32,
}

impl Map {
    pub fn of(instance: &Instance) -> Self {
        let down = MATRIX_BITS as i32 - i32::from(instance.exponent);
        Self {
            rows: instance.matrix.map(|row| row.map(|x| fraction(x, down))),
            center: instance.center.map(|x| fraction(x, 8)),
            stretch: stretch(instance),
            number: instance.number,
        }
    }

    pub fn line(&self, line: &Line) -> Line {
        let from_center = minus(&line.origin, &self.center);
        let turned = |v: &Vector| [0, 1, 2].map(|k| dot(&self.rows[k], v));
        Line {
            origin: turned(&from_center),
            slope: turned(&line.slope),
        }
    }

    /// Maps a vector by the transposed matrix.
    pub fn turned_back(&self, v: &Vector) -> Vector {
        let column = |k: usize| [0, 1, 2].map(|row: usize| self.rows[row][k].clone());
        [0, 1, 2].map(|k| dot(&column(k), v))
    }

    /// A normal of the part in the scene.
    pub fn normal(&self, normal: &Vector) -> Vector {
        unit(&self.turned_back(normal))
    }
}

impl Placed {
    /// The primitives of a scene or of a part, whose numbers begin with one.
    pub fn all(scene: &Scene<'_>, first: u32, whole: &Scene<'_>, map: Option<&Map>) -> Vec<Self> {
        let mut all = Vec::new();
        for kind in Kind::ALL {
            for slot in 0..scene.count(kind) {
                let geometry = scene.geometry(kind, slot).expect("a primitive");
                let bounds = scene.primitive_bounds(kind, slot);
                let primitive = first + scene.primitive(kind, slot as u32);
                let is_triangle = kind == Kind::Triangle;
                let corners = is_triangle.then_some(slot);
                all.push(Self {
                    solid: Solid::of(geometry),
                    primitive,
                    instance: map.map(|map| map.number),
                    object: whole.object(primitive),
                    normals: corners.and_then(|it| scene.corner_normals(it)),
                    colors: corners.and_then(|it| scene.corner_colors(it)),
                    coordinates: corners.and_then(|it| scene.corner_coordinates(it)),
                    bounds: bounds
                        .filter(|_| kind.is_bounded())
                        .map(|bounds| bounds.0.map(|side| side.map(f64::from))),
                    map: map.cloned(),
                });
            }
        }
        all
    }

    /// A line in its part; t stays.
    pub fn line(&self, line: &Line) -> Line {
        self.map
            .as_ref()
            .map_or_else(|| line.clone(), |map| map.line(line))
    }
}

pub struct Met<'e> {
    pub placed: &'e Placed,
    pub t: Real,
    pub point: Vector,
    pub normal: Vector,
    pub front: bool,
    pub object: u32,
    /// The footprint of a sample on the image there.
    pub footprint: Footprint,
}

/// The corners of a triangle as seen from a point, and the parts of the area that are opposite to them.
pub type Corners = ([Vector; 3], [Real; 3]);

impl Met<'_> {
    /// A vector on the side from which the ray came.
    pub fn turned(&self, v: &Vector) -> Vector {
        if self.front {
            v.clone()
        } else {
            v.each_ref().map(|x| -x)
        }
    }

    /// The corners of a triangle, as seen from the point in its part, and their parts of the area.
    pub fn corners(&self) -> Option<Corners> {
        let Solid::Triangle(corners) = &self.placed.solid else {
            return None;
        };
        let here = self.placed.line(&Line {
            origin: self.point.clone(),
            slope: black(),
        });
        let corners = corners.map(|corner| minus(&vector(corner.to_array()), &here.origin));
        let [a, b, c] = &corners;
        let whole = cross(&minus(b, a), &minus(c, a));
        let area = |p: &Vector, q: &Vector| dot(&cross(p, q), &whole) / dot(&whole, &whole);
        let areas = [area(b, c), area(c, a), area(a, b)];
        Some((corners, areas))
    }

    /// The interpolated normal on the side of the ray.
    pub fn smooth_normal(&self) -> Option<Vector> {
        let normals = self.placed.normals?;
        let (_, areas) = self.corners()?;
        let mut result = black();
        for (stored, area) in normals.into_iter().zip(areas) {
            // The rule is nearly length 1, by a step of Newton's from a line.
            let v = unfolded(stored).map(|x| fraction(x, 15));
            let square = dot(&v, &v);
            let root = fraction(2_128_961_606, 30) - fraction(1_114_232_640, 30) * &square;
            let step = real(1.5) - &square * &root * &root * real(0.5);
            result = along(&result, &area, &scaled(&v, &(root * step)));
        }
        let normal = unit(&result);
        let map = self.placed.map.as_ref();
        let normal = map.map_or(normal.clone(), |map| map.normal(&normal));
        Some(self.turned(&normal))
    }

    /// Returns the way out to the curved surface of a triangle; `None` if that does not lie above it.
    pub fn lift(&self) -> Option<Vector> {
        let normals = self.placed.normals?;
        let (corners, areas) = self.corners()?;
        let zero = || real(0.0);
        let mut way = black();
        for k in 0..3 {
            let normal = self.turned(&unit(&unfolded(normals[k]).map(|x| fraction(x, 0))));
            let depth = dot(&corners[k], &normal).max(zero());
            way = along(&way, &(depth * areas[k].clone().max(zero())), &normal);
        }
        if let Some(map) = &self.placed.map {
            let length = norm(&way);
            if length.is_zero() {
                return None;
            }
            let turned = map.turned_back(&scaled(&way, &(one() / &length)));
            let square = dot(&turned, &turned);
            way = scaled(&turned, &(length / square));
        }
        dot(&way, &self.turned(&self.normal))
            .is_positive()
            .then_some(way)
    }
}

/// The coordinates of a stored normal: a point of an octahedron whose lower half is folded out.
fn unfolded([x, y]: [i16; 2]) -> [i64; 3] {
    let (x, y) = (i64::from(x), i64::from(y));
    let largest = i64::from(gridel_core::geometry::smooth::LARGEST);
    let z = largest - x.abs() - y.abs();
    if z >= 0 {
        return [x, y, z];
    }
    let folded = |of: i64, other: i64| (largest - other.abs()) * if of < 0 { -1 } else { 1 };
    [folded(x, y), folded(y, x), z]
}
