//! The effects of a scene, and what requires each.

use gridel_core::format::record::{Light, Material};
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
            let lights = scene.lights().iter().map(Light::effects);
            let lights = numbers_of("light", effect, lights);
            let materials = scene.materials().iter().map(Material::effects);
            let own =
                (of_meshes(scene).contains(effect)).then(|| String::from("the scene's own meshes"));
            let parts = numbers_of("part", effect, scene.parts().iter().map(of_meshes));
            lights
                .chain(numbers_of("material", effect, materials))
                .chain(own)
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
        write!(f, "{}, for {}", self.effect, shown.join(", "))?;
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
