//! All hits of triangles, against exact arithmetic.

use super::*;
use gridel_host::shape::rounding::step;
use gridel_tests::bounds::{CROSSING, allowed};

/// The axis along which t is counted.
fn major_axis(slope: [i64; 3]) -> usize {
    // The first of equal ones, as the core chooses.
    (0..3)
        .rev()
        .max_by_key(|&k| slope[k].abs())
        .expect("an axis")
}

/// Returns the triangles that a line crosses, by integers alone. The half-open rule moves a point by so little that
/// only the signs of zeros change.
fn crossed_exactly(
    triangles: &[[[i64; 3]; 3]],
    origin: [i64; 3],
    slope: [i64; 3],
    moved: [i128; 2],
) -> Vec<(i64, i64, usize)> {
    let major = major_axis(slope);
    let (first, second) = ((major + 1) % 3, (major + 2) % 3);
    let scale = slope[major];
    // Times 2^40, in which the moved place is a whole number.
    let project = |corner: [i64; 3]| {
        let depth = corner[major] - origin[major];
        [(first, moved[0]), (second, moved[1])].map(|(k, moved)| {
            let seen = (corner[k] - origin[k]) * scale - depth * slope[k];
            (i128::from(seen) << 40) - moved * i128::from(scale)
        })
    };
    let mut crossed = Vec::new();
    for (number, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(project);
        let side = |p: [i128; 2], q: [i128; 2]| (p[0] * q[1] - p[1] * q[0]).signum();
        let sides = [side(a, b), side(b, c), side(c, a)];
        assert!(
            !sides.contains(&0) || a == b || b == c || c == a,
            "moved off all lines"
        );
        if sides == [1; 3] || sides == [-1; 3] {
            // t over the slope along the major axis, as a fraction.
            let [p, q, r] = *corners;
            let edge = |to: [i64; 3], k: usize| to[k] - p[k];
            let normal = [0, 1, 2].map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                edge(q, i) * edge(r, j) - edge(q, j) * edge(r, i)
            });
            let dot = |v: [i64; 3]| (0..3).map(|k| normal[k] * v[k]).sum::<i64>();
            let (over, under) = (dot([0, 1, 2].map(|k| p[k] - origin[k])), dot(slope));
            crossed.push((over * scale.abs() * under.signum(), under.abs(), number));
        }
    }
    crossed.sort_by(|a, b| {
        let left = i128::from(a.0) * i128::from(b.1);
        left.cmp(&(i128::from(b.0) * i128::from(a.1)))
            .then(a.2.cmp(&b.2))
    });
    crossed
}

/// Largest error of t: the triangle's plane may be off by the bounds of kernels.
fn most<N: Number>([p, q, r]: [[i64; 3]; 3], slope: [i64; 3]) -> f64 {
    /// The greatest magnitude of a coordinate or distance.
    const MAGNITUDE: f64 = 40_000.0;
    let vector = |v: [i64; 3]| DVec3::from_array(v.map(|x| x as f64));
    let normal = (vector(q) - vector(p)).cross(vector(r) - vector(p));
    let slope = vector(slope) / vector(slope).abs().max_element();
    let apart = allowed(&CROSSING, "triangle") * step(N::FORMAT, MAGNITUDE);
    apart * normal.length() / normal.dot(slope).abs()
}

/// With small integers no format rounds what is projected. The hits are those that exact arithmetic finds, in its
/// order, on edges and vertices as well.
#[test]
fn triangles_are_listed_as_exact_arithmetic_finds_them() {
    fn exact<N: Number>(scene: &Scene<'_>, seed: u64, count: usize) -> usize {
        let mut triangles = vec![[[0; 3]; 3]; scene.count(Kind::Triangle)];
        for slot in 0..triangles.len() {
            let number = scene.primitive(Kind::Triangle, slot as u32) as usize;
            let corners = scene.triangle(slot).expect("a triangle");
            // Whole units.
            triangles[number] = corners.map(|it| it.map(|x| i64::from(x) >> 8));
        }
        let mut random = Random(seed);
        let mut hits = 0;
        for number in 0..count {
            let corner = triangles[random.below(triangles.len())][random.below(3)];
            let major = random.below(3);
            let mut slope = [(); 3].map(|()| i64::from(random.within(-4, 4)));
            slope[major] = if random.one_in(2) { 4 } else { -4 };
            // From far before a vertex, in steps of the slope.
            let origin = [0, 1, 2].map(|k| corner[k] - 1024 * slope[k]);
            let mut moved = [1_i128 << 20, 1];
            if N::FORMAT == Format::Fixed {
                // The projected point is turned into the ray's direction there.
                for (place, moved) in moved.iter_mut().enumerate() {
                    if slope[(major_axis(slope) + 1 + place) % 3] < 0 {
                        *moved = -*moved;
                    }
                }
            }
            let expected = crossed_exactly(&triangles, origin, slope, moved);
            let ray = UnitRay {
                tmin: f64::NEG_INFINITY,
                ..UnitRay::new(origin.map(|x| x as f64), slope.map(|x| x as f64))
            };
            let ready = ray.ready::<N>(scene).expect("a ray");
            assert_eq!(ready.major_axis(), major_axis(slope));
            let structures = Structure::ALL.into_iter().filter_map(|it| scene.choose(it));
            let structures: Vec<_> = structures.collect();
            let listed = list::<N, 4>(&structures[number % structures.len()], &ready);
            let primitives = listed
                .iter()
                .filter_map(|hit| Some((hit, hit.0?.primitive as usize)));
            // Diagonal rays can meet the spheres, too.
            let triangles_only = primitives.filter(|(_, number)| *number < triangles.len());
            let about = || format!("{}: {ray:?}", N::FORMAT.name());
            let mut found = Vec::new();
            for (hit, number) in triangles_only {
                let crossed = expected.iter().find(|it| it.2 == number);
                let Some((over, under, _)) = crossed else {
                    panic!("triangle {number} is not crossed: {}", about());
                };
                let t = *over as f64 / *under as f64;
                let listed = f64::from_bits(hit.2);
                // Of a plane nearly along the ray, not all that the bound allows.
                let most = most::<N>(triangles[number], slope).min(0.1);
                assert!((listed - t).abs() <= most, "{listed}, {t}: {}", about());
                found.push(number);
            }
            let mut as_expected: Vec<usize> = expected.iter().map(|it| it.2).collect();
            // Hits that rounding puts into another order, as at an edge.
            found.sort_unstable();
            as_expected.sort_unstable();
            assert_eq!(found, as_expected, "{}", about());
            hits += found.len();
        }
        hits
    }
    let mut random = Random(0xe4ac7);
    for seed in 0..part_of(sixth_of(12), 200) as u64 {
        let vertices: Vec<DVec3> = (0..30)
            .map(|_| DVec3::from_array([(); 3].map(|()| f64::from(random.within(-8, 8)))))
            .chain([DVec3::splat(-32_000.0), DVec3::splat(32_000.0)])
            .collect();
        let triangles = (0..60).filter_map(|_| {
            let corners = [(); 3].map(|()| random.below(30) as u32);
            let [a, b, c] = corners.map(|it| vertices[it as usize]);
            ((b - a).cross(c - a) != DVec3::ZERO).then_some(corners)
        });
        let triangles: Vec<_> = triangles.collect();
        let ends = [30, 31].map(|end: usize| {
            Shape::Sphere(Sphere {
                center: vertices[end],
                radius: 1.0,
            })
        });
        let shape = Shape::Mesh {
            vertices: vertices[..30].to_vec(),
            triangles,
        };
        let blob =
            scenes::blob_with_gridels(&scenes::of(std::iter::once(shape).chain(ends)), 24, 1);
        let scene = blob.scene().expect("a scene");
        assert_eq!(
            (scene.header().unit_exponent, scene.header().origin),
            (0, [0.0; 3])
        );
        let count = 300;
        let hits = [
            exact::<Fixed>(&scene, seed, count),
            exact::<f32>(&scene, seed, count),
            exact::<f64>(&scene, seed, count),
        ];
        assert!(hits.iter().all(|&hits| hits > count), "{hits:?}");
    }
}
