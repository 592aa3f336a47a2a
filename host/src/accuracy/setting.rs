//! The settings of a sweep: five parameters, each alone and together.

use gridel_core::Format;
use serde::{Deserialize, Serialize};

/// The most samples per pixel of a reference, unless a setting has more.
const REFERENCE_SAMPLES: u16 = 256;

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
}

mod format_name {
    use gridel_core::Format;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub fn serialize<S: Serializer>(format: &Format, to: S) -> Result<S::Ok, S::Error> {
        format.name().serialize(to)
    }

    pub fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<Format, D::Error> {
        let name = String::deserialize(from)?;
        let mut all = Format::ALL.into_iter();
        all.find(|format| format.name() == name)
            .ok_or_else(|| D::Error::custom("no such number format"))
    }
}

/// One of the five.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Parameter {
    Format,
    LatticeBits,
    Samples,
    Depth,
    Cutoff,
}

impl Parameter {
    pub const ALL: [Parameter; 5] = [
        Parameter::Format,
        Parameter::LatticeBits,
        Parameter::Samples,
        Parameter::Depth,
        Parameter::Cutoff,
    ];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Parameter::Format => "number format",
            Parameter::LatticeBits => "lattice bits",
            Parameter::Samples => "samples per pixel",
            Parameter::Depth => "ray depth",
            Parameter::Cutoff => "contribution cut-off",
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
    /// Its short name: `f32-24bit-4spp-6deep-0.002`.
    pub fn name(&self) -> String {
        format!(
            "{}-{}bit-{}spp-{}deep-{}",
            self.format.name(),
            self.lattice_bits,
            self.samples,
            self.depth,
            cutoff_text(self.cutoff)
        )
    }

    /// The parameters in which it differs from another.
    pub fn differs(&self, other: &Self) -> Vec<Parameter> {
        let differs = |parameter: &Parameter| match parameter {
            Parameter::Format => self.format != other.format,
            Parameter::LatticeBits => self.lattice_bits != other.lattice_bits,
            Parameter::Samples => self.samples != other.samples,
            Parameter::Depth => self.depth != other.depth,
            Parameter::Cutoff => self.cutoff != other.cutoff,
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
            Parameter::Cutoff => cutoff_text(self.cutoff),
        }
    }
}

fn cutoff_text(cutoff: f64) -> String {
    // Three digits distinguish them.
    format!("{cutoff:.2e}")
        .parse::<f64>()
        .map_or_else(|_| cutoff.to_string(), |x| x.to_string())
}

/// The settings of a sweep around the one that the scene file states: first that one, then each parameter
/// alone, then together. `secondary` says whether anything in the scene reflects or refracts; without,
/// depth and cut-off change nothing and are left alone.
pub fn sweep(base: Setting, secondary: bool) -> Vec<Setting> {
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
    // Together: what a board can choose between, and what raises samples at less depth.
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

/// The fewest samples per pixel of a reference that is better than every setting of a sweep: twice the
/// most of theirs, as far as pictures can have so many.
pub fn least_reference_samples(settings: &[Setting]) -> u16 {
    let most = settings.iter().map(|setting| setting.samples).max();
    let most = most.unwrap_or(1);
    (2 * most).min(REFERENCE_SAMPLES.max(most))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lever_is_turned_alone_and_nothing_twice() {
        let base = Setting {
            format: Format::F32,
            lattice_bits: 24,
            samples: 1,
            depth: 6,
            cutoff: 1.0 / 512.0,
        };
        let settings = sweep(base, true);
        for parameter in Parameter::ALL {
            let alone = settings.iter().filter(|s| s.differs(&base) == [parameter]);
            assert!(alone.count() >= 2, "{parameter:?}");
        }
        for (number, setting) in settings.iter().enumerate() {
            assert!(!settings[..number].contains(setting), "{setting:?}");
        }
        let plain = sweep(base, false);
        assert!(
            plain
                .iter()
                .all(|s| s.depth == 6 && s.cutoff == base.cutoff)
        );
        assert_eq!(settings[0].name(), "f32-24bit-1spp-6deep-0.00195");
    }
}
