//! Names that come twice, numbers that are not finite, and files that are too large.

use super::*;
use ply_rs_bw::ply::Encoding;

#[test]
#[rustfmt::skip]
fn doubled_names_of_elements_and_properties_are_rejected_with_their_line() {
    let text = |from: &str, to: &str| SQUARE.replacen(from, to, 1);
    for (text, expected) in [
        (text("property uchar red", "property uchar x"), "thing.ply:8: the header announces another property \"x\"; the first is in line 5"),
        (text("property int spokes", "property int a\nproperty list uchar int a"), "thing.ply:13: the header announces another property \"a\"; the first is in line 12"),
        (text("element wheel 1", "element face 1"), "thing.ply:11: the header announces another element \"face\"; the first is in line 9"),
        (text("element wheel 1", "element vertex 1"), "thing.ply:11: the header announces another element \"vertex\"; the first is in line 4"),
    ] {
        rejects(&text, expected);
    }
    // Another element may have a property of the same name.
    assert!(read(text("property int spokes", "property int x").as_bytes()).is_ok());
}

#[test]
fn numbers_that_are_not_finite_are_counted_and_the_others_are_used() {
    let channels = ["red", "green", "blue"].map(|it| format!("property float {it}\n"));
    let text = with_properties(&channels.concat(), "").replace("comment TextureFile a.png\n", "");
    let rows = "0 0 0 1 0 0\n1 0 0 0 nan 0\n0 1 0 0 inf 1\n3 0 1 2\n";
    let imported = read((text + rows).as_bytes()).unwrap();
    let colors = &imported.scene.objects[0].attributes.colors;
    assert_eq!(*colors, [[1.0, 0.0, 0.0], [1.0; 3], [1.0; 3]]);
    assert_eq!(
        imported.warnings,
        [
            "thing.ply: 2 vertices, of which vertex 1 (from 0) is the first, have colors with numbers \
             that are not finite; white is used"
        ]
    );

    let components = ["nx", "ny", "nz"].map(|it| format!("property float {it}\n"));
    let text = with_properties(&components.concat(), "")
        .replace("comment TextureFile a.png\n", "")
        .replace("vertex 3", "vertex 4")
        .replace("face 1", "face 2");
    let rows = "0 0 0 0 0 1\n1 0 0 0.5 0 1\n0 1 0 0 0.5 1\n1 1 0 0 nan 1\n3 0 1 2\n3 2 1 3\n";
    let imported = read((text + rows).as_bytes()).unwrap();
    let normals = &imported.scene.objects[0].normals;
    assert_eq!(normals.triangles, [[0, 1, 2], Normals::FLAT]);
    assert_eq!(
        imported.warnings,
        [
            "thing.ply: vertex 3 (from 0) has normals with numbers that are not finite; faces that \
             have them are shaded flat"
        ]
    );
}

/// Reads the faces of a file that takes all memory but that of three triangles.
fn read_faces(format: &str, faces: usize, bytes: &[u8]) -> Result<Vec<Face>, SceneError> {
    let header = format!(
        "ply\nformat {format} 1.0\nelement face {faces}\nproperty list uchar uchar vertex_indices\n\
         end_header\n"
    );
    let bytes = [header.as_bytes(), bytes].concat();
    let path = Path::new("thing.ply");
    let mut reader = Reader::new(&bytes[..]);
    let mut warnings = Warnings::default();
    let header = header::read(path, &bytes, &mut reader, &mut warnings)?;
    assert_eq!(header.encoding == Encoding::Ascii, format == "ascii");
    let mut payload = Payload::new(path, header.encoding, reader);
    payload.size.triangles = crate::scene::size::MOST_PRIMITIVES;
    assert_eq!(payload.size.excess(), None);
    while payload.size.excess().is_none() {
        payload.size.triangles += 1;
    }
    payload.size.triangles -= 4;
    let triangles = |face: &Face| face.len().saturating_sub(2);
    payload.read(&header.elements["face"], &header, triangles)
}

#[test]
fn faces_are_limited_while_they_are_read() {
    let binary = [[4, 0, 1, 2, 3], [4, 0, 1, 2, 3]].concat();
    for (format, bytes) in [
        ("binary_little_endian", &binary[..]),
        ("ascii", b"4 0 1 2 3\n4 0 1 2 3\n"),
    ] {
        assert_eq!(read_faces(format, 1, bytes).unwrap()[0].len(), 4);
        let error = read_faces(format, 2, bytes).unwrap_err();
        let begins = "up to face 1 (from 0) the file takes about 3.8 GB of memory";
        assert!(error.cause.starts_with(begins), "{error}");
    }
}

/// Elements are read some thousands at once.
#[test]
fn binary_elements_keep_their_numbers_beyond_those_that_are_read_at_once() {
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 9000\nproperty uchar x\n\
                  property uchar y\nproperty uchar z\nelement face 1\n\
                  property list uchar ushort vertex_indices\nend_header\n";
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend((0..9000_u32).flat_map(|it| [it as u8, (it >> 8) as u8, 0]));
    let vertices = bytes.len();
    bytes.push(3);
    bytes.extend([1_u16, 5000, 8999].into_iter().flat_map(u16::to_le_bytes));
    let imported = read(&bytes).unwrap();
    let (points, triangles) = mesh(&imported.scene.objects[0]);
    assert_eq!(triangles, [[1, 5000, 8999]]);
    assert_eq!(points[8999], DVec3::new(39.0, 35.0, 0.0));
    let error = read(&bytes[..vertices - 1]).unwrap_err();
    assert_eq!(
        error.cause,
        "the file ends behind 8999 of 9000 elements \"vertex\""
    );
}

#[test]
fn corners_take_no_more_memory_than_in_the_file() {
    let bytes = [&[255][..], &[0; 255]].concat();
    let face = &read_faces("binary_little_endian", 1, &[3, 0, 1, 2]).unwrap()[0];
    assert!(matches!(&face.0, Some(Property::ListUChar(list)) if list.capacity() <= 8));
    assert!(read_faces("binary_little_endian", 1, &bytes).is_err());
}
