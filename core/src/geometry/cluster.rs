//! All clusters of a blob: see [`format::cluster`](crate::format::cluster).

use crate::format::cluster::{
    LANES, Pack, Pack16, Pack24, RADII, Strip, Strip16, Strip24, StripMembers, Windowed24,
};
use crate::format::record::UnitBox;
use crate::format::{BlobError, Indices, Kind, SectionKind, Sections};

/// All strips.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Strips<'a> {
    S16(&'a [Strip16]),
    S24(&'a [Strip24]),
}

/// All packs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Packs<'a> {
    P16(&'a [Pack16]),
    P24(Packs24<'a>),
}

/// All packs on the 24-bit lattice, and all radii in 1/256 unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Packs24<'a> {
    pub(crate) packs: &'a [Pack24],
    pub(crate) radii: &'a [i32],
}

impl<'a> Packs24<'a> {
    /// A pack with its window of radii.
    #[inline(always)]
    pub(crate) fn get(&self, pack: u32) -> Option<Windowed24<'a>> {
        let number = pack as usize;
        let start = if self.radii.len() == RADII {
            0
        } else {
            number.wrapping_mul(LANES)
        };
        Some(Windowed24 {
            pack: self.packs.get(number)?,
            radii: self.radii.get(start..)?.first_chunk()?,
        })
    }
}

impl Strips<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Strips::S16(strips) => strips.len(),
            Strips::S24(strips) => strips.len(),
        }
    }

    #[inline]
    pub(crate) fn members(&self, strip: u32) -> Option<&StripMembers> {
        match self {
            Strips::S16(strips) => strips.get(strip as usize).map(Strip::members),
            Strips::S24(strips) => strips.get(strip as usize).map(Strip::members),
        }
    }

    /// The corners of a triangle in 1/256 unit.
    #[inline]
    pub(crate) fn triangle(&self, strip: u32, place: u32) -> Option<[[i32; 3]; 3]> {
        match self {
            Strips::S16(strips) => strips.get(strip as usize)?.triangle(place),
            Strips::S24(strips) => strips.get(strip as usize)?.triangle(place),
        }
    }

    /// Number of triangles in all strips.
    fn triangles(&self) -> usize {
        let last = (self.len() as u32).checked_sub(1);
        let members = last.and_then(|last| self.members(last));
        members.map_or(0, |last| (last.first() + last.count()) as usize)
    }
}

impl Packs<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Packs::P16(packs) => packs.len(),
            Packs::P24(all) => all.packs.len(),
        }
    }

    /// One bit for each lane of a pack that holds a sphere.
    pub(crate) fn lanes(&self, pack: u32) -> u32 {
        match self {
            Packs::P16(packs) => packs.get(pack as usize).map_or(0, Pack::lanes),
            Packs::P24(packs) => packs.get(pack).map_or(0, |pack| pack.lanes()),
        }
    }

    /// Center and radius of a sphere in 1/256 unit.
    pub(crate) fn sphere(&self, pack: u32, lane: u32) -> Option<([i32; 3], i32)> {
        match self {
            Packs::P16(packs) => packs.get(pack as usize)?.sphere(lane),
            Packs::P24(packs) => packs.get(pack)?.sphere(lane),
        }
    }

    /// Number of spheres in all packs.
    fn spheres(&self) -> usize {
        let Some(full) = self.len().checked_sub(1) else {
            return 0;
        };
        full * LANES + self.lanes(full as u32).count_ones() as usize
    }
}

/// All clusters of a blob, and the primitives in them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clusters<'a> {
    pub(crate) strips: Strips<'a>,
    pub(crate) packs: Packs<'a>,
    /// The primitive of each member, or its slot where other structures share the primitives.
    pub(crate) members: Indices<'a>,
    /// The location of each slot in the hierarchy, where other structures share the primitives.
    pub(crate) locations: &'a [u32],
}

impl<'a> Clusters<'a> {
    /// No clusters: used in builds without code for them.
    pub(crate) const NONE: Self = Self {
        strips: Strips::S16(&[]),
        packs: Packs::P16(&[]),
        members: Indices::Absent,
        locations: &[],
    };

    pub(crate) fn read(sections: &Sections<'a>, short: bool) -> Result<Self, BlobError> {
        Ok(Self {
            strips: if short {
                Strips::S16(sections.records(SectionKind::Strips)?)
            } else {
                Strips::S24(sections.records(SectionKind::Strips)?)
            },
            packs: if short {
                Packs::P16(sections.records(SectionKind::Packs)?)
            } else {
                Packs::P24(Packs24 {
                    packs: sections.records(SectionKind::Packs)?,
                    radii: sections.records(SectionKind::Radii)?,
                })
            },
            members: Indices::read(sections, SectionKind::Members)?,
            locations: sections.records(SectionKind::SlotLocations)?,
        })
    }

    /// Number of triangles.
    pub(crate) fn triangles(&self) -> usize {
        self.strips.triangles()
    }

    /// Number of spheres.
    pub(crate) fn spheres(&self) -> usize {
        self.packs.spheres()
    }

    /// Returns true if a cluster holds primitives, and all of them lie in a box.
    ///
    /// In 1/256 unit, where no sum wraps: coordinates have 24 bits and radii 25.
    pub(crate) fn inside(&self, kind: Kind, cluster: u32, outer: &UnitBox) -> bool {
        let holds = |lowest: i32, highest: i32, axis: usize| {
            let [low, high] = outer.0[axis].map(|side| i32::from(side) << 8);
            low <= lowest && highest <= high
        };
        let mut places = match kind {
            Kind::Triangle => self.strips.members(cluster).map_or(0, StripMembers::lanes),
            _ => self.packs.lanes(cluster),
        };
        let mut inside = places != 0;
        while places != 0 {
            let place = places.trailing_zeros();
            places &= places - 1;
            inside &= match kind {
                Kind::Triangle => self
                    .strips
                    .triangle(cluster, place)
                    .is_some_and(|[a, b, c]| {
                        let lowest = |k: usize| a[k].min(b[k]).min(c[k]);
                        let highest = |k: usize| a[k].max(b[k]).max(c[k]);
                        (0..3).all(|k| holds(lowest(k), highest(k), k))
                    }),
                _ => self
                    .packs
                    .sphere(cluster, place)
                    .is_some_and(|(center, radius)| {
                        (0..3).all(|k| holds(center[k] - radius, center[k] + radius, k))
                    }),
            };
        }
        inside
    }

    /// The strip and the place of a triangle by its number among the members.
    pub(crate) fn find_triangle(&self, member: usize) -> Option<(u32, u32)> {
        let first = |strip| Some(self.strips.members(strip)?.first() as usize);
        let strip = last_at_or_before(self.strips.len(), member, first)?;
        let members = self.strips.members(strip)?;
        let place = (0..8).find(|&place| {
            members.lanes() >> place & 1 != 0 && members.member(place) as usize == member
        })?;
        Some((strip, place))
    }

    /// The member that is a triangle: its primitive, or its slot.
    #[inline]
    pub(crate) fn triangle_member(&self, strip: u32, place: u32) -> Option<u32> {
        let member = self.strips.members(strip)?.member(place);
        self.members.get(member as usize)
    }

    /// The member that is a sphere: its primitive, or its slot.
    #[inline]
    pub(crate) fn sphere_member(&self, pack: u32, lane: u32) -> Option<u32> {
        let member = pack as usize * LANES + lane as usize;
        self.members.get(self.triangles() + member)
    }
}

/// Returns the last of `count` ascending numbers that is not above `value`.
fn last_at_or_before(
    count: usize,
    value: usize,
    number: impl Fn(u32) -> Option<usize>,
) -> Option<u32> {
    let (mut low, mut high) = (0, count as u32);
    while low < high {
        let middle = low + (high - low) / 2;
        if number(middle)? <= value {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low.checked_sub(1)
}
