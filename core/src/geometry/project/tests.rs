use crate::geometry::Project;
use proptest::prelude::*;

/// Two plane vectors of integers, often all but parallel.
fn vectors(bits: u32) -> impl Strategy<Value = [[i64; 2]; 2]> {
    let most = 1_i64 << bits;
    let free = (-most..=most, -most..=most, -most..=most, -most..=most)
        .prop_map(|(a, b, c, d)| [[a, b], [c, d]]);
    let half = 1_i64 << (bits / 2);
    let near = (-half..=half, -half..=half, 1..half, -1..=1_i64, -1..=1_i64)
        .prop_map(|(x, y, factor, dx, dy)| [[x * factor + dx, y * factor + dy], [x, y]]);
    prop_oneof![free, near]
}

/// Triangles with an edge of two such vectors, which often leads through the origin.
fn triangles(bits: u32) -> impl Strategy<Value = [[i64; 2]; 3]> {
    let most = 1_i64 << bits;
    let third = prop_oneof![
        Just(None),
        (-most..=most, -most..=most).prop_map(|(x, y)| Some([x, y]))
    ];
    (vectors(bits), third).prop_map(|([a, b], c)| {
        // Opposite the edge, so that it decides.
        let opposite = [0, 1].map(|k| -(a[k] / 2) - b[k] / 2);
        [a, b, c.unwrap_or(opposite)]
    })
}

fn surrounds_exactly([a, b, c]: [[i64; 2]; 3]) -> bool {
    let side = |p: [i64; 2], q: [i64; 2]| {
        i128::from(p[0]) * i128::from(q[1]) - i128::from(p[1]) * i128::from(q[0])
    };
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().any(|&side| side > 0) != sides.iter().any(|&side| side < 0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200_000))]

    #[test]
    fn edges_are_judged_exactly(corners in triangles(24), shift in 0..40_i32) {
        let scale = f32::powi(2.0, -shift);
        let [a, b, c] = corners.map(|v| v.map(|x| x as f32 * scale));
        prop_assert_eq!(f32::surrounds_origin(a, b, c), surrounds_exactly(corners));
    }

    #[test]
    fn edges_are_judged_exactly_in_double(corners in triangles(53), shift in 0..120_i32) {
        let scale = f64::powi(2.0, -shift);
        let [a, b, c] = corners.map(|v| v.map(|x| x as f64 * scale));
        prop_assert_eq!(f64::surrounds_origin(a, b, c), surrounds_exactly(corners));
    }
}
