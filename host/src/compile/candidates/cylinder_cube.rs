//! Builds the cylinder cubes: for every pair of gridels of different faces, the candidates between
//! them (the paper, section 3.1).

use super::budget::{Budget, Needed, OnProgress, OverBudget};
use super::lists::{BYTES_PER_CELL, Counted, List, Lists, Plan};
use super::shaft::Shaft;
use super::target::Targets;
use glam::DVec3;
use gridel_core::Structure;
use gridel_core::format::record::Gridels;

/// A table over pairs of gridels.
#[derive(Debug)]
pub struct Cube {
    pub gridels: Gridels,
    pub lists: Lists,
}

/// Pairs of faces in the order of their cells.
pub const FACES: [[u32; 2]; Gridels::FACE_PAIRS as usize] = {
    let mut faces = [[0; 2]; 15];
    let (mut first, mut place) = (0, 0);
    while first < 6 {
        let mut second = first + 1;
        while second < 6 {
            faces[place] = [first, second];
            place += 1;
            second += 1;
        }
        first += 1;
    }
    faces
};

/// Numbers of gridels per side that are tried by default.
const SIZES: [u32; 19] = [
    1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64,
];
/// The paper's.
const PAPER_SIZE: u32 = 4;

/// A method of finding the candidates of a pair of gridels.
pub trait Form: Sync {
    const STRUCTURE: Structure;
    /// True if lists are sorted along the ray and have keys.
    const KEYED: bool;
    /// Most gridels per side that are tried by default.
    const MOST: u32;

    /// The number beyond the largest candidate.
    fn end(&self) -> u32;

    /// Fills the list of two rectangles.
    fn list(&self, pair: &Pair, list: &mut List);
}

/// Two gridels, each widened in its plane by what rounding moves a ray.
#[derive(Clone, Copy, Debug)]
pub struct Pair(pub [[[f64; 2]; 3]; 2]);

impl Pair {
    /// Returns the gridels of a cell.
    pub fn of(gridels: &Gridels, cell: u64) -> Self {
        let square = u64::from(gridels.count) * u64::from(gridels.count);
        let faces = FACES[(cell / (square * square)) as usize];
        let numbers = [cell / square % square, cell % square];
        Self([0, 1].map(|which| rectangle(gridels, faces[which], numbers[which] as u32)))
    }
}

fn rectangle(gridels: &Gridels, face: u32, number: u32) -> [[f64; 2]; 3] {
    let axis = (face / 2) as usize;
    let units = |q13: i32| f64::from(q13) / 8192.0;
    let plane = if face.is_multiple_of(2) {
        gridels.low[axis]
    } else {
        gridels.high[axis]
    };
    let mut sides = [[units(plane); 2]; 3];
    let columns = [number / gridels.count, number % gridels.count];
    for (across, column) in Gridels::across(axis).into_iter().zip(columns) {
        let [low, high] = gridels.extent(across, column).map(units);
        sides[across] = [low - Gridels::REACH, high + Gridels::REACH];
    }
    sides
}

/// Builds a cube with the given gridels, or as many as fit the budget.
pub fn build<F: Form>(
    form: &F,
    targets: &Targets<'_>,
    budget: Budget<'_>,
) -> Result<Cube, OverBudget> {
    let plan = |count: u32| OfSize::new(form, Gridels::new(&targets.bounds, count));
    let memory = |count: u32| Gridels::pairs(count).saturating_mul(BYTES_PER_CELL);
    if let Some(count) = budget.gridels {
        let sized = plan(count);
        // Does not count what cannot fit.
        let least = Gridels::pairs(count);
        if least > budget.bytes {
            return Err(budget.exceeded(F::STRUCTURE, Some(count), Needed::AtLeast(least)));
        }
        if memory(count) > budget.memory() {
            let needed = Needed::Memory(memory(count));
            return Err(budget.exceeded(F::STRUCTURE, Some(count), needed));
        }
        let counted = sized.count(budget.on_progress);
        let needed = counted.figures().bytes;
        if needed > budget.bytes {
            return Err(budget.exceeded(F::STRUCTURE, Some(count), Needed::Table(needed)));
        }
        return Ok(sized.build(counted));
    }
    let mut best: Option<(OfSize<'_, F>, Counted)> = None;
    for count in SIZES.into_iter().take_while(|&count| count <= F::MOST) {
        // Lists are divided among more cells no faster than their cross-sections shrink.
        let expected = best.as_ref().map_or(0.0, |(sized, counted)| {
            let finer = f64::from(count) / f64::from(sized.gridels.count);
            counted.figures().bytes as f64 * finer * finer
        });
        let fits = Gridels::pairs(count) <= budget.bytes && memory(count) <= budget.memory();
        if !fits || expected > budget.bytes as f64 {
            break;
        }
        let sized = plan(count);
        let counted = sized.count(budget.on_progress);
        let needed = counted.figures().bytes;
        if needed > budget.bytes {
            if best.is_none() {
                return Err(budget.exceeded(F::STRUCTURE, Some(count), Needed::Table(needed)));
            }
            break;
        }
        best = Some((sized, counted));
    }
    match best {
        Some((sized, counted)) => Ok(sized.build(counted)),
        None => Err(budget.exceeded(F::STRUCTURE, Some(1), Needed::AtLeast(Gridels::pairs(1)))),
    }
}

/// A cube of one size.
struct OfSize<'f, F> {
    form: &'f F,
    gridels: Gridels,
}

impl<'f, F: Form> OfSize<'f, F> {
    fn new(form: &'f F, gridels: Gridels) -> Self {
        Self { form, gridels }
    }

    fn with_plan<T>(&self, act: impl FnOnce(&Plan<'_>) -> T) -> T {
        act(&Plan {
            cells: Gridels::pairs(self.gridels.count),
            end: self.form.end(),
            keyed: F::KEYED,
            list: &|cell, list| self.form.list(&Pair::of(&self.gridels, cell), list),
        })
    }

    fn count(&self, on_progress: OnProgress<'_>) -> Counted {
        self.with_plan(|plan| plan.count(on_progress))
    }

    fn build(self, counted: Counted) -> Cube {
        let lists = self.with_plan(|plan| plan.build(counted));
        Cube {
            gridels: self.gridels,
            lists,
        }
    }
}

/// The paper's form: cylinders about the gridels' midpoints, objects by bounding sphere.
pub struct Cylinders {
    spheres: Vec<([f64; 3], f64)>,
}

impl Cylinders {
    pub fn new(targets: &Targets<'_>) -> Self {
        let all = targets.all().iter();
        Self {
            spheres: all.map(|target| target.bounding_sphere()).collect(),
        }
    }
}

impl Form for Cylinders {
    const STRUCTURE: Structure = Structure::CylinderCube;
    const KEYED: bool = false;
    const MOST: u32 = PAPER_SIZE;

    fn end(&self) -> u32 {
        self.spheres.len() as u32
    }

    fn list(&self, pair: &Pair, list: &mut List) {
        let cylinder = Cylinder::around(pair);
        for (slot, &(center, radius)) in self.spheres.iter().enumerate() {
            if cylinder.meets(DVec3::from_array(center), radius) {
                list.push((slot as u32, 0));
            }
        }
    }
}

/// A cylinder without ends.
struct Cylinder {
    middle: DVec3,
    /// Direction of length 1.
    axis: DVec3,
    radius: f64,
}

/// Factor that is larger than the loss of a radius by rounding.
const ROUNDING: f64 = 1.0 + 8.0 * f64::EPSILON;

impl Cylinder {
    /// The cylinder about the line through the rectangles' midpoints that holds all their corners.
    fn around(pair: &Pair) -> Self {
        let middle =
            |sides: [[f64; 2]; 3]| DVec3::from_array(sides.map(|[low, high]| 0.5 * (low + high)));
        let [first, second] = pair.0.map(middle);
        // The partitioned box has some height, so no two faces share a midpoint.
        let mut cylinder = Self {
            middle: first,
            axis: (second - first).normalize(),
            radius: 0.0,
        };
        for sides in pair.0 {
            for corner in 0..8 {
                let point = [0, 1, 2].map(|k| sides[k][corner >> k & 1]);
                let distance = cylinder.distance(DVec3::from_array(point));
                cylinder.radius = cylinder.radius.max(distance * ROUNDING);
            }
        }
        cylinder
    }

    /// The distance of a point from the axis; by the cross product, which far away loses nothing.
    fn distance(&self, point: DVec3) -> f64 {
        (point - self.middle).cross(self.axis).length()
    }

    fn meets(&self, center: DVec3, radius: f64) -> bool {
        self.distance(center) <= (self.radius + radius) * ROUNDING
    }
}

/// The tight form: the convex hull of two gridels, tested against the primitives themselves.
pub struct Hulls<'t>(pub &'t Targets<'t>);

impl Form for Hulls<'_> {
    const STRUCTURE: Structure = Structure::CylinderCubeTight;
    const KEYED: bool = true;
    const MOST: u32 = Gridels::MOST;

    fn end(&self) -> u32 {
        self.0.all().len() as u32
    }

    fn list(&self, pair: &Pair, list: &mut List) {
        let mut met = Vec::new();
        let shaft = Shaft::between(pair.0[0], pair.0[1]);
        self.0
            .search(&shaft, &mut |slot, span| met.push((slot, span)));
        sorted(met, list);
    }
}

/// Sorts candidates by the middle of the span where rays can hit them, and gives them keys. A key
/// is the first level of this and all later candidates, and the last level of this and all earlier
/// ones.
pub fn sorted(mut met: Vec<(u32, [f64; 2])>, list: &mut List) {
    const LEVELS: f64 = 16.0;
    /// Part of a level; more than rounding can move a place.
    const SPARE: f64 = 1e-6;
    met.sort_unstable_by(|(a, from), (b, to)| {
        (from[0] + from[1])
            .total_cmp(&(to[0] + to[1]))
            .then(a.cmp(b))
    });
    let level = |place: f64| (place * LEVELS).clamp(0.0, LEVELS - 1.0) as u8;
    let mut last = 0;
    list.extend(met.iter().map(|&(candidate, span)| {
        last = last.max(level(span[1] + SPARE));
        (candidate, last)
    }));
    let mut first = u8::MAX;
    for (entry, (_, span)) in list.iter_mut().zip(&met).rev() {
        first = first.min(level(span[0] - SPARE));
        entry.1 |= first << 4;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gridel_core::format::record::UnitBox;

    /// The eight corners of a pair.
    fn corners(pair: &Pair) -> impl Iterator<Item = DVec3> + '_ {
        pair.0.iter().flat_map(|sides| {
            (0..8).map(|corner| DVec3::from_array([0, 1, 2].map(|k| sides[k][corner >> k & 1])))
        })
    }

    #[test]
    fn cylinders_hold_the_corners_and_little_more() {
        let flat = UnitBox([[-32_767, 32_767], [7, 7], [-5, 90]]);
        for bounds in [UnitBox([[-30_000, 30_000]; 3]), flat] {
            for count in [1, 2, 4] {
                let gridels = Gridels::new(&bounds, count);
                for cell in 0..Gridels::pairs(count) {
                    let pair = Pair::of(&gridels, cell);
                    let cylinder = Cylinder::around(&pair);
                    let farthest = corners(&pair)
                        .map(|corner| cylinder.distance(corner))
                        .fold(0.0, f64::max);
                    assert!(cylinder.axis.is_finite());
                    assert!(farthest <= cylinder.radius);
                    assert!(cylinder.radius <= farthest * (1.0 + 64.0 * f64::EPSILON));
                }
            }
        }
    }

    #[test]
    fn a_sphere_that_touches_a_cylinder_is_met_from_afar_too() {
        let gridels = Gridels::new(&UnitBox([[-30_000, 30_000]; 3]), 4);
        for cell in (0..Gridels::pairs(4)).step_by(7) {
            let cylinder = Cylinder::around(&Pair::of(&gridels, cell));
            let aside = cylinder.axis.any_orthonormal_vector();
            for along in [0.0, 1e4, 1e9] {
                let near = cylinder.middle + along * cylinder.axis;
                let center = near + (cylinder.radius + 10.0) * aside;
                let rounding = 1e-15 * along;
                assert!(cylinder.meets(center, 10.0 + rounding));
                assert!(!cylinder.meets(center, 9.9 - rounding));
                assert!(cylinder.distance(near).is_finite());
            }
        }
    }

    #[test]
    fn the_cells_of_opposite_faces_are_the_papers() {
        let opposite = FACES.iter().filter(|[a, b]| a / 2 == b / 2).count();
        assert_eq!((FACES.len(), opposite), (15, 3));
        let gridels = Gridels::new(&UnitBox([[-100, 100]; 3]), 3);
        // Cells as rays count them are those that lists are built for.
        for (number, [first, second]) in FACES.into_iter().enumerate() {
            assert_eq!(
                gridels.cell((first, 4), (second, 7)),
                number as u32 * 81 + 4 * 9 + 7
            );
        }
    }
}
