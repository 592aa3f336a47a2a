//! Camera, lights and materials as records, and the effects that they require.

use super::CompileError;
use super::camera::place;
use super::checkerboard::{LARGEST_CELL, checker_origin, has_large_cells};
use super::coordinates::Coordinates;
use super::environment::EnvironmentData;
use super::exposure::Exposure;
use super::extent::Shapes;
use super::framing::{BACKGROUND, framing_of};
use super::joints;
use super::lens;
use super::light_forms::{FormedLight, form_record, lift};
use super::media::media;
use super::section::Section;
use super::textures::{TextureFigures, Textures};
use super::tracks;
use crate::scene::{Camera, Color, Diffuse, Light, Material, Object, Scene, ToneMapping};
use crate::shape::{Lattice, unit};
use crate::table::printable;
use bytemuck::Zeroable;
use glam::DVec3;
use gridel_core::Effects;
use gridel_core::format::lens::Lens;
use gridel_core::format::light_form::LightForm;
use gridel_core::format::limits::FARTHEST;
use gridel_core::format::record::{self, View};
use gridel_core::format::track::TrackTarget;

/// The ambient light that is supplied with a light, so that shadows are not black.
const AMBIENT: f64 = 0.15;

/// Everything of a blob that is not geometry.
#[derive(Debug)]
pub struct ShadingData {
    pub view: View,
    pub coordinates: Coordinates,
    pub lights: Vec<record::Light>,
    /// Properties of lights other than plain points.
    pub light_forms: Vec<LightForm>,
    /// The emission of each material that an object has; empty where none glows.
    pub emissions: Vec<record::Emission>,
    /// The lens of the camera, in place of a pinhole: one, or none.
    pub lens: Vec<Lens>,
    /// How often light may be reflected diffusely: one number, or none.
    pub bounces: Vec<u32>,
    /// The light around the scene.
    pub environment: Option<EnvironmentData>,
    /// The α of each material that an object has, up to the last rough one; empty where none is rough.
    pub roughnesses: Vec<i32>,
    /// The materials with a priority, from the highest on.
    pub media: Vec<u32>,
    /// For each form of a light, whether an object shows it; empty where none is rough.
    pub shown_forms: Vec<u8>,
    /// Materials that an object has.
    pub materials: Vec<record::Material>,
    /// For each object, its place in `materials`.
    pub object_material: Vec<u32>,
    pub effects: Effects,
    /// The names of the effects, and of the parts that require each.
    pub required_by: Vec<(String, Vec<String>)>,
    /// Parts that the scene lacks and the compiler supplied.
    pub supplied: Vec<String>,
    /// Textures.
    pub textures: Vec<Section>,
    /// How each texture is stored.
    pub texture_figures: Vec<TextureFigures>,
    /// Tracks and joints.
    pub tracks: Vec<Section>,
}

impl ShadingData {
    /// Compiles the shading data of a scene in which these meshes require these effects.
    pub fn of(
        shapes: &Shapes<'_>,
        lattice: &Lattice,
        (lowest, highest): (DVec3, DVec3),
        mut required_by: Vec<(Effects, String)>,
        texture_bytes: Option<u64>,
    ) -> Result<Self, CompileError> {
        let scene = shapes.scene();
        let mut supplied = Vec::new();
        let camera = scene.camera.unwrap_or_else(|| {
            supplied.push(String::from("a camera that shows the whole scene"));
            framing_of(shapes, None)
        });
        let background = scene.background.unwrap_or(match scene.camera {
            Some(_) => [0.0; 3],
            None => BACKGROUND,
        });
        let (mut lights, mut ambient) = (scene.lights.clone(), scene.ambient);
        let glows = |object: &Object| scene.materials[object.material].emission != [0.0; 3];
        let lights_itself = scene.render.bounces > 0 && scene.all_objects().any(glows);
        let is_lit = lights_itself || scene.environment.is_some();
        if lights.is_empty() && ambient == [0.0; 3] && !is_lit {
            let (direction, shoulder) = over_a_shoulder(shapes, &camera);
            supplied.push(format!(
                "a directional light from above the camera's {shoulder} shoulder, and some light from \
                 everywhere"
            ));
            lights.push(Light::Directional {
                direction,
                // With what comes from everywhere, white stays white and is not cut off.
                color: [1.0 - AMBIENT; 3],
            });
            ambient = [AMBIENT; 3];
        }
        if scene.camera.is_none() && scene.background.is_none() && scene.environment.is_none() {
            supplied.push(String::from("a light background"));
        }
        let size = (highest - lowest).max_element();
        let far = |what, point| on_lattice(lattice, size, what, point);
        let mut numbers: Vec<Option<u32>> = vec![None; scene.materials.len()];
        let mut materials = Vec::new();
        let mut textures = Textures::default();
        let mut object_material = Vec::with_capacity(scene.objects.len());
        for object in scene.all_objects() {
            let material = &scene.materials[object.material];
            if !object.shape.is_bounded() && has_large_cells(material, lattice) {
                return Err(CompileError::CheckerSize {
                    material: printable(&material.name),
                    most: LARGEST_CELL * lattice.unit(),
                });
            }
            let number = *numbers[object.material].get_or_insert_with(|| {
                let material = &scene.materials[object.material];
                let record = record::Material {
                    maps: textures.maps(material),
                    ..material_record(material, lattice)
                };
                required_by.push((
                    record.effects(),
                    format!("material {}", printable(&material.name)),
                ));
                materials.push(record);
                materials.len() as u32 - 1
            });
            object_material.push(number);
        }
        let (textures, of_textures) = textures.sections(scene.display_values, texture_bytes)?;
        let exposure = Exposure::of(scene);
        let mut emissions = Vec::new();
        for (material, number) in scene.materials.iter().zip(&numbers) {
            let Some(number) = number.filter(|_| material.emission != [0.0; 3]) else {
                continue;
            };
            let what = || format!("material {}", printable(&material.name));
            let emission = record::Emission {
                radiance: radiance(exposure.of_color(material.emission, what)?),
                lights: material.is_sampled.into(),
            };
            if emissions.len() <= number as usize {
                emissions.resize(number as usize + 1, record::Emission::default());
            }
            emissions[number as usize] = emission;
            required_by.push((Effects::EMISSION, what()));
        }
        let mut roughnesses = Vec::new();
        for (material, number) in scene.materials.iter().zip(&numbers) {
            let Some(number) = number.filter(|_| material.is_rough()) else {
                continue;
            };
            if roughnesses.len() <= number as usize {
                roughnesses.resize(number as usize + 1, 0);
            }
            let roughness = material.roughness.clamp(Material::LEAST_ROUGHNESS, 1.0);
            [roughnesses[number as usize], ..] = ratio([roughness * roughness; 3]);
            required_by.push((
                Effects::GLOSSY,
                format!("material {}", printable(&material.name)),
            ));
        }
        let media = media(scene, &numbers, &mut required_by)?;
        let mut light_forms = Vec::new();
        let mut shown_forms = Vec::new();
        let mut lights = lights
            .iter()
            .enumerate()
            .map(|(number, light)| {
                let form = scene.light_forms.get(number).copied().flatten();
                let (Some(form), Light::Point { position, color }) = (form, *light) else {
                    let light = exposure.of_light(light, number)?;
                    return light_record(&light, lattice, size, number);
                };
                let color = color.map(|channel| channel * exposure.factor);
                let position = position + lift(&form, lattice);
                let has_color_track = scene
                    .tracks
                    .iter()
                    .any(|track| (track.target, track.index) == (TrackTarget::LightColor, number));
                if !roughnesses.is_empty() {
                    shown_forms.push(u8::from(form.is_surface));
                }
                let nearest = position.clamp(lowest, highest) - position;
                let farthest = (highest - position).abs().max((lowest - position).abs());
                let (form, color) = form_record(
                    &FormedLight {
                        form: &form,
                        color,
                        label: &light_label(scene, number),
                        distances: [nearest.length(), farthest.length()],
                        has_color_track,
                    },
                    lattice,
                )?;
                let light = Light::Point { position, color };
                let directional =
                    record::Light::with_form(light_forms.len() as u32, form.shape != 0);
                light_forms.push(form);
                let record = light_record(&light, lattice, size, number)?;
                Ok(record::Light {
                    directional,
                    ..record
                })
            })
            .collect::<Result<Vec<_>, CompileError>>()?;
        let environment = scene.environment.as_ref();
        let environment = environment.map(|it| EnvironmentData::of(it, scene.up, &exposure));
        let environment = environment.transpose()?;
        if let Some(environment) = &environment {
            lights.extend(&environment.lights);
            required_by.push(EnvironmentData::required_by());
        }
        // A scene file may turn shadows off.
        let unwanted = if scene.render.shadows {
            Effects::NONE
        } else {
            Effects::SHADOW
        };
        let view = View {
            background: radiance(exposure.of_color(background, || String::from("background"))?),
            ambient: radiance(exposure.of_color(ambient, || String::from("ambient light"))?),
            ..view_record(scene)?
        };
        required_by.push((
            view.effects(),
            String::from("the `tone_mapping` of pictures"),
        ));
        let lens = lens::record(scene.lens.as_ref(), &camera, lattice)?;
        required_by.push((
            Effects::DEPTH_OF_FIELD.only_if(lens.is_some()),
            String::from("the camera's `aperture`"),
        ));
        let bounces = Some(scene.render.bounces).filter(|&bounces| bounces > 0);
        required_by.push((
            Effects::INDIRECT.only_if(bounces.is_some()),
            String::from("the `bounces` of pictures"),
        ));
        if scene.all_objects().next().is_some() {
            let effects = (0..).zip(lights.iter().map(record::Light::effects));
            required_by.extend(effects.map(|(number, effects): (usize, _)| {
                let effects = effects.without(unwanted.with(Effects::ENVIRONMENT));
                (effects, format!("light {number}"))
            }));
        }
        let effects = required_by
            .iter()
            .fold(Effects::NONE, |all, (effects, _)| all.with(*effects));
        let required_by = Effects::NAMED
            .iter()
            .filter(|(effect, _)| effects.contains(*effect))
            .map(|(effect, name)| {
                let callers = required_by
                    .iter()
                    .filter(|(effects, _)| effects.contains(*effect));
                (
                    String::from(*name),
                    callers.map(|(_, caller)| caller.clone()).collect(),
                )
            })
            .collect();

        far(String::from("camera"), camera.eye)?;
        let mut ways = tracks::places(&scene.tracks, &camera);
        ways.extend(joints::places(scene));
        let coordinates =
            Coordinates::choose(lattice, [lowest, highest], camera.eye, &scene.lights, &ways);
        let placed = place(&camera, &coordinates.header)?;
        let mut tracks = joints::kept_tracks(scene);
        exposure.change_tracks(&mut tracks);
        let mut tracks = tracks::sections(tracks, &camera, &numbers, &coordinates.header)?;
        tracks.extend(joints::sections(scene, &coordinates.header)?);
        Ok(Self {
            view: placed.replace_in(&view, &coordinates.header),
            coordinates,
            lights,
            light_forms,
            emissions,
            lens: lens.into_iter().collect(),
            bounces: bounces.into_iter().map(u32::from).collect(),
            environment,
            roughnesses,
            media,
            shown_forms,
            materials,
            object_material,
            effects,
            required_by,
            supplied,
            textures,
            texture_figures: of_textures,
            tracks,
        })
    }
}

/// Returns the direction of a light from above the camera's left shoulder, and the shoulder's name. The light comes
/// from the right one where flat surfaces that face the camera would otherwise be dark.
fn over_a_shoulder(shapes: &Shapes<'_>, camera: &Camera) -> (DVec3, &'static str) {
    /// By how many times more the right one must light.
    const CLEARLY: f64 = 2.0;
    let view = unit(camera.target - camera.eye);
    let up = unit(camera.up);
    let aside = 0.5 * unit(view.cross(up));
    let [left, right] = [aside, -aside].map(|aside| view + aside - 0.7 * up);
    let lit = |direction: DVec3| -> f64 {
        let towards = |normal: DVec3| normal * -normal.dot(view).signum();
        let mut sum = 0.0;
        shapes.each_face(|normal| sum += (-towards(normal).dot(direction)).max(0.0));
        sum
    };
    if lit(right) > CLEARLY * lit(left) {
        (right, "right")
    } else {
        (left, "left")
    }
}

/// The defaults of a picture; the camera is placed afterwards.
fn view_record(scene: &Scene) -> Result<View, CompileError> {
    let render = &scene.render;
    let encoding = match (render.tone_mapping, scene.display_values) {
        (ToneMapping::None, false) => 0,
        (ToneMapping::None, true) => View::DISPLAY_VALUES,
        (_, true) => return Err(CompileError::ToneMapping),
        (ToneMapping::Reinhard, false) => View::REINHARD,
        (ToneMapping::Aces, false) => View::ACES,
    };
    Ok(View {
        cutoff: radiance([render.cutoff; 3])[0],
        width: render.width.clamp(1, u16::MAX.into()) as u16,
        height: render.height.clamp(1, u16::MAX.into()) as u16,
        samples: render.samples,
        depth: render.depth.max(render.bounces),
        encoding,
        ..View::zeroed()
    })
}

/// A place that may lie beyond the scene, in units with 13 fraction bits.
fn on_lattice(
    lattice: &Lattice,
    size: f64,
    what: String,
    point: DVec3,
) -> Result<[i64; 3], CompileError> {
    let q13 = lattice.in_units(point) * 8192.0;
    let largest = q13.abs().max_element();
    if largest.is_nan() || largest > FARTHEST as f64 {
        let distance = (point - lattice.origin).length();
        return Err(CompileError::FarAway {
            what,
            distance,
            size,
        });
    }
    Ok(q13.round().to_array().map(|x| x as i64))
}

/// A light for messages: its number, and its name if it has one.
fn light_label(scene: &Scene, number: usize) -> String {
    match scene.light_names.get(number) {
        Some(name) if !name.is_empty() => format!("light {number} ({})", printable(name)),
        _ => format!("light {number}"),
    }
}

/// A light of a scene of some size.
pub fn light_record(
    light: &Light,
    lattice: &Lattice,
    size: f64,
    number: usize,
) -> Result<record::Light, CompileError> {
    Ok(match *light {
        Light::Point { position, color } => record::Light {
            vector: on_lattice(lattice, size, format!("light {number}"), position)?,
            color: radiance(color),
            directional: 0,
        },
        Light::Directional { direction, color } => {
            let towards = -unit(direction);
            let vector = (towards * f64::from(1 << 30))
                .round()
                .to_array()
                .map(|x| x as i64);
            record::Light {
                vector,
                color: radiance(color),
                directional: 1,
            }
        }
    })
}

fn material_record(material: &Material, lattice: &Lattice) -> record::Material {
    let (even, odd, checker_size, checker_origin) = match material.diffuse {
        Diffuse::Plain(color) => (color, color, 0, [0; 3]),
        Diffuse::Checker {
            even,
            odd,
            size,
            origin,
        } => {
            // At least one sub-step.
            let size = (size / lattice.unit()).max(1.0 / 8192.0);
            // On the lattice, as faces are that lie between two layers of cells.
            let step = lattice.step() / lattice.unit();
            let origin = (lattice.in_units(origin) / step).round() * step;
            let origin = origin.to_array().map(|x| checker_origin(x, size));
            let q13 = |units: f64| (units * 8192.0).round() as i32;
            (even, odd, q13(size.min(LARGEST_CELL)), origin.map(q13))
        }
    };
    let glass = material.transmit != [0.0; 3];
    record::Material {
        diffuse: ratio(even),
        odd: ratio(odd),
        checker_size,
        checker_origin,
        highlight: ratio(material.highlight),
        mirror: ratio(material.mirror),
        transmit: ratio(material.transmit),
        inverse_ior: ratio([1.0 / material.ior.clamp(1.0, 4.0); 3])[0],
        // The cast saturates: one unit of such glass lets nothing through anyway.
        absorption: material.absorption.map(|coefficient| {
            if glass {
                (coefficient * lattice.unit() * f64::powi(2.0, 32)).round() as u32
            } else {
                0
            }
        }),
        shininess: material.shininess.clamp(1, 1024),
        maps: 0,
    }
}

/// A color of light as a blob's records hold it: 20 fraction bits, 0 to 2,047.999999; saturates.
///
/// ```
/// assert_eq!(gridel_host::compile::radiance([1.0, 0.5, 0.0]), [1 << 20, 1 << 19, 0]);
/// assert_eq!(gridel_host::compile::radiance([1e9; 3]), [i32::MAX; 3]);
/// ```
pub fn radiance(color: Color) -> [i32; 3] {
    color.map(|channel| (channel * f64::from(1 << 20)).round().max(0.0) as i32)
}

/// Ratios with 30 fraction bits, 0 to 1.
fn ratio(color: Color) -> [i32; 3] {
    color.map(|channel| (channel.clamp(0.0, 1.0) * f64::from(1 << 30)).round() as i32)
}
