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
mod residues;
mod select;
mod stated;

pub(crate) use bonds::perceive;
pub(crate) use draw::{BoundingSphere, draw};
pub(crate) use element::Element;
pub(crate) use parsed::Site;
pub(super) use parsed::{Atom, Bond, End, Group, Matrix, Model, Operators, Parsed};

use super::importer::Input;
use super::text::{Source, Warnings};
use super::{FileKinds, Imported, Instance, Material, MoleculeStyle, Part, Scene, SceneError};
use crate::table::grouped;
use assembly::{Copied, GENERATED, assemble};
use limit::check_size;
use stated::{find_bonds, missing_ends};

/// Makes a scene of the atoms that `parse` reads from a file.
///
/// # Errors
/// If the file has no atoms, its content is broken (the error names the line), or it lacks the requested model or
/// alternate location.
pub(super) fn import(
    input: Input<'_>,
    parse: impl for<'a> Fn(&'a Source, &mut Warnings) -> Result<Parsed<'a>, SceneError>,
) -> Result<Imported, SceneError> {
    let options = input.options.molecule;
    let assembly = input.options.assembly;
    let source = &input.into_source()?;
    let mut warnings = Warnings::default();
    let mut parsed = parse(source, &mut warnings)?;
    generate(source, &mut parsed, assembly.is_some(), &mut warnings);
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
        kinds: FileKinds {
            molecules: true,
            assemblies: true,
            ..FileKinds::default()
        },
        ..Imported::of(scene, warnings.into_sentences())
    })
}

/// Makes the copies that operators generate an assembly, and warns of them unless an assembly is drawn.
fn generate(source: &Source, parsed: &mut Parsed<'_>, is_chosen: bool, warnings: &mut Warnings) {
    let copies = std::mem::take(&mut parsed.generating);
    let Some(line) = copies.first().map(|it| it.line) else {
        return;
    };
    if !is_chosen {
        let sentence = format!(
            "the file states {} copies of its atoms by operators (MTRIX, struct_ncs_oper), of which one is drawn; \
             `--assembly {GENERATED}` draws all",
            grouped(1 + copies.len())
        );
        warnings.add(source, line, sentence);
    }
    let mut operators = vec![Matrix::identity(line)];
    operators.extend(copies);
    parsed.groups.push(Group {
        assemblies: [GENERATED].into(),
        chains: None,
        operators: Operators::Listed(operators),
        line,
    });
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

#[cfg(test)]
mod tests;
