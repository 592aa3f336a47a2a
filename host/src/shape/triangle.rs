//! Triangles. As scene files have them they are parts of meshes, which share vertices; here is the geometry of one.

use super::analytic::{Geometric, Normal, Surface};
use super::crossing::{flat_span, plane_crossing, within_plane};
use super::exact::{Line, Real, Vector, cross, dot, minus, unit, vector};
use crate::random::Random;
use glam::DVec3;

/// The corners, counter-clockwise as seen from the front.
pub type Triangle = [DVec3; 3];

fn normal([a, b, c]: &[Vector; 3]) -> Vector {
    unit(&cross(&minus(b, a), &minus(c, a)))
}

impl Geometric for Triangle {
    fn is_flat(&self) -> bool {
        true
    }

    fn ends(&self) -> [(DVec3, f64); 2] {
        let [a, b, c] = *self;
        [(a.min(b).min(c), 0.0), (a.max(b).max(c), 0.0)]
    }

    fn surface(&self) -> Surface {
        let [a, b, c] = *self;
        Surface::Plane {
            normal: (b - a).cross(c - a),
            point: a,
        }
    }

    fn feature(&self) -> Option<f64> {
        None
    }

    fn point(&self, _: DVec3, random: &mut Random) -> DVec3 {
        let [a, b, c] = *self;
        let (u, v) = (random.unit(), random.unit());
        let (u, v) = if u + v > 1.0 {
            (1.0 - u, 1.0 - v)
        } else {
            (u, v)
        };
        a + u * (b - a) + v * (c - a)
    }

    fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)> {
        let corners = self.map(vector);
        let normal = normal(&corners);
        let [a, b, c] = &corners;
        let span = match plane_crossing(line, &normal, a) {
            Some((t, tilt)) => {
                let point = line.at(&t);
                let [u, v, w] = [(a, b), (b, c), (c, a)].map(|(from, to)| {
                    let edge = unit(&minus(to, from));
                    dot(&cross(&normal, &edge), &minus(&point, from))
                });
                flat_span(t, u.min(v).min(w), &tilt, line, grow)
            }
            None => within_plane(line, &normal, a, grow),
        };
        span.into_iter().collect()
    }

    fn excess(&self, point: [f64; 3]) -> f64 {
        let corners = self.map(vector);
        let apart = minus(&vector(point), &corners[0]);
        dot(&normal(&corners), &apart).abs().to_f64()
    }

    fn normals(&self, _: [f64; 3]) -> Vec<Normal> {
        vec![Normal::flat(normal(&self.map(vector)))]
    }
}
