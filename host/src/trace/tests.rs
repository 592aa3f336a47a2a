use super::*;
use crate::compile::{Compiled, Options, compile};
use crate::scene;

/// A sphere of radius 1 around the origin.
fn ball() -> Compiled {
    let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
    let imported = scene::read("ball.toml".as_ref(), file.into(), &Default::default()).unwrap();
    compile(&imported.scene, &Options::default()).unwrap()
}

fn queries(any: bool) -> impl Iterator<Item = Query> {
    [Format::Fixed, Format::F32, Format::F64]
        .map(|format| Query {
            format,
            structure: Structure::DualSplit,
            any,
        })
        .into_iter()
}

#[test]
fn t_is_never_outside_of_the_interval() {
    let compiled = ball();
    let scene = compiled.blob.scene().unwrap();
    let ray = |number: usize, tmin, tmax| SceneRay {
        origin: DVec3::new(0.0, 0.0007 * number as f64, 5.0),
        tmin,
        direction: DVec3::new(0.0, 0.0, -0.37),
        tmax,
    };
    for query in queries(false) {
        let numbers = || 0..200;
        let endless: Vec<_> = numbers().map(|it| ray(it, 0.0, f64::INFINITY)).collect();
        let mut hits = vec![SceneHit::MISS; endless.len()];
        trace(&scene, &endless, query, &mut hits);
        // Intervals that end or begin just beside the hit, closer than a format resolves.
        let beside = numbers().zip(&hits).flat_map(|(number, hit)| {
            let [low, high] = [hit.t * (1.0 - 1e-12), hit.t * (1.0 + 1e-12)];
            [
                ray(number, 0.0, low),
                ray(number, high, f64::INFINITY),
                ray(number, high, high),
            ]
        });
        let beside: Vec<_> = beside.collect();
        let mut hits = vec![SceneHit::MISS; beside.len()];
        let rejected = trace(&scene, &beside, query, &mut hits);
        assert_eq!(rejected.count, 0);
        let mut found = 0;
        for (ray, hit) in beside.iter().zip(&hits).filter(|(_, hit)| !hit.is_miss()) {
            found += 1;
            assert!(
                ray.tmin <= hit.t && hit.t <= ray.tmax,
                "{query:?} {ray:?} {hit:?}"
            );
        }
        assert!(found > 0, "{query:?}");
    }
}

#[test]
fn any_hit_rejects_the_rays_that_closest_hit_rejects() {
    let compiled = ball();
    let scene = compiled.blob.scene().unwrap();
    let lengths = [5e-324, 1e-310, 1e-300, 1.0, 1e300, 1.7e308];
    let rays = lengths.map(|length| {
        [-1.0, 1.0].map(|sign| SceneRay {
            origin: DVec3::new(0.0, 0.0, 5.0),
            tmin: 0.0,
            direction: DVec3::new(0.0, 0.0, sign * length),
            tmax: f64::INFINITY,
        })
    });
    let rays = rays.concat();
    for (closest, any) in queries(false).zip(queries(true)) {
        let (mut first, mut some) = ([SceneHit::MISS; 12], [SceneHit::MISS; 12]);
        let rejected = trace(&scene, &rays, closest, &mut first);
        assert!(rejected.count > 0);
        assert_eq!(trace(&scene, &rays, any, &mut some), rejected);
        for (first, some) in first.iter().zip(&some) {
            assert_eq!(first.is_rejected(), some.is_rejected());
            assert_eq!(
                first.is_rejected() || first.is_miss(),
                some.object == u32::MAX
            );
        }
    }
}
