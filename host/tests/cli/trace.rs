//! `gridel trace`.

use crate::program::Folder;
use glam::DVec3;
use gridel_core::{Format, Structure};
use gridel_host::blob::Blob;
use gridel_host::trace::{Query, SceneHit, SceneRay, trace};

/// A file of rays as `numpy.save` writes it.
pub fn npy(element: &str, rows: &[[f64; 8]]) -> Vec<u8> {
    let shape = format!("({}, 8)", rows.len());
    let header = format!("{{'descr': '{element}', 'fortran_order': False, 'shape': {shape}, }}");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    let text = format!("{header:<117}\n");
    file.extend((text.len() as u16).to_le_bytes());
    file.extend(text.as_bytes());
    for &number in rows.iter().flatten() {
        match element {
            "<f4" => file.extend((number as f32).to_le_bytes()),
            _ => file.extend(number.to_le_bytes()),
        }
    }
    file
}

/// Rays through the scene from all around; all numbers are exact in single precision.
pub fn rows(count: u32) -> Vec<[f64; 8]> {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 20) / 2048.0 - 1.0
    };
    (0..count)
        .map(|_| {
            let (origin, target) = (
                [(); 3].map(|()| 8.0 * random()),
                [(); 3].map(|()| 4.0 * random()),
            );
            let [dx, dy, dz] = [0, 1, 2].map(|k| target[k] - origin[k]);
            let [x, y, z] = origin;
            [x, y, z, 0.0, dx, dy, dz, f64::INFINITY]
        })
        .collect()
}

fn scene_rays(rows: &[[f64; 8]]) -> Vec<SceneRay> {
    rows.iter()
        .map(|&[x, y, z, tmin, dx, dy, dz, tmax]| SceneRay {
            origin: DVec3::new(x, y, z),
            tmin,
            direction: DVec3::new(dx, dy, dz),
            tmax,
        })
        .collect()
}

/// The hits of a file, which must be packed.
fn hits(file: &[u8]) -> Vec<SceneHit> {
    let header = usize::from(u16::from_le_bytes([file[8], file[9]]));
    file[10 + header..]
        .chunks_exact(28)
        .map(|record| {
            let word = |at: usize| <[u8; 4]>::try_from(&record[at..at + 4]).unwrap();
            SceneHit {
                t: f64::from_le_bytes(record[..8].try_into().unwrap()),
                object: u32::from_le_bytes(word(8)),
                primitive: u32::from_le_bytes(word(12)),
                instance: u32::MAX,
                normal: [16, 20, 24].map(|at| f32::from_le_bytes(word(at))),
            }
        })
        .collect()
}

const TRACE: [&str; 6] = [
    "trace",
    "quick.gridel",
    "--rays",
    "rays.npy",
    "-o",
    "hits.npy",
];

fn traced(folder: &Folder, options: &[&str]) -> Vec<SceneHit> {
    folder.done(&[&TRACE[..], options].concat());
    hits(&folder.read("hits.npy"))
}

#[test]
fn the_file_holds_what_the_library_finds() {
    let folder = Folder::with_quick();
    let accels = ["--accel", "bvh", "--accel", "flagged", "--accel", "wide"];
    folder.done(&[&["build", "quick.toml", "-o", "quick.gridel"], &accels[..]].concat());
    let rows = rows(10_000);
    let blob = Blob::new(&folder.read("quick.gridel"));
    let scene = blob.scene().unwrap();
    for element in ["<f4", "<f8"] {
        folder.write("rays.npy", &npy(element, &rows));
        for format in Format::ALL {
            let query = Query {
                format,
                structure: Structure::List,
                any: false,
            };
            let mut expected = vec![SceneHit::MISS; rows.len()];
            trace(&scene, &scene_rays(&rows), query, &mut expected).unwrap();
            assert!(expected.iter().any(|hit| hit.object == 2));
            for accel in ["list", "bvh", "flagged", "wide"] {
                let found = traced(&folder, &["--format", format.name(), "--accel", accel]);
                assert!(found == expected, "{element} {} {accel}", format.name());
            }
        }
    }
}

#[test]
fn threads_change_no_byte() {
    let folder = Folder::with_quick();
    folder.write("rays.npy", &npy("<f8", &rows(20_000)));
    let one = traced(&folder, &[]);
    for threads in ["2", "7"] {
        assert!(traced(&folder, &["--threads", threads]) == one, "{threads}");
    }
    let scene = [
        "trace",
        "quick.toml",
        "--rays",
        "rays.npy",
        "-o",
        "hits.npy",
    ];
    folder.done(&scene);
    assert!(hits(&folder.read("hits.npy")) == one);
}

#[test]
fn any_hits_are_those_that_have_a_closest_one() {
    let folder = Folder::with_quick();
    folder.write("rays.npy", &npy("<f8", &rows(5000)));
    let closest = traced(&folder, &[]);
    let any = traced(&folder, &["--any"]);
    for (closest, any) in closest.iter().zip(&any) {
        if closest.t == f64::INFINITY {
            assert_eq!(*any, SceneHit::MISS);
        } else {
            let expected = SceneHit {
                t: 0.0,
                object: 0,
                primitive: 0,
                instance: u32::MAX,
                normal: [0.0; 3],
            };
            assert_eq!(*any, expected);
        }
    }
}

#[test]
fn rejected_rays_are_counted_apart_and_the_first_is_printed_with_its_reason() {
    let folder = Folder::with_quick();
    let ray = rows(1)[0];
    let with = |index: usize, value: f64| {
        let mut ray = ray;
        ray[index] = value;
        ray
    };
    let scaled = |length: f64| {
        let mut ray = ray;
        // Straight down on the floor.
        ray[..7].copy_from_slice(&[3.0, 9.0, 3.0, 0.0, 0.0, -length, 0.0]);
        ray
    };
    let mut zero = ray;
    zero[4..7].fill(0.0);
    let mut reversed = ray;
    (reversed[3], reversed[7]) = (2.0, 1.0);
    let nan = (0..8).map(|index| with(index, f64::NAN));
    let mut rays = vec![scaled(1.0), scaled(5e-324)];
    rays.extend(nan);
    rays.extend([
        zero,
        reversed,
        with(0, f64::INFINITY),
        with(4, f64::INFINITY),
        with(1, 1e11),
        with(2, -1e300),
        scaled(1e-300),
        scaled(1.7e308),
    ]);
    folder.write("rays.npy", &npy("<f8", &rays));
    for format in ["fixed", "f32", "f64"] {
        let options = ["--format", format, "--threads", "2"];
        let report = folder.json(&[&TRACE[..], &options].concat());
        assert_eq!(
            (&report["rays"], &report["rejected"]),
            (&18.into(), &15.into())
        );
        assert_eq!((&report["hits"], &report["misses"]), (&3.into(), &0.into()));
        assert_eq!(report["first_rejected"]["row"], 1);
        let reason = report["first_rejected"]["reason"].as_str().unwrap();
        let remedy = report["first_rejected"]["remedy"].as_str().unwrap();
        assert!(remedy.starts_with("give "), "{remedy}");
        assert!(reason.contains("the direction is too short"), "{reason}");
        let found = hits(&folder.read("hits.npy"));
        assert!(
            found[1..16]
                .iter()
                .all(|hit| hit.t.is_nan() && hit.primitive == u32::MAX)
        );
        // On the floor from a height of 9, in multiples of each direction.
        for (hit, length) in [(found[0], 1.0), (found[16], 1e-300), (found[17], 1.7e308)] {
            assert_eq!((hit.object, hit.normal), (0, [0.0, 1.0, 0.0]), "{length:e}");
            assert!((hit.t * length - 9.0).abs() < 1e-5, "{hit:?} {length:e}");
        }
    }
    let text = folder.done(&TRACE);
    assert!(
        text.contains("15 rejected; the first is row 1: the ray's t") && text.contains("; give "),
        "{text}"
    );
    // Without t, any answer is one.
    let report = folder.json(&[&TRACE[..], &["--any"]].concat());
    assert_eq!(
        (&report["rejected"], &report["hits"]),
        (&14.into(), &4.into())
    );
    assert_eq!(report["first_rejected"]["row"], 2);

    folder.write("rays.npy", &npy("<f8", &[with(1, 1e11)]));
    let text = folder.done(&TRACE);
    assert!(
        text.contains("0 misses") && text.contains("too far from the scene"),
        "{text}"
    );
}

#[test]
fn the_report_has_counts_times_and_counters() {
    let folder = Folder::with_quick();
    folder.write("rays.npy", &npy("<f8", &rows(1000)));
    let report = folder.json(&[&TRACE[..], &["--repeat", "3", "--threads", "2"]].concat());
    let number = |key: &str| report[key].as_u64().unwrap();
    assert_eq!(number("hits") + number("misses"), number("rays"));
    assert!(number("hits") > 0 && number("misses") > 0);
    let seconds = report["seconds"].as_array().unwrap();
    assert_eq!(seconds.len(), 3);
    assert!(seconds.iter().all(|s| s.as_f64().unwrap() > 0.0));
    for counter in ["planes", "boxes", "primitives"] {
        assert!(
            report["counters"][counter].as_u64().unwrap() > 0,
            "{counter}"
        );
    }
    let list = folder.json(&[&TRACE[..], &["--accel", "list"]].concat());
    assert_eq!(list["counters"]["planes"], 0);
    assert_eq!(list["counters"]["cells"], 0);
    assert_eq!(list["counters"]["instances"], 0);

    folder.write("rays.npy", &npy("<f8", &[]));
    let empty = folder.json(&TRACE);
    assert_eq!(empty["rays"], 0);
    assert_eq!(hits(&folder.read("hits.npy")), []);
}

#[test]
fn broken_rays_and_wrong_options_are_rejected() {
    let folder = Folder::with_quick();
    let whole = npy("<f8", &rows(10));
    folder.write("rays.npy", &whole);
    folder.done(&TRACE);
    folder.write("cut.npy", &whole[..whole.len() - 3]);
    folder.write("wide.npy", &npy("<i4", &rows(1)));
    let fails = |code: i32, rays: &str, output: &str, words: &[&str]| {
        folder.fails(
            code,
            &["trace", "quick.gridel", "--rays", rays, "-o", output],
            words,
        );
    };
    fails(1, "cut.npy", "hits.npy", &["cut.npy", "promises 640"]);
    fails(1, "wide.npy", "hits.npy", &["wide.npy", "<i4", "float64"]);
    fails(
        1,
        "quick.toml",
        "hits.npy",
        &["quick.toml", "not a NumPy array file"],
    );
    fails(1, "absent.npy", "hits.npy", &["absent.npy cannot be read"]);
    fails(1, ".", "hits.npy", &["not a file"]);
    fails(1, "rays.npy", "absent/hits.npy", &["create the folder"]);
    fails(2, "rays.npy", "rays.npy", &["is the input"]);
    fails(2, "rays.npy", "quick.gridel", &["is the input"]);
    for option in [
        ["--repeat", "0"],
        ["--repeat", "1001"],
        ["--threads", "0"],
        ["--format", "half"],
    ] {
        folder.fails(2, &[&TRACE[..], &option].concat(), &[option[0]]);
    }
    #[cfg(target_os = "linux")]
    fails(1, "rays.npy", "/dev/full", &["make room"]);
}
