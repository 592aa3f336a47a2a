//! Boards and their memory.

use super::scene::SceneOptions;
use super::values::{bytes, vector};
use crate::cli::failure::Failure;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use glam::DVec3;
use gridel_core::{Format, Scene};
use gridel_host::measure::board::{BOARDS, Board, MemoryReport, Rendering, Target};
use std::ffi::OsStr;

/// The memory that a scene is to fit into.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Options for boards")]
pub struct TargetOptions {
    /// Board that must hold the scene, by the code and call stack measured for it [default:
    /// stm32vldiscovery, if --ram or --flash is given]
    ///
    /// A point X,Y,Z is not a board, but what the camera of a scene file looks at.
    #[arg(long, value_name = "BOARD|X,Y,Z", value_parser = TargetParser, allow_hyphen_values = true, ignore_case = true)]
    target: Vec<BoardOrPoint>,

    /// Bytes of RAM, such as 8192 or 8K [default: the board's]
    #[arg(long, value_name = "N", value_parser = bytes)]
    ram: Option<u64>,

    /// Bytes of flash, such as 131072 or 128K [default: the board's]
    #[arg(long, value_name = "N", value_parser = bytes)]
    flash: Option<u64>,
}

impl TargetOptions {
    /// Returns the memory, if any of it is given.
    pub fn target(&self) -> Option<Target> {
        let board = self.target.iter().find_map(BoardOrPoint::board);
        if board.is_none() && self.ram.is_none() && self.flash.is_none() {
            return None;
        }
        let board = board.unwrap_or(&BOARDS[0]);
        Some(Target {
            board,
            flash: self.flash.unwrap_or(board.flash),
            ram: self.ram.unwrap_or(board.ram),
        })
    }

    /// Returns the options for scene files, with the point that the camera is to look at.
    ///
    /// # Errors
    /// If two boards or two points were given.
    pub fn with_target(&self, options: &SceneOptions) -> Result<SceneOptions, Failure> {
        let mut points = self.target.iter().filter_map(BoardOrPoint::point);
        let boards = self.target.iter().filter_map(BoardOrPoint::board);
        if points.clone().count() > 1 || boards.count() > 1 {
            return Err(Failure::usage(
                "--target is given twice for the same",
                "give it once for a board, and once for the point that the camera looks at",
            ));
        }
        let mut options = options.clone();
        options.view.target = points.next();
        Ok(options)
    }

    /// Returns the memory report of a scene, in a number format of the board.
    ///
    /// # Errors
    /// If the best structure that the blob holds was not measured on boards.
    pub fn memory_report(
        &self,
        scene: &Scene<'_>,
        blob: &[u8],
        format: Format,
    ) -> Result<Option<MemoryReport>, Failure> {
        let Some(target) = self.target() else {
            return Ok(None);
        };
        let rendering = Rendering::of(scene, format);
        let report = MemoryReport::of(scene, blob, &target, &rendering);
        report
            .map(Some)
            .map_err(|error| Failure::usage(error.to_string(), error.remedy()))
    }
}

/// The meaning of `--target` where both are possible.
#[derive(Clone, Copy, Debug)]
enum BoardOrPoint {
    Board(&'static Board),
    Point(DVec3),
}

impl BoardOrPoint {
    fn board(&self) -> Option<&'static Board> {
        match self {
            Self::Board(board) => Some(board),
            Self::Point(_) => None,
        }
    }

    fn point(&self) -> Option<DVec3> {
        match self {
            Self::Board(_) => None,
            Self::Point(point) => Some(*point),
        }
    }
}

/// Points have commas, and boards have none.
#[derive(Clone)]
struct TargetParser;

impl TypedValueParser for TargetParser {
    type Value = BoardOrPoint;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<BoardOrPoint, clap::Error> {
        if value.to_string_lossy().contains(',') {
            let point = |text: &str| vector(text).map(BoardOrPoint::Point);
            return point.parse_ref(command, argument, value);
        }
        let board = board().map(BoardOrPoint::Board);
        board.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(
            BOARDS
                .map(|board| PossibleValue::new(board.name))
                .into_iter(),
        ))
    }
}

fn board() -> impl TypedValueParser<Value = &'static Board> {
    PossibleValuesParser::new(BOARDS.map(|board| board.name))
        .try_map(|name| Board::named(&name).ok_or("no such board"))
}
