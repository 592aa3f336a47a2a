//! Properties of lights other than plain points: an area, a falloff, a spot.

use glam::{DAffine3, DMat3, DVec3};

/// The form of a point light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightForm {
    pub shape: LightShape,
    /// True if a point falls off with the square of the distance, and has its color at a distance of 1 scene unit.
    pub falls_off: bool,
    /// The distance at which light ends, in scene units.
    pub range: Option<f64>,
    pub spot: Option<Spot>,
    /// True if a light with an area is visible. It gets an object, by
    /// [`Scene::with_emitters`](super::Scene::with_emitters).
    pub is_visible: bool,
    /// True if an object has the same surface. Light must start above it.
    pub is_surface: bool,
}

impl Default for LightForm {
    /// A point that falls off.
    fn default() -> Self {
        Self {
            shape: LightShape::Point,
            falls_off: true,
            range: None,
            spot: None,
            is_visible: false,
            is_surface: false,
        }
    }
}

/// The shape that shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// The position itself.
    Point,
    /// The position, which shines as a small surface does: to the side of its normal, by the cosine of the angle to it.
    Facet { normal: DVec3 },
    /// A sphere around the position.
    Sphere { radius: f64 },
    /// A rectangle with a corner at the position; it shines to the side of the cross product of its edges.
    Rectangle { edges: [DVec3; 2] },
    /// A triangle with a corner at the position; it shines to the side of the cross product of its edges.
    Triangle { edges: [DVec3; 2] },
    /// A disc around the position; it shines to the side of its normal.
    Disc { normal: DVec3, radius: f64 },
}

/// A cone to which light is limited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    pub direction: DVec3,
    /// Degrees from the direction to which the light is full, and at which it ends: 0 to 90.
    pub inner: f64,
    pub outer: f64,
}

impl Spot {
    /// The least angle at which a spot ends, in degrees. The cosine of a smaller one is so close to 1 that a step of
    /// `f32` there, 2^-24, changes the light by more than a percent.
    pub const LEAST_OUTER: f64 = 0.3;
}

/// The part of themselves by which lengths may differ that count as equal: more than a product of rotations rounds.
const EVEN: f64 = 1e-6;

/// Returns the geometric mean of a transform's scales.
pub(super) fn scale_of(by: &DAffine3) -> f64 {
    libm::cbrt(by.matrix3.determinant().abs())
}

/// A normal of a surface after a transform, of any length.
fn moved_normal(normal: DVec3, by: &DAffine3) -> DVec3 {
    let [x, y, z] = [by.matrix3.x_axis, by.matrix3.y_axis, by.matrix3.z_axis];
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    cofactors * normal * by.matrix3.determinant().signum()
}

/// Perpendicular vectors of length 1 in the plane of a disc, after a transform.
fn moved_plane(normal: DVec3, by: &DAffine3) -> [DVec3; 2] {
    let (a, b) = normal.normalize().any_orthonormal_pair();
    [a, b].map(|vector| by.transform_vector3(vector))
}

impl LightForm {
    /// The factor of a light's color after a transform of its scene, so that the scene looks as before: that of a point
    /// whose light falls off is what arrives at a distance of 1.
    pub(super) fn moved_brightness(&self, by: &DAffine3) -> f64 {
        match self.shape {
            LightShape::Point | LightShape::Facet { .. } if self.falls_off => {
                scale_of(by) * scale_of(by)
            }
            _ => 1.0,
        }
    }

    /// The name of a round light that a transform makes oval.
    pub(super) fn distorted(&self, by: &DAffine3) -> Option<&'static str> {
        let [x, y, z] = [by.matrix3.x_axis, by.matrix3.y_axis, by.matrix3.z_axis];
        let evenly = |a: DVec3, b: DVec3| {
            let (most, least) = (a.length().max(b.length()), a.length().min(b.length()));
            most - least <= EVEN * most && a.dot(b).abs() <= EVEN * most * most
        };
        match self.shape {
            LightShape::Sphere { .. } => {
                let is_round = evenly(x, y) && evenly(y, z) && evenly(z, x);
                (!is_round).then_some("sphere")
            }
            LightShape::Disc { normal, .. } => {
                let [a, b] = moved_plane(normal, by);
                (!evenly(a, b)).then_some("disc")
            }
            _ => None,
        }
    }

    /// Returns the form, moved by a transform that keeps it round. Ranges grow with the cube root of the volume.
    /// Surfaces keep the side to which they shine, in mirror images too.
    pub fn moved(&self, by: &DAffine3) -> Self {
        let scale = scale_of(by);
        let turned = |vector: DVec3| by.transform_vector3(vector);
        let spanning = |[first, second]: [DVec3; 2]| match by.matrix3.determinant() < 0.0 {
            true => [turned(second), turned(first)],
            false => [turned(first), turned(second)],
        };
        Self {
            shape: match self.shape {
                LightShape::Point => LightShape::Point,
                LightShape::Facet { normal } => LightShape::Facet {
                    normal: moved_normal(normal, by),
                },
                LightShape::Sphere { radius } => LightShape::Sphere {
                    radius: radius * scale,
                },
                LightShape::Rectangle { edges } => LightShape::Rectangle {
                    edges: spanning(edges),
                },
                LightShape::Triangle { edges } => LightShape::Triangle {
                    edges: spanning(edges),
                },
                LightShape::Disc { normal, radius } => LightShape::Disc {
                    normal: moved_normal(normal, by),
                    radius: radius * moved_plane(normal, by)[0].length(),
                },
            },
            range: self.range.map(|range| range * scale),
            spot: self.spot.map(|spot| Spot {
                direction: turned(spot.direction),
                ..spot
            }),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Spot;

    #[test]
    fn a_step_of_f32_changes_the_narrowest_spot_by_less_than_a_percent() {
        let change = |degrees: f64| {
            let width = 1.0 - libm::cos(degrees.to_radians());
            let step = f64::from(f32::EPSILON) / 2.0;
            1.0 - (1.0 - step / width).powi(2)
        };
        assert!(change(Spot::LEAST_OUTER) < 0.01);
        assert!(change(0.9 * Spot::LEAST_OUTER) > 0.01);
    }
}
