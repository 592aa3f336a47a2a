//! Scenes whose lights lose their area, or their falloff.

use crate::scene::{Light, LightForm, LightShape, Scene, Track};
use glam::DVec3;
use gridel_core::format::track::TrackTarget;
use std::borrow::Cow;
use std::f64::consts::PI;

/// Returns the light of a point that replaces an area in its middle: its color at a distance of 1 over the area's
/// radiance.
fn brightness(shape: &LightShape) -> f64 {
    match *shape {
        LightShape::Point | LightShape::Facet { .. } => 1.0,
        LightShape::Sphere { radius } | LightShape::Disc { radius, .. } => radius * radius,
        LightShape::Rectangle { edges } => edges[0].cross(edges[1]).length() / PI,
        LightShape::Triangle { edges } => 0.5 * edges[0].cross(edges[1]).length() / PI,
    }
}

/// Returns the vector from the position of an area to its middle.
fn to_middle(shape: &LightShape) -> DVec3 {
    match *shape {
        LightShape::Rectangle { edges } => 0.5 * (edges[0] + edges[1]),
        LightShape::Triangle { edges } => (edges[0] + edges[1]) / 3.0,
        _ => DVec3::ZERO,
    }
}

/// A point that shines as an area does from far away.
fn shrunk(shape: &LightShape) -> LightShape {
    match *shape {
        LightShape::Point | LightShape::Sphere { .. } => LightShape::Point,
        LightShape::Rectangle { edges } | LightShape::Triangle { edges } => LightShape::Facet {
            normal: edges[0].cross(edges[1]),
        },
        LightShape::Disc { normal, .. } | LightShape::Facet { normal } => {
            LightShape::Facet { normal }
        }
    }
}

/// The part of a point's light that leaves it in a direction and is left at a distance.
fn shine(form: &LightForm, way: DVec3) -> f64 {
    let (distance, direction) = (way.length(), way.normalize_or_zero());
    let mut part = match form.shape {
        LightShape::Facet { normal } => normal.normalize_or_zero().dot(direction).max(0.0),
        _ => 1.0,
    };
    if let Some(spot) = form.spot {
        let [inner, outer] = [spot.inner, spot.outer].map(|angle| libm::cos(angle.to_radians()));
        let within = spot.direction.normalize_or_zero().dot(direction) - outer;
        let width = inner - outer;
        part *= match within >= width {
            true => f64::from(u8::from(within > 0.0)),
            false => (within.max(0.0) / width).powi(2),
        };
    }
    if let Some(range) = form.range {
        part *= 1.0 - (distance / range).min(1.0).powi(4);
    }
    if form.falls_off && distance > 0.0 {
        part /= distance * distance;
    }
    part
}

/// Makes points of areas, as bright from far away. Spheres around these points are removed: they would block all light.
pub(super) fn shrink_areas(scene: &mut Scene) {
    if let Cow::Owned(expanded) = scene.with_emitters() {
        *scene = expanded;
    }
    if scene.render.shadows {
        remove_spheres_of_lights(scene);
    }
    for (number, form) in scene.light_forms.iter_mut().enumerate() {
        let Some(form) = form.as_mut() else {
            continue;
        };
        let Some(Light::Point { position, color }) = scene.lights.get_mut(number) else {
            continue;
        };
        let (factor, middle) = (brightness(&form.shape), to_middle(&form.shape));
        *position += middle;
        *color = color.map(|channel| channel * factor);
        change_tracks(&mut scene.tracks, number, factor, middle);
        *form = LightForm {
            shape: shrunk(&form.shape),
            is_surface: false,
            ..*form
        };
    }
}

/// Returns the sphere that has the surface of a light.
fn sphere_of_light(scene: &Scene, number: usize) -> Option<usize> {
    let form = scene.light_forms.get(number).copied().flatten()?;
    let is_sphere = matches!(form.shape, LightShape::Sphere { .. });
    scene.object_of_light(number).filter(|_| is_sphere)
}

/// Removes the spheres that have the surface of a light.
fn remove_spheres_of_lights(scene: &mut Scene) {
    for number in 0..scene.lights.len() {
        if let Some(object) = sphere_of_light(scene, number) {
            scene.objects.remove(object);
        }
    }
}

/// Returns true if [`shrink_areas`] removes a sphere.
pub(super) fn shows_spheres(scene: &Scene) -> bool {
    let expanded = scene.with_emitters();
    let mut numbers = 0..expanded.lights.len();
    scene.render.shadows && numbers.any(|number| sphere_of_light(&expanded, number).is_some())
}

/// Makes points that shine equally in all directions and at all distances, as bright as at the point where the camera
/// looks.
pub(super) fn remove_falloff(scene: &mut Scene) {
    shrink_areas(scene);
    let looked_at = match scene.camera {
        Some(camera) => camera.target,
        None => middle(scene),
    };
    for (number, form) in scene.light_forms.iter_mut().enumerate() {
        let Some(form) = form.take() else {
            continue;
        };
        let Some(Light::Point { position, color }) = scene.lights.get_mut(number) else {
            continue;
        };
        let factor = shine(&form, looked_at - *position);
        *color = color.map(|channel| channel * factor);
        change_tracks(&mut scene.tracks, number, factor, DVec3::ZERO);
    }
}

/// The middle of all that has an end.
fn middle(scene: &Scene) -> DVec3 {
    let shapes = scene.all_objects().map(|object| object.shape.bounds());
    let [low, high] = shapes
        .filter(|[low, high]| low.is_finite() && high.is_finite())
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], it| {
            [low.min(it[0]), high.max(it[1])]
        });
    let middle = 0.5 * (low + high);
    if middle.is_finite() {
        middle
    } else {
        DVec3::ZERO
    }
}

/// Multiplies the colors of a light's tracks, and moves its positions.
fn change_tracks(tracks: &mut [Track], number: usize, factor: f64, by: DVec3) {
    for track in tracks.iter_mut().filter(|track| track.index == number) {
        for key in &mut track.keys {
            if track.target == TrackTarget::LightColor {
                *key = key.weighted([factor; 4]);
            }
            if track.target == TrackTarget::LightPosition {
                for (value, by) in key.value.iter_mut().zip(by.to_array()) {
                    *value += by;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::without::leave_one_out;
    use crate::scene::{Light, LightShape, Scene, read};
    use glam::DVec3;
    use gridel_core::Effects;

    const FLOOR: &str =
        "[[object]]\nkind = 'box'\nmin = [-5, -1, -5]\nmax = [5, 0, 5]\nname = 'floor'\n";
    const GLOWING: &str = "[material.lamp]\nemission = 2\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 1, 0]\nradius = 0.5\nmaterial = 'lamp'\nname = 'bulb'\n";
    const VISIBLE: &str = "[[light]]\nkind = 'sphere'\ncenter = [0, 1, 0]\nradius = 0.5\nradiance = 2\n\
        visible = true\nname = 'bulb'\n";

    fn scene(text: &str) -> Scene {
        let imported = read("lamp.toml".as_ref(), text.into(), &Default::default());
        imported.unwrap_or_else(|error| panic!("{error}")).scene
    }

    #[test]
    fn spheres_that_glow_do_not_block_the_points_in_their_middles() {
        for lamp in [GLOWING, VISIBLE] {
            for effect in [Effects::AREA_LIGHT, Effects::FALLOFF] {
                let mut scene = scene(&format!("{lamp}{FLOOR}"));
                assert_eq!(scene.objects.len(), 2);
                let names = leave_one_out(&mut scene, effect).unwrap();
                assert!(names.contains(&String::from("object `bulb`")), "{names:?}");
                assert!(
                    !names.contains(&String::from("object `floor`")),
                    "{names:?}"
                );
                let [object] = &scene.objects[..] else {
                    panic!("{} objects", scene.objects.len());
                };
                assert_eq!(object.name, "floor");
                assert!(matches!(scene.lights[..], [Light::Point { .. }]));
            }
        }
    }

    /// A disc 2 above the floor, turned by 60 degrees: half as bright below it as one that faces the floor.
    #[test]
    fn points_shine_to_the_sides_to_which_areas_did() {
        for (normal, cosine) in [
            ("[0, -1, 0]", 1.0),
            ("[3, -1.732050807568877, 0]", 0.5),
            ("[0, 1, 0]", -1.0),
        ] {
            let text = format!(
                "[camera]\neye = [0, 1, -4]\ntarget = [0, 0, 0]\n{FLOOR}\
                 [[light]]\nkind = 'disc'\ncenter = [0, 2, 0]\nradius = 0.1\nradiance = 40\nnormal = {normal}\n"
            );
            let mut left = scene(&text);
            left.remove_effects(Effects::AREA_LIGHT);
            let LightShape::Facet { normal } = left.light_forms[0].unwrap().shape else {
                panic!("{:?}", left.light_forms);
            };
            assert!((normal.normalize().dot(DVec3::NEG_Y) - cosine).abs() < 1e-9);
            left.remove_effects(Effects::FALLOFF);
            let [Light::Point { color, .. }] = left.lights[..] else {
                panic!("{:?}", left.lights);
            };
            // The area over π, times the radiance, over the square of the distance; nothing behind the light.
            let expected = 0.1 * f64::max(cosine, 0.0);
            assert!((color[0] - expected).abs() < 1e-9, "{color:?} {cosine}");
        }
    }

    /// A spot 2 above where the camera looks, turned by 20 degrees, that is full up to 10 and ends at 30.
    #[test]
    fn lights_without_falloff_are_as_bright_as_where_the_camera_looks() {
        let text = |rest: &str| {
            format!(
                "[camera]\neye = [0, 1, -4]\ntarget = [0, 0, 0]\n{FLOOR}\
                 [[light]]\nposition = [0, 2, 0]\nfalloff = 'square'\ncolor = 8\n{rest}\n"
            )
        };
        let [sine, cosine] = [f64::sin, f64::cos].map(|of| of(20_f64.to_radians()));
        let spot = |inner: f64, outer: f64| {
            format!(
                "kind = 'spot'\ndirection = [{sine}, {}, 0]\ninner = {inner}\nouter = {outer}",
                -cosine
            )
        };
        let [full, end] = [10_f64, 30.0].map(|angle| libm::cos(angle.to_radians()));
        for (rest, expected) in [
            (String::from("kind = 'point'"), 2.0),
            (
                String::from("kind = 'point'\nrange = 4"),
                2.0 * (1.0 - 1.0 / 16.0),
            ),
            (String::from("kind = 'point'\nrange = 2"), 0.0),
            (spot(25.0, 30.0), 2.0),
            (
                spot(10.0, 30.0),
                2.0 * ((cosine - end) / (full - end)).powi(2),
            ),
            (spot(5.0, 15.0), 0.0),
        ] {
            let mut left = scene(&text(&rest));
            left.remove_effects(Effects::FALLOFF);
            let [Light::Point { color, .. }] = left.lights[..] else {
                panic!("{:?}", left.lights);
            };
            assert!((color[0] - expected).abs() < 1e-9, "{rest}: {color:?}");
        }
    }

    #[test]
    fn lights_without_falloff_lose_nothing() {
        let point = "[[light]]\nkind = 'point'\nposition = [0, 9, 0]\n";
        let sun = "[[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\n";
        for lights in [String::new(), point.to_owned(), sun.to_owned() + point] {
            let mut scene = scene(&format!("{lights}{FLOOR}"));
            for effect in [Effects::FALLOFF, Effects::AREA_LIGHT] {
                assert_eq!(leave_one_out(&mut scene, effect), None, "{lights}");
            }
        }
    }

    #[test]
    fn only_spheres_that_are_lost_are_said_not_to_be_seen() {
        const DISC: &str = "[[light]]\nkind = 'disc'\ncenter = [0, 2, 0]\nradius = 1\nnormal = [0, -1, 0]\n\
            radiance = 1\nvisible = true\n";
        let hidden = VISIBLE.replace("visible = true\n", "");
        let shadowless = format!("render.shadows = false\n{GLOWING}");
        for (lamp, is_lost) in [
            (GLOWING, true),
            (VISIBLE, true),
            (DISC, false),
            (&hidden, false),
            (&shadowless, false),
        ] {
            for effect in [Effects::AREA_LIGHT, Effects::FALLOFF] {
                let mut scene = scene(&format!("{lamp}{FLOOR}"));
                let sentences = crate::scene::leave_out(&mut scene, &[effect]);
                let says = sentences[0].ends_with("; spheres that shine are not seen");
                assert_eq!(says, is_lost, "{sentences:?}");
            }
        }
    }

    #[test]
    fn spheres_that_glow_stay_where_nothing_blocks_light() {
        let mut scene = scene(&format!("render.shadows = false\n{GLOWING}{FLOOR}"));
        scene.remove_effects(Effects::AREA_LIGHT);
        assert_eq!(scene.objects.len(), 2);
    }
}
