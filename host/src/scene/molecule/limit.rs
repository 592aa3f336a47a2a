//! Limits of the content of a file, so that it fits into memory.

use super::parsed::{Atom, Bond, Group, Left, Matrix, Model, Parsed};
use crate::scene::SceneError;
use crate::scene::size::Size;
use crate::scene::text::Source;
use crate::table::counted;

/// Bytes of an entry of an index, with the part of the index that is empty.
const INDEX: usize = 64;
/// Bytes of a name of a chain, with the copies that an assembly makes.
const CHAIN: usize = 4 * size_of::<&str>();

impl<'a> Parsed<'a> {
    /// Adds an atom, unless there are too many.
    pub(in crate::scene) fn add(
        &mut self,
        source: &Source,
        atom: Atom<'a>,
    ) -> Result<(), SceneError> {
        let index = if atom.altloc.is_empty() { 0 } else { INDEX };
        self.spend(source, atom.line, size_of::<Atom>() + index)?;
        self.atoms.push(atom);
        Ok(())
    }

    /// Adds a model, likewise.
    pub(in crate::scene) fn add_model(
        &mut self,
        source: &Source,
        model: Model<'a>,
    ) -> Result<(), SceneError> {
        self.spend(source, model.line, size_of::<Model>() + INDEX)?;
        self.models.push(model);
        Ok(())
    }

    /// Adds a bond, likewise.
    pub(in crate::scene) fn add_bond(
        &mut self,
        source: &Source,
        bond: Bond<'a>,
    ) -> Result<(), SceneError> {
        self.spend(source, bond.line, size_of::<Bond>() + INDEX)?;
        self.bonds.push(bond);
        Ok(())
    }

    /// Adds a group of chains, likewise, whose names are [accounted](Self::spend_names) for.
    pub(in crate::scene) fn add_group(
        &mut self,
        source: &Source,
        group: Group<'a>,
    ) -> Result<(), SceneError> {
        self.spend(source, group.line, size_of::<Group>() + 2 * INDEX)?;
        self.groups.push(group);
        Ok(())
    }

    /// Accounts for names of chains or assemblies that a group gets.
    pub(in crate::scene) fn spend_names(
        &mut self,
        source: &Source,
        line: usize,
        names: usize,
    ) -> Result<(), SceneError> {
        self.spend(source, line, names.saturating_mul(CHAIN))
    }

    /// Accounts for an operator.
    pub(in crate::scene) fn spend_operator(
        &mut self,
        source: &Source,
        line: usize,
    ) -> Result<(), SceneError> {
        self.spend(source, line, size_of::<Matrix>() + INDEX)
    }

    /// Adds an operator that generates a copy of all atoms, likewise. The identity generates none.
    pub(in crate::scene) fn add_generating(
        &mut self,
        source: &Source,
        operator: Matrix<'a>,
    ) -> Result<(), SceneError> {
        if !operator.is_identity() {
            self.spend(source, operator.line, size_of::<Matrix>() + INDEX)?;
            self.generating.push(operator);
        }
        Ok(())
    }

    fn spend(&mut self, source: &Source, line: usize, bytes: usize) -> Result<(), SceneError> {
        if let Some(left) = self.left.0.checked_sub(bytes) {
            self.left = Left(left);
            return Ok(());
        }
        let found = [
            (self.models.len(), "model"),
            (self.atoms.len(), "atom"),
            (self.bonds.len(), "bond"),
            (self.groups.len(), "assembly group"),
            (self.operators.len(), "operator"),
        ];
        let found = found.into_iter().filter(|(count, _)| *count > 0);
        let mut found = found.map(|(count, what)| counted(count, what));
        let before = match found.next() {
            None => String::new(),
            Some(first) => found.fold(format!("; before this line come {first}"), |text, more| {
                format!("{text}, {more}")
            }),
        };
        let cause = format!("the file lists more than fits into memory{before}");
        let remedy = "leave models, bonds or assemblies out, or parts of the molecule";
        Err(source.error(cause, remedy).at_line(line))
    }
}

/// Rejects atoms and bonds whose objects fit into no memory.
pub(super) fn check_size(source: &Source, atoms: usize, bonds: usize) -> Result<(), SceneError> {
    // A name has a few words with a few letters each.
    let of = |objects: usize| {
        let size = Size {
            objects: objects as u64,
            ..Size::default()
        };
        size.excess()
    };
    let all = of(atoms + 2 * bonds);
    let (cause, remedy) = match (of(atoms), all) {
        (Some(excess), _) => (
            format!("{} take {excess}", counted(atoms, "atom")),
            "draw another model or assembly, or a part of the molecule",
        ),
        (None, Some(excess)) => (
            format!(
                "{} of {} take {excess}",
                counted(bonds, "bond"),
                counted(atoms, "atom")
            ),
            "use the style space-filling, or check that the coordinates are in angstroms",
        ),
        (None, None) => return Ok(()),
    };
    Err(source.error(cause, remedy))
}
