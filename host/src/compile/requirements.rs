//! Which effects a scene requires, and which of its parts require them.

use gridel_core::Effects;

/// Effects, each time with the part of the scene that requires them.
#[derive(Clone, Debug, Default)]
pub struct Requirements(Vec<(Effects, String)>);

impl Requirements {
    pub fn add(&mut self, effects: Effects, part: impl Into<String>) {
        self.0.push((effects, part.into()));
    }

    pub fn extend(&mut self, others: &Self) {
        self.0.extend_from_slice(&others.0);
    }

    /// All effects that the scene requires.
    pub fn effects(&self) -> Effects {
        let effects = self.0.iter().map(|(effects, _)| *effects);
        effects.fold(Effects::NONE, Effects::with)
    }

    /// The names of the effects, and of the parts that require each.
    pub fn by_effect(&self) -> Vec<(String, Vec<String>)> {
        let parts = |effect| {
            let all = self.0.iter();
            let requiring = all.filter(move |(effects, _)| effects.contains(effect));
            requiring.map(|(_, part)| part.clone()).collect()
        };
        let required = self.effects();
        let named = Effects::NAMED.iter();
        let named = named.filter(|(effect, _)| required.contains(*effect));
        named
            .map(|&(effect, name)| (String::from(name), parts(effect)))
            .collect()
    }
}
