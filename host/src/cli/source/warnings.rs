//! Changes of the compiler to a scene that its author would want to know.

use gridel_core::Effects;
use gridel_host::compile::{LATTICE_BITS, Report};
use gridel_host::scene::{self, Scene};
use gridel_host::table::{grouped, printable};
use std::path::Path;

/// All warnings of a compiled scene.
pub fn of_compiler(report: &Report, lattice_bits: u8) -> Vec<String> {
    let all = [
        report.environment.and_then(|it| it.warning()),
        far_moved(report, lattice_bits),
        names_changed(report),
    ];
    all.into_iter().flatten().collect()
}

/// Names the primitives that the lattice moves far.
fn far_moved(report: &Report, lattice_bits: u8) -> Option<String> {
    const NAMED: usize = 3;
    if report.far_moved.count() == 0 {
        return None;
    }
    let remedy = if lattice_bits < *LATTICE_BITS.end() {
        "use more `--lattice-bits`"
    } else {
        "make them thicker or larger"
    };
    Some(format!(
        "the lattice moves the surfaces of some solids by several steps, {}; {remedy}",
        report.far_moved.names(NAMED).join(", ")
    ))
}

/// Says which names the blob lacks or has in part.
fn names_changed(report: &Report) -> Option<String> {
    let names = report.names?;
    if names.left_out {
        return Some(String::from(
            "the names are left out, because the blob would exceed `--max-bytes`; raise it to keep them",
        ));
    }
    (names.shortened > 0).then(|| {
        format!(
            "{} cut to 255 bytes in the blob; give shorter names",
            match names.shortened {
                1 => String::from("1 name is"),
                many => format!("{} names are", grouped(many)),
            }
        )
    })
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
    use gridel_host::compile::{Options, compile};
    use gridel_host::scene::{Environment, Panorama, Sky};

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

    #[test]
    fn lost_light_of_an_environment_is_a_warning_of_the_compiler() {
        let mut pixels = vec![[1.0; 3]; 64 * 32];
        pixels[500] = [1e5; 3];
        let sky = Panorama::new("sky", 64, 32, pixels).unwrap();
        let mut scene = scene("");
        scene.environment = Some(Environment::of(Sky::Picture(sky.into())));
        let report = compile(&scene, &Options::default()).unwrap().report;
        let lines = of_compiler(&report, 16);
        assert!(lines[0].contains("of its light is lost"), "{lines:?}");
    }
}
