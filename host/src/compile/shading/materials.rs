//! Materials as records, and the data that only some of them have.

use super::checkerboard::{LARGEST_CELL, checker_origin, has_large_cells};
use super::exposure::Exposure;
use super::lights::light_label;
use super::media::media;
use super::radiance::radiance;
use super::textures::{TextureFigures, Textures};
use crate::compile::CompileError;
use crate::compile::requirements::{Requirements, RequiringPart};
use crate::compile::section::{Section, indices, section};
use crate::scene::{Color, Diffuse, Material, Scene, Sends};
use crate::shape::Lattice;
use crate::table::printable;
use gridel_core::Effects;
use gridel_core::format::SectionKind;
use gridel_core::format::record;

/// The materials that objects have. Lists other than `records` are empty where no material needs them.
#[derive(Debug, Default)]
pub struct MaterialData {
    records: Vec<record::Material>,
    /// For each object, its place in `records`.
    of_objects: Vec<u32>,
    /// For each material of the scene its place in `records`, if an object has it.
    pub numbers: Vec<Option<u32>>,
    emissions: Vec<record::Emission>,
    /// The α of each material, up to the last rough one.
    roughnesses: Vec<i32>,
    /// The materials with a priority, from the highest on.
    media: Vec<u32>,
    textures: Vec<Section>,
    /// The storage of each texture.
    pub texture_figures: Vec<TextureFigures>,
}

impl MaterialData {
    /// Compiles the materials of a scene, whose textures may take so many bytes.
    pub fn of(
        scene: &Scene,
        lattice: &Lattice,
        exposure: &Exposure,
        texture_bytes: Option<u64>,
        requirements: &mut Requirements,
    ) -> Result<Self, CompileError> {
        let mut data = Self {
            numbers: vec![None; scene.materials.len()],
            ..Self::default()
        };
        let mut textures = Textures::default();
        let has_coordinates = with_coordinates(scene);
        let sends = scene.sends();
        for object in scene.all_objects() {
            let material = &scene.materials[object.material];
            if !object.shape.is_bounded() && has_large_cells(material, lattice) {
                let part = RequiringPart::new(label(material), &material.place);
                return Err(CompileError::CheckerSize {
                    material: part.to_string(),
                    most: LARGEST_CELL * lattice.unit(),
                });
            }
            let number = *data.numbers[object.material].get_or_insert_with(|| {
                // Maps that no object shows cost nothing.
                let maps = match has_coordinates[object.material] {
                    true => textures.maps(material),
                    false => 0,
                };
                let record = record::Material {
                    maps,
                    ..material_record(material, sends[object.material], lattice)
                };
                requirements.add(record.effects(), label(material), &material.place);
                data.records.push(record);
                data.records.len() as u32 - 1
            });
            data.of_objects.push(number);
        }
        (data.textures, data.texture_figures) =
            textures.sections(scene.display_values, texture_bytes)?;
        let materials = scene.materials.iter().zip(sends);
        for (index, ((material, sends), number)) in materials.zip(&data.numbers).enumerate() {
            let Some(number) = *number else {
                continue;
            };
            if material.emission != [0.0; 3] {
                let color =
                    exposure.of_color(material.emission, || match shown_light(scene, index) {
                        Some(light) => light_label(scene, light),
                        None => label(material),
                    })?;
                let emission = record::Emission {
                    radiance: radiance(color),
                    lights: material.is_sampled.into(),
                };
                put(&mut data.emissions, number, emission);
                requirements.add(Effects::EMISSION, label(material), &material.place);
            }
            if material.roughness > 0.0 && sends.any() {
                let roughness = material.roughness.clamp(Material::LEAST_ROUGHNESS, 1.0);
                let [alpha, ..] = ratio([roughness * roughness; 3]);
                put(&mut data.roughnesses, number, alpha);
                let part = match material.is_rough() {
                    true => label(material),
                    false => format!("a track of {}", label(material)),
                };
                requirements.add(Effects::GLOSSY, part, &material.place);
            }
        }
        data.media = media(scene, &data.numbers, requirements)?;
        Ok(data)
    }

    /// Returns true if a material is rough.
    pub fn are_rough(&self) -> bool {
        !self.roughnesses.is_empty()
    }

    /// Returns the sections of a blob that distinguishes this number of objects.
    pub fn sections(&self, objects: u32) -> Vec<Section> {
        let mut sections = vec![
            section(SectionKind::Materials, &self.records),
            section(SectionKind::Emissions, &self.emissions),
            section(SectionKind::Roughnesses, &self.roughnesses),
            section(SectionKind::Media, &self.media),
        ];
        // A part's objects that are not distinguished have no materials, either.
        if self.records.len() > 1 && self.of_objects.len() == objects as usize {
            sections.push(indices(SectionKind::ObjectMaterial, &self.of_objects, 1));
        }
        sections.extend(self.textures.iter().cloned());
        sections
    }
}

/// Returns for each material of a scene whether an object of it has texture coordinates.
pub fn with_coordinates(scene: &Scene) -> Vec<bool> {
    let mut found = vec![false; scene.materials.len()];
    for object in scene.all_objects() {
        found[object.material] |= object.attributes.has_coordinates();
    }
    found
}

/// Puts a material's value into a list that ends where all others have none.
fn put<T: Clone + Default>(values: &mut Vec<T>, number: u32, value: T) {
    let number = number as usize;
    if values.len() <= number {
        values.resize(number + 1, T::default());
    }
    values[number] = value;
}

/// A material for messages.
fn label(material: &Material) -> String {
    format!("material {}", printable(&material.name))
}

/// Returns the light that a material shows, if no file states the material.
fn shown_light(scene: &Scene, material: usize) -> Option<usize> {
    let place = &scene.materials[material].place;
    (0..scene.lights.len()).find(|&number| {
        let object = scene.object_of_light(number);
        object.is_some_and(|it| scene.objects[it].material == material)
            && scene.places.light(number) == *place
    })
}

fn material_record(material: &Material, sends: Sends, lattice: &Lattice) -> record::Material {
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
    let (absorption, shift) = match sends.transmits {
        true => absorption(material, lattice),
        false => ([0; 3], 0),
    };
    record::Material {
        diffuse: ratio(even),
        odd: ratio(odd),
        checker_size,
        checker_origin,
        highlight: ratio(material.highlight),
        mirror: ratio(material.mirror),
        transmit: ratio(material.transmit),
        inverse_ior: ratio([1.0 / material.ior.clamp(1.0, 4.0); 3])[0],
        absorption,
        shininess: material.shininess.clamp(1, 1024) | shift << 12,
        maps: 0,
    }
}

/// Returns the coefficients of glass as a record has them, and the power of two that multiplies them.
fn absorption(material: &Material, lattice: &Lattice) -> ([u32; 3], u16) {
    let scaled = |shift: i32| {
        let scale = lattice.unit() * f64::powi(2.0, 32 - shift);
        material.absorption.map(|it| (it * scale).round())
    };
    let most = f64::from(u32::MAX);
    let fits = |shift: &i32| scaled(*shift).iter().all(|&it| it <= most);
    // Beyond that the casts saturate: one step of such glass lets nothing through.
    let shift = (0..15).find(fits).unwrap_or(15);
    (scaled(shift).map(|it| it as u32), shift as u16)
}

/// Ratios with 30 fraction bits, 0 to 1.
fn ratio(color: Color) -> [i32; 3] {
    color.map(|channel| (channel.clamp(0.0, 1.0) * f64::from(1 << 30)).round() as i32)
}

#[cfg(test)]
mod tests {
    use crate::blob::Blob;
    use crate::compile::{Compiled, Options, compile};
    use crate::scene::read;
    use crate::state::{State, ticks};
    use gridel_core::{Effects, Tracks};

    /// Glass and steel, with these weights at rest and tracks.
    fn compiled(weights: [f64; 2], tracks: &str) -> Compiled {
        let [transmit, mirror] = weights;
        let file = format!(
            "[material.glass]\ndiffuse = 0\ntransmit = {transmit}\nabsorption = [2, 0.1, 2]\n\
             [material.steel]\ndiffuse = 0\nmirror = {mirror}\nroughness = 0.4\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'glass'\n\
             [[object]]\nkind = 'sphere'\ncenter = [3, 0, 0]\nradius = 1\nmaterial = 'steel'\n{tracks}"
        );
        let imported = read("m.toml".as_ref(), file.into(), &Default::default()).unwrap();
        compile(&imported.scene, &Options::default()).unwrap()
    }

    fn track(target: &str, last: f64) -> String {
        format!("[[track]]\ntarget = 'material.{target}'\ntimes = [0, 1]\nvalues = [0, {last}]\n")
    }

    #[test]
    fn materials_that_tracks_raise_are_those_with_the_same_values_at_rest() {
        let tracks = track("glass.transmit", 1.0) + &track("steel.mirror", 0.8);
        let moving = compiled([0.0, 0.0], &tracks);
        let still = compiled([1.0, 0.8], "").blob;
        let (scene, expected) = (moving.blob.scene().unwrap(), still.scene().unwrap());
        let tracks = Tracks::from_bytes(moving.blob.bytes()).unwrap();
        let state = State::at(&moving.blob, &scene, &tracks, ticks(&tracks, 1.0).unwrap()).unwrap();
        assert_eq!(state.materials, expected.materials());
        let at_end = state.apply(&scene).unwrap();
        assert_eq!(at_end.roughness(1), expected.roughness(1));
        assert!(at_end.roughness(1).is_some());
        assert_eq!(at_end.effects(), expected.effects());
        let mut effects = moving.report.effects.iter();
        let (_, glossy) = effects.find(|(name, _)| name == "glossy").unwrap();
        assert_eq!(
            glossy[0].to_string(),
            "a track of material steel (m.toml:5)"
        );
    }

    #[test]
    fn materials_that_tracks_leave_black_cost_nothing() {
        let tracks = track("glass.transmit", 0.0) + &track("steel.mirror", 0.0);
        let plain = |blob: Blob| {
            let scene = blob.scene().unwrap();
            assert_eq!(scene.materials()[0].absorption, [0; 3]);
            assert_eq!(scene.roughness(1), None);
            assert!(!scene.effects().contains(Effects::GLOSSY));
        };
        plain(compiled([0.0, 0.0], &tracks).blob);
        plain(compiled([0.0, 0.0], "").blob);
    }
}
