//! Malformed and unusual files of other projects. Each is read correctly, with a warning of the
//! parts that are not drawn, or rejected with its true cause.

use super::samples;
use crate::scene::{MoleculeOptions, load};
use std::collections::BTreeSet;

/// The result of reading a file.
enum Expected {
    /// The number of objects, and a warning with each of these words, no more.
    Read(usize, &'static [&'static str]),
    /// An error with these words.
    Rejected(&'static str),
}

use Expected::{Read, Rejected};

const UNDEFINED: &str = "is defined nowhere; the default is used";
const NO_MATERIALS: &str = "cannot be read";
const NO_TRIANGLES: &str = "has no triangles; nothing is drawn";
const NO_FORMAT: &str = "names no scene format";
const NO_FACES: &str = "the file has no faces and no triangle strips";

#[rustfmt::skip]
const FILES: [(&str, Expected); 64] = [
    ("IndexOutOfRange.gltf", Rejected("mesh 0, primitive 0 uses vertex 255, and it has 24 vertices")),
    ("MissingBin_BoxTextured.gltf", Rejected("BoxTextured0.bin, which cannot be read")),
    ("PLY__cube_binary_header_with_RN_newline.ply", Read(1, &[])),
    ("RecursiveNodes.gltf", Rejected("node 0 is inside of itself")),
    ("assimp_WithCamera.nff", Read(4, &[])),
    ("assimp_spheres.nff", Rejected(":8: a transparent material has no index of refraction")),
    ("atom-id-0.pdb", Read(2, &[])),
    ("bad-atom-line.sdf", Rejected(NO_FORMAT)),
    ("biopython_occupancy.pdb", Read(3, &[])),
    ("box_without_lineending.obj", Read(1, &[UNDEFINED])),
    ("count-line-too-short.sdf", Rejected(NO_FORMAT)),
    ("count_mismatch.xyz", Rejected(":1: the file ends behind 4 of the 8 atoms of a frame")),
    ("crystal-maker.pdb", Read(8, &[])),
    ("cube-vertex-w-component.obj", Read(6, &[NO_MATERIALS, UNDEFINED, UNDEFINED, UNDEFINED])),
    ("empty.ply", Rejected(NO_FACES)),
    ("empty.stl", Rejected("the file has no triangles")),
    ("end-endmdl.pdb", Read(4, &["\"A\" is unknown", "\"E\" is unknown", "\"G\" is unknown", "has 2 models, of which model 1 is drawn"])),
    ("face_in_group_name_mid_file.obj", Read(2, &["a face has a normal that the file lacks"])),
    ("insertion-code.pdb", Read(4, &["\"A\" is unknown"])),
    ("insertion_codes.pdb", Read(6, &[])),
    ("invalid-face-definition.obj", Rejected("the file has no faces")),
    ("invalid.off", Rejected(":7: face 1 (from 0) uses vertex 20, and there are 3 vertices")),
    ("invalid_magic.glb", Rejected("it begins with the bytes 00 00 00 00, not with `glTF`")),
    ("invalid_syntax.gltf", Rejected(":1: the JSON is broken: key must be a string")),
    ("issue-140-zero-face-idx.obj", Rejected(":16: a face has the vertex index 0")),
    ("issue-161-inconsistent-f.obj", Read(1, &["smoothing groups are ignored", NO_MATERIALS, UNDEFINED])),
    ("malformed.obj", Rejected(":28: a face has the vertex index 0")),
    ("malformed2.obj", Read(1, &["a face of 0 vertices has no surface", UNDEFINED])),
    ("mda_xl_serial.pdb", Read(4, &[])),
    ("metadata.ply", Read(1, &[])),
    ("missing_material_file.obj", Read(8, &[UNDEFINED, UNDEFINED, UNDEFINED, UNDEFINED])),
    ("models.pdb", Read(1, &["has 6 models, of which model 1 is drawn"])),
    ("notenoughindices.obj", Read(1, &["smoothing groups are ignored", "a face of 2 vertices has no surface", NO_MATERIALS, UNDEFINED])),
    ("ply_empty_header.ply", Rejected(NO_FACES)),
    ("points_emptyface.ply", Rejected(NO_FACES)),
    ("short-atom.pdb", Read(9, &[])),
    ("stl_empty_bin.stl", Rejected("the file has no triangles")),
    ("test-nan.obj", Rejected(":12: the x coordinate of a vertex is \"nan\", which is not a finite number")),
    ("triangle_with_two_solids.stl", Read(2, &[])),
    ("truncated_chunk_data.glb", Rejected("the header announces 48 bytes, and the file has 47")),
    ("gltf-validator/bom.gltf", Read(0, &["begins with a byte order mark", NO_TRIANGLES])),
    ("gltf-validator/index_buffer_oob.gltf", Rejected("mesh 0, primitive 0 uses vertex 5, and it has 4 vertices")),
    ("gltf-validator/invalid_elements_float.gltf", Read(0, &["element 0 of accessor 0 is not a finite number", NO_TRIANGLES])),
    ("gltf-validator/invalid_version.glb", Rejected("binary glTF of version 0; version 2 is required")),
    ("gltf-validator/length_mismatch.glb", Rejected("the header announces 49 bytes, and the file has 48")),
    ("gltf-validator/no_header.glb", Rejected("begins with the bytes 00, not with `glTF`")),
    ("gltf-validator/node_loop.gltf", Rejected("node 0 is inside of itself")),
    ("gltf-validator/primitive_no_position.gltf", Read(0, &["mesh 0, primitive 0 has no positions", NO_TRIANGLES])),
    ("gltf-validator/two_bin_chunks.glb", Rejected("the first chunk is of the type \"BIN\\0\"; it must be JSON")),
    ("gltf-validator/wrong_bytelength.glb", Rejected("buffer 0 has 16 bytes, and 17 are announced")),
    // Not scenes: what the files above name, and what another program found in them.
    ("IndexOutOfRange.bin", Rejected(NO_FORMAT)),
    ("gltf-validator/index_buffer_oob.bin", Rejected(NO_FORMAT)),
    ("gltf-validator/invalid_elements_float.bin", Rejected(NO_FORMAT)),
    ("gltf-validator/bom.gltf.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/index_buffer_oob.gltf.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/invalid_elements_float.gltf.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/invalid_version.glb.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/length_mismatch.glb.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/no_header.glb.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/node_loop.gltf.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/primitive_no_position.gltf.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/two_bin_chunks.glb.report.json", Rejected(NO_FORMAT)),
    ("gltf-validator/wrong_bytelength.glb.report.json", Rejected(NO_FORMAT)),
    // The folder of the files before.
    ("gltf-validator", Rejected("cannot be read: it is not a file")),
];

#[test]
fn malformed_files_are_read_rightly_or_rejected_with_their_cause() {
    let Some(folder) = samples::find("bad") else {
        return;
    };
    let mut wrong = Vec::new();
    for (name, expected) in &FILES {
        let path = folder.join(name);
        match (load(&path, &MoleculeOptions::default()), expected) {
            (Ok(imported), Read(objects, words)) => {
                let warnings = &imported.warnings;
                let is_warned = warnings.len() == words.len()
                    && words
                        .iter()
                        .all(|it| warnings.iter().any(|w| w.contains(it)));
                if imported.scene.objects.len() != *objects || !is_warned {
                    let found = imported.scene.objects.len();
                    wrong.push(format!("{name}: {found} objects, {warnings:#?}"));
                }
            }
            (Err(error), Rejected(words)) => {
                let text = error.to_string();
                if !text.contains(words) || error.remedy.is_empty() || error.file != path {
                    wrong.push(format!("{name}: {text}; {}", error.remedy));
                }
            }
            (Ok(imported), Rejected(_)) => {
                wrong.push(format!("{name} is read, with {:#?}", imported.warnings));
            }
            (Err(error), Read(..)) => wrong.push(format!("{name} is rejected: {error}")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));

    // No file of the folder is left out.
    let listed: BTreeSet<_> = FILES.iter().map(|(name, _)| folder.join(name)).collect();
    let folders = [folder.clone(), folder.join("gltf-validator")];
    let files = folders.iter().flat_map(|it| std::fs::read_dir(it).unwrap());
    let unlisted: Vec<_> = files
        .map(|entry| entry.unwrap().path())
        .filter(|path| !listed.contains(path))
        .collect();
    assert!(unlisted.is_empty(), "{unlisted:?}");
}

/// The materials of Khronos' validator: valid files are read, with warnings of the parts that are
/// not drawn.
#[test]
fn valid_files_of_khronos_are_read() {
    for (name, words) in [
        ("KHR_lights_punctual__valid", &[NO_TRIANGLES][..]),
        (
            "KHR_materials_dispersion__valid",
            &["KHR_materials_dispersion", NO_TRIANGLES],
        ),
        (
            "KHR_materials_ior__out_of_range",
            &["-0.5 of", "0.5 of material \"material 1\"", NO_TRIANGLES],
        ),
        ("KHR_materials_ior__valid", &["0 of", NO_TRIANGLES]),
        ("KHR_materials_transmission__valid", &[NO_TRIANGLES]),
        ("KHR_materials_volume__valid", &[NO_TRIANGLES]),
    ] {
        let Some(path) = samples::find(&format!("meshes/gltf-khr-materials/{name}.gltf")) else {
            return;
        };
        let loaded = load(&path, &MoleculeOptions::default());
        let warnings = loaded.unwrap_or_else(|error| panic!("{error}")).warnings;
        assert_eq!(warnings.len(), words.len(), "{warnings:#?}");
        for words in words {
            assert!(warnings.iter().any(|w| w.contains(words)), "{warnings:#?}");
        }
    }
}
