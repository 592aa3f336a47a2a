//! Warnings about odd scenes, and about what the compiler changes of a scene.

use super::LATTICE_BITS;
use super::report::Report;
use super::requirements::RequiringPart;
use super::shading::{exposure_factor, light_label, radiance, with_coordinates};
use crate::scene::{BRIGHTEST, Color, Light, Material, Scene, Shape, SourceSpan};
use crate::shape::unit;
use crate::table::{counted, grouped, printable};

/// Distance from a plane within which an eye counts as in it, relative to the distance from the target.
const IN_PLANE: f64 = 1e-9;

/// Returns warnings about a scene's objects and its camera.
pub(super) fn scene_warnings(scene: &Scene) -> Vec<String> {
    let mut warnings = Vec::new();
    if scene.objects.is_empty() && scene.instances.is_empty() {
        warnings.push(String::from(
            "the scene has no object: pictures show the background",
        ));
    }
    warnings.extend(hidden_background(scene));
    warnings.extend(faint_light(scene));
    warnings.extend(unused_maps(scene));
    warnings.extend(lost_priorities(scene));
    let Some(camera) = scene.camera else {
        return warnings;
    };
    let near = IN_PLANE * camera.eye.distance(camera.target);
    let around = scene.objects.iter().find(|object| match &object.shape {
        Shape::Plane(plane) => (camera.eye - plane.point).dot(unit(plane.normal)).abs() <= near,
        _ => false,
    });
    warnings.extend(around.map(|plane| {
        format!(
            "the camera lies in the plane {} ({}), which hides all else: move its eye off the plane",
            printable(&plane.name),
            plane.place
        )
    }));
    warnings
}

/// Returns a warning if an environment hides the background.
fn hidden_background(scene: &Scene) -> Option<String> {
    let hides = scene.background.is_some() && scene.environment.is_some();
    hides.then(|| {
        let environment = RequiringPart::new(RequiringPart::ENVIRONMENT, &scene.places.environment);
        format!("{environment} is shown in place of the scene's background; remove one of the two")
    })
}

/// Most of a light that rounding may add or take without a warning.
const MOST_ROUNDING: f64 = 0.1;

/// Returns a warning of light that a blob's steps round to nothing, or by more than [`MOST_ROUNDING`]. Lights with a
/// form have exponents of their own.
fn faint_light(scene: &Scene) -> Option<String> {
    let factor = exposure_factor(scene);
    let is_faint = |color: Color| {
        let brightest = factor * color.into_iter().fold(0.0, f64::max);
        let rounded = f64::from(radiance([brightest; 3])[0]) / f64::from(1 << 20);
        (rounded - brightest).abs() > MOST_ROUNDING * brightest.min(BRIGHTEST)
    };
    let mut faint = Vec::new();
    for (number, light) in scene.lights.iter().enumerate() {
        let (Light::Point { color, .. } | Light::Directional { color, .. }) = *light;
        let has_form = matches!(scene.light_forms.get(number), Some(Some(_)));
        if !has_form && is_faint(color) {
            faint.push((light_label(scene, number), scene.places.light(number)));
        }
    }
    for material in scene.materials.iter().filter(|it| is_faint(it.emission)) {
        let label = format!("the emission of material {}", printable(&material.name));
        faint.push((label, material.place.clone()));
    }
    let background = scene.background.unwrap_or_default();
    for (name, color) in [
        ("the ambient light", scene.ambient),
        ("the background", background),
    ] {
        if is_faint(color) {
            faint.push((String::from(name), SourceSpan::default()));
        }
    }
    let ((label, place), rest) = faint.split_first()?;
    let first = RequiringPart::new(label.as_str(), place);
    let more = match rest.len() {
        0 => String::new(),
        more => format!(" and {} more", grouped(more)),
    };
    Some(format!(
        "{first}{more} is lost or changed by more than a tenth, because a blob stores light in steps of 2^-20 of white; \
         make it brighter, or raise the exposure"
    ))
}

/// Returns a warning for each material in use whose maps no object shows.
fn unused_maps(scene: &Scene) -> Vec<String> {
    let is_shown = with_coordinates(scene);
    let mut is_used = vec![false; scene.materials.len()];
    for object in scene.all_objects() {
        is_used[object.material] = true;
    }
    let all = scene.materials.iter().zip(is_shown.iter().zip(is_used));
    let unused = all.filter(|(_, (is_shown, is_used))| *is_used && !**is_shown);
    let warning = |(material, _): (&Material, _)| {
        let (map, verb) = match (&material.texture, &material.normal_map) {
            (Some(_), Some(_)) => ("texture and the normal map", "are"),
            (Some(_), None) => ("texture", "is"),
            (None, Some(_)) => ("normal map", "is"),
            (None, None) => return None,
        };
        let part = format!("material {}", printable(&material.name));
        let part = RequiringPart::new(part, &material.place);
        Some(format!(
            "the {map} of {part} {verb} not drawn, because no object of it has texture coordinates; give its meshes \
             `coordinates`"
        ))
    };
    unused.filter_map(warning).collect()
}

/// Returns a warning for each material that is glass by a track alone, and has a priority. A blob orders only glass at
/// rest.
fn lost_priorities(scene: &Scene) -> impl Iterator<Item = String> {
    let materials = scene.materials.iter().zip(scene.sends());
    let lost = materials.filter(|(material, sends)| {
        material.priority.is_some() && material.transmit == [0.0; 3] && sends.transmits
    });
    lost.map(|(material, _)| {
        let part = format!("material {}", printable(&material.name));
        let part = RequiringPart::new(part, &material.place);
        format!(
            "the `priority` of {part} is ignored, because it is glass by a track alone; write a `transmit` above 0 in \
             the material"
        )
    })
}

/// Primitives that a warning names; the rest are counted.
const NAMED: usize = 3;

impl Report {
    /// Returns all warnings of a scene that was compiled with this number of lattice bits.
    ///
    /// ```
    /// use gridel_host::compile::{Options, compile};
    /// use gridel_host::scene;
    ///
    /// let sphere = |x: f64, radius: f64| {
    ///     format!("[[object]]\nkind = 'sphere'\ncenter = [{x}, 0, 0]\nradius = {radius}\n")
    /// };
    /// let file = sphere(0.0, 1e6) + &sphere(3.0, 1e-3);
    /// let imported = scene::read("s.toml".as_ref(), file.into(), &Default::default())?;
    /// let report = compile(&imported.scene, &Options::default())?.report;
    /// assert!(report.warnings(24)[0].starts_with("1 primitive too small for the lattice, left out: "));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn warnings(&self, lattice_bits: u8) -> Vec<String> {
        let remedy = |otherwise| match lattice_bits < *LATTICE_BITS.end() {
            true => "use more lattice bits",
            false => otherwise,
        };
        let all = [
            self.environment.and_then(|it| it.warning()),
            (self.without_area.count() > 0).then(|| {
                format!(
                    "{} without area, left out: {}",
                    counted(self.without_area.count(), "primitive"),
                    self.without_area.names(NAMED).join(", ")
                )
            }),
            (self.collapsed.count() > 0).then(|| {
                format!(
                    "{} too small for the lattice, left out: {}; {}",
                    counted(self.collapsed.count(), "primitive"),
                    self.collapsed.names(NAMED).join(", "),
                    remedy("make them larger, or the scene smaller")
                )
            }),
            (self.flat_at_rest.count() > 0).then(|| {
                let count = self.flat_at_rest.count();
                let [it, its] = if count == 1 {
                    ["it", "its"]
                } else {
                    ["them", "their"]
                };
                format!(
                    "{} whose corners lie on a line at rest, left out at all times: {}; a morph target would open {it}, \
                     so move {its} corners apart, or state another `weight` at rest",
                    counted(count, "triangle"),
                    self.flat_at_rest.names(NAMED).join(", ")
                )
            }),
            (self.far_moved.count() > 0).then(|| {
                format!(
                    "the lattice moves the surfaces of some solids by several steps, {}; {}",
                    self.far_moved.names(NAMED).join(", "),
                    remedy("make them thicker or larger")
                )
            }),
            self.still_lights.as_ref().map(|name| {
                format!(
                    "{} glows, and its light stays where it is when its vertices move; write `lights = false` in \
                     its material, or keep it still",
                    printable(name)
                )
            }),
            self.keeps_rest.then(|| {
                String::from(
                    "meshes with morph targets keep their shape at rest: of all structures only bvh can be refitted, and \
                     others are built; choose `--accel bvh` alone",
                )
            }),
            self.names_changed(),
        ];
        let of_scene = self.scene_warnings.iter().cloned();
        all.into_iter().flatten().chain(of_scene).collect()
    }

    /// Says which names the blob lacks or has in part.
    fn names_changed(&self) -> Option<String> {
        let names = self.names?;
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
}

#[cfg(test)]
mod tests {
    use super::scene_warnings;
    use crate::compile::{Options, compile};
    use crate::scene::{self, Alpha, Environment, Image, NormalMap, Panorama, Sky, Texture};
    use gridel_core::Effects;

    #[test]
    fn lost_light_of_an_environment_is_a_warning_of_the_compiler() {
        let mut pixels = vec![[1.0; 3]; 64 * 32];
        pixels[500] = [1e5; 3];
        let sky = Panorama::new("sky", 64, 32, pixels).unwrap();
        let sphere = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
        let imported = scene::read("s.toml".as_ref(), sphere.into(), &Default::default());
        let mut scene = imported.unwrap().scene;
        scene.environment = Some(Environment::of(Sky::Picture(sky.into())));
        let report = compile(&scene, &Options::default()).unwrap().report;
        let lines = report.warnings(24);
        assert!(lines[0].contains("of its light is lost"), "{lines:?}");
    }

    #[test]
    fn light_below_the_steps_of_a_blob_is_a_warning() {
        let lines = |light: &str, exposure: f64| {
            let file = format!(
                "{light}\n[render]\nexposure = {exposure}\n\
                 [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n"
            );
            let imported = scene::read("s.toml".as_ref(), file.into(), &Default::default());
            scene_warnings(&imported.unwrap().scene)
        };
        let light = |color: &str, more: &str| {
            format!("[[light]]\nkind = 'point'\nposition = [0, 9, 0]\ncolor = {color}\n{more}")
        };
        let lost = |part: &str| {
            [format!(
                "{part} is lost or changed by more than a tenth, because a blob stores light in steps of 2^-20 of \
                 white; make it brighter, or raise the exposure"
            )]
        };
        assert_eq!(lines(&light("4e-7", ""), 0.0), lost("light 0 (s.toml:1)"));
        assert_eq!(lines(&light("1", ""), -25.0), lost("light 0 (s.toml:1)"));
        // By its brightest channel, which is 6.3 steps.
        assert_eq!(lines(&light("[6e-6, 1e-9, 0]", ""), 0.0).len(), 0);
        assert_eq!(lines(&light("1", ""), -17.0).len(), 0);
        // It has an exponent of its own.
        assert_eq!(lines(&light("1e-8", "falloff = 'square'"), 0.0).len(), 0);
        let two = light("1e-9", "") + "\n" + &light("1e-8", "");
        assert_eq!(lines(&two, 0.0), lost("light 0 (s.toml:1) and 1 more"));
        assert_eq!(lines("ambient = 1e-8", 0.0), lost("the ambient light"));
    }

    #[test]
    fn an_environment_hides_a_background_of_its_own_file_with_a_warning() {
        let file = "background = 0.5\n[environment]\nzenith = 1\nhorizon = 1\nground = 0\n\
                    [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
        let imported = scene::read("s.toml".as_ref(), file.into(), &Default::default()).unwrap();
        let report = compile(&imported.scene, &Options::default())
            .unwrap()
            .report;
        assert_eq!(
            report.warnings(24),
            [
                "the environment (s.toml:2) is shown in place of the scene's background; remove one of the two"
            ]
        );
    }

    #[test]
    fn a_mesh_that_glows_and_has_room_to_move_is_named() {
        let file = |lights: bool| {
            format!(
                "[material.glow]\nemission = 1\nlights = {lights}\n\
                 [[object]]\nkind = 'triangle'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
                 name = 'flag'\nmaterial = 'glow'\n"
            )
        };
        for (room, lights, expected) in [(0.25, true, 1), (0.0, true, 0), (0.25, false, 0)] {
            let imported = scene::read("s.toml".as_ref(), file(lights).into(), &Default::default());
            let options = Options {
                structures: vec![gridel_core::Structure::Bvh],
                room,
                ..Options::default()
            };
            let report = compile(&imported.unwrap().scene, &options).unwrap().report;
            let lines = report.warnings(24);
            assert_eq!(lines.len(), expected, "{lines:?}");
            assert!(
                lines
                    .iter()
                    .all(|it| it.contains("flag") && it.contains("glows"))
            );
        }
    }

    #[test]
    fn triangles_that_a_morph_target_would_open_are_named() {
        // The third corner of the first triangle is on the line of the others, or above it.
        let lines = |third: &str, way: &str| {
            let file = format!(
                "[morph.up]\n[[object]]\nkind = 'mesh'\nname = 'lid'\n\
                 vertices = [[0, 0, 0], [2, 0, 0], {third}, [0, 0, 3]]\nfaces = [[0, 1, 2], [0, 1, 3]]\n\
                 morph = {{ up = [[0, 0, 0], [0, 0, 0], {way}, [0, 0, 0]] }}\n"
            );
            let imported = scene::read("s.toml".as_ref(), file.into(), &Default::default());
            let options = Options {
                structures: vec![gridel_core::Structure::Bvh],
                ..Options::default()
            };
            let report = compile(&imported.unwrap().scene, &options).unwrap().report;
            report.warnings(24)
        };
        for (third, way, expected) in [
            (
                "[1, 0, 0]",
                "[0, 1, 0]",
                "1 triangle whose corners lie on a line at rest, left out at all times: lid (s.toml:2, triangle 0)",
            ),
            (
                "[1, 1e-9, 0]",
                "[0, 1, 0]",
                "1 triangle whose corners lie on a line",
            ),
            (
                "[1, 0, 0]",
                "[0.5, 0, 0]",
                "1 primitive without area, left out",
            ),
            (
                "[1, 1e-9, 0]",
                "[0.5, 0, 0]",
                "1 primitive too small for the lattice",
            ),
        ] {
            let lines = lines(third, way);
            assert!(
                lines.len() == 1 && lines[0].starts_with(expected),
                "{third} {way}: {lines:?}"
            );
        }
        // What opens from a point is drawn as soon as it does.
        for third in ["[1, 1, 0]", "[2, 1e-9, 0]"] {
            assert_eq!(lines(third, "[0, 1, 0]"), Vec::<String>::new(), "{third}");
        }
    }

    #[test]
    fn priority_of_glass_by_a_track_alone_is_ignored_with_a_warning() {
        for (transmit, expected) in [(0.0, 1), (0.1, 0)] {
            let file = format!(
                "[material.water]\ntransmit = {transmit}\npriority = 1\n\
                 [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'water'\n\
                 [[track]]\ntarget = 'material.water.transmit'\ntimes = [0, 1]\nvalues = [0, 1]\n"
            );
            let imported = scene::read("s.toml".as_ref(), file.into(), &Default::default());
            let lines = scene_warnings(&imported.unwrap().scene);
            assert_eq!(lines.len(), expected, "{lines:?}");
            assert!(
                lines
                    .iter()
                    .all(|it| it.contains("`priority` of material water (s.toml:1)"))
            );
        }
    }

    #[test]
    fn maps_that_nothing_shows_are_left_out_with_a_warning() {
        let image = Image::new("dots", 2, 2, vec![[9, 9, 9, 0]; 4]).unwrap();
        let texture = Texture::of(image.into());
        let compiled = |coordinates: &str| {
            let file = format!(
                "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n[material.dotted]\ndiffuse = 0.5\n\
                 [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'dotted'\n\
                 [[object]]\nkind = 'triangle'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
                 material = 'dotted'\n{coordinates}"
            );
            let imported = scene::read("s.toml".as_ref(), file.into(), &Default::default());
            let mut scene = imported.unwrap().scene;
            let material = scene.materials.iter_mut().find(|it| it.name == "dotted");
            let material = material.unwrap();
            material.texture = Some(texture.clone());
            material.alpha = Some(Alpha::CutOut(0.5));
            material.normal_map = Some(NormalMap {
                texture: texture.clone(),
                scale: 1.0,
            });
            compile(&scene, &Options::default()).unwrap()
        };
        let maps = Effects::TEXTURE
            .with(Effects::ALPHA)
            .with(Effects::NORMAL_MAP);
        let left_out = compiled("");
        let lines = left_out.report.warnings(24);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!(
            lines[0].starts_with("the texture and the normal map of material dotted (s.toml:4)"),
            "{lines:?}"
        );
        assert_eq!(left_out.report.textures, []);
        let effects = left_out.blob.scene().unwrap().effects();
        assert_eq!(effects.without(maps), effects);
        // One object is enough.
        let kept = compiled("coordinates = [[0, 0], [1, 0], [0, 1]]\n");
        assert_eq!(kept.report.warnings(24), Vec::<String>::new());
        assert_eq!(kept.report.textures.len(), 2);
        assert!(kept.blob.scene().unwrap().effects().contains(maps));
    }

    #[test]
    fn cameras_in_a_plane_have_a_warning() {
        let warnings = |eye: &str| {
            let file = format!(
                "[camera]\neye = {eye}\ntarget = [0, 0, 0]\n\
                 [[object]]\nkind = 'plane'\npoint = [1, 1, 0]\nnormal = [3, 1, 0]\nname = 'wall'\n"
            );
            let imported = crate::scene::read("a.toml".as_ref(), file.into(), &Default::default());
            scene_warnings(&imported.unwrap().scene)
        };
        let found = warnings("[0, 4, 7]");
        assert!(
            found.len() == 1 && found[0].contains("lies in the plane wall (a.toml:4)"),
            "{found:?}"
        );
        assert_eq!(warnings("[0, 4.001, 7]"), Vec::<String>::new());
    }
}
