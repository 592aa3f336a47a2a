use super::*;
use crate::number::Fixed;
use crate::scene::environment::EnvironmentMap;
use crate::shade::sampler::Sampler;
use std::vec::Vec;

const BITS: u32 = 4;
const SIDE: usize = 1 << BITS;
const ONE: f64 = 1_073_741_824.0;

/// Maps, by texel: radiance, and light of rows and of texels as weights.
struct Owned {
    record: Record,
    texels: Vec<u32>,
    rows: Vec<u32>,
    columns: Vec<u16>,
}

/// The part of the whole that comes before each weight.
fn starts(weights: &[f64], whole: f64) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    let mut before = 0.0;
    let start = |weight: &f64| {
        let start = before;
        before += weight;
        libm::floor(start / sum * whole)
    };
    weights.iter().map(start).collect()
}

/// A map of texels with a radiance of 1 and an exponent, drawn by weights.
fn map(weight: &dyn Fn(usize, usize) -> f64) -> Owned {
    let row = |row: usize| -> Vec<f64> { (0..SIDE).map(|column| weight(column, row)).collect() };
    let rows: Vec<f64> = (0..SIDE).map(|at| row(at).iter().sum()).collect();
    let columns = (0..SIDE).flat_map(|at| starts(&row(at), 65_536.0));
    Owned {
        record: Record {
            size_bits: BITS,
            sun_direction: [0, 0, 1 << 30],
            sun_radius: 1 << 28,
            sun_radiance: [1 << 20; 3],
        },
        texels: vec![256 | 128 << 9 | 64 << 18 | 12 << 27; SIDE * SIDE],
        rows: starts(&rows, 4_294_967_296.0)
            .into_iter()
            .map(|it| it as u32)
            .collect(),
        columns: columns.map(|it| it as u16).collect(),
    }
}

impl Owned {
    fn view(&self) -> EnvironmentMap<'_> {
        EnvironmentMap {
            record: Some(&self.record),
            texels: &self.texels,
            rows: &self.rows,
            columns: &self.columns,
        }
    }
}

/// One bright texel, a bright row and a dim rest.
fn uneven(column: usize, row: usize) -> f64 {
    match (column, row) {
        (3, 5) => 400.0,
        (_, 9) => 5.0,
        _ => 1.0 + 0.3 * column as f64,
    }
}

/// The direction of a place as a light sees it.
fn to_light<N: Number>(place: [i32; 2]) -> [N; 3] {
    let way = direction_of(place).map(|axis| N::far(axis.into()));
    N::normalize(N::slopes(way).expect("a direction").0).0
}

fn drawn_directions_fall_into_their_texels<N: Number>() {
    let owned = map(&uneven);
    let view = owned.view();
    for sample in 0..4096 {
        let place = view.draw(
            &owned.record,
            Sampler::new([1, 2], sample).point(0, DIMENSION),
        );
        let direction = to_light::<N>(place);
        let found = place_of(direction).0;
        assert_eq!(texel_at(BITS, found), texel_at(BITS, place), "{place:?}");
        let of_slopes = place_of(N::slopes(direction.map(N::widen)).expect("a direction").0).0;
        assert_eq!(
            texel_at(BITS, of_slopes),
            texel_at(BITS, place),
            "{place:?}"
        );
    }
}

#[test]
fn drawn_directions_fall_into_their_texels_in_every_format() {
    drawn_directions_fall_into_their_texels::<Fixed>();
    drawn_directions_fall_into_their_texels::<f32>();
    drawn_directions_fall_into_their_texels::<f64>();
}

fn map_and_its_inverse_agree<N: Number>(most: f64) {
    for x in (-32..=32).map(|it| it << 25) {
        for y in (-32..=32).map(|it| it << 25) {
            let direction = direction_of([x, y]);
            let length: i64 = direction.iter().map(|it| i64::from(it.abs())).sum();
            assert_eq!(length, 1 << 30, "on the octahedron");
            let found = direction_of(place_of(to_light::<N>([x, y])).0);
            for (found, expected) in found.into_iter().zip(direction) {
                let off = f64::from(found.abs_diff(expected)) / ONE;
                assert!(off <= most, "{x} {y}: {off}");
            }
        }
    }
}

#[test]
fn map_and_its_inverse_agree_in_every_format() {
    map_and_its_inverse_agree::<Fixed>(1e-8);
    map_and_its_inverse_agree::<f32>(4e-7);
    map_and_its_inverse_agree::<f64>(4e-9);
}

/// The mean of L / (π times density). It is 4 L for a uniformly bright map, however it is drawn.
fn densities_integrate_to_one<N: Number>() {
    for weight in [&(|_, _| 1.0) as &dyn Fn(usize, usize) -> f64, &uneven] {
        let owned = map(weight);
        let view = owned.view();
        let (mut sum, mut count) = ([0.0; 3], 0);
        for pixel in 0..16 {
            for sample in 0..4096 {
                let point = Sampler::new([pixel, 0], sample).point(0, DIMENSION);
                let place = view.draw(&owned.record, point);
                let (place, half_sum) = place_of(to_light::<N>(place));
                let brought = view.sampled(&owned.record, place, half_sum.to_q30());
                for (sum, channel) in sum.iter_mut().zip(brought) {
                    *sum += f64::from(channel) / 1_048_576.0;
                }
                count += 1;
            }
        }
        for (sum, expected) in sum.into_iter().zip([4.0, 2.0, 1.0]) {
            let mean = sum / f64::from(count);
            assert!((mean / expected - 1.0).abs() < 1e-3, "{mean}, {expected}");
        }
    }
}

#[test]
fn densities_integrate_to_one_in_every_format() {
    densities_integrate_to_one::<Fixed>();
    densities_integrate_to_one::<f32>();
    densities_integrate_to_one::<f64>();
}

fn drawn_directions_of_the_sun_are_seen_in_it<N: Number>() {
    let owned = map(&uneven);
    for radius in [1 << 20, 1 << 23, 1 << 28, 800_000_000] {
        let record = Record {
            sun_direction: [644_245_094, 0, -858_993_459],
            sun_radius: radius,
            ..owned.record
        };
        let mut inner = 0;
        for sample in 0..1024 {
            let way = in_sun::<N>(&record, Sampler::new([0, 0], sample).point(0, 1));
            let direction = N::normalize(N::slopes(way).expect("a direction").0).0;
            let seen = |scale: f64| {
                let sun_radius = (f64::from(radius) * scale) as i32;
                is_in_sun(
                    &Record {
                        sun_radius,
                        ..record
                    },
                    direction,
                )
            };
            assert!(seen(1.001), "{radius}");
            inner += i32::from(seen(0.5));
        }
        assert!(
            (250..262).contains(&inner),
            "a quarter of the area: {inner}"
        );
    }
}

#[test]
fn drawn_directions_of_the_sun_are_seen_in_it_in_every_format() {
    drawn_directions_of_the_sun_are_seen_in_it::<Fixed>();
    drawn_directions_of_the_sun_are_seen_in_it::<f32>();
    drawn_directions_of_the_sun_are_seen_in_it::<f64>();
}

#[test]
fn mixed_texels_are_those_in_their_middles_and_go_on_across_edges() {
    let mut owned = map(&uneven);
    let gray = |level: u32| (level | level << 9 | level << 18) | 10 << 27;
    owned.texels = (0..(SIDE * SIDE) as u32).map(|it| gray(it + 1)).collect();
    let view = owned.view();
    let middle = |it: usize| ((it as i32 * 2 + 1) << 26).wrapping_sub(1 << 30);
    for (index, texel) in owned.texels.iter().enumerate() {
        let place = [middle(index % SIDE), middle(index / SIDE)];
        let [red, ..] = view.mixed(&owned.record, place);
        assert_eq!(red, ((texel & 511) << 10) as i32);
    }
    // Mirrored places of an edge are the same direction.
    for at in (-16..=16).map(|it| it << 26) {
        for edge in [-(1 << 30), 1 << 30] {
            for (place, same) in [([at, edge], [-at, edge]), ([edge, at], [edge, -at])] {
                assert_eq!(direction_of(place), direction_of(same));
                let off = view.mixed(&owned.record, place)[0] - view.mixed(&owned.record, same)[0];
                assert!(off.abs() <= 2 << 10, "{place:?}: {off}");
            }
        }
    }
}
