//! The effects of a scene, and what requires each.

use gridel_core::format::record::Material;
use gridel_core::{Effects, Scene};
use gridel_host::compile::{Names, Report, RequiringPart};
use gridel_host::measure::board::{MemoryReport, WORK_LIST};
use gridel_host::scene::{SourceSpan, effect_named};
use gridel_host::table::{grouped, printable};
use serde::Serialize;
use std::fmt;

/// An effect, and the parts that require it.
#[derive(Serialize)]
pub struct CalledFor {
    effect: String,
    by: Vec<RequiringPart>,
    /// Bytes of its code on a board, where programs were built with and without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    code: Option<u64>,
    /// Bytes of RAM on a board that the scene needs for this effect alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    ram: Option<u64>,
}

impl CalledFor {
    /// Returns the effects of a scene at all times, from the compiler's report if there is one. `moving` is the scene
    /// with all [raised](gridel_host::state::raised_materials) materials.
    pub fn at_all_times(
        report: Option<&Report>,
        scene: &Scene<'_>,
        moving: &Scene<'_>,
        blob: &[u8],
    ) -> Vec<Self> {
        let mut all = match report {
            Some(report) => Self::in_report(report),
            None => Self::in_blob(scene),
        };
        let names = Names::of_blob(scene, blob).unwrap_or_default().materials;
        let materials = scene.materials().iter().zip(moving.materials());
        for (number, (material, raised)) in materials.enumerate() {
            let more = raised.effects().without(material.effects());
            let name = names.get(number).filter(|name| !name.is_empty());
            let name = name.map_or(number.to_string(), |name| printable(name));
            let part = format!("a track of material {name}");
            for (_, effect) in Effects::NAMED.iter().filter(|it| more.contains(it.0)) {
                let part = RequiringPart::new(part.clone(), &SourceSpan::default());
                match all.iter_mut().find(|it| it.effect == *effect) {
                    Some(known) => known.by.push(part),
                    None => all.push(Self::new(effect, vec![part])),
                }
            }
        }
        all.sort_by_key(|it| {
            Effects::NAMED
                .iter()
                .position(|(_, name)| *name == it.effect)
        });
        all
    }

    fn new(effect: &str, by: Vec<RequiringPart>) -> Self {
        Self {
            effect: effect.to_owned(),
            by,
            code: None,
            ram: None,
        }
    }

    /// Returns the effects of a scene file, whose lights and materials have names.
    fn in_report(report: &Report) -> Vec<Self> {
        let effects = report.effects.iter().cloned();
        effects.map(|(effect, by)| Self::new(&effect, by)).collect()
    }

    /// Adds its costs on a board.
    pub fn add_costs(&mut self, scene: &Scene<'_>, report: &MemoryReport) {
        self.code = report.code_of(&self.effect);
        let (all, depth) = (scene.effects(), scene.view().depth);
        let rest = effect_named(&self.effect).map_or(all, |effect| all.without(effect));
        // Places for waiting rays, which no other effect needs.
        if all.work_depth(depth) > 0 && rest.work_depth(depth) == 0 {
            let mut items = report.ram.items.iter();
            let work_list = items.find(|item| item.what == WORK_LIST);
            self.ram = work_list.and_then(|item| item.bytes);
        }
    }

    /// Returns the effects of a blob, whose lights and materials have numbers.
    fn in_blob(scene: &Scene<'_>) -> Vec<Self> {
        let callers = |effect: Effects| -> Vec<RequiringPart> {
            let of_scene = of_scene(scene).into_iter();
            let of_scene = of_scene.filter(|(called, _)| called.contains(effect));
            let of_scene = of_scene.map(|(_, part)| String::from(part));
            // The environment stands for its own lights.
            let lights = scene.lights().iter();
            let lights = lights.map(|light| light.effects().without(Effects::ENVIRONMENT));
            let materials = (0..scene.materials().len()).map(|number| of_material(scene, number));
            let parts = numbers_of("part", effect, scene.parts().iter().map(of_meshes));
            numbers_of("light", effect, lights)
                .chain(numbers_of("material", effect, materials))
                .chain(of_scene)
                .chain(parts)
                .map(|part| RequiringPart::new(part, &SourceSpan::default()))
                .collect()
        };
        Effects::NAMED
            .into_iter()
            .filter(|&(effect, _)| scene.effects().contains(effect))
            .map(|(effect, name)| Self::new(name, callers(effect)))
            .collect()
    }
}

/// Returns the effects that a blob requires besides those of lights, materials and parts, and what requires them.
fn of_scene(scene: &Scene<'_>) -> [(Effects, &'static str); 5] {
    let environment = Effects::ENVIRONMENT.only_if(scene.environment().is_some());
    let aperture = Effects::DEPTH_OF_FIELD.only_if(scene.lens().is_some());
    let bounces = Effects::INDIRECT.only_if(scene.bounces() > 0);
    [
        (of_meshes(scene), "the scene's own meshes"),
        (environment, RequiringPart::ENVIRONMENT),
        (scene.view().effects(), RequiringPart::TONE_MAPPING),
        (aperture, RequiringPart::APERTURE),
        (bounces, RequiringPart::BOUNCES),
    ]
}

/// Returns the effects that a material of a blob requires, with those of the sections beside its record.
fn of_material(scene: &Scene<'_>, number: usize) -> Effects {
    let own = scene.materials().get(number).map(Material::effects);
    let emission = scene.emissions().get(number);
    let glows = emission.is_some_and(|emission| emission.radiance != [0; 3]);
    let roughness = scene.roughnesses().get(number);
    let is_rough = roughness.is_some_and(|&alpha| alpha > 0);
    let mut media = scene.media().iter();
    let has_priority = media.any(|&material| material as usize == number);
    own.unwrap_or_default()
        .with(Effects::EMISSION.only_if(glows))
        .with(Effects::GLOSSY.only_if(is_rough))
        .with(Effects::NESTED.only_if(has_priority))
}

/// Returns the effects that the vertices of a scene's own meshes require.
fn of_meshes(scene: &Scene<'_>) -> Effects {
    let normals = Effects::SMOOTH.only_if(scene.normals() > 0);
    normals.with(Effects::VERTEX_COLORS.only_if(!scene.vertex_colors().is_empty()))
}

/// The names of those that require an effect, counted from 0.
fn numbers_of(
    what: &str,
    effect: Effects,
    called: impl Iterator<Item = Effects>,
) -> impl Iterator<Item = String> {
    let numbers = (0_u32..).zip(called);
    numbers
        .filter(move |(_, called)| called.contains(effect))
        .map(move |(number, _)| format!("{what} {number}"))
}

impl fmt::Display for CalledFor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 5;
        let shown: Vec<_> = self
            .by
            .iter()
            .take(SHOWN)
            .map(RequiringPart::to_string)
            .collect();
        f.write_str(&self.effect)?;
        if !shown.is_empty() {
            write!(f, ", for {}", shown.join(", "))?;
        }
        if self.by.len() > SHOWN {
            write!(f, " and {} more", self.by.len() - SHOWN)?;
        }
        if let Some(code) = self.code {
            write!(f, "; {} bytes of code", grouped(code))?;
        }
        if let Some(ram) = self.ram {
            write!(f, "; {} bytes of RAM", grouped(ram))?;
        }
        Ok(())
    }
}
