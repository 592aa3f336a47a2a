//! Fuzzing of a fixed extent: a number of mutations of a corpus, the same in every run.

use crate::random::Random;
use std::path::{Path, PathBuf};

/// The inputs in a folder, in the order of the files' names.
///
/// # Panics
/// If the corpus is empty.
pub fn corpus(folder: &Path) -> Vec<Vec<u8>> {
    let entries = std::fs::read_dir(folder).expect("the corpus is committed");
    let mut paths: Vec<PathBuf> = entries.map(|it| it.expect("an entry").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{} is empty", folder.display());
    let read = |path: &PathBuf| std::fs::read(path).expect("a file of the corpus");
    paths.iter().map(read).collect()
}

/// Calls a target with every input of a corpus, and with `mutations` mutations of them.
pub fn run(corpus: &[Vec<u8>], mutations: usize, target: fn(&[u8])) {
    for input in corpus {
        target(input);
    }
    let mut random = Random(17);
    for _ in 0..mutations {
        let mut input = corpus[random.below(corpus.len())].clone();
        for _ in 0..=random.below(4) {
            mutate(&mut input, corpus, &mut random);
        }
        target(&input);
    }
}

fn mutate(input: &mut Vec<u8>, corpus: &[Vec<u8>], random: &mut Random) {
    /// Bytes that mean something in some text.
    const LIKELY: &[u8] = b"0123456789-.e#/;'\"_ \n[]{},=";
    if input.is_empty() {
        input.push(random.bits() as u8);
        return;
    }
    let place = random.below(input.len());
    let end = (place + 1 + random.below(16)).min(input.len());
    match random.below(10) {
        0..2 => input[place] = random.bits() as u8,
        2..4 => input[place] = LIKELY[random.below(LIKELY.len())],
        4 => input[place] ^= 1 << random.below(8),
        5 => input[place] = [0, 1, 0x7f, 0x80, 0xff][random.below(5)],
        6 => input.truncate(place),
        7 => drop(input.drain(place..end)),
        8 => {
            // A piece of this or another input, put in between.
            let other = &corpus[random.below(corpus.len())];
            let start = random.below(other.len().max(1));
            let piece = &other[start..(start + 1 + random.below(32)).min(other.len())];
            input.splice(place..place, piece.iter().copied());
        }
        _ => {
            let piece = input[place..end].to_vec();
            input.splice(place..place, piece);
        }
    }
}
