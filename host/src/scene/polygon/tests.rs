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
fn concave_arrow_gets_two_triangles() {
    check(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)], 2);
}

#[test]
fn collinear_and_repeated_vertices_are_triangulated_exactly() {
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
fn a_hole_joined_by_a_bridge_stays_open() {
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
fn a_hole_that_touches_the_outline_stays_open() {
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
fn extreme_coordinates_are_triangulated_exactly() {
    for scale in [1e-300, 1e-160, 1e160, 1e307] {
        let arrow = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)];
        let vertices: Vec<DVec3> = polygon(&arrow).into_iter().map(|v| v * scale).collect();
        let result = triangulate(&vertices).unwrap();
        assert_eq!((result.triangles.len(), result.exact), (2, true), "{scale}");
    }
}

/// Cuts an outline like [`Clipper::run`], and compares each corner with all vertices.
fn cut_by_brute_force(vertices: &[DVec3]) -> Triangulation {
    let flat = project(vertices).unwrap();
    let mut clipper = Clipper::new(vertices, &flat);
    let (mut tip, mut exact) = (0, true);
    let turn = |clipper: &Clipper<'_>, tip: usize| {
        orient2d(
            flat[clipper.previous[tip]],
            flat[tip],
            flat[clipper.next[tip]],
        )
    };
    let is_clear = |clipper: &Clipper<'_>, tip: usize| {
        let (before, after) = (clipper.previous[tip], clipper.next[tip]);
        let [a, b, c] = [before, tip, after].map(|i| flat[i]);
        let mut i = clipper.next[after];
        while i != before {
            if clipper.blocks(i, a, b, c) {
                return false;
            }
            i = clipper.next[i];
        }
        true
    };
    while clipper.left > 3 {
        let ring: Vec<usize> = std::iter::successors(Some(tip), |&i| Some(clipper.next[i]))
            .take(clipper.left)
            .collect();
        let first = |fits: &dyn Fn(usize) -> bool| ring.iter().copied().find(|&i| fits(i));
        let proper = first(&|i| turn(&clipper, i) > 0.0 && is_clear(&clipper, i))
            .or_else(|| first(&|i| turn(&clipper, i) == 0.0));
        exact &= proper.is_some();
        let ear = proper
            .or_else(|| first(&|i| turn(&clipper, i) > 0.0))
            .unwrap_or(tip);
        tip = clipper.cut(ear);
    }
    exact &= turn(&clipper, tip) >= 0.0;
    clipper.cut(tip);
    Triangulation {
        triangles: clipper.triangles,
        exact,
    }
}

/// Numbers from 0 to below `end`, as if at random.
fn numbers(end: u64) -> impl FnMut() -> f64 {
    let mut state = 7_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) % end) as f64
    }
}

/// A star whose every second corner is nearer, by a factor from 0.1 to 1.
fn ragged(n: usize) -> Vec<DVec3> {
    let mut number = numbers(1000);
    let point = |i: usize| {
        let (sin, cos) = (i as f64 * std::f64::consts::TAU / n as f64).sin_cos();
        DVec3::new(cos, sin, 0.0) * (0.1 + 0.0009 * number())
    };
    (0..n).map(point).collect()
}

/// A ribbon of so many vertices, wound up six times.
fn spiral(n: usize) -> Vec<DVec3> {
    let point = |i: usize, width: f64| {
        let angle = 12.0 * std::f64::consts::PI * i as f64 / (n / 2) as f64;
        let (sin, cos) = angle.sin_cos();
        DVec3::new(cos, sin, 0.0) * (1.0 + angle + width)
    };
    let inside = (0..n / 2).map(|i| point(i, 0.0));
    inside
        .chain((0..n / 2).rev().map(|i| point(i, 3.0)))
        .collect()
}

/// A comb with so many teeth, along x or turned by 30 degrees.
fn comb(teeth: usize, turned: bool) -> Vec<DVec3> {
    let tooth = |i: usize| {
        [
            (2 * i, 1.0),
            (2 * i, 9.0),
            (2 * i + 1, 9.0),
            (2 * i + 1, 1.0),
        ]
    };
    let points = (0..teeth).flat_map(tooth).map(|(x, y)| (x as f64, y));
    let mut points: Vec<_> = points.collect();
    points.extend([(2.0 * teeth as f64, 0.0), (-1.0, 0.0)]);
    let (sin, cos) = if turned {
        (0.5, 0.75_f64.sqrt())
    } else {
        (0.0, 1.0)
    };
    let turn = |(x, y): (f64, f64)| DVec3::new(cos * x - sin * y, sin * x + cos * y, 0.0);
    points.into_iter().map(turn).collect()
}

#[test]
fn outlines_of_every_kind_are_cut_as_by_brute_force() {
    let mut outlines = vec![
        ragged(33),
        ragged(500),
        comb(40, false),
        comb(100, true),
        spiral(400),
    ];
    // Outlines that cross and touch themselves, with repeated and collinear vertices.
    for (n, end) in [(40, 4), (40, 1000), (200, 12), (200, 1_000_000)] {
        let mut number = numbers(end);
        for _ in 0..8 {
            outlines.push(
                (0..n)
                    .map(|_| DVec3::new(number(), number(), 0.0))
                    .collect(),
            );
        }
    }
    for outline in &outlines {
        if let Some(flat) = project(outline) {
            let found = Clipper::new(outline, &flat).run();
            assert_eq!(found, cut_by_brute_force(outline), "{outline:?}");
        }
    }
}

#[test]
fn large_concave_outlines_test_few_vertices_per_corner() {
    let mut far = ragged(MAX_CONCAVE);
    // All others are in a corner of their box.
    far[0] *= 1e6;
    for outline in [
        ragged(MAX_CONCAVE),
        far,
        comb(1000, false),
        comb(1000, true),
        spiral(4000),
    ] {
        let flat = project(&outline).unwrap();
        let mut clipper = Clipper::new(&outline, &flat);
        clipper.cut_all();
        let tests = clipper.tested.get();
        assert!(tests < 500 * outline.len(), "{tests} of {}", outline.len());
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
