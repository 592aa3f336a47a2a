use super::*;
use crate::number::Fixed;

/// Directions all over the sphere, and those where the octahedron has edges.
fn directions() -> impl Iterator<Item = [f64; 3]> {
    let grid = (-7..=7).flat_map(|x| (-7..=7).flat_map(move |y| (-7..=7).map(move |z| [x, y, z])));
    grid.filter(|v| *v != [0; 3]).map(|v| v.map(f64::from))
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let apart = [0, 1, 2].map(|k| a[k] - b[k]);
    apart.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn decoded<N: Arithmetic>(stored: [i16; 2]) -> [f64; 3] {
    decode::<N>(stored).map(N::ratio_to_f64)
}

#[test]
fn stored_normals_are_near_in_all_formats() {
    for direction in directions() {
        let (stored, expected) = (encode(direction), unit(direction));
        assert!(stored.iter().all(|x| *x != i16::MIN));
        for found in [
            decoded::<f64>(stored),
            decoded::<f32>(stored),
            decoded::<Fixed>(stored),
        ] {
            assert!(angle(found, expected) < 8e-5, "{direction:?}: {found:?}");
        }
    }
}

#[test]
fn any_stored_words_are_normals() {
    for x in [i16::MIN, -32_767, -1, 0, 1, 16_384, i16::MAX] {
        for y in [i16::MIN, -32_767, -1, 0, 1, 16_384, i16::MAX] {
            let found = decoded::<Fixed>([x, y]);
            assert!(angle(found, [0.0; 3]) > 0.99, "{x} {y}");
        }
    }
    for zero in [[0.0; 3], [f64::NAN; 3], [f64::INFINITY, 0.0, 0.0]] {
        assert_eq!(encode(zero), [0, 0]);
    }
}

/// A triangle of a sphere around the origin, with a radius of this many units.
fn on_sphere(directions: [[f64; 3]; 3], radius: f64) -> SmoothTriangle {
    let corner = |v: [f64; 3]| unit(v).map(|x| (x * radius * 256.0).round() as i32);
    SmoothTriangle {
        corners: directions.map(corner),
        normals: directions.map(encode),
    }
}

const OCTANT: [[f64; 3]; 3] = [[1.0, 0.1, 0.2], [0.2, 1.0, 0.1], [0.1, 0.3, 1.0]];

/// A point of a triangle in units.
fn point(triangle: &SmoothTriangle, weights: [f64; 3]) -> [f64; 3] {
    let sum: f64 = weights.iter().sum();
    [0, 1, 2].map(|k| {
        let parts = (0..3).map(|c| weights[c] * f64::from(triangle.corners[c][k]));
        parts.sum::<f64>() / sum / 256.0
    })
}

fn facing(triangle: &SmoothTriangle) -> [f64; 3] {
    let [a, b, c] = triangle.corners.map(|corner| corner.map(f64::from));
    let (p, q) = (
        [0, 1, 2].map(|k| b[k] - a[k]),
        [0, 1, 2].map(|k| c[k] - a[k]),
    );
    unit([
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ])
}

fn weights() -> impl Iterator<Item = [f64; 3]> {
    let all = (0..=8).flat_map(|u| (0..=8 - u).map(move |v| [u, v, 8 - u - v]));
    all.map(|weights| weights.map(f64::from))
}

fn check_radial<N: Arithmetic>(scale: f64) {
    let triangle = on_sphere(OCTANT, scale);
    let facing = facing(&triangle);
    for weights in weights() {
        let place = point(&triangle, weights);
        let found = |facing: [f64; 3]| {
            let facing = facing.map(N::ratio_from_f64);
            let normal = triangle.normal::<N>(place.map(N::length_from_f64), facing);
            normal.expect("a normal").map(N::ratio_to_f64)
        };
        let outside = found(facing);
        assert!(
            angle(outside, unit(place)) < 2e-3,
            "{weights:?}: {outside:?}"
        );
        // From inside.
        let inside = found(facing.map(|x| -x));
        assert!(angle(inside, unit(place).map(|x| -x)) < 2e-3, "{inside:?}");
    }
}

/// The plane of a triangle of a sphere has the sphere's own normals. A corner is as far from the center as its normal
/// is long.
#[test]
fn normals_of_a_sphere_are_radial_in_all_formats() {
    for scale in [30.0, 2_000.0, 32_000.0] {
        check_radial::<f64>(scale);
        check_radial::<f32>(scale);
        check_radial::<Fixed>(scale);
    }
}

fn check_lift<N: Arithmetic>() {
    const RADIUS: f64 = 1_000.0;
    let triangle = on_sphere(OCTANT, RADIUS);
    let facing = facing(&triangle);
    for weights in weights() {
        let place = point(&triangle, weights);
        let lifted = |facing: [f64; 3]| {
            let facing = facing.map(N::ratio_from_f64);
            let way = triangle.lift::<N>(place.map(N::length_from_f64), facing);
            [0, 1, 2].map(|k| place[k] + way[k].length_to_f64())
        };
        let from_center = angle(lifted(facing), [0.0; 3]);
        assert!(from_center > RADIUS - 0.1, "{weights:?}: {from_center}");
        // Beneath a sphere the curved surface lies behind the triangle.
        let inside = facing.map(|x| -x);
        assert!(angle(lifted(inside), place) < 0.1);
    }
}

#[test]
fn lifted_points_lie_on_or_outside_of_the_sphere() {
    check_lift::<f64>();
    check_lift::<f32>();
    check_lift::<Fixed>();
}

#[test]
fn opposite_normals_cancel_out_and_are_no_normal() {
    let mut triangle = on_sphere(OCTANT, 100.0);
    triangle.normals = [[0, 0], [LARGEST, LARGEST], [0, 0]];
    let place = point(&triangle, [0.25, 0.5, 0.25]);
    let found = triangle.normal::<f64>(place, facing(&triangle));
    assert!(found.is_none_or(|normal| angle(normal, [0.0; 3]) > 0.99));
    let flat = SmoothTriangle {
        corners: [[5, 5, 5]; 3],
        ..triangle
    };
    assert_eq!(
        flat.normal::<Fixed>([Fixed::default(); 3], [Fixed::default(); 3]),
        None
    );
    assert_eq!(flat.lift::<f64>([0.0; 3], [0.0, 0.0, 1.0]), [0.0; 3]);
}

/// Changes of all sizes, from less than a step to far beyond the octahedron.
#[test]
fn changed_normals_point_where_their_sum_does() {
    // Pairs of different directions.
    let changes = directions().skip(1000).step_by(2);
    let mut turned = 0;
    for (normal, change) in directions().step_by(2).zip(changes) {
        let stored = encode(normal);
        for size in [0.3, 40.0, 3000.0, 1e6, 3e11] {
            let half = change.map(|x| (x * size * f64::from(1 << 24)) as i64);
            let at_rest = unfold(stored).map(f64::from);
            let sum = [0, 1, 2].map(|k| at_rest[k] + 2.0 * half[k] as f64 / f64::from(1 << 24));
            let found = unfold(changed(stored, half)).map(f64::from);
            let length = sum.iter().map(|x| x.abs()).sum::<f64>();
            // Where nearly nothing is left, rounding decides.
            if length > 64.0 {
                let apart = angle(unit(found), unit(sum));
                assert!(
                    apart <= 2e-4 + 2.0 / length,
                    "{apart}: {stored:?} and {half:?}"
                );
                turned += usize::from(apart < angle(unit(at_rest), unit(sum)));
            }
        }
        for (far, end) in [
            ([i64::MAX, 0, 0], [LARGEST, 0, 0]),
            ([0, 0, i64::MIN], [0, 0, -LARGEST]),
        ] {
            assert_eq!(unfold(changed(stored, far)), end, "{stored:?}");
        }
        let away = unfold(stored).map(|x| i64::from(x) * -(1 << 23));
        assert_eq!(changed(stored, away), stored, "nothing is left");
    }
    assert!(turned > 1000, "{turned} normals turned");
}
