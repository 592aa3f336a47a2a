//! Imports inside of groups and parts.

use super::load_in;
use crate::scene::Shape;

const LIT: &str = "background = 1\nambient = 0.7\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
                   [environment]\nzenith = 1\nhorizon = 1\nground = 1\n\
                   [[light]]\nkind = 'sphere'\ncenter = [0, 3, 0]\nradius = 0.5\nradiance = 50\nvisible = true\n\
                   [[light]]\nkind = 'point'\nposition = [0, 9, 0]\n\
                   [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";

const LOST: &str = "an import inside of a group or part brings its objects alone, and not its";

#[test]
fn imports_inside_of_groups_keep_lamps_as_objects_and_warn_of_the_rest() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    // Outside of a group, a file imported by this one brings it its lights.
    write("lit.toml", LIT);
    write(
        "sub.toml",
        "[[object]]\nkind = 'import'\nfile = 'lit.toml'\n",
    );
    write(
        "ball.toml",
        "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    let grouped = |file: &str| {
        let text = format!(
            "[[object]]\nkind = 'group'\ntranslate = [1, 0, 0]\nobject = [{{ kind = 'import', file = '{file}' }}]\n"
        );
        load_in(folder.path(), &text).unwrap()
    };
    for file in ["lit.toml", "sub.toml"] {
        let imported = grouped(file);
        let [warning] = &imported.warnings[..] else {
            panic!("{:?}", imported.warnings)
        };
        let lost =
            format!("scene.toml:4: {LOST} camera, lights, background, ambient light, environment");
        assert!(warning.ends_with(&lost), "{warning}");
        let scene = &imported.scene;
        // It lights others as any object that glows.
        assert_eq!((scene.objects.len(), scene.lights.len()), (2, 1));
        let lamp = &scene.objects[1];
        assert_eq!(scene.materials[lamp.material].emission, [50.0; 3]);
        let Shape::Sphere(shape) = lamp.shape else {
            panic!("{:?}", lamp.shape)
        };
        assert_eq!(shape.center.to_array(), [1.0, 3.0, 0.0]);
    }
    assert_eq!(grouped("ball.toml").warnings, [] as [&str; 0]);
    let own = load_in(
        folder.path(),
        "[[object]]\nkind = 'import'\nfile = 'lit.toml'\n",
    )
    .unwrap();
    assert_eq!(own.warnings, [] as [&str; 0]);
    assert_eq!((own.scene.objects.len(), own.scene.lights.len()), (2, 2));
}

#[test]
fn texts_that_take_too_much_memory_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let error = load_in(folder.path(), &"#".repeat(22_000_001)).unwrap_err();
    assert_eq!(
        error.cause,
        "the text has 22,000,001 bytes, with the files that import it; the limit is 22,000,000"
    );
    assert!(load_in(folder.path(), &"#".repeat(1_000_000)).is_ok());
}
