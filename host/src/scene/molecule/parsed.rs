//! The content of a molecule file.

use super::element::Element;
use crate::scene::size::MOST_BYTES;
use glam::DVec3;
use std::collections::HashMap;
use std::rc::Rc;

/// The bytes that are left for the content of a file. A line can be shorter than the memory of what it states.
pub(super) struct Left(pub(super) usize);

impl Default for Left {
    fn default() -> Self {
        // While a list grows, it takes its bytes twice.
        Self(MOST_BYTES as usize / 2)
    }
}

/// An element at a position in angstroms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Site {
    pub(crate) element: Element,
    pub(crate) position: DVec3,
}

/// An atom as the file has it; fields that the file does not state are empty.
#[derive(Default)]
pub(in crate::scene) struct Atom<'a> {
    pub(in crate::scene) site: Site,
    pub(in crate::scene) line: usize,
    /// Index of its model in the file, counted from 0.
    pub(in crate::scene) model: usize,
    pub(in crate::scene) serial: &'a str,
    pub(in crate::scene) name: &'a str,
    pub(in crate::scene) altloc: &'a str,
    pub(in crate::scene) chain: &'a str,
    /// The chain's name in assemblies.
    pub(in crate::scene) asym: &'a str,
    pub(in crate::scene) residue: &'a str,
    /// Number of the residue in its chain, and the code of residues inserted after it.
    pub(in crate::scene) number: &'a str,
    pub(in crate::scene) insertion: &'a str,
    /// The archive's number of the residue in `asym`, in mmCIF.
    pub(in crate::scene) label: &'a str,
    /// Distinguishes residues of one chain and number: the segment in PDB, and in mmCIF the archive's chain of residues
    /// that the author did not number.
    pub(in crate::scene) segment: &'a str,
}

impl<'a> Atom<'a> {
    pub(in crate::scene) fn full_name(&self) -> String {
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
pub(in crate::scene) enum End<'a> {
    /// An atom's serial number, in PDB.
    Serial(&'a str),
    /// Chain, residue number, insertion code, atom name and alternate location. An empty location stands for any.
    Name([&'a str; 5]),
    /// The archive's chain and residue number, atom name and alternate location, in mmCIF.
    Label([&'a str; 4]),
}

/// One of the models of a file.
pub(in crate::scene) struct Model<'a> {
    /// The number that the file gives it; empty where files do not number them.
    pub(in crate::scene) number: &'a str,
    pub(in crate::scene) line: usize,
}

/// Chains of an assembly that have operators in common, as the file has them.
pub(in crate::scene) struct Group<'a> {
    /// The numbers or names of the assemblies that it belongs to.
    pub(in crate::scene) assemblies: Rc<[&'a str]>,
    /// Names of chains as in [`Atom::asym`]; `None` for all.
    pub(in crate::scene) chains: Option<Vec<&'a str>>,
    pub(in crate::scene) operators: Operators<'a>,
    pub(in crate::scene) line: usize,
}

/// An operator as the file writes it.
#[derive(Clone)]
pub(in crate::scene) struct Matrix<'a> {
    pub(in crate::scene) name: &'a str,
    /// Three rows of the rotation, each with its displacement behind it; empty where one is missing.
    pub(in crate::scene) words: [[&'a str; 4]; 3],
    pub(in crate::scene) line: usize,
    /// The line of another one that has its name.
    pub(in crate::scene) again: Option<usize>,
}

impl Matrix<'_> {
    /// Returns whether two have the same words.
    pub(in crate::scene) fn agrees(&self, other: &Self) -> bool {
        self.words == other.words
    }

    /// An operator that leaves atoms where they are.
    pub(super) fn identity(line: usize) -> Self {
        Self {
            name: "0",
            words: [0, 1, 2].map(|row| {
                let word = |column| if column == row { "1" } else { "0" };
                [0, 1, 2, 3].map(word)
            }),
            line,
            again: None,
        }
    }

    pub(super) fn is_identity(&self) -> bool {
        let is = |word: &&str, number: f64| word.parse() == Ok(number);
        let mut rows = self.words.iter().zip(0..);
        rows.all(|(row, at)| {
            let mut words = row.iter().zip(0..);
            words.all(|(word, column)| is(word, f64::from(u8::from(at == column))))
        })
    }
}

/// The operators of a group of chains, unread.
pub(in crate::scene) enum Operators<'a> {
    Listed(Vec<Matrix<'a>>),
    /// Names of operators in [`Parsed::operators`], such as `(1-60)(61,P)`. Each factor in parentheses means several
    /// operators, and the rightmost applies first.
    Expression(&'a str),
}

/// A bond that the file states.
pub(in crate::scene) struct Bond<'a> {
    /// The record or category that states it.
    pub(in crate::scene) record: &'static str,
    pub(in crate::scene) line: usize,
    pub(in crate::scene) ends: [End<'a>; 2],
}

/// The content of a file, before one model and one set of alternate locations is chosen.
#[derive(Default)]
pub(in crate::scene) struct Parsed<'a> {
    pub(in crate::scene) atoms: Vec<Atom<'a>>,
    /// In file order.
    pub(in crate::scene) models: Vec<Model<'a>>,
    pub(in crate::scene) bonds: Vec<Bond<'a>>,
    /// The assemblies, in file order.
    pub(in crate::scene) groups: Vec<Group<'a>>,
    /// Operators by their name, for expressions.
    pub(in crate::scene) operators: HashMap<&'a str, Matrix<'a>>,
    /// Operators that generate the rest of the asymmetric unit from the atoms of the file.
    pub(in crate::scene) generating: Vec<Matrix<'a>>,
    /// The memory that is left for more.
    pub(super) left: Left,
}
