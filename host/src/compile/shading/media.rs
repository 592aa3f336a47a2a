//! The order of glass that overlaps.

use crate::compile::CompileError;
use crate::compile::requirements::Requirements;
use crate::scene::Scene;
use crate::table::printable;
use gridel_core::Effects;
use gridel_core::format::limits::MAX_MEDIA;
use std::cmp::Reverse;

/// Returns the numbers of the materials with a priority, from the highest on. `numbers` are the materials that objects
/// have. Equal ones keep the order of the scene file.
pub fn media(
    scene: &Scene,
    numbers: &[Option<u32>],
    requirements: &mut Requirements,
) -> Result<Vec<u32>, CompileError> {
    let mut media = Vec::new();
    for (material, number) in scene.materials.iter().zip(numbers) {
        let priority = material.priority.filter(|_| material.transmit != [0.0; 3]);
        if let (Some(priority), Some(number)) = (priority, number) {
            media.push((Reverse(priority), *number));
            let name = printable(&material.name);
            let part = format!("the priority of material {name}");
            requirements.add(Effects::NESTED, part, &material.place);
        }
    }
    if media.len() > MAX_MEDIA {
        return Err(CompileError::Media { count: media.len() });
    }
    media.sort_by_key(|&(priority, _)| priority);
    Ok(media.into_iter().map(|(_, number)| number).collect())
}
