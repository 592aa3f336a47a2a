use super::*;
use crate::number::Fixed;
use crate::number::Scalar;

#[test]
fn linear_of_white_is_one_and_of_all_roots_their_square() {
    assert_eq!(linear((255 * 255) << 16), 1 << 30);
    for root in 0..=255_u32 {
        let found = f64::from(linear((root * root) << 16)) / f64::from(1 << 30);
        let expected = (f64::from(root) / 255.0).powi(2);
        assert!((found - expected).abs() < 3e-9, "{root}: {found}");
    }
}

fn at_corners<N: Arithmetic>() {
    let corners = [[256, 512, 0], [25_600, 1024, 7680], [2560, 51_200, -2560]];
    let normal = [N::ratio(-(1 << 28)), N::ratio(1 << 27), N::ratio(1 << 30)];
    let colors = [[255, 0, 10, 255], [0, 255, 20, 255], [7, 9, 255, 255]];
    for (number, corner) in corners.iter().enumerate() {
        let weights = Weights::at(corners, corner.map(N::from_lattice), normal);
        let found = weights.color(colors).map(|it| N::ratio(it).ratio_to_f64());
        for (found, root) in found.into_iter().zip(colors[number]) {
            let expected = (f64::from(root) / 255.0).powi(2);
            assert!(
                (found - expected).abs() < 1e-6,
                "{number}: {found} {expected}"
            );
        }
    }
}

#[test]
fn colors_at_corners_are_those_of_the_vertices() {
    at_corners::<f32>();
    at_corners::<f64>();
    at_corners::<Fixed>();
}

#[test]
fn means_of_the_farthest_coordinates_are_exact() {
    let [low, high] = [i32::MIN + 1, i32::MAX];
    let half = Weights([1 << 29, 0]);
    for (corners, mean) in [
        ([-(1 << 30), 1 << 30, 0], 0),
        ([low, high, 0], 0),
        ([high, low, low], 0),
        ([high, high, low], high),
    ] {
        let corners = corners.map(|u| [u, -u]);
        assert_eq!(half.coordinates(corners), [mean, -mean], "{corners:?}");
    }
    let third = Weights([0, 1 << 30]);
    assert_eq!(third.coordinates([[low; 2], [0; 2], [high; 2]]), [high; 2]);
}

#[test]
fn weights_of_points_outside_and_of_nan_stay_in_range() {
    let corners = [[0, 0, 0], [2560, 0, 0], [0, 2560, 0]];
    let up = [0.0_f32, 0.0, 1.0];
    let nan = f32::NAN;
    for point in [
        [-9.0, 3.0, 0.0],
        [40.0, 40.0, 0.0],
        [nan; 3],
        [1e30; 3],
        [0.0; 3],
    ] {
        let Weights([second, third]) = Weights::at(corners, point, up);
        assert!(second >= 0 && third >= 0, "{point:?}");
        assert!(
            i64::from(second) + i64::from(third) <= i64::from(i32::MAX),
            "{point:?}"
        );
    }
    let flat = [[0, 0, 0]; 3];
    let Weights([second, third]) = Weights::at(flat, [Fixed::ZERO; 3], [Fixed::ONE; 3]);
    assert!(second >= 0 && third >= 0);
}

#[test]
fn coordinates_keep_their_fraction_bits_at_both_ends() {
    let half = Weights([1 << 29, 0]);
    let most = i32::MAX;
    assert_eq!(half.coordinates([[most, 0], [most, 2], [0, 0]]), [most, 1]);
    assert_eq!(
        Weights([0, 1 << 30]).coordinates([[0, 0], [0, 0], [-most, 5]]),
        [-most, 5]
    );
}

#[test]
fn triangle_with_a_vertex_without_coordinates_has_none() {
    let short = [[i16::MAX, -i16::MAX], [1, 2], [-3, i16::MIN], [i16::MIN; 2]];
    let short = Coordinates::Short(&short);
    let most = i32::from(i16::MAX) << 6;
    let expected = [[most, -most], [64, 128], [-192, -(2 << 20)]];
    assert_eq!(short.corners([0, 1, 2]), Some(expected));
    assert_eq!(short.corners([0, 1, 3]), None);
    assert_eq!(short.corners([4, 1, 0]), None);
    let long = [[i32::MAX, i32::MIN], [0, 0], [i32::MIN, 0]];
    let long = Coordinates::Long(&long);
    assert_eq!(
        long.corners([1, 1, 0]),
        Some([[0, 0], [0, 0], [i32::MAX, i32::MIN]])
    );
    assert_eq!(long.corners([1, 2, 0]), None);
    assert_eq!(long.corners([1, 0, 3]), None);
    assert_eq!(Coordinates::default().corners([0; 3]), None);
}
