//! Numbers and extensions of materials, and colors of vertices, that are not taken as they are.

use super::animation::animated;
use super::appearance::textured;
use super::*;

#[test]
fn colors_of_vertices_on_metal_and_glass_are_warned_of() {
    let colored = |surface: Value, extensions: Value| {
        let mut document = document();
        document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(2);
        push(
            &mut document,
            "accessors",
            json!({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}),
        );
        document["materials"][0]["pbrMetallicRoughness"] = surface;
        document["materials"][0]["extensions"] = extensions;
        warnings(&document)
    };
    let warning = "COLOR_0 on material \"plain\" weights its diffuse color alone, not what it mirrors or lets through";
    let glass = json!({"KHR_materials_transmission": {"transmissionFactor": 0.5}});
    let rough = json!({"metallicFactor": 0});
    for (surface, extensions) in [
        (json!({"roughnessFactor": 0.5}), json!({})),
        (json!({"roughnessFactor": 0}), json!({})),
        (rough.clone(), glass),
    ] {
        assert_eq!(colored(surface, extensions), [warning]);
    }
    assert_eq!(colored(rough, json!({})), [] as [&str; 0]);
    assert_eq!(colored(json!({}), json!({})), [] as [&str; 0]);
}

#[test]
fn factors_out_of_range_are_warned_of() {
    let with = |surface: Value, emissive: f64| {
        let mut document = document();
        document["materials"][0]["pbrMetallicRoughness"] = surface;
        document["materials"][0]["emissiveFactor"] = json!([emissive, 0, 0]);
        warnings(&document)
    };
    let outside = |what: &str| {
        format!("the {what} factor of material \"plain\" is outside of its range, 0 to 1")
    };
    let base = json!({"baseColorFactor": [1, -1, 0, 1], "metallicFactor": 0});
    assert_eq!(with(base, 0.0), [outside("base color")]);
    let rough = json!({"roughnessFactor": 7, "metallicFactor": -1});
    assert_eq!(
        with(rough, 5.0),
        ["metallic", "roughness", "emissive"].map(outside)
    );
    assert_eq!(with(json!({"metallicFactor": 0}), 1.0), [] as [&str; 0]);
}

#[test]
fn extensions_that_are_not_listed_are_warned_of() {
    let mut document = document();
    document["materials"][0]["extensions"] = json!({"EXT_paint": {"shine": 1}});
    let unlisted = "`extensionsUsed` does not list extensions that elements have: EXT_paint";
    assert_eq!(warnings(&document), [unlisted]);
    document["extensionsUsed"] = json!(["KHR_lights_punctual", "EXT_paint"]);
    assert_eq!(warnings(&document), ["extensions are ignored: EXT_paint"]);
}

#[test]
fn times_beyond_the_limit_name_their_channel() {
    let mut document = animated(json!([{
        "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
        "samplers": [{"input": 2, "output": 3}],
    }]));
    let bytes: Vec<u8> = [0.0_f32, 1.0, 1e6]
        .iter()
        .flat_map(|it| it.to_le_bytes())
        .collect();
    let uri = format!(
        "data:application/octet-stream;base64,{}",
        STANDARD.encode(bytes)
    );
    push(
        &mut document,
        "buffers",
        json!({"byteLength": 12, "uri": uri}),
    );
    push(
        &mut document,
        "bufferViews",
        json!({"buffer": 2, "byteLength": 12}),
    );
    let view = document["bufferViews"].as_array().unwrap().len() - 1;
    document["accessors"][2]["bufferView"] = json!(view);
    assert_eq!(
        cause(&document),
        "animation 0, channel 0 of node 1: the time 1000000 is beyond 44739 seconds, the limit"
    );
}

/// The components along u and v change their sign, which the image can, but not the scale.
#[test]
fn normal_maps_of_negative_scale_are_turned() {
    let mut document = document();
    let pixels = [[0, 255, 200, 255], [128, 100, 255, 7]];
    let image = STANDARD.encode(crate::scene::image::tests::png_of(2, 1, &pixels));
    document["images"] = json!([{"uri": format!("data:image/png;base64,{image}")}]);
    document["textures"] = json!([{"source": 0}]);
    let mut part = document["meshes"][0]["primitives"][0].clone();
    part["material"] = json!(1);
    push(&mut document["meshes"][0], "primitives", part);
    document["materials"] = json!([
        {"normalTexture": {"index": 0, "scale": -2}},
        {"normalTexture": {"index": 0, "scale": 0.5}},
    ]);
    // The square has no texture coordinates.
    let others = |document: &Value| {
        let mut found = warnings(document);
        found.retain(|it| !it.contains("no TEXCOORD_0"));
        found
    };
    assert_eq!(others(&document), [] as [&str; 0]);
    let maps = scene(&document).materials.into_iter();
    let maps = maps.map(|material| material.normal_map.unwrap());
    let found: Vec<_> = maps
        .map(|map| (map.scale, map.texture.image.pixels().to_vec()))
        .collect();
    let turned = vec![[255, 0, 200, 255], [127, 155, 255, 7]];
    assert_eq!(found, [(2.0, turned), (0.5, pixels.to_vec())]);
    document["materials"][0]["normalTexture"]["scale"] = json!(-20);
    assert!(others(&document)[0].contains("has the scale -20; it is drawn with -16"));
}

#[test]
fn colors_of_vertices_are_linear() {
    let mut document = textured();
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(3);
    let made = scene(&document);
    let colors = &made.objects[0].attributes.colors;
    assert_eq!(
        colors[..3],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    );
    assert_eq!(colors[3], [0.2; 3]);
    // What is opaque has no alpha.
    assert_eq!(warnings(&document), Vec::<String>::new());
    for mode in ["MASK", "BLEND"] {
        document["materials"][0]["alphaMode"] = json!(mode);
        assert_eq!(
            warnings(&document),
            ["the alpha of COLOR_0 is ignored"],
            "{mode}"
        );
    }
    document["accessors"][3]["count"] = json!(3);
    assert!(cause(&document).contains("4 vertices and 3 colors"));
    document["accessors"][3] =
        json!({"bufferView": 3, "componentType": 5121, "count": 4, "type": "SCALAR"});
    assert!(cause(&document).contains("is to hold colors"));
}
