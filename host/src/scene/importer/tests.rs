use super::*;
use crate::scene::tests::samples::{self, gzipped};
use crate::scene::{IMPORTERS, extensions};
use crate::scene::{ImportOptions, SceneError};
use std::collections::BTreeSet;

fn read(name: &str, bytes: &[u8]) -> Result<Imported, SceneError> {
    samples::read(name, bytes)
}

#[test]
fn extensions_are_listed_once_each() {
    let all: Vec<_> = IMPORTERS.iter().flat_map(|it| it.extensions).collect();
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
    assert!(
        all.iter()
            .all(|it| it.bytes().all(|byte| byte.is_ascii_lowercase()))
    );
    let names: BTreeSet<_> = IMPORTERS.iter().map(|it| it.name).collect();
    assert_eq!(names.len(), IMPORTERS.len());
    let error = read("a.FBX", b"").unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.FBX: the extension \"fbx\" names no scene format"
    );
    for extension in all {
        assert!(
            error.remedy.contains(&format!(".{extension}")),
            "{}",
            error.remedy
        );
    }
}

#[test]
fn every_example_is_read_by_its_extensions_and_by_its_content() {
    for importer in IMPORTERS {
        let example = importer.example.as_bytes();
        let recognized: Vec<_> = IMPORTERS
            .iter()
            .filter(|it| (it.recognizes)(example))
            .collect();
        assert_eq!(recognized.len(), 1, "{}", importer.name);
        assert_eq!(recognized[0].name, importer.name);
        let by_content = read("<stdin>", example).unwrap();
        assert!(!by_content.scene.objects.is_empty(), "{}", importer.name);
        assert_eq!(by_content.warnings, [] as [&str; 0], "{}", importer.name);
        for extension in importer.extensions {
            let named = read(&format!("a.{}", extension.to_ascii_uppercase()), example).unwrap();
            assert_eq!(named.scene.objects.len(), by_content.scene.objects.len());
        }
    }
}

#[test]
fn every_format_may_be_gzipped_whatever_the_name_is() {
    for importer in IMPORTERS {
        let (plain, packed) = (
            importer.example.as_bytes(),
            gzipped(importer.example.as_bytes()),
        );
        let extension = importer.extensions[0];
        let mut scenes = [
            read(&format!("a.{extension}"), plain),
            read(&format!("a.{extension}"), &packed),
            read(&format!("a.{extension}.gz"), &packed),
            // Inflated by hand, and not renamed.
            read(&format!("a.{extension}.GZ"), plain),
            read("a.gz", &packed),
        ]
        .map(|it| it.unwrap().scene);
        for scene in &mut scenes {
            for object in &mut scene.objects {
                object.place = Default::default();
            }
            for material in &mut scene.materials {
                material.place = Default::default();
            }
            scene.places = Default::default();
        }
        let [plain, others @ ..] = &scenes;
        assert!(others.iter().all(|it| it == plain), "{}", importer.name);
    }
}

#[test]
fn real_files_are_recognized_by_their_content() {
    let mut seen = 0;
    for folder in ["meshes", "molecules", "spd"] {
        let Some(folder) = samples::find(folder) else {
            return;
        };
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            // Some files are megabytes, which take long to inflate and test nothing else.
            let small =
                std::fs::metadata(&path).is_ok_and(|it| it.is_file() && it.len() < 2_000_000);
            let Ok(Some(importer)) = Importers(IMPORTERS).of_name(&path) else {
                continue;
            };
            if small {
                let bytes = gzip::inflate(&path, std::fs::read(&path).unwrap()).unwrap();
                let found = Importers(IMPORTERS).of_content(&path, &bytes).unwrap();
                assert_eq!(found.name, importer.name, "{}", path.display());
                seen += 1;
            }
        }
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn content_of_no_format_is_rejected_with_all_formats() {
    for bytes in [
        &b""[..],
        b"\0",
        b"hello\n",
        b"<svg/>",
        b"\xff\xff\n",
        b"# only a comment\n",
    ] {
        let error = read("<stdin>", bytes).unwrap_err();
        assert_eq!(
            error.to_string(),
            "<stdin>: the content is of no scene format, and the name has no extension"
        );
        assert!(error.remedy.contains(&extensions()));
    }
    let wide: Vec<u8> = "solid a\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let error = read("<stdin>", &wide).unwrap_err();
    assert!(error.cause.contains("UTF-16LE"), "{error}");
}

#[test]
fn stem_and_extension_leave_out_folder_and_gz() {
    for (name, expected) in [
        ("a/bunny.ply", "bunny"),
        ("bunny.ply.gz", "bunny"),
        ("bunny.v2.ply.GZ", "bunny.v2"),
        ("bunny.gz", "bunny"),
        ("bunny", "bunny"),
        (".ply", ".ply"),
        ("", ""),
    ] {
        assert_eq!(stem(Path::new(name)), expected);
    }
    for (name, expected) in [
        ("a/bunny.PLY", Some("ply")),
        ("bunny.ply.gz", Some("ply")),
        ("bunny.gz", None),
        ("a.b/bunny", None),
        ("<stdin>", None),
    ] {
        assert_eq!(extension(Path::new(name)).as_deref(), expected);
    }
}

#[test]
fn files_that_a_named_stream_refers_to_lie_in_the_current_folder() {
    let scene = "object = [{ kind = \"import\", file = \"../other.obj\" }]\n";
    let error = read("<stdin>", scene.as_bytes()).unwrap_err();
    assert!(
        error.cause.contains("lies outside of the scene's folder"),
        "{error}"
    );
    let options = ImportOptions {
        allow_outside: true,
        ..ImportOptions::default()
    };
    let error = crate::scene::read(Path::new("<stdin>"), scene.into(), &options).unwrap_err();
    assert!(
        error.cause.contains("../other.obj cannot be read"),
        "{error}"
    );
}

/// The page chooses the scene among several files by itself.
#[test]
fn the_page_lists_all_extensions() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("web/page/files.js");
    let page = std::fs::read_to_string(page).unwrap();
    for extension in IMPORTERS.iter().flat_map(|it| it.extensions) {
        assert!(page.contains(&format!("{extension:?}")), "{extension}");
    }
}
