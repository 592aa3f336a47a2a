//! Reads molecules from PDB and mmCIF files. Scene units are angstroms.
//!
//! Atoms are spheres of their van der Waals radius, or small spheres joined by sticks. Every atom
//! is one object, in file order, named like `A/CYS 3/CA`; hydrogens and waters are included.
//! Materials are one for each element. There are no camera and no lights; the compiler adds them.
//!
//! The parsers are our own. The crate `pdbtbx` (0.12) was tried first: it does not build without
//! its default features, panics on ordinary files (a space group it does not list, such as
//! `H 3 2`, or a blank residue name), regroups atoms by chain so that file order is lost, reads
//! neither CONECT nor struct_conn, and knows no lines for mmCIF.

mod bonds;
mod cif;
mod draw;
mod element;
mod mmcif;
mod pdb;
mod select;

pub(crate) use bonds::perceive;
pub(crate) use draw::{BoundingSphere, draw};
pub(crate) use element::Element;

use super::size::Size;
use super::text::{Source, Warnings};
use super::{Imported, MoleculeOptions, MoleculeStyle, Scene, SceneError};
use glam::DVec3;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// An element at a position in angstroms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Site {
    pub(crate) element: Element,
    pub(crate) position: DVec3,
}

/// An atom as the file has it; what it does not say is empty.
struct Atom<'a> {
    site: Site,
    line: usize,
    /// Index of its model in the file, counted from 0.
    model: usize,
    serial: &'a str,
    name: &'a str,
    altloc: &'a str,
    chain: &'a str,
    residue: &'a str,
    /// Number of the residue in its chain, and the code of residues inserted after it.
    number: &'a str,
    insertion: &'a str,
}

impl<'a> Atom<'a> {
    /// What tells its residue from others of its model.
    fn residue_key(&self) -> [&'a str; 3] {
        [self.chain, self.number, self.insertion]
    }

    fn full_name(&self) -> String {
        let Self {
            chain,
            residue,
            number,
            insertion,
            name,
            ..
        } = self;
        let residue = format!("{residue} {number}{insertion}");
        [chain, residue.trim(), name]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join("/")
    }
}

/// One end of a bond that the file states.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum End<'a> {
    /// An atom's serial number, in PDB.
    Serial(&'a str),
    /// Chain, residue number, insertion code and atom name, in mmCIF.
    Name([&'a str; 4]),
}

/// What a file says, before one model and one set of alternate locations is chosen.
#[derive(Default)]
struct Parsed<'a> {
    atoms: Vec<Atom<'a>>,
    /// The numbers that the file gives to its models, in file order.
    models: Vec<&'a str>,
    /// The ends of each, and its line.
    bonds: Vec<(usize, [End<'a>; 2])>,
}

/// Reads a PDB (`.pdb`, `.ent`) or mmCIF (`.cif`, `.mmcif`) file.
///
/// # Errors
/// If the file cannot be read, has no atoms, its content is broken (the error names the line), or
/// it lacks the model or the alternate location asked for.
pub(super) fn load(path: &Path, options: &MoleculeOptions) -> Result<Imported, SceneError> {
    import(&Source::read(path)?, options)
}

fn import(source: &Source, options: &MoleculeOptions) -> Result<Imported, SceneError> {
    let mut warnings = Warnings::default();
    let extension = source
        .path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_ascii_lowercase();
    let parsed = match extension.as_str() {
        "cif" | "mmcif" => mmcif::parse(source, &mut warnings)?,
        _ => pdb::parse(source, &mut warnings)?,
    };
    let atoms = select::select(source, &parsed, options)?;
    if parsed.models.len() > 1 {
        let other = parsed
            .atoms
            .iter()
            .find(|atom| atom.model + 1 != options.model);
        let sentence = format!(
            "the file has {} models, of which model {} is drawn; `--model N` chooses another",
            parsed.models.len(),
            options.model
        );
        warnings.add(source, other.map_or(0, |atom| atom.line), sentence);
    }
    missing_ends(source, &parsed, &mut warnings);
    let bonds = match options.style {
        MoleculeStyle::SpaceFilling => Vec::new(),
        MoleculeStyle::BallAndStick => find_bonds(source, &parsed, &atoms, &mut warnings),
    };
    check_size(source, &atoms, &bonds)?;
    let balls = atoms
        .into_iter()
        .map(|atom| BoundingSphere {
            site: atom.site,
            name: atom.full_name(),
            place: source.place(atom.line),
        })
        .collect();
    let (materials, objects) = draw(balls, options.style, &bonds);
    let scene = Scene {
        materials,
        objects,
        ..Scene::default()
    };
    Ok(Imported {
        scene,
        warnings: warnings.into_sentences(),
        molecules: true,
    })
}

/// Rejects atoms so crowded that their bonds fit into no memory.
fn check_size(source: &Source, atoms: &[&Atom<'_>], bonds: &[[u32; 2]]) -> Result<(), SceneError> {
    // A name has a few words, of which each has a few letters.
    let objects = (atoms.len() + 2 * bonds.len()) as u64;
    let size = Size {
        objects,
        ..Size::default()
    };
    match size.excess() {
        None => Ok(()),
        Some(excess) => Err(source.error(
            format!(
                "{} bonds of {} atoms take {excess}",
                bonds.len(),
                atoms.len()
            ),
            "use the style space-filling, or check that the coordinates are in angstroms",
        )),
    }
}

/// Warns of bonds to atoms that no model of the file has.
fn missing_ends(source: &Source, parsed: &Parsed<'_>, warnings: &mut Warnings) {
    if parsed.bonds.is_empty() {
        return;
    }
    let known: HashSet<End<'_>> = parsed.atoms.iter().flat_map(ends_of).collect();
    let mut all = parsed.bonds.iter().filter_map(|(line, bond)| {
        let end = bond.iter().find(|end| !known.contains(end))?;
        Some((*line, *end))
    });
    let Some((line, first)) = all.next() else {
        return;
    };
    let named = match first {
        End::Serial(serial) => format!("CONECT names the atom {serial}"),
        End::Name([chain, number, _, name]) => {
            format!("struct_conn names the atom {chain}/{number}/{name}")
        }
    };
    let sentence = format!("{named}, which the file lacks; the bond is left out");
    warnings.add_times(source.place(line), 1 + all.count(), sentence);
}

/// What bonds call an atom.
fn ends_of<'a>(atom: &Atom<'a>) -> [End<'a>; 2] {
    let name = [atom.chain, atom.number, atom.insertion, atom.name];
    [End::Serial(atom.serial), End::Name(name)]
}

/// The bonds between the chosen atoms: those of the file, and those that distances tell.
fn find_bonds(
    source: &Source,
    parsed: &Parsed<'_>,
    atoms: &[&Atom<'_>],
    warnings: &mut Warnings,
) -> Vec<[u32; 2]> {
    let mut ends: HashMap<End<'_>, u32> = HashMap::new();
    for (atom, index) in atoms.iter().zip(0..) {
        for end in ends_of(atom) {
            ends.entry(end).or_insert(index);
        }
    }
    // An end that is missing here may be in another model or an alternate location.
    let stated = parsed
        .bonds
        .iter()
        .filter_map(|(_, [a, b])| Some([*ends.get(a)?, *ends.get(b)?]));
    let sites: Vec<Site> = atoms.iter().map(|atom| atom.site).collect();
    let (perceived, crowded) = perceive(&sites);
    if let Some(&first) = crowded.first() {
        let sentence = format!(
            "{} atoms are crowded as in no molecule; no bonds are guessed among them",
            crowded.len()
        );
        warnings.add(source, atoms[first as usize].line, sentence);
    }
    let mut bonds: Vec<[u32; 2]> = stated.chain(perceived).filter(|[a, b]| a != b).collect();
    for bond in &mut bonds {
        bond.sort_unstable();
    }
    bonds.sort_unstable();
    bonds.dedup();
    bonds
}

#[cfg(test)]
mod tests;
