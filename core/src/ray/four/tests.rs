use super::*;
use crate::simd::Avx2;

const BOUNDS: UnitBox = UnitBox([[-300, 200], [-7, 32_767], [-32_768, 5]]);

/// Numbers on the edges of what is ordinary.
const NUMBERS: [f64; 22] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.3,
    -250.5,
    1e3,
    -4e4,
    98_300.9,
    98_301.5,
    -2e5,
    1e30,
    -1e30,
    1e-30,
    -1e-31,
    1e-40,
    5e-324,
    1e308,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    -1e-12,
];

/// Bits that look random.
fn next(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

/// A number: one of the edges where `edges` says so.
fn number(state: &mut u64, edges: bool, size: f64) -> f64 {
    if edges && next(state) & 3 == 0 {
        NUMBERS[(next(state) >> 32) as usize % NUMBERS.len()]
    } else {
        (next(state) as i64 as f64) / (1_u64 << 63) as f64 * size
    }
}

/// The bits of a ray, as text.
fn bits(ray: &Ray<f32>) -> String {
    let three = |v: [f32; 3]| v.map(f32::to_bits);
    let rest = [ray.start_t, ray.tmin, ray.tmax].map(f32::to_bits);
    let (origin, slope) = (three(ray.origin), three(ray.slope));
    let major = ray.major;
    format!("{origin:?} {slope:?} {major} {rest:?}")
}

#[test]
fn four_rays_have_the_bits_of_each_alone() {
    let Some(avx2) = Avx2::detect() else { return };
    let mut state = 0x9e37_79b9_7f4a_7c15;
    let (mut ready, mut left) = (0, 0);
    for turn in 0..60_000 {
        let edges = turn & 1 != 0;
        let mut ray = || {
            let mut three = |size: f64| [0; 3].map(|_| number(&mut state, edges, size));
            let (origin, direction) = (three(60_000.0), three(2.0));
            let tmin = (number(&mut state, true, 1e5) - 2e4).max(0.0);
            let tmax = tmin + number(&mut state, true, 1e5) + 9e4;
            (origin, direction, tmin, tmax)
        };
        let rays = [ray(), ray(), ray(), ray()];
        let row = |of: &dyn Fn(usize) -> f64| F64x4::new(avx2, [of(0), of(1), of(2), of(3)]);
        let rows =
            |of: &dyn Fn(usize) -> [f64; 3]| [0, 1, 2].map(|axis| row(&|lane| of(lane)[axis]));
        let given = FourGivenRays {
            origin: rows(&|lane| rays[lane].0),
            direction: rows(&|lane| rays[lane].1),
            tmin: row(&|lane| rays[lane].2),
            tmax: row(&|lane| rays[lane].3),
        };
        let four = FourRays::new(avx2, &BOUNDS, &given);
        for (lane, (origin, direction, tmin, tmax)) in rays.into_iter().enumerate() {
            let alone = Ray::<f32>::from_f64(&BOUNDS, origin, direction, tmin, tmax);
            if four.ready >> lane & 1 == 0 {
                left += 1;
                continue;
            }
            ready += 1;
            let alone = alone.expect("a ray that is set up with others is valid");
            let mut ray = Ray::unwritten();
            four.write(lane, &mut ray);
            assert_eq!(bits(&ray), bits(&alone), "{rays:?} {lane}");
        }
    }
    // Ordinary rays are not left to the other function.
    assert!(ready > left, "{ready} {left}");
}

#[test]
fn ordinary_rays_are_set_up() {
    let Some(avx2) = Avx2::detect() else { return };
    let row = |lanes| F64x4::new(avx2, lanes);
    let given = FourGivenRays {
        origin: [
            row([0.0, -98_000.0, 50.0, 0.0]),
            row([0.0, 0.0, 6e4, 1e-3]),
            row([0.0, -0.0, 7.0, -9.0]),
        ],
        direction: [
            row([1.0, 2.0, 0.0, 1e-30]),
            row([1.0, 1.0, -3.0, 1e-30]),
            row([1.0, 0.1, 0.0, -1e-29]),
        ],
        tmin: row([0.0, 1.0, 0.0, 0.0]),
        tmax: row([f64::INFINITY, 1.0, 1e9, 0.5]),
    };
    assert_eq!(FourRays::new(avx2, &BOUNDS, &given).ready, 0b1111);
}
