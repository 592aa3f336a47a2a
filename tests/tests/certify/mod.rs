//! Certified pixels: every exact value lies in its interval, and intervals that are too narrow are noticed.

mod bumps;
mod exact;
mod facets;
mod hard;
mod levels;
mod lights;
mod lit;
mod media;
mod meet;
mod numbers;
mod paint;
mod picture;
mod placed;
mod random;
mod shares;
mod sky;
mod small;
mod surface;

use exact::Exact;
use gridel_core::{Format, Scene, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::certify::{Enclosed, Report, World, certify, code, enclose};
use gridel_host::render::{Job, render};
use gridel_host::scene::{Camera, Shape};
use gridel_host::shape::exact::Real;
use gridel_tests::scenes;
use hard::values;
use rayon::prelude::*;
use std::convert::Infallible;

fn fixtures() -> impl Iterator<Item = (String, gridel_host::scene::Scene)> {
    scenes::fixtures().into_iter()
}

/// All of the fixtures, and small scenes.
fn known() -> Vec<(String, Blob)> {
    let mut known: Vec<(String, Blob)> = fixtures()
        .chain(small::all())
        .map(|(name, scene)| (name, scenes::blob(&scene, 24)))
        .collect();
    known.sort_by(|(a, _), (b, _)| a.cmp(b));
    assert!(known.len() >= 24, "{} scenes", known.len());
    known
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

/// Returns the exact values that an interval of a pixel misses, with the intervals of double precision and with more
/// bits where pixels need it. Also returns whether an interval that is made too narrow is noticed.
fn compared(world: &World<'_>, exact: &Exact<'_>, pixel: [u16; 2]) -> (Vec<String>, bool) {
    let value = exact.pixel(pixel);
    let [quick, precise] = [1, 3].map(|levels| enclose(world, &exact.settings, pixel, levels));
    let wrong = [&quick, &precise].into_iter();
    let wrong = wrong.filter(|enclosed| !holds(enclosed.linear, &value));
    let wrong = wrong.map(|enclosed| {
        let value = value.each_ref().map(Real::to_f64);
        format!("{pixel:?}: {:?} does not hold {value:?}", enclosed.linear)
    });
    let narrowed = quick.linear;
    let narrowed = narrowed.map(|[low, high]| [low + (high - low) * 0.8, high]);
    (wrong.collect(), !holds(narrowed, &value))
}

#[test]
fn every_exact_value_lies_in_its_interval() {
    let known = known();
    let count = pixels_per_scene(known.len());
    let (mut noticed, mut all_wrong) = (0, Vec::new());
    for (name, blob) in &known {
        let scene = blob.scene().expect("a scene");
        let settings = settings(&scene, [400, 300], 1);
        let world = World::of(&scene).expect("a scene that is known");
        let exact = Exact::of(&scene, settings);
        let results = (0..count).into_par_iter().map(|number| {
            // Spread by the golden ratio and its like.
            let part = |by: f64, size: u16| ((number as f64 * by).fract() * f64::from(size)) as u16;
            let pixel = [part(0.754_877_666, 400), part(0.569_840_291, 300)];
            compared(&world, &exact, pixel)
        });
        let results: Vec<(Vec<String>, bool)> = results.collect();
        noticed += results.iter().filter(|(_, noticed)| *noticed).count();
        let wrong: Vec<String> = results.into_iter().flat_map(|(wrong, _)| wrong).collect();
        if let Some(first) = wrong.first() {
            all_wrong.push(format!("{name}: {} of {count}, first {first}", wrong.len()));
        }
    }
    assert!(all_wrong.is_empty(), "{all_wrong:#?}");
    // Intervals that are made too narrow on purpose are caught.
    assert!(
        noticed > 100,
        "{noticed} of the narrowed intervals were noticed"
    );
}

/// The picture of the kernel in double precision equals that in 320 bits, except for pixels where a rounding decides
/// the hit.
#[test]
fn the_kernels_picture_is_the_exact_one() {
    for (name, blob) in known() {
        let scene = blob.scene().expect("a scene");
        let settings = settings(&scene, [24, 18], 1);
        let job = Job::whole(Format::F64, Structure::DualSplit, settings);
        let picture = render(&scene, &job, &|| ()).expect("a picture");
        let exact = Exact::of(&scene, settings);
        let pixels = picture.pixels.into_par_iter().enumerate();
        let wrong = pixels.filter_map(|(index, shown)| {
            let pixel = [(index % 24) as u16, (index / 24) as u16];
            let value = exact.pixel(pixel);
            let exact = values(&value);
            let is_near = |k: usize| shown[k].abs_diff(exact[k]) <= 1;
            (!(0..3).all(is_near)).then(|| format!("{pixel:?}: {shown:?}, exact {exact:?}"))
        });
        let wrong: Vec<String> = wrong.collect();
        assert!(wrong.len() <= 2, "{name}: {} {wrong:#?}", wrong.len());
    }
}

/// The share of each scene, and no format that is off by much where pixels are proved.
#[test]
fn scenes_are_certified_and_f64_is_right_where_they_are_proved() {
    let mut all_wrong = Vec::new();
    for (name, blob) in known() {
        let scene = blob.scene().expect("a scene");
        let settings = settings(&scene, [64, 48], 2);
        let pixels = certified(&scene, &settings);
        let job = Job::whole(Format::F64, Structure::DualSplit, settings);
        let picture = render(&scene, &job, &|| ()).expect("a picture");
        let pictures = [(Format::F64, picture.pixels)];
        let world = World::of(&scene).expect("a scene that is known");
        let report = Report::of(&world, &settings, &pixels, &pictures);
        eprintln!("{name}: {:.3} % proved", 100.0 * report.certified);
        if report.certified < 0.98 {
            all_wrong.push(format!("{name}: {:?}", report.reasons));
        }
        let different = report.formats[0].different;
        if different * 500 > report.pixels {
            all_wrong.push(format!("{name}: {:?}", report.formats));
        }
        let open: usize = report.reasons.iter().map(|it| it.pixels).sum();
        assert_eq!(open + report.proved, report.pixels, "{name}");
    }
    assert!(all_wrong.is_empty(), "{all_wrong:#?}");
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

/// README's table of proved pixels equals the measured one.
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
        let world = World::of(&scene).expect("a scene that is known");
        let formats = Report::of(&world, &settings, &pixels, &pictures).formats;
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

/// Neither blobs nor firmware depend on certified pixels. The enclosing numbers are the host's, which the core and its
/// firmware do not use.
#[test]
fn the_core_and_firmware_have_no_intervals() {
    use std::path::{Path, PathBuf};

    fn files(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            // Build outputs hold code of others.
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
