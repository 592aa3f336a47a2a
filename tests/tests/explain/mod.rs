//! The explanation of a pixel is that of the pixel that is rendered: the same hits, and parts that add up.

mod lights;
mod points;
mod sums;
mod walks;

use gridel_core::{Format, Scene, Settings, Structure};
use gridel_host::explain::{Explanation, Subject, Walk, explain};
use gridel_host::trace::SceneRay;

fn explanation(
    scene: &Scene<'_>,
    format: Format,
    structure: Structure,
    ray: SceneRay,
) -> Explanation {
    let settings = Settings::of(scene);
    explain(scene, format, structure, settings, Subject::Ray(ray)).expect("a explanation")
}

/// Returns the walk of the ray itself.
fn way(explanation: &Explanation) -> &Walk {
    explanation.samples[0].rays[0]
        .walk
        .as_ref()
        .expect("a walk")
}

fn rays(seed: u64, count: usize) -> impl Iterator<Item = SceneRay> {
    let mut random = gridel_tests::random::Random(seed);
    (0..count).map(move |_| {
        let origin = glam::DVec3::from_array(random.direction()) * 3.0;
        let target = glam::DVec3::from_array([0; 3].map(|_| random.signed()));
        SceneRay {
            origin,
            direction: target - origin,
            tmin: 0.0,
            tmax: f64::INFINITY,
        }
    })
}
