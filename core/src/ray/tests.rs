//! Rays of a pencil equal rays that are made one by one; and the limits of rays.

use super::*;
use crate::format::limits::FARTHEST;
use crate::number::Fixed;
use proptest::prelude::*;

fn same_ray<N: Arithmetic>(origin: [f64; 3], direction: [f64; 3]) {
    let bounds = UnitBox([[-300, 400], [-1000, 32_000], [5, 6]]);
    let origin = origin.map(N::far_from_f64);
    let direction = direction.map(N::far_from_f64);
    let endless = endless::<N>();
    let alone = Ray::<N>::new(&bounds, origin, direction, N::Wide::default(), endless);
    let shared = Pencil::new(&bounds, origin).and_then(|pencil| pencil.ray(direction));
    // Debug shows every bit, even of -0.0 and NaN. The order of checks can differ.
    let text = |ray: Result<Ray<N>, RayError>| ray.map(|ray| format!("{ray:?}"));
    let (alone, shared) = (text(alone), text(shared));
    assert_eq!(alone.is_ok(), shared.is_ok());
    if alone.is_ok() {
        assert_eq!(alone, shared);
    }
}

fn length() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1e3..1e3,
        -1e5..1e5,
        -1e7..1e7,
        Just(0.0),
        Just(f64::NAN),
        -1e12..1e12
    ]
}

/// The short arithmetic for near origins gives the same starts as the long one for far origins.
fn same_start<N: Arithmetic>(origin: [f64; 3], direction: [f64; 3], tmin: f64) {
    let bounds = UnitBox([[-300, 400], [-32_768, 32_767], [5, 6]]);
    let origin = origin.map(N::far_from_f64);
    let direction = direction.map(N::far_from_f64);
    let Some((slope, major)) = N::slopes(direction) else {
        return;
    };
    let forward = pick(slope, major) > N::ZERO;
    let tmin = N::far_from_f64(tmin);
    let start_t = distance_to_box::<N>(&bounds, pick(origin, major), (major, forward), tmin);
    let single = (origin.map(N::narrow), N::narrow(start_t));
    if is_near(single.0, major, single.1) {
        let near = near_start(single.0, single.1, slope);
        let far = far_start::<N, false>(&bounds, origin, direction, (slope, major), start_t);
        assert_eq!((near, start_t, true), far);
    }
}

/// The sum of three finite numbers can be infinite.
#[test]
fn origins_are_rejected_with_the_reason() {
    fn origins<N: Arithmetic<Wide = N>>(largest: N, infinite: N) {
        let bounds = UnitBox([[-300, 400], [-1000, 32_000], [5, 6]]);
        let (zero, end) = (N::ZERO, N::FAR);
        let made = |origin: [N; 3]| {
            let direction = [N::ONE; 3];
            let alone = Ray::<N>::new(&bounds, origin, direction, zero, end);
            let pencil = Pencil::<N>::new(&bounds, origin);
            assert_eq!(alone.err(), pencil.err());
            alone.err()
        };
        let most = N::far(FARTHEST);
        assert_eq!(made([most; 3]), None);
        assert_eq!(made([-most, -most, zero]), None);
        assert_eq!(made([largest; 3]), Some(RayError::Distance));
        for axis in 0..3 {
            let with = |x: N| {
                let mut origin = [zero; 3];
                origin[axis] = x;
                made(origin)
            };
            for far in [most + most, -most - most, largest, -largest] {
                assert_eq!(with(far), Some(RayError::Distance));
            }
            for wrong in [infinite, -infinite, infinite - infinite] {
                assert_eq!(with(wrong), Some(RayError::Origin));
            }
        }
        // A coordinate that is not finite does not vanish next to its opposite either.
        assert_eq!(made([infinite, -infinite, zero]), Some(RayError::Origin));
    }
    origins::<f32>(f32::MAX, f32::INFINITY);
    origins::<f64>(f64::MAX, f64::INFINITY);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn near_rays_start_as_far_ones(
        origin in [length(), length(), length()],
        direction in [length(), length(), length()],
        tmin in length(),
    ) {
        same_start::<Fixed>(origin, direction, tmin);
        same_start::<f32>(origin, direction, tmin);
        same_start::<f64>(origin, direction, tmin);
    }

    #[test]
    fn a_pencil_gives_the_rays_that_are_made_one_by_one(
        origin in [length(), length(), length()],
        direction in [length(), length(), length()],
    ) {
        same_ray::<Fixed>(origin, direction);
        same_ray::<f32>(origin, direction);
        same_ray::<f64>(origin, direction);
    }
}

/// A length beyond every scene, however far from it a ray begins.
fn endless<N: Arithmetic>() -> N::Wide {
    N::far(i64::MAX)
}
