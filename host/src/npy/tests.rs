//! Array files, whole and broken.

use super::*;

/// A file as `numpy.save` writes it.
fn file(header: &str, data: &[u8]) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    let text = format!("{header:<117}\n");
    file.extend((text.len() as u16).to_le_bytes());
    file.extend(text.as_bytes());
    file.extend(data);
    file
}

fn header(element: &str, fortran: &str, shape: &str) -> String {
    format!("{{'descr': {element}, 'fortran_order': {fortran}, 'shape': {shape}, }}")
}

fn expected() -> Vec<SceneRay> {
    let ray = |first: f64| SceneRay {
        origin: DVec3::new(first, first + 1.0, first + 2.0),
        tmin: first + 3.0,
        direction: DVec3::new(first + 4.0, first + 5.0, first + 6.0),
        tmax: first + 7.0,
    };
    vec![ray(0.0), ray(8.0)]
}

#[test]
fn all_orders_and_types_read_alike() {
    let c_order: Vec<f64> = (0..16).map(f64::from).collect();
    let fortran: Vec<f64> = (0..16).map(|k| f64::from(8 * (k % 2) + k / 2)).collect();
    let bytes = |values: &[f64], to: fn(f64) -> Vec<u8>| -> Vec<u8> {
        values.iter().flat_map(|&value| to(value)).collect()
    };
    type ToBytes = fn(f64) -> Vec<u8>;
    let types: [(&str, ToBytes); 4] = [
        ("'<f8'", |x| x.to_le_bytes().to_vec()),
        ("'>f8'", |x| x.to_be_bytes().to_vec()),
        ("'<f4'", |x| (x as f32).to_le_bytes().to_vec()),
        ("'>f4'", |x| (x as f32).to_be_bytes().to_vec()),
    ];
    for (element, to) in types {
        for (order, values) in [("False", &c_order), ("True", &fortran)] {
            let file = file(&header(element, order, "(2, 8)"), &bytes(values, to));
            assert_eq!(read_rays(&file).unwrap(), expected(), "{element} {order}");
        }
    }
}

#[test]
fn headers_read_in_any_form_that_python_writes() {
    for text in [
        "{'descr': '<f4', 'fortran_order': False, 'shape': (0, 8)}",
        "{\"shape\":[0,8,],\"descr\":\"<f4\",\"fortran_order\":True}",
        " { 'fortran_order' : False , 'shape' : ( 0 , 8 , ) , 'descr' : '<f4' , } ",
    ] {
        assert_eq!(read_rays(&file(text, &[])).unwrap(), [], "{text}");
    }
}

#[test]
fn no_rays_are_an_array_too() {
    let file = file(&header("'<f4'", "False", "(0, 8)"), &[]);
    assert_eq!(read_rays(&file).unwrap(), []);
}

#[test]
fn foreign_arrays_are_named() {
    let read = |element: &str, shape: &str| {
        let file = file(&header(element, "False", shape), &[0; 128]);
        read_rays(&file).unwrap_err().to_string()
    };
    let types = ["'<i8'", "'<f2'", "'<c16'", "'|O'", "'<f16'"];
    for element in types {
        let message = read(element, "(2, 8)");
        let name = element.trim_matches('\'');
        assert_eq!(
            message,
            format!("its elements are of type {name}, not float32 or float64")
        );
    }
    for shape in [
        "(16,)",
        "(8, 2)",
        "(2, 8, 1)",
        "()",
        "(4294967296, 4294967296)",
    ] {
        let message = read("'<f8'", shape);
        assert_eq!(message, format!("its shape is {shape}, not (N, 8)"));
    }
    // 2^61 rows and 2^60: the bytes are no number of 64 bits.
    for shape in ["(2305843009213693952, 8)", "(1152921504606846976, 8)"] {
        let message = read("'<f8'", shape);
        let expected = format!("its shape is {shape}, which is more than a file holds");
        assert_eq!(message, expected);
    }
    assert!(read("[('a', '<f8')]", "(16,)").contains("no array of plain numbers"));
    assert_eq!(
        read("'<f8'", "(3, 8)"),
        "it has 128 bytes of rays where its header promises 192"
    );
    assert!(read("'<f8'", "(1, 8)").contains("promises 64"));
}

#[test]
fn hostile_headers_are_rejected() {
    let nested = format!("{}1{}", "(".repeat(5000), ")".repeat(5000));
    for shape in [
        nested.as_str(),
        "(0xffffffffffff, 0xffffffffffff, 8)",
        "(99999999999999999999999, 8)",
        "(-1, 8)",
        "(None, 8)",
        "8",
    ] {
        let file = file(&header("'<f8'", "False", shape), &[]);
        let error = read_rays(&file).unwrap_err();
        assert!(matches!(error, RaysError::Header { .. }), "{error}");
    }
    let whole = header("'<f8'", "False", "(0, 8)");
    for text in [
        whole.replace("'shape'", "'form'"),
        whole.replace("'shape': (0, 8), ", ""),
        whole.replace("'shape'", "'descr': '<f8', 'shape'"),
        whole.replace("False", "0"),
        whole.replace("(0, 8), ", "(0, 8) 1"),
        whole.replace("(0, 8)", "(0,, 8)"),
        whole.replace("(0, 8)", "(0, 8"),
        whole.replace("(0, 8)", "(0, +8)"),
        whole.replace("'<f8'", "'<f8"),
        whole.replace("'<f8'", "'<f\\x38'"),
        whole.clone() + "1",
        String::new(),
    ] {
        let error = read_rays(&file(&text, &[])).unwrap_err();
        assert!(matches!(error, RaysError::Header { .. }), "{text}: {error}");
    }
    // 2^60 rays would be 2^66 bytes.
    let file = file(&header("'<f8'", "False", "(1152921504606846976, 8)"), &[]);
    assert!(read_rays(&file).is_err());
}

#[test]
fn every_truncation_is_an_error() {
    let whole = file(&header("'<f8'", "False", "(2, 8)"), &[0; 128]);
    assert!(read_rays(&whole).is_ok());
    for length in 0..whole.len() {
        assert!(read_rays(&whole[..length]).is_err(), "{length} bytes");
    }
    for version in [0_u8, 4, 9, 255] {
        let mut other = whole.clone();
        other[6] = version;
        assert!(read_rays(&other).is_err(), "version {version}");
    }
    // Lengths of 32 bits that promise gigabytes.
    let mut long = b"\x93NUMPY\x02\x00\xff\xff\xff\xff".to_vec();
    long.extend(&whole[10..]);
    assert!(read_rays(&long).is_err());
}

#[test]
fn pixels_go_row_by_row() {
    let vectors = Values::Vectors(vec![[1.0, 2.0, 3.0], [4.0, 5.0, f32::INFINITY]]);
    let mut file = Vec::new();
    write_pixels(&mut file, [1, 2], &vectors).unwrap();
    let (found, data) = super::header(&file).unwrap();
    assert_eq!((found.element, found.fortran_order), ("<f4", false));
    assert_eq!(found.shape, [2, 1, 3]);
    assert_eq!((file.len() - data.len()) % 64, 0);
    let numbers = data.chunks(4).map(|bytes| f32::from_le_bytes(array(bytes)));
    assert!(numbers.eq([1.0, 2.0, 3.0, 4.0, 5.0, f32::INFINITY]));
    let mut file = Vec::new();
    write_pixels(&mut file, [2, 1], &Values::Lengths(vec![0.5, 8.0])).unwrap();
    assert_eq!(super::header(&file).unwrap().0.shape, [1, 2]);
}

#[test]
fn hits_are_packed() {
    let hit = SceneHit {
        t: 1.5,
        object: 2,
        primitive: 3,
        instance: 7,
        normal: [0.0, -1.0, 0.5],
    };
    let mut file = Vec::new();
    write_hits(&mut file, &[hit, SceneHit::MISS], false).unwrap();
    let data = &file[file.len() - 56..];
    assert_eq!(data[..8], 1.5_f64.to_le_bytes());
    assert_eq!(data[8..12], 2_u32.to_le_bytes());
    assert_eq!(data[12..16], 3_u32.to_le_bytes());
    assert_eq!(data[20..24], (-1.0_f32).to_le_bytes());
    assert_eq!(data[28..36], f64::INFINITY.to_le_bytes());
    assert_eq!(data[36..44], [0xff; 8]);
    let header = String::from_utf8_lossy(&file[10..file.len() - 56]);
    for field in ["'t', '<f8'", "'object', '<u4'", "'primitive', '<u4'"] {
        assert!(header.contains(field), "{header}");
    }
    assert!(header.contains("'normal', '<f4', (3,)"), "{header}");
    assert!(header.contains("'shape': (2, )"), "{header}");
    assert_eq!((file.len() - 56) % 16, 0);
    let mut placed = Vec::new();
    write_hits(&mut placed, &[hit], true).unwrap();
    let header = String::from_utf8_lossy(&placed[..placed.len() - 32]).into_owned();
    assert!(
        header.contains("('primitive', '<u4'), ('instance', '<u4'), ('normal'"),
        "{header}"
    );
    assert_eq!(placed[placed.len() - 16..][..4], 7_u32.to_le_bytes());
}
