use super::*;
use crate::compile::{Compiled, Options, compile};
use crate::scene;

/// A sphere of radius 1 around the origin.
fn ball() -> Compiled {
    let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
    let imported = scene::read("ball.toml".as_ref(), file.into(), &Default::default()).unwrap();
    compile(&imported.scene, &Options::default()).unwrap()
}

fn queries() -> impl Iterator<Item = Query> {
    [Format::Fixed, Format::F32, Format::F64]
        .map(|format| Query {
            format,
            structure: Structure::DualSplit,
            any: false,
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
    for query in queries() {
        let numbers = || 0..200;
        let endless: Vec<_> = numbers().map(|it| ray(it, 0.0, f64::INFINITY)).collect();
        let mut hits = vec![SceneHit::MISS; endless.len()];
        trace(&scene, &endless, query, &mut hits).unwrap();
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
        let rejected = trace(&scene, &beside, query, &mut hits).unwrap();
        assert_eq!(rejected.count, 0);
        let mut found = 0;
        for (ray, hit) in beside
            .iter()
            .zip(&hits)
            .filter(|(_, hit)| hit.object != u32::MAX)
        {
            found += 1;
            assert!(
                ray.tmin <= hit.t && hit.t <= ray.tmax,
                "{query:?} {ray:?} {hit:?}"
            );
        }
        assert!(found > 0, "{query:?}");
    }
}
