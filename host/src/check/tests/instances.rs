//! Instances that are kept or copied, and assemblies.

use super::*;

/// Two balls at the ends of a beam that turns.
const BEAM: &str = r#"
camera = { eye = [0, 0, 8], target = [0, 0, 0] }
render = { width = 16, height = 12 }
light = [{ kind = "point", position = [3, 4, 5] }]

[[object]]
kind = "sphere"
center = [0, 0, 0]
radius = 0.5

[[part]]
name = "ball"
object = [{ kind = "sphere", center = [0, 0, 0], radius = 1 }]

[[joint]]
name = "beam"
pivot = [0, 0, 0]

[[instance]]
part = "ball"
joint = "beam"
translate = [2, 0, 0]

[[instance]]
part = "ball"
joint = "beam"
translate = [-2, 0, 0]

[[track]]
target = "joint.beam.rotation"
axis = [0, 0, 1]
times = [0, 1]
values = [0, 90]
"#;

fn found(report: &Report, check: &str, what: &str) -> Figure {
    let mut findings = report.findings.iter();
    let finding = findings.find(|it| it.check == check && it.what == what);
    finding.and_then(|it| it.found.clone()).expect(what)
}

/// The working memory is what the memory report lists beside the row of pixels and the call stack.
#[test]
fn working_memory_counts_parts_and_joints() {
    let folder = Folder::new();
    fs::write(folder.path("beam.toml"), BEAM).unwrap();
    let text = "[[check]]\nscene = \"beam.toml\"\ntarget = \"stm32f411\"\nformats = [\"f32\"]\n\
                budget = { working_bytes = 1, ram = 1, call_stack = 1 }\n";
    let (_, report) = folder.run(text);
    let count = |what: &str| match found(&report, "beam", what) {
        Figure::Count(count) => count,
        other => panic!("{other:?}"),
    };
    let row = 16 * 2;
    assert_eq!(
        count("working_bytes") + row + count("call_stack"),
        count("ram"),
        "{}",
        report.table()
    );
}

#[test]
fn instances_are_kept_or_copied_where_they_are() {
    let folder = Folder::new();
    fs::write(folder.path("beam.toml"), BEAM).unwrap();
    let check = |name: &str, instances: &str| {
        let name = format!("[[check]]\nname = \"{name}\"\nscene = \"beam.toml\"\n");
        format!("{name}time = 0.5\nhash = {{}}\nbudget = {{ blob_bytes = 1 }}\n{instances}\n")
    };
    let (_, report) = folder.run(&format!(
        "{}{}{}",
        check("as it is", ""),
        check("kept", "instances = \"keep\""),
        check("copied", "instances = \"flatten\"")
    ));
    let of = |what| ["as it is", "kept", "copied"].map(|check| found(&report, check, what));
    let [as_it_is, kept, copied] = of("blob_bytes");
    assert_eq!(as_it_is, kept);
    assert_ne!(kept, copied);
    let [as_it_is, kept, copied] = of("hash");
    assert_eq!(as_it_is, kept);
    // The balls stand where they are at the time: the picture is the same, and at rest another one.
    assert_eq!(kept, copied);
    let (_, report) = folder.run(&check("at rest", "").replace("time = 0.5\n", ""));
    assert_ne!(found(&report, "at rest", "hash"), kept);
}

#[test]
fn what_has_no_instances_to_choose_is_rejected() {
    let folder = Folder::new();
    fs::write(folder.path("beam.toml"), BEAM).unwrap();
    let mistakes = [
        ("assembly = \"1\"", "`assembly` is for PDB and mmCIF files"),
        ("instances = \"keep\"", ""),
    ];
    for (key, expected) in mistakes {
        let text = format!("[[check]]\nscene = \"beam.toml\"\nhash = {{}}\n{key}\n");
        let (_, report) = folder.run(&text);
        let why = report
            .findings
            .iter()
            .map(why)
            .find(|it| it.contains(expected));
        assert!(why.is_some(), "{key}: {:?}", report.findings);
    }
    let text = "[[check]]\nscene = \"beam.toml\"\nhash = {}\ninstances = \"copy\"\n";
    let error = folder.manifest(text).unwrap_err().to_string();
    assert!(error.contains("`instances` is \"copy\""), "{error}");
    let scene = crate::scene::load(&folder.path("beam.toml"), &Default::default())
        .unwrap()
        .scene;
    let blob = crate::compile::compile(&scene, &Default::default())
        .unwrap()
        .blob;
    fs::write(folder.path("beam.gridel"), blob.bytes()).unwrap();
    for key in ["instances = \"flatten\"", "assembly = \"1\""] {
        let text = format!("[[check]]\nscene = \"beam.gridel\"\nhash = {{}}\n{key}\n");
        let (_, report) = folder.run(&text);
        let why = why(&report.findings[0]);
        let place = format!("{}:2:", folder.path("check.toml").display());
        assert!(why.starts_with(&place), "{key}: {why}");
        for words in ["is for scene files", "; leave the key out"] {
            assert!(why.contains(words), "{key}: {why}");
        }
    }
}

#[test]
fn blobs_that_cannot_be_checked_name_the_manifest_and_a_remedy() {
    let folder = Folder::new();
    let scene = crate::scene::load(&folder.path("ball.toml"), &Default::default()).unwrap();
    let compiled = crate::compile::compile(&scene.scene, &Default::default()).unwrap();
    let bytes = compiled.blob.bytes();
    fs::write(folder.path("ball.gridel"), bytes).unwrap();
    fs::write(folder.path("cut.gridel"), &bytes[..bytes.len() - 16]).unwrap();
    for (keys, words) in [
        (
            "scene = \"cut.gridel\"",
            ["is an invalid blob", "; copy the file again"],
        ),
        (
            "scene = \"ball.gridel\"\ntime = 1",
            ["nothing that moves", "; leave `time` out"],
        ),
    ] {
        let (_, report) = folder.run(&format!("[[check]]\n{keys}\nhash = {{}}\n"));
        let why = why(&report.findings[0]);
        let place = format!("{}:2:", folder.path("check.toml").display());
        assert!(why.starts_with(&place), "{keys}: {why}");
        assert!(words.iter().all(|it| why.contains(it)), "{keys}: {why}");
    }
}
