//! Options for building structures.

use super::values::bytes;
use crate::cli::failure::Failure;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use gridel_core::Structure;
use gridel_core::shared::DIRECTION_COUNTS;
use gridel_host::compile::{self, Quality, takes_hierarchy};
use gridel_host::measure::Deforming;

/// Options for building structures.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Options for structures")]
pub struct StructureOptions {
    /// Number of directions of slabs [default: 7]
    #[arg(long, value_name = "N", value_parser = directions())]
    slabs: Option<usize>,

    /// Divisions of the grid, 1 to 1024: one number for all axes, or three, such as 8x8x2 [default:
    /// four cells per primitive, fewer if their build needs more than 256M]
    #[arg(long, value_name = "N|NxNxN", value_parser = divisions)]
    grid: Option<[u32; 3]>,

    /// Gridels (rectangles) per side of a cylinder cube's faces, 1 to 64 [default: as many as
    /// --budget allows; at most 4, as in the paper, for `cylinder-cube`]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    gridels: Option<u32>,

    /// Largest size in bytes of a table of candidate lists, such as 64K or 1M; for `apex`, per
    /// point or direction [default: 48M for `cylinder-cube`, 4M for `cylinder-cube-tight` and
    /// `ray-classes`, 2M for `cylinder-cube-entry`, 1M for `apex`]
    #[arg(long, value_name = "N", value_parser = bytes)]
    budget: Option<u64>,

    /// Time to spend on building wide [default: good]
    #[arg(long, value_name = "NAME")]
    quality: Option<Quality>,
}

impl StructureOptions {
    /// Returns the options for the compiler.
    ///
    /// # Errors
    /// If an option was given that none of the options' structures takes.
    pub fn apply(&self, options: compile::Options) -> Result<compile::Options, Failure> {
        let structures = &options.structures;
        let cubes = |it| {
            use Structure::{CylinderCube, CylinderCubeEntry, CylinderCubeTight};
            matches!(it, CylinderCube | CylinderCubeTight | CylinderCubeEntry)
        };
        check_takers("--slabs", self.slabs.is_some(), structures, |it| {
            matches!(it, Structure::Slabs | Structure::FlaggedSlabs)
        })?;
        check_takers("--grid", self.grid.is_some(), structures, |it| {
            it == Structure::Grid
        })?;
        check_takers("--gridels", self.gridels.is_some(), structures, cubes)?;
        // Lists of candidates, in tables.
        let tables = |it: Structure| !it.is_proved();
        check_takers("--budget", self.budget.is_some(), structures, tables)?;
        check_quality(self.quality, structures)?;
        Ok(compile::Options {
            slab_directions: self.slabs.unwrap_or(options.slab_directions),
            grid: self.grid,
            gridels: self.gridels,
            budget: self.budget,
            quality: self.quality.unwrap_or_default(),
            ..options
        })
    }
}

/// Rejects an option if none of its structures is built.
///
/// # Errors
/// If it was given.
pub fn check_takers(
    option: &str,
    given: bool,
    built: &[Structure],
    takes: impl Fn(Structure) -> bool,
) -> Result<(), Failure> {
    if !given || built.iter().any(|&structure| takes(structure)) {
        return Ok(());
    }
    let takers = Structure::ALL.into_iter().filter(|&it| takes(it));
    let takers: Vec<_> = takers.map(Structure::name).collect();
    let built: Vec<_> = built.iter().map(|it| it.name()).collect();
    Err(Failure::usage(
        format!(
            "{option} is for {}, and what is built is {}",
            takers.join(", "),
            built.join(", ")
        ),
        "leave the option out, or choose with `--accel` a structure that it is for",
    ))
}

/// Rejects `--quality` where the structure wide is not built.
///
/// # Errors
/// If it was given.
pub fn check_quality(quality: Option<Quality>, built: &[Structure]) -> Result<(), Failure> {
    check_takers("--quality", quality.is_some(), built, |it| {
        it == Structure::Wide
    })
}

/// Rejects an option of hierarchies where none is built.
///
/// # Errors
/// If it was given.
pub fn check_hierarchy(option: &str, given: bool, built: &[Structure]) -> Result<(), Failure> {
    check_takers(option, given, built, takes_hierarchy)
}

/// Rejects `--room` where a structure is built that cannot be refitted.
///
/// # Errors
/// If a room above 0 was given.
pub fn check_room(room: Option<f64>, built: &[Structure]) -> Result<(), Failure> {
    let is_room = room.is_some_and(|room| room > 0.0);
    if !is_room || built.iter().all(|it| Deforming::STRUCTURES.contains(it)) {
        return Ok(());
    }
    Err(Failure::usage(
        "--room is for meshes that deform, and of all structures only bvh can be refitted",
        "choose `--accel bvh` alone",
    ))
}

fn directions() -> impl TypedValueParser<Value = usize> {
    PossibleValuesParser::new(DIRECTION_COUNTS.map(|count| match count {
        3 => "3",
        7 => "7",
        _ => "13",
    }))
    .try_map(|count| count.parse())
}

/// Reads divisions of three axes, such as `8` or `8x8x2`.
fn divisions(text: &str) -> Result<[u32; 3], String> {
    let numbers: Option<Vec<u32>> = text
        .split(['x', 'X'])
        .map(|number| {
            number
                .parse()
                .ok()
                .filter(|number| (1..=1024).contains(number))
        })
        .collect();
    match numbers.as_deref() {
        Some(&[all]) => Ok([all; 3]),
        Some(&[x, y, z]) => Ok([x, y, z]),
        _ => Err(String::from(
            "write one number or three, each 1 to 1024, such as 8 or 8x8x2",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_have_one_number_or_three() {
        assert_eq!(divisions("8"), Ok([8; 3]));
        assert_eq!(divisions("1x2X1024"), Ok([1, 2, 1024]));
        for wrong in ["", "0", "1025", "8x8", "8x8x8x8", "8x0x8", "-1", "a"] {
            assert!(divisions(wrong).is_err(), "{wrong}");
        }
    }
}
