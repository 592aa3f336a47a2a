//! Materials, textures, cameras and lights.

use super::*;

fn material(made: Value) -> Material {
    let mut document = document();
    document["materials"] = json!([made]);
    scene(&document).materials.remove(0)
}

#[test]
fn materials_take_mirror_glass_and_glow_from_gltf() {
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
    assert_eq!((steel.mirror, steel.roughness), ([0.5; 3], 0.25));
    assert_eq!(steel.diffuse, Diffuse::Plain([0.0; 3]));
    assert_eq!(steel.highlight, [0.0; 3]);
    // A material without further keys is not rough.
    let unsaid = material(json!({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1]}}));
    assert_eq!((unsaid.mirror, unsaid.roughness), ([0.0; 3], 0.0));
    assert_eq!(unsaid.diffuse, Diffuse::Plain([0.5; 3]));
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
    // As much of it glows as is there.
    let glow = material(json!({"alphaMode": "BLEND", "emissiveFactor": [1, 0.5, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 0.25]}}));
    assert_eq!(glow.emission, [0.25, 0.125, 0.0]);
    // The highlight of a metal has its hue.
    let gold = material(json!({"pbrMetallicRoughness": {
        "baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 1, "roughnessFactor": 0}}));
    assert_eq!(gold.highlight, [1.0, 0.5, 0.25]);
}

#[test]
fn camera_and_lights_are_read_from_nodes() {
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
    assert!(warnings[0].ends_with("cameras without a perspective are left out"));
    assert!(matches!(scene.camera, Some(Camera { .. })));
}

/// A scene of a mesh and a light.
fn lit(light: &Value) -> Imported {
    let mut document = document();
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
    document["nodes"] = json!([
        {"mesh": 0},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 5, 0]},
    ]);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    read(document.to_string().as_bytes()).unwrap()
}

#[test]
fn a_scene_whose_lights_have_no_strength_is_dark() {
    let scene = lit(&json!({"type": "directional", "intensity": 0})).scene;
    let color = [0.0; 3];
    assert!(matches!(scene.lights[..], [Light::Directional { color: own, .. }] if own == color));
    assert!(scene.is_lit());
}

#[test]
fn spots_that_are_too_narrow_for_f32_are_widened_with_a_warning() {
    let spot = |outer: f64| {
        let cone = json!({"innerConeAngle": 0, "outerConeAngle": outer.to_radians()});
        let imported = lit(&json!({"type": "spot", "spot": cone}));
        let form = imported.scene.light_forms[0].unwrap();
        (form.spot.unwrap().outer, imported.warnings)
    };
    let (outer, warnings) = spot(0.01);
    assert_eq!(outer, 0.3);
    assert!(warnings[0].contains("0.3 degrees"), "{warnings:?}");
    let (outer, warnings) = spot(0.5);
    assert!((outer - 0.5).abs() < 1e-5 && warnings.is_empty());
}

#[test]
fn ignored_attributes_are_counted_in_one_warning_each() {
    let mut document = document();
    assert_eq!(warnings(&document), [] as [&str; 0]);
    let part = json!({"attributes": {"POSITION": 0, "NORMAL": 0, "COLOR_1": 0}, "indices": 1});
    document["meshes"][0]["primitives"] = json!([part, part, part]);
    document["materials"] = json!([{"emissiveFactor": [1, 0, 0], "name": "lamp"}]);
    assert_eq!(
        warnings(&document),
        ["COLOR_1 of a primitive is ignored; COLOR_0 is read (and 2 times more)"]
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
            [
                "the texture of material \"plain\" names no image that Gridel reads; its plain color is used"
            ]
        );
    }
    let mut document = document();
    document["textures"] = json!([{}]);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 1});
    assert!(cause(&document).contains("baseColorTexture"));
}

/// The square with texture coordinates 0, 1/2, 1 in 16 bits, colors in 8 bits, and a texture of two by one texels.
pub(super) fn textured() -> Value {
    let mut document = document();
    let pixels = [[255, 0, 0, 255], [0, 0, 255, 255]];
    let image = STANDARD.encode(crate::scene::image::tests::png_of(2, 1, &pixels));
    document["images"] = json!([{"uri": format!("data:image/png;base64,{image}")}]);
    document["samplers"] = json!([{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}]);
    document["textures"] = json!([{"source": 0, "sampler": 0}, {"source": 0}]);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
    let coordinates: [u16; 8] = [0, 0, 65535, 0, 65535, 65535, 0, 32768];
    let coordinates = coordinates.iter().flat_map(|it| it.to_le_bytes());
    let colors: [u8; 16] = [
        255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 51, 51, 51, 127,
    ];
    let more: Vec<u8> = coordinates.chain(colors).collect();
    push(
        &mut document,
        "buffers",
        json!({"byteLength": 32,
        "uri": format!("data:application/octet-stream;base64,{}", STANDARD.encode(more))}),
    );
    push(
        &mut document,
        "bufferViews",
        json!({"buffer": 1, "byteLength": 16}),
    );
    push(
        &mut document,
        "bufferViews",
        json!({"buffer": 1, "byteOffset": 16, "byteLength": 16}),
    );
    push(
        &mut document,
        "accessors",
        json!({"bufferView": 2, "componentType": 5123, "normalized": true,
        "count": 4, "type": "VEC2"}),
    );
    push(
        &mut document,
        "accessors",
        json!({"bufferView": 3, "componentType": 5121, "normalized": true,
        "count": 4, "type": "VEC4"}),
    );
    document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(2);
    document
}

#[test]
fn base_color_textures_have_their_sampler_and_transform() {
    let mut document = textured();
    let made = scene(&document);
    let texture = made.materials[0].texture.clone().unwrap();
    assert_eq!(texture.image.pixels()[1], [0, 0, 255, 255]);
    assert_eq!(
        (texture.wrap, texture.bilinear),
        ([Wrap::Clamp, Wrap::Mirror], false)
    );
    let attributes = &made.objects[0].attributes;
    assert_eq!(attributes.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(attributes.coordinates[2].to_array(), [1.0, 1.0]);
    assert_eq!(warnings(&document), [] as [&str; 0]);

    let info = &mut document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    let turn = std::f64::consts::FRAC_PI_2;
    *info = json!({"index": 1, "extensions": {"KHR_texture_transform":
        {"offset": [0.5, 0.25], "rotation": turn, "scale": [2, 3]}}});
    document["extensionsUsed"] = json!(["KHR_texture_transform", "KHR_lights_punctual"]);
    let made = scene(&document);
    let texture = made.materials[0].texture.clone().unwrap();
    assert_eq!((texture.wrap, texture.bilinear), ([Wrap::Repeat; 2], true));
    // The matrix of the extension: translation * rotation * scale, with the rotation [[c, s], [-s, c]].
    let placed = made.objects[0].attributes.placed_on(Some(&texture));
    let corner = placed.coordinates[1];
    assert!(
        (corner - glam::DVec2::new(0.5, 0.25 - 2.0)).length() < 1e-6,
        "{corner}"
    );
    let corner = placed.coordinates[2];
    assert!(
        (corner - glam::DVec2::new(3.5, 0.25 - 2.0)).length() < 1e-6,
        "{corner}"
    );
}

#[test]
fn normal_textures_lie_as_that_of_the_base_color_does() {
    let mut document = textured();
    document["materials"][0]["normalTexture"] = json!({"index": 0, "scale": 0.5});
    let map = scene(&document).materials[0].normal_map.clone().unwrap();
    assert_eq!((map.scale, map.texture.bilinear), (0.5, false));
    assert_eq!(map.texture.wrap, [Wrap::Clamp, Wrap::Mirror]);
    assert_eq!(warnings(&document), [] as [&str; 0]);

    // Alone, with a transform of its own.
    let transform = json!({"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 3]}});
    let surface = &mut document["materials"][0]["pbrMetallicRoughness"];
    surface.as_object_mut().unwrap().remove("baseColorTexture");
    document["materials"][0]["normalTexture"] =
        json!({"index": 1, "scale": 20, "extensions": transform});
    document["extensionsUsed"] = json!(["KHR_texture_transform", "KHR_lights_punctual"]);
    let made = scene(&document);
    let material = &made.materials[0];
    assert_eq!(material.texture, None);
    let placed = made.objects[0].attributes.placed_on(material.placing());
    assert_eq!(placed.coordinates[2].to_array(), [2.5, 3.25]);
    let [warning] = &warnings(&document)[..] else {
        panic!("one warning");
    };
    assert!(warning.contains("has the scale 20"), "{warning}");

    // An invalid transform is an error, as with the color's.
    let mut broken = document.clone();
    broken["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["scale"] =
        json!("large");
    let error = cause(&broken);
    assert!(
        error.contains("the transform of the normal map of material 0 is broken"),
        "{error}"
    );

    // As the reader of glTF takes an empty list for no extensions.
    broken["materials"][0]["normalTexture"]["extensions"] = json!([]);
    assert!(scene(&broken).materials[0].normal_map.is_some());

    // Once the color's own transform, and once another one.
    let color = json!({"index": 0, "extensions": transform});
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = color;
    assert!(scene(&document).materials[0].normal_map.is_some());
    document["materials"][0]["normalTexture"] = json!({"index": 1});
    assert_eq!(scene(&document).materials[0].normal_map, None);
    let all = warnings(&document);
    assert!(all[0].contains("does not lie as the texture"), "{all:?}");
}

#[test]
fn images_that_cannot_be_read_are_named() {
    let mut document = textured();
    document["images"] = json!([{"uri": "none.png"}]);
    let found = warnings(&document);
    assert!(
        found.len() == 1 && found[0].contains("none.png"),
        "{found:?}"
    );
    assert_eq!(scene(&document).materials[0].texture, None);
    document["images"] = json!([{"uri": "../none.png"}]);
    assert!(cause(&document).contains("outside of the scene's folder"));
    document["images"] = json!([{"bufferView": 2, "mimeType": "image/png"}]);
    assert!(cause(&document).contains("neither PNG nor JPEG"));
    document["bufferViews"][2]["byteLength"] = json!(99);
    assert!(!cause(&document).is_empty());
    let mut document = textured();
    document["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 0});
    let found = warnings(&document);
    assert!(
        found.len() == 1 && found[0].contains("no TEXCOORD_0"),
        "{found:?}"
    );
}

/// The members `mimeType`, `uri` and `bufferView` of images.
#[test]
fn images_without_a_kind_or_data_are_told_by_their_bytes_or_left_out() {
    let mut document = textured();
    let image = scene(&document).materials[0].texture.clone().unwrap().image;
    let pixels = [[255, 0, 0, 255], [0, 0, 255, 255]];
    let bytes = crate::scene::image::tests::png_of(2, 1, &pixels);
    push(
        &mut document,
        "buffers",
        json!({
            "byteLength": bytes.len(),
            "uri": format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bytes)),
        }),
    );
    let buffer = document["buffers"].as_array().unwrap().len() - 1;
    push(
        &mut document,
        "bufferViews",
        json!({"buffer": buffer, "byteLength": bytes.len()}),
    );
    let view = document["bufferViews"].as_array().unwrap().len() - 1;
    document["images"] = json!([{"name": "wood", "bufferView": view}]);
    assert_eq!(
        warnings(&document),
        ["image 0 \"wood\" has no `mimeType`; its first bytes show whether it is PNG or JPEG"]
    );
    let read = scene(&document).materials[0].texture.clone().unwrap().image;
    assert_eq!(read.pixels(), image.pixels());
    for (image, named) in [
        (json!({}), "image 0"),
        (json!({"name": "wood"}), "image 0 \"wood\""),
    ] {
        document["images"] = json!([image]);
        assert_eq!(
            warnings(&document),
            [
                format!("{named} has neither `uri` nor `bufferView`; it is not drawn"),
                String::from(
                    "the texture of material \"plain\" names no image that Gridel reads; its plain color is used"
                ),
            ]
        );
        assert_eq!(scene(&document).materials[0].texture, None);
    }
}

#[test]
fn alpha_modes_of_textures_choose_cut_out_or_blend() {
    let mut document = textured();
    let pixels = [[255, 0, 0, 255], [0, 0, 255, 9]];
    let image = STANDARD.encode(crate::scene::image::tests::png_of(2, 1, &pixels));
    let clear = json!({"uri": format!("data:image/png;base64,{image}")});
    let alpha_of = |document: &Value| scene(document).materials[0].alpha;
    let set = |document: &mut Value, mode: &str, factor: f64, cutoff: f64| {
        document["materials"][0]["alphaMode"] = json!(mode);
        document["materials"][0]["alphaCutoff"] = json!(cutoff);
        let surface = &mut document["materials"][0]["pbrMetallicRoughness"];
        surface["baseColorFactor"] = json!([1, 1, 1, factor]);
    };
    // An opaque image leaves a pane.
    set(&mut document, "BLEND", 0.25, 0.5);
    assert_eq!(alpha_of(&document), None);
    assert_eq!(scene(&document).materials[0].transmit, [0.75; 3]);
    document["images"][0] = clear;
    assert_eq!(alpha_of(&document), Some(Alpha::Blend(0.25)));
    assert_eq!(scene(&document).materials[0].transmit, [0.0; 3]);
    for (mode, factor, cutoff, expected) in [
        ("OPAQUE", 0.5, 0.5, None),
        ("MASK", 1.0, 0.5, Some(Alpha::CutOut(0.5))),
        ("MASK", 0.5, 0.25, Some(Alpha::CutOut(0.5))),
        ("MASK", 0.5, 0.0, None),
    ] {
        set(&mut document, mode, factor, cutoff);
        assert_eq!(alpha_of(&document), expected, "{mode} {factor} {cutoff}");
        assert_eq!(
            scene(&document).materials[0].diffuse,
            Diffuse::Plain([1.0; 3])
        );
    }
    // No texel has as much alpha as the cutoff.
    set(&mut document, "MASK", 0.5, 0.75);
    assert!(scene(&document).objects.is_empty());
}

#[test]
fn strong_emission_is_limited_with_a_warning() {
    let mut document = document();
    let strong = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 1e6}});
    document["materials"] =
        json!([{"name": "lamp", "emissiveFactor": [1, 0, 0], "extensions": strong}]);
    assert_eq!(scene(&document).materials[0].emission, [2047.0, 0.0, 0.0]);
    let found = warnings(&document);
    assert!(
        found[0].contains("lamp") && found[0].contains("limited to 2047"),
        "{found:?}"
    );
}

#[test]
fn what_a_mask_cuts_out_wholly_is_left_out() {
    let mut document = document();
    let thin = json!({"baseColorFactor": [1, 1, 1, 0.3]});
    document["materials"] =
        json!([{"alphaMode": "MASK", "name": "leaf", "pbrMetallicRoughness": thin}]);
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
    assert!(scene(&document).objects.is_empty());
    let found = warnings(&document);
    let sentence = "the alpha of material \"leaf\" is below its cutoff; what has it is left out";
    assert!(found.iter().any(|it| it == sentence), "{found:?}");
}
