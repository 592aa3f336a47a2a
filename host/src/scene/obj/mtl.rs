//! Reads MTL, the materials of OBJ.
//!
//! `Kd` is the diffuse color. `Ks` and `Ns` are the highlight, unless `illum` is 0 or 1, which
//! have none. `illum` 3, 5 and 8 mirror with `Ks`. `illum` 6 and 7 are glass of index `Ni` that lets
//! `Tf` through. `illum` 4 and 9 are so only where `d` or `Tr` says that light passes, or neither is
//! given and `Ni` is above 1: many programs write 4 for opaque materials. Otherwise `d` below 1 (or `Tr` above 0, of which `d` takes precedence)
//! is a pane that does not bend light: glass of index 1. `Ka` is not needed, because ambient light
//! takes the diffuse color. `Ke` is the radiance that the surface sends out, weighted
//! by the mean of `map_Ke`, which is not drawn.
//! `Pr` is the roughness of what mirrors and of glass. `map_Kd` weights `Kd`, with its options `-o`, `-s` and `-clamp`.
//! `norm` is a normal map, with the same options. Everything else is ignored, with a warning.

use crate::scene::access::FileError;
use crate::scene::text::{Source, Warnings};
use crate::scene::texture::Images;
use crate::scene::{
    BRIGHTEST, CauseAndRemedy, Color, Diffuse, Material, NormalMap, SceneError, Texture, Wrap,
};
use crate::table::shortened;
use glam::{DAffine2, DVec2};
use std::collections::HashSet;

/// One material of a file.
#[derive(Default)]
struct Statements<'s> {
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
    emission: Color,
    /// `map_Ke`: the number of its line, and the line.
    emissive: Option<(usize, &'s str)>,
    roughness: Option<f64>,
    texture: Option<Texture>,
    /// The texture of normals.
    normals: Option<Texture>,
}

/// Reads the materials by name; a later one replaces an earlier one of its name.
pub(super) fn read(
    source: &Source,
    images: &mut Images<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<(String, Material)>, SceneError> {
    let mut all: Vec<Statements<'_>> = Vec::new();
    let mut names = HashSet::new();
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
            if !names.insert(name.clone()) {
                let name = shortened(&name);
                let sentence =
                    format!("the material {name:?} is defined again; the last one is used");
                warnings.add(source, number, sentence);
            }
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
                "what comes before the first `newmtl` is ignored",
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
        material.read(&reader, (number, line), images, warnings)?;
    }
    for material in &mut all {
        material.weight_emission(source, images, warnings)?;
    }
    Ok(all
        .iter()
        .map(|material| (material.name.clone(), material.build(source, warnings)))
        .collect())
}

impl<'s> Statements<'s> {
    /// Reads the statement of a line, which is given with its number.
    fn read(
        &mut self,
        reader: &Reader<'_>,
        (number, line): (usize, &'s str),
        images: &mut Images<'_>,
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let keyword = reader.keyword;
        match keyword {
            "Kd" => self.diffuse = reader.color(number, warnings)?,
            "Ks" => self.specular = reader.color(number, warnings)?,
            "Tf" => self.filter = reader.color(number, warnings)?,
            "Ns" => self.exponent = Some(reader.number_in([0.0, 1024.0], number, warnings)?),
            "Ni" => self.density = Some(reader.number(number, warnings)?),
            "d" => self.dissolve = Some(reader.number_in([0.0, 1.0], number, warnings)?),
            "Tr" => self.transparency = Some(reader.number_in([0.0, 1.0], number, warnings)?),
            "illum" => self.illumination = reader.illumination(number, warnings)?,
            "Ke" => {
                self.emission = reader
                    .color_up_to(BRIGHTEST, number, warnings)?
                    .unwrap_or_default()
            }
            "Pr" => self.roughness = Some(reader.number_in([0.0, 1.0], number, warnings)?),
            "Ka" | "sharpness" => {}
            "map_Kd" => {
                let instead = "the plain color is used";
                self.texture = reader.texture(number, images, instead, warnings)?;
            }
            "norm" => {
                let instead = "the normal map is not drawn";
                self.normals = reader.texture(number, images, instead, warnings)?;
            }
            // `Ke` may follow.
            "map_Ke" => self.emissive = Some((number, line)),
            _ if keyword.starts_with("map_")
                || ["bump", "disp", "decal", "refl"].contains(&keyword) =>
            {
                warnings.add(
                    reader.source,
                    number,
                    "textures other than map_Kd and norm are not drawn; the plain colors are used",
                );
            }
            _ => {
                let sentence = format!(
                    "the statement {keyword:?} is unknown and ignored",
                    keyword = shortened(keyword)
                );
                warnings.add(reader.source, number, sentence);
            }
        }
        Ok(())
    }

    fn build(&self, source: &Source, warnings: &mut Warnings) -> Material {
        let default = Material::default();
        let illumination = self.illumination.unwrap_or(2);
        let specular = self.specular.unwrap_or([0.0; 3]);
        let mut opacity = self
            .dissolve
            .or(self.transparency.map(|t| 1.0 - t))
            .unwrap_or(1.0);
        let is_glass = match illumination {
            6 | 7 => true,
            4 | 9 if self.dissolve.is_some() || self.transparency.is_some() => opacity < 1.0,
            4 | 9 => self.density.is_some_and(|density| density > 1.0),
            _ => false,
        };
        if is_glass && opacity == 1.0 {
            // Glass that does not say how transparent it is, is so altogether.
            opacity = 0.0;
        } else if !is_glass && opacity == 0.0 && self.dissolve.is_none() {
            let sentence = "Tr 1 would make the material invisible; it is read as opaque, which some programs mean by it";
            warnings.add(source, self.line, sentence);
            opacity = 1.0;
        }
        let diffuse = match (self.diffuse, default.diffuse) {
            // The color that the texture weights.
            (None, _) if self.texture.is_some() => [1.0; 3],
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
        let mirror = match illumination {
            3 | 5 | 8 => specular,
            _ => [0.0; 3],
        };
        let transmit = self.filter.unwrap_or([1.0; 3]).map(|c| c * (1.0 - opacity));
        if self.roughness.is_some() && [mirror, transmit] == [[0.0; 3]; 2] {
            let sentence =
                "Pr is ignored, because the material neither mirrors nor lets light through";
            warnings.add(source, self.line, sentence);
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
            mirror,
            transmit,
            ior: density.clamp(1.0, 4.0),
            emission: self.emission,
            roughness: taken_roughness(self.roughness.unwrap_or_default()),
            normal_map: self.normal_map(source, warnings),
            texture: self.texture.clone(),
            place: source.place(self.line),
            ..default
        }
    }
}

impl Statements<'_> {
    /// Weights `Ke` by the mean of `map_Ke`. Programs write `Ke 1 1 1` wherever there is such a texture.
    fn weight_emission(
        &mut self,
        source: &Source,
        images: &mut Images<'_>,
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let Some((number, line)) = self.emissive else {
            return Ok(());
        };
        if self.emission == [0.0; 3] {
            let sentence = "map_Ke is ignored, because Ke is 0 or missing";
            warnings.add(source, number, sentence);
            return Ok(());
        }
        let reader = Reader {
            source,
            line,
            keyword: "map_Ke",
            values: &[],
        };
        let mean = match reader.texture(number, images, "the material does not glow", warnings)? {
            Some(texture) => {
                let sentence = "map_Ke is not drawn; its mean is taken, and weights Ke";
                warnings.add(source, number, sentence);
                images.means.of(&texture.image).color
            }
            None => [0.0; 3],
        };
        self.emission = std::array::from_fn(|k| self.emission[k] * mean[k]);
        Ok(())
    }

    /// The normal map, if it lies as the texture does.
    fn normal_map(&self, source: &Source, warnings: &mut Warnings) -> Option<NormalMap> {
        let texture = self.normals.clone()?;
        let color = self.texture.as_ref();
        if color.is_some_and(|it| it.transform != texture.transform) {
            let sentence = "norm has other options than map_Kd and is not drawn";
            warnings.add(source, self.line, sentence);
            return None;
        }
        Some(NormalMap {
            texture,
            scale: 1.0,
        })
    }
}

/// Converts the roughness of a file to [`Material::roughness`]; nearly smooth counts as smooth.
fn taken_roughness(roughness: f64) -> f64 {
    if roughness < Material::LEAST_ROUGHNESS {
        0.0
    } else {
        roughness
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
    /// Reads the last value, as options such as `-halo` come before it. What comes before it has a warning.
    fn number(&self, line: usize, warnings: &mut Warnings) -> Result<f64, SceneError> {
        if let [ignored @ .., _] = self.values
            && let Some(first) = ignored.first()
        {
            let (first, keyword) = (shortened(first), self.keyword);
            let sentence = format!("{first:?} is ignored: the last value of {keyword} is taken");
            warnings.add(self.source, line, sentence);
        }
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

    /// Reads the number of a model of illumination; `None` with a warning for one that there is not.
    fn illumination(
        &self,
        line: usize,
        warnings: &mut Warnings,
    ) -> Result<Option<u32>, SceneError> {
        let number = self.number(line, warnings)?;
        let known = (0..=10).find(|it| f64::from(*it) == number);
        if known.is_none() {
            let sentence = format!("illum {number} is none of 0 to 10, and is read as 2");
            warnings.add(self.source, line, sentence);
        }
        Ok(known)
    }

    /// Reads a number, and limits it to a range with a warning.
    fn number_in(
        &self,
        [least, most]: [f64; 2],
        line: usize,
        warnings: &mut Warnings,
    ) -> Result<f64, SceneError> {
        let number = self.number(line, warnings)?;
        if !(least..=most).contains(&number) {
            let sentence = format!("{} is limited to the range {least} to {most}", self.keyword);
            warnings.add(self.source, line, sentence);
        }
        Ok(number.clamp(least, most))
    }

    /// Reads a texture: options, then the name of a file, which may contain spaces. `None` for a file that is not there,
    /// with a warning that says what happens `instead`.
    fn texture(
        &self,
        line: usize,
        images: &mut Images<'_>,
        instead: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<Texture>, SceneError> {
        let mut rest = self.line.strip_prefix(self.keyword).unwrap_or("").trim();
        let (mut scale, mut offset, mut clamps) = (DVec2::ONE, DVec2::ZERO, false);
        while rest.starts_with('-') {
            let (option, behind) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
            rest = behind.trim_start();
            let mut values = Vec::new();
            let most = match option {
                "-o" | "-s" | "-t" => 3,
                "-mm" => 2,
                _ => 1,
            };
            while values.len() < most {
                let (word, behind) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
                let is_value = most == 1 || word.parse::<f64>().is_ok();
                if !is_value || behind.is_empty() {
                    break;
                }
                values.push(word);
                rest = behind.trim_start();
            }
            let number = |k: usize, default: f64| match values.get(k) {
                Some(word) => {
                    let what = format!("a number of the option {option} of {}", self.keyword);
                    self.source.number(word, &what)
                }
                None => Ok(default),
            };
            match option {
                "-s" => scale = DVec2::new(number(0, 1.0)?, number(1, 1.0)?),
                "-o" => offset = DVec2::new(number(0, 0.0)?, number(1, 0.0)?),
                "-clamp" => clamps = values == ["on"],
                _ => {
                    let sentence = format!("the option {option} of a texture is ignored");
                    warnings.add(self.source, line, sentence);
                }
            }
        }
        if rest.is_empty() {
            return Err(self.source.error_at(
                self.line,
                format!("{} names no file", self.keyword),
                format!("write `{} FILE`", self.keyword),
            ));
        }
        let name = rest.replace('\\', "/");
        let mut found = images.file(&self.source.path, &name);
        // Names may have number signs, so what follows one is a comment only where the whole is no file.
        let mut signs = name.match_indices('#').map(|(at, _)| &name[..at]);
        if let Err(FileError::Unreadable(_)) = found
            && let Some(before) = signs.find(|it| it.ends_with(char::is_whitespace))
        {
            found = images.file(&self.source.path, before.trim_end());
        }
        match found {
            Ok(image) => Ok(Some(Texture {
                wrap: [if clamps { Wrap::Clamp } else { Wrap::Repeat }; 2],
                // Coordinates have v downwards here, and upwards there.
                transform: DAffine2::from_translation(DVec2::new(offset.x, 1.0 - offset.y))
                    * DAffine2::from_scale(scale)
                    * DAffine2::from_translation(DVec2::new(0.0, -1.0)),
                ..Texture::of(image)
            })),
            // As with material files: it was often left behind.
            Err(FileError::Unreadable(CauseAndRemedy { cause, .. })) => {
                let sentence = format!("the texture {cause}; {instead}");
                warnings.add(self.source, line, sentence);
                Ok(None)
            }
            Err(FileError::Unusable(CauseAndRemedy { cause, remedy })) => {
                let error = self.source.error(format!("the texture {cause}"), remedy);
                Err(error.at_line(line))
            }
        }
    }

    /// Reads a color of one number (gray) or three, from 0 to 1; `None` where it has another form.
    fn color(&self, line: usize, warnings: &mut Warnings) -> Result<Option<Color>, SceneError> {
        self.color_up_to(1.0, line, warnings)
    }

    fn color_up_to(
        &self,
        most: f64,
        line: usize,
        warnings: &mut Warnings,
    ) -> Result<Option<Color>, SceneError> {
        if let Some(way @ (&"spectral" | &"xyz")) = self.values.first() {
            let sentence = format!(
                "a color given as {way:?} is not read; the default is used",
                way = shortened(way)
            );
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
            [gray] => [gray; 3],
            [r, g, b] => [r, g, b],
            _ => {
                return Err(self.source.error_at(
                    self.line,
                    format!("{} has {} numbers", self.keyword, numbers.len()),
                    format!(
                        "write `{} r g b`, with numbers from 0 to {most}",
                        self.keyword
                    ),
                ));
            }
        };
        if color.iter().any(|c| !(0.0..=most).contains(c)) {
            let sentence = format!("{} is limited to the range 0 to {most}", self.keyword);
            warnings.add(self.source, line, sentence);
        }
        Ok(Some(color.map(|c| c.clamp(0.0, most))))
    }
}
