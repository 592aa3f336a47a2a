//! The lens of a camera as a record.

use crate::compile::CompileError;
use crate::scene::{Camera, Lens};
use crate::shape::Lattice;
use gridel_core::format::lens;
use gridel_core::format::limits::FARTHEST;

/// Fractions of a unit.
const STEPS: f64 = 8192.0;

/// The record of a lens, whose focus is the camera's target unless it says otherwise. Lengths are at least a step.
pub(super) fn record(
    lens: Option<&Lens>,
    camera: &Camera,
    lattice: &Lattice,
) -> Result<Option<lens::Lens>, CompileError> {
    let Some(lens) = lens else {
        return Ok(None);
    };
    let to_target = (camera.target - camera.eye).length();
    let steps = |length: f64| (length / lattice.unit() * STEPS).round().max(1.0);
    let (radius, focus) = (steps(lens.radius), steps(lens.focus.unwrap_or(to_target)));
    // Rays start from all of the lens.
    let eye = lattice.in_units(camera.eye).abs().max_element() * STEPS;
    let most_radius = FARTHEST as f64 - eye.ceil();
    for (what, found, most, part) in [
        ("aperture", radius, most_radius, 2.0),
        ("focus", focus, FARTHEST as f64, 1.0),
    ] {
        if found.is_nan() || found > most {
            let length = |steps: f64| part * steps / STEPS * lattice.unit();
            return Err(CompileError::Lens {
                what,
                found: length(found),
                most: length(most),
            });
        }
    }
    Ok(Some(lens::Lens {
        radius: radius as i64,
        focus: focus as i64,
    }))
}

#[cfg(test)]
mod tests {
    use crate::compile::{CompileError, Options, compile};
    use crate::scene::read;

    fn compiled(lens: &str) -> Result<crate::compile::Compiled, CompileError> {
        let text = format!(
            "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n{lens}\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1"
        );
        let imported = read("lens.toml".as_ref(), text.into(), &Default::default());
        compile(&imported.unwrap().scene, &Options::default())
    }

    #[test]
    fn lenses_end_where_rays_may_not_start() {
        type Text = fn(f64) -> String;
        let keys: [(&str, Text); 2] = [
            ("aperture", |length| format!("aperture = {length:e}")),
            ("focus", |length| {
                format!("aperture = 1\nfocus = {length:e}")
            }),
        ];
        for (key, lens) in keys {
            let Err(CompileError::Lens { what, most, .. }) = compiled(&lens(1e300)) else {
                panic!("{key} is accepted");
            };
            assert!(what == key && most > 4e6, "{what} {most}");
            for (part, fits) in [(1.0 - 1e-9, true), (1.0 + 1e-9, false)] {
                let found = compiled(&lens(part * most));
                assert_eq!(found.is_ok(), fits, "{key} {part}");
            }
            let least = compiled(&lens(1e-300)).unwrap().blob;
            assert!(least.scene().unwrap().lens().is_some(), "{key}");
        }
    }
}
