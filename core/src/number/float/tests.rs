use super::*;
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200_000))]

    #[test]
    fn cross_products_have_the_exact_sign(v in vectors(24), shift in 0..40_i32) {
        let exact = i128::from(v[0][0]) * i128::from(v[1][1]) - i128::from(v[0][1]) * i128::from(v[1][0]);
        let scale = f32::powi(2.0, -shift);
        let [a, b] = v.map(|v| v.map(|x| x as f32 * scale));
        let found = f32::cross2(a, b);
        prop_assert_eq!(found.partial_cmp(&0.0), Some(exact.cmp(&0)));
    }

    #[test]
    fn cross_products_have_the_exact_sign_in_double(v in vectors(53), shift in 0..120_i32) {
        let exact = i128::from(v[0][0]) * i128::from(v[1][1]) - i128::from(v[0][1]) * i128::from(v[1][0]);
        let scale = f64::powi(2.0, -shift);
        let [a, b] = v.map(|v| v.map(|x| x as f64 * scale));
        let found = f64::cross2(a, b);
        prop_assert_eq!(found.partial_cmp(&0.0), Some(exact.cmp(&0)));
    }
}
