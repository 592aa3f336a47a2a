use super::*;
use crate::format::record::UnitBox;
use crate::geometry::sphere;
use crate::number::{Products, Vectors};

const BOUNDS: UnitBox = UnitBox([[-32_768, 32_767]; 3]);

/// Center and radius in 1/256 unit.
type Sphere = ([i32; 3], i32);

/// Bits that look random.
fn next(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

/// Eight spheres with a ray at each that meets it. Radii have all sizes, and centers all distances from the middle.
fn spheres_and_rays(state: &mut u64) -> [(Sphere, Ray<f32>); LANES] {
    core::array::from_fn(|_| {
        let radius = 1 << ((next(state) >> 32) % 16);
        let size = 8 + (next(state) >> 32) % 16;
        let center = core::array::from_fn(|_| (next(state) as i32) >> (32 - size) & !1);
        let mut signed = |size: f64| next(state) as i64 as f64 / (1_u64 << 63) as f64 * size;
        let unit = |length: i32| f64::from(length) / 256.0;
        let way: [f64; 3] = core::array::from_fn(|_| signed(1.0));
        let origin = core::array::from_fn(|axis| {
            unit(center[axis]) + signed(unit(radius)) - 3e4 * way[axis]
        });
        let ray = Ray::from_f64(&BOUNDS, origin, way, 0.0, f64::INFINITY);
        ((center, radius), ray.expect("a direction"))
    })
}

#[test]
fn normals_have_the_bits_of_each_alone() {
    let Some(avx2) = Avx2::detect() else { return };
    let state = &mut 1;
    let (mut known, mut left) = (0, 0);
    for turn in 0..20_000 {
        let given = spheres_and_rays(state);
        let mut spheres = MetSpheres::default();
        let mut crossings = [None; LANES];
        for (lane, ((center, radius), ray)) in given.iter().enumerate() {
            let recip_norm2 = f32::recip_norm2(ray.slope);
            let Some(crossing) = sphere::cross(ray, recip_norm2, *center, *radius) else {
                continue;
            };
            let leaves = (turn + lane) % 2 == 0;
            let (t, _) = if leaves {
                crossing.leave
            } else {
                crossing.enter
            };
            spheres.add(lane, (*center, *radius), (ray, t), leaves);
            crossings[lane] = Some((t, leaves));
        }
        let normals = avx2.call(
            #[inline(always)]
            |avx2, spheres: &MetSpheres, (), (), (), ()| spheres.normals(avx2),
            (&spheres, (), (), (), ()),
        );
        for (lane, ((center, radius), ray)) in given.iter().enumerate() {
            let found = normals.get(lane);
            let Some((t, leaves)) = crossings[lane] else {
                assert_eq!(found, None);
                continue;
            };
            let surface = sphere::surface(*center, *radius, ray.at(t));
            let against = f32::dot(surface.normal, ray.slope) < 0.0;
            let is_lost = surface.normal == [0.0; 3] || against == leaves;
            match found {
                Some(normal) => {
                    known += 1;
                    assert_eq!(normal.map(f32::to_bits), surface.normal.map(f32::to_bits));
                    assert!(!is_lost);
                }
                None => {
                    left += 1;
                    assert!(is_lost, "{center:?} {radius} {ray:?}");
                }
            }
        }
    }
    assert!(known > 10_000 && left > 100, "{known} {left}");
}
