//! The container of a binary file, and buffers in files of their own.

use super::*;

/// The header and the chunks of a binary file, each with a fault of its own.
#[test]
fn faults_of_the_container_are_named() {
    let whole = binary();
    let text = u32::from_le_bytes(*whole[12..].first_chunk().unwrap()) as usize;
    let second = 20 + text;
    let with = |at: usize, bytes: &[u8]| {
        let mut file = whole.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    let length = whole.len() as u32;
    let cut = |to: usize| {
        let mut file = whole[..to].to_vec();
        file[8..12].copy_from_slice(&(to as u32).to_le_bytes());
        file
    };
    let twice = {
        let mut file = [&whole[..], &whole[second..]].concat();
        let length = file.len() as u32;
        file[8..12].copy_from_slice(&length.to_le_bytes());
        file
    };
    for (file, expected) in [
        (
            b"glTF".to_vec(),
            "the file ends inside its header: it has 4 of 12 bytes",
        ),
        (Vec::new(), "the file is empty"),
        (b"\xef\xbb\xbf \n".to_vec(), "the file is empty"),
        (
            with(0, b"glTG"),
            "begins with the bytes 67 6c 54 47, not with `glTF`",
        ),
        (
            with(4, &[3]),
            "binary glTF of version 3; version 2 is required",
        ),
        (with(8, &(length - 8).to_le_bytes()), "the header announces"),
        (with(8, &(length + 8).to_le_bytes()), "the header announces"),
        (
            with(12, &u32::MAX.to_le_bytes()),
            "chunk 0 (from 0) announces 4294967295 bytes",
        ),
        (
            with(second, &(61_u32).to_le_bytes()),
            "chunk 1 (from 0) announces 61 bytes, and 60 follow",
        ),
        (
            with(16, b"TEXT"),
            "the first chunk is of the type \"TEXT\"; it must be JSON",
        ),
        (
            cut(second + 5),
            "the file ends inside the header of chunk 1",
        ),
        (cut(12), "the file has no chunk"),
        (twice, "a second one of the type BIN"),
        (
            with(20, b"["),
            "the JSON is broken: invalid type: string \"accessors\"",
        ),
        (with(20, b"["), "(line 1, column 12 of the JSON chunk)"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("thing.glb");
        std::fs::write(&path, file).unwrap();
        let error = load(&path).unwrap_err();
        assert!(error.cause.contains(expected), "{expected}: {error}");
        assert!(!error.remedy.is_empty());
    }
}

#[test]
fn data_uris_are_read_in_capital_letters_and_with_escapes() {
    let mut document = document();
    let escaped = STANDARD.encode(square()).replace('A', "%41");
    let whole = document["buffers"][0]["uri"].as_str().unwrap().to_owned();
    for uri in [
        format!("data:application/octet-stream;base64,{escaped}"),
        whole.replace("data:", "DATA:"),
        whole.replace("base64", "BASE64"),
        whole.replace("application/octet-stream", ""),
    ] {
        document["buffers"][0]["uri"] = json!(uri);
        assert_eq!(scene(&document).objects.len(), 1, "{uri}");
    }
    // Signs that are often escaped.
    let path = Path::new("a.gltf");
    let uri = "Data:;base64,%2B%2F%2f%2B%2Fw%3D%3D";
    let found = buffers::fetch(path, "buffer 0", uri, &Access::of(path, false));
    assert_eq!(found.unwrap(), [0xfb, 0xff, 0xfe, 0xff]);
    document["buffers"][0]["uri"] = json!(format!("data:x;base64,{}", "=".repeat(1000)));
    let cause = cause(&document);
    assert!(
        cause.contains("not in base 64: \"data:x;base64,==="),
        "{cause}"
    );
    assert!(cause.len() < 200, "{cause}");
}

#[test]
fn buffers_outside_of_the_folder_are_rejected() {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("scene");
    std::fs::create_dir(&folder).unwrap();
    let secret = outer.path().join("secret.bin");
    std::fs::write(&secret, square()).unwrap();
    std::fs::write(folder.join("near.bin"), square()).unwrap();
    let path = folder.join("thing.gltf");
    let write = |uri: &str| {
        let mut document = document();
        document["buffers"][0]["uri"] = json!(uri);
        std::fs::write(&path, document.to_string()).unwrap();
    };
    let absolute = secret.display().to_string();
    for uri in [
        "../secret.bin",
        "%2e%2e/secret.bin",
        "%2E%2E%2Fsecret.bin",
        "./x/../../secret.bin",
        "..%5Csecret.bin",
        &absolute,
        &format!("file://{absolute}"),
        &format!("file://localhost{absolute}"),
        "/etc/passwd",
        "C:\\secret.bin",
    ] {
        write(uri);
        let error = load(&path).unwrap_err();
        assert!(
            error.cause.contains("outside of the scene's folder"),
            "{uri}: {error}"
        );
        assert!(error.remedy.contains("--allow-outside"), "{uri}");
    }
    for uri in [
        "../secret.bin",
        "%2e%2e/secret.bin",
        &absolute,
        &format!("file://{absolute}"),
    ] {
        write(uri);
        let imported = load_allowing_outside(&path);
        assert_eq!(imported.unwrap().scene.objects.len(), 1, "{uri}");
    }
    for uri in ["near.bin", "./near.bin", "%6eear.bin"] {
        write(uri);
        assert_eq!(load(&path).unwrap().scene.objects.len(), 1, "{uri}");
    }
}
