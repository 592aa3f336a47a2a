//! The whole-program tests: one program, because each would compile the kernels again. Tests that
//! replace the allocator (`allocation`, `memory`) and those of boards (`board`) are programs of their
//! own.

mod absorption;
mod accuracy;
mod all_hits;
mod apex;
mod blob;
mod boxes;
mod c_header;
mod camera_rays;
mod certify;
mod cylinder_cube;
mod deform;
mod depth_of_field;
mod distances;
mod documents;
mod environment;
mod explain;
mod far_planes;
mod fixed_point;
mod glossy;
mod grids;
mod indirect;
mod instances;
mod large_scenes;
mod lattice;
mod layers;
mod lights;
mod live;
mod motion_blur;
mod nested;
mod normal_maps;
mod origins;
mod reference;
mod render;
mod shading;
mod shapes;
mod spd;
mod structures;
mod tables;
mod texture_levels;
mod textures;
mod tracks;
mod transforms;
mod verify;
mod watertight;
mod wide;

/// A file that is not named here would not run.
#[test]
fn every_file_is_part_of_a_program() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let programs = ["allocation", "board", "main", "memory"];
    for entry in std::fs::read_dir(folder).expect("the folder of this file") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_string_lossy();
        let is_module = include_str!("main.rs").contains(&format!("\nmod {name};"));
        let is_program = programs.contains(&&*name);
        assert!(
            is_module != is_program,
            "{name} is in no program, or in two"
        );
    }
}
