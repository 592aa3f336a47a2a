//! Reads NFF, the Neutral File Format of Eric Haines's Standard Procedural Databases (version
//! 3.1 of its text, 1992).
//!
//! Where the format leaves a meaning open, the databases' reference pictures decide:
//! * Colors and lights are display values: they are added up and shown as they are.
//! * A light without a color has intensity 1 / sqrt(n), n being the number of lights.
//! * Ambient light, which the format does not have, is the part of 1 that Kd, Ks and T of a
//!   material leave, relative to Kd. It is the mean over all materials that objects have, each at
//!   most 1.
//! * `angle` is the full vertical field of view. `hither` is not needed.
//! * In `f`, Kd (1 - T) weighs the color, and Ks is the gray mirror. Ks is also the white
//!   highlight, up to 1 - Ks. T filters the transmitted light by the color. Shine is the exponent
//!   of Phong's cosine, between the view and the mirrored light. The halfway vector leans half as
//!   far, so the exponent is four times as large.
//! * Values beyond those of a blob are limited, with a warning: lights and the background to 2047, the parts of
//!   materials to 1, and Shine to 256.
//! * A negative radius (only the inside is visible) counts as its absolute value, since both sides
//!   are drawn.
//! * Polygons and patches are one mesh each, every other primitive one object, in file order.

mod reader;
mod shapes;
mod view;

use super::importer::{Importer as Entry, Input};
use super::size::Size;
use super::text::{Source, Warnings};
use super::{BRIGHTEST, Color, Diffuse, Imported, Light, Material, Scene, SceneError};
use crate::table::shortened;
use glam::DVec3;
use gridel_core::Up;
use reader::{Line, Lines};
use std::collections::{BTreeSet, HashMap};

/// The factor from the exponent of Phong's cosine to that of the halfway vector's.
const PHONG_TO_HALFWAY: f64 = 4.0;

/// The largest exponent of Phong's cosine that a material holds.
const MOST_SHINE: f64 = 1024.0 / PHONG_TO_HALFWAY;

pub(super) const IMPORTER: Entry = Entry {
    name: "NFF",
    about: "Haines's Neutral File Format, with camera and lights",
    extensions: &["nff"],
    // Files have a camera; in the databases' own scenes z is up.
    up: Up::Z,
    binary: false,
    example: "b 0 0 .5\nv\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 64 48\n\
              l 1 2 3\nf 1 .5 0 .8 .25 20 .5 1.5\ns 1 2 3 4\n",
    recognizes: |bytes| {
        let mut lines = bytes.split(|&byte| byte == b'\n');
        let mut words = lines.find_map(|line| {
            let mut words = str::from_utf8(line).ok()?.split_ascii_whitespace();
            let first = words.next().filter(|word| !word.starts_with('#'))?;
            Some((first, words.count()))
        });
        // The first entity, and how many numbers follow it on its line.
        matches!(
            words.take(),
            Some(
                ("v", 0)
                    | ("b", 3)
                    | ("l", 3 | 6)
                    | ("f", 8)
                    | ("s", 4)
                    | ("c", 0)
                    | ("p" | "pp", 1)
            )
        )
    },
    read,
};

/// Reads an NFF file.
///
/// # Errors
/// If its content is broken; the error names the line.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let source = &input.into_source()?;
    let mut importer = Importer::new(source);
    let mut lines = Lines::new(source);
    while let Some(line) = lines.next() {
        importer.entity(&line, &mut lines)?;
    }
    importer.finish()
}

struct Importer<'a> {
    source: &'a Source,
    scene: Scene,
    warnings: Warnings,
    /// Lights whose color is to be set once all are counted.
    plain_lights: Vec<usize>,
    /// Index of a material by the bits of its eight numbers.
    materials: HashMap<[u64; 8], usize>,
    material: Option<usize>,
    /// Ambient light that a material states.
    ambient: HashMap<usize, f64>,
    /// Number of spheres, cones and polygons, for their names.
    counts: [usize; 3],
    size: Size,
}

impl<'a> Importer<'a> {
    fn new(source: &'a Source) -> Self {
        Self {
            source,
            scene: Scene {
                display_values: true,
                unnamed: true,
                ..Scene::default()
            },
            warnings: Warnings::default(),
            plain_lights: Vec::new(),
            materials: HashMap::new(),
            material: None,
            ambient: HashMap::new(),
            counts: [0; 3],
            size: Size::default(),
        }
    }

    fn entity(&mut self, line: &Line<'a>, lines: &mut Lines<'a>) -> Result<(), SceneError> {
        match line.word(0) {
            "v" => self.view(line, lines),
            "b" => self.background(line),
            "l" => self.light(line),
            "f" => self.fill(line),
            "s" => self.sphere(line),
            "c" => self.cone(line, lines),
            "p" => self.polygon(line, lines, 3),
            "pp" => self.polygon(line, lines, 6),
            word if word.parse::<f64>().is_ok() => Err(self.source.error_at(
                word,
                format!("the number {} belongs to no entity", shortened(word)),
                "start a line with v, b, l, f, s, c, p or pp, or correct the vertex count before it",
            )),
            word => {
                self.warnings.add(self.source, line.number, format!("the entity {word:?} is unknown and ignored", word = shortened(word)));
                Ok(())
            }
        }
    }

    fn background(&mut self, line: &Line<'a>) -> Result<(), SceneError> {
        let numbers = line.numbers::<3>(self.source, &mut self.warnings, 1, "b r g b")?;
        let color = self.color(line, numbers)?;
        let color = self.limited(line, "the background", BRIGHTEST, color);
        self.scene.background = Some(color);
        Ok(())
    }

    fn light(&mut self, line: &Line<'a>) -> Result<(), SceneError> {
        let given = line.words.len() - 1;
        let color = match given {
            3 => {
                self.plain_lights.push(self.scene.lights.len());
                [1.0; 3]
            }
            given if given >= 6 => {
                let [_, _, _, color @ ..] =
                    line.numbers::<6>(self.source, &mut self.warnings, 1, "l x y z r g b")?;
                let color = self.color(line, color)?;
                self.limited(line, "the color of a light", BRIGHTEST, color)
            }
            _ => {
                return Err(self.source.error_at(
                    line.text,
                    format!("a light has a position (3 numbers) or a position and a color (6), not {given} numbers"),
                    "write `l x y z` or `l x y z r g b`",
                ));
            }
        };
        let mut position = [0.0; 3];
        for (axis, value) in position.iter_mut().enumerate() {
            *value = self
                .source
                .number(line.word(axis + 1), "a coordinate of the light")?;
        }
        self.scene.lights.push(Light::Point {
            position: DVec3::from_array(position),
            color,
        });
        let place = self.source.place(line.number);
        self.scene.places.lights.push(place);
        Ok(())
    }

    /// Checks a color that may not be negative.
    fn color(&self, line: &Line<'a>, color: Color) -> Result<Color, SceneError> {
        if color.iter().any(|&c| c < 0.0) {
            return Err(self.source.error_at(
                line.text,
                "a color is negative",
                "write numbers from 0 to 1",
            ));
        }
        Ok(color)
    }

    /// Limits a color to what a blob holds.
    fn limited(&mut self, line: &Line<'a>, what: &str, most: f64, color: Color) -> Color {
        if color.iter().any(|&channel| channel > most) {
            let sentence = format!("{what} is limited to the range 0 to {most}");
            self.warnings.add(self.source, line.number, sentence);
        }
        color.map(|channel| channel.min(most))
    }

    /// Reads the numbers of a material.
    fn fill_numbers(&mut self, line: &Line<'a>) -> Result<[f64; 8], SceneError> {
        let format = "f r g b Kd Ks Shine T ior";
        let numbers = match line.numbers_from(1) {
            // Short lines are common in files written by hand. The missing numbers are those that
            // say "opaque".
            given @ (6 | 7) => {
                self.warnings.add(
                    self.source,
                    line.number,
                    format!("a material of {given} numbers instead of 8 is read as opaque"),
                );
                let [r, g, b, kd, ks, shine] =
                    line.numbers::<6>(self.source, &mut self.warnings, 1, format)?;
                if given == 7
                    && line.numbers::<7>(self.source, &mut self.warnings, 1, format)?[6] != 0.0
                {
                    return Err(self.source.error_at(
                        line.text,
                        "a transparent material has no index of refraction",
                        format!("write `{format}`, with ior 1.5 for glass"),
                    ));
                }
                [r, g, b, kd, ks, shine, 0.0, 1.0]
            }
            _ => line.numbers::<8>(self.source, &mut self.warnings, 1, format)?,
        };
        self.color(line, [numbers[0], numbers[1], numbers[2]])?;
        if let Some(value) = [3, 4, 5, 6]
            .into_iter()
            .map(|i| numbers[i])
            .find(|&value| value < 0.0)
        {
            return Err(self.source.error_at(
                line.text,
                format!("Kd, Ks, Shine and T may not be negative, but one is {value}"),
                "write numbers at or above 0",
            ));
        }
        Ok(numbers)
    }

    fn fill(&mut self, line: &Line<'a>) -> Result<(), SceneError> {
        let numbers = self.fill_numbers(line)?;
        let key = numbers.map(f64::to_bits);
        if let Some(&known) = self.materials.get(&key) {
            self.material = Some(known);
            return Ok(());
        }
        let [r, g, b, kd, ks, shine, transmit, ior] = numbers;
        if transmit > 0.0 && !(1.0..=4.0).contains(&ior) {
            self.warnings.add(
                self.source,
                line.number,
                format!(
                    "the index of refraction {ior} is taken as {}, since it must be 1 to 4",
                    ior.clamp(1.0, 4.0)
                ),
            );
        }
        let diffuse = [r, g, b].map(|c| c * kd * (1.0 - transmit).max(0.0));
        let diffuse = self.limited(
            line,
            "the color of a material times Kd (1 - T)",
            1.0,
            diffuse,
        );
        let mirror = self.limited(line, "Ks", 1.0, [ks; 3]);
        let transmitted = [r, g, b].map(|c| c * transmit);
        let transmitted = self.limited(line, "the color of a material times T", 1.0, transmitted);
        let highlight = ks.min((1.0 - ks).max(0.0));
        if highlight > 0.0 && shine > MOST_SHINE {
            let sentence = format!("Shine is limited to the range 0 to {MOST_SHINE}");
            self.warnings.add(self.source, line.number, sentence);
        }
        let index = self.scene.materials.len();
        self.scene.materials.push(Material {
            name: format!("fill {}", index + 1),
            diffuse: Diffuse::Plain(diffuse),
            highlight: [highlight; 3],
            shininess: (PHONG_TO_HALFWAY * shine.min(MOST_SHINE)).round().max(1.0) as u16,
            mirror,
            transmit: transmitted,
            ior: ior.clamp(1.0, 4.0),
            place: self.source.place(line.number),
            ..Material::default()
        });
        self.materials.insert(key, index);
        let left = (1.0 - kd - ks - transmit).max(0.0);
        self.ambient
            .insert(index, if kd > 0.0 { (left / kd).min(1.0) } else { 0.0 });
        self.material = Some(index);
        Ok(())
    }

    fn finish(mut self) -> Result<Imported, SceneError> {
        if self.scene.objects.is_empty() {
            return Err(self.source.error(
                "the file has no objects",
                "add spheres (s), cones (c) or polygons (p, pp), or check that the file is NFF",
            ));
        }
        let intensity = 1.0 / (self.scene.lights.len() as f64).sqrt();
        for &plain in &self.plain_lights {
            if let Light::Point { color, .. } = &mut self.scene.lights[plain] {
                *color = [intensity; 3];
            }
        }
        let used: BTreeSet<usize> = self.scene.objects.iter().map(|o| o.material).collect();
        let stated = |index| self.ambient.get(index).copied().unwrap_or(0.0);
        let ambient = used.iter().map(stated).sum::<f64>() / used.len() as f64;
        self.scene.ambient = [ambient; 3];
        Ok(Imported::of(self.scene, self.warnings.into_sentences()))
    }
}

#[cfg(test)]
mod tests;
