use super::*;

fn polygon(points: &[(f64, f64)]) -> Vec<DVec3> {
    points
        .iter()
        .map(|&(x, y)| DVec3::new(x, y, 0.25 * x - 0.5 * y))
        .collect()
}

fn area(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let cross = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|i| vertices[i as usize]);
        (b - a).cross(c - a).length() / 2.0
    };
    triangles.iter().map(cross).sum()
}

fn outline_area(vertices: &[DVec3]) -> f64 {
    let n = vertices.len();
    (0..n)
        .fold(DVec3::ZERO, |s, i| {
            s + vertices[i].cross(vertices[(i + 1) % n])
        })
        .length()
        / 2.0
}

/// In every rotation and both windings: exact, without loss of area, all facing one way.
fn check(points: &[(f64, f64)], triangles: usize) {
    for start in 0..points.len() {
        let mut turned = points.to_vec();
        turned.rotate_left(start);
        for _ in 0..2 {
            turned.reverse();
            let vertices = polygon(&turned);
            let result = triangulate(&vertices).unwrap();
            assert!(result.exact, "{turned:?}");
            assert_eq!(result.triangles.len(), triangles, "{turned:?}");
            let (found, expected) = (area(&vertices, &result.triangles), outline_area(&vertices));
            assert!(
                (found - expected).abs() < 1e-12 * expected,
                "{found} for {expected} in {turned:?}"
            );
        }
    }
}

#[test]
fn convex_is_a_fan() {
    let square = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    assert_eq!(
        triangulate(&square).unwrap().triangles,
        [[0, 1, 2], [0, 2, 3]]
    );
}

/// Outlines that cross themselves are distinguished from those that only touch, even where every corner of
/// them can be cut off.
#[test]
fn crossing_outlines_are_not_exact() {
    let star = |step: usize| -> Vec<(f64, f64)> {
        let corner = |i: usize| (1.256_637 * (i * step) as f64).sin_cos();
        (0..5).map(corner).collect()
    };
    let bow = [(0.0, 0.0), (3.0, 2.0), (3.0, 0.0), (0.0, 1.0)];
    // A square with a tooth that reaches out beyond the opposite side.
    let tooth = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, -1.0), (0.0, 4.0)];
    for crossing in [&star(2)[..], &bow, &tooth] {
        for start in 0..crossing.len() {
            let mut turned = crossing.to_vec();
            turned.rotate_left(start);
            assert!(!triangulate(&polygon(&turned)).unwrap().exact, "{turned:?}");
        }
    }
    assert!(triangulate(&polygon(&star(1))).unwrap().exact);
}

#[test]
fn concave_arrow() {
    check(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)], 2);
}

#[test]
fn collinear_and_repeated_vertices() {
    check(
        &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)],
        3,
    );
    check(
        &[(0.0, 0.0), (2.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 1.0)],
        2,
    );
}

#[test]
fn a_hole_joined_by_a_bridge() {
    let outline = [
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 4.0),
        (0.0, 4.0),
        (0.0, 0.0),
        (1.0, 1.0),
        (1.0, 3.0),
        (3.0, 3.0),
        (3.0, 1.0),
        (1.0, 1.0),
    ];
    check(&outline, 8);
}

#[test]
fn a_hole_that_touches_the_outline() {
    check(
        &[
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 4.0),
            (0.0, 4.0),
            (0.0, 0.0),
            (1.0, 2.0),
            (2.0, 1.0),
        ],
        5,
    );
}

#[test]
fn a_bow_tie_is_not_exact() {
    let tie = polygon(&[(0.0, 0.0), (3.0, 2.0), (3.0, 0.0), (0.0, 1.0)]);
    assert!(!triangulate(&tie).unwrap().exact);
    let even = polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
    assert!(!triangulate(&even).unwrap().exact);
}

#[test]
fn a_line_keeps_its_empty_triangles() {
    let line = polygon(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)]);
    let result = triangulate(&line).unwrap();
    assert_eq!((result.triangles.len(), result.exact), (2, true));
}

#[test]
fn extreme_coordinates() {
    for scale in [1e-300, 1e-160, 1e160, 1e307] {
        let arrow = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)];
        let vertices: Vec<DVec3> = polygon(&arrow).into_iter().map(|v| v * scale).collect();
        let result = triangulate(&vertices).unwrap();
        assert_eq!((result.triangles.len(), result.exact), (2, true), "{scale}");
    }
}

#[test]
fn too_many_concave_vertices_are_rejected() {
    let star = |n: usize| -> Vec<DVec3> {
        let point = |i: usize| {
            let (sin, cos) = (i as f64 * std::f64::consts::TAU / n as f64).sin_cos();
            DVec3::new(cos, sin, 0.0) * if i.is_multiple_of(2) { 1.0 } else { 0.9 }
        };
        (0..n).map(point).collect()
    };
    assert!(triangulate(&star(MAX_CONCAVE + 2)).is_none());
    let vertices = star(1000);
    let result = triangulate(&vertices).unwrap();
    assert!(result.exact);
    assert!((area(&vertices, &result.triangles) - outline_area(&vertices)).abs() < 1e-12);
}
