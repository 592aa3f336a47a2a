use super::*;
use crate::scene::{Camera, Diffuse, Light, Material, test_scenes, test_scenes::mesh};
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
        (
            |d| d["meshes"][0]["primitives"][0]["mode"] = json!(0),
            "has no triangles",
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

#[test]
fn bad_files_of_other_projects() {
    let Some(folder) = test_scenes::find("bad") else {
        return;
    };
    let folders = [folder.clone(), folder.join("gltf-validator")];
    let mut refused = 0;
    for entry in folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
    {
        let path = entry.unwrap().path();
        if !path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            continue;
        }
        let error = load(&path).expect_err(&path.display().to_string());
        assert!(!error.cause.is_empty() && !error.remedy.is_empty());
        println!("{error}");
        refused += 1;
    }
    assert!(refused >= 10, "{refused}");
}
