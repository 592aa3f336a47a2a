//! Manifests, valid and invalid.

use super::*;

#[test]
fn mistakes_name_line_cause_and_remedy() {
    let folder = Folder::new();
    for (text, line, cause, remedy) in [
        (
            "",
            1,
            "this manifest has no `[[check]]`",
            "add a line `[[check]]`",
        ),
        (
            "check = []",
            1,
            "this manifest has no `[[check]]`",
            "add a line `[[check]]`",
        ),
        (
            "[[check]]\nscene = \".\"\nhash = {}",
            2,
            "is a folder, and no scene",
            "path of a scene file",
        ),
        (
            "[[check]]\nname = \"a\"\nscene = \"lost/..\"\nhash = {}",
            3,
            "is a folder, and no scene",
            "",
        ),
        (
            "[[check]]\nscene = \"ball.toml\"\nhash = {}\n[[check]]\nscene = \"b.toml\"\n\
             reference = \"./ball.toml\"",
            6,
            "ball.toml is a scene",
            "another name",
        ),
        (
            "[[check]]\nscene = \"a\"\nreference = \"q.jpg\"",
            3,
            "q.jpg is no PNG file",
            "path that ends in `.png`",
        ),
        (
            "[[check]]\nscene = \"a\"\nbudget = {}\nformats = [\"f64\"]",
            1,
            "this check tests nothing",
            "add `hash = {}`",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"\nelf = \"e\"",
            3,
            "this board tests nothing",
            "add a `budget`",
        ),
        (
            "[[check]]\nscene = \"a\"\nhash = { f32 = \"zz\" }",
            3,
            "`zz` is not a picture hash",
            "--bless",
        ),
        (
            "[[check]]\nname = \"a\"",
            1,
            "has no `scene`",
            "add a line `scene",
        ),
        (
            "[[check]]\nscene = \"a\"\nbugdet = {}",
            3,
            "this check has no key `bugdet`",
            "did you mean `budget`?",
        ),
        (
            "[[check]]\nscene = \"a\"\n[check.budget]\nblob_byte = 3",
            4,
            "this budget has no key `blob_byte`",
            "did you mean `blob_bytes`?",
        ),
        (
            "[[check]]\nscene = \"a\"\nbudget = { blob_bytes = -3 }",
            3,
            "`blob_bytes` is -3",
            "write a number from 0",
        ),
        (
            "[[check]]\nscene = \"a\"\nformats = [\"f33\"]",
            3,
            "`formats` is \"f33\"",
            "did you mean \"f32\"?",
        ),
        (
            "[[check]]\nscene = \"a\"\nformats = [\"f32\", \"f32\"]",
            3,
            "none of them twice",
            "",
        ),
        (
            "[[check]]\nscene = \"a\"\nhash = { fixed = \"\" }",
            3,
            "this hash table has no key `fixed`",
            "The keys are f32",
        ),
        (
            "[[check]]\nscene = \"a\"\naccel = \"flaged\"",
            3,
            "no acceleration structure \"flaged\"",
            "did you mean \"flagged\"?",
        ),
        (
            "[[check]]\nscene = \"a\"\nsize = [1]",
            3,
            "a width and a height",
            "[640, 480]",
        ),
        (
            "[[check]]\nscene = \"a\"\nsize = [0, 1]",
            3,
            "it must be from 1",
            "",
        ),
        (
            "[[check]]\nscene = \"a\"\nsize = [999, 1]",
            3,
            "64 times",
            "",
        ),
        (
            "[[check]]\nscene = \"a\"\ntolerance = {}",
            3,
            "without a `reference`",
            "",
        ),
        (
            "[[check]]\nscene = \"x/a.toml\"\nhash = {}\n[[check]]\nscene = \"a.obj\"\nhash = {}",
            4,
            "two checks have the name \"a\"",
            "another `name`",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"",
            3,
            "this board has no program",
            "`elf = ...`",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"\nelf = \"e\"\ntarget = \"t\"",
            6,
            "needs no `target`",
            "remove the key",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"\nelf = \"e\"\nfirmware = \"f\"",
            5,
            "both",
            "remove one",
        ),
        (
            "[[check]]\nscene = \"a\"\nhash = {}\n[[check.board]]\nmachine = \"m\"\nelf = \"e\"",
            4,
            "this board tests nothing",
            "add a `budget`",
        ),
        (
            "[[check]]\nscene = \"a\"\n[[check.board]]\nmachine = \"m\"\nelf = \"e\"\npicture = \"/tmp/p\"",
            6,
            "the folder in which the program runs",
            "without a folder",
        ),
    ] {
        let error = folder.manifest(text).unwrap_err();
        assert_eq!(error.line, Some(line), "{text}: {error}");
        assert!(error.cause.contains(cause), "{text}: {error}");
        assert!(error.remedy.contains(remedy), "{text}: {}", error.remedy);
    }
}

#[test]
fn documented_example_is_a_valid_manifest() {
    let document = include_str!("../../../docs/CHECK.md");
    let (_, example) = document.split_once("```toml\n").unwrap();
    let (example, _) = example.split_once("```").unwrap();
    let manifest = Folder::new().manifest(example).unwrap();
    assert_eq!(manifest.checks[0].boards[0].budget.len(), 2);
}

#[test]
fn target_mistakes_name_the_boards() {
    let folder = Folder::new();
    let check = "[[check]]\nscene = \"ball.toml\"\n";
    for (lines, parts) in [
        ("target = \"stm32\"\n", ["stm32vldiscovery", "sifive_e"]),
        (
            "budget = { ram = 8192 }\n",
            ["`ram` is a budget on a board", "microbit"],
        ),
        (
            "budget = { call_stack = 1 }\n",
            ["`call_stack`", "target = ..."],
        ),
        (
            "target = \"microbit\"\nbudget = { flash = -1 }\n",
            ["flash", "0"],
        ),
    ] {
        let error = folder.manifest(&format!("{check}{lines}")).unwrap_err();
        let text = format!("{error} {}", miette::Diagnostic::help(&error).unwrap());
        for part in parts {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
