//! A scene file from top to bottom.

use super::census::Census;
use super::import::Imports;
use super::imported_track::{ImportPlace, lost, with_imported};
use super::item::{Content, Item};
use super::joint::{self, Joints};
use super::material::Materials;
use super::morph::{self, Morphs};
use super::object::Reader;
use super::part;
use super::place::Placer;
use super::source::Source;
use super::track::{self, Targets};
use super::value::{Fields, Value};
use super::{environment, light, view};
use crate::scene::access::Access;
use crate::scene::importer::Input;
use crate::scene::light_form::scale_of;
use crate::scene::texture::Images;
use crate::scene::{Camera, Color, Light, Places, RenderSettings, Scene, SceneError, Track};
use crate::table::printable;
use glam::DVec3;
use std::collections::{BTreeMap, HashSet};

const KEYS: &[&str] = &[
    "camera",
    "render",
    "background",
    "ambient",
    "environment",
    "light",
    "material",
    "object",
    "group",
    "part",
    "instance",
    "joint",
    "room",
    "morph",
    "track",
];

const BLACK: Color = [0.0; 3];

pub(super) fn read(input: Input<'_>, imports: &mut Imports) -> Result<Scene, SceneError> {
    let options = input.options;
    let source = Source::new(input.path, input.bytes)?;
    let document = source.parse()?;
    let root = Fields::new(
        &source,
        document.span(),
        document.get_ref(),
        "scene",
        &[KEYS],
    )?;
    let (mut scene, given) = surroundings(&root, input.access)?;
    let tracks = root.or("track", Vec::new(), |tables| {
        track::read(tables, &mut imports.keys)
    })?;
    let mut images = Images::new(input.access);
    let mut materials = root.or("material", Materials::default(), |tables| {
        Materials::read(tables, &mut images)
    })?;

    let mut morphs = root.or("morph", Morphs::default(), morph::read)?;
    let mut reader = Reader {
        source: &source,
        imports,
        molecule: options.molecule,
        assembly: options.assembly,
        materials: &mut materials,
        morphs: &mut morphs,
        inside: 0,
    };
    let groups = root.or("group", BTreeMap::new(), |tables| reader.groups(tables))?;
    let items = root.or("object", Vec::new(), |list| reader.items(list))?;
    let parts = root.or("part", Vec::new(), |list| reader.parts(list))?;
    let joints = root.or("joint", Joints::default(), joint::read)?;
    let instances = root.or("instance", Vec::new(), |list| {
        part::instances(list, &parts, &joints)
    })?;
    let room = root.or("room", None, |value| joint::room(value).map(Some))?;

    let taken = Census::new(&source, &groups, &materials).take(&items, &parts)?;
    imports.warnings.extend(taken.warnings);
    imports
        .warnings
        .extend(part::unplaced(&source, &parts, &instances));
    imports
        .warnings
        .extend(joint::unused(&source, &joints, &instances));
    let placer = Placer::new(&source, &groups, &mut materials, taken.objects);
    let placed = placer.place(&items, &parts, &instances, &joints.items)?;
    imports.warnings.extend(placed.warnings);

    scene.objects = placed.objects;
    scene.parts = placed.parts;
    scene.instances = placed.instances;
    scene.joints = placed.joints;
    scene.room = room;
    let mut imported_tracks = Vec::new();
    for item in &items {
        imported_tracks.extend(given.complete(&mut scene, &source, item)?);
    }
    let targets = Targets {
        source: &source,
        lights: &scene.lights,
        light_forms: &scene.light_forms,
        light_names: &scene.light_names,
        materials: &materials,
        joints: &joints,
        morphs: &morphs,
    };
    imported_tracks.extend(placed.tracks);
    imported_tracks.extend(morphs.tracks.iter().cloned());
    scene.tracks = with_imported(targets.resolve(tracks)?, imported_tracks);
    scene.materials = materials.into_vec();
    scene.morph_targets = morphs.targets;
    imports.warnings.extend(moving_nothing(&scene));
    imports.warnings.extend(morph::unused(&scene));
    Ok(scene)
}

/// Reads a scene without its objects and materials: what it is seen and lit by, and how it is rendered.
fn surroundings(root: &Fields<'_>, access: &Access) -> Result<(Scene, Given), SceneError> {
    let camera = root.or("camera", None, |table| view::camera(table).map(Some))?;
    let (camera, lens) = camera.map_or((None, None), |(camera, lens)| (Some(camera), lens));
    let render = root.or("render", None, |table| view::render(table).map(Some))?;
    let lights = root.or("light", Vec::new(), light::lights)?;
    let (lights, (light_names, (light_forms, light_places))): (Vec<_>, (Vec<_>, (Vec<_>, _))) =
        lights.into_iter().unzip();
    let background = root.or("background", None, |value| value.radiance().map(Some))?;
    let ambient = root.or("ambient", None, |value| value.radiance().map(Some))?;
    let environment = root.or("environment", None, |table| {
        environment::read(table, access).map(Some)
    })?;
    let given = Given {
        render,
        lights: !lights.is_empty(),
        background: background.is_some(),
        ambient: ambient.is_some(),
    };
    let scene = Scene {
        camera,
        lens,
        background,
        environment,
        ambient: ambient.unwrap_or(BLACK),
        lights,
        light_names,
        light_forms,
        render: render.unwrap_or_default(),
        places: Places {
            lights: light_places,
            aperture: root.place_of("camera", "aperture"),
            environment: root
                .get("environment")
                .map(Value::place)
                .unwrap_or_default(),
            bounces: root.place_of("render", "bounces"),
            tone_mapping: root.place_of("render", "tone_mapping"),
        },
        ..Scene::default()
    };
    Ok((scene, given))
}

/// Settings that the document itself states, which no import replaces.
struct Given {
    render: Option<RenderSettings>,
    lights: bool,
    background: bool,
    ambient: bool,
}

impl Given {
    /// Completes a scene by what an imported file has and the document lacks. Returns the file's tracks.
    fn complete(
        &self,
        scene: &mut Scene,
        source: &Source,
        item: &Item,
    ) -> Result<Vec<Track>, SceneError> {
        let Content::Import {
            scene: import,
            materials,
            ..
        } = &item.content
        else {
            return Ok(Vec::new());
        };
        let takes_camera = scene.camera.is_none() && import.camera.is_some();
        let place = ImportPlace {
            camera: takes_camera,
            lights: (!self.lights).then_some(scene.lights.len()),
            materials,
        };
        let tracks = place.tracks(source, item, import)?;
        if let (None, Some(camera)) = (scene.camera, import.camera) {
            scene.camera = Some(moved_camera(source, item, &camera)?);
            let scale = scale_of(&item.transform);
            scene.lens = import.lens.map(|lens| lens.scaled(scale));
            scene.places.aperture.clone_from(&import.places.aperture);
            if self.render.is_none() {
                scene.render = import.render;
                scene.places.bounces.clone_from(&import.places.bounces);
                let tones = &import.places.tone_mapping;
                scene.places.tone_mapping.clone_from(tones);
            }
        }
        if !self.lights {
            add_lights(scene, source, item, import)?;
        }
        self.complete_surroundings(scene, import);
        if let Some(room) = import.room {
            let room = joint::moved_room(room, &item.transform);
            scene.room = Some(scene.room.map_or(room, |own| joint::around(own, room)));
        }
        if !self.ambient && scene.ambient == BLACK {
            scene.ambient = import.ambient;
        }
        Ok(tracks)
    }

    /// Completes the environment, or else the background. An environment hides the background, so what an import has
    /// of one never meets what another file has of the other.
    fn complete_surroundings(&self, scene: &mut Scene, import: &Scene) {
        if scene.environment.is_some() {
            return;
        }
        if import.environment.is_some() && !self.background {
            scene.background = import.background;
            scene.environment.clone_from(&import.environment);
            let place = &import.places.environment;
            scene.places.environment.clone_from(place);
        } else {
            scene.background = scene.background.or(import.background);
        }
    }
}

/// Adds the lights of an imported file.
fn add_lights(
    scene: &mut Scene,
    source: &Source,
    item: &Item,
    import: &Scene,
) -> Result<(), SceneError> {
    scene.display_values |= import.display_values && !import.lights.is_empty();
    for (number, light) in import.lights.iter().enumerate() {
        let form = import.light_forms.get(number).copied().flatten();
        if let Some(shape) = form.and_then(|form| form.distorted(&item.transform)) {
            return Err(source.error(
                &item.span,
                format!("a {shape} light of this import becomes an ellipse, which no light is"),
                "scale the import evenly, or give this scene lights of its own",
            ));
        }
        let brightness = form.map_or(1.0, |form| form.moved_brightness(&item.transform));
        let light = moved_light(source, item, light, brightness)?;
        scene.lights.push(light);
        let name = import.light_names.get(number).cloned();
        scene.light_names.push(name.unwrap_or_default());
        scene.places.lights.push(import.places.light(number));
        scene
            .light_forms
            .push(form.map(|form| form.moved(&item.transform)));
    }
    Ok(())
}

/// A warning for each track of a material that no object has.
fn moving_nothing(scene: &Scene) -> Vec<String> {
    let used: HashSet<usize> = scene.all_objects().map(|it| it.material).collect();
    let tracks = scene.tracks.iter();
    tracks
        .filter(|track| track.target.is_of_material() && !used.contains(&track.index))
        .map(|track| {
            let name = printable(&scene.materials[track.index].name);
            format!(
                "{}: no object has the material {name}, so its track moves nothing",
                track.place
            )
        })
        .collect()
}

fn moved_camera(source: &Source, item: &Item, camera: &Camera) -> Result<Camera, SceneError> {
    let by = &item.transform;
    let moved = Camera {
        eye: by.transform_point3(camera.eye),
        target: by.transform_point3(camera.target),
        up: by.transform_vector3(camera.up),
        ..*camera
    };
    if moved.is_along_up() {
        return Err(lost(source, item, "camera"));
    }
    Ok(moved)
}

fn moved_light(
    source: &Source,
    item: &Item,
    light: &Light,
    brightness: f64,
) -> Result<Light, SceneError> {
    let by = &item.transform;
    let (moved, sound) = match *light {
        Light::Point { position, color } => {
            let position = by.transform_point3(position);
            let color = color.map(|channel| channel * brightness);
            (Light::Point { position, color }, position.is_finite())
        }
        Light::Directional { direction, color } => {
            let direction = by.transform_vector3(direction);
            let sound = direction.is_finite() && direction != DVec3::ZERO;
            (Light::Directional { direction, color }, sound)
        }
    };
    if sound {
        Ok(moved)
    } else {
        Err(lost(source, item, "light"))
    }
}
