//! Materials and textures.

use super::*;

fn material(text: &str) -> (Material, Vec<String>) {
    let mut warnings = Warnings::default();
    let source = Source::from_bytes(Path::new("t.mtl"), text.into());
    let access = Access::of(Path::new("t.mtl"), false);
    let mut images = Images::new(&access);
    let mut all = mtl::read(&source, &mut images, &mut warnings).unwrap();
    (all.remove(0).1, warnings.into_sentences())
}

#[test]
fn materials_take_color_mirror_and_glass_from_mtl() {
    let (plain, warnings) =
        material("newmtl my red #2\nKd 1 0 .5\nKs .2 # gray\nNs 96.08\nillum 2\nKe 0 0 0\n");
    assert_eq!(warnings, [] as [&str; 0]);
    assert_eq!(plain.name, "my red #2");
    assert_eq!(plain.diffuse, Diffuse::Plain([1.0, 0.0, 0.5]));
    assert_eq!(
        (plain.highlight, plain.shininess, plain.mirror),
        ([0.2; 3], 96, [0.0; 3])
    );
    assert_eq!(plain.transmit, [0.0; 3]);

    let (mirror, _) = material("newmtl a\nKs .9 .8 .7\nillum 3\n");
    assert_eq!(mirror.mirror, [0.9, 0.8, 0.7]);

    let (glass, _) = material("newmtl a\nKd 1 1 1\nillum 7\nNi 1.5\nTf .9 1 .9\nd 1\n");
    assert_eq!((glass.transmit, glass.ior), ([0.9, 1.0, 0.9], 1.5));
    assert_eq!(glass.diffuse, Diffuse::Plain([0.0; 3]));

    // What many programs write for opaque materials; glass is what is said to be.
    let opaque = "newmtl a\nillum 4\nKd .8 .2 .2\nTf 1 1 1\n";
    for (rest, transmits) in [
        ("Ni 1", 0.0),
        ("d 1", 0.0),
        ("Tr 0\nNi 1.5", 0.0),
        ("", 0.0),
        ("Ni 1.5", 1.0),
        ("d .25\nNi 1.5", 0.75),
    ] {
        for illumination in ["illum 4", "illum 9"] {
            let text = opaque.replace("illum 4", illumination) + rest + "\n";
            let (made, _) = material(&text);
            assert_eq!(made.transmit, [transmits; 3], "{text}");
            let diffuse = [0.8, 0.2, 0.2].map(|it| it * (1.0 - transmits));
            assert_eq!(made.diffuse, Diffuse::Plain(diffuse), "{text}");
        }
    }

    let (pane, _) = material("newmtl a\nKd 1 1 1\nd -halo .25\nNi 1.45\n");
    assert_eq!((pane.transmit, pane.ior), ([0.75; 3], 1.0));

    let (opaque, warnings) = material("newmtl a\nTr 1\nillum 1\nKs 1 1 1\nmap_Kd a.jpg\n");
    assert_eq!((opaque.transmit, opaque.highlight), ([0.0; 3], [0.0; 3]));
    assert_eq!(warnings.len(), 2);
}

#[test]
fn numbers_out_of_range_are_limited_with_a_warning() {
    let (limited, warnings) = material("newmtl a\nKs 1 1 1\nillum 2\nNs 2000\nd 2\nTr -0.5\n");
    assert_eq!(limited.shininess, 1024);
    assert_eq!(limited.transmit, [0.0; 3]);
    let expected = [
        "t.mtl:4: Ns is limited to the range 0 to 1024",
        "t.mtl:5: d is limited to the range 0 to 1",
        "t.mtl:6: Tr is limited to the range 0 to 1",
    ];
    assert_eq!(warnings, expected);
}

#[test]
fn material_faults_name_their_own_file() {
    let fault = |text: &str| {
        let source = Source::from_bytes(Path::new("t.mtl"), text.into());
        let access = Access::of(Path::new("t.mtl"), false);
        let mut images = Images::new(&access);
        mtl::read(&source, &mut images, &mut Warnings::default())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(fault("newmtl a\nKd .5 .5\n"), "t.mtl:2: Kd has 2 numbers");
    assert_eq!(fault("newmtl a\nNs\n"), "t.mtl:2: Ns has no value");
    assert_eq!(
        fault("newmtl a\nd x\n"),
        "t.mtl:2: the value of d is \"x\", which is not a number"
    );
}

#[test]
fn a_missing_material_file_is_a_warning() {
    let warnings = read(&format!("mtllib no such file.mtl\n{CORNERS}f 1 2 3\n"))
        .unwrap()
        .warnings;
    assert_eq!(warnings.len(), 3);
    assert!(
        warnings[0].starts_with("t.obj:1: the material file \"no\" cannot be read"),
        "{}",
        warnings[0]
    );
}

/// A square with a material file of one material, and a texture of two by one texels.
fn textured(faces: &str, material: &str) -> Result<Imported, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.obj");
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0\n";
    let text = format!("mtllib t.mtl\n{corners}usemtl m\n{faces}");
    std::fs::write(&path, text).unwrap();
    std::fs::write(
        folder.path().join("t.mtl"),
        format!("newmtl m\n{material}\n"),
    )
    .unwrap();
    let pixels = [[255, 0, 0, 255], [0, 0, 255, 255]];
    let image = crate::scene::image::tests::png_of(2, 1, &pixels);
    for name in ["two colors.png", "wood # 2.png"] {
        std::fs::write(folder.path().join(name), &image).unwrap();
    }
    for broken in ["broken.png", "it cannot be read.png"] {
        std::fs::write(folder.path().join(broken), "PNG").unwrap();
    }
    load(&path)
}

#[test]
fn textures_are_read_with_their_options() {
    let square = "f 1/1 2/2 3/3 4/4\n";
    let plain = textured(square, "map_Kd two colors.png").unwrap();
    let (object, material) = (&plain.scene.objects[0], &plain.scene.materials[0]);
    assert_eq!(material.diffuse, Diffuse::Plain([1.0; 3]));
    let texture = material.texture.as_ref().unwrap();
    assert_eq!((texture.image.size(), texture.bilinear), ([2, 1], true));
    assert_eq!(texture.wrap, [Wrap::Repeat; 2]);
    // v points up in the file, and down here.
    let placed = object.attributes.placed_on(Some(texture));
    let found: Vec<_> = placed.coordinates.iter().map(|it| it.to_array()).collect();
    assert_eq!(found, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(placed.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(plain.warnings, [] as [&str; 0]);

    let statement = "Kd .5 .5 .5\nmap_Kd -s 2 3 1 -clamp on -o 0.25 0.5 -bm 1 two colors.png";
    let placed = textured(square, statement).unwrap();
    let material = &placed.scene.materials[0];
    assert_eq!(material.diffuse, Diffuse::Plain([0.5; 3]));
    let texture = material.texture.as_ref().unwrap();
    assert_eq!(texture.wrap, [Wrap::Clamp; 2]);
    let attributes = placed.scene.objects[0].attributes.placed_on(Some(texture));
    // u becomes 2 u + 0.25; v, upwards, 3 v + 0.5.
    let corner = attributes.coordinates[2];
    assert!(
        (corner - DVec2::new(2.25, 1.0 - 3.5)).length() < 1e-12,
        "{corner}"
    );
    assert_eq!(placed.warnings.len(), 1);
    assert!(placed.warnings[0].ends_with("the option -bm of a texture is ignored"));
}

#[test]
fn comments_behind_names_of_textures_are_cut() {
    let square = "f 1/1 2/2 3/3 4/4\n";
    for name in [
        "two colors.png # oak",
        "two colors.png\t#1 # 2",
        "wood # 2.png",
    ] {
        let imported = textured(square, &format!("map_Kd -clamp on {name}")).unwrap();
        assert_eq!(imported.warnings, [] as [&str; 0], "{name}");
        assert!(imported.scene.materials[0].texture.is_some(), "{name}");
    }
    let missing = textured(square, "map_Kd none.png # oak").unwrap();
    let [warning] = &missing.warnings[..] else {
        panic!("{:?}", missing.warnings);
    };
    assert!(warning.contains("none.png cannot be read"), "{warning}");
}

#[test]
fn normal_maps_lie_as_map_kd_does() {
    let square = "f 1/1 2/2 3/3 4/4\n";
    let alone = textured(square, "norm -s 2 2 two colors.png").unwrap();
    let material = &alone.scene.materials[0];
    let map = material.normal_map.as_ref().unwrap();
    assert_eq!((map.scale, &material.texture), (1.0, &None));
    let placed = alone.scene.objects[0]
        .attributes
        .placed_on(material.placing());
    // v points up in the file, and down here.
    assert_eq!(placed.coordinates[1].to_array(), [2.0, 1.0]);
    assert_eq!(alone.warnings, [] as [&str; 0]);
    let both = textured(square, "map_Kd two colors.png\nnorm two colors.png").unwrap();
    assert!(both.scene.materials[0].normal_map.is_some());
    let apart = textured(square, "map_Kd two colors.png\nnorm -s 2 2 two colors.png").unwrap();
    assert_eq!(apart.scene.materials[0].normal_map, None);
    assert!(apart.warnings[0].contains("other options than map_Kd"));
}

#[test]
fn faces_without_texture_coordinates_have_none() {
    let faces = "f 1/1 2/2 3/3\nf 1 3 4\nf 1/1 2/2 3/9\nf -4/-4 -2/-2 -1/-1\n";
    let imported = textured(faces, "map_Kd two colors.png").unwrap();
    let attributes = &imported.scene.objects[0].attributes;
    let none = Attributes::NONE;
    assert_eq!(attributes.triangles, [[0, 1, 2], none, none, [3, 4, 5]]);
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings);
    };
    assert!(
        warning.ends_with(
            "t.obj:13: a face has texture coordinates that the file lacks, and no texture"
        ),
        "{warning}"
    );
}

#[test]
fn textures_that_cannot_be_read_are_named() {
    let square = "f 1/1 2/2 3/3 4/4\n";
    let missing = textured(square, "Kd .5 .5 .5\nmap_Kd none.png").unwrap();
    assert_eq!(missing.scene.materials[0].texture, None);
    let [warning] = &missing.warnings[..] else {
        panic!("{:?}", missing.warnings);
    };
    assert!(
        warning.contains("t.mtl:3") && warning.contains("none.png"),
        "{warning}"
    );
    for (statement, expected) in [
        ("map_Kd broken.png", "is neither PNG nor JPEG"),
        ("map_Kd it cannot be read.png", "is neither PNG nor JPEG"),
        ("map_Kd ../two.png", "outside of the scene's folder"),
        ("map_Kd", "names no file"),
    ] {
        let error = textured(square, statement).unwrap_err().to_string();
        assert!(
            error.contains("t.mtl:2") && error.contains(expected),
            "{error}"
        );
    }
}

/// Programs write `Ke 1 1 1` wherever there is a texture.
#[test]
fn map_ke_weights_ke_by_its_mean_as_light() {
    let square = "f 1/1 2/2 3/3 4/4\n";
    for statements in [
        "Ke 1 1 .5\nmap_Ke two colors.png",
        "map_Ke -s 2 2 two colors.png\nKe 1 1 .5",
    ] {
        let made = textured(square, statements).unwrap();
        assert_eq!(made.scene.materials[0].emission, [0.5, 0.0, 0.25]);
        let [warning] = &made.warnings[..] else {
            panic!("{:?}", made.warnings);
        };
        assert!(
            warning.ends_with("map_Ke is not drawn; its mean is taken, and weights Ke"),
            "{warning}"
        );
    }
    for (statements, expected) in [
        ("Ke 1 1 1\nmap_Ke none.png", "the material does not glow"),
        ("map_Ke none.png", "because Ke is 0 or missing"),
        ("Ke 0\nmap_Ke broken.png", "because Ke is 0 or missing"),
    ] {
        let made = textured(square, statements).unwrap();
        assert_eq!(made.scene.materials[0].emission, [0.0; 3]);
        assert!(made.warnings[0].ends_with(expected), "{:?}", made.warnings);
    }
    let error = textured(square, "Ke 1 1 1\nmap_Ke broken.png").unwrap_err();
    let error = error.to_string();
    assert!(
        error.contains("t.mtl:3") && error.contains("neither PNG nor JPEG"),
        "{error}"
    );
}

#[test]
fn mirrors_and_glass_may_be_rough() {
    for (rough, taken) in [(0.5, 0.5), (0.01, 0.0), (2.0, 1.0)] {
        let (mirror, _) = material(&format!("newmtl a\nKs .5\nillum 3\nPr {rough}\n"));
        assert_eq!((mirror.mirror, mirror.roughness), ([0.5; 3], taken));
        assert_eq!(mirror.is_rough(), taken > 0.0);
    }
    assert!(!material("newmtl a\nKd .5\nPr .5\n").0.is_rough());
}

#[test]
fn numbers_out_of_range_or_not_in_use_are_warned_of() {
    for (text, warning) in [
        (
            "illum 3\nKs 1 1 1\nPr 7",
            "Pr is limited to the range 0 to 1",
        ),
        (
            "illum 3\nKs 1 1 1\nPr -5",
            "Pr is limited to the range 0 to 1",
        ),
        (
            "Pr 0.5",
            "Pr is ignored, because the material neither mirrors nor lets light through",
        ),
        ("illum 99", "illum 99 is none of 0 to 10, and is read as 2"),
        ("illum -3", "illum -3 is none of 0 to 10, and is read as 2"),
        (
            "illum 2.7",
            "illum 2.7 is none of 0 to 10, and is read as 2",
        ),
        (
            "d -halo 0.5",
            "\"-halo\" is ignored: the last value of d is taken",
        ),
        (
            "Ns 10 20",
            "\"10\" is ignored: the last value of Ns is taken",
        ),
        (
            "Kd 1 1 1\nnewmtl a",
            "the material \"a\" is defined again; the last one is used",
        ),
    ] {
        let (_, warnings) = material(&format!("newmtl a\n{text}\n"));
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].ends_with(warning), "{warnings:?}");
    }
    for text in [
        "illum 3\nKs 1 1 1\nPr 0.5",
        "d 0.5\nPr 0.5",
        "illum 10",
        "Ns 10 # 20",
    ] {
        let (_, warnings) = material(&format!("newmtl a\n{text}\n"));
        assert_eq!(warnings, [] as [&str; 0], "{text}");
    }
}

#[test]
fn options_of_textures_are_finite() {
    for word in ["nan", "inf", "-infinity"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.obj");
        let library = format!("newmtl a\nmap_Kd -o 0 {word} a.png\n");
        std::fs::write(folder.path().join("t.mtl"), library).unwrap();
        std::fs::write(&path, format!("mtllib t.mtl\n{CORNERS}f 1 2 3\n")).unwrap();
        let error = load(&path).unwrap_err();
        let cause = format!(
            "a number of the option -o of map_Kd is {word:?}, which is not a finite number"
        );
        assert_eq!((error.cause, error.line), (cause, Some(2)));
    }
}

#[test]
fn material_files_are_limited_and_named_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.obj");
    let write = |libraries: &str| {
        std::fs::write(&path, format!("{libraries}{CORNERS}f 1 2 3\n")).unwrap();
        load(&path)
    };
    std::fs::write(folder.path().join("t.mtl"), "#".repeat(10_000_001)).unwrap();
    assert_eq!(
        write("mtllib t.mtl\n").unwrap_err().cause,
        "the material files have more than 10,000,000 bytes of text"
    );
    std::fs::write(folder.path().join("t.mtl"), "").unwrap();
    let start = std::time::Instant::now();
    assert!(write(&"mtllib t.mtl\n".repeat(500_000)).is_ok());
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
    let many: String = (0..2000).map(|it| format!("mtllib {it}\n")).collect();
    let error = write(&many).unwrap_err();
    assert_eq!(error.cause, "the file names more than 1000 material files");
}

#[test]
fn statements_that_bring_other_files_are_warned_of() {
    for (statement, keyword) in [("call big.obj", "call"), ("csh ls", "csh")] {
        let imported = read(&format!("{CORNERS}f 1 2 3\n{statement}\n")).unwrap();
        let warning =
            format!("t.obj:6: what `{keyword}` brings, from a file or a program, is not read");
        assert_eq!(imported.warnings, [warning]);
    }
}
