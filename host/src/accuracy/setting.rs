//! The settings of a sweep: six parameters, each alone and together.

use gridel_core::format::limits::{MAX_RAY_DEPTH, MAX_SAMPLES};
use gridel_core::{Effects, Format};
use serde::{Deserialize, Serialize};

/// The most samples per pixel that can be measured: a reference has twice as many.
pub const MOST_MEASURED_SAMPLES: u16 = MAX_SAMPLES / 2;

/// A key of a setting in maps.
pub(super) type Key = (Format, u8, u16, u8, u64, Effects);

/// A way to build and render a scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    #[serde(with = "format_name")]
    pub format: Format,
    pub lattice_bits: u8,
    pub samples: u16,
    pub depth: u8,
    /// A secondary ray that can change no channel by more than this is not traced.
    pub cutoff: f64,
    /// Effects of the scene that are left out.
    #[serde(default, skip_serializing_if = "is_none", with = "effect_names")]
    pub without: Effects,
}

fn is_none(effects: &Effects) -> bool {
    *effects == Effects::NONE
}

mod effect_names {
    use crate::scene::effect_named;
    use gridel_core::Effects;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub fn serialize<S: Serializer>(effects: &Effects, to: S) -> Result<S::Ok, S::Error> {
        effects.names().collect::<Vec<_>>().serialize(to)
    }

    pub fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<Effects, D::Error> {
        let names = Vec::<String>::deserialize(from)?;
        let effects = names.iter().map(|name| effect_named(name));
        let all = effects.reduce(|all, one| Some(all?.with(one?)));
        let all = all.unwrap_or(Some(Effects::NONE));
        all.ok_or_else(|| D::Error::custom("no such effect"))
    }
}

mod format_name {
    use gridel_core::Format;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub fn serialize<S: Serializer>(format: &Format, to: S) -> Result<S::Ok, S::Error> {
        format.name().serialize(to)
    }

    pub fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<Format, D::Error> {
        let name = String::deserialize(from)?;
        Format::from_name(&name).ok_or_else(|| D::Error::custom("no such number format"))
    }
}

/// One of the six.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Parameter {
    Format,
    LatticeBits,
    Samples,
    Depth,
    Cutoff,
    Effects,
}

impl Parameter {
    pub const ALL: [Parameter; 6] = [
        Parameter::Format,
        Parameter::LatticeBits,
        Parameter::Samples,
        Parameter::Depth,
        Parameter::Cutoff,
        Parameter::Effects,
    ];

    /// Returns its name.
    pub const fn name(self) -> &'static str {
        match self {
            Parameter::Format => "number format",
            Parameter::LatticeBits => "lattice bits",
            Parameter::Samples => "samples per pixel",
            Parameter::Depth => "ray depth",
            Parameter::Cutoff => "contribution cut-off",
            Parameter::Effects => "effects",
        }
    }
}

const BITS: [u8; 5] = [10, 12, 16, 20, 24];
const SAMPLES: [u16; 7] = [1, 2, 4, 8, 16, 32, 64];
const CUTOFFS: [f64; 6] = [
    0.0,
    1.0 / 2048.0,
    1.0 / 512.0,
    1.0 / 128.0,
    1.0 / 32.0,
    1.0 / 8.0,
];

impl Setting {
    /// Returns its short name: `f32-24bit-4spp-6deep-0.002`, and `-without-glass` where effects are left out. Other
    /// settings have other names: the cutoff has all its digits.
    pub fn name(&self) -> String {
        let effects: String = self
            .without
            .names()
            .map(|name| format!("-{name}"))
            .collect();
        let without = if effects.is_empty() { "" } else { "-without" };
        format!(
            "{}-{}bit-{}spp-{}deep-{}{without}{effects}",
            self.format.name(),
            self.lattice_bits,
            self.samples,
            self.depth,
            self.cutoff
        )
    }

    /// Returns a key that distinguishes settings.
    pub(super) fn key(&self) -> Key {
        let Self {
            format,
            lattice_bits,
            samples,
            depth,
            cutoff,
            without,
        } = *self;
        (
            format,
            lattice_bits,
            samples,
            depth,
            cutoff.to_bits(),
            without,
        )
    }

    /// Says in words how it differs from another: `4 samples, without glass`.
    pub fn words(&self, base: &Self) -> String {
        let words = self.differs(base).into_iter().map(|parameter| {
            let value = self.value(parameter);
            match parameter {
                Parameter::Format => value,
                Parameter::LatticeBits => format!("{value} bits"),
                Parameter::Samples if self.samples == 1 => String::from("1 sample"),
                Parameter::Samples => format!("{value} samples"),
                Parameter::Depth => format!("depth {value}"),
                Parameter::Cutoff => format!("cut-off {value}"),
                Parameter::Effects => format!("without {value}"),
            }
        });
        let words = words.collect::<Vec<_>>().join(", ");
        match words.is_empty() {
            true => String::from("as the scene file states"),
            false => words,
        }
    }

    /// Returns the parameters in which it differs from another.
    pub fn differs(&self, other: &Self) -> Vec<Parameter> {
        let differs = |parameter: &Parameter| match parameter {
            Parameter::Format => self.format != other.format,
            Parameter::LatticeBits => self.lattice_bits != other.lattice_bits,
            Parameter::Samples => self.samples != other.samples,
            Parameter::Depth => self.depth != other.depth,
            Parameter::Cutoff => self.cutoff != other.cutoff,
            Parameter::Effects => self.without != other.without,
        };
        Parameter::ALL.into_iter().filter(differs).collect()
    }

    /// Returns the value of a parameter as text.
    pub fn value(&self, parameter: Parameter) -> String {
        match parameter {
            Parameter::Format => self.format.name().to_owned(),
            Parameter::LatticeBits => self.lattice_bits.to_string(),
            Parameter::Samples => self.samples.to_string(),
            Parameter::Depth => self.depth.to_string(),
            Parameter::Cutoff => self.cutoff.to_string(),
            Parameter::Effects => self.without.to_string(),
        }
    }
}

/// Returns the settings of a sweep around the one that the scene file states. First comes that one, then each parameter
/// alone, then combinations. `effects` are those of the scene; each is left out alone. Where none of them sends rays
/// on, depth and cut-off change nothing and are left alone.
pub fn sweep(base: Setting, effects: Effects) -> Vec<Setting> {
    let secondary = effects.work_depth(1) > 0;
    let mut settings = vec![base];
    let mut add = |setting: Setting| {
        if !settings.contains(&setting) {
            settings.push(setting);
        }
    };
    let depths: Vec<u8> = (0..=base.depth.max(4)).collect();
    for format in Format::ALL {
        add(Setting { format, ..base });
    }
    for lattice_bits in BITS {
        add(Setting {
            lattice_bits,
            ..base
        });
    }
    for samples in SAMPLES {
        add(Setting { samples, ..base });
    }
    if secondary {
        for &depth in &depths {
            add(Setting { depth, ..base });
        }
        for cutoff in CUTOFFS {
            add(Setting { cutoff, ..base });
        }
    }
    for (effect, _) in Effects::NAMED {
        if effects.contains(effect) {
            add(Setting {
                without: base.without.with(effect),
                ..base
            });
        }
    }
    // Combinations: the choices of a board, and more samples at less depth.
    for format in [Format::Fixed, Format::F32] {
        for lattice_bits in [12, 16] {
            add(Setting {
                format,
                lattice_bits,
                ..base
            });
        }
        for samples in [1, 4, 16] {
            add(Setting {
                format,
                samples,
                ..base
            });
            if !secondary {
                continue;
            }
            for depth in [2, base.depth] {
                for cutoff in [base.cutoff, 1.0 / 32.0] {
                    add(Setting {
                        format,
                        samples,
                        depth,
                        cutoff,
                        ..base
                    });
                }
            }
        }
    }
    settings
}

/// Returns the fewest samples per pixel of a reference that is better than every setting of a sweep: twice the most of
/// a setting, which is at most [`MOST_MEASURED_SAMPLES`].
pub fn least_reference_samples(settings: &[Setting]) -> u16 {
    let most = settings.iter().map(|setting| setting.samples).max();
    let most = most.unwrap_or(1);
    2 * most.min(MOST_MEASURED_SAMPLES)
}

/// The largest cutoff of a reference.
const REFERENCE_CUTOFF: f64 = 1.0 / 16_384.0;

/// The least cutoff above 0 that a blob stores. At 0 a ray could cause 2 to the power of the ray depth others.
const LEAST_CUTOFF: f64 = 1.0 / 1_048_576.0;

/// Returns the setting of a reference for some settings: double precision, the finest lattice, the largest ray depth. Its
/// cutoff is the least of theirs and 2^-14, but 2^-20 where theirs is less.
///
/// ```
/// use gridel_host::accuracy::reference_setting;
///
/// let most = reference_setting(256, &[]);
/// assert_eq!((most.samples, most.depth, most.cutoff), (256, 32, 1.0 / 16_384.0));
/// ```
pub fn reference_setting(samples: u16, measured: &[Setting]) -> Setting {
    let cutoffs = measured.iter().map(|setting| setting.cutoff);
    Setting {
        format: Format::F64,
        lattice_bits: 24,
        samples,
        depth: MAX_RAY_DEPTH as u8,
        cutoff: cutoffs.fold(REFERENCE_CUTOFF, f64::min).max(LEAST_CUTOFF),
        without: Effects::NONE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_parameter_is_changed_alone_and_nothing_twice() {
        let base = Setting {
            format: Format::F32,
            lattice_bits: 24,
            samples: 1,
            depth: 6,
            cutoff: 1.0 / 512.0,
            without: Effects::NONE,
        };
        let settings = sweep(base, Effects::SHADOW.with(Effects::MIRROR));
        for parameter in Parameter::ALL {
            let alone = settings.iter().filter(|s| s.differs(&base) == [parameter]);
            assert!(alone.count() >= 2, "{parameter:?}");
        }
        for (number, setting) in settings.iter().enumerate() {
            assert!(!settings[..number].contains(setting), "{setting:?}");
        }
        let plain = sweep(base, Effects::NONE);
        assert!(
            plain
                .iter()
                .all(|s| s.depth == 6 && s.cutoff == base.cutoff)
        );
        assert_eq!(settings[0].name(), "f32-24bit-1spp-6deep-0.001953125");
        let bare = Setting {
            samples: 4,
            without: Effects::SHADOW.with(Effects::MIRROR),
            ..base
        };
        assert_eq!(
            bare.name(),
            "f32-24bit-4spp-6deep-0.001953125-without-shadow-mirror"
        );
        assert_eq!(bare.words(&base), "4 samples, without shadow, mirror");
        let text = serde_json::to_string(&bare).unwrap();
        assert_eq!(serde_json::from_str::<Setting>(&text).unwrap(), bare);
        assert!(!serde_json::to_string(&base).unwrap().contains("without"));
    }

    /// Cutoffs that differ in the fourth digit alone have other names, which name files.
    #[test]
    fn settings_that_differ_have_names_that_differ() {
        let base = Setting {
            format: Format::F32,
            lattice_bits: 24,
            samples: 1,
            depth: 6,
            cutoff: 0.00195,
            without: Effects::NONE,
        };
        let settings = sweep(base, Effects::MIRROR);
        let names: HashSet<String> = settings.iter().map(Setting::name).collect();
        assert_eq!(names.len(), settings.len());
        let keys: HashSet<Key> = settings.iter().map(Setting::key).collect();
        assert_eq!(keys.len(), settings.len());
    }

    /// A reference traces all that the settings trace.
    #[test]
    fn reference_has_the_least_cutoff_of_all() {
        let with = |cutoff: f64| Setting {
            cutoff,
            ..reference_setting(1, &[])
        };
        for (cutoffs, expected) in [
            (&[1.0 / 512.0, 0.5][..], f64::powi(2.0, -14)),
            (&[1.0 / 512.0, 1e-5], 1e-5),
            (&[1.0 / 512.0, 0.0], f64::powi(2.0, -20)),
        ] {
            let settings: Vec<Setting> = cutoffs.iter().map(|&it| with(it)).collect();
            assert_eq!(reference_setting(1, &settings).cutoff, expected);
        }
    }
}
