//! Compares the contenders' answers with brute force: primitive, instance, and t to the last bit.
//!
//! Brute force tests every primitive, which takes long where there are many. So it traces as many rays as fit a budget,
//! spread evenly over the picture, and every ray on which two structures differ. On the other rays a common answer is
//! taken as right.
//!
//! All contenders find instances by the same hierarchy above them. Brute force tests every primitive of a part that a
//! ray enters.

use crate::measure::primitives;
use crate::measure::rays::{Answer, Question, Questions, ask, stride};
use gridel_core::{Number, Ray, Scene, Structure};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// The wrong answers of a contender.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Mismatch {
    /// Rays with another answer than the list's.
    pub rays: usize,
    /// The first of them.
    pub first: String,
}

/// The result of the comparison.
pub struct Verdict {
    /// Rays that brute force traced.
    pub listed: usize,
    /// For each contender.
    pub wrong: Vec<Option<Mismatch>>,
}

/// Compares the contenders' answers with each other and with the list's.
pub fn judge<N: Number>(
    questions: &Questions<'_, N>,
    list: &Scene<'_>,
    contenders: &[(&Scene<'_>, &Structure)],
    tests: u64,
) -> Verdict {
    let rays: Vec<(Question, &Ray<N>)> = questions.all().collect();
    let answers: Vec<Vec<Answer>> = contenders
        .par_iter()
        .map(|&(scene, &structure)| {
            if structure == Structure::List {
                // Brute force is not compared with itself.
                return Vec::new();
            }
            all_answers((scene, structure), &rays)
        })
        .collect();
    let asked: Vec<&Vec<Answer>> = answers.iter().filter(|all| !all.is_empty()).collect();
    let [_, placed] = primitives(list);
    let step = stride(Structure::List, rays.len(), placed, tests);
    let doubtful = |ray: &usize| {
        ray.is_multiple_of(step) || asked.windows(2).any(|pair| pair[0][*ray] != pair[1][*ray])
    };
    let numbers: Vec<usize> = (0..rays.len()).filter(doubtful).collect();
    let truth: BTreeMap<usize, Answer> = numbers
        .into_par_iter()
        .map(|number| {
            let one = all_answers((list, Structure::List), &rays[number..=number]);
            (number, one[0])
        })
        .collect();
    let wrong = answers
        .iter()
        .map(|answers| {
            let mut differ = truth.iter().filter(|&(&number, &truth)| {
                answers.get(number).is_some_and(|&answer| answer != truth)
            });
            let (&number, &truth) = differ.next()?;
            let (question, ray) = rays[number];
            Some(Mismatch {
                rays: 1 + differ.count(),
                first: format!(
                    "{question:?} of {ray:?}: {:x?} and not {truth:x?}",
                    answers[number]
                ),
            })
        })
        .collect();
    Verdict {
        listed: truth.len(),
        wrong,
    }
}

fn all_answers<N: Number>(
    contender: (&Scene<'_>, Structure),
    rays: &[(Question, &Ray<N>)],
) -> Vec<Answer> {
    let mut answers = Vec::with_capacity(rays.len());
    // Runs of one question.
    for run in rays.chunk_by(|a, b| a.0 == b.0) {
        let mut same = run.iter().map(|&(_, ray)| ray);
        let question = run[0].0.of_scene(contender.0);
        ask(contender, question, &mut same, &mut |answer| {
            answers.push(answer);
        });
    }
    answers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blob::Blob;
    use crate::compile::{Options, compile};
    use crate::picture_rays::PictureRays;
    use crate::scene;
    use crate::shape::{Cuboid, Sphere};
    use glam::DVec3;
    use gridel_core::Settings;

    fn spheres(radii: [f64; 2]) -> Blob {
        let objects = radii
            .into_iter()
            .zip([-1.0, 1.0])
            .map(|(radius, x)| scene::Object {
                name: String::from("sphere"),
                material: 0,
                shape: scene::Shape::Sphere(Sphere {
                    center: DVec3::new(x, 0.0, 0.0),
                    radius,
                }),
                place: scene::SourceSpan::default(),
                normals: Default::default(),
                attributes: Default::default(),
            });
        let wall = scene::Object {
            name: String::from("wall"),
            material: 0,
            shape: scene::Shape::Box(Cuboid {
                min: DVec3::new(-2.0, -2.0, -3.0),
                max: DVec3::new(2.0, 2.0, -2.5),
            }),
            place: scene::SourceSpan::default(),
            normals: Default::default(),
            attributes: Default::default(),
        };
        let scene = scene::Scene {
            materials: vec![scene::Material::default()],
            objects: objects.chain([wall]).collect(),
            ..scene::Scene::default()
        };
        let options = Options {
            structures: vec![Structure::Bvh, Structure::Flagged],
            ..Options::default()
        };
        compile(&scene, &options).unwrap().blob
    }

    /// A structure of another scene acts as a broken one.
    #[test]
    fn a_row_that_differs_is_wrong_and_no_other() {
        let (right, other) = (spheres([0.5, 0.5]), spheres([0.5, 0.45]));
        let (right, other) = (right.scene().unwrap(), other.scene().unwrap());
        let settings = Settings {
            width: 64,
            height: 64,
            ..Settings::of(&right)
        };
        let rays = PictureRays::<f32>::of(&right, settings).unwrap();
        assert_eq!(rays.primary.len(), 64 * 64);
        let questions = Questions {
            rays: &rays,
            shadow: Question::Any,
        };
        let contenders = [
            (&right, &Structure::Bvh),
            (&other, &Structure::Flagged),
            (&right, &Structure::List),
        ];
        for tests in [1, 1_000_000] {
            let verdict = judge(&questions, &right, &contenders, tests);
            let wrong = verdict.wrong[1].as_ref().expect("the other scene's");
            assert!(wrong.rays > 10 && wrong.rays < 1000, "{}", wrong.rays);
            assert_eq!((&verdict.wrong[0], &verdict.wrong[2]), (&None, &None));
        }
    }
}
