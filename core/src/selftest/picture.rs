//! Pixels are encoded as the display requires, and a picture has the same bytes everywhere.

use crate::accel::Number;
use crate::accel::list::List;
use crate::observe::count::NoCount;
use crate::render::Pixel;
use crate::selftest::checks::{Checks, FNV_START, hash, name};
use crate::selftest::scene::TinyBlob;
use crate::{Effects, Format, Renderer, Rgb565, Rgb888, Scene, Settings, Workspace};

pub(super) fn encoding(checks: &mut Checks<'_>) {
    // sRGB codes of linear values: IEC 61966-2-1.
    let known = [
        (0, 0),
        (20, 1),
        (199, 10),
        (14_146, 128),
        (32_768, 188),
        (65_535, 255),
    ];
    for (linear, code) in known {
        let Rgb888(pixel) = Rgb888::encode([linear; 3], None);
        checks.equal(format_args!("sRGB of {linear}"), pixel, [code; 3]);
    }
    let Rgb565(pixel) = Rgb565::encode([65_535, 14_146, 0], None);
    checks.equal(format_args!("5-6-5"), pixel, 31 << 11 | 32 << 5);
    let mut sum = 0;
    for y in 0..8 {
        for x in 0..8 {
            sum += u32::from(Rgb888::encode([20_000; 3], Some([x, y])).0[0]);
        }
    }
    // Code 150.04, sixty-four times.
    checks.near(format_args!("dithered sum"), sum.into(), 150.04 * 64.0, 2.0);
}

/// Bytes of a row.
const ROW: usize = 3 * TinyBlob::SIZE[0] as usize;
/// Bytes of the picture.
const PICTURE: usize = ROW * TinyBlob::SIZE[1] as usize;

/// The hash of the picture's 16-bit channels on every machine.
const fn expected(format: Format) -> u32 {
    match format {
        Format::Fixed => 3_703_514_865,
        Format::F32 => 2_885_739_082,
        Format::F64 => 2_363_183_411,
    }
}

pub(super) fn matches<N: Number>(checks: &mut Checks<'_>) {
    let blob = TinyBlob::new();
    let Ok(scene) = Scene::from_bytes(blob.bytes()) else {
        return checks.equal(format_args!("the blob"), "rejected", "read");
    };
    let renderer =
        Renderer::<N, List, { Effects::ALL.0 }>::with_settings(&scene, Settings::of(&scene));
    let Ok(renderer) = renderer else {
        return checks.equal(format_args!("the renderer"), "rejected", "made");
    };
    let mut space = Workspace::<N, 0, { Effects::GLASS.work_depth(4) }>::new();
    let mut space = space.as_view();
    let enough = renderer.check_workspace(&space);
    checks.equal(format_args!("workspace"), enough, Ok(()));
    let mut picture = [0; PICTURE];
    let mut linear_bytes = FNV_START;
    for (y, row) in (0..).zip(picture.chunks_exact_mut(ROW)) {
        for (x, bytes) in (0..).zip(row.chunks_exact_mut(3)) {
            let linear = renderer.linear(x, y, &mut space, &mut NoCount);
            linear_bytes = hash(linear_bytes, linear.into_iter().flat_map(u16::to_le_bytes));
            bytes.copy_from_slice(&Rgb888::encode(linear, None).0);
        }
    }
    let failures = checks.failures;
    checks.equal(
        format_args!("hash in {}", name::<N>()),
        linear_bytes,
        expected(N::FORMAT),
    );
    if checks.failures > failures {
        checks.host.save(c"gridel-selftest.rgb", &picture);
    }
}
