//! Tracks: the state at a time is that of a scene which is compiled with it.

use glam::DVec3;
use gridel_core::format::track::{Interpolation, TrackTarget};
use gridel_core::render::CameraError;
use gridel_core::{BlobError, Format, Settings, Structure, Tracks};
use gridel_host::blob::Blob;
use gridel_host::compile::{CompileError, Options, TICKS_PER_SECOND, compile};
use gridel_host::render::{Job, render};
use gridel_host::scene::{Camera, Diffuse, ImportOptions, Light, Material, Scene, Track, read};
use gridel_host::state::{State, StateError, ticks};
use gridel_tests::scenes::{self, track};

fn built(scene: &Scene) -> Blob {
    let options = Options {
        structures: vec![Structure::DualSplit],
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

/// The error of tracks that cannot be compiled.
fn rejected(tracks: Vec<Track>) -> String {
    let scene = Scene {
        tracks,
        ..scene_file()
    };
    let error = compile(&scene, &Options::default()).expect_err("invalid tracks");
    assert!(matches!(error, CompileError::Track { .. }), "{error}");
    error.to_string()
}

const EYE: DVec3 = DVec3::new(0.0, 0.5, 5.0);

fn scene_file() -> Scene {
    let mut scene = scenes::soup(5, 40, 0.4);
    scene.lights = vec![
        Light::Point {
            position: DVec3::new(3.0, 5.0, 4.0),
            color: [0.5; 3],
        },
        Light::Directional {
            direction: DVec3::NEG_Y,
            color: [0.25; 3],
        },
    ];
    scene.materials = vec![
        Material::default(),
        Material {
            diffuse: Diffuse::Checker {
                even: [0.5; 3],
                odd: [0.25; 3],
                size: 0.25,
                origin: DVec3::ZERO,
            },
            mirror: [0.5; 3],
            ..Material::default()
        },
    ];
    for (index, object) in scene.objects.iter_mut().enumerate() {
        object.material = index % 2;
    }
    scene.camera = Some(Camera {
        eye: EYE,
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 45.0,
    });
    scene
}

/// Returns a scene that moves from 0 to 2 seconds, evenly and to numbers that integers hold.
fn moving() -> Scene {
    use Interpolation::Linear;
    let mut scene = scene_file();
    let line = |target, index, from: [f64; 3], to: [f64; 3]| {
        track(target, index, Linear, &[(0.0, from), (2.0, to)])
    };
    scene.tracks = vec![
        line(TrackTarget::CameraEye, 0, [0.0, 0.5, 5.0], [4.0, 2.5, 3.0]),
        line(TrackTarget::CameraTarget, 0, [0.0; 3], [0.5, 0.25, -0.5]),
        track(
            TrackTarget::CameraFieldOfView,
            0,
            Linear,
            &[(0.0, [45.0]), (2.0, [90.0])],
        ),
        line(
            TrackTarget::LightPosition,
            0,
            [3.0, 5.0, 4.0],
            [-3.0, 1.0, 0.0],
        ),
        line(TrackTarget::LightColor, 1, [0.25; 3], [0.0, 0.5, 0.75]),
        line(
            TrackTarget::MaterialDiffuse,
            0,
            [0.0, 0.5, 1.0],
            [1.0, 0.5, 0.0],
        ),
        line(TrackTarget::MaterialOdd, 1, [0.25; 3], [0.75, 0.0, 0.5]),
        line(TrackTarget::MaterialMirror, 1, [0.5; 3], [0.0; 3]),
    ];
    scene
}

/// The scene as it is a part of the way through [`moving`], without tracks.
fn still(part: f64) -> Scene {
    let mix = |from: [f64; 3], to: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|k| from[k] + part * (to[k] - from[k]))
    };
    let place = |from, to| DVec3::from_array(mix(from, to));
    let mut scene = scene_file();
    scene.camera = Some(Camera {
        eye: place([0.0, 0.5, 5.0], [4.0, 2.5, 3.0]),
        target: place([0.0; 3], [0.5, 0.25, -0.5]),
        up: DVec3::Y,
        fov_degrees: 45.0 + part * 45.0,
    });
    scene.lights[0] = Light::Point {
        position: place([3.0, 5.0, 4.0], [-3.0, 1.0, 0.0]),
        color: [0.5; 3],
    };
    scene.lights[1] = Light::Directional {
        direction: DVec3::NEG_Y,
        color: mix([0.25; 3], [0.0, 0.5, 0.75]),
    };
    scene.materials[0].diffuse = Diffuse::Plain(mix([0.0, 0.5, 1.0], [1.0, 0.5, 0.0]));
    scene.materials[1].diffuse = Diffuse::Checker {
        even: [0.5; 3],
        odd: mix([0.25; 3], [0.75, 0.0, 0.5]),
        size: 0.25,
        origin: DVec3::ZERO,
    };
    scene.materials[1].mirror = mix([0.5; 3], [0.0; 3]);
    scene
}

fn pictures(scene: &gridel_core::Scene<'_>) -> Vec<Vec<[u16; 3]>> {
    let settings = Settings {
        width: 32,
        height: 24,
        ..Settings::of(scene)
    };
    let picture = |format| {
        let job = Job::whole(format, Structure::DualSplit, settings);
        render(scene, &job, &|| ()).expect("a picture").pixels
    };
    Format::ALL.map(picture).to_vec()
}

#[test]
fn the_state_at_a_time_is_the_one_that_is_compiled() {
    let blob = built(&moving());
    let scene = blob.scene().expect("a scene");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
    assert_eq!(tracks.span(), [0, 2 * TICKS_PER_SECOND as i32]);
    for (seconds, part) in [
        (-1.0, 0.0),
        (0.0, 0.0),
        (0.5, 0.25),
        (1.0, 0.5),
        (1.75, 0.875),
        (2.0, 1.0),
        (9.0, 1.0),
    ] {
        let time = ticks(&tracks, seconds).unwrap();
        let state = State::at(&blob, &scene, &tracks, time).expect("a state");
        let seen = state.apply(&scene).expect("in range");
        let other = built(&still(part));
        let compiled = other.scene().expect("a scene");
        assert_eq!(seen.lights(), compiled.lights(), "{seconds}");
        assert_eq!(seen.materials(), compiled.materials(), "{seconds}");
        assert_eq!(seen.view(), compiled.view(), "{seconds}");
        assert_eq!(pictures(&seen), pictures(&compiled), "{seconds}");
    }
}

#[test]
fn a_scene_without_tracks_has_no_section_of_them() {
    let blob = built(&scene_file());
    let tracks = Tracks::from_bytes(blob.bytes()).expect("none");
    assert!(tracks.is_empty());
    assert_eq!(tracks.camera_at(i32::MIN), Ok(None));
    let scene = blob.scene().expect("a scene");
    let state = State::at(&blob, &scene, &tracks, 7).expect("its own");
    assert_eq!(state.view, *scene.view());
    assert_eq!(
        (&state.lights[..], &state.materials[..]),
        (scene.lights(), scene.materials())
    );
    // Tracks take four sections and leave all others as they are.
    let moves = built(&moving());
    assert_eq!(moves.scene().expect("a scene").lights(), scene.lights());
}

#[test]
fn an_orbit_turns_the_eye_about_up_through_the_target() {
    let turned = |degrees: f64, up: DVec3, target: DVec3| {
        let mut file = scene_file();
        file.camera = Some(Camera {
            eye: EYE,
            target,
            up,
            fov_degrees: 45.0,
        });
        let keys = [(0.0, [0.0]), (1.0, [degrees])];
        file.tracks = vec![track(
            TrackTarget::CameraOrbit,
            0,
            Interpolation::Linear,
            &keys,
        )];
        let blob = built(&file);
        let scene = blob.scene().expect("a scene");
        let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
        let camera = tracks
            .camera_at(tracks.span()[1])
            .expect("a camera")
            .expect("it moves");
        let step = f64::powi(2.0, scene.coordinate_exponent());
        (
            DVec3::from_array(camera.eye().0.map(f64::from)) * step,
            step,
        )
    };
    for (degrees, expected) in [
        (0.0, [0.0, 0.5, 5.0]),
        (90.0, [5.0, 0.5, 0.0]),
        (180.0, [0.0, 0.5, -5.0]),
        (-90.0, [-5.0, 0.5, 0.0]),
        (360.0, [0.0, 0.5, 5.0]),
        (3600.0 + 90.0, [5.0, 0.5, 0.0]),
    ] {
        let (eye, _) = turned(degrees, DVec3::Y, DVec3::ZERO);
        assert_eq!(eye, DVec3::from_array(expected), "{degrees}");
    }
    for (degrees, up, target) in [
        (30.0, DVec3::Y, DVec3::new(1.0, 0.25, -1.0)),
        (
            77.0,
            DVec3::new(1.0, 2.0, 3.0),
            DVec3::new(0.5, 0.25, 0.125),
        ),
        (-200.0, DVec3::new(-1.0, 5.0, 0.5), DVec3::ZERO),
    ] {
        let (eye, step) = turned(degrees, up, target);
        let rotation = glam::DQuat::from_axis_angle(up.normalize(), f64::to_radians(degrees));
        let expected = target + rotation * (EYE - target);
        // Turns have 24 fraction bits, sines 29; the arm is some five units long.
        let bound = 5.0 * std::f64::consts::TAU * f64::powi(2.0, -25) + 8.0 * step;
        assert!(eye.distance(expected) <= bound, "{eye}, not {expected}");
    }
}

#[test]
fn frames_of_common_rates_are_whole_ticks() {
    let blob = built(&moving());
    let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
    assert_eq!(tracks.ticks_per_second(), TICKS_PER_SECOND);
    for rate in [1, 24, 25, 30, 48, 50, 60, 100, 120] {
        let exact = |frame: u32| (frame * TICKS_PER_SECOND / rate) as i32;
        for frame in [0, 1, 7, 1000] {
            assert_eq!(tracks.frame_time(frame, rate), exact(frame));
        }
    }
    assert_eq!(tracks.frame_time(1, 7), 6857);
    assert_eq!(tracks.frame_time(2, 7), 13714);
    assert_eq!(tracks.frame_time(u32::MAX, 0), i32::MAX);
}

#[test]
fn a_camera_that_comes_to_see_nothing_is_an_error_with_its_time() {
    let mut file = scene_file();
    let keys = [(0.0, [0.0, 0.0, 4.0]), (2.0, [0.0, 0.0, -4.0])];
    file.tracks = vec![track(
        TrackTarget::CameraEye,
        0,
        Interpolation::Linear,
        &keys,
    )];
    let blob = built(&file);
    let scene = blob.scene().expect("a scene");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
    assert!(State::at(&blob, &scene, &tracks, ticks(&tracks, 0.9).unwrap()).is_ok());
    let error = State::at(&blob, &scene, &tracks, ticks(&tracks, 1.0).unwrap())
        .expect_err("inside of its target");
    assert!(matches!(
        error,
        StateError::Camera {
            source: CameraError::NoDirection,
            ..
        }
    ));
    assert!(error.to_string().starts_with("at 1 s"), "{error}");
}

#[test]
fn slices_of_another_length_are_rejected() {
    let blob = built(&moving());
    let scene = blob.scene().expect("a scene");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
    let mut lights = vec![scene.lights()[0]; 3];
    let error = tracks.lights_at(&scene, 0, &mut lights).err();
    assert!(matches!(
        error,
        Some(BlobError::Memory {
            found: 3,
            needed: 2,
            ..
        })
    ));
    let error = tracks.materials_at(&scene, 0, &mut []).err();
    assert!(matches!(
        error,
        Some(BlobError::Memory {
            found: 0,
            needed: 2,
            ..
        })
    ));
}

#[test]
fn opposite_directions_of_light_cancel_out_to_the_earlier_one() {
    let mut file = scene_file();
    let keys = [(0.0, [0.0, -1.0, 0.0]), (1.0, [0.0, 1.0, 0.0])];
    file.tracks = vec![track(
        TrackTarget::LightDirection,
        1,
        Interpolation::Linear,
        &keys,
    )];
    let blob = built(&file);
    let scene = blob.scene().expect("a scene");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
    let direction = |seconds: f64| {
        let state =
            State::at(&blob, &scene, &tracks, ticks(&tracks, seconds).unwrap()).expect("a state");
        state.apply(&scene).expect("in range").lights()[1].vector
    };
    let up = [0, 1 << 30, 0];
    assert_eq!([0.0, 0.25, 0.5].map(direction), [up; 3]);
    assert_eq!(direction(1.0), [0, -(1 << 30), 0]);
}

#[test]
fn tracks_that_no_blob_can_hold_are_rejected_with_the_reason() {
    use Interpolation::{Cubic, Linear};
    let eye = |keys: &[(f64, [f64; 3])], how| vec![track(TrackTarget::CameraEye, 0, how, keys)];
    let near = rejected(eye(&[(1.0, [0.0; 3]), (1.000_001, [1.0; 3])], Linear));
    assert!(
        near.contains("less than a tick apart") && near.contains("camera.eye"),
        "{near}"
    );
    let late = rejected(eye(&[(44_740.0, [0.0; 3])], Linear));
    assert!(late.contains("beyond 44739 seconds"), "{late}");
    let steep = rejected(eye(&[(0.0, [1e9; 3]), (1.0, [0.0; 3])], Cubic));
    assert!(
        steep.contains("beyond the range of scene coordinates"),
        "{steep}"
    );
    let orbit = |degrees| {
        vec![track(
            TrackTarget::CameraOrbit,
            0,
            Linear,
            &[(0.0, [degrees])],
        )]
    };
    assert!(rejected(orbit(46_080.0)).contains("below 46080"));
    let mut file = scene_file();
    file.tracks = orbit(-46_079.0);
    assert!(
        !Tracks::from_bytes(built(&file).bytes())
            .expect("tracks")
            .is_empty()
    );
    let both = [TrackTarget::CameraRotation, TrackTarget::CameraOrbit];
    let both = both.map(|target| track(target, 0, Linear, &[(0.0, [0.0, 0.0, 0.0, 1.0])]));
    assert!(rejected(both.to_vec()).contains("rotation"));
    // What is supplied for the camera is not to blame.
    let late = track(
        TrackTarget::CameraFieldOfView,
        0,
        Linear,
        &[(1e9, [40.0; 4])],
    );
    assert!(rejected(vec![late]).contains("track of camera.fov"));
    let twice = [orbit(1.0), orbit(2.0)].concat();
    assert!(rejected(twice).contains("two tracks"));
}

#[test]
fn a_turntable_needs_no_camera_and_follows_an_import() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("the file is written");
    };
    write(
        "inner.toml",
        "[camera]\neye = [0, 0, 4]\ntarget = [0, 0, 0]\n\
         [[light]]\nkind = 'point'\nposition = [0, 3, 0]\n[material.red]\n\
         [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'red'\n\
         [[track]]\ntarget = 'camera.eye'\ntimes = [0, 1]\nvalues = [[0, 0, 4], [1, 0, 4]]\n\
         [[track]]\ntarget = 'light.0.position'\ntimes = [0, 1]\nvalues = [[0, 3, 0], [0, 4, 0]]\n\
         [[track]]\ntarget = 'material.red.diffuse'\ntimes = [0, 1]\nvalues = [0, 1]\n",
    );
    let outer = "[material.blue]\n[[object]]\nkind = 'box'\nmin = [5, 0, 0]\nmax = [6, 1, 1]\nmaterial = 'blue'\n\
         [[object]]\nkind = 'import'\nfile = 'inner.toml'\ntranslate = [10, 0, 0]\nscale = 2\n\
         [[track]]\ntarget = 'camera.orbit'\ntimes = [0, 4]\nvalues = [0, 360]\n";
    let path = folder.path().join("outer.toml");
    let imported = read(&path, outer.into(), &ImportOptions::default()).expect("reads");
    let find = |target| {
        let mut tracks = imported.scene.tracks.iter();
        tracks
            .find(|track| track.target == target)
            .expect("a track")
    };
    assert_eq!(imported.scene.tracks.len(), 4);
    let last = |target| find(target).keys[1].vector();
    assert_eq!(last(TrackTarget::CameraEye), DVec3::new(12.0, 0.0, 8.0));
    assert_eq!(last(TrackTarget::LightPosition), DVec3::new(10.0, 8.0, 0.0));
    let material = find(TrackTarget::MaterialDiffuse).index;
    assert_eq!(imported.scene.materials[material].name, "red");
    let blob = built(&imported.scene);
    assert_eq!(
        Tracks::from_bytes(blob.bytes())
            .expect("tracks")
            .tracks()
            .len(),
        7
    );
}

/// A scene may be many times wider than what moves in it.
#[test]
fn what_moves_has_room_at_every_time_in_scenes_of_every_width() {
    let tracks = [
        "target = 'joint.j.shift'\nvalues = [[0, 0, 0], [0, 1, 0]]",
        "target = 'joint.j.scale'\nvalues = [1, 2]",
        "target = 'joint.j.rotation'\naxis = [0, 0, 1]\nvalues = [0, 90]",
    ];
    for (half, track) in [1, 10, 37, 1000, 30_000]
        .into_iter()
        .flat_map(|half| tracks.map(|track| (half, track)))
    {
        let file = format!(
            "[[object]]\nkind = 'box'\nmin = [-{half}, -9, -{half}]\nmax = [{half}, -8, {half}]\n\
             [[part]]\nname = 'p'\nobject = [{{ kind = 'box', min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.5] }}]\n\
             [[joint]]\nname = 'j'\n[[instance]]\npart = 'p'\njoint = 'j'\ntranslate = [0, {half}, 0]\n\
             [[track]]\ntimes = [0, 1]\n{track}\n"
        );
        let imported = read("lift.toml".as_ref(), file.into(), &ImportOptions::default());
        let blob = built(&imported.expect("reads").scene);
        let scene = blob.scene().expect("a scene");
        let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
        for time in [0.0, 0.5, 0.999, 1.0, 2.0] {
            let state = State::at(&blob, &scene, &tracks, ticks(&tracks, time).unwrap());
            let applied = state.as_ref().map(|state| state.apply(&scene).map(drop));
            assert!(
                matches!(applied, Ok(Ok(()))),
                "{half}, {track}, {time}: {state:?}"
            );
        }
    }
}

/// A matrix that is turned, scaled and doubled is still a rotation.
#[test]
fn turned_and_scaled_instances_have_a_place_at_every_tick() {
    let file = "room = [[-9, -9, -9], [9, 9, 9]]\n[[part]]\nname = 'p'\n\
        object = [{ kind = 'box', min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.5] }]\n\
        [[joint]]\nname = 'j'\n[[instance]]\npart = 'p'\njoint = 'j'\nscale = 0.484\n\
        rotate = [-66.9, -67.3, 27.6]\n[[track]]\ntarget = 'joint.j.rotation'\ntimes = [0, 1, 2]\n\
        values = [[10, 20, 30], [100, -40, 170], [-60, 80, 20]]\n\
        [[track]]\ntarget = 'joint.j.scale'\ntimes = [0, 2]\nvalues = [1.01, 1.3]\n";
    let imported = read(
        "drift.toml".as_ref(),
        file.into(),
        &ImportOptions::default(),
    );
    let blob = built(&imported.expect("reads").scene);
    let scene = blob.scene().expect("a scene");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
    for time in (0..96_000).step_by(7).chain([28_133]) {
        let state = State::at(&blob, &scene, &tracks, time);
        assert!(state.is_ok(), "tick {time}: {state:?}");
    }
}
