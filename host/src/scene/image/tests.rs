use super::*;

/// A PNG of red, green, blue and alpha.
pub(crate) fn png_of(width: u32, height: u32, pixels: &[[u8; 4]]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(pixels.as_flattened()).unwrap();
    writer.finish().unwrap();
    file
}

#[test]
fn png_pixels_are_read_as_they_are() {
    let pixels = [[255, 0, 0, 255], [1, 2, 3, 4]];
    let image = Image::decode("two.png", &png_of(2, 1, &pixels), &Texels::default()).unwrap();
    assert_eq!((image.size(), image.pixels()), ([2, 1], &pixels[..]));
}

#[test]
fn broken_images_are_rejected_with_cause_and_remedy() {
    let whole = png_of(3, 3, &[[9, 8, 7, 255]; 9]);
    for end in [0, 4, 8, 20, 40, whole.len() - 20] {
        let CauseAndRemedy { cause, remedy } =
            Image::decode("cut.png", &whole[..end], &Texels::default()).unwrap_err();
        assert!(!cause.is_empty() && !remedy.is_empty(), "{end}");
    }
    for bytes in [&b"GIF89a"[..], b"\xff\xd8\xff", b"\xff\xd8"] {
        assert!(Image::decode("x", bytes, &Texels::default()).is_err());
    }
}

#[test]
fn image_that_announces_too_many_pixels_is_rejected_before_they_are_read() {
    let mut file = png_of(1, 1, &[[0; 4]]);
    // Width and height in the header, and its checksum.
    file[16..24].copy_from_slice(&[0, 0, 0x7f, 0xff, 0, 0, 0x7f, 0xff]);
    let crc = crc32(&file[12..29]);
    file[29..33].copy_from_slice(&crc.to_be_bytes());
    let CauseAndRemedy { cause, .. } =
        Image::decode("bomb.png", &file, &Texels::default()).unwrap_err();
    assert!(cause.contains("32767x32767"), "{cause}");
}

#[test]
fn images_of_a_scene_are_limited_together() {
    let texels = Texels::default();
    let mut most = (0..).take_while(|_| texels.add(8192, 8192).is_ok());
    assert_eq!(most.by_ref().count(), 8);
    let CauseAndRemedy { cause, remedy } =
        Image::decode("one more", &png_of(1, 1, &[[0; 4]]), &texels).unwrap_err();
    assert!(cause.contains("1x1") && remedy.contains("fewer"), "{cause}");
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            crc >> 1 ^ (0xedb8_8320 & (crc & 1).wrapping_neg())
        })
    })
}

#[test]
fn sixteen_bits_are_rounded_to_eight() {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, 4, 1);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().unwrap();
    let values = [128_u16, 129, 33_023, 65_535];
    writer
        .write_image_data(values.map(u16::to_be_bytes).as_flattened())
        .unwrap();
    writer.finish().unwrap();
    let image = Image::decode("deep.png", &file, &Texels::default()).unwrap();
    let found: Vec<u8> = image.pixels().iter().map(|it| it[0]).collect();
    assert_eq!(found, [0, 1, 128, 255]);
}
