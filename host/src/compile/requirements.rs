//! The effects that a scene requires, and the parts that require them.

use crate::scene::SourceSpan;
use gridel_core::Effects;
use std::fmt;

/// A part of a scene that requires an effect, and where a file states it.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct RequiringPart {
    /// Such as `material glass`.
    pub part: String,
    /// `None` where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Line of the file, counted from 1; `None` where the format has no lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
}

impl RequiringPart {
    /// The part that requires an environment.
    pub const ENVIRONMENT: &'static str = "the environment";
    /// The part that requires tone mapping.
    pub const TONE_MAPPING: &'static str = "the `tone_mapping` of pictures";
    /// The part that requires depth of field.
    pub const APERTURE: &'static str = "the camera's `aperture`";
    /// The part that requires indirect light.
    pub const BOUNCES: &'static str = "the `bounces` of pictures";

    /// Returns a part of a scene file.
    pub fn new(part: impl Into<String>, place: &SourceSpan) -> Self {
        Self {
            part: part.into(),
            file: place.is_known().then(|| place.file.display().to_string()),
            line: Some(place.line).filter(|&line| line > 0),
        }
    }
}

impl fmt::Display for RequiringPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = &self.part;
        match (&self.file, self.line) {
            (None, _) => write!(f, "{part}"),
            (Some(file), None) => write!(f, "{part} ({file})"),
            (Some(file), Some(line)) => write!(f, "{part} ({file}:{line})"),
        }
    }
}

/// Effects, each time with the part of the scene that requires them.
#[derive(Clone, Debug, Default)]
pub struct Requirements(Vec<(Effects, RequiringPart)>);

impl Requirements {
    /// Adds effects that a part requires, which a file states at `place`.
    pub fn add(&mut self, effects: Effects, part: impl Into<String>, place: &SourceSpan) {
        self.0.push((effects, RequiringPart::new(part, place)));
    }

    pub fn extend(&mut self, others: &Self) {
        self.0.extend_from_slice(&others.0);
    }

    /// Returns all effects that the scene requires.
    pub fn effects(&self) -> Effects {
        let effects = self.0.iter().map(|(effects, _)| *effects);
        effects.fold(Effects::NONE, Effects::with)
    }

    /// Returns the names of the effects, and the parts that require each.
    pub fn by_effect(&self) -> Vec<(String, Vec<RequiringPart>)> {
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

#[cfg(test)]
mod tests {
    use crate::compile::{Options, compile};
    use crate::scene::{Files, read_among};

    /// The parts that require each effect of the first file, as they are shown.
    fn required(files: &[(&str, &str)]) -> Vec<(String, Vec<String>)> {
        let mut all = Files::new();
        for (name, text) in files {
            all.insert(name, text.as_bytes().to_vec());
        }
        let imported = read_among(files[0].0.as_ref(), &all, &Default::default());
        let imported = imported.unwrap_or_else(|error| panic!("{error}"));
        let report = compile(&imported.scene, &Options::default())
            .unwrap()
            .report;
        let shown = |(effect, parts): (String, Vec<super::RequiringPart>)| {
            (effect, parts.iter().map(|it| it.to_string()).collect())
        };
        report.effects.into_iter().map(shown).collect()
    }

    fn of<'r>(required: &'r [(String, Vec<String>)], effect: &str) -> &'r [String] {
        let found = required.iter().find(|(name, _)| name == effect);
        &found
            .unwrap_or_else(|| panic!("no {effect}: {required:?}"))
            .1
    }

    #[test]
    fn parts_of_a_scene_file_have_their_lines() {
        let file = "[camera]
eye = [0, 0, 9]
target = [0, 0, 0]
aperture = 0.5
[render]
bounces = 1
tone_mapping = 'aces'
[environment]
zenith = 1
horizon = 1
ground = 1
sun = { direction = [1, 1, 1] }
[material.shiny]
highlight = 0.5
mirror = 0.5
roughness = 0.5
[material]
lamp = { emission = 1 }
[[light]]
kind = 'disc'
center = [0, 5, 0]
radius = 1
normal = [0, -1, 0]
radiance = 1
visible = true
[[object]]
kind = 'sphere'
center = [0, 0, 0]
radius = 1
material = 'shiny'
[[object]]
name = 'bulb'
kind = 'sphere'
center = [3, 0, 0]
radius = 1
material = 'lamp'
[[object]]
name = 'sail'
kind = 'mesh'
vertices = [[0, 0, 0], [2, 0, 0.1], [2, 2, 0], [0, 2, 0.1]]
faces = [[0, 1, 2], [0, 2, 3]]
smooth = 90
";
        let found = required(&[("all.toml", file)]);
        for (effect, parts) in [
            (
                "depth-of-field",
                &["the camera's `aperture` (all.toml:4)"][..],
            ),
            ("indirect", &["the `bounces` of pictures (all.toml:6)"]),
            (
                "tone-mapping",
                &["the `tone_mapping` of pictures (all.toml:7)"],
            ),
            ("environment", &["the environment (all.toml:8)"]),
            ("highlight", &["material shiny (all.toml:13)"]),
            ("glossy", &["material shiny (all.toml:13)"]),
            ("mirror", &["material shiny (all.toml:13)"]),
            (
                "emission",
                &[
                    "material lamp (all.toml:18)",
                    "material light 0 (all.toml:19)",
                ],
            ),
            ("smooth", &["mesh sail (all.toml:37)"]),
            // The disc, the lamp's sphere, the environment and its sun.
            (
                "shadow",
                &[
                    "light 0 (all.toml:19)",
                    "light 1 (all.toml:31)",
                    "light 2 (all.toml:8)",
                    "light 3 (all.toml:8)",
                ],
            ),
        ] {
            assert_eq!(of(&found, effect), parts, "{effect}");
        }
    }

    #[test]
    fn parts_of_imported_files_name_these_files() {
        let scene = "[[object]]\nkind = 'import'\nfile = 'box.obj'\nname = 'box'\n\
             [[object]]\nkind = 'import'\nfile = 'own.toml'\n\
             [[object]]\nkind = 'import'\nfile = 'ball.nff'\n";
        let mesh = "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 1\n\
             usemtl pane\nf 1//1 2//2 3//1\n";
        let materials = "# two\nnewmtl plain\nKd 1 1 1\n\nnewmtl pane\nillum 6\nd 0.2\n";
        let own = "render.bounces = 1\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\naperture = 1\n\
             [[light]]\nkind = 'point'\nposition = [0, 9, 0]\nfalloff = 'square'\n";
        let ball = "l 1 2 3\nf 1 .5 0 .8 .25 20 0 1\ns 1 2 3 4\n";
        let found = required(&[
            ("scene.toml", scene),
            ("box.obj", mesh),
            ("box.mtl", materials),
            ("own.toml", own),
            ("ball.nff", ball),
        ]);
        for (effect, parts) in [
            ("glass", &["material pane (box.mtl:5)"][..]),
            ("smooth", &["mesh box/mesh 1 (box.obj:8)"]),
            ("indirect", &["the `bounces` of pictures (own.toml:1)"]),
            ("depth-of-field", &["the camera's `aperture` (own.toml:5)"]),
            ("falloff", &["light 0 (own.toml:6)"]),
            ("shadow", &["light 0 (own.toml:6)", "light 1 (ball.nff:1)"]),
            ("mirror", &["material fill 1 (ball.nff:2)"]),
        ] {
            assert_eq!(of(&found, effect), parts, "{effect}");
        }
    }

    #[test]
    fn parts_that_are_supplied_have_no_place() {
        let ball = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";
        assert_eq!(of(&required(&[("ball.toml", ball)]), "shadow"), ["light 0"]);
    }

    #[test]
    fn materials_of_two_files_that_are_equal_otherwise_are_one() {
        let scene = "[[object]]\nkind = 'import'\nfile = 'a.obj'\n\
             [[object]]\nkind = 'import'\nfile = 'b.obj'\n";
        let mesh = |library: &str| {
            format!("mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n")
        };
        let red = "newmtl red\nKd 1 0 0\nKs 1 1 1\n";
        let files = [
            ("scene.toml", scene),
            ("a.obj", &mesh("a.mtl")),
            ("b.obj", &mesh("b.mtl")),
            ("a.mtl", red),
            ("b.mtl", &format!("\n{red}")),
        ];
        assert_eq!(
            of(&required(&files), "highlight"),
            ["material red (a.mtl:1)"]
        );
    }
}
