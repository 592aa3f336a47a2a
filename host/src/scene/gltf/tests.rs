use super::*;
use crate::scene::test_scenes::{self, load, load_allowing_outside, mesh};
use crate::scene::{Camera, Diffuse, Light, Material};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// Bytes of a unit square in the plane z = 0 and of two triangles of it.
fn square() -> Vec<u8> {
    let positions: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let corners: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let mut bytes: Vec<u8> = positions.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(corners.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// A document of one mesh, the square, in one node.
fn document() -> Value {
    let data = STANDARD.encode(square());
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            {"name": "tile", "mesh": 0},
            {"camera": 0, "translation": [0.5, 0.5, 4],
             "extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 1}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
        "materials": [{"name": "plain", "pbrMetallicRoughness": {"metallicFactor": 0}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 60, "uri": format!("data:application/octet-stream;base64,{data}")}],
    })
}

pub(in crate::scene) fn text() -> String {
    document().to_string()
}

/// The same as a binary file.
pub(in crate::scene) fn binary() -> Vec<u8> {
    let mut document = document();
    document["buffers"] = json!([{"byteLength": 60}]);
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunks = [(text, *b"JSON"), (square(), *b"BIN\0")];
    let length: usize = 12
        + chunks
            .iter()
            .map(|(bytes, _)| 8 + bytes.len())
            .sum::<usize>();
    let mut file = b"glTF".to_vec();
    file.extend([2, length as u32].map(u32::to_le_bytes).concat());
    for (bytes, kind) in chunks {
        file.extend((bytes.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(bytes);
    }
    file
}

fn read(bytes: &[u8]) -> Result<Imported, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thing.gltf");
    std::fs::write(&path, bytes).unwrap();
    load(&path)
}

fn scene(document: &Value) -> Scene {
    read(document.to_string().as_bytes()).unwrap().scene
}

fn cause(document: &Value) -> String {
    let error = read(document.to_string().as_bytes()).unwrap_err();
    assert!(!error.remedy.is_empty());
    error.cause
}

/// The sum of the triangles' normals, each as long as twice its area.
fn facing(object: &Object) -> DVec3 {
    let (vertices, triangles) = mesh(object);
    let corners = |t: &[u32; 3]| t.map(|corner| vertices[corner as usize]);
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    triangles.iter().map(|t| normal(corners(t))).sum()
}

#[test]
fn a_square_as_text_and_as_binary() {
    let scene = scene(&document());
    let (vertices, triangles) = mesh(&scene.objects[0]);
    assert_eq!(vertices[2], DVec3::new(1.0, 1.0, 0.0));
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(scene.objects[0].name, "tile");
    assert_eq!(scene.materials[0].diffuse, Diffuse::Plain([1.0; 3]));
    assert_eq!(
        read(&binary()).unwrap().scene.objects[0].shape,
        scene.objects[0].shape
    );
    let with_mark = [b"\xef\xbb\xbf", document().to_string().as_bytes()].concat();
    assert!(read(&with_mark).is_ok());
}

#[test]
fn a_buffer_in_a_file_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thing.gltf");
    let mut document = document();
    document["buffers"][0]["uri"] = json!("the%20square.bin");
    std::fs::write(&path, document.to_string()).unwrap();
    let missing = load(&path).unwrap_err();
    assert!(missing.cause.contains("the square.bin"), "{missing}");
    std::fs::write(folder.path().join("the square.bin"), square()).unwrap();
    assert_eq!(load(&path).unwrap().scene.objects.len(), 1);
}

/// Children stand in their parents, and what is mirrored still faces outward.
#[test]
fn nodes_place_their_meshes() {
    let mut document = document();
    document["nodes"] = json!([
        {"translation": [10, 0, 0], "children": [1, 2], "rotation": [0, 0, 1, 1]},
        {"mesh": 0, "scale": [2, 2, 2]},
        {"mesh": 0, "scale": [-1, 1, 1], "name": "mirrored"},
    ]);
    document["scenes"][0]["nodes"] = json!([0]);
    let scene = scene(&document);
    let (vertices, _) = mesh(&scene.objects[0]);
    assert!(vertices[1].distance(DVec3::new(10.0, 2.0, 0.0)) < 1e-6);
    assert!(facing(&scene.objects[0]).distance(DVec3::Z * 8.0) < 1e-6);
    assert_eq!(scene.objects[1].name, "mirrored");
    assert!(facing(&scene.objects[1]).distance(DVec3::Z * 2.0) < 1e-6);
}

#[test]
fn strips_fans_and_meshes_without_indices() {
    let mut document = document();
    document["meshes"][0]["primitives"] = json!([
        {"attributes": {"POSITION": 0}, "mode": 6},
        {"attributes": {"POSITION": 0}, "mode": 5},
        {"attributes": {"POSITION": 0}},
        {"attributes": {"POSITION": 0}, "mode": 1},
    ]);
    let scene = scene(&document);
    let triangles: Vec<_> = scene.objects.iter().map(|object| mesh(object).1).collect();
    assert_eq!(triangles[0], [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(triangles[1], [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(triangles[2], [[0, 1, 2]]);
    assert_eq!(scene.objects.len(), 3);
    assert_eq!(scene.objects[1].name, "tile 1");
}

/// An accessor may replace elements of its view, or of nothing.
#[test]
fn sparse_positions() {
    let mut bytes = square();
    bytes.extend([2, 0, 0, 0]);
    bytes.extend([9.0_f32, 8.0, 7.0].iter().flat_map(|x| x.to_le_bytes()));
    let mut document = document();
    document["buffers"][0] = json!({
        "byteLength": bytes.len(),
        "uri": format!("data:;base64,{}", STANDARD.encode(&bytes)),
    });
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteOffset": 60, "byteLength": 4}));
    views.push(json!({"buffer": 0, "byteOffset": 64, "byteLength": 12}));
    document["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": 2, "componentType": 5121},
        "values": {"bufferView": 3},
    });
    let placed = scene(&document);
    let (vertices, _) = mesh(&placed.objects[0]);
    assert_eq!(vertices[1..3], [DVec3::X, DVec3::new(9.0, 8.0, 7.0)]);
    let accessor = document["accessors"][0].as_object_mut().unwrap();
    accessor.remove("bufferView");
    let placed = scene(&document);
    let (vertices, _) = mesh(&placed.objects[0]);
    assert_eq!(vertices[1..3], [DVec3::ZERO, DVec3::new(9.0, 8.0, 7.0)]);
    document["accessors"][0]["count"] = json!(2);
    let part = document["meshes"][0]["primitives"][0].as_object_mut();
    part.unwrap().remove("indices");
    assert!(cause(&document).contains("replaces element 2"));
}

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
        {"type": "spot", "intensity": 0, "spot": {}},
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
    // 800 candela ten units away are 8, the strongest.
    assert_eq!(
        scene.lights[..2],
        [
            Light::Point {
                position: DVec3::Y * 10.0,
                color: [1.0, 0.5, 0.0]
            },
            Light::Directional {
                direction: DVec3::Z,
                color: [0.5; 3]
            },
        ]
    );
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(warnings[0].contains("several cameras") && warnings[1].contains("spot lights"));
    assert!(matches!(scene.camera, Some(Camera { .. })));
}

#[test]
fn broken_documents() {
    let with = |change: fn(&mut Value)| {
        let mut document = document();
        change(&mut document);
        cause(&document)
    };
    for (change, expected) in [
        (
            (|d| d["nodes"][0]["children"] = json!([0])) as fn(&mut Value),
            "node 0 is inside of itself",
        ),
        (
            |d| d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]),
            "KHR_draco_mesh_compression",
        ),
        (
            |d| d["accessors"][0]["type"] = json!("VEC2"),
            "holds Vec2 of F32",
        ),
        (
            |d| d["accessors"][1]["componentType"] = json!(5126),
            "holds Scalar of F32",
        ),
        (
            |d| d["accessors"][0]["count"] = json!(5),
            "reads 5 elements",
        ),
        (|d| d["accessors"][0]["count"] = json!(3), "uses vertex 3"),
        (
            |d| d["accessors"][0]["count"] = json!(4_000_000_000_u32),
            "are the most",
        ),
        (
            |d| d["bufferViews"][0]["byteOffset"] = json!(u64::MAX),
            "has 0 bytes",
        ),
        (
            |d| d["bufferViews"][0]["byteStride"] = json!(4),
            "4 bytes apart",
        ),
        (
            |d| d["buffers"][0]["byteLength"] = json!(61),
            "61 are announced",
        ),
        (|d| d["buffers"][0]["uri"] = json!("https://a/b"), "network"),
        (
            |d| d["buffers"][0]["uri"] = json!("data:text/plain,abc"),
            "not in base 64",
        ),
        (
            |d| d["nodes"][0]["scale"] = json!([1e38, 1e39, 1]),
            "finite",
        ),
        (|d| d["nodes"][0]["mesh"] = json!(7), "nodes[0].mesh"),
        (
            |d| d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(7),
            "mesh 0 uses accessor 7",
        ),
        (
            |d| d["cameras"][0]["type"] = json!("orthographic"),
            "camera 0 lacks",
        ),
    ] {
        let cause = with(change);
        assert!(cause.contains(expected), "{expected}: {cause}");
    }
    let error = read(b"{\n \"asset\": {\"version\": 2.0}\n}").unwrap_err();
    assert_eq!(error.line, Some(2));
}

/// Instances count against what a blob can hold before they are made.
#[test]
fn a_million_instances_are_refused() {
    let mut document = document();
    let count = 100_000;
    document["nodes"] = json!(vec![json!({"mesh": 0}); count]);
    document["scenes"][0]["nodes"] = json!((0..count).collect::<Vec<_>>());
    document["meshes"][0]["primitives"] =
        json!(vec![document["meshes"][0]["primitives"][0].clone(); 50]);
    assert!(cause(&document).contains("instances counted"));
}

/// Triangles, instances counted, as other programs count them.
#[test]
fn files_of_other_projects() {
    for (name, objects, triangles) in [
        ("monkey.glb", 1, 968),
        ("BoxTextured.glb", 1, 12),
        ("boolean.glb", 28, 3936),
        ("nested.glb", 3, 36),
        ("no_indices_3storybuilding.glb", 3, 72),
        ("TestScene.gltf", 9, 1096),
    ] {
        let Some(path) = test_scenes::find(&format!("meshes/{name}")) else {
            return;
        };
        let scene = load(&path).unwrap_or_else(|error| panic!("{error}")).scene;
        let count: usize = scene
            .objects
            .iter()
            .map(|object| mesh(object).1.len())
            .sum();
        assert_eq!((scene.objects.len(), count), (objects, triangles), "{name}");
    }
}

fn warnings(document: &Value) -> Vec<String> {
    let warnings = read(document.to_string().as_bytes()).unwrap().warnings;
    let sentence = |warning: &String| warning.split_once(": ").unwrap().1.to_owned();
    warnings.iter().map(sentence).collect()
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
            "NORMAL of a primitive is ignored; its surface is shaded flat (and 2 times more)",
            "COLOR_0 of a primitive is ignored; its surface has its material's colour (and 2 times \
             more)",
            "the alpha mask of material \"leaf\" is ignored; it is opaque",
            "material \"lamp\" glows, which is ignored; it is not brighter",
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
            ["textures are not drawn; the plain colours are used (and 2 times more)"]
        );
    }
    let mut document = document();
    document["textures"] = json!([{}]);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 1});
    assert!(cause(&document).contains("baseColorTexture"));
}

#[test]
fn other_versions_are_rejected() {
    let mut document = document();
    for (version, message) in [
        (json!("3.0"), "glTF of version 3.0; version 2 is required"),
        (json!("1.0"), "glTF of version 1.0"),
        (json!("20"), "glTF of version 20"),
    ] {
        document["asset"]["version"] = version;
        assert!(cause(&document).contains(message), "{}", cause(&document));
    }
    document["asset"] = json!({"version": "2.0", "minVersion": "3.0"});
    assert!(cause(&document).contains("version 3.0"));
    document["asset"] = json!({"version": "2.9", "minVersion": "2.0"});
    assert_eq!(warnings(&document), [] as [&str; 0]);
    // Objects where version 2 has arrays.
    let old = br#"{"asset": {"version": "1.0"}, "nodes": {"a": {}}}"#;
    assert!(read(old).unwrap_err().cause.contains("version 1.0"));
}

#[test]
fn a_projective_matrix_is_rejected() {
    let mut document = document();
    let mut matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1].map(f64::from);
    document["nodes"][0]["matrix"] = json!(matrix);
    assert_eq!(warnings(&document), [] as [&str; 0]);
    for (place, value, row) in [
        (11, 0.125, "0 0 0.125 1"),
        (3, -1.0, "-1 0 0 1"),
        (15, 2.0, "0 0 0 2"),
        (15, 0.0, "0 0 0 0"),
    ] {
        let kept = std::mem::replace(&mut matrix[place], value);
        document["nodes"][0]["matrix"] = json!(matrix);
        let cause = cause(&document);
        let expected = format!("node 0 \"tile\": the matrix is projective (its last row is {row}");
        assert!(cause.contains(&expected), "{cause}");
        matrix[place] = kept;
    }
}

/// Nodes and meshes that no scene shows must be valid all the same.
#[test]
fn what_is_not_shown_is_checked() {
    let mut document = document();
    document["scenes"] = json!([{"nodes": []}]);
    document["nodes"] = json!([{"children": [1]}, {"children": [2]}, {"children": [0]}]);
    assert!(cause(&document).contains("node 0 is inside of itself"));
    document["nodes"] = json!([{"children": [2]}, {"children": [2]}, {}]);
    assert!(cause(&document).contains("node 2 is inside of two nodes"));
    document["nodes"] = json!([]);
    document["accessors"][0]["count"] = json!(3);
    assert!(cause(&document).contains("mesh 0, primitive 0 uses vertex 3"));
}

/// The header and the chunks of a binary file, each with a fault of its own.
#[test]
fn faults_of_the_container_are_named() {
    let whole = binary();
    let text = u32::from_le_bytes(*whole[12..].first_chunk().unwrap()) as usize;
    let second = 20 + text;
    let with = |at: usize, bytes: &[u8]| {
        let mut file = whole.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    let length = whole.len() as u32;
    let cut = |to: usize| {
        let mut file = whole[..to].to_vec();
        file[8..12].copy_from_slice(&(to as u32).to_le_bytes());
        file
    };
    let twice = {
        let mut file = [&whole[..], &whole[second..]].concat();
        let length = file.len() as u32;
        file[8..12].copy_from_slice(&length.to_le_bytes());
        file
    };
    for (file, expected) in [
        (
            b"glTF".to_vec(),
            "the file ends inside its header: it has 4 of 12 bytes",
        ),
        (
            with(0, b"glTG"),
            "begins with the bytes 67 6c 54 47, not with `glTF`",
        ),
        (
            with(4, &[3]),
            "binary glTF of version 3; version 2 is required",
        ),
        (with(8, &(length - 8).to_le_bytes()), "the header announces"),
        (with(8, &(length + 8).to_le_bytes()), "the header announces"),
        (
            with(12, &u32::MAX.to_le_bytes()),
            "chunk 0 (from 0) announces 4294967295 bytes",
        ),
        (
            with(second, &(61_u32).to_le_bytes()),
            "chunk 1 (from 0) announces 61 bytes, and 60 follow",
        ),
        (
            with(16, b"TEXT"),
            "the first chunk is of the type \"TEXT\"; it must be JSON",
        ),
        (
            cut(second + 5),
            "the file ends inside the header of chunk 1",
        ),
        (cut(12), "the file has no chunk"),
        (twice, "a second one of the type BIN"),
        (with(20, b"["), "the JSON is broken"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("thing.glb");
        std::fs::write(&path, file).unwrap();
        let error = load(&path).unwrap_err();
        assert!(error.cause.contains(expected), "{expected}: {error}");
        assert!(!error.remedy.is_empty());
    }
}

#[test]
fn buffers_outside_of_the_folder_are_rejected() {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("scene");
    std::fs::create_dir(&folder).unwrap();
    let secret = outer.path().join("secret.bin");
    std::fs::write(&secret, square()).unwrap();
    std::fs::write(folder.join("near.bin"), square()).unwrap();
    let path = folder.join("thing.gltf");
    let write = |uri: &str| {
        let mut document = document();
        document["buffers"][0]["uri"] = json!(uri);
        std::fs::write(&path, document.to_string()).unwrap();
    };
    let absolute = secret.display().to_string();
    for uri in [
        "../secret.bin",
        "%2e%2e/secret.bin",
        "%2E%2E%2Fsecret.bin",
        "./x/../../secret.bin",
        "..%5Csecret.bin",
        &absolute,
        &format!("file://{absolute}"),
        &format!("file://localhost{absolute}"),
        "/etc/passwd",
        "C:\\secret.bin",
    ] {
        write(uri);
        let error = load(&path).unwrap_err();
        assert!(
            error.cause.contains("outside of the scene's folder"),
            "{uri}: {error}"
        );
        assert!(error.remedy.contains("--allow-outside"), "{uri}");
    }
    for uri in [
        "../secret.bin",
        "%2e%2e/secret.bin",
        &absolute,
        &format!("file://{absolute}"),
    ] {
        write(uri);
        let imported = load_allowing_outside(&path);
        assert_eq!(imported.unwrap().scene.objects.len(), 1, "{uri}");
    }
    for uri in ["near.bin", "./near.bin", "%6eear.bin"] {
        write(uri);
        assert_eq!(load(&path).unwrap().scene.objects.len(), 1, "{uri}");
    }
}

/// A mesh of many small parts that many nodes share.
#[test]
fn nodes_that_multiply_beyond_all_memory_are_rejected_with_the_figure() {
    let mut document = document();
    let part = document["meshes"][0]["primitives"][0].clone();
    document["meshes"][0]["primitives"] = json!(vec![part; 4000]);
    let name = "n".repeat(1000);
    let count = 3000;
    document["nodes"] = json!(vec![json!({"mesh": 0, "name": name}); count]);
    document["scenes"][0]["nodes"] = json!((0..count).collect::<Vec<_>>());
    let cause = cause(&document);
    assert!(cause.contains("GB of memory, for"), "{cause}");
    assert!(cause.contains("the limit is 3.8 GB"), "{cause}");
}

/// Many accessors of the same bytes, which nothing uses.
#[test]
fn accessors_that_multiply_are_rejected() {
    let mut document = document();
    let accessors = document["accessors"].as_array_mut().unwrap();
    let many =
        json!({"bufferView": 0, "componentType": 5126, "count": 16_000_000, "type": "SCALAR"});
    accessors.extend(vec![many; 20]);
    assert!(
        cause(&document).contains("the accessors of the file have more than 268435456 elements")
    );
}
