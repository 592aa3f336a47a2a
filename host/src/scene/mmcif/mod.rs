//! Reads the categories of mmCIF that drawing needs. They say where atoms are (`atom_site`), and which are bonded
//! beyond the bonds that distances imply (`struct_conn`). Others say how atoms are copied (`pdbx_struct_assembly_gen`,
//! `pdbx_struct_oper_list`).
//!
//! The author's chain and residue names (`auth_`) come before the archive's (`label_`), as in PDB
//! files of the same structure.

mod assembly;
mod bonds;
mod cif;
mod table;

use super::importer::{Importer, Input};
use super::molecule::{self, Atom, Element, Model, Parsed, Site};
use super::text::{Source, Warnings};
use super::{Imported, SceneError};
use crate::table::shortened;
use assembly::{GroupColumns, OperatorColumns};
use bonds::BondColumns;
use cif::{Token, Tokens};
use glam::DVec3;
use gridel_core::Up;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use table::{Column, Table, category};

pub(super) const IMPORTER: Importer = Importer {
    name: "mmCIF",
    about: "molecules as the Protein Data Bank archives them",
    extensions: &["cif", "mmcif"],
    // As PDB.
    up: Up::Y,
    binary: false,
    example: "data_t\nloop_\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n\
              _atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n1 C CA 0 0 0\n2 O O 1.2 0 0\n",
    recognizes: |bytes| {
        let lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
        let mut lines = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
        let head = lines.next().and_then(|line| line.get(..5));
        head.is_some_and(|it| it.eq_ignore_ascii_case(b"data_"))
    },
    read,
};

/// Reads an mmCIF file. It has no camera and no lights; the compiler adds them.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    molecule::import(input, parse)
}

/// Reads the first data block that has atoms.
///
/// # Errors
/// If the syntax is broken, a table is incomplete, or coordinates are no finite numbers.
fn parse<'a>(source: &'a Source, warnings: &mut Warnings) -> Result<Parsed<'a>, SceneError> {
    parse_into(source, Parsed::default(), warnings)
}

/// Reads the first data block that has atoms, and adds them to what there is.
pub(super) fn parse_into<'a>(
    source: &'a Source,
    parsed: Parsed<'a>,
    warnings: &mut Warnings,
) -> Result<Parsed<'a>, SceneError> {
    let mut parser = Parser {
        source,
        warnings,
        parsed,
        model_index: HashMap::new(),
    };
    let mut tokens = Tokens::new(source);
    // Items outside of loops: a table of one row, which ends where another category begins.
    let mut single = Table::default();
    let mut token = tokens.next()?;
    while let Some(current) = token {
        match current {
            Token::Tag(tag) => {
                let (category, line) = (category(tag), tokens.line);
                if !single.is_of(category) {
                    parser.row(&single)?;
                    single = Table {
                        line,
                        ..Table::default()
                    };
                }
                let value = tokens.next()?;
                let Some(Token::Value(value)) = value else {
                    return Err(source
                        .error(
                            format!("the item _{tag} has no value"),
                            "write its value after it, or a question mark",
                        )
                        .at_line(line));
                };
                single.add_column(source, tag, line)?;
                single.row.push(value);
                token = tokens.next()?;
            }
            Token::Loop => {
                parser.row(&single)?;
                single = Table::default();
                token = parser.table(&mut tokens)?;
            }
            Token::Block(name) => {
                parser.row(&single)?;
                single = Table::default();
                if !parser.parsed.atoms.is_empty() {
                    let sentence = format!(
                        "the data block {name:?} and what follows is ignored",
                        name = shortened(name)
                    );
                    parser.warnings.add(source, tokens.line, sentence);
                    return Ok(parser.parsed);
                }
                token = tokens.next()?;
            }
            Token::Value(_) | Token::Reserved => token = tokens.next()?,
        }
    }
    parser.row(&single)?;
    match parser.parsed.atoms.is_empty() {
        true => unread(source).map_or(Ok(parser.parsed), Err),
        false => Ok(parser.parsed),
    }
}

/// The error of a file whose atoms stand in a category of other CIF files.
fn unread(source: &Source) -> Option<SceneError> {
    let has = |tag: &str| {
        source.lines().any(|(_, line)| {
            let start = line.trim_start().get(..tag.len());
            start.is_some_and(|it| it.eq_ignore_ascii_case(tag))
        })
    };
    let cause = if has("_atom_site_fract_x") {
        "the atoms have no Cartesian coordinates, as in CIF files of small molecules"
    } else if has("_atom_site_Cartn_x") {
        "the atoms stand in _atom_site_Cartn_x, as in CIF files of small molecules; _atom_site.Cartn_x is read"
    } else if has("_chem_comp_atom.") {
        "the atoms stand in _chem_comp_atom, which describes a chemical component; _atom_site is read"
    } else {
        return None;
    };
    Some(source.error(cause, "convert the file to mmCIF or PDB"))
}

struct Parser<'a, 'w> {
    source: &'a Source,
    warnings: &'w mut Warnings,
    parsed: Parsed<'a>,
    /// Index of a model by its number; nothing forbids that the atoms of models alternate.
    model_index: HashMap<&'a str, usize>,
}

impl<'a> Parser<'a, '_> {
    /// Reads a loop and returns the token after it.
    fn table(&mut self, tokens: &mut Tokens<'a>) -> Result<Option<Token<'a>>, SceneError> {
        let mut table = Table::default();
        // Small and capital letters mean the same.
        let mut names = HashSet::new();
        let mut token = tokens.next()?;
        while let Some(Token::Tag(tag)) = token {
            if !names.insert(tag.to_ascii_lowercase()) {
                let cause = format!("a loop has the column _{} twice", shortened(tag));
                let error = self.source.error(cause, "remove one, with its values");
                return Err(error.at_line(tokens.line));
            }
            table.add_column(self.source, tag, tokens.line)?;
            token = tokens.next()?;
        }
        let Some(columns) = Columns::of(&table) else {
            while let Some(Token::Value(_)) = token {
                token = tokens.next()?;
            }
            return Ok(token);
        };
        while let Some(Token::Value(value)) = token {
            if table.row.is_empty() {
                table.line = tokens.line;
            }
            table.row.push(value);
            if table.row.len() == table.tags.len() {
                self.read(&table, &columns)?;
                table.row.clear();
            }
            token = tokens.next()?;
        }
        if table.row.is_empty() {
            return Ok(token);
        }
        let category = table.tags.first().map_or("", |tag| category(tag));
        Err(self
            .source
            .error(
                format!(
                    "a row of _{category} has {} of {} values",
                    table.row.len(),
                    table.tags.len()
                ),
                "complete the row, or check that the file is complete",
            )
            .at_line(table.line))
    }

    /// Reads a table of one row.
    fn row(&mut self, table: &Table<'a>) -> Result<(), SceneError> {
        match Columns::of(table) {
            Some(columns) => self.read(table, &columns),
            None => Ok(()),
        }
    }

    fn read(&mut self, table: &Table<'a>, columns: &Columns) -> Result<(), SceneError> {
        match columns {
            Columns::Atom(columns) => self.atom(table, columns)?,
            Columns::Bond(columns) => {
                if let Some(bond) = columns.read(table) {
                    self.parsed.add_bond(self.source, bond)?;
                }
            }
            Columns::Generating(columns) => {
                if columns.generates(table) {
                    self.parsed
                        .add_generating(self.source, columns.read(table))?;
                }
            }
            Columns::Group(columns) => {
                let names = 1 + columns.count_of_chains(table);
                self.parsed.spend_names(self.source, table.line, names)?;
                self.parsed.add_group(self.source, columns.read(table))?;
            }
            Columns::Operator(columns) => {
                self.parsed.spend_operator(self.source, table.line)?;
                let matrix = columns.read(table);
                match self.parsed.operators.entry(matrix.name) {
                    Entry::Vacant(place) => {
                        place.insert(matrix);
                    }
                    // It matters only to assemblies that use it.
                    Entry::Occupied(mut place) if !place.get().agrees(&matrix) => {
                        place.get_mut().again.get_or_insert(matrix.line);
                    }
                    Entry::Occupied(_) => {}
                }
            }
        }
        Ok(())
    }

    fn atom(&mut self, table: &Table<'a>, columns: &AtomColumns) -> Result<(), SceneError> {
        let mut position = [0.0; 3];
        for (axis, value) in position.iter_mut().enumerate() {
            let name = ["Cartn_x", "Cartn_y", "Cartn_z"][axis];
            let word = table.value([columns.position[axis]]);
            if word.is_empty() {
                return Err(self
                    .source
                    .error(
                        format!("an atom has no {name}"),
                        "give every atom Cartesian coordinates in angstroms",
                    )
                    .at_line(table.line));
            }
            // A standard uncertainty may follow in parentheses.
            let number = word.split('(').next().unwrap_or(word);
            *value = self.source.number(number, name)?;
        }
        let name = table.value(columns.name);
        let symbol = table.value([columns.symbol]);
        let element = Element::from_symbol(symbol);
        let at = (self.source, table.line);
        let element = Element::or_unknown(element, ["", symbol], at, self.warnings);
        let number = match table.value([columns.model]) {
            "" => "1",
            number => number,
        };
        let model = match self.model_index.entry(number) {
            Entry::Occupied(model) => *model.get(),
            Entry::Vacant(place) => {
                let line = table.line;
                self.parsed.add_model(self.source, Model { number, line })?;
                *place.insert(self.parsed.models.len() - 1)
            }
        };
        let asym = table.value(columns.asym);
        let is_numbered = !table.value([columns.number[0]]).is_empty();
        let atom = Atom {
            site: Site {
                element,
                position: DVec3::from_array(position),
            },
            line: table.line,
            model,
            serial: table.value([columns.serial]),
            name,
            altloc: table.value([columns.altloc]),
            chain: table.value(columns.chain),
            asym,
            residue: table.value(columns.residue),
            number: table.value(columns.number),
            insertion: table.value([columns.insertion]),
            label: table.value([columns.label]),
            segment: if is_numbered { "" } else { asym },
        };
        self.parsed.add(self.source, atom)
    }
}

/// The columns of a table that is read.
enum Columns {
    Atom(AtomColumns),
    Bond(BondColumns),
    Group(GroupColumns),
    Operator(OperatorColumns),
    /// Operators that generate the rest of the asymmetric unit.
    Generating(OperatorColumns),
}

impl Columns {
    fn of(table: &Table<'_>) -> Option<Self> {
        Some(
            match category(table.tags.first()?).to_ascii_lowercase().as_str() {
                "atom_site" => Self::Atom(AtomColumns::of(table)),
                "struct_conn" => Self::Bond(BondColumns::of(table)),
                "pdbx_struct_assembly_gen" => Self::Group(GroupColumns::of(table)),
                "struct_ncs_oper" => Self::Generating(OperatorColumns::of(table)),
                "pdbx_struct_oper_list" => Self::Operator(OperatorColumns::of(table)),
                _ => return None,
            },
        )
    }
}

struct AtomColumns {
    serial: Column,
    symbol: Column,
    name: [Column; 2],
    altloc: Column,
    residue: [Column; 2],
    chain: [Column; 2],
    asym: [Column; 2],
    number: [Column; 2],
    label: Column,
    insertion: Column,
    position: [Column; 3],
    model: Column,
}

impl AtomColumns {
    fn of(table: &Table<'_>) -> Self {
        let column = |name: &str| table.column(name);
        Self {
            serial: column("id"),
            symbol: column("type_symbol"),
            name: [column("label_atom_id"), column("auth_atom_id")],
            altloc: column("label_alt_id"),
            residue: [column("auth_comp_id"), column("label_comp_id")],
            chain: [column("auth_asym_id"), column("label_asym_id")],
            asym: [column("label_asym_id"), column("auth_asym_id")],
            number: [column("auth_seq_id"), column("label_seq_id")],
            label: column("label_seq_id").or_else(|| column("auth_seq_id")),
            insertion: column("pdbx_PDB_ins_code"),
            position: ["Cartn_x", "Cartn_y", "Cartn_z"].map(column),
            model: column("pdbx_PDB_model_num"),
        }
    }
}
