use super::super::{reference_setting, sweep};
use super::*;

const BALL: &str = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'\n\
                    [[object]]\nkind = 'sphere'\ncenter = [2, 0, 1]\nradius = 1\nname = 'other'";

/// Blobs that are dropped and compiled again change no figure, and nothing is left when all is measured.
#[test]
fn bench_keeps_what_later_settings_need_and_no_more() {
    let imported = crate::scene::read("ball.toml".as_ref(), BALL.into(), &Default::default());
    let scene = imported.expect("a scene").scene;
    let bench = || Bench::new(&scene, Structure::Flagged, [8, 6]);
    let (mut all, mut few) = (bench(), bench());
    few.most_blob_bytes = 0;
    let mut settings = sweep(all.base(), all.effects().expect("a blob"));
    settings.retain(|setting| setting.samples < 8);
    assert!(settings.iter().any(|it| it.without != Effects::NONE));
    let with = reference_setting(8, &settings);
    few.plan(settings.clone());
    let reference = all.reference(&with).expect("a reference");
    assert_eq!(few.reference(&with).expect("a reference"), reference);
    let mut most = 0;
    for setting in &settings {
        let measured = |bench: &mut Bench<'_>| bench.measure(setting, &reference);
        let points = [&mut all, &mut few].map(|it| measured(it).expect("a point"));
        assert_eq!(points[0], points[1], "{}", setting.name());
        assert_eq!(few.compiled.len(), 1);
        most = most.max(few.pictures.len());
    }
    assert!(0 < most && most < all.pictures.len() / 2, "{most}");
    assert!(few.pictures.is_empty() && few.hits.is_empty());
    assert!(all.compiled.len() > 5);
}
