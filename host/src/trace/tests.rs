use super::*;
use crate::compile::{Compiled, Options, compile};
use crate::random::Random;
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

/// Numbers on the edges of what is ordinary.
const EDGES: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    3.5,
    1e4,
    -1e9,
    1e-9,
    1e30,
    -1e-31,
    1e300,
    5e-324,
    f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

#[test]
fn rays_that_are_set_up_together_have_the_hits_of_each_alone() {
    let ball = sample_of_wide();
    let scene = ball.blob.scene().unwrap();
    let mut random = Random(1);
    let mut number = |edges: bool, size: f64| match edges && random.one_in(5) {
        true => EDGES[random.below(EDGES.len())],
        false => size * random.signed(),
    };
    // As many rays as fill no batch.
    let rays: Vec<_> = (0..40_003)
        .map(|turn| {
            let edges = turn % 3 == 0;
            let mut three = |size: f64| {
                DVec3::new(
                    number(edges, size),
                    number(edges, size),
                    number(edges, size),
                )
            };
            SceneRay {
                origin: three(2.0),
                direction: three(1.0),
                tmin: if edges { number(true, 1.0) } else { 0.0 },
                tmax: if edges {
                    number(true, 9.0)
                } else {
                    f64::INFINITY
                },
            }
        })
        .collect();
    for any in [false, true] {
        let query = Query {
            format: Format::F32,
            structure: Structure::Wide,
            any,
        };
        let mut together = vec![SceneHit::MISS; rays.len()];
        let mut alone = together.clone();
        let rejections = trace(&scene, &rays, query, &mut together).unwrap();
        let counters = &mut Counters::default();
        let expected = trace_counted(&scene, &rays, query, &mut alone, counters).unwrap();
        assert_eq!(rejections, expected);
        assert!(expected.count > 0);
        // As text, in which NaN is equal to itself.
        for ((ray, found), expected) in rays.iter().zip(&together).zip(&alone) {
            assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{ray:?}");
        }
    }
}

/// A mesh and spheres of many sizes, as `wide` stores them.
fn sample_of_wide() -> Compiled {
    let sphere = |number: i32| {
        let [x, y, z] = [7, 11, 13].map(|step| f64::from(number * step % 17) / 10.0 - 0.8);
        let radius = f64::exp2(-f64::from(number % 21)) / 2.0;
        format!(
            "[[object]]\nkind = 'sphere'\ncenter = [{x}, {y}, {z}]\nradius = {radius}\nname = 'ball {number}'\n"
        )
    };
    let spheres: String = (0..60).map(sphere).collect();
    let file = "[[object]]\nkind = 'mesh'\nname = 'mesh'\n\
        vertices = [[-1, -1, -1], [1, -1, -1], [0, 1, -0.5], [0, 0, 1]]\n\
        faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]";
    let file = spheres + file;
    let imported = scene::read("wide.toml".as_ref(), file.into(), &Default::default()).unwrap();
    let options = Options {
        structures: vec![Structure::Wide],
        ..Options::default()
    };
    compile(&imported.scene, &options).unwrap()
}
