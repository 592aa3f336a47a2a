//! The lens of a camera as a record.

use super::CompileError;
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
        // A unit is 2^-15 here, or somewhat less.
        for (lens, key) in [
            ("aperture = 1e7", "aperture"),
            ("aperture = 1e300", "aperture"),
            ("aperture = 1\nfocus = 5e6", "focus"),
            ("aperture = 1\nfocus = 1e308", "focus"),
        ] {
            let Err(CompileError::Lens { what, found, most }) = compiled(lens) else {
                panic!("{lens} is accepted");
            };
            assert_eq!(what, key);
            assert!(found > most && most > 4e6, "{lens}: {found}, {most}");
        }
        for lens in [
            "aperture = 8e6",
            "aperture = 1e-300",
            "aperture = 1\nfocus = 4e6",
            "aperture = 1\nfocus = 1e-300",
        ] {
            let blob = compiled(lens).unwrap().blob;
            assert!(blob.scene().unwrap().lens().is_some(), "{lens}");
        }
    }
}
