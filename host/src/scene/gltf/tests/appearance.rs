//! Materials, textures, cameras and lights.

use super::*;

fn material(made: Value) -> Material {
    let mut document = document();
    document["materials"] = json!([made]);
    scene(&document).materials.remove(0)
}

#[test]
fn materials() {
    let matte = material(json!({"name": "matte",
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 0}}));
    assert_eq!(matte.name, "matte");
    assert_eq!(matte.diffuse, Diffuse::Plain([0.5, 0.25, 1.0]));
    assert_eq!(
        [matte.highlight, matte.mirror, matte.transmit],
        [[0.0; 3]; 3]
    );
    let steel = material(json!({"pbrMetallicRoughness": {
        "baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 1, "roughnessFactor": 0.25}}));
    assert_eq!(steel.mirror, [0.375; 3]);
    assert_eq!(steel.diffuse, Diffuse::Plain([0.125; 3]));
    assert_eq!((steel.shininess, steel.highlight), (510, [1.0; 3]));
    let glass = material(json!({
    "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
    "extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 0.75},
        "KHR_materials_ior": {"ior": 1.25},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2,
                                 "attenuationColor": [1, 0.5, 0]},
    }}));
    assert_eq!((glass.ior, glass.transmit), (1.25, [0.75; 3]));
    assert_eq!(glass.diffuse, Diffuse::Plain([0.25; 3]));
    assert_eq!(glass.absorption[..2], [0.0, 2.0_f64.ln() / 2.0]);
    assert!(glass.absorption[2] > 6.0 && glass.absorption[2].is_finite());
    let pane = material(json!({"alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.25], "metallicFactor": 0}}));
    assert_eq!((pane.ior, pane.transmit), (1.0, [0.75; 3]));
    assert_eq!(pane.diffuse, Diffuse::Plain([0.25, 0.0, 0.0]));
}

#[test]
fn a_camera_and_lights() {
    let mut document = document();
    document["cameras"] = json!([
        {"type": "orthographic",
         "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 1}},
        {"type": "perspective",
         "perspective": {"yfov": std::f64::consts::FRAC_PI_2, "znear": 1, "aspectRatio": 1.5}},
    ]);
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 800, "color": [1, 0.5, 0]},
        {"type": "directional", "intensity": 4},
        {"type": "spot", "intensity": 0, "range": 7,
         "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
    ]}});
    let light = |number: usize| json!({"KHR_lights_punctual": {"light": number}});
    document["nodes"] = json!([
        {"mesh": 0, "translation": [-0.5, -0.5, 0]},
        {"camera": 0},
        {"camera": 1, "translation": [0, 0, 5]},
        {"extensions": light(0), "translation": [0, 10, 0]},
        {"extensions": light(1), "rotation": [1, 0, 0, 0]},
        {"extensions": light(2)},
    ]);
    document["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4, 5]);
    let Imported {
        scene, warnings, ..
    } = read(document.to_string().as_bytes()).unwrap();
    let camera = scene.camera.unwrap();
    assert_eq!(
        (camera.eye, camera.target, camera.up),
        (DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y)
    );
    assert!((camera.fov_degrees - 90.0).abs() < 1e-4);
    assert_eq!((scene.render.width, scene.render.height), (360, 240));
    // 800 candela ten units away are 8 lux, the strongest, and 1 there.
    assert_eq!(
        scene.lights[..2],
        [
            Light::Point {
                position: DVec3::Y * 10.0,
                color: [100.0, 50.0, 0.0]
            },
            Light::Directional {
                direction: DVec3::Z,
                color: [0.5; 3]
            },
        ]
    );
    let [Some(point), None, Some(spot)] = scene.light_forms[..] else {
        panic!("{:?}", scene.light_forms);
    };
    assert_eq!(point, LightForm::default());
    assert_eq!(spot.range, Some(7.0));
    let cone = spot.spot.unwrap();
    assert_eq!(cone.direction, -DVec3::Z);
    for (found, radians) in [(cone.inner, 0.25_f64), (cone.outer, 0.5)] {
        assert!((found - radians.to_degrees()).abs() < 1e-5);
    }
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("several cameras"));
    assert!(matches!(scene.camera, Some(Camera { .. })));
}

#[test]
fn ignored_attributes_are_counted_in_one_warning_each() {
    let mut document = document();
    assert_eq!(warnings(&document), [] as [&str; 0]);
    let part = json!({"attributes": {"POSITION": 0, "NORMAL": 0, "COLOR_0": 0}, "indices": 1});
    document["meshes"][0]["primitives"] = json!([part, part, part]);
    document["materials"] = json!([{"alphaMode": "MASK", "name": "leaf"},
        {"emissiveFactor": [1, 0, 0], "name": "lamp"}]);
    assert_eq!(
        warnings(&document),
        [
            "COLOR_0 of a primitive is ignored; its surface has its material's color (and 2 times \
             more)",
            "the alpha mask of material \"leaf\" is ignored; it is opaque",
        ]
    );
}

#[test]
fn points_alone_draw_nothing_and_say_so() {
    let mut document = document();
    document["meshes"][0]["primitives"][0]["mode"] = json!(0);
    let imported = read(document.to_string().as_bytes()).unwrap();
    assert!(imported.scene.objects.is_empty());
    let found = warnings(&document);
    assert_eq!(found[0], "points and lines are not drawn");
    assert!(
        found[1].contains("has no triangles; nothing is drawn"),
        "{found:?}"
    );
}

/// The member `source` of a texture is optional.
#[test]
fn textures_without_a_source_are_read() {
    for images in [json!(null), json!([{"uri": "a.png"}])] {
        let mut document = document();
        document["textures"] = json!([{}, {"sampler": 0}, {"name": "third"}]);
        document["samplers"] = json!([{}]);
        if !images.is_null() {
            document["images"] = images;
            document["textures"][2]["source"] = json!(0);
        }
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 1});
        assert_eq!(
            warnings(&document),
            ["textures are not drawn; the plain colors are used (and 2 times more)"]
        );
    }
    let mut document = document();
    document["textures"] = json!([{}]);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 1});
    assert!(cause(&document).contains("baseColorTexture"));
}
