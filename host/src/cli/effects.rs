//! The effects of a scene, and what requires each.

use gridel_core::format::record::{Light, Material};
use gridel_core::{Effects, Scene};
use gridel_host::compile::Report;
use serde::Serialize;
use std::fmt;

/// An effect, and the names of what requires it.
#[derive(Serialize)]
pub struct CalledFor {
    effect: String,
    by: Vec<String>,
}

impl CalledFor {
    /// The effects of a scene file, whose lights and materials have names.
    pub fn in_report(report: &Report) -> Vec<Self> {
        let effects = report.effects.iter().cloned();
        effects.map(|(effect, by)| Self { effect, by }).collect()
    }

    /// The effects of a blob, whose lights and materials have numbers.
    pub fn in_blob(scene: &Scene<'_>) -> Vec<Self> {
        let callers = |effect: Effects| -> Vec<String> {
            let lights = scene.lights().iter().map(Light::effects);
            let lights = numbers_of("light", effect, lights);
            let materials = scene.materials().iter().map(Material::effects);
            let smooth = |scene: &Scene<'_>| match scene.normals() {
                0 => Effects::NONE,
                _ => Effects::SMOOTH,
            };
            let own =
                (smooth(scene).contains(effect)).then(|| String::from("the scene's own meshes"));
            let parts = numbers_of("part", effect, scene.parts().iter().map(smooth));
            lights
                .chain(numbers_of("material", effect, materials))
                .chain(own)
                .chain(parts)
                .collect()
        };
        Effects::NAMED
            .into_iter()
            .filter(|&(effect, _)| scene.effects().contains(effect))
            .map(|(effect, name)| Self {
                effect: name.to_owned(),
                by: callers(effect),
            })
            .collect()
    }
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
        let shown: Vec<_> = self.by.iter().take(SHOWN).map(String::as_str).collect();
        write!(f, "{}, for {}", self.effect, shown.join(", "))?;
        if self.by.len() > SHOWN {
            write!(f, " and {} more", self.by.len() - SHOWN)?;
        }
        Ok(())
    }
}
