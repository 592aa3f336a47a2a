//! The parts of flash and RAM.

use serde::Serialize;

/// One kind of memory: what there is, and what takes it.
#[derive(Clone, Debug, Serialize)]
pub struct Account {
    pub available: u64,
    /// Bytes of all items; `None` where one of them is not known.
    pub used: Option<u64>,
    pub items: Vec<Item>,
}

/// Something that takes memory.
#[derive(Clone, Debug, Serialize)]
pub struct Item {
    pub what: String,
    /// `None` where they are not known.
    pub bytes: Option<u64>,
}

impl Account {
    pub(super) fn new(available: u64) -> Self {
        Self {
            available,
            used: Some(0),
            items: Vec::new(),
        }
    }

    /// Bytes of the items that are known.
    pub(super) fn at_least(&self) -> u64 {
        self.items.iter().filter_map(|item| item.bytes).sum()
    }

    /// Returns the least number of bytes that are missing; 0 where the known figures fit.
    pub fn missing(&self) -> u64 {
        self.at_least().saturating_sub(self.available)
    }

    /// Bytes that remain, 0 where it does not fit; `None` where that is not known.
    pub fn remains(&self) -> Option<u64> {
        self.used.map(|used| self.available.saturating_sub(used))
    }

    /// Returns the items that are not known.
    pub fn unknown(&self) -> impl Iterator<Item = &str> {
        let unknown = self.items.iter().filter(|item| item.bytes.is_none());
        unknown.map(|item| item.what.as_str())
    }

    pub(super) fn add(&mut self, what: impl Into<String>, bytes: Option<u64>) {
        let what = what.into();
        self.used = self.used.zip(bytes).map(|(sum, bytes)| sum + bytes);
        self.items.push(Item { what, bytes });
    }
}
