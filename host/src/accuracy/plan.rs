//! The settings that are still to be measured, and the pictures that they need.

use super::setting::{Key, Setting};
use gridel_core::{Effects, Format};

/// The settings that the first hits of a picture depend on: number format, lattice bits, effects left out.
pub type HitsKey = (Format, u8, Effects);

pub fn hits_key(setting: &Setting) -> HitsKey {
    (setting.format, setting.lattice_bits, setting.without)
}

/// The setting of the true picture of a setting.
pub fn in_f64(setting: &Setting) -> Setting {
    Setting {
        format: Format::F64,
        ..*setting
    }
}

/// The setting with all effects.
pub fn with_all(setting: &Setting) -> Setting {
    Setting {
        without: Effects::NONE,
        ..*setting
    }
}

/// The settings that are still to be measured; `None` if that is not known.
#[derive(Debug, Default)]
pub struct Plan(Option<Vec<Setting>>);

impl Plan {
    pub fn of(settings: Vec<Setting>) -> Self {
        Self(Some(settings))
    }

    /// Notes that a setting was measured.
    pub fn measured(&mut self, setting: &Setting) {
        if let Some(rest) = &mut self.0 {
            rest.retain(|it| it != setting);
        }
    }

    pub fn needs_hits(&self, key: &HitsKey) -> bool {
        self.needs(|it| hits_key(it) == *key || hits_key(&with_all(it)) == *key)
    }

    pub fn needs_picture(&self, key: &Key) -> bool {
        self.needs(|it| {
            let without_some = it.without != Effects::NONE;
            in_f64(it).key() == *key || without_some && with_all(it).key() == *key
        })
    }

    fn needs(&self, by: impl Fn(&Setting) -> bool) -> bool {
        self.0.as_ref().is_none_or(|rest| rest.iter().any(by))
    }
}
