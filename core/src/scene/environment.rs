//! The map of the light around a scene: how it is looked up, and how random texels are drawn.
//!
//! All arithmetic is in integers, so texels and the random places in them are the same in every number format. A place
//! in the map is two coordinates with 30 fraction bits, -1 to 1: see [`Environment`].

use crate::format::environment::Environment;
use crate::format::range::{At, Ranges};
use crate::format::record::Light;
use crate::format::{BlobError, Field, Location, Reason, SectionKind, Sections};

/// The ratio 1.
const ONE: i32 = 1 << 30;

/// The least distance of random places from a texel's edges, as a part of a texel with 16 fraction bits. It is more
/// than the error of any number format on the way from a place to a direction and back.
const MARGIN: u32 = 1 << 5;

/// The map.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EnvironmentMap<'a> {
    /// Absent where the scene has no environment.
    pub(crate) record: Option<&'a Environment>,
    pub(crate) texels: &'a [u32],
    pub(crate) rows: &'a [u32],
    pub(crate) columns: &'a [u16],
}

impl<'a> EnvironmentMap<'a> {
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        let records: &[Environment] = sections.records(SectionKind::Environment)?;
        let map = Self {
            record: records.first(),
            texels: sections.records(SectionKind::EnvironmentTexels)?,
            rows: sections.records(SectionKind::EnvironmentRows)?,
            columns: sections.records(SectionKind::EnvironmentColumns)?,
        };
        if let Some(record) = map.record {
            record.check_ranges(Location::Record(SectionKind::Environment, 0))?;
        }
        let size_bits = map.record.map_or(0, |it| it.size_bits);
        let side = if map.record.is_some() {
            1 << (size_bits & 15)
        } else {
            0
        };
        for (section, found, expected) in [
            (
                SectionKind::Environment,
                records.len(),
                records.len().min(1),
            ),
            (
                SectionKind::EnvironmentTexels,
                map.texels.len(),
                side * side,
            ),
            (SectionKind::EnvironmentRows, map.rows.len(), side),
            (
                SectionKind::EnvironmentColumns,
                map.columns.len(),
                side * side,
            ),
        ] {
            if found != expected {
                return Err(BlobError::Count {
                    section,
                    found,
                    expected,
                });
            }
        }
        Ok(map)
    }

    /// Proves that texels are in their range, and that the light of rows and texels adds up.
    pub(crate) fn validate(&self) -> Result<(), BlobError> {
        let Some(record) = self.record else {
            return Ok(());
        };
        let section = SectionKind::Environment;
        let at = At { section, index: 0 };
        let has_direction = record.sun_radius == 0 || record.sun_direction != [0; 3];
        at.ensure(has_direction, Reason::ZeroDirection)?;
        let section = SectionKind::EnvironmentTexels;
        for (index, texel) in (0..self.texels.len()).zip(self.texels) {
            let at = At { section, index };
            let most = Environment::MOST_EXPONENT.into();
            at.within(Field::Exponent, (texel >> 27).into(), 0, most)?;
        }
        let side = 1_usize << (record.size_bits & 15);
        adds_up(SectionKind::EnvironmentRows, self.rows, side)?;
        adds_up(SectionKind::EnvironmentColumns, self.columns, side)
    }

    /// Returns true if a light is the map or the sun.
    #[inline(always)]
    pub(crate) fn has(&self, light: &Light) -> bool {
        match light.kind {
            Light::ENVIRONMENT => self.record.is_some(),
            Light::SUN => self.record.is_some_and(|it| it.sun_radius > 0),
            _ => false,
        }
    }

    /// Returns a random place, drawn in proportion to the light of rows and texels; none if that light is 0.
    #[inline(never)]
    pub(crate) fn draw(&self, record: &Environment, [u, v]: [u32; 2]) -> [i32; 2] {
        let bits = record.size_bits;
        let row = last_at_most(self.rows, u);
        let [start, width] = self.row(row as u32);
        let down = (u64::from(u.wrapping_sub(start)) << 16).checked_div(width.into());
        let columns = self.columns_of(bits, row as u32);
        let column = last_at_most(columns, (v >> 16) as u16);
        let [start, width] = span(columns, column as u32);
        let right = v.wrapping_sub(start << 16).checked_div(width);
        [
            (column as u32, right),
            (row as u32, down.map(|it| it as u32)),
        ]
        .map(|(texel, within)| {
            let within = within.unwrap_or(0).min(0xffff);
            let inner = (within.wrapping_mul((1 << 16) - 2 * MARGIN) >> 16).wrapping_add(MARGIN);
            let place = (texel << 16 | inner).wrapping_shl(15_u32.wrapping_sub(bits));
            place.wrapping_sub(1 << 30) as i32
        })
    }

    /// Returns the radiance of the texel at a place over its density and π, with 20 fraction bits. That is the
    /// contribution of a light of that direction. Half the sum of the magnitudes of its direction's components is
    /// given, with 30 fraction bits. The result is at most the largest number.
    ///
    /// Let p be the probability of the texel, of n² in the map, and s the sum. The density of a direction is p n² / (4
    /// s³).
    #[inline(never)]
    pub(crate) fn sampled(&self, record: &Environment, place: [i32; 2], half_sum: i32) -> [i32; 3] {
        /// 4 / π with 62 fraction bits.
        const FACTOR: u64 = 5_871_781_006_564_002_453;
        let bits = record.size_bits;
        let [column, row] = texel_at(bits, place);
        let [_, of_row] = self.row(row);
        let [_, of_texel] = span(self.columns_of(bits, row), column);
        // With 48 fraction bits.
        let probability = u64::from(of_row).wrapping_mul(of_texel.into());
        if probability == 0 {
            return [0; 3];
        }
        let zeros = probability.leading_zeros();
        let leading = probability.wrapping_shl(zeros) >> 32;
        let inverse = FACTOR.checked_div(leading).unwrap_or(0);
        let half_sum = u64::from(half_sum.max(0).cast_unsigned());
        let square = half_sum.wrapping_mul(half_sum) >> 30;
        let cube = square.wrapping_mul(half_sum) >> 30;
        // Below 2^32 each, the radiance below 2^31.
        let weight = inverse.wrapping_mul(cube) >> 30;
        // 2 for the size, 3 for the halves, and 46 for the fraction bits.
        let shift = 43_u32
            .wrapping_add(bits.wrapping_mul(2))
            .wrapping_sub(zeros)
            .cast_signed();
        self.texel(bits, [column, row]).map(|radiance| {
            let product = u64::from(radiance).wrapping_mul(weight);
            let most = u64::from(i32::MAX.cast_unsigned());
            let brought = match shift {
                1.. => product.wrapping_add(1 << (shift.wrapping_sub(1) & 63)) >> (shift & 63),
                // Less than 64, as is the number of zeros.
                _ if product.leading_zeros() > shift.unsigned_abs() => {
                    product << (shift.unsigned_abs() & 63)
                }
                _ => most,
            };
            brought.min(most) as i32
        })
    }

    /// The radiance at a place with 20 fraction bits, mixed from four texels.
    #[inline(never)]
    pub(crate) fn mixed(&self, record: &Environment, place: [i32; 2]) -> [i32; 3] {
        let bits = record.size_bits;
        let size = 30_u32.wrapping_sub(bits) & 31;
        // From the middle of the first texel, in halves; 8 bits of it are the weight.
        let from_middle = place.map(|it| {
            let from_edge = (it >> 1).wrapping_add(1 << 29);
            from_edge.wrapping_sub(1 << (size.wrapping_sub(1) & 31))
        });
        let [column, row] = from_middle.map(|it| it >> size);
        let [right, down] =
            from_middle.map(|it| (it >> (size.wrapping_sub(8) & 31) & 255).cast_unsigned());
        let mut sum = [0_u64; 3];
        for (x, y, weight) in [
            (0, 0, (256 - right) * (256 - down)),
            (1, 0, right * (256 - down)),
            (0, 1, (256 - right) * down),
            (1, 1, right * down),
        ] {
            let place = texel_around_edges(bits, [column.wrapping_add(x), row.wrapping_add(y)]);
            for (sum, channel) in sum.iter_mut().zip(self.texel(bits, place)) {
                // The sum is below 2^47.
                *sum = sum.wrapping_add(u64::from(channel).wrapping_mul(weight.into()));
            }
        }
        sum.map(|it| (it >> 16) as i32)
    }

    /// The radiance of a texel, given by column and row, with 20 fraction bits: below 2^31.
    #[inline(always)]
    fn texel(&self, bits: u32, [column, row]: [u32; 2]) -> [u32; 3] {
        let index = row.wrapping_shl(bits) | column;
        let texel = self.texels.get(index as usize).copied().unwrap_or(0);
        let exponent = texel >> 27;
        let channel = |shift: u32| (texel >> shift & 511).wrapping_shl(exponent) & 0x7fff_ffff;
        [channel(0), channel(9), channel(18)]
    }

    /// The columns of a row.
    #[inline(always)]
    fn columns_of(&self, bits: u32, row: u32) -> &'a [u16] {
        let (first, side) = (row.wrapping_shl(bits), 1_u32.wrapping_shl(bits));
        let all = self.columns.get(first as usize..).unwrap_or_default();
        all.get(..side as usize).unwrap_or_default()
    }

    /// Returns the part of the light before a row, and the part from it, with 32 fraction bits; the whole is stored as
    /// 1 less.
    #[inline(always)]
    fn row(&self, row: u32) -> [u32; 2] {
        let at = |row: u32| self.rows.get(row as usize).copied();
        let start = at(row).unwrap_or(0);
        match at(row.wrapping_add(1)) {
            Some(end) => [start, end.wrapping_sub(start)],
            None if start == 0 => [0, u32::MAX],
            None => [start, start.wrapping_neg()],
        }
    }
}

/// Proves that each part of cumulative light begins with 0 and does not decrease.
fn adds_up<T: Copy + Into<u32>>(
    section: SectionKind,
    all: &[T],
    side: usize,
) -> Result<(), BlobError> {
    let mut before = 0;
    for (index, &light) in (0..all.len()).zip(all) {
        let (at, light) = (At { section, index }, light.into());
        if index & side.wrapping_sub(1) == 0 {
            at.ensure(light == 0, Reason::FirstNotZero)?;
        } else {
            at.ensure(light >= before, Reason::LightOrder)?;
        }
        before = light;
    }
    Ok(())
}

/// Returns the last of some numbers, which do not decrease, that is at most another one.
#[inline(always)]
fn last_at_most<T: Copy + PartialOrd>(all: &[T], most: T) -> usize {
    let (mut low, mut high) = (0_usize, all.len());
    while low.saturating_add(1) < high {
        let middle = low.midpoint(high);
        match all.get(middle) {
            Some(&start) if start <= most => low = middle,
            _ => high = middle,
        }
    }
    low
}

/// Returns the part of a row's light before a texel, and the part from it, with 16 fraction bits.
#[inline(always)]
fn span(columns: &[u16], column: u32) -> [u32; 2] {
    let at = |column: u32| columns.get(column as usize).copied().map(u32::from);
    let start = at(column).unwrap_or(0);
    let end = at(column.wrapping_add(1)).unwrap_or(1 << 16);
    [start, end.wrapping_sub(start)]
}

/// The texel at a place, column and row.
#[inline(always)]
pub(crate) fn texel_at(bits: u32, place: [i32; 2]) -> [u32; 2] {
    place.map(|it| {
        let from_edge = it.cast_unsigned().wrapping_add(1 << 30);
        let last = 1_u32.wrapping_shl(bits).wrapping_sub(1);
        from_edge.wrapping_shr(31_u32.wrapping_sub(bits)).min(last)
    })
}

/// Returns the texel at a place that can lie one texel beyond the map. An edge of the map continues at itself, turned
/// about its middle.
#[inline(always)]
fn texel_around_edges(bits: u32, [mut column, mut row]: [i32; 2]) -> [u32; 2] {
    let last = 1_i32.wrapping_shl(bits).wrapping_sub(1);
    if column < 0 || column > last {
        column = column.clamp(0, last);
        row = last.wrapping_sub(row);
    }
    if row < 0 || row > last {
        row = row.clamp(0, last);
        column = last.wrapping_sub(column);
    }
    [column.cast_unsigned(), row.cast_unsigned()]
}

/// Converts a place of the octahedron to one on the map, and back: on the lower half it is turned outwards.
#[inline(always)]
pub(crate) fn turned([x, y]: [i32; 2]) -> [i32; 2] {
    let rest = |of: i32, sign: i32| {
        let magnitude = ONE.wrapping_sub(of.wrapping_abs());
        if sign < 0 {
            magnitude.wrapping_neg()
        } else {
            magnitude
        }
    };
    [rest(y, x), rest(x, y)]
}

/// The direction of a place on the map: a point of the octahedron.
#[inline(always)]
pub(crate) fn direction_of(place: [i32; 2]) -> [i32; 3] {
    let [x, y] = place.map(i32::wrapping_abs);
    let z = ONE.wrapping_sub(x).wrapping_sub(y);
    let [x, y] = if z < 0 { turned(place) } else { place };
    [x, y, z]
}
