//! `gridel sample`: scenes that come with the program.

use super::failure::Failure;
use super::input::is_standard;
use super::output::{print, print_json, write_text_file};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use gridel_host::sample;
use gridel_host::table::{Align, Table};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// List the sample scenes, or write one
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// Sample to write [default: list the samples]
    #[arg(value_parser = name())]
    name: Option<&'static Sample>,

    /// File to write [default: the sample's name, in the current folder]
    #[arg(short, long, value_name = "FILE", requires = "name")]
    output: Option<PathBuf>,

    /// Replace a file that exists
    #[arg(long, requires = "name")]
    force: bool,

    /// Print the list as JSON
    #[arg(long, conflicts_with = "name")]
    json: bool,
}

/// A sample scene.
#[derive(Serialize)]
pub struct Sample {
    name: &'static str,
    /// Extension of its file, without the dot.
    extension: &'static str,
    summary: &'static str,
    #[serde(skip)]
    text: fn() -> Result<String, sample::PdbError>,
}

/// A sample that is a file of the project's own.
macro_rules! fixture {
    ($name:literal, $summary:literal) => {
        Sample {
            name: $name,
            extension: "toml",
            summary: $summary,
            text: || {
                Ok(String::from(include_str!(concat!(
                    "../../scenes/",
                    $name,
                    ".toml"
                ))))
            },
        }
    };
}

/// A sample that is computed, and written as a PDB file.
const fn molecule(
    name: &'static str,
    summary: &'static str,
    text: fn() -> Result<String, sample::PdbError>,
) -> Sample {
    Sample {
        name,
        extension: "pdb",
        summary,
        text,
    }
}

static SAMPLES: &[Sample] = &[
    fixture!("quick", "every effect once; renders in a moment"),
    fixture!(
        "glass-chess",
        "a glass chessboard with glass figures, about 150 objects"
    ),
    fixture!("cornell", "a box of diffuse walls with two blocks"),
    molecule("c60", "buckminsterfullerene, 60 atoms", || {
        sample::pdb(&sample::c60())
    }),
    molecule(
        "nanotube",
        "the carbon nanotube (10, 10), about 2,800 atoms",
        || sample::pdb(&sample::nanotube(10, 10, 172.0)),
    ),
    molecule("diamond", "a ball of diamond, about 2,800 atoms", || {
        sample::pdb(&sample::diamond(sample::DIAMOND_2_800))
    }),
    molecule(
        "diamond-large",
        "a ball of diamond, about 27,000 atoms",
        || sample::pdb(&sample::diamond(sample::DIAMOND_27_000)),
    ),
    Sample {
        name: "icosphere",
        extension: "obj",
        summary: "a closed sphere of 20,480 triangles",
        text: || Ok(sample::obj(&sample::icosphere(5))),
    },
    fixture!("turntable", "a scene that moves: an orbit, a lamp, a color"),
    fixture!(
        "robot-arm",
        "instances that move: an arm on a chain of joints"
    ),
    fixture!("room", "a closed room with indirect light"),
    fixture!("sky", "rough mirrors under a sky, through a lens"),
    fixture!("tumbler", "a drink with ice in a glass"),
    fixture!("stress-triangle", "hard cases of triangles"),
    fixture!("stress-sphere", "hard cases of spheres"),
    fixture!("stress-box", "hard cases of boxes"),
    fixture!("stress-disc", "hard cases of discs"),
    fixture!("stress-cylinder", "hard cases of cylinders"),
    fixture!("stress-cone", "hard cases of cones"),
    fixture!("stress-frustum", "hard cases of frusta"),
    fixture!("stress-torus", "hard cases of tori"),
    fixture!("stress-plane", "hard cases of planes"),
];

fn name() -> impl TypedValueParser<Value = &'static Sample> {
    PossibleValuesParser::new(SAMPLES.iter().map(|sample| sample.name)).try_map(|name| {
        let mut samples = SAMPLES.iter();
        samples
            .find(|sample| sample.name == name)
            .ok_or("no such sample")
    })
}

/// Lists the samples or writes one.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match arguments.name {
        Some(sample) => sample.write(arguments),
        None if arguments.json => print_json(&SAMPLES),
        None => {
            let mut table = Table::untitled([Align::Left, Align::Left, Align::Left]);
            for sample in SAMPLES {
                table.row([sample.name, sample.extension, sample.summary].map(String::from));
            }
            print(table)
        }
    }
}

impl Sample {
    fn write(&self, arguments: &Arguments) -> Result<(), Failure> {
        let own_name = PathBuf::from(format!("{}.{}", self.name, self.extension));
        let path = arguments.output.as_deref().unwrap_or(&own_name);
        let is_file = |path: &Path| !is_standard(path) && path.is_file();
        if is_file(path) && !arguments.force {
            return Err(Failure::failed(
                format!("{} exists already", path.display()),
                "give another name with `-o FILE`, or replace it with `--force`",
            ));
        }
        self.check_extension(path)?;
        let text = (self.text)().map_err(Failure::fault)?;
        write_text_file(path, |out| out.write_all(text.as_bytes()))?;
        if is_file(path) {
            print(format_args!("{}: {}\n", path.display(), self.summary))?;
        }
        Ok(())
    }

    /// The extension says which format a scene file is in, so a wrong one makes it unreadable.
    fn check_extension(&self, path: &Path) -> Result<(), Failure> {
        let wrong = path
            .extension()
            .is_some_and(|extension| !extension.eq_ignore_ascii_case(self.extension));
        if wrong {
            return Err(Failure::usage(
                format!(
                    "the sample {} is a .{} file, which {} would hide",
                    self.name,
                    self.extension,
                    path.display()
                ),
                format!("give it a name that ends with .{}", self.extension),
            ));
        }
        Ok(())
    }
}
