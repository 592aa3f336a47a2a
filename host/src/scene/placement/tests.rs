use super::*;
use crate::random::Random;
use std::f64::consts::FRAC_PI_2;

/// A placement of any kind.
pub(in crate::scene) fn any(random: &mut Random) -> Placement {
    let axis = DVec3::from_array(random.direction());
    Placement {
        rotation: DQuat::from_axis_angle(axis, 7.0 * random.signed()),
        translation: 100.0 * DVec3::from_array(random.direction()),
        scale: random.magnitude(1e-3, 1e3),
    }
}

#[test]
fn placement_scales_then_rotates_then_moves() {
    let random = &mut Random(1);
    for _ in 0..1000 {
        let placement = any(random);
        let point = 10.0 * DVec3::from_array(random.direction());
        let step_by_step = placement.rotation * (point * placement.scale) + placement.translation;
        let error = (placement.point(point) - step_by_step).length();
        assert!(
            error <= 1e-12 * (100.0 + 10.0 * placement.scale),
            "{placement:?}"
        );
        let turned = placement.direction(point);
        assert!((turned.length() - point.length()).abs() < 1e-12);
    }
}

#[test]
fn matrix_of_a_placement_gives_it_back() {
    let random = &mut Random(2);
    for _ in 0..1000 {
        let placement = any(random);
        let back = Placement::from_affine(placement.matrix(), placement.translation).unwrap();
        assert!((back.scale / placement.scale - 1.0).abs() < 2e-6);
        let turn = back.rotation.dot(placement.rotation).abs();
        assert!((turn - 1.0).abs() < 1e-12, "{turn}");
        assert_eq!(back.translation, placement.translation);
    }
}

#[test]
fn quarter_turns_are_exact() {
    for quarters in -4..=4 {
        let rotation = DQuat::from_rotation_y(f64::from(quarters) * FRAC_PI_2);
        let placement = Placement {
            rotation,
            ..Placement::IDENTITY
        };
        let point = placement.point(DVec3::new(0.1, 0.2, 0.3)).abs().to_array();
        assert!(
            [[0.1, 0.2, 0.3], [0.3, 0.2, 0.1]].contains(&point),
            "{point:?}"
        );
    }
}

#[test]
fn placements_apply_one_after_the_other() {
    let random = &mut Random(3);
    for _ in 0..1000 {
        let (inner, outer) = (any(random), any(random));
        let point = DVec3::from_array(random.direction());
        let once = inner.within(&outer).point(point);
        let twice = outer.point(inner.point(point));
        let size = 200.0 + outer.scale * (200.0 + inner.scale);
        assert!((once - twice).length() < 1e-12 * size, "{once} {twice}");
    }
}

#[test]
fn matrices_that_are_no_similarity_are_rejected() {
    let turn = DMat3::from_rotation_y(0.3);
    let diagonal = |x, y, z| turn * DMat3::from_diagonal(DVec3::new(x, y, z));
    let sheared = DMat3::from_cols(DVec3::X, DVec3::new(1e-3, 1.0, 0.0), DVec3::Z);
    for matrix in [
        diagonal(1.0, 1.0, -1.0),
        diagonal(-1.0, -1.0, -1.0),
        diagonal(1.0, 1.0, 1.0 + 1e-4),
        diagonal(1.0, 0.0, 1.0),
        diagonal(1e-12, 1.0, 1e12),
        diagonal(f64::NAN, 1.0, 1.0),
        diagonal(f64::INFINITY, 1.0, 1.0),
        sheared,
        DMat3::ZERO,
    ] {
        assert_eq!(
            Placement::from_affine(matrix, DVec3::ZERO),
            None,
            "{matrix}"
        );
    }
    let endless = DVec3::new(0.0, f64::INFINITY, 0.0);
    assert_eq!(Placement::from_affine(turn, endless), None);
}

#[test]
fn matrices_of_any_size_are_placements() {
    for scale in [1e-200, 1e-9, 1.0 + 1e-7, 3.0, 1e200] {
        let matrix = DMat3::from_rotation_x(2.0) * scale;
        let placement = Placement::from_affine(matrix, DVec3::X).unwrap();
        assert!((placement.scale / scale - 1.0).abs() < 1e-6);
    }
}

#[test]
fn rounded_rotations_become_the_nearest_one() {
    let random = &mut Random(4);
    for _ in 0..1000 {
        let exact = DMat3::from_quat(any(random).rotation);
        let rounded = exact.to_cols_array().map(|it| (it * 1e4).round() / 1e4);
        let rounded = DMat3::from_cols_array(&rounded);
        let placement = Placement::near(rounded, DVec3::ZERO, 1e-3).unwrap();
        assert_eq!(placement.scale, 1.0);
        assert!(placement.matrix().abs_diff_eq(exact, 1e-4));
        let square = placement.matrix() * placement.matrix().transpose();
        assert!(square.abs_diff_eq(DMat3::IDENTITY, 1e-14));
    }
}
