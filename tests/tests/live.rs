//! Cameras, lights and materials of a program that replace a blob's own.

use glam::DVec3;
use gridel_core::format::limits::FARTHEST;
use gridel_core::format::record::{Light as LightRecord, Material as MaterialRecord, View};
use gridel_core::render::RenderError;
use gridel_core::{
    Angle, BlobError, Camera, Effects, Fixed, Format, Position, Renderer, Scene, Settings,
    Structure, Up,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::render::{Job, render};
use gridel_host::scene::{Camera as SceneCamera, Diffuse, Light, Material, Scene as SceneFile};
use gridel_host::shape::{Shape, Sphere};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// Steps of a scene's coordinates in scene units.
fn in_scene_units(scene: &Scene<'_>, position: Position) -> DVec3 {
    DVec3::from_array(scene.header().coordinate_origin())
        + DVec3::from_array(position.0.map(f64::from)) * f64::powi(2.0, scene.coordinate_exponent())
}

/// The nearest place in a scene's coordinates.
fn position(scene: &Scene<'_>, place: DVec3) -> Position {
    let origin = in_scene_units(scene, Position([0; 3]));
    let steps = (place - origin) / f64::powi(2.0, scene.coordinate_exponent());
    Position(steps.round().to_array().map(|x| x as i32))
}

fn small(scene: &Scene<'_>) -> Settings {
    Settings {
        width: 32,
        height: 24,
        samples: 2,
        ..Settings::of(scene)
    }
}

/// A picture in each number format, through a structure.
fn pictures(scene: &Scene<'_>, structure: Structure) -> Vec<Vec<[u16; 3]>> {
    let settings = small(scene);
    let picture = |format| {
        let job = Job::whole(format, structure, settings);
        render(scene, &job, &|| ()).expect("a picture").pixels
    };
    Format::ALL.map(picture).to_vec()
}

fn built(scene: &SceneFile) -> Blob {
    let options = Options {
        structures: vec![Structure::DualSplit],
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

/// A scene with lights of both kinds, a mirror and a plain material.
fn scene_file() -> SceneFile {
    let mut scene = scenes::soup(5, 60, 0.4);
    scene.lights = vec![
        Light::Point {
            position: DVec3::new(3.0, 5.0, 4.0),
            color: [0.7; 3],
        },
        Light::Directional {
            direction: DVec3::new(0.0, -1.0, -1.0),
            color: [0.3; 3],
        },
    ];
    scene.materials = vec![
        Material::default(),
        Material {
            mirror: [0.5; 3],
            ..Material::default()
        },
    ];
    for (index, object) in scene.objects.iter_mut().enumerate() {
        object.material = index % 2;
    }
    scene.camera = Some(SceneCamera {
        eye: DVec3::new(0.0, 0.5, 5.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 45.0,
    });
    scene
}

#[test]
fn a_camera_at_run_time_is_the_one_that_is_compiled() {
    let (mut compared, mut drawn) = (0, 0);
    for (name, mut file) in scenes::fixtures() {
        let blob = built(&file);
        let scene = blob.scene().expect("a scene");
        let (own, size) = {
            let [low, high] = [0, 1].map(|side| {
                let corner = scene.bounds().0.map(|axis| f64::from(axis[side]));
                let unit = f64::powi(2.0, scene.header().unit_exponent.into());
                DVec3::from_array(scene.header().origin) + DVec3::from_array(corner) * unit
            });
            (low.midpoint(high), (high - low).max_element())
        };
        // Planes alone have no box.
        let size = if size == 0.0 { 1.0 } else { size };
        for (away, degrees) in [
            (DVec3::new(0.3, 0.7, 1.1), 45),
            (DVec3::new(-1.5, 0.2, -0.4), 90),
            (DVec3::new(0.01, 0.02, -0.03), 120),
        ] {
            let eye = position(&scene, own + away * size);
            let target = position(&scene, own);
            let up = [1, 5, -2];
            let camera = Camera::look_at(eye, target, up, Angle::degrees(degrees));
            let view = camera.expect(&name).view(&scene);
            let live = scene.with_view(&view).expect("a view");
            file.camera = Some(SceneCamera {
                eye: in_scene_units(&scene, eye),
                target: in_scene_units(&scene, target),
                up: DVec3::from_array(up.map(f64::from)),
                fov_degrees: degrees.into(),
            });
            let background = [scene.view().background, scene.view().ambient];
            let other = built(&file);
            let compiled = other.scene().expect("a scene");
            let lattice = |scene: &Scene<'_>| {
                let header = scene.header();
                (header.unit_exponent, header.origin.map(f64::to_bits))
            };
            let is_coarser = compiled.header().coordinate_shift > scene.header().coordinate_shift;
            if is_coarser || lattice(&compiled) != lattice(&scene) {
                // For an eye so far away coordinates are coarser; planes alone have another lattice.
                continue;
            }
            compared += 1;
            // The supplied defaults depend on whether the scene has a camera.
            let same_surroundings =
                background == [compiled.view().background, compiled.view().ambient];
            let frame = |view: &View| (view.eye, view.forward, view.right, view.up);
            assert_eq!(frame(live.view()), frame(compiled.view()), "{name}");
            if same_surroundings && scene.lights() == compiled.lights() {
                drawn += 1;
                let structure = Structure::DualSplit;
                assert_eq!(
                    pictures(&live, structure),
                    pictures(&compiled, structure),
                    "{name}"
                );
            }
        }
    }
    assert!(compared > 20 && drawn > 10, "{compared}, {drawn}");
}

#[test]
fn lights_and_materials_at_run_time_are_those_that_are_compiled() {
    let blob = built(&scene_file());
    let scene = blob.scene().expect("a scene");
    let mut file = scene_file();
    file.lights[0] = Light::Point {
        position: DVec3::new(-3.0, 2.0, 1.0),
        color: [0.9, 0.4, 0.1],
    };
    file.lights.push(Light::Directional {
        direction: DVec3::NEG_Y,
        color: [0.1, 0.1, 0.5],
    });
    file.materials[0].diffuse = Diffuse::Plain([0.1, 0.9, 0.3]);
    file.materials[1].mirror = [0.9, 0.1, 0.4];
    let other = built(&file);
    let compiled = other.scene().expect("a scene");
    let lights = scene.with_lights(compiled.lights()).expect("lights");
    let live = lights
        .with_materials(compiled.materials())
        .expect("materials");
    let structure = Structure::DualSplit;
    assert_eq!(pictures(&live, structure), pictures(&compiled, structure));
    assert_ne!(pictures(&live, structure), pictures(&scene, structure));
    // The library's lights are those of the compiler.
    for (number, light) in file.lights.iter().enumerate() {
        let record = light.in_blob(&scene, number).expect("a light");
        assert_eq!(record, compiled.lights()[number]);
    }
}

#[test]
fn structures_agree_from_eyes_and_under_lights_that_they_were_not_made_for() {
    let file = scene_file();
    let blob = scenes::blob_with_gridels(&file, 24, 3);
    let scene = blob.scene().expect("a scene");
    let unit = 1 << -scene.coordinate_exponent();
    let mut lights = scene.lights().to_vec();
    lights[0].vector = scene.on_lattice(Position([unit, -2 * unit, 3 * unit]));
    lights[1].vector = [1 << 29, 1 << 29, 1 << 28];
    let (middle, distance) = (Position([0; 3]), 4 * unit as u32);
    for turn in 0..3 {
        let turn = Angle::of_turn(turn, 3);
        let camera = Camera::orbit(Up::Y, middle, distance, turn, turn, Angle::degrees(60));
        let view = camera.expect("a camera").view(&scene);
        let live = scene.with_view(&view).expect("a view");
        let live = live.with_lights(&lights).expect("lights");
        let listed = pictures(&live, Structure::List);
        for structure in Structure::ALL {
            assert_eq!(pictures(&live, structure), listed, "{}", structure.name());
        }
    }
}

#[test]
fn an_effect_that_a_renderer_lacks_is_named() {
    let blob = built(&scene_file());
    let scene = blob.scene().expect("a scene");
    let mut materials = scene.materials().to_vec();
    materials[0].transmit = [1 << 29; 3];
    let live = scene.with_materials(&materials).expect("materials");
    assert_eq!(live.effects(), scene.effects().with(Effects::GLASS));
    const OPAQUE: u32 = Effects::SHADOW.with(Effects::MIRROR).0;
    type Opaque<'s, 'a> = Renderer<'s, 'a, Fixed, gridel_core::DualSplit, OPAQUE>;
    assert!(Opaque::with_settings(&scene, small(&scene)).is_ok());
    let error = Opaque::with_settings(&live, small(&live)).err();
    assert_eq!(error, Some(RenderError::Effects(Effects::GLASS)));
    assert!(error.unwrap().to_string().contains("glass"));
}

#[test]
fn lights_call_for_shadows_where_a_scene_has_none_of_its_own() {
    let mut file = scene_file();
    let lights: Vec<LightRecord> = built(&file).scene().expect("a scene").lights().to_vec();
    file.render.shadows = false;
    let unshadowed = built(&file);
    let scene = unshadowed.scene().expect("a scene");
    let effects = scene.with_lights(&lights).expect("lights").effects();
    assert!(
        !effects.contains(Effects::SHADOW),
        "the scene file turns them off"
    );
    file.render.shadows = true;
    file.lights.clear();
    file.ambient = [0.5; 3];
    let dark = built(&file);
    let scene = dark.scene().expect("a scene");
    assert!(scene.lights().is_empty());
    let effects = scene.with_lights(&lights).expect("lights").effects();
    assert!(effects.contains(Effects::SHADOW));
    assert_eq!(
        scene.with_lights(&[]).expect("none").effects(),
        scene.effects()
    );
}

#[test]
fn values_out_of_range_are_rejected_with_their_place() {
    let blob = built(&scene_file());
    let scene = blob.scene().expect("a scene");
    let view = |change: &dyn Fn(&mut View)| {
        let mut view = *scene.view();
        change(&mut view);
        scene.with_view(&view).err().map(|error| error.to_string())
    };
    let light = |change: &dyn Fn(&mut LightRecord)| {
        let mut lights = scene.lights().to_vec();
        change(&mut lights[1]);
        let error = scene.with_lights(&lights).err();
        error.map(|error| error.to_string())
    };
    let material = |change: &dyn Fn(&mut MaterialRecord)| {
        let mut materials = scene.materials().to_vec();
        change(&mut materials[1]);
        let error = scene.with_materials(&materials).err();
        error.map(|error| error.to_string())
    };
    let rejected = [
        (view(&|it| it.eye[1] = FARTHEST + 1), "eye"),
        (view(&|it| it.right[0] = -(1 << 28) - 1), "camera vector"),
        (view(&|it| it.ambient[2] = -1), "ambient"),
        (view(&|it| it.width = 0), "width"),
        (view(&|it| it.samples = 4097), "samples"),
        (light(&|it| it.color[0] = -1), "1"),
        (light(&|it| it.kind = 2), "1"),
        (light(&|it| it.vector = [0; 3]), "1"),
        (material(&|it| it.diffuse[0] = (1 << 30) + 1), "diffuse"),
        (material(&|it| it.shininess = 0), "shininess"),
        (material(&|it| it.inverse_ior = 0), "index of refraction"),
    ];
    for (error, part) in rejected {
        let error = error.expect("an error");
        assert!(error.contains(part), "{error}: no {part}");
    }
    for count in [0, 1, 3] {
        let materials = vec![scene.materials()[0]; count];
        let error = scene.with_materials(&materials).err();
        assert!(matches!(error, Some(BlobError::Memory { needed: 2, .. })));
    }
    assert_eq!(view(&|it| it.eye = [FARTHEST; 3]), None);
    assert_eq!(light(&|it| it.color = [i32::MAX; 3]), None);
}

/// Every accepted value renders, and no number leaves its range where ranges are checked.
#[test]
fn any_values_are_rejected_or_harmless() {
    let file = scene_file();
    let blob = built(&file);
    let scene = blob.scene().expect("a scene");
    let mut random = Random(11);
    let mut accepted = 0;
    for round in 0..2_000 {
        let mut view = *scene.view();
        let mut lights = scene.lights().to_vec();
        let mut materials = scene.materials().to_vec();
        let parts: [&mut [u8]; 3] = [
            bytemuck::bytes_of_mut(&mut view),
            bytemuck::cast_slice_mut(&mut lights),
            bytemuck::cast_slice_mut(&mut materials),
        ];
        let part = parts.into_iter().nth(round % 3).expect("one of three");
        for _ in 0..=random.below(3) {
            let bytes = [0x00, 0xff, 0x80, 0x7f, 0x40, 0x10];
            let place = random.below(part.len());
            part[place] = bytes[random.below(6)];
        }
        let live = scene
            .with_view(&view)
            .and_then(|scene| scene.with_lights(&lights))
            .and_then(|scene| scene.with_materials(&materials));
        let Ok(live) = live else { continue };
        let settings = Settings {
            width: 4,
            height: 3,
            samples: 1,
            ..Settings::of(&live)
        };
        for format in Format::ALL {
            let job = Job::whole(format, Structure::DualSplit, settings);
            accepted += u32::from(render(&live, &job, &|| ()).is_ok());
        }
    }
    assert!(accepted > 1_000, "{accepted}");
}

#[test]
fn coordinates_are_the_scenes_own_or_the_lattices_far_from_there() {
    for (offset, own) in [
        (0.0, 1),
        (1.0, 1),
        (-100.0, 1),
        (1e4, 0),
        (1e6, 0),
        (-1e9, 0),
    ] {
        let middle = DVec3::splat(offset);
        let shapes = [DVec3::ZERO, DVec3::ONE].map(|beside| {
            Shape::Sphere(Sphere {
                center: middle + beside,
                radius: 0.5,
            })
        });
        let mut file = scenes::of(shapes);
        file.camera = Some(SceneCamera {
            eye: middle + DVec3::new(0.0, 0.5, 5.0),
            target: middle,
            up: DVec3::Y,
            fov_degrees: 45.0,
        });
        let blob = built(&file);
        let scene = blob.scene().expect("a scene");
        assert_eq!(scene.header().counted_from, own, "{offset}");
        // Steps are far below a pixel, and reach beyond the eye.
        let step = f64::powi(2.0, scene.coordinate_exponent());
        assert!(step < 1e-6, "{step} at {offset}");
        let eye = in_scene_units(&scene, Position([i32::MAX; 3]));
        assert!((eye - DVec3::splat(offset)).min_element() > 4.0 * 5.0);
    }
}

#[test]
fn eyes_as_far_away_as_records_reach_are_placed() {
    let file = |offset: f64, eye: DVec3| {
        let mut file = scenes::of([Shape::Sphere(Sphere {
            center: DVec3::splat(offset),
            radius: 1.0,
        })]);
        file.camera = Some(SceneCamera {
            eye,
            target: DVec3::splat(offset),
            up: DVec3::Y,
            fov_degrees: 1e-3,
        });
        file
    };
    for offset in [0.0, -3.0, 1e5, -1e9] {
        let near = built(&file(offset, DVec3::splat(offset) + 3.0 * DVec3::Z));
        let header = *near.scene().expect("a scene").header();
        let unit = f64::powi(2.0, header.unit_exponent.into());
        // The largest coordinate of a record: 2^50, with 13 fraction bits.
        let reach = FARTHEST as f64 / 8192.0 * unit;
        let origin = DVec3::from_array(header.origin);
        for part in [1.0, 0.75, 0.3, 0.01] {
            for eye in [DVec3::X, DVec3::NEG_X, DVec3::new(-1.0, 0.5, 1.0)] {
                let eye = origin + reach * part * eye;
                let blob = built(&file(offset, eye));
                let scene = blob.scene().expect("a scene");
                let found = DVec3::from_array(scene.view().eye.map(|x| x as f64)) * unit / 8192.0;
                let step = f64::powi(2.0, scene.coordinate_exponent());
                let off = (found - (eye - origin)).abs().max_element();
                assert!(off <= step, "{off} steps of {step} at {offset}, {part}");
            }
        }
        let beyond = file(offset, origin + DVec3::Z * (reach * 1.001));
        let error = compile(&beyond, &Options::default()).expect_err("too far");
        assert!(error.to_string().starts_with("the camera lies"), "{error}");
    }
}
