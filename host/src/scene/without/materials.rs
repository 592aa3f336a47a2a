//! Scenes whose materials lose what varies on a surface. What moves a color moves what is left of it.

use crate::scene::{Color, Diffuse, Material, Scene, Track};
use gridel_core::format::track::TrackTarget;

/// Replaces checkerboards by the means of their two colors. Where both move, at other times or in another manner, the
/// odd color counts as the material states it.
pub(super) fn average_checkers(scene: &mut Scene) {
    for (number, material) in scene.materials.iter_mut().enumerate() {
        let Diffuse::Checker { even, odd, .. } = material.diffuse else {
            continue;
        };
        let mean = [0, 1, 2].map(|channel| 0.5 * (even[channel] + odd[channel]));
        material.diffuse = Diffuse::Plain(mean);
        let place = |target| {
            let mut tracks = scene.tracks.iter();
            tracks.position(|track| (track.target, track.index) == (target, number))
        };
        let of_odd = place(TrackTarget::MaterialOdd);
        match (place(TrackTarget::MaterialDiffuse), of_odd) {
            (Some(even), None) => average(&mut scene.tracks[even], odd),
            (None, Some(odd)) => {
                average(&mut scene.tracks[odd], even);
                scene.tracks[odd].target = TrackTarget::MaterialDiffuse;
            }
            (Some(even), Some(other)) => {
                let moving = scene.tracks[other].clone();
                let track = &mut scene.tracks[even];
                match is_in_step(track, &moving) {
                    true => average_both(track, &moving),
                    false => average(track, odd),
                }
                scene.tracks.remove(other);
            }
            (None, None) => (),
        }
    }
}

/// Changes materials that are glass, at rest or at a time of their tracks.
pub(super) fn each_glass(scene: &mut Scene, change: impl Fn(&mut Material)) {
    let sends = scene.sends();
    let materials = scene.materials.iter_mut().zip(sends);
    let glass = materials.filter(|(_, sends)| sends.transmits);
    glass.for_each(|(material, _)| change(material));
}

/// Makes mirrors and glass smooth. A roughness that no ray meets is left alone.
pub(super) fn make_smooth(scene: &mut Scene) {
    let sends = scene.sends();
    let materials = scene.materials.iter_mut().zip(sends);
    let rough = materials.filter(|(_, sends)| sends.any());
    rough.for_each(|(material, _)| material.roughness = 0.0);
}

/// Replaces textures by the means of their images.
pub(super) fn average_textures(scene: &mut Scene) {
    for (number, material) in scene.materials.iter_mut().enumerate() {
        material.alpha = None;
        let Some(texture) = material.texture.take() else {
            continue;
        };
        let [red, green, blue] = texture.image.mean();
        material.diffuse = material.diffuse.weighted([red, green, blue]);
        let of_diffuse = |track: &&mut Track| {
            let targets = [TrackTarget::MaterialDiffuse, TrackTarget::MaterialOdd];
            track.index == number && targets.contains(&track.target)
        };
        for track in scene.tracks.iter_mut().filter(of_diffuse) {
            for key in &mut track.keys {
                *key = key.weighted([red, green, blue, 0.0]);
            }
        }
    }
}

/// Replaces a moving color by its mean with one that stands still.
fn average(track: &mut Track, [red, green, blue]: Color) {
    for key in &mut track.keys {
        *key = key.weighted([0.5; 4]);
        let other = [red, green, blue, 0.0];
        key.value = [0, 1, 2, 3].map(|it| key.value[it] + 0.5 * other[it]);
    }
}

/// Replaces a moving color by its mean with another one that moves in step.
fn average_both(track: &mut Track, other: &Track) {
    for (key, other) in track.keys.iter_mut().zip(&other.keys) {
        let mean =
            |one: [f64; 4], other: [f64; 4]| [0, 1, 2, 3].map(|it| 0.5 * (one[it] + other[it]));
        key.value = mean(key.value, other.value);
        key.entering = mean(key.entering, other.entering);
        key.leaving = mean(key.leaving, other.leaving);
    }
}

fn is_in_step(one: &Track, other: &Track) -> bool {
    let times = |track: &Track| -> Vec<f64> { track.keys.iter().map(|it| it.seconds).collect() };
    one.interpolation == other.interpolation && times(one) == times(other)
}

#[cfg(test)]
mod tests {
    use crate::scene::without::leave_one_out;
    use crate::scene::{Diffuse, Image, Scene, Texture, read};
    use gridel_core::Effects;
    use gridel_core::format::track::TrackTarget;

    const BOARD: &str = "[material.board]\nchecker = { even = [1, 1, 1], odd = [0.5, 0, 0], size = 0.5 }\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'board'\n";

    fn scene(tracks: &str) -> Scene {
        let text = format!("{BOARD}{tracks}");
        let imported = read("board.toml".as_ref(), text.into(), &Default::default());
        imported.unwrap().scene
    }

    fn track(color: &str, times: &str, values: &str) -> String {
        format!(
            "[[track]]\ntarget = 'material.board.checker.{color}'\ntimes = {times}\nvalues = {values}\n"
        )
    }

    /// The colors that the tracks of a scene without checkerboards give to its material.
    fn averaged(tracks: &str) -> Vec<Vec<[f64; 3]>> {
        let mut scene = scene(tracks);
        scene.remove_effects(Effects::CHECKER);
        assert_eq!(scene.materials[0].diffuse, Diffuse::Plain([0.75, 0.5, 0.5]));
        let tracks = scene.tracks.iter().map(|track| {
            assert_eq!(
                (track.target, track.index),
                (TrackTarget::MaterialDiffuse, 0)
            );
            let values = track.keys.iter().map(|it| it.value);
            values.map(|[r, g, b, _]| [r, g, b]).collect()
        });
        tracks.collect()
    }

    #[test]
    fn colors_of_checkerboards_that_move_have_moving_means() {
        let even = track("even", "[0, 1]", "[[1, 1, 1], [0, 1, 0]]");
        let odd = track("odd", "[0, 1]", "[[1, 0, 0], [0, 0, 1]]");
        let late = track("odd", "[0, 2]", "[[1, 0, 0], [0, 0, 1]]");
        assert_eq!(averaged(&even), [[[0.75, 0.5, 0.5], [0.25, 0.5, 0.0]]]);
        assert_eq!(averaged(&odd), [[[1.0, 0.5, 0.5], [0.5, 0.5, 1.0]]]);
        assert_eq!(
            averaged(&format!("{even}{odd}")),
            [[[1.0, 0.5, 0.5], [0.0, 0.5, 0.5]]]
        );
        assert_eq!(
            averaged(&format!("{odd}{even}")),
            [[[1.0, 0.5, 0.5], [0.0, 0.5, 0.5]]]
        );
        assert_eq!(
            averaged(&format!("{late}{even}")),
            [[[0.75, 0.5, 0.5], [0.25, 0.5, 0.0]]]
        );
    }

    #[test]
    fn colors_of_textures_that_move_are_weighted_at_every_time() {
        let mut scene = scene(&track("odd", "[0, 1]", "[[1, 1, 1], [0.5, 0, 0]]"));
        let image = Image::new("red", 1, 1, vec![[255, 0, 0, 255]]).unwrap();
        scene.materials[0].texture = Some(Texture::of(image.into()));
        scene.remove_effects(Effects::TEXTURE);
        let values = scene.tracks[0].keys.iter().map(|it| it.value);
        let expected = [[1.0, 0.0, 0.0, 0.0], [0.5, 0.0, 0.0, 0.0]];
        assert_eq!(values.collect::<Vec<_>>(), expected);
    }

    #[test]
    fn properties_that_no_ray_meets_are_not_left_out() {
        let material = "[material.m]\nmirror = 0\ntransmit = 0\nroughness = 0.4\npriority = 1\nabsorption = 1\n";
        let ball = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n";
        let raised = "[[track]]\ntarget = 'material.m.transmit'\ntimes = [0, 1]\nvalues = [0, 1]\n";
        for (tracks, kept) in [("", [true; 3]), (raised, [false, false, true])] {
            let text = format!("{material}{ball}{tracks}");
            let imported = read("m.toml".as_ref(), text.into(), &Default::default());
            let scene = imported.unwrap().scene;
            let effects = [Effects::GLOSSY, Effects::ABSORPTION, Effects::NESTED];
            for (effect, kept) in effects.into_iter().zip(kept) {
                let names = leave_one_out(&mut scene.clone(), effect);
                assert_eq!(names.is_none(), kept, "{effect}: {names:?}");
            }
        }
    }
}
