//! Warnings of a scene file: what the compiler reports, and what is lost with effects that are left out.

use crate::cli::output::warn;
use gridel_core::Effects;
use gridel_host::scene::{self, Scene};
use gridel_host::table::printable;
use std::path::Path;

/// Warns of what the compiler reports of a file, and adds it to the file's other warnings.
pub fn warn_of_file(path: &Path, sentences: Vec<String>, warnings: &mut Vec<String>) {
    for sentence in sentences {
        let warning = format!("{}: {sentence}", path.display());
        warn(&warning);
        warnings.push(warning);
    }
}

/// Leaves effects out of the scene of a file, and reports what each of them loses.
pub fn leave_out(scene: &mut Scene, path: &Path, effects: &[Effects]) -> Vec<String> {
    let file = path.display();
    // One that is left out can take another along.
    let whole = (effects.len() > 1).then(|| scene.clone());
    let was_called_for = |effect| {
        let whole = whole.clone();
        whole.is_some_and(|mut scene| scene::leave_out(&mut scene, effect).is_some())
    };
    let lost = effects
        .iter()
        .filter_map(|&effect| match scene::leave_out(scene, effect) {
            None if was_called_for(effect) => None,
            None => Some(format!(
                "{file}: the scene does not call for {effect}, so nothing is left out"
            )),
            Some(names) => Some(format!(
                "{file}: without {effect}{}: {}",
                lost_by(&names),
                scene::shown_without(effect)
            )),
        });
    lost.collect()
}

/// Names what loses an effect.
fn lost_by(names: &[String]) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(text: &str) -> Scene {
        let sphere = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
        let file = format!("{text}{sphere}");
        let imported = scene::read("s.toml".as_ref(), file.into(), &Default::default());
        imported.unwrap().scene
    }

    #[test]
    fn effects_that_are_left_out_twice_are_named_once() {
        let light = "[[light]]\nkind = 'sphere'\ncenter = [0, 5, 0]\nradius = 1\nradiance = 1\n";
        for effects in [
            [Effects::AREA_LIGHT; 2],
            [Effects::FALLOFF, Effects::AREA_LIGHT],
        ] {
            let lines = leave_out(&mut scene(light), "s.toml".as_ref(), &effects);
            assert_eq!(lines.len(), 1, "{lines:?}");
            assert!(!lines[0].contains("does not call"), "{lines:?}");
        }
        let lines = leave_out(&mut scene(light), "s.toml".as_ref(), &[Effects::GLASS]);
        assert!(lines[0].contains("does not call for glass"), "{lines:?}");
    }
}
