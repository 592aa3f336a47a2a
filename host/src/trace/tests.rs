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
fn structures_that_the_blob_does_not_hold_are_an_error() {
    let compiled = ball();
    let scene = compiled.blob.scene().unwrap();
    let ray = SceneRay {
        origin: DVec3::new(0.0, 0.0, 5.0),
        tmin: 0.0,
        direction: DVec3::NEG_Z,
        tmax: f64::INFINITY,
    };
    for query in queries() {
        for structure in Structure::ALL {
            for any in [false, true] {
                let query = Query {
                    structure,
                    any,
                    ..query
                };
                let mut hits = [SceneHit::MISS];
                let traced = trace(&scene, &[ray], query, &mut hits);
                let mut counted = [SceneHit::MISS];
                let counters = &mut Counters::default();
                let with_counters = trace_counted(&scene, &[ray], query, &mut counted, counters);
                let missing = Err(MissingStructure(structure));
                if scene.holds(structure) {
                    assert!(traced.is_ok() && with_counters.is_ok(), "{query:?}");
                    assert_eq!(hits, counted);
                    assert!(hits[0] != SceneHit::MISS, "{query:?}");
                } else {
                    assert_eq!((traced, with_counters), (missing, missing), "{query:?}");
                    assert_eq!((hits, counted), ([SceneHit::MISS; 1], [SceneHit::MISS; 1]));
                }
            }
        }
    }
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
