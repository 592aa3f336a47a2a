use super::*;
use crate::scene::tests::samples::{self, load, load_allowing_outside, mesh};
use crate::scene::{Diffuse, Imported, Wrap};
use crate::srgb::linear_of_srgb;
use std::path::Path;

fn read(text: &str) -> Result<Imported, SceneError> {
    samples::read("t.obj", text)
}

fn fault(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn parts_follow_the_file() {
    let text = format!(
        "{CORNERS}f 1 2 3\no first # 1\nf 1 2 3 # a comment\nusemtl a\nf 1 3 4\nusemtl a\nf 2 3 4\nusemtl b\n\
         f -4/1/1 -3//2 -1/7\ng second one\nf 1 2 \\\n3 4\n"
    );
    let Imported {
        scene, warnings, ..
    } = read(&text).unwrap();
    let parts: Vec<_> = scene
        .objects
        .iter()
        .map(|o| (o.name.as_str(), o.material, o.place.line, mesh(o).1.len()))
        .collect();
    assert_eq!(
        parts,
        [
            ("mesh 1", 0, 5, 1),
            ("first # 1", 0, 7, 1),
            ("first # 1", 1, 9, 2),
            ("first # 1", 2, 13, 1),
            ("second one", 2, 15, 2)
        ]
    );
    let (vertices, triangles) = mesh(&scene.objects[3]);
    assert_eq!(vertices, [DVec3::ZERO, DVec3::X, DVec3::Y]);
    assert_eq!(triangles, [[0, 1, 2]]);
    assert_eq!(
        warnings,
        [
            "t.obj:9: the material \"a\" is defined nowhere; the default is used",
            "t.obj:13: the material \"b\" is defined nowhere; the default is used"
        ]
    );
}

#[test]
fn comments_that_end_in_a_backslash_do_not_continue() {
    for text in [
        format!("# made in C:\\models\\\n{CORNERS}f 1 2 3\n"),
        format!("{CORNERS}f 1 2 3 # C:\\models\\\nf 1 3 4\n"),
        format!("{CORNERS}f 1 2 \\\n3 # C:\\\nf 1 3 4\n"),
    ] {
        let scene = read(&text).unwrap().scene;
        let (vertices, triangles) = mesh(&scene.objects[0]);
        assert_eq!(vertices[1], DVec3::X, "{text}");
        assert_eq!(triangles.len(), text.matches("f ").count(), "{text}");
    }
}

#[test]
fn names_continue_on_the_next_line() {
    let text = format!("{CORNERS}g a \\\n  b \\\nc\nusemtl \\\nred wood\nf 1 2 3\n");
    let Imported {
        scene, warnings, ..
    } = read(&text).unwrap();
    assert_eq!(scene.objects[0].name, "a b c");
    assert_eq!(scene.objects[0].place.line, 10);
    assert_eq!(
        warnings,
        ["t.obj:10: the material \"red wood\" is defined nowhere; the default is used"]
    );
    // Each continued statement gets its own line, those of numbers in between.
    let text = format!("{CORNERS}vn 0 \\\n0 1\no a\\\n\nf 1 \\\n2 3\n\\\no b \\\nc\nf 1 3 4\n");
    let scene = read(&text).unwrap().scene;
    let names: Vec<_> = scene.objects.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["a", "b c"]);
}

#[test]
fn names_of_material_files_continue_and_end_at_a_comment() {
    let folder = tempfile::tempdir().unwrap();
    for (name, material) in [("a", "newmtl a\nKd 1 0 0\n"), ("b", "newmtl b\nKd 0 1 0\n")] {
        std::fs::write(folder.path().join(format!("{name}.mtl")), material).unwrap();
    }
    let path = folder.path().join("t.obj");
    for libraries in ["a.mtl \\\nb.mtl", "a.mtl b.mtl # c.mtl"] {
        let text = format!("mtllib {libraries}\n{CORNERS}usemtl b\nf 1 2 3\n");
        std::fs::write(&path, text).unwrap();
        let imported = load(&path).unwrap();
        assert_eq!(imported.warnings, [] as [&str; 0], "{libraries}");
        let diffuse = imported.scene.materials[0].diffuse;
        assert_eq!(diffuse, Diffuse::Plain([0.0, 1.0, 0.0]), "{libraries}");
    }
}

#[test]
fn comments_may_follow_numbers_and_names_of_materials() {
    let text = format!(
        "{CORNERS}v 0 0 5#x\nv 0 0 5 #a.#b\nvn 0 0 1#\nvt 0 0 # y\nf 1/1/1 2/1/1 3/1/1#c 4\n"
    );
    let imported = read(&text).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    assert_eq!(mesh(&imported.scene.objects[0]).1.len(), 1);
    let folder = tempfile::tempdir().unwrap();
    let materials = "newmtl b\nKd 0 1 0\nnewmtl b # 2\nKd 1 0 0\n";
    std::fs::write(folder.path().join("a.mtl"), materials).unwrap();
    let path = folder.path().join("t.obj");
    let text = format!(
        "mtllib a.mtl\n{CORNERS}usemtl b # 2\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl b # green\nf 1 2 3\nusemtl c #\nf 1 2 3\n"
    );
    std::fs::write(&path, text).unwrap();
    let Imported {
        scene, warnings, ..
    } = load(&path).unwrap();
    let materials: Vec<_> = scene.objects.iter().map(|it| it.material).collect();
    assert_eq!(materials, [0, 1, 1, 2]);
    let names = scene.materials[..2].iter().map(|it| it.name.as_str());
    assert!(names.eq(["b # 2", "b"]));
    let [warning] = &warnings[..] else {
        panic!("{warnings:?}");
    };
    assert!(warning.contains("\"c #\" is defined nowhere"), "{warning}");
}

#[test]
fn lines_of_material_files_continue() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.obj");
    let text = format!("mtllib a.mtl\n{CORNERS}usemtl b c\nf 1 2 3\n");
    std::fs::write(&path, text).unwrap();
    let read = |materials: &str| {
        std::fs::write(folder.path().join("a.mtl"), materials).unwrap();
        load(&path)
    };
    let imported = read("# C:\\\nnewmtl b \\\n c\r\nKd 0 \\\r\n1 \\\n0\nillum 11\n").unwrap();
    let diffuse = imported.scene.materials[0].diffuse;
    assert_eq!(diffuse, Diffuse::Plain([0.0, 1.0, 0.0]));
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings);
    };
    assert!(warning.contains("a.mtl:7: illum 11"), "{warning}");
    let error = read("newmtl b c\nKd 0 \\\n1 x\nNs 1\n").unwrap_err();
    let expected = "a.mtl:2: a number of Kd is \"x\", which is not a number";
    assert!(error.to_string().ends_with(expected), "{error}");
}

#[test]
fn faces_may_come_before_their_vertices() {
    let scene = read(&format!("f 1 2 3\no later\n{CORNERS}")).unwrap().scene;
    assert_eq!(mesh(&scene.objects[0]).0.len(), 3);
}

#[test]
fn weights_colors_and_lines_are_no_geometry() {
    let text = "v 1 2 3 .5\nv 0 1 0 1 0 0\nv 0 0 1\nl 1 2 3\np 1\nf 1 2 3\n";
    let Imported {
        scene, warnings, ..
    } = read(text).unwrap();
    assert_eq!(mesh(&scene.objects[0]).0[0], DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(mesh(&scene.objects[0]).1.len(), 1);
    assert_eq!(
        warnings,
        [
            "t.obj:2: vertices before the first with a color are white",
            "t.obj:3: a vertex without a color, behind others with one, is white",
            "t.obj:4: points and lines have no surface and are skipped (and once more)"
        ]
    );
}

#[test]
fn faults_name_line_and_cause() {
    assert_eq!(fault(""), "t.obj: the file has no faces");
    assert_eq!(fault(CORNERS), "t.obj: the file has no faces");
    assert_eq!(
        fault(&format!("{CORNERS}f 1 2\n")),
        "t.obj:5: the file has no faces: a face of 2 vertices has no surface and is skipped"
    );
    assert_eq!(
        fault(&format!(
            "{CORNERS}\nl 1 2\np 1\nl 2 3\nf 1\ncurv 0 1 1 2\n"
        )),
        "t.obj:6: the file has no faces: points and lines have no surface and are skipped (and 2 times more); \
         line 9: a face of 1 vertices has no surface and is skipped; \
         line 10: the statement \"curv\" is unknown or about curves, and ignored"
    );
    assert_eq!(
        fault(&format!("{CORNERS}f 1/1/1/1 2 3\n")),
        "t.obj:5: a face has the vertex \"1/1/1/1\", which has more than three indices"
    );
    assert_eq!(fault("v 1 2\n"), "t.obj:1: a vertex has 2 of 3 coordinates");
    assert_eq!(
        fault("\nv 1 nan 2\n"),
        "t.obj:2: the y coordinate of a vertex is \"nan\", which is not a finite number"
    );
    assert_eq!(
        fault("v 1 2 1e999\n"),
        "t.obj:1: the z coordinate of a vertex is \"1e999\", which is not a finite number"
    );
    assert_eq!(
        fault("v 1.#IND 0 0\n"),
        "t.obj:1: the x coordinate of a vertex is \"1.#IND\", which is not a number"
    );
    assert_eq!(
        fault("v 1 2 3 red\n"),
        "t.obj:1: what follows the coordinates of a vertex is \"red\", which is not a number"
    );
    assert_eq!(
        fault(&format!("{CORNERS}f 1 0 2\n")),
        "t.obj:5: a face has the vertex index 0"
    );
    assert_eq!(
        fault(&format!("{CORNERS}f 1 2 3\nf 1 2 5\n")),
        "t.obj:6: a face has the vertex index 5, but the file has 4 vertices"
    );
    assert_eq!(
        fault(&format!("{CORNERS}f 1 2 4294967297\n")),
        "t.obj:5: a face has the vertex index 4294967297, but the file has 4 vertices"
    );
    assert_eq!(
        fault(&format!("{CORNERS}f 1 2 -5\n")),
        "t.obj:5: a face has the vertex index -5, but only 4 vertices come before it"
    );
    assert_eq!(
        fault(&format!("{CORNERS}f 1 2 x/1\n")),
        "t.obj:5: a face has the vertex \"x/1\", which is not an index"
    );
    assert_eq!(
        fault(&format!("{CORNERS}f 1//x 2//x 3//x\n")),
        "t.obj:5: a face has the vertex \"1//x\", whose normal is not an index"
    );
    assert_eq!(
        fault(&format!("{CORNERS}f 1/1.5 2/1 3/1\n")),
        "t.obj:5: a face has the vertex \"1/1.5\", whose texture coordinate is not an index"
    );
}

#[test]
fn faces_without_surface_are_skipped_with_a_warning() {
    let Imported {
        scene, warnings, ..
    } = read(&format!("{CORNERS}f\nf 1\nf 1 2\nf 1 2 2\n")).unwrap();
    assert_eq!(mesh(&scene.objects[0]).1, [[0, 1, 1]]);
    assert_eq!(warnings.len(), 3);
    assert_eq!(
        warnings[2],
        "t.obj:7: a face of 2 vertices has no surface and is skipped"
    );
}

#[test]
fn concave_faces_keep_their_area() {
    let text = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 3 1 0\nf 1 2 3 4\n";
    let scene = read(text).unwrap().scene;
    assert_eq!(mesh(&scene.objects[0]).1, [[3, 0, 1], [1, 2, 3]]);
}

/// Bounding box and area as printed in the facts.
fn measure(scene: &Scene) -> (usize, [f64; 6], f64) {
    let (mut count, mut area) = (0, 0.0);
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for object in &scene.objects {
        let (vertices, triangles) = mesh(object);
        count += triangles.len();
        for t in triangles {
            let [a, b, c] = t.map(|i| vertices[i as usize]);
            low = low.min(a).min(b).min(c);
            high = high.max(a).max(b).max(c);
            area += (b - a).cross(c - a).length() / 2.0;
        }
    }
    let [a, b, c] = low.to_array();
    let [d, e, f] = high.to_array();
    (count, [a, b, c, d, e, f], area)
}

#[test]
fn real_meshes_have_the_triangles_box_and_area_that_trimesh_finds() {
    let Some(facts) = samples::find("reference/mesh_facts_by_trimesh.csv") else {
        return;
    };
    let text = std::fs::read_to_string(facts).unwrap();
    let mut compared = 0;
    for line in text
        .lines()
        .filter(|line| line.starts_with("dev/meshes/") && line.contains(".obj,"))
    {
        let fields: Vec<&str> = line.split(',').collect();
        let name = fields[0].trim_start_matches("dev/");
        let Some(path) = samples::find(name) else {
            continue;
        };
        let (count, bounds, area) = measure(&load(&path).unwrap().scene);
        assert_eq!(count, fields[7].parse::<usize>().unwrap(), "{name}");
        let expected: Vec<f64> = fields[8]
            .split(' ')
            .map(|word| word.parse().unwrap())
            .collect();
        for (found, expected) in bounds.into_iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 1e-5 * expected.abs().max(1e-9),
                "{name}: {found} for {expected}"
            );
        }
        let expected = match name {
            // A fan covers the hole of this ring many times over; this is the volume that it
            // encloses.
            "meshes/concave_polygon.obj" => "0.2454966872",
            // Its pentagon is bent, so that its area depends on where it is cut.
            "meshes/polygonfaces.obj" => "",
            _ => fields[9],
        };
        if let Ok(expected) = expected.parse::<f64>() {
            assert!(
                (area - expected).abs() <= 1e-6 * expected,
                "{name}: {area} for {expected}"
            );
        }
        compared += 1;
    }
    println!("{compared} meshes compared");
}

#[test]
fn known_meshes_keep_their_objects_triangles_and_normals() {
    for (name, objects, triangles, normals) in [
        // Faces wound the other way round take three of its 507 normals turned.
        ("suzanne.obj", 1, 968, 510),
        ("stanford-bunny.obj", 1, 69_451, 0),
        ("cornell_box.obj", 8, 36, 0),
    ] {
        let Some(path) = samples::find(&format!("meshes/{name}")) else {
            continue;
        };
        let Imported {
            scene, warnings, ..
        } = load(&path).unwrap();
        assert_eq!(measure(&scene).0, triangles, "{name}");
        assert_eq!(scene.objects.len(), objects, "{name}");
        assert_eq!(warnings, [] as [&str; 0], "{name}");
        let found = scene.objects.iter().map(|it| it.normals.vectors.len());
        assert_eq!(found.sum::<usize>(), normals, "{name}");
    }
}

#[test]
fn faces_are_smooth_where_all_corners_have_normals() {
    let text = format!(
        "{CORNERS}vn 0 0 2\nvn 1 0 1\nvn 0 1 1\nvn 9 9 9\nf 1//1 2//2 3/7/-2\nf 1//1 2 3//3\nf 1 3 4\n\
         f 1//2 2//1 3//5\nf 1//0 2//1 3//1\nf 1//1 2//1 3//1 4//1\n"
    );
    let Imported {
        scene, warnings, ..
    } = read(&text).unwrap();
    let normals = &scene.objects[0].normals;
    let flat = Normals::FLAT;
    // The file's face of its own normals is flat, too.
    assert_eq!(
        normals.triangles,
        [[0, 1, 2], flat, flat, flat, flat, flat, flat]
    );
    assert_eq!(normals.vectors[0], DVec3::Z);
    assert!((normals.vectors[1] - DVec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-15);
    assert_eq!(
        warnings,
        ["t.obj:12: a face has a normal that the file lacks, and is shaded flat (and once more)"]
    );
    assert_eq!(fault("vn 1 2\n"), "t.obj:1: a normal has 2 of 3 components");
    assert_eq!(
        fault("vn 1 2 x\n"),
        "t.obj:1: a component of a normal is \"x\", which is not a number"
    );
}

#[test]
fn ignored_smoothing_causes_one_warning() {
    let colored = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n";
    let text = format!("{colored}vn 0 0 1\nvn 0 0 1\ns off\ns 0\ns 1\nusemap off\nf 1 2 3\n");
    assert_eq!(
        read(&text).unwrap().warnings,
        ["t.obj:8: smoothing groups are ignored; for smooth normals use `--normals smooth=40`",]
    );
}

#[test]
fn usemap_is_warned_of_with_a_remedy() {
    let text = "usemap wood.png\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let expected = "t.obj:1: the texture of `usemap` is not drawn; name its image in the MTL file, by `map_Kd`";
    assert_eq!(read(text).unwrap().warnings, [expected]);
}

#[test]
fn material_files_outside_of_the_folder_are_rejected() {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("scene");
    std::fs::create_dir(&folder).unwrap();
    let secret = outer.path().join("secret.mtl");
    std::fs::write(&secret, "newmtl a\nKd 1 0 0\n").unwrap();
    let path = folder.join("t.obj");
    for name in [
        "../secret.mtl",
        "..\\secret.mtl",
        "/etc/passwd",
        "C:\\secret.mtl",
        &secret.display().to_string(),
    ] {
        std::fs::write(
            &path,
            format!("# 1\nmtllib {name}\n{CORNERS}usemtl a\nf 1 2 3\n"),
        )
        .unwrap();
        let error = load(&path).unwrap_err();
        assert_eq!(error.line, Some(2));
        assert!(
            error.cause.contains("outside of the scene's folder"),
            "{name}: {error}"
        );
        assert!(error.remedy.contains("--allow-outside"));
    }
    std::fs::write(
        &path,
        format!("mtllib ../secret.mtl\n{CORNERS}usemtl a\nf 1 2 3\n"),
    )
    .unwrap();
    let imported = load_allowing_outside(&path).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    assert_eq!(
        imported.scene.materials[0].diffuse,
        Diffuse::Plain([1.0, 0.0, 0.0])
    );
}

/// A long name is repeated for every part.
#[test]
fn parts_with_a_long_name_are_rejected_with_the_figure() {
    let mut text = format!("{CORNERS}o {}\n", "n".repeat(1_000_000));
    for _ in 0..1000 {
        text.push_str("usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
    }
    let error = read(&text).unwrap_err();
    assert!(
        error.cause.contains("takes about 3.8 GB of memory"),
        "{error}"
    );
    assert!(error.line.is_some());
}

#[test]
fn lists_that_no_face_uses_are_limited() {
    assert!(parser::fit([8_000_000, 50_000_000, 10_000_000]));
    for many in [[60_000_000, 0, 0], [0, 80_000_000, 0], [0, 0, 120_000_000]] {
        assert!(!parser::fit(many), "{many:?}");
    }
}

#[test]
fn colors_of_vertices_are_taken_from_srgb() {
    let text = "v 0 0 0 1 0 0.5\nv 1 0 0 0 2 0\nv 0 1 0 .5 -1 1 0 0 1\nv 9 9 9 1 1 1\nf 1 2 3\n";
    let imported = read(text).unwrap();
    let colors = &imported.scene.objects[0].attributes.colors;
    let half = linear_of_srgb(0.5);
    assert_eq!(
        *colors,
        [[1.0, 0.0, half], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    );
    let limited = "t.obj:2: a color of a vertex is limited to 0 to 1, its range";
    let many = "t.obj:3: of more than 3 numbers behind the coordinates of a vertex, the last 3 are taken as its color";
    assert_eq!(imported.warnings, [limited, many]);
    let two = read("v 0 0 0 1 1\nv 1 0 0 1\nv 0 1 0\nf 1 2 3\n").unwrap();
    let ignored =
        "t.obj:1: 2 numbers behind the coordinates of a vertex are ignored; a color has 3";
    assert_eq!(two.warnings, [ignored]);
}

mod materials;

#[test]
fn zero_normals_and_colors_out_of_range_are_warned_of() {
    let text = "v 0 0 0 255 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n\
                vn 0 0 0\nvn 0.5 0 1\nf 1//1 2//2 3//2\n";
    assert_eq!(
        read(text).unwrap().warnings,
        [
            "t.obj:1: a color of a vertex is limited to 0 to 1, its range",
            "t.obj:4: a normal is 0 0 0; faces that have it are shaded flat",
        ]
    );
}
