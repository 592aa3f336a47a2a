//! Files in memory, for scenes where there are none on a disk.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files in memory, by their paths relative to each other. A scene that is [read among them](super::read_among) may
/// name each of them, and no other file.
#[derive(Clone, Debug, Default)]
pub struct Files(BTreeMap<PathBuf, Arc<[u8]>>);

impl Files {
    /// No files.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file. One of the same path is replaced.
    pub fn insert(&mut self, path: impl AsRef<Path>, bytes: Vec<u8>) {
        self.0.insert(lexical(path.as_ref()), bytes.into());
    }

    /// Returns the path and the content of the file for a path. It is the file of that path, or else the only file of
    /// that name. Files that are given one by one have no folders.
    pub(super) fn find(&self, path: &Path) -> Option<(&Path, &[u8])> {
        let path = lexical(path);
        let exact = self.0.get_key_value(&path);
        let found = exact.or_else(|| {
            let name = path.file_name()?;
            let mut named = self.0.iter().filter(|(it, _)| it.file_name() == Some(name));
            named.next().filter(|_| named.next().is_none())
        });
        found.map(|(path, bytes)| (path.as_path(), &**bytes))
    }
}

/// The path without `.` and `..`.
pub(super) fn lexical(path: &Path) -> PathBuf {
    use std::path::Component;

    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ImportOptions, Shape, read_among};

    const LEAF: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\no leaf\nf 1 2 3\n";

    fn files(all: &[(&str, &str)]) -> Files {
        let mut files = Files::new();
        for (path, text) in all {
            files.insert(path, text.as_bytes().to_vec());
        }
        files
    }

    fn import(file: &str) -> String {
        format!("[[object]]\nkind = 'import'\nfile = '{file}'\n")
    }

    #[test]
    fn file_is_found_by_its_path_or_else_by_a_name_that_is_the_only_one() {
        let files = files(&[("a/leaf.obj", "1"), ("b/leaf.obj", "2"), ("c.obj", "3")]);
        let content = |path: &str| files.find(path.as_ref()).map(|(_, bytes)| bytes);
        assert_eq!(content("a/leaf.obj"), Some(&b"1"[..]));
        assert_eq!(content("./b/x/../leaf.obj"), Some(&b"2"[..]));
        assert_eq!(content("leaf.obj"), None);
        assert_eq!(content("meshes/c.obj"), Some(&b"3"[..]));
        assert_eq!(content("none.obj"), None);
    }

    #[test]
    fn scene_reads_imports_materials_and_buffers_from_memory() {
        let leaf = format!("mtllib leaf.mtl\nusemtl green\n{LEAF}");
        let gltf = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "leaf.bin", "byteLength": 36}]}"#;
        let scene = import("meshes/leaf.obj") + &import("sub/leaf.gltf");
        let mut files = files(&[
            ("scene.toml", &scene),
            ("leaf.obj", &leaf),
            ("leaf.mtl", "newmtl green\nKd 0 1 0\n"),
            ("sub/leaf.gltf", gltf),
        ]);
        let corners = [[0.0_f32; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        files.insert("sub/leaf.bin", bytemuck::cast_slice(&corners).to_vec());
        let imported =
            read_among("scene.toml".as_ref(), &files, &ImportOptions::default()).unwrap();
        assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
        let scene = imported.scene;
        assert_eq!(scene.objects.len(), 2);
        assert!(
            scene.objects.iter().all(
                |it| matches!(&it.shape, Shape::Mesh { triangles, .. } if triangles.len() == 1)
            )
        );
        assert!(scene.materials.iter().any(|it| it.name == "green"));
    }

    #[test]
    fn file_that_is_not_given_is_an_error_and_disks_are_not_read() {
        let outer = tempfile::tempdir().unwrap();
        let disk = outer.path().join("leaf.obj");
        std::fs::write(&disk, LEAF).unwrap();
        let files = files(&[("scene.toml", &import(disk.to_str().unwrap()))]);
        let options = ImportOptions {
            allow_outside: true,
            ..ImportOptions::default()
        };
        let error = read_among("scene.toml".as_ref(), &files, &options).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("is not among the files that were given"),
            "{error}"
        );
        let error = read_among("other.toml".as_ref(), &files, &options).unwrap_err();
        assert!(
            error
                .cause
                .contains("is not among the files that were given"),
            "{error}"
        );
    }

    #[test]
    fn files_that_import_each_other_are_an_error() {
        let files = files(&[
            ("a.toml", &import("b.toml")),
            ("b.toml", &import("./a.toml")),
        ]);
        let error = read_among("a.toml".as_ref(), &files, &ImportOptions::default()).unwrap_err();
        assert!(
            error.to_string().contains("a.toml -> b.toml -> a.toml"),
            "{error}"
        );
    }
}
