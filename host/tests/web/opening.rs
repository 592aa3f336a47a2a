//! Scenes that are opened, and scenes that cannot be.

use crate::page::{Page, assert_no_message, choose, content, explain, open, settle, shown};
use serde_json::json;

const RIGHT: &str = "\u{e014}";

pub fn files_open(page: &Page) {
    let browser = page.open();
    let input = "//*[@id='files']";
    let begin = "document.documentElement.dataset.state = 'wait'";
    let path = |name: &str| page.files.path(name).display().to_string();

    // A scene with the files that it names.
    page.files.write(
        "leaf.obj",
        b"mtllib leaf.mtl\nusemtl red\nv 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n",
    );
    page.files.write("leaf.mtl", b"newmtl red\nKd 1 0 0\n");
    page.files.write(
        "tree.toml",
        b"[[object]]\nkind = 'import'\nfile = 'leaf.obj'\n",
    );
    browser.script(begin);
    browser.fill(
        input,
        &[path("leaf.mtl"), path("tree.toml"), path("leaf.obj")].join("\n"),
    );
    settle(&browser);
    let of_program = |arguments: &[&str]| {
        page.rendered(&[arguments, &["--format", "f32", "--accel", "dual-split"]].concat())
    };
    assert!(shown(&browser) == of_program(&["tree.toml"]));
    // The other file that is a scene of its own.
    let is_named = "return !document.getElementById('scene-name').hidden";
    assert_eq!(browser.text(is_named), "false");
    choose(&browser, "main", "leaf.obj");
    assert!(shown(&browser) == of_program(&["leaf.obj"]));

    // A blob, dropped as a mouse drops it.
    page.files
        .done(&["build", "quick.toml", "-o", "drop.gridel", "--accel", "bvh"]);
    browser.script(begin);
    let data = json!({"items": [], "files": [path("drop.gridel")], "dragOperationsMask": 1});
    for kind in ["dragEnter", "dragOver", "drop"] {
        let event = json!({"type": kind, "x": 200, "y": 200, "data": data});
        browser.command("Input.dispatchDragEvent", event);
    }
    settle(&browser);
    assert!(content(&browser, "status").contains("drop.gridel"));
    assert_eq!(browser.text(is_named), "true");
    assert_eq!(content(&browser, "scene-name"), "File: drop.gridel");
    assert!(
        shown(&browser) == page.rendered(&["drop.gridel", "--format", "f32", "--accel", "bvh"])
    );
    assert_eq!(
        browser.text("return document.getElementById('bits').disabled"),
        "true"
    );

    // Errors are the program's: file, place, cause and remedy.
    page.files.write(
        "broken.toml",
        b"[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = -1\n",
    );
    page.files.write(
        "lost.toml",
        b"[[object]]\nkind = 'import'\nfile = 'none.obj'\n",
    );
    let mut blob = page.files.read("drop.gridel");
    blob.truncate(200);
    page.files.write("short.gridel", &blob);
    page.files.write("notes.docx", b"no scene");
    for name in ["broken.toml", "short.gridel", "notes.docx"] {
        browser.script(begin);
        browser.fill(input, &path(name));
        browser.wait("document.documentElement.dataset.state === 'error'");
        let plain = |text: &str| {
            let words = text
                .split_whitespace()
                .filter(|word| !"│╰─▶×╭╯├".contains(*word));
            // Lines break at other places.
            words.collect::<String>()
        };
        let run = page.files.run(&["render", name, "-o", "none.png"]);
        assert_ne!(run.code, Some(0));
        // The cause and its remedy; frames and lines are drawn in another width.
        let (page_says, program_says) =
            (plain(&content(&browser, "error-text")), plain(&run.stderr));
        let sentences = page_says.split("help:");
        for sentence in sentences
            .map(|it| it.split('[').next().unwrap().trim())
            .filter(|it| !it.is_empty())
        {
            assert!(
                program_says.contains(sentence),
                "{sentence:?}\n{program_says}"
            );
        }
        assert!(page_says.contains("help:"), "{page_says}");
    }
    browser.script(begin);
    browser.fill(input, &path("lost.toml"));
    browser.wait("document.documentElement.dataset.state === 'error'");
    let error = content(&browser, "error-text");
    assert!(
        error.contains("lost.toml:3") && error.contains("none.obj"),
        "{error}"
    );
    // Two files of one name: neither would be found by it.
    browser.script(
        "document.documentElement.dataset.state = 'wait';
         const dataTransfer = new DataTransfer();
         for (const text of ['', 'two']) dataTransfer.items.add(new File([text], 'same.toml'));
         document.body.dispatchEvent(new DragEvent('drop', { bubbles: true, dataTransfer }))",
    );
    browser.wait("document.documentElement.dataset.state === 'error'");
    let error = content(&browser, "error-text");
    let both = "same.toml (0 bytes) and same.toml (3 bytes)";
    assert!(error.contains(both), "{error}");
    // The scene that was shown still is.
    browser.click("//*[@id='error-close']");
    assert!(
        shown(&browser) == page.rendered(&["drop.gridel", "--format", "f32", "--accel", "bvh"])
    );
    assert_no_message(&browser);
}

pub fn scene_stays(page: &Page) {
    let browser = page.open();
    choose(&browser, "sample", "quick.toml");
    let first = shown(&browser);
    page.files.write(
        "broken.toml",
        b"[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = -1\n",
    );
    page.files
        .write("short.gridel", b"GRIDEL\x1a\n, and no more");
    let failed = "document.documentElement.dataset.state === 'error'";
    let all_is_there = || {
        assert!(shown(&browser) == first);
        explain(&browser, [110, 150]);
        let explained = ["explain", "quick.toml", "--pixel", "110,150"];
        let explained = page.files.done(
            &[
                &explained[..],
                &["--format", "f32", "--accel", "dual-split"],
            ]
            .concat(),
        );
        assert_eq!(content(&browser, "explanation").trim(), explained.trim());
        browser.script(
            "document.getElementById('memory').textContent = '';
             document.getElementById('board').dispatchEvent(new Event('change'))",
        );
        browser.wait("document.getElementById('memory').textContent.includes('dual-split')");
        for keys in [RIGHT, "r"] {
            browser.script(
                "document.documentElement.dataset.state = 'wait';
                 document.getElementById('error-close').click();
                 document.getElementById('canvas').focus()",
            );
            browser.keys(&[keys]);
            settle(&browser);
            assert_eq!(shown(&browser) == first, keys == "r");
        }
    };
    for name in ["broken.toml", "short.gridel"] {
        open(page, &browser, name);
        browser.wait(failed);
        assert!(content(&browser, "error-text").contains(name));
        all_is_there();
    }
    // One right after another, and while a scene is opened.
    let other = "const samples = document.getElementById('sample');
        samples.value = 'quick.toml';
        samples.dispatchEvent(new Event('change'))";
    browser.script(other);
    open(page, &browser, "broken.toml");
    open(page, &browser, "short.gridel");
    browser.wait(failed);
    all_is_there();

    // After a file of one's own, the sample can be chosen again.
    page.files.write(
        "ball.toml",
        b"[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    open(page, &browser, "ball.toml");
    settle(&browser);
    assert!(shown(&browser) != first);
    // It has no light, so the program would place one by the camera that is moved.
    let is_noted = "return !document.getElementById('camera-note').hidden";
    assert_eq!(browser.text(is_noted), "true");
    choose(&browser, "sample", "quick.toml");
    assert_eq!(browser.text(is_noted), "false");
    assert!(shown(&browser) == first);
    assert_no_message(&browser);
}

pub fn compiling_stops(page: &Page) {
    let browser = page.open();
    let first = shown(&browser);
    browser.script(
        "window.begun = 0;
         window.Worker = class extends Worker {
           constructor(name) { super(name); window.begun += 1; }
         }",
    );
    let set = |id: &str, value: &str| {
        browser.script(&format!(
            "document.documentElement.dataset.state = 'wait';
             const it = document.getElementById('{id}');
             it.value = '{value}';
             it.dispatchEvent(new Event('change', {{ bubbles: true }}))"
        ));
    };
    let begun = || browser.text("return window.begun");
    let slow = || {
        set("structure", "cylinder-cube-entry");
        browser.wait("document.getElementById('status').textContent.startsWith('Compiling')");
    };
    // Another structure, and what waits for it.
    slow();
    browser.script("document.getElementById('explain').click()");
    let status = content(&browser, "status");
    let waits = "The pixel will be explained when the scene is compiled";
    assert!(status.contains(waits), "{status}");
    set("structure", "dual-split");
    settle(&browser);
    assert_eq!(begun(), "1");
    assert!(shown(&browser) == first);
    browser.wait("!document.getElementById('explanation').hidden");
    let setting = ["--format", "f32", "--accel", "dual-split"];
    let explain = ["explain", "glass-chess.toml", "--pixel", "0,0"];
    let explained = page.files.done(&[&explain[..], &setting].concat());
    assert_eq!(content(&browser, "explanation").trim(), explained.trim());

    // Another scene: what waits for the first one is given up.
    slow();
    for button in ["explain", "save-blob"] {
        browser.script(&format!("document.getElementById('{button}').click()"));
    }
    browser.script("document.getElementById('summary').textContent = ''");
    choose(&browser, "sample", "quick.toml");
    assert_eq!(begun(), "2");
    assert!(shown(&browser) == page.rendered(&[&["quick.toml"][..], &setting].concat()));
    assert!(content(&browser, "summary").starts_with("Click"));
    let status = content(&browser, "status");
    assert!(!status.contains("will be"), "{status}");

    // One that cannot be opened: the scene before is shown again.
    choose(&browser, "sample", "glass-chess.toml");
    slow();
    page.files
        .write("broken.toml", b"[[object]]\nkind = 'none'\n");
    open(page, &browser, "broken.toml");
    browser.wait("!document.getElementById('error').hidden");
    assert_eq!(begun(), "3");
    set("structure", "dual-split");
    settle(&browser);
    assert!(shown(&browser) == first);
    assert_no_message(&browser);
}
