//! Tests importers with scene files that are cut off or overwritten. The result is always a
//! consistent scene or an error that says what to do, and it comes at once.

use super::samples;
use crate::scene::{IMPORTERS, Importer, MoleculeOptions, MoleculeStyle, Scene, Shape, load};
use std::path::Path;
use std::time::{Duration, Instant};

const OBJ: &str = "mtllib none.mtl\no a\nv 0 0 0\nv 4 0 0\nv 4 4 0 1\nv 3 1 0\nusemtl b\nf 1/1 2//2 3 -1\nf 1 2 \\\n3 # c\n";
const NFF: &str = "b 0 0 .5\nv\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 64 48\nl 1 2 3\n\
                   f 1 .5 0 .8 .25 20 .5 1.5\ns 1 2 3 4\nc\n0 0 0 2\n0 0 5 1\np 4\n0 0 0\n4 0 0\n4 4 0\n3 1 0\n\
                   pp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n";
const PDB: &str = "\
MODEL        1
ATOM      1  N  ACYS A   3      11.000   2.000   3.000  1.00  0.00           N
ATOM      2  CA BCYS A   3      12.400   2.000   3.000  0.50  0.00           C
HETATM    3 FE   HEM B  10A     -1.000  20.000-300.000  1.00  0.00          FE3+
CONECT    1    2    3
ENDMDL
";
const CIF: &str = "data_t\n_cell.a 'x y'\nloop_\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n\
                   _atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n1 C \"C1'\" 0 0 0\n2 O O 1.2 ? 0\n\
                   loop_\n_struct_conn.conn_type_id\n_struct_conn.ptnr1_label_atom_id\ncovale\n;O\n;\n";

/// A scene of something in which all indices lead somewhere and all numbers are finite.
fn holds_together(scene: &Scene) -> bool {
    scene.objects.iter().all(|object| {
        let shape = match &object.shape {
            Shape::Mesh {
                vertices,
                triangles,
            } => {
                vertices.iter().all(|vertex| vertex.is_finite())
                    && triangles
                        .iter()
                        .flatten()
                        .all(|&index| (index as usize) < vertices.len())
            }
            shape @ (Shape::Sphere(_) | Shape::Cone(_)) => shape.is_finite() && shape.has_extent(),
            _ => false,
        };
        shape && object.material < scene.materials.len()
    })
}

/// Loads a file of these bytes.
fn check(path: &Path, bytes: &[u8]) {
    std::fs::write(path, bytes).unwrap();
    for style in [MoleculeStyle::SpaceFilling, MoleculeStyle::BallAndStick] {
        let start = Instant::now();
        match load(
            path,
            &MoleculeOptions {
                style,
                ..MoleculeOptions::default()
            },
        ) {
            Ok(imported) => assert!(
                holds_together(&imported.scene)
                    && (!imported.scene.objects.is_empty() || !imported.warnings.is_empty()),
                "{:?}",
                String::from_utf8_lossy(bytes)
            ),
            Err(error) => {
                assert!(!error.cause.is_empty() && !error.remedy.is_empty() && error.file == path)
            }
        }
        assert!(
            start.elapsed() < Duration::from_secs(2),
            "{} takes long",
            path.display()
        );
    }
}

/// Cuts the bytes off at `cuts` lengths and overwrites some of them `flips` times.
fn damage(extension: &str, bytes: &[u8], cuts: usize, flips: usize) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("damaged.{extension}"));
    for end in (0..=bytes.len()).step_by(bytes.len().div_ceil(cuts).max(1)) {
        check(&path, &bytes[..end]);
    }
    // Marsaglia's xorshift, so that a failure comes again.
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    for _ in 0..flips {
        let mut bytes = bytes.to_vec();
        for _ in 0..=random(4) {
            let place = random(bytes.len());
            let likely = b"0123456789-.e#/;'\"_ \n";
            bytes[place] = if random(2) == 0 {
                random(256) as u8
            } else {
                likely[random(likely.len())]
            };
        }
        check(&path, &bytes);
    }
}

#[test]
fn damaged_files_load_whole_or_fail_with_a_remedy() {
    for (extension, text) in [
        ("obj", OBJ),
        ("nff", NFF),
        ("pdb", PDB),
        ("cif", CIF),
        ("stl", crate::scene::stl::tests::TWO_SOLIDS),
        ("ply", crate::scene::ply::tests::SQUARE),
    ] {
        damage(extension, text.as_bytes(), text.len(), 3000);
    }
    let (text, binary) = (
        crate::scene::gltf::tests::text(),
        crate::scene::gltf::tests::binary(),
    );
    damage("gltf", text.as_bytes(), text.len(), 3000);
    damage("glb", &binary, binary.len(), 3000);
}

/// Formats whose files are never empty. TOML has its own tests of damaged files.
fn damageable() -> impl Iterator<Item = &'static Importer> {
    IMPORTERS.iter().filter(|it| it.name != "TOML")
}

#[test]
fn damaged_examples_of_every_format_load_whole_or_fail_with_a_remedy() {
    for importer in damageable() {
        let text = importer.example.as_bytes();
        damage(importer.extensions[0], text, text.len(), 500);
    }
}

#[test]
fn damaged_gzipped_files_load_whole_or_fail_with_a_remedy() {
    for importer in damageable() {
        let bytes = samples::gzipped(importer.example.as_bytes());
        let extension = format!("{}.gz", importer.extensions[0]);
        damage(&extension, &bytes, bytes.len(), 100);
    }
}

#[test]
fn bad_files_of_other_projects_load_whole_or_fail_with_a_remedy() {
    let Some(folder) = samples::find("bad") else {
        return;
    };
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
        if IMPORTERS
            .iter()
            .any(|it| it.extensions.contains(&extension))
        {
            damage(extension, &std::fs::read(&path).unwrap(), 100, 100);
        }
    }
}

#[test]
fn wrong_counts_and_indices_fail_at_once() {
    let huge = [
        ("nff", "p 4000000000\n0 0 0\n"),
        ("nff", "p 18446744073709551615\n0 0 0\n"),
        ("nff", "p 99999999999999999999\n0 0 0\n"),
        (
            "obj",
            "v 0 0 0\nf 1 18446744073709551615 9223372036854775807\n",
        ),
        ("obj", "v 0 0 0\nf 1 -9223372036854775808 1\n"),
        (
            "ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nend_header\n",
        ),
        (
            "ply",
            "ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nproperty float x\nend_header\n1\n",
        ),
        (
            "ply",
            "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}",
        ),
        ("obj", "mtllib /dev/zero\nv 0 0 0\nf 1 1 1\n"),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (extension, text) in huge {
        check(
            &folder.path().join(format!("huge.{extension}")),
            text.as_bytes(),
        );
    }
}
