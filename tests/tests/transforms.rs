//! A scene elsewhere (hard cases G, and E4 and E8 of fixed point). Scaled by powers of two,
//! shifted, mirrored and turned, it gives the same bits, up to the mirror, until it is rejected.

use glam::DVec3;
use gridel_core::{Kind, List, NoCount, Number, Scene};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Scene as SceneFile;
use gridel_tests::effort::part_of;
use gridel_tests::judge::lattice_soup;
use gridel_tests::query::{HitBits, UnitRay, closest, t_bound};
use gridel_tests::{every_format, moved, rays, scenes};

/// The hits of rays in units, which are the same for every place of the scene.
fn hits<N: Number>(scene: &Scene<'_>, rays: &[UnitRay]) -> Vec<Option<HitBits>> {
    rays.iter()
        .map(|ray| {
            let ray = ray.ready::<N>(scene).expect("a ray");
            closest::<N, List>(scene, &ray, &mut NoCount).map(|hit| HitBits::of(&hit))
        })
        .collect()
}

fn same_hits(plain: &Blob, other: &Blob, rays: &[UnitRay], about: &str) {
    fn judge<N: Number>(plain: &Blob, other: &Blob, rays: &[UnitRay], about: &str) {
        let (plain, other) = (plain.scene().expect("a scene"), other.scene().expect("one"));
        let (expected, found) = (hits::<N>(&plain, rays), hits::<N>(&other, rays));
        assert!(expected.iter().filter(|hit| hit.is_some()).count() > rays.len() / 20);
        assert!(expected == found, "{about}, {}", N::FORMAT.name());
    }
    every_format!(judge(plain, other, rays, about));
}

/// Times a power of two: the same blob but for the unit, until a clear rejection (D4, E8, G5).
#[test]
fn a_scene_times_a_power_of_two_is_the_same() {
    let soup = lattice_soup(40, 60);
    let plain = scenes::blob(&soup, 24);
    let rays: Vec<_> = rays::rays(&plain.scene().expect("a scene"), 41)
        .take(part_of(4000, 100_000))
        .collect();
    for exponent in [-850, -300, -60, -1, 1, 10, 60, 300, 850] {
        let factor = f64::powi(2.0, exponent);
        let scaled = moved::with(&soup, |p| p * factor, factor, DVec3::ZERO);
        let blob = scenes::blob(&scaled, 24);
        let unit = |blob: &Blob| i32::from(blob.scene().expect("a scene").header().unit_exponent);
        assert_eq!(unit(&blob), unit(&plain) + exponent);
        same_hits(&plain, &blob, &rays, &format!("2^{exponent}"));
    }
    for exponent in [-1020, -930, 930, 1000] {
        let factor = f64::powi(2.0, exponent);
        let scaled = moved::with(&soup, |p| p * factor, factor, DVec3::ZERO);
        let error = compile(&scaled, &Options::default()).expect_err("beyond every lattice");
        assert!(error.to_string().contains("no lattice can hold"), "{error}");
    }
}

/// Shifted by whole steps of the lattice, however far, the blob's records are the same (G1).
#[test]
fn a_scene_that_is_shifted_is_the_same() {
    let soup = lattice_soup(41, 60);
    let plain = scenes::blob(&soup, 24);
    let step = plain.scene().expect("a scene").header().unit_exponent - 8;
    let rays: Vec<_> = rays::rays(&plain.scene().expect("a scene"), 42)
        .take(part_of(4000, 100_000))
        .collect();
    for shift in [1.0, -7.0, 1e3, 1e6, -1e9, f64::powi(2.0, 40)] {
        let shift = DVec3::new(shift, -shift, shift + 1.0) * f64::powi(2.0, step.into());
        let shifted = moved::with(&soup, |p| p, 1.0, shift);
        let blob = scenes::blob(&shifted, 24);
        let (a, b) = (plain.scene().expect("a scene"), blob.scene().expect("one"));
        let apart = DVec3::from_array(b.header().origin) - DVec3::from_array(a.header().origin);
        assert_eq!(apart, shift);
        same_hits(&plain, &blob, &rays, &format!("{shift}"));
    }
    // Beyond the digits of a double the scene does not compile.
    let gone = moved::with(&soup, |p| p, 1.0, DVec3::splat(1e18));
    assert!(compile(&gone, &Options::default()).is_err());
}

/// A vector mirrored along axes.
fn mirror(v: [f64; 3], axes: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| v[k] * axes[k])
}

/// The soup with all of its meshes' fronts turned, as a mirror turns them.
fn fronts_turned(mut scene: SceneFile) -> SceneFile {
    for object in &mut scene.objects {
        if let gridel_host::scene::Shape::Mesh { triangles, .. } = &mut object.shape {
            triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
    }
    scene
}

/// Mirrored along any axes: the same primitives at the same t, and mirrored points and normals
/// (G4, E4).
#[test]
fn a_mirrored_scene_is_the_mirror_image() {
    fn judge<N: Number>(plain: &Scene<'_>, other: &Scene<'_>, rays: &[UnitRay], axes: [f64; 3]) {
        let mut count = 0;
        for ray in rays {
            let image = UnitRay {
                origin: mirror(ray.origin, axes),
                direction: mirror(ray.direction, axes),
                ..*ray
            };
            let hit = |scene, ray: &UnitRay| {
                let ray = ray.ready::<N>(scene).expect("a ray");
                closest::<N, List>(scene, &ray, &mut NoCount)
            };
            let (a, b) = (hit(plain, ray), hit(other, &image));
            let about = || format!("{} {axes:?} {ray:?}: {a:?} {b:?}", N::FORMAT.name());
            let (Some(a), Some(b)) = (a, b) else {
                assert!(a.is_none() && b.is_none(), "{}", about());
                continue;
            };
            count += 1;
            assert_eq!(
                (a.primitive, a.front),
                (b.primitive, b.front),
                "{}",
                about()
            );
            assert_eq!(a.t, b.t, "{}", about());
            let point = mirror(a.point.map(N::length_to_f64), axes);
            assert_eq!(point, b.point.map(N::length_to_f64), "{}", about());
            let normal = mirror(a.normal.map(N::ratio_to_f64), axes);
            assert_eq!(normal, b.normal.map(N::ratio_to_f64), "{}", about());
        }
        assert!(count > rays.len() / 20);
    }
    let soup = lattice_soup(42, 60);
    let plain = scenes::blob(&soup, 24);
    let scene = plain.scene().expect("a scene");
    assert_eq!({ scene.header().origin }, [0.0; 3]);
    let rays: Vec<_> = rays::rays(&scene, 43)
        .take(part_of(4000, 1_000_000))
        .collect();
    for axes in [
        [-1.0, 1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, -1.0],
        [-1.0; 3],
    ] {
        let axes_vector = DVec3::from_array(axes);
        let mut image = moved::with(&soup, |p| p * axes_vector, 1.0, DVec3::ZERO);
        if axes.iter().product::<f64>() < 0.0 {
            image = fronts_turned(image);
        }
        let blob = scenes::blob(&image, 24);
        let other = blob.scene().expect("a scene");
        assert_eq!(scene.count(Kind::Triangle), other.count(Kind::Triangle));
        every_format!(judge(&scene, &other, &rays, axes));
    }
}

/// With its axes exchanged, a scene has the same hits to within the rounding of a few sums (G2).
#[test]
fn a_turned_scene_is_the_same_scene() {
    fn judge<N: Number>(plain: &Scene<'_>, other: &Scene<'_>, rays: &[UnitRay]) {
        let (mut flags, mut worst) = (0, 0.0_f64);
        for ray in rays {
            let turn = |v: [f64; 3]| [v[2], v[0], v[1]];
            let image = UnitRay {
                origin: turn(ray.origin),
                direction: turn(ray.direction),
                ..*ray
            };
            let hit = |scene, ray: &UnitRay| {
                let ray = ray.ready::<N>(scene).expect("a ray");
                closest::<N, List>(scene, &ray, &mut NoCount)
            };
            match (hit(plain, ray), hit(other, &image)) {
                (Some(a), Some(b)) if a.primitive == b.primitive => {
                    let apart = (N::far_to_f64(a.t) - N::far_to_f64(b.t)).abs();
                    // Head on, so that the surface's place is t's.
                    let ready = ray.ready::<N>(plain).expect("a ray");
                    let slope = ready.slope();
                    let cosine: f64 = (0..3)
                        .map(|k| a.normal[k].ratio_to_f64() * slope[k].ratio_to_f64())
                        .sum();
                    worst = worst.max(apart * cosine.abs() / t_bound(&ready, &a));
                }
                (None, None) => {}
                _ => flags += 1,
            }
        }
        eprintln!(
            "{:5}: {} rays, {flags} other primitives at rims, t apart by {worst:.3} of the bound",
            N::FORMAT.name(),
            rays.len()
        );
        assert!(worst <= 1.0);
        assert!(flags * 100 <= rays.len(), "{flags}");
    }
    let soup = lattice_soup(43, 60);
    let turned = moved::with(&soup, |p| DVec3::new(p.z, p.x, p.y), 1.0, DVec3::ZERO);
    let (plain, turned) = (scenes::blob(&soup, 24), scenes::blob(&turned, 24));
    let (plain, turned) = (
        plain.scene().expect("a scene"),
        turned.scene().expect("one"),
    );
    // Rays that touch are another matter.
    let rays: Vec<_> = rays::plain_rays(&plain, 44)
        .take(part_of(4000, 100_000))
        .collect();
    every_format!(judge(&plain, &turned, &rays));
}
