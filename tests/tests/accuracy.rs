//! Figures of `accuracy` equal those of pictures and blobs.

use gridel_core::{Format, Structure};
use gridel_host::accuracy::{
    Bench, Parameter, Point, Results, cheapest, frontier, page, reference_setting, sentences, sweep,
};
use gridel_host::measure::board::PICTURE_COSTS;
use gridel_tests::scenes;

/// A sweep of a small picture, timed by what it counts so that the test does not depend on clocks.
fn swept(name: &str) -> Results {
    let path = scenes::fixture_folder().join(name).with_extension("toml");
    let scene = scenes::read(&path);
    let mut bench = Bench::new(&scene, Structure::Flagged, [32, 24]);
    let reference = bench.reference(64).expect("a reference");
    let mut points = Vec::new();
    for setting in sweep(bench.base(), bench.is_secondary().expect("a blob")) {
        let (mut point, _) = bench.measure(&setting, &reference).expect("a point");
        let work = point.cost.tests + point.cost.rays;
        point.cost.seconds = vec![1e-6 * work as f64; 2];
        points.push(point);
    }
    Results {
        key: String::new(),
        instances: bench.instances().expect("a blob"),
        base: bench.base(),
        reference,
        points,
    }
}

#[test]
fn more_work_is_more_right() {
    let results = swept("glass-chess");
    let base = results.base;
    let of = |parameter: Parameter, value: &str| -> &Point {
        let turned = |point: &&Point| {
            let others = point.setting.differs(&base);
            point.setting.value(parameter) == value && (others.is_empty() || others == [parameter])
        };
        results.points.iter().find(turned).expect("a point")
    };
    let rmse = |parameter, value| of(parameter, value).errors.rmse;
    assert!(rmse(Parameter::Samples, "64") < 0.5 * rmse(Parameter::Samples, "1"));
    assert!(rmse(Parameter::Depth, "0") > rmse(Parameter::Depth, "6"));
    assert!(rmse(Parameter::Cutoff, "0.125") > rmse(Parameter::Cutoff, "0.00195"));
    assert!(rmse(Parameter::LatticeBits, "10") > rmse(Parameter::LatticeBits, "24"));
    // Distances of single precision are right to a few units of its last place, of double precision
    // to none, on a coarse lattice to many.
    let ulps = |parameter, value| of(parameter, value).errors.t_ulps[0];
    assert!(ulps(Parameter::Format, "f64") < 1e-3);
    assert!(ulps(Parameter::Format, "f32") < 8.0);
    assert!(of(Parameter::LatticeBits, "10").errors.t_ulps[1] > 100.0);
    assert!(
        of(Parameter::LatticeBits, "16").cost.blob_bytes
            < of(Parameter::LatticeBits, "24").cost.blob_bytes
    );

    let best = frontier(&results.points);
    assert!(best.contains(&true) && best.contains(&false));
    for (point, best) in results.points.iter().zip(&best) {
        let beaten = results.points.iter().any(|other| {
            other.cost.time() < point.cost.time() && other.errors.rmse < point.errors.rmse
        });
        assert!(!(beaten && *best), "{}", point.name);
    }
    let bound = rmse(Parameter::Samples, "4");
    let cheap = cheapest(&results.points, bound, None).expect("a setting");
    assert!(cheap.errors.rmse <= bound);
    let board = cheapest(&results.points, bound, Some("cortex-m3")).expect("a setting");
    assert_eq!(board.setting.format, Format::Fixed);
    assert!(cheapest(&results.points, 0.0, None).is_none());
    assert_eq!(sentences(&base, &results.points).len(), 6);

    let page = page("a <scene>", [32, 24], &results, &[]).expect("a page");
    assert!(page.contains("a &lt;scene&gt;") && page.matches("<svg").count() == 3);
    assert!(
        !page.contains("http://")
            || page.matches("http://www.w3.org").count() == page.matches("http://").count()
    );
}

/// The reference has no error against itself.
#[test]
fn the_same_picture_has_no_error() {
    let scene = scenes::read(&scenes::fixture_folder().join("quick.toml"));
    let mut bench = Bench::new(&scene, Structure::Flagged, [24, 18]);
    let reference = bench.reference(4).expect("a reference");
    let (point, _) = bench
        .measure(&reference_setting(4), &reference)
        .expect("a point");
    let errors = point.errors;
    assert_eq!(
        (errors.rmse, errors.largest, errors.pixels_off),
        (0.0, 0.0, 0)
    );
    assert_eq!(
        (errors.flip, errors.other_objects, errors.t_ulps),
        (0.0, 0, [0.0; 2])
    );
    assert!((errors.ssim - 1.0).abs() < 1e-9, "{}", errors.ssim);
}

/// The instructions per ray are those of the recorded pictures.
#[test]
fn boards_are_the_recorded_ones() {
    let text = std::fs::read_to_string(scenes::fixture_folder().join("recorded/board.json"));
    let recorded: serde_json::Value = serde_json::from_str(&text.expect("a file")).expect("JSON");
    for board in PICTURE_COSTS {
        for (name, per_ray) in ["quick", "glass-chess"].into_iter().zip(board.per_ray) {
            let build = format!(
                "{name} {} {} dual-split",
                board.machine,
                board.format.name()
            );
            let Some(instructions) = recorded[&build]["picture-instructions"].as_f64() else {
                panic!("{build} is not recorded");
            };
            let scene = scenes::read(&scenes::fixture_folder().join(name).with_extension("toml"));
            let mut bench = Bench::new(&scene, Structure::DualSplit, [48, 36]);
            let setting = gridel_host::accuracy::Setting {
                format: board.format,
                ..bench.base()
            };
            let reference = bench.reference(1).expect("a reference");
            let (point, _) = bench.measure(&setting, &reference).expect("a point");
            let found = instructions / point.cost.rays as f64;
            eprintln!("{build}: {found:.0} instructions per ray");
            assert!(
                (found / per_ray - 1.0).abs() < 0.15,
                "{build}: {found} {per_ray}"
            );
        }
    }
}

/// A ray through the arm, whose links are instances, takes as many instructions as one of pictures without instances.
#[test]
fn boards_estimate_instances_of_the_arm() {
    let text = std::fs::read_to_string(scenes::fixture_folder().join("recorded/board.json"));
    let recorded: serde_json::Value = serde_json::from_str(&text.expect("a file")).expect("JSON");
    let scene = scenes::read(&scenes::fixture_folder().join("robot-arm.toml"));
    let mut bench = Bench::new(&scene, Structure::DualSplit, [64, 64]);
    let instances = bench.instances().expect("a blob").expect("instances");
    assert!(instances.are_kept());
    let reference = bench.reference(1).expect("a reference");
    let mut measured = 0;
    for board in PICTURE_COSTS {
        let (machine, format) = (board.machine, board.format.name());
        let build = format!("arm robot-arm {machine} {format} dual-split");
        let Some(instructions) = recorded[&build]["picture-instructions"].as_f64() else {
            continue;
        };
        let setting = gridel_host::accuracy::Setting {
            format: board.format,
            ..bench.base()
        };
        let (point, _) = bench.measure(&setting, &reference).expect("a point");
        let found = instructions / point.cost.rays as f64;
        eprintln!("{build}: {found:.0} instructions per ray");
        let [least, most] = board.per_ray;
        assert!(
            0.9 * least < found && found < most,
            "{build}: {found} {least} {most}"
        );
        measured += 1;
    }
    assert_eq!(measured, 2);
}
