//! Figures of `accuracy` equal those of pictures and blobs.

use gridel_core::{Format, Structure};
use gridel_host::accuracy::{
    Bench, Limits, Parameter, Point, Results, answers, cheapest, effect_costs, frontier, given_up,
    most_accurate, page, plot, reference_setting, sentences, sweep,
};
use gridel_host::measure::board::PICTURE_COSTS;
use gridel_tests::scenes;

/// A sweep of a small picture. Its times are its counts, so that the test does not depend on clocks.
fn swept(name: &str) -> Results {
    let path = scenes::fixture_folder().join(name).with_extension("toml");
    let scene = scenes::read(&path);
    let mut bench = Bench::new(&scene, Structure::Flagged, [32, 24]);
    let settings = sweep(bench.base(), bench.effects().expect("a blob"));
    let reference = reference_setting(64, &settings);
    let reference = bench.reference(&reference).expect("a reference");
    let mut points = Vec::new();
    for setting in settings {
        let (mut point, _) = bench.measure(&setting, &reference).expect("a point");
        let work = point.cost.tests + point.cost.rays;
        point.cost.seconds = vec![1e-6 * work as f64; 2];
        points.push(point);
    }
    let mut results = Results {
        key: String::new(),
        instances: bench.instances().expect("a blob"),
        base: bench.base(),
        reference,
        points,
        effects: Vec::new(),
    };
    results.effects = effect_costs(&mut bench, &results).expect("blobs");
    results
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
    assert!(rmse(Parameter::Cutoff, "0.125") > rmse(Parameter::Cutoff, "0.001953125"));
    assert!(rmse(Parameter::LatticeBits, "10") > rmse(Parameter::LatticeBits, "24"));
    // Distances of single precision are right to a few units of its last place, and those of double precision exactly.
    // On a coarse lattice they are off by many.
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
    let within = |error| Limits {
        error,
        rays: f64::INFINITY,
    };
    let cheap = cheapest(&results.points, within(bound), None).expect("a setting");
    assert!(cheap.errors.rmse <= bound);
    let board = cheapest(&results.points, within(bound), Some("cortex-m3")).expect("a setting");
    assert_eq!(board.setting.format, Format::Fixed);
    assert!(cheapest(&results.points, within(0.0), None).is_none());
    assert!(sentences(&results).len() >= 5);

    let page = page("a <scene>", [32, 24], &results, &[]).expect("a page");
    assert!(
        page.contains("a &lt;scene&gt;") && !page.contains("{{") && !page.contains("src=\"http")
    );
    assert_eq!(
        page.matches("http://").count(),
        page.matches("http://www.w3.org").count()
    );
    assert!(page.contains("What each effect costs"));
    assert!(plot(&results).expect("a plot").starts_with("<svg"));
    assert_eq!(answers(&results).len(), 3);

    parts_of_errors_are_those_of_formats_and_samples(&results);
    effects_are_ordered_by_what_they_cost(&results);

    // Limits of rays hold, alone and with one of the error.
    let few = most_accurate(&results.points, 8.0, None).expect("a setting");
    assert!(few.rays_per_pixel() <= 8.0);
    let better = |it: &Point| it.rays_per_pixel() <= 8.0 && it.errors.rmse < few.errors.rmse;
    assert!(!results.points.iter().any(better));
    assert!(most_accurate(&results.points, 0.5, None).is_none());
    let limits = Limits {
        error: few.errors.rmse,
        rays: 8.0,
    };
    let both = cheapest(&results.points, limits, None).expect("a setting");
    assert!(limits.hold(both));
}

/// The error of `f64` is that of sampling alone, and no format adds as much as a sample does.
fn parts_of_errors_are_those_of_formats_and_samples(results: &Results) {
    for point in &results.points {
        let (errors, parts) = (&point.errors, &point.parts);
        if point.setting.format == Format::F64 {
            assert_eq!((parts.arithmetic, parts.arithmetic_largest), (0.0, 0.0));
            assert!(
                (parts.sampling - errors.rmse).abs() < 1e-12,
                "{}",
                point.name
            );
        }
        // A triangle's inequality.
        assert!(
            errors.rmse <= parts.sampling + parts.arithmetic + 1e-12,
            "{}",
            point.name
        );
        assert!(
            parts.arithmetic <= parts.arithmetic_largest,
            "{}",
            point.name
        );
    }
}

/// Every effect of the scene has a setting without it. The first to leave out changes the picture least for its saving.
fn effects_are_ordered_by_what_they_cost(results: &Results) {
    let base = results.base;
    let left_out = |it: &&Point| it.setting.differs(&base) == [Parameter::Effects];
    let alone: Vec<&Point> = results.points.iter().filter(left_out).collect();
    assert!(alone.len() > 2);
    assert_eq!(results.effects.len(), alone.len());
    let prices = results.effects.iter().map(|cost| {
        let point = alone
            .iter()
            .find(|it| it.name == cost.without)
            .expect("a point");
        assert_eq!(Some(cost.lost), point.lost);
        let saved = cost.rays + cost.tests;
        match saved > 0.0 {
            true => (false, cost.lost.rmse / saved),
            false => (true, cost.lost.rmse),
        }
    });
    assert!(prices.collect::<Vec<_>>().is_sorted());
    let shadow = results
        .effects
        .iter()
        .find(|it| it.effect == "shadow")
        .expect("shadows");
    assert!(shadow.lost.rmse > 0.0 && shadow.rays > 0.5 && shadow.instructions.is_some());
    // One after the other, until none is left.
    let given_up = given_up(&base, &results.effects);
    assert_eq!(given_up.len() + 1, results.effects.len());
    let last = given_up.last().expect("several effects");
    assert_eq!(last.without.names().count(), results.effects.len());
}

/// The reference has no error against itself.
#[test]
fn the_same_picture_has_no_error() {
    let scene = scenes::read(&scenes::fixture_folder().join("quick.toml"));
    let mut bench = Bench::new(&scene, Structure::Flagged, [24, 18]);
    let setting = reference_setting(4, &[]);
    let reference = bench.reference(&setting).expect("a reference");
    let (point, _) = bench.measure(&setting, &reference).expect("a point");
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
            let reference = bench
                .reference(&reference_setting(1, &[]))
                .expect("a reference");
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
    let reference = bench
        .reference(&reference_setting(1, &[]))
        .expect("a reference");
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
