//! Reads MTL, the materials of OBJ.
//!
//! `Kd` is the diffuse color. `Ks` and `Ns` are the highlight, unless `illum` is 0 or 1, which
//! have none. `illum` 3, 5 and 8 mirror with `Ks`. `illum` 4, 6, 7 and 9 are glass of index `Ni`
//! that lets `Tf` through. Otherwise `d` below 1 (or `Tr` above 0, of which `d` takes precedence)
//! is a pane that does not bend light: glass of index 1. `Ka` is not needed, because ambient light
//! takes the diffuse color. Everything else is ignored, with a warning.

use crate::scene::text::{Source, Warnings};
use crate::scene::{Color, Diffuse, Material, SceneError};

/// One material of a file.
#[derive(Default)]
struct Statements {
    name: String,
    line: usize,
    diffuse: Option<Color>,
    specular: Option<Color>,
    filter: Option<Color>,
    exponent: Option<f64>,
    density: Option<f64>,
    dissolve: Option<f64>,
    transparency: Option<f64>,
    illumination: Option<u32>,
}

/// Reads the materials by name; a later one replaces an earlier one of its name.
pub(super) fn read(
    source: &Source,
    warnings: &mut Warnings,
) -> Result<Vec<(String, Material)>, SceneError> {
    let mut all: Vec<Statements> = Vec::new();
    for (number, line) in source.lines() {
        let words: Vec<&str> = line
            .split_whitespace()
            .take_while(|word| !word.starts_with('#'))
            .collect();
        let Some((&keyword, values)) = words.split_first() else {
            continue;
        };
        if keyword == "newmtl" {
            // Names keep their spaces and number signs.
            let name = line
                .trim()
                .strip_prefix(keyword)
                .unwrap_or("")
                .trim()
                .to_owned();
            all.push(Statements {
                name,
                line: number,
                ..Statements::default()
            });
            continue;
        }
        let Some(material) = all.last_mut() else {
            warnings.add(
                source,
                number,
                "what comes before the first `newmtl` is passed over",
            );
            continue;
        };
        let line = line.trim();
        let reader = Reader {
            source,
            line,
            keyword,
            values,
        };
        match keyword {
            "Kd" => material.diffuse = reader.color(number, warnings)?,
            "Ks" => material.specular = reader.color(number, warnings)?,
            "Tf" => material.filter = reader.color(number, warnings)?,
            "Ns" => material.exponent = Some(reader.number()?),
            "Ni" => material.density = Some(reader.number()?),
            "d" => material.dissolve = Some(reader.number()?.clamp(0.0, 1.0)),
            "Tr" => material.transparency = Some(reader.number()?.clamp(0.0, 1.0)),
            "illum" => material.illumination = Some(reader.number()?.clamp(0.0, 255.0) as u32),
            "Ke" if reader
                .color(number, warnings)?
                .is_none_or(|c| c != [0.0; 3]) =>
            {
                warnings.add(source, number, "Ke is ignored; the material does not glow");
            }
            "Ka" | "Ke" | "sharpness" => {}
            _ if keyword.starts_with("map_")
                || ["bump", "disp", "decal", "refl", "norm"].contains(&keyword) =>
            {
                warnings.add(
                    source,
                    number,
                    "textures are not drawn; the plain colors are used",
                );
            }
            _ => {
                let sentence = format!("the statement {keyword:?} is unknown and ignored");
                warnings.add(source, number, sentence);
            }
        }
    }
    Ok(all
        .iter()
        .map(|material| (material.name.clone(), material.build(source, warnings)))
        .collect())
}

impl Statements {
    fn build(&self, source: &Source, warnings: &mut Warnings) -> Material {
        let default = Material::default();
        let illumination = self.illumination.unwrap_or(2);
        let is_glass = matches!(illumination, 4 | 6 | 7 | 9);
        let specular = self.specular.unwrap_or([0.0; 3]);
        let mut opacity = self
            .dissolve
            .or(self.transparency.map(|t| 1.0 - t))
            .unwrap_or(1.0);
        if is_glass && opacity == 1.0 {
            // Glass that does not say how transparent it is, is so altogether.
            opacity = 0.0;
        } else if !is_glass && opacity == 0.0 && self.dissolve.is_none() {
            let sentence = "Tr 1 would make the material invisible; it is read as opaque, which some programs mean by it";
            warnings.add(source, self.line, sentence);
            opacity = 1.0;
        }
        let diffuse = match (self.diffuse, default.diffuse) {
            (Some(color), _) | (None, Diffuse::Plain(color)) => color,
            (None, Diffuse::Checker { even, .. }) => even,
        };
        let density = if is_glass {
            self.density.unwrap_or(default.ior)
        } else {
            1.0
        };
        if !(1.0..=4.0).contains(&density) {
            let taken = density.clamp(1.0, 4.0);
            warnings.add(
                source,
                self.line,
                format!("Ni {density} is taken as {taken}, since it must be 1 to 4"),
            );
        }
        Material {
            name: self.name.clone(),
            diffuse: Diffuse::Plain(diffuse.map(|c| c * opacity)),
            highlight: if illumination >= 2 {
                specular
            } else {
                [0.0; 3]
            },
            shininess: self
                .exponent
                .map_or(default.shininess, |n| n.round().clamp(1.0, 1024.0) as u16),
            mirror: if matches!(illumination, 3 | 5 | 8) {
                specular
            } else {
                [0.0; 3]
            },
            transmit: self.filter.unwrap_or([1.0; 3]).map(|c| c * (1.0 - opacity)),
            ior: density.clamp(1.0, 4.0),
            absorption: [0.0; 3],
        }
    }
}

/// One line of a material.
struct Reader<'a> {
    source: &'a Source,
    line: &'a str,
    keyword: &'a str,
    values: &'a [&'a str],
}

impl Reader<'_> {
    /// Reads the last value, as options such as `-halo` come before it.
    fn number(&self) -> Result<f64, SceneError> {
        match self.values.last() {
            Some(value) => self
                .source
                .number(value, &format!("the value of {}", self.keyword)),
            None => Err(self.source.error_at(
                self.line,
                format!("{} has no value", self.keyword),
                "write a number",
            )),
        }
    }

    /// Reads a color of one number (gray) or three, from 0 to 1; `None` where it is given in
    /// another way.
    fn color(&self, line: usize, warnings: &mut Warnings) -> Result<Option<Color>, SceneError> {
        if let Some(way @ (&"spectral" | &"xyz")) = self.values.first() {
            let sentence = format!("a color given as {way:?} is not read; the default is used");
            warnings.add(self.source, line, sentence);
            return Ok(None);
        }
        let numbers = self
            .values
            .iter()
            .map(|value| {
                self.source
                    .number(value, &format!("a number of {}", self.keyword))
            })
            .collect::<Result<Vec<f64>, _>>()?;
        let color = match numbers[..] {
            [grey] => [grey; 3],
            [r, g, b] => [r, g, b],
            _ => {
                return Err(self.source.error_at(
                    self.line,
                    format!("{} has {} numbers", self.keyword, numbers.len()),
                    format!("write `{} r g b`, with numbers from 0 to 1", self.keyword),
                ));
            }
        };
        if color.iter().any(|c| !(0.0..=1.0).contains(c)) {
            let sentence = format!("{} is limited to the range 0 to 1", self.keyword);
            warnings.add(self.source, line, sentence);
        }
        Ok(Some(color.map(|c| c.clamp(0.0, 1.0))))
    }
}
