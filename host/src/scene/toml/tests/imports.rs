//! Scenes made of several files.

use super::{load_in, material_of, named};
use crate::scene::{Diffuse, IMPORTERS, Light, LightShape, Shape};
use crate::shape::Sphere;
use glam::DVec3;
use std::path::Path;
use tempfile::TempDir;

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

const BALL: &str = r#"
background = "blue"
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
[render]
width = 64
[[light]]
kind = "directional"
direction = [0, 0, -1]
[material.paint]
diffuse = 0.5
[[object]]
name = "ball"
kind = "sphere"
center = [1, 0, 0]
radius = 1
material = "paint"
"#;

fn ball() -> String {
    BALL.replace("\"blue\"", "[0, 0, 1]")
}

fn importing(keys: &str) -> String {
    format!("[[object]]\nkind = \"import\"\nfile = \"parts/ball.toml\"\n{keys}\n")
}

#[test]
fn an_import_brings_objects_and_lends_the_view() {
    let folder = folder(&[("parts/ball.toml", &ball())]);
    let scene = load_in(
        folder.path(),
        &importing("translate = [0, 2, 0]\nscale = 2"),
    )
    .unwrap()
    .scene;
    let shape = Shape::Sphere(Sphere {
        center: DVec3::new(2.0, 2.0, 0.0),
        radius: 2.0,
    });
    let object = named(&scene, "ball/ball");
    assert_eq!(object.shape, shape);
    assert!(object.place.file.ends_with("parts/ball.toml") && object.place.line == 13);
    assert_eq!(scene.camera.unwrap().eye, DVec3::new(0.0, 2.0, 10.0));
    assert_eq!(scene.render.width, 64);
    assert_eq!(scene.background, Some([0.0, 0.0, 1.0]));
    assert_eq!(
        scene.lights,
        [Light::Directional {
            direction: DVec3::new(0.0, 0.0, -2.0),
            color: [1.0; 3]
        }]
    );
}

#[test]
fn an_import_brings_its_lens_and_lights_as_large_as_it_is() {
    let text = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\naperture = 0.5\nfocus = 2\n\
                [[light]]\nkind = 'point'\nposition = [0, 3, 0]\nfalloff = 'square'\nrange = 5\ncolor = 2\n\
                [[light]]\nkind = 'rectangle'\ncorner = [0, 3, 0]\nedges = [[1, 0, 0], [0, 0, 1]]\nradiance = 5\n\
                [[light]]\nkind = 'disc'\ncenter = [0, 3, 0]\nnormal = [0, -1, 0]\nradius = 1\nradiance = 5\n\
                [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
    let folder = folder(&[("parts/ball.toml", text)]);
    let imported = |keys: &str| load_in(folder.path(), &importing(keys)).unwrap().scene;
    let lens = imported("scale = 3").lens.unwrap();
    assert_eq!((lens.radius, lens.focus), (0.75, Some(6.0)));
    let scene = imported("scale = 3");
    let color = |light: &Light| match *light {
        Light::Point { color, .. } | Light::Directional { color, .. } => color[0],
    };
    let colors: Vec<f64> = scene.lights.iter().map(color).collect();
    assert_eq!(colors, [2.0 * 9.0, 5.0, 5.0]);
    assert_eq!(scene.light_forms[0].unwrap().range, Some(15.0));
    // Mirrored, they shine down as before.
    for keys in ["scale = [-1, 1, 1]", "scale = [2, 2, -2]"] {
        let scene = imported(keys);
        let LightShape::Rectangle { edges } = scene.light_forms[1].unwrap().shape else {
            panic!("no rectangle")
        };
        assert!(edges[0].cross(edges[1]).y < 0.0, "{keys}");
        let LightShape::Disc { normal, .. } = scene.light_forms[2].unwrap().shape else {
            panic!("no disc")
        };
        assert_eq!(normal.normalize(), DVec3::NEG_Y, "{keys}");
    }
}

#[test]
fn settings_of_the_importing_scene_come_first() {
    let folder = folder(&[("parts/ball.toml", &ball())]);
    let own = "background = 0\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n[[light]]\nkind = \"point\"\nposition = [0, 9, 0]\n";
    let scene = load_in(folder.path(), &format!("{own}{}", importing("")))
        .unwrap()
        .scene;
    assert_eq!(scene.camera.unwrap().eye, DVec3::new(0.0, 0.0, 9.0));
    assert_eq!(scene.render.width, 320);
    assert_eq!(scene.background, Some([0.0; 3]));
    assert!(matches!(scene.lights[..], [Light::Point { .. }]));
}

#[test]
fn an_environment_and_a_background_of_two_files_do_not_meet() {
    let sky = "[environment]\nzenith = 1\nhorizon = 1\nground = 0\n";
    let folder = folder(&[("ball.toml", &ball()), ("sky.toml", sky)]);
    let importing = |own: &str, files: &[&str]| {
        let import = |file: &&str| format!("[[object]]\nkind = \"import\"\nfile = \"{file}\"\n");
        let imports: String = files.iter().map(import).collect();
        let scene = load_in(folder.path(), &format!("{own}{imports}"))
            .unwrap()
            .scene;
        (scene.background, scene.environment.is_some())
    };
    assert_eq!(importing(sky, &["ball.toml"]), (None, true));
    let own = importing("background = 0\n", &["sky.toml"]);
    assert_eq!(own, (Some([0.0; 3]), false));
    for files in [["ball.toml", "sky.toml"], ["sky.toml", "ball.toml"]] {
        assert_eq!(importing("", &files), (None, true), "{files:?}");
    }
}

#[test]
fn an_import_inside_a_group_lends_no_view() {
    let folder = folder(&[("parts/ball.toml", &ball())]);
    let text = "[[object]]\nkind = \"group\"\nobject = [{ kind = \"import\", file = \"parts/ball.toml\" }]\n";
    let scene = load_in(folder.path(), text).unwrap().scene;
    assert_eq!(scene.objects[0].name, "group 1/ball/ball");
    assert!(scene.camera.is_none() && scene.lights.is_empty());
}

#[test]
fn materials_that_clash_are_named_after_their_import() {
    let folder = folder(&[("parts/ball.toml", &ball())]);
    let own = "[material.paint]\ndiffuse = 0.1\n";
    let text = format!(
        "{own}{}{}{}",
        importing("name = \"a\""),
        importing("name = \"a\""),
        importing("name = \"b\"\nmaterial = \"paint\"")
    );
    let scene = load_in(folder.path(), &text).unwrap().scene;
    let names: Vec<_> = scene
        .materials
        .iter()
        .map(|material| material.name.as_str())
        .collect();
    assert_eq!(names, ["paint", "a/paint"]);
    assert_eq!(material_of(&scene, "a/ball"), "a/paint");
    assert_eq!(material_of(&scene, "b/ball"), "paint");
}

#[test]
fn materials_of_an_import_can_be_used_by_name() {
    let folder = folder(&[(
        "parts/ball.toml",
        "[material.gold]\ndiffuse = [0.9, 0.7, 0.1]\n",
    )]);
    let sphere = "[[object]]\nname = \"s\"\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"gold\"\n";
    let scene = load_in(folder.path(), &format!("{sphere}{}", importing("")))
        .unwrap()
        .scene;
    assert_eq!(material_of(&scene, "s"), "gold");
}

#[test]
fn a_group_around_an_import_does_not_repaint_it() {
    let folder = folder(&[("parts/ball.toml", &ball())]);
    let text = "[material.other]\n[[object]]\nname = \"g\"\nkind = \"group\"\nmaterial = \"other\"\nobject = [{ kind = \"import\", file = \"parts/ball.toml\" }]\n";
    let scene = load_in(folder.path(), text).unwrap().scene;
    assert_eq!(material_of(&scene, "g/ball/ball"), "paint");
}

#[test]
fn a_missing_import_names_both_places() {
    let folder = folder(&[]);
    let error = load_in(folder.path(), &importing("")).unwrap_err();
    assert_eq!(
        (error.file.as_path(), error.line),
        (folder.path().join("scene.toml").as_path(), Some(3))
    );
    let missing = Path::new("parts").join("ball.toml");
    assert!(
        error.cause.contains(&missing.display().to_string()),
        "{error}"
    );
    assert!(error.remedy.contains("relative to the folder"));
}

#[test]
fn an_error_inside_an_import_names_both_places() {
    let folder = folder(&[("parts/ball.toml", "[material.a]\n\nior = 9\n")]);
    let error = load_in(folder.path(), &importing("")).unwrap_err();
    assert!(error.file.ends_with("parts/ball.toml") && error.line == Some(3));
    assert!(
        error.cause.contains("`ior` is 9") && error.cause.ends_with("scene.toml:3)"),
        "{error}"
    );
}

#[test]
fn circles_of_imports_are_rejected() {
    let back = "[[object]]\nkind = \"import\"\nfile = \"../scene.toml\"\n";
    let around = folder(&[("parts/ball.toml", back)]);
    let error = load_in(around.path(), &importing("")).unwrap_err();
    assert!(
        error
            .cause
            .contains("scene.toml -> ball.toml -> scene.toml"),
        "{error}"
    );
    assert!(error.file.ends_with("parts/ball.toml") && error.line == Some(3));
    let itself = "[[object]]\nkind = \"import\"\nfile = \"./scene.toml\"\n";
    let error = load_in(folder(&[]).path(), itself).unwrap_err();
    assert!(error.cause.contains("scene.toml -> scene.toml"), "{error}");
}

#[test]
fn long_chains_of_imports_are_rejected() {
    let chain: Vec<_> = (0..40)
        .map(|index| {
            let text = format!(
                "[[object]]\nkind = \"import\"\nfile = \"{}.toml\"\n",
                index + 1
            );
            (format!("{index}.toml"), text)
        })
        .collect();
    let files: Vec<_> = chain
        .iter()
        .map(|(name, text)| (name.as_str(), text.as_str()))
        .collect();
    let folder = folder(&files);
    let error = load_in(
        folder.path(),
        "[[object]]\nkind = \"import\"\nfile = \"0.toml\"\n",
    )
    .unwrap_err();
    assert!(error.cause.contains("deeper than 16 files"), "{error}");
}

/// Every file imports the next one four times: 4^14 readings, if files were read again each time.
#[test]
fn files_are_read_once() {
    let mut files: Vec<_> = (0..14)
        .map(|index| {
            let object = format!(
                "[[object]]\nkind = \"import\"\nfile = \"{}.toml\"\n",
                index + 1
            );
            (format!("{index}.toml"), object.repeat(4))
        })
        .collect();
    files.push((String::from("14.toml"), String::from("[material.a]\n")));
    let files: Vec<_> = files
        .iter()
        .map(|(name, text)| (name.as_str(), text.as_str()))
        .collect();
    let folder = folder(&files);
    let scene = load_in(
        folder.path(),
        "[[object]]\nkind = \"import\"\nfile = \"0.toml\"\n",
    )
    .unwrap()
    .scene;
    assert_eq!((scene.objects.len(), scene.materials.len()), (0, 1));
}

#[test]
fn other_formats_are_imported_by_their_extension() {
    let folder = folder(&[("a.fbx", "")]);
    let error = load_in(
        folder.path(),
        "[[object]]\nkind = \"import\"\nfile = \"a.fbx\"\n",
    )
    .unwrap_err();
    assert!(
        error.cause.contains("names no scene format") && error.cause.contains("scene.toml:3"),
        "{error}"
    );
}

#[test]
fn imports_outside_of_the_scenes_folder_are_rejected() {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("scene");
    std::fs::create_dir_all(folder.join("sub")).unwrap();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for place in ["secret.obj", "scene/near.obj"] {
        std::fs::write(outer.path().join(place), mesh).unwrap();
    }
    let import = |file: &str| format!("[[object]]\nkind = \"import\"\nfile = '{file}'\n");
    let absolute = outer.path().join("secret.obj").display().to_string();
    let path = folder.join("scene.toml");
    for name in [
        "../secret.obj",
        "sub/../../secret.obj",
        "..\\secret.obj",
        "/etc/passwd",
        &absolute,
    ] {
        std::fs::write(&path, import(name)).unwrap();
        let error = crate::scene::load(&path, &Default::default()).unwrap_err();
        assert_eq!(error.line, Some(3));
        assert!(
            error.cause.contains("outside of the scene's folder"),
            "{name}: {error}"
        );
        assert!(error.remedy.contains("--allow-outside"));
    }
    // A nested file may name what lies in the folder of the outermost one, and no more.
    std::fs::write(&path, import("sub/nested.toml")).unwrap();
    std::fs::write(folder.join("sub/nested.toml"), import("../near.obj")).unwrap();
    assert!(crate::scene::load(&path, &Default::default()).is_ok());
    std::fs::write(folder.join("sub/nested.toml"), import("../../secret.obj")).unwrap();
    let error = crate::scene::load(&path, &Default::default()).unwrap_err();
    assert!(
        error.cause.contains("outside of the scene's folder"),
        "{error}"
    );
    let allowed = crate::scene::ImportOptions {
        allow_outside: true,
        ..Default::default()
    };
    let scene = crate::scene::load_with(&path, &allowed).unwrap().scene;
    assert_eq!(scene.objects.len(), 1);
}

/// The examples of all formats, as `a.EXTENSION` in a folder.
fn examples() -> TempDir {
    let files = IMPORTERS.iter();
    let files = files.map(|it| (format!("a.{}", it.extensions[0]), it.example));
    let files: Vec<_> = files.collect();
    let files: Vec<_> = files.iter().map(|(name, it)| (&**name, *it)).collect();
    folder(&files)
}

const KEYS_OF_MOLECULES: [&str; 3] = ["style = \"ball-and-stick\"", "model = 1", "altloc = \"A\""];

#[test]
fn keys_for_molecules_are_rejected_for_formats_without_them() {
    let folder = examples();
    for importer in IMPORTERS {
        let name = format!("a.{}", importer.extensions[0]);
        let import = |key: &str| {
            let text = format!("[[object]]\nkind = \"import\"\nfile = \"{name}\"\n{key}\n");
            load_in(folder.path(), &text)
        };
        let holds_molecules = import("").unwrap().kinds.molecules;
        // The names that errors list.
        let listed = ["PDB", "mmCIF", "XYZ"].contains(&importer.name);
        assert_eq!(holds_molecules, listed, "{name}");
        for line in KEYS_OF_MOLECULES {
            let key = line.split(' ').next().unwrap();
            let error = import(line).err();
            if holds_molecules {
                // The examples have no alternate locations.
                let cause = error.map_or(String::new(), |it| it.cause);
                assert!(!cause.contains("is for"), "{name}: {cause}");
                assert_eq!(cause.is_empty(), key != "altloc", "{name}: {cause}");
                continue;
            }
            let error = error.unwrap();
            let found = error.to_string();
            let expected = format!(
                "scene.toml:4: `{key}` is for molecules (PDB, mmCIF and XYZ files), and {name} is none of these"
            );
            assert!(found.ends_with(&expected), "{found}");
            assert_eq!(error.remedy, "leave the key out");
        }
        // The examples state no assembly.
        let error = import("assembly = \"1\"").unwrap_err();
        let expected = match holds_molecules {
            true => String::from("there is no assembly \"1\": the file states none"),
            false => format!("`assembly` is for PDB and mmCIF files, and {name} is none of these"),
        };
        assert!(error.cause.contains(&expected), "{error}");
    }
}

#[test]
fn keys_for_molecules_reach_the_imports_of_an_import() {
    let folder = examples();
    let import = |file: &str| format!("[[object]]\nkind = \"import\"\nfile = \"{file}\"\n");
    let both = import("a.pdb") + &import("a.obj");
    std::fs::write(folder.path().join("both.toml"), both).unwrap();
    std::fs::write(folder.path().join("mesh.toml"), import("a.obj")).unwrap();
    std::fs::write(folder.path().join("outer.toml"), import("both.toml")).unwrap();
    let count = |text: &str| load_in(folder.path(), text).unwrap().scene.objects.len();
    for key in &KEYS_OF_MOLECULES[..2] {
        for file in ["both.toml", "outer.toml"] {
            // Also of a file that was read before, and after others.
            let text = import(file) + key + "\n" + &import("mesh.toml") + &import(file) + key;
            assert!(count(&text) > 2, "{key}");
        }
        let text = import("both.toml") + &import("mesh.toml") + key;
        let error = load_in(folder.path(), &text).unwrap_err();
        assert!(
            error.cause.ends_with("mesh.toml is none of these"),
            "{error}"
        );
        assert_eq!(error.line, Some(7));
    }
    let wanted = import("both.toml") + "assembly = \"7\"";
    let error = load_in(folder.path(), &wanted).unwrap_err();
    assert!(error.file.ends_with("a.pdb"), "{error}");
    assert!(
        error.cause.contains("there is no assembly \"7\""),
        "{error}"
    );
}

/// An ellipse is no light; a disc may be scaled across its plane.
#[test]
fn round_lights_that_become_oval_are_rejected() {
    let scaled = |light: &str, scale: &str| {
        let floor = "[[object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 0, 1]\n";
        let inner = format!("[[light]]\n{light}\nradius = 1\nradiance = 1\n{floor}");
        let folder = folder(&[("inner.toml", &inner)]);
        let import =
            format!("[[object]]\nkind = \"import\"\nfile = \"inner.toml\"\nscale = {scale}\n");
        load_in(folder.path(), &import)
    };
    let disc = "kind = 'disc'\ncenter = [0, 3, 0]\nnormal = [0, -1, 0]";
    let sphere = "kind = 'sphere'\ncenter = [0, 3, 0]";
    for light in [disc, sphere] {
        let scene = scaled(light, "[2, 2, 2]").unwrap().scene;
        let form = scene.light_forms[0].unwrap();
        assert!(
            matches!(form.shape, LightShape::Disc { radius, .. } | LightShape::Sphere { radius } if (radius - 2.0).abs() < 1e-12),
            "{form:?}"
        );
        let error = scaled(light, "[4, 1, 1]").unwrap_err();
        assert!(error.cause.contains("becomes an ellipse"), "{error}");
    }
}

#[test]
fn a_material_called_default_of_an_import_stays_with_it() {
    let folder = folder(&[
        (
            "a.obj",
            "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl default\nf 1 2 3\n",
        ),
        ("a.mtl", "newmtl default\nKd 1 0 0\n"),
    ]);
    let import = "[[object]]\nkind = 'import'\nname = 'a'\nfile = 'a.obj'\n";
    let ball = "[[object]]\nkind = 'sphere'\nname = 'ball'\ncenter = [0, 0, 0]\nradius = 1\n";
    let own = "[material.default]\ndiffuse = [0, 0, 1]\n";
    for (text, ours) in [
        (format!("{import}{ball}"), [0.8; 3]),
        (format!("{ball}{import}"), [0.8; 3]),
        (format!("{own}{ball}{import}"), [0.0, 0.0, 1.0]),
        (format!("{own}{import}{ball}"), [0.0, 0.0, 1.0]),
    ] {
        let scene = load_in(folder.path(), &text).unwrap().scene;
        let ball = &scene.materials[named(&scene, "ball").material];
        assert_eq!(ball.diffuse, Diffuse::Plain(ours));
        let object = scene.objects.iter().find(|it| it.name != "ball").unwrap();
        let theirs = &scene.materials[object.material];
        assert_eq!(theirs.diffuse, Diffuse::Plain([1.0, 0.0, 0.0]), "{text}");
        assert_eq!(theirs.name, "a/default");
    }
}

#[test]
fn backslashes_separate_folders_on_every_system() {
    let folder = folder(&[("parts/ball.toml", &ball())]);
    let text = "[[object]]\nkind = 'import'\nfile = 'parts\\ball.toml'\n";
    let scene = load_in(folder.path(), text).unwrap().scene;
    named(&scene, "ball/ball");
}
