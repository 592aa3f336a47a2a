//! Parts and instances.

use super::*;
use crate::scene::{ImportOptions, Instances, Placement};
use glam::DQuat;

const WHEEL: &str = "[[part]]\nname = 'wheel'\n\
    [[part.object]]\nkind = 'sphere'\ncenter = [1, 0, 0]\nradius = 1\nname = 'hub'\n";

/// Options that flatten instances.
fn flatten() -> ImportOptions {
    ImportOptions {
        instances: Instances::Flatten,
        ..ImportOptions::default()
    }
}

#[test]
fn part_is_held_once_and_placed_often() {
    let scene = scene(&format!(
        "{WHEEL}[[instance]]\npart = 'wheel'\n\
         [[instance]]\npart = 'wheel'\nname = 'left'\nscale = 2\n\
         rotate = {{ axis = [0, 0, 1], degrees = 90 }}\ntranslate = [0, 0, 5]\n"
    ));
    assert!(scene.objects.is_empty());
    assert_eq!(scene.parts.len(), 1);
    assert_eq!(scene.parts[0].name, "wheel");
    assert_eq!(scene.parts[0].place.line, 1);
    let [first, left] = &scene.instances[..] else {
        panic!("{:?}", scene.instances)
    };
    assert_eq!(
        (first.name.as_str(), first.placement),
        ("wheel 1", Placement::IDENTITY)
    );
    assert_eq!((left.name.as_str(), left.place.line), ("left", 10));
    let placement = left.placement;
    let quarter = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    assert!(placement.rotation.dot(quarter).abs() > 1.0 - 1e-15);
    assert_eq!(placement.point(DVec3::X), DVec3::new(0.0, 2.0, 5.0));
    let flat = scene.flattened().unwrap();
    let names: Vec<_> = flat.objects.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["wheel 1/hub", "left/hub"]);
}

#[test]
fn instance_stands_where_a_group_would() {
    let keys = "scale = 1.5\nrotate = [20, 30, 40]\ntranslate = [1, 2, 3]\n";
    let object = "object]]\nkind = 'disc'\ncenter = [1, 2, 3]\nnormal = [1, 1, 0]\nradius = 1\n";
    let part = format!("[[part]]\nname = 'p'\n[[part.{object}[[instance]]\npart = 'p'\n{keys}");
    let group = format!("[[object]]\nkind = 'group'\n{keys}[[object.{object}");
    let part = scene(&part);
    let flat = part.flattened().unwrap();
    let group = scene(&group);
    let support = |scene: &Scene, direction: DVec3| scene.objects[0].shape.support(direction);
    for direction in [
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::ONE,
        DVec3::new(1.0, -2.0, 0.5),
    ] {
        let [a, b] = [&flat, &group].map(|scene| support(scene, direction));
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn part_can_hold_groups_and_imports() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\no leaf\nf 1 2 3\n";
    std::fs::write(folder.path().join("leaf.obj"), mesh).unwrap();
    let text = "[material.red]\ndiffuse = [1, 0, 0]\n\
        [group.pair]\nobject = [{ kind = 'sphere', center = [0, 0, 0], radius = 1 }]\n\
        [[part]]\nname = 'tree'\nobject = [\n\
        { kind = 'import', file = 'leaf.obj', material = 'red', translate = [0, 0, 1] },\n\
        { kind = 'instance', group = 'pair', name = 'fruit' },\n]\n\
        [[instance]]\npart = 'tree'\n[[instance]]\npart = 'tree'\ntranslate = [5, 0, 0]\n";
    let imported = load_in(folder.path(), text).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    let objects = &imported.scene.parts[0].objects;
    let names: Vec<_> = objects.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["leaf/leaf", "fruit/sphere 1"]);
    assert_eq!(imported.scene.materials[objects[0].material].name, "red");
    assert_eq!(objects[0].shape.bounds()[0].z, 1.0);
}

/// A file with two instances of a part, and a scene that imports it.
fn importing(transform: &str, wrap: [&str; 2]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let cart = format!(
        "[material.steel]\n{}material = 'steel'\n[[instance]]\npart = 'wheel'\nname = 'left'\n\
         [[instance]]\npart = 'wheel'\nname = 'right'\ntranslate = [4, 0, 0]\n",
        WHEEL
    );
    std::fs::write(folder.path().join("cart.toml"), cart).unwrap();
    let import = format!("{{ kind = 'import', file = 'cart.toml'{transform} }}");
    let text = format!("{}object = [{import}, {import}]{}", wrap[0], wrap[1]);
    load_in(folder.path(), &text).unwrap().scene
}

#[test]
fn import_keeps_its_instances() {
    let scene = importing(", scale = 2, translate = [0, 1, 0]", ["", ""]);
    assert!(scene.objects.is_empty());
    // Two imports of a file share its parts.
    assert_eq!((scene.parts.len(), scene.instances.len()), (1, 4));
    assert_eq!(scene.parts[0].name, "cart/wheel");
    let right = &scene.instances[1];
    assert_eq!(right.name, "cart/right");
    assert_eq!(right.placement.point(DVec3::X), DVec3::new(10.0, 1.0, 0.0));
    let material = scene.parts[0].objects[0].material;
    assert_eq!(scene.materials[material].name, "steel");
}

#[test]
fn import_that_is_mirrored_or_in_a_part_has_copies() {
    let mirrored = importing(", scale = [-1, 1, 1]", ["", ""]);
    assert!(mirrored.parts.is_empty() && mirrored.instances.is_empty());
    let names: Vec<_> = mirrored.objects.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names[..2], ["cart/left/hub", "cart/right/hub"]);
    assert_eq!(
        mirrored.objects[1].shape.middle(),
        Some(DVec3::new(-5.0, 0.0, 0.0))
    );
    let part = [
        "[[part]]\nname = 'outer'\n",
        "\n[[instance]]\npart = 'outer'\n",
    ];
    let nested = importing("", part);
    assert_eq!((nested.parts.len(), nested.instances.len()), (1, 1));
    assert_eq!(nested.parts[0].objects.len(), 4);
}

#[test]
fn flattening_at_import_leaves_no_instances() {
    let text = format!("{WHEEL}[[instance]]\npart = 'wheel'\n");
    let read = crate::scene::read("a.toml".as_ref(), text.clone().into(), &flatten());
    let flat = read.unwrap().scene;
    assert!(flat.parts.is_empty() && flat.instances.is_empty());
    assert_eq!(flat, *scene_at("a.toml", &text).flattened().unwrap());
}

fn scene_at(name: &str, text: &str) -> Scene {
    let read = crate::scene::read(name.as_ref(), text.into(), &ImportOptions::default());
    read.unwrap().scene
}

#[test]
fn part_that_nobody_places_is_left_out_with_a_warning() {
    let imported = load(&format!(
        "{WHEEL}[[part]]\nname = 'door'\n[[part.object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\n\
         radius = 1\n[[instance]]\npart = 'door'\n"
    ))
    .unwrap();
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings)
    };
    assert!(warning.ends_with(":1: no instance places the part \"wheel\"; it is left out"));
    assert_eq!(imported.scene.parts.len(), 1);
    assert_eq!(imported.scene.instances[0].part, 0);
}

#[test]
fn many_instances_are_kept_and_not_flattened() {
    let mut text = String::from(WHEEL);
    for _ in 0..1 << 12 {
        text.push_str("[[instance]]\npart = 'wheel'\n");
    }
    // Twelve levels of two imports each make 2^24 instances.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("0.toml"), text).unwrap();
    for level in 0..12 {
        let import = format!("[[object]]\nkind = 'import'\nfile = '{level}.toml'\n");
        let text = import.repeat(2);
        std::fs::write(folder.path().join(format!("{}.toml", level + 1)), text).unwrap();
    }
    let error = crate::scene::load(&folder.path().join("12.toml"), &Default::default());
    let error = error.unwrap_err();
    assert!(error.cause.contains("GB of memory"), "{error}");
}

#[test]
fn a_material_of_a_part_moves() {
    let imported = load(&format!(
        "[material.red]\ndiffuse = [1, 0, 0]\n{WHEEL}material = 'red'\n\
         [[instance]]\npart = 'wheel'\n\
         [[track]]\ntarget = 'material.red.diffuse'\ntimes = [0]\nvalues = [0]\n"
    ))
    .unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    assert_eq!(imported.scene.tracks.len(), 1);
}

#[test]
fn documented_parts_are_placed() {
    let document = include_str!("../../../../docs/SCENE.md");
    let (_, section) = document.split_once("\n## Instances\n").unwrap();
    let (_, example) = section.split_once("```toml\n").unwrap();
    let imported = load(example.split_once("```").unwrap().0).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    let flat = imported.scene.flattened().unwrap();
    let names: Vec<_> = flat.objects.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["left/torus 1", "right/torus 1"]);
}

#[test]
fn documented_assembly_is_placed() {
    let document = include_str!("../../../../docs/SCENE.md");
    let (_, section) = document.split_once("\n## Assemblies\n").unwrap();
    let (_, example) = section.split_once("```toml\n").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let capsid = "\
REMARK 350 BIOMOLECULE: 1
REMARK 350 APPLY THE FOLLOWING TO CHAINS: A
REMARK 350   BIOMT1   1 -1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   1  0.000000 -1.000000  0.000000        0.00000
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000
ATOM      1  CA  CYS A   3      11.000   2.000   3.000  1.00  0.00           C
";
    std::fs::write(folder.path().join("capsid.pdb"), capsid).unwrap();
    let imported = load_in(folder.path(), example.split_once("```").unwrap().0).unwrap();
    assert!(imported.kinds.assemblies);
    let flat = imported.scene.flattened().unwrap();
    assert_eq!(flat.objects[0].name, "capsid/1/A/CYS 3/CA");
    assert_eq!(
        flat.objects[0].shape.middle(),
        Some(DVec3::new(-11.0, -2.0, 3.0))
    );
}
