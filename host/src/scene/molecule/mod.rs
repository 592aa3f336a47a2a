//! Molecules, as the importers of their formats read them. Scene units are angstroms.
//!
//! Atoms are spheres of their van der Waals radius, or small spheres joined by sticks. Every atom
//! is one object, in file order, named like `A/CYS 3/CA`; hydrogens and waters are included.
//! Materials are one for each element. There are no camera and no lights; the compiler adds them.
//!
//! The parsers are our own. The crate `pdbtbx` (0.12) was tried first. It does not build without its default features.
//! It panics on ordinary files (a space group it does not list, such as `H 3 2`, or a blank residue name). It regroups
//! atoms by chain, so file order is lost. It reads neither CONECT nor struct_conn, and reports no lines for mmCIF.

mod assembly;
mod bonds;
mod draw;
mod element;
mod limit;
mod operators;
mod parsed;
mod select;

pub(crate) use bonds::perceive;
pub(crate) use draw::{BoundingSphere, draw};
pub(crate) use element::Element;
pub(crate) use parsed::Site;
pub(super) use parsed::{Atom, End, Group, Matrix, Model, Operators, Parsed};

use super::importer::Input;
use super::text::{Source, Warnings};
use super::{Imported, Instance, Material, MoleculeStyle, Part, Scene, SceneError};
use crate::table::shortened;
use assembly::{Copied, assemble};
use limit::check_size;
use std::collections::{HashMap, HashSet};

/// Makes a scene of the atoms that `parse` reads from a file.
///
/// # Errors
/// If the file has no atoms, its content is broken (the error names the line), or it lacks the requested model or
/// alternate location.
pub(super) fn import(
    input: Input<'_>,
    parse: impl for<'a> Fn(&'a Source, &mut Warnings) -> Result<Parsed<'a>, SceneError>,
) -> Result<Imported, SceneError> {
    let options = input.choices.molecule;
    let assembly = input.choices.assembly;
    let source = &input.into_source()?;
    let mut warnings = Warnings::default();
    let parsed = parse(source, &mut warnings)?;
    let atoms = select::select(source, &parsed, options)?;
    if parsed.models.len() > 1 {
        let other = usize::from(options.model == 1);
        let sentence = format!(
            "the file has {} models, of which model {} is drawn; `--model N` chooses another",
            parsed.models.len(),
            options.model
        );
        warnings.add(source, parsed.models[other].line, sentence);
    }
    missing_ends(source, &parsed, &mut warnings);
    let bonds = match options.style {
        MoleculeStyle::SpaceFilling => Vec::new(),
        MoleculeStyle::BallAndStick => find_bonds(source, &parsed, &atoms, &mut warnings),
    };
    let molecule = Molecule {
        source,
        atoms: &atoms,
        bonds: &bonds,
        style: options.style,
    };
    let scene = match assembly {
        Some(wanted) => {
            let copied = assemble(source, &parsed, &atoms, wanted, &mut warnings)?;
            molecule.assembled(copied)?
        }
        None => molecule.whole()?,
    };
    Ok(Imported {
        molecules: true,
        assemblies: true,
        ..Imported::of(scene, warnings.into_sentences())
    })
}

/// The atoms of a model, and their bonds.
struct Molecule<'m, 'a> {
    source: &'m Source,
    atoms: &'m [&'m Atom<'a>],
    bonds: &'m [[u32; 2]],
    style: MoleculeStyle,
}

impl Molecule<'_, '_> {
    /// All of it, where it stands.
    fn whole(&self) -> Result<Scene, SceneError> {
        check_size(self.source, self.atoms.len(), self.bonds.len())?;
        let (materials, objects) = draw(self.balls(0..self.atoms.len()), self.style, self.bonds);
        Ok(Scene {
            materials,
            objects,
            ..Scene::default()
        })
    }

    /// Copies of some of it. Those that stand where they are in the file alone are objects, others parts.
    fn assembled(&self, copied: Vec<Copied>) -> Result<Scene, SceneError> {
        let mut within = Vec::with_capacity(copied.len());
        let [mut atoms, mut bonds] = [0, 0];
        for copied in &copied {
            let own = self.bonds_of(&copied.atoms);
            atoms += copied.atoms.len();
            bonds += own.len();
            check_size(self.source, atoms, bonds)?;
            within.push(own);
        }
        let mut scene = Scene::default();
        for (copied, bonds) in copied.into_iter().zip(within) {
            let atoms = copied.atoms.iter().map(|&at| at as usize);
            let (materials, mut objects) = draw(self.balls(atoms), self.style, &bonds);
            let numbers = shared(&mut scene.materials, materials);
            for object in &mut objects {
                object.material = numbers[object.material];
            }
            if copied.is_single() {
                scene.objects.extend(objects);
                continue;
            }
            let place = self.source.place(copied.line);
            for (name, placement) in copied.places {
                scene.instances.push(Instance {
                    name,
                    part: scene.parts.len(),
                    placement,
                    joint: None,
                    place: place.clone(),
                });
            }
            scene.parts.push(Part {
                name: copied.name,
                objects,
                place,
            });
        }
        Ok(scene)
    }

    fn balls(&self, atoms: impl Iterator<Item = usize>) -> Vec<BoundingSphere> {
        let ball = |at: usize| BoundingSphere {
            site: self.atoms[at].site,
            name: self.atoms[at].full_name(),
            place: self.source.place(self.atoms[at].line),
        };
        atoms.map(ball).collect()
    }

    /// The bonds between some atoms, by their place among these.
    fn bonds_of(&self, atoms: &[u32]) -> Vec<[u32; 2]> {
        // Atoms and the first ends of bonds rise, so searches find them: there can be many groups of atoms.
        let find = |end: u32| atoms.binary_search(&end).ok().map(|at| at as u32);
        let mut within = Vec::new();
        for (&atom, near) in atoms.iter().zip(0..) {
            let first = self.bonds.partition_point(|[end, _]| *end < atom);
            let bonds = self.bonds[first..].iter();
            let bonds = bonds.take_while(|[end, _]| *end == atom);
            within.extend(bonds.filter_map(|[_, far]| Some([near, find(*far)?])));
        }
        within
    }
}

/// Adds materials to those that there are, unless one of their name is among them, and returns their numbers.
fn shared(all: &mut Vec<Material>, more: Vec<Material>) -> Vec<usize> {
    let number = |material: Material| {
        let known = all.iter().position(|it| it.name == material.name);
        known.unwrap_or_else(|| {
            all.push(material);
            all.len() - 1
        })
    };
    more.into_iter().map(number).collect()
}

/// Warns of bonds to atoms that no model of the file has.
fn missing_ends(source: &Source, parsed: &Parsed<'_>, warnings: &mut Warnings) {
    if parsed.bonds.is_empty() {
        return;
    }
    let mut missing: HashSet<&End<'_>> = named_ends(parsed).collect();
    for end in parsed.atoms.iter().flat_map(ends_of) {
        missing.remove(&end);
    }
    let mut all = parsed.bonds.iter().filter_map(|(line, bond)| {
        let end = bond.iter().find(|end| missing.contains(end))?;
        Some((*line, *end))
    });
    let Some((line, first)) = all.next() else {
        return;
    };
    let named = match first {
        End::Serial(serial) => format!("CONECT names the atom {serial}"),
        End::Name(names) => {
            let [chain, number, _, name, altloc] = names.map(shortened);
            let at = if altloc.is_empty() {
                ""
            } else {
                " at the alternate location "
            };
            format!("struct_conn names the atom {chain}/{number}/{name}{at}{altloc}")
        }
    };
    let sentence = format!("{named}, which the file lacks; the bond is left out");
    warnings.add_times(source.place(line), 1 + all.count(), sentence);
}

/// Returns the names of an atom in bonds.
fn ends_of<'a>(atom: &Atom<'a>) -> [End<'a>; 3] {
    let name = |altloc| [atom.chain, atom.number, atom.insertion, atom.name, altloc];
    [
        End::Serial(atom.serial),
        End::Name(name(atom.altloc)),
        End::Name(name("")),
    ]
}

/// The ends that bonds name: far fewer than atoms have.
fn named_ends<'p, 'a>(parsed: &'p Parsed<'a>) -> impl Iterator<Item = &'p End<'a>> {
    parsed.bonds.iter().flat_map(|(_, ends)| ends)
}

/// The bonds between the chosen atoms: those of the file, and those that distances imply.
fn find_bonds(
    source: &Source,
    parsed: &Parsed<'_>,
    atoms: &[&Atom<'_>],
    warnings: &mut Warnings,
) -> Vec<[u32; 2]> {
    let mut ends: HashMap<&End<'_>, Option<u32>> = HashMap::new();
    ends.extend(named_ends(parsed).map(|end| (end, None)));
    if !ends.is_empty() {
        for (atom, index) in atoms.iter().zip(0..) {
            for end in ends_of(atom) {
                if let Some(first) = ends.get_mut(&end) {
                    first.get_or_insert(index);
                }
            }
        }
    }
    // An end that is missing here may be in another model or an alternate location.
    let stated = parsed
        .bonds
        .iter()
        .filter_map(|(_, [a, b])| Some([ends[a]?, ends[b]?]));
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
