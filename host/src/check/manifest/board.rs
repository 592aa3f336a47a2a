//! The programs of a check that run on emulated boards.

use super::named::Named;
use super::values::format;
use crate::scene::SceneError;
use crate::scene::toml::value::Value;
use gridel_core::Format;
use std::collections::BTreeMap;
use std::path::{Component, Path};

/// A program on an emulated board.
#[derive(Clone, Debug)]
pub struct Board {
    pub machine: String,
    pub emulator: String,
    pub program: Program,
    /// The file with the picture that the program writes.
    pub picture: Option<String>,
    pub format: Format,
    /// The value of `-icount`: an instruction takes 2^shift ns on the board's clock.
    pub shift: u32,
    pub seconds: u32,
    /// The most for each figure that the program prints.
    pub budget: BTreeMap<String, u64>,
}

/// The origin of a board's program.
#[derive(Clone, Debug)]
pub enum Program {
    /// It was built before.
    Elf(Named),
    /// It is built from a Cargo package.
    Firmware(Firmware),
}

/// A Cargo package, and its program, target and features.
#[derive(Clone, Debug)]
pub struct Firmware {
    pub folder: Named,
    pub program: String,
    pub target: String,
    pub features: Vec<String>,
}

impl Board {
    pub(super) fn read(table: Value<'_>, folder: &Path) -> Result<Self, SceneError> {
        let keys = [
            "machine", "emulator", "elf", "firmware", "program", "target", "features", "picture",
            "format", "shift", "seconds", "budget",
        ];
        let fields = table.fields("board", &[&keys])?;
        let text = |value: Value<'_>| value.filled().map(str::to_owned);
        let program = match (fields.get("elf"), fields.get("firmware")) {
            (Some(path), None) => {
                let foreign = ["program", "target", "features"];
                if let Some(value) = foreign.into_iter().find_map(|key| fields.get(key)) {
                    return Err(value.error(
                        format!("a program that was built before needs no `{}`", value.key),
                        "remove the key, or give a `firmware` folder in place of `elf`",
                    ));
                }
                Program::Elf(Named::read(path, folder)?)
            }
            (None, Some(path)) => Program::Firmware(Firmware {
                folder: Named::read(path, folder)?,
                program: text(fields.require("program")?)?,
                target: text(fields.require("target")?)?,
                features: fields.or("features", Vec::new(), |list| {
                    list.items("`features = [\"f32\"]`")?.map(text).collect()
                })?,
            }),
            (Some(elf), Some(_)) => {
                return Err(elf.error(
                    "this board has both an `elf` and a `firmware`",
                    "remove one: a program is built before, or from a folder",
                ));
            }
            (None, None) => {
                return Err(table.error(
                    "this board has no program",
                    "add a line `elf = ...` with the path of an ELF file, or `firmware = ...` with \
                     the folder of a Cargo package",
                ));
            }
        };
        let budget: BTreeMap<String, u64> = fields.or("budget", BTreeMap::new(), |table| {
            let entries = table.entries()?.into_iter();
            entries
                .map(|(name, value)| Ok((name.text, value.count()?)))
                .collect()
        })?;
        let picture = fields.or("picture", None, |value| {
            let name = text(value)?;
            let mut parts = Path::new(&name).components();
            match (parts.next(), parts.next()) {
                (Some(Component::Normal(_)), None) => Ok(Some(name)),
                _ => Err(value.error(
                    "the picture is a file in the folder in which the program runs",
                    "write the name of the file that the program writes, without a folder",
                )),
            }
        })?;
        if budget.is_empty() && picture.is_none() {
            return Err(table.error(
                "this board tests nothing: it states no expected result",
                "add a `budget` of figures that the program prints, or the `picture` that it writes",
            ));
        }
        let mut emulator = fields.or("emulator", String::from("qemu-system-arm"), text)?;
        // A name is looked up as a shell does, a path from the manifest.
        if Path::new(&emulator).components().count() > 1 {
            let path = folder.join(&emulator);
            emulator = std::path::absolute(&path)
                .unwrap_or(path)
                .to_string_lossy()
                .into_owned();
        }
        Ok(Self {
            machine: text(fields.require("machine")?)?,
            emulator,
            program,
            picture,
            format: fields.or("format", Format::F32, format)?,
            shift: fields.or("shift", 4, |value| value.integer_in(0..=10))?,
            seconds: fields.or("seconds", 300, |value| value.integer_in(1..=86_400))?,
            budget,
        })
    }
}
