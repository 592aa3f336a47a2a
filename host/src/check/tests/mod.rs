#[cfg(unix)]
mod boards;
mod findings;
mod instances;
mod mistakes;
mod target;

use super::*;
use crate::scene::SceneError;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// A folder with a ball and a manifest.
struct Folder(TempDir);

const BALL: &str = r#"
background = 0.5
camera = { eye = [0, 0, 4], target = [0, 0, 0] }
render = { width = 16, height = 12 }
light = [{ kind = "point", position = [3, 4, 5] }]
object = [{ kind = "sphere", center = [0, 0, 0], radius = 1 }]
"#;

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("ball.toml"), BALL).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn manifest(&self, text: &str) -> Result<Manifest, SceneError> {
        fs::write(self.path("check.toml"), text).unwrap();
        Manifest::read(&self.path("check.toml"))
    }

    fn run(&self, text: &str) -> (Manifest, Report) {
        let manifest = self.manifest(text).unwrap();
        let steps = std::cell::Cell::new(0);
        let report = run(&manifest, &|| steps.set(steps.get() + 1));
        assert!(steps.get() <= manifest.steps());
        (manifest, report)
    }

    /// The manifest as it is now.
    fn text(&self) -> String {
        fs::read_to_string(self.path("check.toml")).unwrap()
    }
}

fn why(finding: &Finding) -> &str {
    match &finding.outcome {
        Outcome::Passed | Outcome::Recorded => "",
        Outcome::Failed(why) | Outcome::NotRun(why) => why,
    }
}

fn keep(recorded: &Recorded) {
    recorded.files().unwrap().keep().unwrap();
}
