//! Values of splines between keys.

use crate::scene::{Interpolation, LARGEST_SCALE, LARGEST_WEIGHT, Track, turning_points};
use gridel_core::format::track::ValueKind;

/// Returns where a spline leads out of the range of fields of view, scales or weights, for an error. A device would
/// limit it: there is no picture then, or another one.
pub(super) fn beyond(track: &Track) -> Option<String> {
    let kind = track.target.kind();
    let is_limited = matches!(
        kind,
        ValueKind::FieldOfView | ValueKind::Scale | ValueKind::Weight
    );
    if !is_limited || track.interpolation != Interpolation::Cubic {
        return None;
    }
    let pairs = track.keys.windows(2);
    let mut times = pairs.flat_map(|pair| {
        let [begin, end] = [pair[0].seconds, pair[1].seconds];
        turning_points(&pair[0], &pair[1]).map(move |part| begin + part * (end - begin))
    });
    times.find_map(|seconds| {
        let [value, ..] = track.at(seconds);
        if kind == ValueKind::Weight {
            return (value.abs() > LARGEST_WEIGHT).then(|| {
                format!("at {seconds:.3} s the weight is {value:.3}; it must be from -64 to 64")
            });
        }
        if kind == ValueKind::Scale {
            return (value > LARGEST_SCALE).then(|| {
                format!("at {seconds:.3} s the scale is {value:.3}; it must be at most {LARGEST_SCALE}")
            });
        }
        (value <= 0.0 || value >= 180.0).then(|| {
            format!(
                "at {seconds:.3} s there is no picture, because the field of view is {value:.3} degrees; it must be \
                 above 0 and below 180"
            )
        })
    })
}

#[cfg(test)]
mod tests {
    use crate::compile::{CompileError, Options, compile};
    use crate::scene::read;

    fn compiled(keys: &str) -> Result<(), CompileError> {
        let file = format!(
            "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
             [camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
             [[track]]\ntarget = 'camera.fov'\ninterpolation = 'cubic'\n{keys}"
        );
        let imported = read("zoom.toml".as_ref(), file.into(), &Default::default()).unwrap();
        compile(&imported.scene, &Options::default()).map(|_| ())
    }

    #[test]
    fn splines_that_leave_the_range_of_fields_of_view_are_rejected() {
        let below = "times = [0, 1, 2]\nvalues = [40, 1, 40]\ntangents = [0, -40, 0]";
        let above = "times = [0, 2]\nvalues = [170, 170]\ntangents = [40, -40]";
        for (keys, found) in [(below, "is -"), (above, "at 1.000 s there is no picture")] {
            let error = compiled(keys).unwrap_err().to_string();
            let parts = [found, "field of view is", "zoom.toml:8", "camera.fov"];
            assert!(parts.iter().all(|it| error.contains(it)), "{error}");
        }
        assert!(
            compiled(above)
                .unwrap_err()
                .to_string()
                .contains("is 190.000 degrees")
        );
    }

    #[test]
    fn splines_that_lead_beyond_the_largest_weight_are_rejected() {
        let compiled = |tangent: f64| {
            let file = format!(
                "[morph.a]\n[[object]]\nkind = 'triangle'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
                 morph = {{ a = [[0, 0, 0], [0, 0, 0], [0, 0, 1]] }}\n\
                 [[track]]\ntarget = 'morph.a.weight'\ninterpolation = 'cubic'\n\
                 times = [0, 1]\nvalues = [60, 60]\ntangents = [{tangent}, -{tangent}]"
            );
            let imported = read("a.toml".as_ref(), file.into(), &Default::default()).unwrap();
            let options = Options {
                structures: vec![gridel_core::Structure::Bvh],
                ..Options::default()
            };
            compile(&imported.scene, &options).map(|_| ())
        };
        compiled(16.0).unwrap();
        let error = compiled(60.0).unwrap_err().to_string();
        assert!(error.contains("at 0.500 s the weight is 75.000"), "{error}");
    }

    #[test]
    fn splines_that_lead_beyond_the_largest_scale_are_rejected() {
        let compiled = |tangent: f64| {
            let file = format!(
                "[[part]]\nname = 'p'\n[[part.object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
                 [[joint]]\nname = 'j'\n[[instance]]\npart = 'p'\njoint = 'j'\n\
                 [[track]]\ntarget = 'joint.j.scale'\ninterpolation = 'cubic'\n\
                 times = [0, 1]\nvalues = [60, 60]\ntangents = [{tangent}, -{tangent}]"
            );
            let imported = read("j.toml".as_ref(), file.into(), &Default::default()).unwrap();
            compile(&imported.scene, &Options::default()).map(|_| ())
        };
        compiled(16.0).unwrap();
        let error = compiled(60.0).unwrap_err().to_string();
        for part in [
            "j.toml:12",
            "joint.j.scale: ",
            "at 0.500 s the scale is 75.000",
            "at most 64",
        ] {
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn splines_within_the_range_of_fields_of_view_are_compiled() {
        for keys in [
            "times = [0, 1, 2]\nvalues = [40, 1, 40]\ntangents = [0, 0, 0]",
            "times = [0, 1, 2]\nvalues = [40, 40, 40]",
            "times = [0, 2]\nvalues = [170, 170]\ntangents = [19, -19]",
            "times = [0, 2]\nvalues = [1, 179]\ntangents = [0, 0]",
            "times = [0]\nvalues = [40]",
        ] {
            compiled(keys).unwrap();
        }
    }
}
