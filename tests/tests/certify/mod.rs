//! Certified pixels: every exact value lies in its interval, and what is made too narrow is noticed.

mod exact;
mod hard;
mod numbers;
mod placed;
mod shares;

use exact::Exact;
use gridel_core::{Format, Scene, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::certify::{Enclosed, Report, Unknown, World, certify, code, enclose};
use gridel_host::render::{Job, render};
use gridel_host::scene::{Camera, Shape};
use gridel_host::shape::exact::Real;
use gridel_tests::scenes;
use rayon::prelude::*;
use std::convert::Infallible;

/// Fixtures with effects that are not certified.
const REJECTED: [&str; 4] = ["room", "sky", "studio", "tumbler"];

fn fixtures() -> impl Iterator<Item = (String, gridel_host::scene::Scene)> {
    let all = scenes::fixtures().into_iter();
    all.filter(|(name, _)| !REJECTED.contains(&name.as_str()))
}

#[test]
fn effects_that_are_not_known_are_rejected_by_name() {
    let all = scenes::fixtures().into_iter();
    let rejected = all.filter(|(name, _)| REJECTED.contains(&name.as_str()));
    let mut count = 0;
    for (name, scene) in rejected {
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let Err(Unknown::Effect(effect)) = World::of(&scene) else {
            panic!("{name} is not rejected");
        };
        assert!(scene.effects().names().any(|it| it == effect), "{effect}");
        count += 1;
    }
    assert_eq!(count, REJECTED.len());
}

/// All of these, and a smooth mesh of glass and of mirrors, by itself and in instances.
fn known() -> Vec<(String, Blob)> {
    let fixtures = fixtures();
    let mut known: Vec<(String, Blob)> = fixtures
        .chain([(String::from("smooth"), smooth())])
        .map(|(name, scene)| (name, scenes::blob(&scene, 24)))
        .collect();
    known.sort_by(|(a, _), (b, _)| a.cmp(b));
    assert!(known.len() >= 16, "{} scenes", known.len());
    known
}

/// Octahedra that are shaded as balls: one of glass on a mirror, one that is placed twice, and a light so low that it
/// faces normals where it does not face their triangles.
fn smooth() -> gridel_host::scene::Scene {
    let ball = "kind = 'mesh'\nsmooth = 120\n\
        vertices = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]\n\
        faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]\n";
    let text = format!(
        "background = [0.3, 0.4, 0.6]\nambient = 0.1\n\
         [camera]\neye = [0.5, 2, 8]\ntarget = [0, 0, 0]\nfov = 40\n[render]\ndepth = 4\n\
         [[light]]\nkind = 'point'\nposition = [-6, 0.5, 3]\ncolor = 0.6\n\
         [[light]]\nkind = 'directional'\ndirection = [-3, -1, 0.5]\ncolor = 0.4\n\
         [material.glass]\ndiffuse = 0.1\ntransmit = 0.8\nior = 1.5\nhighlight = 0.3\n\
         [material.metal]\ndiffuse = 0.3\nmirror = 0.5\n\
         [[object]]\nkind = 'box'\nmin = [-4, -1.5, -4]\nmax = [4, -1.25, 4]\nmaterial = 'metal'\n\
         [[object]]\nmaterial = 'glass'\n{ball}\
         [[part]]\nname = 'ball'\n[[part.object]]\nmaterial = 'metal'\n{ball}\
         [[instance]]\npart = 'ball'\ntranslate = [-2, 0, 0]\nrotate = [10, 20, 30]\n\
         [[instance]]\npart = 'ball'\ntranslate = [2, 0, -1]\nscale = 0.75\n"
    );
    let options = gridel_host::scene::ImportOptions::default();
    let imported = gridel_host::scene::read("smooth.toml".as_ref(), text.into(), &options);
    imported.expect("a scene").scene
}

fn settings(scene: &Scene<'_>, size: [u16; 2], samples: u16) -> Settings {
    Settings {
        width: size[0],
        height: size[1],
        samples,
        ..Settings::of(scene)
    }
}

fn certified(scene: &Scene<'_>, settings: &Settings) -> Vec<Enclosed> {
    let world = World::of(scene).expect("a scene that is known");
    let count = usize::from(settings.width) * usize::from(settings.height);
    let mut pixels = vec![Enclosed::default(); count];
    let Ok(()) = certify(&world, settings, &mut pixels, &|| (), |_| {
        Ok::<_, Infallible>(())
    });
    pixels
}

fn holds(bounds: [[f64; 2]; 3], exact: &[Real; 3]) -> bool {
    let holds = |k: usize| Real::of(bounds[k][0]) <= exact[k] && exact[k] <= Real::of(bounds[k][1]);
    holds(0) && holds(1) && holds(2)
}

/// Pixels of all scenes together; `GRIDEL_FULL=1` takes a hundred times as many.
fn pixels_per_scene(scenes: usize) -> usize {
    let all = if std::env::var_os("GRIDEL_FULL").is_some() {
        100_000
    } else {
        1_000
    };
    all / scenes + 1
}

/// With the intervals of double precision, and with more bits where pixels need it.
#[test]
fn every_exact_value_lies_in_its_interval() {
    let known = known();
    let count = pixels_per_scene(known.len());
    let mut noticed = 0;
    for (name, blob) in &known {
        let scene = blob.scene().expect("a scene");
        let settings = settings(&scene, [400, 300], 1);
        let world = World::of(&scene).expect("a scene that is known");
        let exact = Exact::of(&scene, settings);
        let results: Vec<(bool, bool)> = (0..count)
            .into_par_iter()
            .map(|number| {
                // Spread by the golden ratio and its like.
                let part =
                    |by: f64, size: u16| ((number as f64 * by).fract() * f64::from(size)) as u16;
                let pixel = [part(0.754_877_666, 400), part(0.569_840_291, 300)];
                let value = exact.pixel(pixel);
                for levels in [1, 3] {
                    let enclosed = enclose(&world, &settings, pixel, levels);
                    assert!(
                        holds(enclosed.linear, &value),
                        "{name} {pixel:?}: {enclosed:?} does not hold {:?}",
                        value.each_ref().map(Real::to_f64)
                    );
                }
                let enclosed = enclose(&world, &settings, pixel, 1);
                let narrowed = enclosed
                    .linear
                    .map(|[low, high]| [low + (high - low) * 0.8, high]);
                (enclosed.width() > 0.0, !holds(narrowed, &value))
            })
            .collect();
        noticed += results.iter().filter(|(_, noticed)| *noticed).count();
    }
    // Intervals that are made too narrow on purpose are caught.
    assert!(
        noticed > 100,
        "{noticed} of the narrowed intervals were noticed"
    );
}

/// The share of each fixture, and no format that is off by much where pixels are proved.
#[test]
fn fixtures_are_certified_and_f64_is_right_where_they_are_proved() {
    for (name, scene) in fixtures() {
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let settings = settings(&scene, [64, 48], 2);
        let pixels = certified(&scene, &settings);
        let job = Job::whole(Format::F64, Structure::DualSplit, settings);
        let picture = render(&scene, &job, &|| ()).expect("a picture");
        let pictures = [(Format::F64, picture.pixels)];
        let report = Report::of(&settings, &pixels, &pictures);
        eprintln!("{name}: {:.3} % proved", 100.0 * report.certified);
        assert!(report.certified >= 0.98, "{name}: {:?}", report.reasons);
        let different = report.formats[0].different;
        assert!(
            different * 500 <= report.pixels,
            "{name}: {:?}",
            report.formats
        );
        let open: usize = report.reasons.iter().map(|it| it.pixels).sum();
        assert_eq!(open + report.proved, report.pixels, "{name}");
    }
}

/// A value outside of the bounds is proved different, by how much it is off at least.
#[test]
fn errors_of_formats_are_counted_from_the_bounds() {
    let pixel = |low: u8, high: u8| Enclosed {
        low: [low; 3],
        high: [high; 3],
        done: 1,
        ..Enclosed::default()
    };
    assert_eq!(pixel(7, 7).error_of([7; 3]), Some(0));
    assert_eq!(pixel(7, 7).error_of([7, 9, 7]), Some(2));
    assert_eq!(pixel(7, 9).error_of([8; 3]), None);
    assert_eq!(pixel(7, 9).error_of([5, 8, 8]), Some(2));
    assert_eq!(code([65_535, 0, 14_146]), [255, 0, 128]);
}

/// Open pixels are named: a wall of two colors, whose edge runs exactly through the middles of pixels.
#[test]
fn rays_exactly_on_a_boundary_are_decided_or_said_to_be_on_it() {
    let mut file = scenes::of([Shape::Mesh {
        vertices: [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]]
            .map(|[x, y]| glam::DVec3::new(x, y, 0.0))
            .to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }]);
    file.camera = Some(Camera {
        eye: glam::DVec3::new(0.0, 0.0, 9.0),
        target: glam::DVec3::ZERO,
        up: glam::DVec3::Y,
        fov_degrees: 40.0,
    });
    let blob = scenes::blob(&file, 24);
    let scene = blob.scene().expect("a scene");
    // The diagonal of the square is that of the picture.
    let pixels = certified(&scene, &settings(&scene, [33, 33], 1));
    let open = pixels.iter().filter(|it| it.proved().is_none()).count();
    assert_eq!(open, 0);
}

/// README's table of proved pixels is what is measured.
#[test]
fn the_table_in_the_readme_is_measured() {
    let readme = include_str!("../../../README.md");
    let (_, table) = readme.split_once("<!-- certified -->\n").expect("a table");
    let (table, _) = table.split_once("<!-- end -->").expect("an end");
    let mut rows = String::from(
        "| scene | `fixed` | `f32` | `f64` | largest proved error |\n|---|---|---|---|---|\n",
    );
    for name in ["glass-chess", "cornell", "c60"] {
        let mut fixtures = fixtures();
        let (_, scene) = fixtures.find(|(it, _)| it == name).expect("a fixture");
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let settings = settings(&scene, [160, 120], 1);
        let pixels = certified(&scene, &settings);
        let pictures = Format::ALL.map(|format| {
            let job = Job::whole(format, Structure::DualSplit, settings);
            let picture = render(&scene, &job, &|| ()).expect("a picture");
            (format, picture.pixels)
        });
        let formats = Report::of(&settings, &pixels, &pictures).formats;
        let shares = formats.iter().map(|format| {
            let share = 100.0 * format.equal as f64 / pixels.len() as f64;
            format!("{share:.2} %")
        });
        let shares: Vec<String> = shares.collect();
        let errors: Vec<String> = formats
            .iter()
            .map(|format| format!("{}/255", format.max_proved_error))
            .collect();
        rows += &format!(
            "| {name} | {} | {} |\n",
            shares.join(" | "),
            errors.join(", ")
        );
    }
    assert_eq!(table, rows, "paste this:\n{rows}");
}

/// `certify` says what it does not know, and proves nothing of it.
#[test]
fn unknown_effects_are_rejected_by_name() {
    for (light, effect) in [
        (
            "kind = 'point'\nposition = [3, 4, 5]\nfalloff = 'square'",
            "falloff",
        ),
        (
            "kind = 'sphere'\ncenter = [3, 4, 5]\nradius = 1\nradiance = 9",
            "falloff",
        ),
    ] {
        let text = format!(
            "[[light]]\n{light}\n[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1"
        );
        let imported =
            gridel_host::scene::read("light.toml".as_ref(), text.into(), &Default::default());
        let blob = scenes::blob(&imported.expect("a scene").scene, 24);
        let scene = blob.scene().expect("a scene");
        let unknown = World::of(&scene).err().map(|error| error.to_string());
        let expected = format!("certify does not know the effect `{effect}` yet");
        assert_eq!(unknown, Some(expected));
    }
}

/// What a blob is and what firmware runs know nothing of certified pixels: the enclosing numbers are the host's, which
/// the core and its firmware do not depend on.
#[test]
fn the_core_and_firmware_have_no_intervals() {
    use std::path::{Path, PathBuf};

    fn files(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            // What was built there holds code of others.
            if path.ends_with("target") {
                continue;
            }
            if path.is_dir() {
                files(&path, found);
            } else if path
                .extension()
                .is_some_and(|it| it == "rs" || it == "toml")
            {
                found.push(path);
            }
        }
    }

    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for folder in ["core", "tests/firmware"] {
        files(&root.join(folder), &mut found);
    }
    assert!(found.len() > 100, "{} files", found.len());
    for path in found {
        let text = std::fs::read_to_string(&path).expect("a text");
        for word in ["certify", "Enclosure", "dashu", "gridel-host", "next_up"] {
            assert!(!text.contains(word), "{}: {word}", path.display());
        }
    }
}
