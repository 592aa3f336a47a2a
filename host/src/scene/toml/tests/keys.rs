//! The keys of all tracks, which imports multiply.

use super::load_in;
use std::path::Path;

const BALL: &str = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";

const LIGHT: &str = "[[light]]\nkind = 'point'\nposition = [0, 5, 0]\n";

/// A track of 2,000 keys, one per second.
fn track(target: &str, value: &str) -> String {
    let times: Vec<_> = (0..2000).map(|it| it.to_string()).collect();
    let times = times.join(", ");
    let values = vec![value; 2000].join(", ");
    format!("[[track]]\ntarget = '{target}'\ntimes = [{times}]\nvalues = [{values}]\n")
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

fn imports(file: &str, times: usize) -> String {
    format!("[[object]]\nkind = 'import'\nfile = '{file}'\n").repeat(times)
}

/// Keys count whether or not the scene takes the tracks over, so that nothing depends on the order of imports.
#[test]
fn keys_of_every_import_count() {
    let folder = tempfile::tempdir().unwrap();
    let inner = format!("{LIGHT}{BALL}{}", track("light.0.color", "0.5"));
    write(folder.path(), "inner.toml", &inner);
    let text = |times| format!("{LIGHT}{}", imports("inner.toml", times));
    // With those of the file itself.
    assert!(load_in(folder.path(), &text(2096)).is_ok());
    let error = load_in(folder.path(), &text(2097)).unwrap_err();
    let expected =
        "with this import, each import counted, tracks have 4,196,000 keys; the limit is 4,194,304";
    assert_eq!(error.cause, expected);
    // The file of the last import.
    assert_eq!(error.line, Some(3 + 3 * 2097));
}

/// A turn of many degrees has few keys in the file.
#[test]
fn keys_of_turns_count() {
    let folder = tempfile::tempdir().unwrap();
    let inner = format!("{LIGHT}{BALL}{}", track("light.0.color", "0.5"));
    write(folder.path(), "inner.toml", &inner);
    let turns = "[[joint]]\nname = 'j'\n[[track]]\ntarget = 'joint.j.rotation'\naxis = [0, 1, 0]\n\
                 times = [0, 1000]\nvalues = [0, 5000000]\n";
    write(folder.path(), "turns.toml", &format!("{BALL}{turns}"));
    assert!(load_in(folder.path(), &imports("turns.toml", 1)).is_ok());
    let text = format!(
        "{LIGHT}{}{}",
        imports("inner.toml", 2080),
        imports("turns.toml", 1)
    );
    let error = load_in(folder.path(), &text).unwrap_err();
    assert!(
        error.cause.starts_with("with this track, tracks have 4,2"),
        "{error}"
    );
    assert!(error.file.ends_with("turns.toml"), "{error}");
}

/// Each place of a group copies the joints of its imports.
#[test]
fn keys_of_joints_count_at_every_place() {
    let folder = tempfile::tempdir().unwrap();
    let ball = "object = [{ kind = 'sphere', center = [0, 0, 0], radius = 1 }]";
    let inner = format!(
        "[[part]]\nname = 'p'\n{ball}\n[[joint]]\nname = 'j'\n[[instance]]\npart = 'p'\njoint = 'j'\n{}",
        track("joint.j.shift", "[0, 1, 0]")
    );
    write(folder.path(), "inner.toml", &inner);
    let row = "{ kind = 'instance', group = 'one' },".repeat(50);
    let text = |rows: usize| {
        let row_of = "[[object]]\nkind = 'instance'\ngroup = 'row'\n".repeat(rows);
        format!(
            "[group.one]\nobject = [{{ kind = 'import', file = 'inner.toml' }}]\n\
             [group.row]\nobject = [{row}]\n{row_of}"
        )
    };
    assert_eq!(
        load_in(folder.path(), &text(1)).unwrap().scene.joints.len(),
        50
    );
    let error = load_in(folder.path(), &text(42)).unwrap_err();
    let expected =
        "with this object the tracks of joints have 4,200,000 keys; the limit is 4,194,304";
    assert_eq!(error.cause, expected);
}
