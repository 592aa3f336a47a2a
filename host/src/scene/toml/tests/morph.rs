//! Morph targets: what meshes have by them, and the tracks of their weights.

use super::{load, load_in, scene};
use crate::scene::{Object, Scene, Shape, TrackTarget};
use glam::DVec3;

const TRIANGLE: &str = "kind = 'triangle'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n";

fn vertices(object: &Object) -> &[DVec3] {
    match &object.shape {
        Shape::Mesh { vertices, .. } => vertices,
        shape => panic!("{shape:?}"),
    }
}

fn displaced(scene: &Scene, object: usize) -> Vec<(usize, DVec3)> {
    let displacements = scene.objects[object].attributes.displacements.iter();
    displacements.map(|it| (it.target, it.vectors[2])).collect()
}

#[test]
fn meshes_share_morph_targets_by_name() {
    let scene = scene(&format!(
        "[morph.b]\nweight = 0.5\nrange = [-1, 2]\n[morph.a]\n\
         [[object]]\n{TRIANGLE}morph = {{ b = [[0, 0, 0], [0, 0, 0], [0, 0, 2]] }}\n\
         [[object]]\n{TRIANGLE}rotate = [0, 0, 90]\nscale = 3\n\
         morph = {{ a = [[0, 0, 0], [0, 0, 0], [1, 0, 0]], b = [[0, 0, 0], [0, 0, 0], [0, 0, 1]] }}\n\
         [[track]]\ntarget = 'morph.b.weight'\ntimes = [0, 1]\nvalues = [0.5, -3]\n"
    ));
    let targets: Vec<_> = scene
        .morph_targets
        .iter()
        .map(|it| (it.name.as_str(), it.weight, it.range))
        .collect();
    let number = |name: &str| targets.iter().position(|it| it.0 == name).unwrap();
    let (a, b) = (number("a"), number("b"));
    assert_eq!(targets[a], ("a", 0.0, [0.0, 1.0]));
    assert_eq!(targets[b], ("b", 0.5, [-1.0, 2.0]));
    assert_eq!(displaced(&scene, 0), [(b, DVec3::Z * 2.0)]);
    // At rest.
    assert_eq!(vertices(&scene.objects[0])[2], DVec3::new(0.0, 1.0, 1.0));
    let mut second = displaced(&scene, 1);
    second.sort_unstable_by_key(|it| it.0 != a);
    assert!(second[0].1.distance(DVec3::Y * 3.0) < 1e-12, "{second:?}");
    assert!(second[1].1.distance(DVec3::Z * 3.0) < 1e-12, "{second:?}");
    let track = &scene.tracks[0];
    assert_eq!((track.target, track.index), (TrackTarget::MorphWeight, b));
}

/// Each import has morph targets of its own, with their tracks, in groups and parts as well.
#[test]
fn imports_bring_their_morph_targets() {
    let folder = tempfile::tempdir().unwrap();
    let inner = format!(
        "[morph.up]\n[[object]]\n{TRIANGLE}morph = {{ up = [[0, 0, 0], [0, 0, 0], [0, 0, 2]] }}\n\
         [[track]]\ntarget = 'morph.up.weight'\ntimes = [0, 1]\nvalues = [0, 1]\n"
    );
    std::fs::write(folder.path().join("inner.toml"), inner).unwrap();
    let import = "kind = 'import'\nfile = 'inner.toml'\n";
    let text = format!(
        "[[object]]\n{import}[[object]]\n{import}scale = 2\n\
         [[part]]\nname = 'p'\n[[part.object]]\n{import}[[instance]]\npart = 'p'\n"
    );
    let imported = load_in(folder.path(), &text).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    let scene = imported.scene;
    let names = scene.morph_targets.iter().map(|it| it.name.as_str());
    assert_eq!(names.collect::<Vec<_>>(), ["up", "up", "up"]);
    let tracks = scene.tracks.iter().map(|it| it.index);
    assert_eq!(tracks.collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(displaced(&scene, 0), [(0, DVec3::Z * 2.0)]);
    assert_eq!(displaced(&scene, 1), [(1, DVec3::Z * 4.0)]);
    let part = &scene.parts[0].objects[0].attributes.displacements;
    assert_eq!(part[0].target, 2);
}

/// Computed normals turn with the faces: the second vertex is lifted until the triangles lie in one plane.
#[test]
fn smooth_normals_turn_with_the_faces() {
    let scene = scene(
        "[morph.flat]\n[[object]]\nkind = 'mesh'\nsmooth = 100\n\
         vertices = [[0, 0, 0], [1, 0, -1], [-1, 0, -1], [0, 1, 0]]\nfaces = [[0, 1, 3], [2, 0, 3]]\n\
         morph = { flat = [[0, 0, 0], [0, 0, 1], [0, 0, 1], [0, 0, 0]] }\n",
    );
    let normals = &scene.objects[0].normals;
    let [changes] = &normals.changes[..] else {
        panic!("{normals:?}")
    };
    for (normal, change) in normals.vectors.iter().zip(&changes.vectors) {
        let turned = *normal + *change;
        assert!(turned.distance(DVec3::Z) < 1e-9, "{normals:?}");
    }
}

#[test]
fn morph_targets_that_no_mesh_has_are_warned_of() {
    let imported = load(&format!(
        "[morph.used]\n[morph.idle]\n\
         [[object]]\n{TRIANGLE}morph = {{ used = [[0, 0, 0], [0, 0, 0], [0, 0, 2]] }}\n\
         [[track]]\ntarget = 'morph.idle.weight'\ntimes = [0]\nvalues = [0]\n"
    ))
    .unwrap();
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings)
    };
    assert!(
        warning.contains("toml:2: no mesh has the morph target \"idle\""),
        "{warning}"
    );
}

/// Triangles that have no area at rest, and one with another weight.
#[test]
fn faces_without_area_at_rest_can_open() {
    let scene = scene(
        "[morph.open]\n\
         [[object]]\nkind = 'triangle'\nvertices = [[0, 0, 0], [0, 0, 0], [0, 1, 0]]\n\
         morph = { open = [[0, 0, 0], [1, 0, 0], [0, 0, 0]] }\n\
         [[object]]\nkind = 'mesh'\nvertices = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]\nfaces = [[0, 1, 2]]\n\
         morph = { open = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }\n",
    );
    assert_eq!(scene.objects.len(), 2);
}
