//! Morph targets: their weights, and what they do to vertices.

use super::tracks::forged as forged_tracks;
use super::{Errors, alone, aside};
use bytemuck::Pod;
use glam::DVec3;
use gridel_core::Structure;
use gridel_core::deform::MorphTargets;
use gridel_core::format::{BlobError, Field, Reason, SectionKind};
use gridel_host::scene::{
    Displacements, Interpolation, Key, MorphTarget, NormalChanges, Normals, Scene, Shape,
    SourceSpan, Track, TrackTarget,
};
use gridel_tests::fuzz::Base;
use gridel_tests::scenes;

/// A triangle with normals and two morph targets, the second of which moves.
fn scene() -> Scene {
    let mut scene = scenes::of([Shape::Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        triangles: vec![[0, 1, 2]],
    }]);
    let target = |name: &str| MorphTarget {
        name: name.to_owned(),
        weight: 0.0,
        range: [0.0, 1.0],
        place: SourceSpan::default(),
    };
    scene.morph_targets = vec![target("a"), target("b")];
    scene.tracks = vec![Track {
        target: TrackTarget::MorphWeight,
        index: 1,
        interpolation: Interpolation::Step,
        keys: vec![Key {
            value: [0.5, 0.0, 0.0, 0.0],
            ..Key::default()
        }],
        place: SourceSpan::default(),
    }];
    let object = &mut scene.objects[0];
    object.attributes.displacements = [DVec3::Z, DVec3::X]
        .into_iter()
        .enumerate()
        .map(|(target, by)| Displacements {
            target,
            vectors: vec![by; 3],
        })
        .collect();
    let normal = DVec3::new(0.6, 0.0, 0.8);
    object.normals = Normals {
        vectors: vec![normal; 3],
        triangles: vec![[0, 1, 2]],
        changes: vec![NormalChanges {
            target: 1,
            vectors: vec![DVec3::Y; 3],
        }],
    };
    scene
}

/// The error of morph targets after a record was changed.
fn forged<T: Pod>(
    base: &Base,
    kind: SectionKind,
    index: usize,
    change: impl FnOnce(&mut T),
) -> BlobError {
    let mut base = base.clone();
    base.change(kind, index, change);
    error_of(base)
}

fn error_of(base: Base) -> BlobError {
    aside(base, |blob| MorphTargets::from_bytes(blob).map(drop))
}

pub(super) fn morph() -> Errors {
    let mut errors = alone(&scene(), Structure::Bvh, 24);
    let base = errors.base.clone();
    for weight in [(1 << 30) + 1, i32::MIN] {
        let error = forged(&base, SectionKind::MorphWeights, 1, |it: &mut i32| {
            *it = weight
        });
        errors.take_field(error, "morph target 1", Field::Weight);
        let word = |it: &mut i32| *it = weight;
        let error = forged_tracks(&base, SectionKind::TrackWords, 0, word);
        errors.take_field(error, "word 0 of tracks", Field::Weight);
    }
    let error = forged_tracks(
        &base,
        SectionKind::Tracks,
        0,
        |it: &mut gridel_core::format::track::Track| it.index = 2,
    );
    errors.take_field(error, "track 0", Field::TrackIndex);
    let error = forged(&base, SectionKind::MorphVertices, 5, |it: &mut u8| *it = 3);
    errors.take_field(error, "displacement 5 of morph-vertices", Field::Vertex);
    let error = forged(&base, SectionKind::MorphNumbers, 1, |it: &mut u8| *it = 2);
    errors.take_field(error, "displacement 1 of morph-numbers", Field::MorphTarget);
    for far in [(1 << 28) + 1, i32::MIN] {
        let kind = SectionKind::Displacements;
        let error = forged(&base, kind, 2, |it: &mut [i32; 3]| it[1] = far);
        errors.take_field(error, "displacement 2", Field::Displacement);
    }
    // The same vertex and morph target twice, and a vertex after a later one.
    for (kind, index, number) in [
        (SectionKind::MorphNumbers, 1, 0),
        (SectionKind::MorphVertices, 2, 0),
    ] {
        let error = forged(&base, kind, index, |it: &mut u8| *it = number);
        errors.take_reason(
            error,
            &format!("displacement {index}"),
            Reason::DisplacementOrder,
        );
    }
    for section in [
        SectionKind::MorphVertices,
        SectionKind::MorphNumbers,
        SectionKind::NormalChanges,
    ] {
        let mut base = base.clone();
        base.drop_first(section, 1);
        let expected = BlobError::Count {
            section,
            found: 5,
            expected: 6,
        };
        assert_eq!(error_of(base), expected);
    }
    errors
}
