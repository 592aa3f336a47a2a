//! Counts of tests in scenes with instances.

use super::{Answer, Question, ask, ask_through};
use crate::compile::{Options, compile};
use crate::picture_rays::PictureRays;
use crate::scene::read;
use gridel_core::accel::DynAccel;
use gridel_core::{Accel, Counters, Ray, Scene, Settings, Structure, StructureVisitor};

const SCENE: &str = "[camera]\neye = [1, 2, 12]\ntarget = [1, 0, 0]\n\
    [[object]]\nkind = 'sphere'\ncenter = [0, -2, 0]\nradius = 0.8\n\
    [[part]]\nname = 'some'\nobject = [\
      { kind = 'sphere', center = [0, 0, 0], radius = 0.5 },\
      { kind = 'box', min = [0, 0, 0], max = [1, 1, 1] }]\n\
    [[instance]]\npart = 'some'\n\
    [[instance]]\npart = 'some'\n\
    [[instance]]\npart = 'some'\ntranslate = [2, 0, 0]\nrotate = [20, 40, 60]\n";

const STRUCTURES: [Structure; 5] = [
    Structure::List,
    Structure::Flagged,
    Structure::DualSplit,
    Structure::Grid,
    Structure::Wide,
];

/// Counts through a structure's own code.
struct Count<'a>(&'a Scene<'a>, Question, &'a [Ray<f32>]);

impl StructureVisitor for Count<'_> {
    type Output = Counters;

    fn visit<A: Accel>(self) -> Counters {
        let Self(scene, question, rays) = self;
        let mut counters = Counters::default();
        let rays = &mut rays.iter();
        ask_through::<f32, A, _>(scene, question, rays, &mut counters, &mut |_| ());
        counters
    }
}

fn with_scene(test: impl FnOnce(&Scene<'_>, &PictureRays<f32>)) {
    let imported = read("a.toml".as_ref(), SCENE.into(), &Default::default());
    let options = Options {
        structures: STRUCTURES.to_vec(),
        ..Options::default()
    };
    let blob = compile(&imported.expect("a scene").scene, &options);
    let blob = blob.expect("a blob").blob;
    let scene = blob.scene().expect("a scene");
    let settings = Settings {
        width: 32,
        height: 24,
        ..Settings::of(&scene)
    };
    test(&scene, &PictureRays::of(&scene, settings).expect("rays"));
}

#[test]
fn chosen_structures_count_what_their_own_code_does() {
    with_scene(|scene, rays| {
        for structure in STRUCTURES {
            let chosen = scene.choose(structure).expect("a structure");
            let mut counters = Counters::default();
            let some = &mut rays.primary.iter();
            let question = Question::Closest;
            ask_through::<f32, DynAccel, _>(&chosen, question, some, &mut counters, &mut |_| ());
            let own = structure.visit(Count(scene, question, &rays.primary));
            let name = structure.name();
            assert_eq!(counters, own, "{name}");
            assert!(counters.instances > 0 && counters.primitives > 0, "{name}");
        }
    });
}

/// Two instances lie in one place, and the first has the hit.
#[test]
fn answers_name_instances_where_they_are_compared() {
    with_scene(|scene, rays| {
        for structure in STRUCTURES {
            let answers = |question: Question| {
                let mut answers: Vec<Answer> = Vec::new();
                let rays = &mut rays.primary.iter();
                ask((scene, structure), question, rays, &mut |it| {
                    answers.push(it)
                });
                answers
            };
            let placed = answers(Question::Closest.of_scene(scene));
            let has = |number: u32| placed.iter().any(|it| it.instance == number);
            assert_eq!(
                [0, 1, 2].map(has),
                [true, false, true],
                "{}",
                structure.name()
            );
            for (placed, plain) in placed.iter().zip(answers(Question::Closest)) {
                assert_eq!((placed.primitive, placed.t), (plain.primitive, plain.t));
            }
        }
    });
}
