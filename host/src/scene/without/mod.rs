//! Scenes without some of their effects.
//!
//! A scene calls for an effect by certain settings. Without these the effect adds no byte to the blob and no
//! instruction to the program. Each effect has a row below, which removes the settings that call for it.
//! What needs more than a setting is in `lights.rs` and `materials.rs`.

mod lights;
mod materials;

use super::{Material, Normals, Object, Scene, ToneMapping};
use crate::table::printable;
use gridel_core::Effects;
use gridel_core::format::track::TrackTarget;
use lights::{remove_falloff, shrink_areas};
use materials::{average_checkers, average_textures, each_glass, make_smooth};
use std::borrow::Cow;

/// Takes away what calls for an effect.
type Removal = fn(&mut Scene);

/// For every effect: what shows where it was, and its removal.
const REMOVALS: [(Effects, &str, Removal); Effects::NAMED.len()] = [
    (
        Effects::SHADOW,
        "lights shine through all objects",
        |scene| scene.render.shadows = false,
    ),
    (
        Effects::HIGHLIGHT,
        "surfaces show their diffuse color alone under a light",
        |scene| {
            each_material(scene, |material| material.highlight = [0.0; 3]);
            remove_tracks(scene, TrackTarget::MaterialHighlight);
        },
    ),
    (
        Effects::GLOSSY,
        "rough mirrors and rough glass are smooth",
        make_smooth,
    ),
    (
        Effects::MIRROR,
        "mirrors show their diffuse color and highlights alone",
        |scene| {
            each_material(scene, |material| material.mirror = [0.0; 3]);
            remove_tracks(scene, TrackTarget::MaterialMirror);
        },
    ),
    (
        Effects::GLASS,
        "glass is opaque and shows its diffuse color and highlights alone",
        |scene| {
            each_material(scene, |material| material.transmit = [0.0; 3]);
            remove_tracks(scene, TrackTarget::MaterialTransmit);
        },
    ),
    (
        Effects::NESTED,
        "glass within glass is refracted at every face, as if each were alone",
        |scene| {
            each_material(scene, |material| {
                // Glass at rest alone has one.
                material.priority = material.priority.filter(|_| material.transmit == [0.0; 3]);
            });
        },
    ),
    (
        Effects::ABSORPTION,
        "glass is as clear in its depth as at its surface",
        |scene| each_glass(scene, |material| material.absorption = [0.0; 3]),
    ),
    (
        Effects::CHECKER,
        "checkerboards have the mean of their two colors",
        average_checkers,
    ),
    (Effects::SMOOTH, "meshes show their faces", |scene| {
        each_object(scene, |object| object.normals = Normals::default());
    }),
    (
        Effects::TEXTURE_LEVELS,
        "textures that are far away show single texels of their images",
        |scene| {
            each_material(scene, |material| {
                let maps = material.normal_map.as_mut().map(|it| &mut it.texture);
                let textures = material.texture.iter_mut().chain(maps);
                textures.for_each(|it| it.levels = false);
            });
        },
    ),
    (
        Effects::NORMAL_MAP,
        "bumps of normal maps are flat",
        |scene| each_material(scene, |material| material.normal_map = None),
    ),
    (
        Effects::VERTEX_COLORS,
        "meshes have the colors of their materials alone",
        |scene| each_object(scene, |object| object.attributes.colors.clear()),
    ),
    (
        Effects::TEXTURE,
        "surfaces have their diffuse color weighted by the mean of the image, and are there where its alpha hid them",
        average_textures,
    ),
    (
        Effects::ALPHA,
        "textures are opaque, also where they were not there",
        |scene| {
            each_material(scene, |material| {
                // Glass has none.
                material.alpha = material.alpha.filter(|_| material.transmit != [0.0; 3]);
            });
        },
    ),
    (
        Effects::FALLOFF,
        "lights are as bright everywhere as where the camera looks",
        remove_falloff,
    ),
    (
        Effects::AREA_LIGHT,
        "lights shine from their middles, and shadows have hard edges",
        shrink_areas,
    ),
    (
        Effects::TONE_MAPPING,
        "what is brighter than white is white",
        |scene| scene.render.tone_mapping = ToneMapping::None,
    ),
    (
        Effects::ENVIRONMENT,
        "rays that hit nothing show the background, and no light comes from there",
        |scene| scene.environment = None,
    ),
    (
        Effects::EMISSION,
        "what glows lights others and is dark itself",
        |scene| {
            if let Cow::Owned(expanded) = scene.with_emitters() {
                *scene = expanded;
            }
            each_material(scene, |material| material.emission = [0.0; 3]);
        },
    ),
    (
        Effects::DEPTH_OF_FIELD,
        "the picture is sharp everywhere",
        |scene| scene.lens = None,
    ),
    (
        Effects::INDIRECT,
        "surfaces do not light each other",
        |scene| scene.render.bounces = 0,
    ),
];

fn each_object(scene: &mut Scene, change: impl Fn(&mut Object)) {
    let in_parts = scene.parts.iter_mut().flat_map(|part| &mut part.objects);
    scene.objects.iter_mut().chain(in_parts).for_each(change);
}

fn each_material(scene: &mut Scene, change: impl Fn(&mut Material)) {
    scene.materials.iter_mut().for_each(change);
}

fn remove_tracks(scene: &mut Scene, target: TrackTarget) {
    scene.tracks.retain(|track| track.target != target);
}

impl Scene {
    /// Removes all that calls for some effects: the blob has no byte of them, and the program no code. Settings for
    /// other effects stay, except those that depend on them. Without glass nothing absorbs, and without a falloff
    /// lights have no area. A scene that loses its only light is dark.
    ///
    /// ```
    /// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
    /// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
    /// use gridel_core::Effects;
    /// use gridel_host::compile::{Options, compile};
    ///
    /// let mut scene = imported.scene;
    /// scene.remove_effects(Effects::SHADOW);
    /// let blob = compile(&scene, &Options::default())?.blob;
    /// assert_eq!(blob.scene()?.effects(), Effects::NONE);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn remove_effects(&mut self, effects: Effects) {
        let was_lit = self.is_lit();
        for (effect, _, remove) in REMOVALS {
            if effects.contains(effect) {
                remove(self);
            }
        }
        // No other light replaces what is gone.
        self.is_dark |= was_lit && !self.is_lit();
    }
}

/// Leaves effects out of a scene. Returns a sentence about each: what is lost, or that the scene does not call for it.
///
/// ```
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_core::Effects;
/// use gridel_host::scene::leave_out;
///
/// let mut scene = imported.scene;
/// let sentences = leave_out(&mut scene, &[Effects::SHADOW, Effects::GLASS]);
/// assert_eq!(sentences[0], "without shadow: lights shine through all objects");
/// assert_eq!(sentences[1], "the scene does not call for glass, so nothing is left out");
/// # Ok::<(), gridel_host::scene::SceneError>(())
/// ```
pub fn leave_out(scene: &mut Scene, effects: &[Effects]) -> Vec<String> {
    // One that is left out can take another along.
    let whole = (effects.len() > 1).then(|| scene.clone());
    let was_called_for = |effect| {
        let whole = whole.clone();
        whole.is_some_and(|mut scene| leave_one_out(&mut scene, effect).is_some())
    };
    let sentences = effects.iter().filter_map(|&effect| {
        let shrinks = [Effects::AREA_LIGHT, Effects::FALLOFF].contains(&effect);
        let spheres = match shrinks && lights::shows_spheres(scene) {
            true => "; spheres that shine are not seen",
            false => "",
        };
        match leave_one_out(scene, effect) {
            None if was_called_for(effect) => None,
            None => Some(format!(
                "the scene does not call for {effect}, so nothing is left out"
            )),
            Some(names) => Some(format!(
                "without {effect}{}: {}{spheres}",
                in_parentheses(&names),
                shown_without(effect)
            )),
        }
    });
    sentences.collect()
}

/// Names of what loses an effect.
fn in_parentheses(names: &[String]) -> String {
    const NAMED: usize = 5;
    let shown: Vec<_> = names
        .iter()
        .take(NAMED)
        .map(|name| printable(name))
        .collect();
    let more = match names.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    match shown.is_empty() {
        true => String::new(),
        false => format!(" ({}{more})", shown.join(", ")),
    }
}

/// Leaves one effect out, and returns the names of the lights, materials and objects that lose it. `None` for a scene
/// that does not call for it.
pub(super) fn leave_one_out(scene: &mut Scene, effect: Effects) -> Option<Vec<String>> {
    let before = scene.clone();
    scene.remove_effects(effect);
    if *scene == before {
        return None;
    }
    let materials = before.materials.iter().zip(&scene.materials);
    let materials = materials.filter(|(old, new)| old != new);
    // Some objects may be gone.
    let mut left = scene.all_objects().peekable();
    let objects = before.all_objects().filter(move |old| {
        let new = left.next_if(|new| (&new.name, &new.place) == (&old.name, &old.place));
        new != Some(old)
    });
    let lights = (0..before.lights.len()).filter(|&number| {
        let form = |scene: &Scene| scene.light_forms.get(number).copied().flatten();
        form(&before) != form(scene)
    });
    let lights = lights.map(|number| match before.light_names.get(number) {
        Some(name) if !name.is_empty() => format!("light `{name}`"),
        _ => format!("light {number}"),
    });
    let names = lights.chain(materials.map(|(old, _)| format!("material `{}`", old.name)));
    let names = names.chain(objects.map(|old| format!("object `{}`", old.name)));
    Some(names.collect())
}

/// Returns what the picture shows without a single effect, as part of a sentence.
///
/// ```
/// use gridel_core::Effects;
/// use gridel_host::scene::shown_without;
///
/// assert_eq!(shown_without(Effects::SHADOW), "lights shine through all objects");
/// ```
pub fn shown_without(effect: Effects) -> &'static str {
    let row = REMOVALS.iter().find(|(of, ..)| *of == effect);
    row.map_or("", |(_, shown, _)| shown)
}

/// Returns the effect of a name: the name of its Cargo feature.
pub fn effect_named(name: &str) -> Option<Effects> {
    let row = Effects::NAMED.into_iter().find(|(_, own)| *own == name);
    row.map(|(effect, _)| effect)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::scene::{Alpha, Image, NormalMap, Shape, Texture, read};
    use glam::DVec2;

    /// Calls for every effect.
    const ALL: &str = "
        [[light]]
        kind = 'point'
        position = [4, 5, 6]
        color = [1, 1, 1]
        [camera]
        eye = [0, 0, 9]
        target = [0, 0, 0]
        aperture = 0.5
        [render]
        tone_mapping = 'aces'
        bounces = 2
        [environment]
        zenith = 1
        horizon = 0.5
        ground = 0
        [material.lamp]
        emission = 2
        [[object]]
        kind = 'box'
        min = [8, 8, 8]
        max = [9, 9, 9]
        material = 'lamp'
        [[light]]
        kind = 'rectangle'
        corner = [4, 5, 6]
        edges = [[1, 0, 0], [0, 1, 0]]
        radiance = 9
        [material.all]
        diffuse = [0.5, 0.5, 0.5]
        highlight = [0.3, 0.3, 0.3]
        mirror = [0.2, 0.2, 0.2]
        roughness = 0.4
        transmit = [0.4, 0.4, 0.4]
        priority = 1
        absorption = [0.1, 0.2, 0.3]
        [material.squares]
        checker = { even = [1, 1, 1], odd = [0, 0, 0], size = 0.5 }
        [[object]]
        kind = 'sphere'
        center = [0, 0, 0]
        radius = 1
        material = 'all'
        [[object]]
        kind = 'mesh'
        vertices = [[0, 0, 0], [2, 0, 0.1], [2, 2, 0], [0, 2, 0.1]]
        faces = [[0, 1, 2], [0, 2, 3]]
        smooth = 90
        colors = ['#ff0000', '#00ff00', '#0000ff', '#ffffff']
        material = 'squares'
        [[track]]
        target = 'material.all.highlight'
        times = [0]
        values = [[0.5, 0.5, 0.5]]
        [[track]]
        target = 'material.all.mirror'
        times = [0]
        values = [[0.5, 0.5, 0.5]]
        [[track]]
        target = 'material.all.transmit'
        times = [0]
        values = [[0.5, 0.5, 0.5]]
        [[track]]
        target = 'material.squares.checker.odd'
        times = [0]
        values = [[0.5, 0.5, 0.5]]
    ";

    fn scene() -> Scene {
        let imported = read("all.toml".as_ref(), ALL.into(), &Default::default());
        let mut scene = imported.unwrap().scene;
        let image = Image::new("two", 2, 1, vec![[0, 0, 0, 255], [255; 4]]);
        // Glass has no alpha.
        let mut materials = scene.materials.iter_mut();
        let squares = materials.find(|it| it.name == "squares").unwrap();
        let leveled = |image: Image| Texture {
            levels: true,
            ..Texture::of(image.into())
        };
        squares.texture = image.map(leveled);
        squares.alpha = Some(Alpha::Blend(0.5));
        squares.normal_map = Some(NormalMap {
            texture: leveled(Image::blank()),
            scale: 1.0,
        });
        // Maps are stored for objects that have texture coordinates.
        let mut objects = scene.objects.iter_mut();
        let mesh = objects.find(|it| matches!(it.shape, Shape::Mesh { .. }));
        let attributes = &mut mesh.unwrap().attributes;
        attributes.coordinates = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
        attributes.triangles = vec![[0, 1, 2], [0, 1, 2]];
        scene
    }

    fn effects(scene: &Scene) -> Effects {
        let blob = compile(scene, &Options::default()).unwrap().blob;
        blob.scene().unwrap().effects()
    }

    #[test]
    fn scenes_that_lose_their_only_light_are_dark() {
        let sphere =
            "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'own'\n";
        let environment = "[environment]\nzenith = 1\nhorizon = 1\nground = 1\n[material.own]\n";
        let glow = "render.bounces = 1\n[material.own]\nemission = 1\nlights = false\n";
        for (text, effect) in [
            (environment, Effects::ENVIRONMENT),
            (glow, Effects::EMISSION),
            (glow, Effects::INDIRECT),
        ] {
            let text = format!("{text}{sphere}");
            let imported = read("dark.toml".as_ref(), text.into(), &Default::default());
            let mut scene = imported.unwrap().scene;
            scene.remove_effects(effect);
            let blob = compile(&scene, &Options::default()).unwrap().blob;
            let compiled = blob.scene().unwrap();
            assert_eq!(compiled.lights().len(), 0, "{effect}");
            assert_eq!(compiled.view().ambient, [0; 3], "{effect}");
        }
    }

    /// A new effect needs what calls for it in the scene above, and a row in the table of removals.
    #[test]
    fn scene_without_an_effect_does_not_call_for_it() {
        assert_eq!(effects(&scene()), Effects::ALL);
        for (effect, name) in Effects::NAMED {
            let mut scene = scene();
            scene.remove_effects(effect);
            let left = effects(&scene);
            assert!(!left.contains(effect), "{name}: {left}");
            assert_eq!(leave_one_out(&mut scene, effect), None, "{name}");
            let depends = match effect {
                Effects::GLASS => Effects::ABSORPTION.with(Effects::NESTED),
                Effects::FALLOFF => Effects::AREA_LIGHT,
                Effects::TEXTURE => Effects::ALPHA,
                _ => Effects::NONE,
            };
            assert_eq!(
                left,
                Effects::ALL.without(effect).without(depends),
                "{name}"
            );
            assert!(!shown_without(effect).is_empty(), "{name}");
        }
        let mut scene = scene();
        scene.remove_effects(Effects::ALL);
        assert_eq!(effects(&scene), Effects::NONE);
    }

    #[test]
    fn effects_that_are_left_out_twice_are_named_once() {
        let text = "[[light]]\nkind = 'sphere'\ncenter = [0, 5, 0]\nradius = 1\nradiance = 1\n\
                    [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
        let imported = read("s.toml".as_ref(), text.into(), &Default::default()).unwrap();
        for effects in [
            [Effects::AREA_LIGHT; 2],
            [Effects::FALLOFF, Effects::AREA_LIGHT],
        ] {
            let sentences = leave_out(&mut imported.scene.clone(), &effects);
            assert_eq!(sentences.len(), 1, "{sentences:?}");
            assert!(!sentences[0].contains("does not call"), "{sentences:?}");
        }
    }
}
