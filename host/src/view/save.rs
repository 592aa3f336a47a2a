//! A camera as TOML, for a scene file; and as options for the command line.

use super::notes::Notes;
use super::state::State;
use crate::compile::Unstated;
use crate::scene::{Camera, Lens, Light};
use glam::DVec3;
use std::fmt::Write as _;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Files with cameras are numbered up to this.
const MOST_FILES: u32 = 9999;

/// Returns the camera of a view as a table of a scene file, with the equivalent options of `gridel render`.
pub fn saved(state: &State<'_>) -> String {
    let lens = state.lens();
    text(&state.camera().focused(lens), lens, state.notes())
}

fn text(camera: &Camera, lens: Option<Lens>, notes: &Notes) -> String {
    let &Camera {
        eye,
        target,
        up,
        fov_degrees,
    } = camera;
    let focus = lens.and_then(|lens| lens.focus);
    // As short as it can be read back to the bit.
    let joined = |vector: DVec3, between| vector.to_array().map(|x| format!("{x:?}")).join(between);
    let [eye_option, target_option, up_option] = [eye, target, up].map(|it| joined(it, ","));
    let array = |vector: DVec3| format!("[{}]", joined(vector, ", "));
    let mut text = format!(
        "# --eye={eye_option} --target={target_option} --up={up_option} --fov={fov_degrees:?}\n"
    );
    text += &comments(notes);
    let [eye, target, up] = [eye, target, up].map(array);
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "[camera]\neye = {eye}\ntarget = {target}\nup = {up}\nfov = {fov_degrees:?}\n"
    );
    if let (Some(lens), Some(focus)) = (lens, focus) {
        let aperture = 2.0 * lens.radius;
        let _ = write!(text, "aperture = {aperture:?}\nfocus = {focus:?}\n");
    }
    if let Some((Light::Directional { direction, color }, _)) = notes.unstated.light {
        let [direction, color] = [direction, DVec3::from_array(color)].map(array);
        let _ = write!(
            text,
            "\n[[light]]\nkind = \"directional\"\ndirection = {direction}\ncolor = {color}\n"
        );
    }
    text
}

/// Returns what else the picture depends on.
fn comments(notes: &Notes) -> String {
    let Notes {
        tracks,
        unstated: Unstated { light, background },
    } = notes;
    let mut text = String::new();
    if !tracks.is_empty() {
        let tracks = tracks.join(", ");
        let _ = write!(
            text,
            "# Remove the scene's tracks of {tracks} beside this camera: at a time they would move it.\n\
             # The options above replace them.\n"
        );
    }
    if light.is_some() {
        text += "# The scene states no light. The view has the light below. The options above alone give a scene file\n\
                 # another one, which moves with the camera.\n";
    }
    let ambient = light.map(|(_, ambient)| ("ambient", ambient));
    let values = ambient.into_iter();
    let values = values.chain(background.map(|it| ("background", it)));
    let lines = values.map(|(key, [r, g, b])| format!("# {key} = [{r:?}, {g:?}, {b:?}]\n"));
    let lines: String = lines.collect();
    if !lines.is_empty() {
        text += "# Write this above all tables of the scene file:\n";
        text += &lines;
    }
    text
}

/// Writes the camera of a view to a new file, `camera-1.toml` or the next number that is free.
///
/// # Errors
/// If the file cannot be written.
pub fn save(state: &State<'_>, folder: &Path) -> io::Result<PathBuf> {
    write_new(&saved(state), folder)
}

/// Saves the camera of a view, and returns a message about its file.
///
/// # Errors
/// A message, if the file cannot be written.
pub(super) fn save_with_message(state: &State<'_>) -> Result<String, String> {
    match save(state, Path::new("")) {
        Ok(path) => Ok(format!("the camera is in {}", path.display())),
        Err(error) => Err(format!("the camera cannot be saved: {error}")),
    }
}

fn write_new(text: &str, folder: &Path) -> io::Result<PathBuf> {
    for number in 1..=MOST_FILES {
        let path = folder.join(format!("camera-{number}.toml"));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(mut file) => {
                let written = file.write_all(text.as_bytes());
                if written.is_err() {
                    // Half of a camera is of no use.
                    let _ = fs::remove_file(&path);
                }
                return written.map(|()| path);
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::scene::Scene;
    use gridel_core::{Format, Settings, Structure};

    const CAMERA: Camera = Camera {
        eye: DVec3::new(1.0, -2.5e-300, 0.1),
        target: DVec3::new(1e21, 0.30000000000000004, -0.0),
        up: DVec3::Z,
        fov_degrees: 40.0,
    };

    const BALL: &str = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";

    fn read(text: String) -> Scene {
        let imported = crate::scene::read("a.toml".as_ref(), text.into(), &Default::default());
        imported.unwrap_or_else(|error| panic!("{error}")).scene
    }

    fn unstated(scene: &Scene) -> Unstated {
        let compiled = compile(scene, &Options::default());
        compiled.unwrap().report.unstated
    }

    #[test]
    fn camera_is_read_back_to_the_bit() {
        let text = text(&CAMERA, None, &Notes::default());
        assert_eq!(read(text + BALL).camera, Some(CAMERA));
    }

    #[test]
    fn lens_is_saved_with_its_focus_and_the_target_lies_in_it() {
        let own = "[camera]\neye = [0, 1, 9]\ntarget = [0, 1, 2]\nfov = 30\naperture = 0.5\n";
        for (focus, distance) in [("", 7.0), ("focus = 5.0\n", 5.0)] {
            let scene = read(format!("{own}{focus}{BALL}"));
            let blob = compile(&scene, &Options::default()).unwrap().blob;
            let compiled = blob.scene().unwrap();
            let settings = Settings::of(&compiled);
            let mut state = State::new(&compiled, Format::F32, Structure::List, settings);
            state.orbit([0.3, 0.1]);
            state.zoom(1.0);
            let shown = state.shot().view;
            let saved = read(saved(&state) + BALL);
            let (camera, lens) = (saved.camera.unwrap(), saved.lens.unwrap());
            let off = [
                lens.radius - 0.25,
                lens.focus.unwrap() - distance,
                camera.eye.distance(camera.target) - distance,
                camera.eye.distance(state.camera().eye),
            ];
            assert!(off.iter().all(|it| it.abs() < 1e-6), "{off:?}");
            assert_eq!(camera.in_blob(&compiled).unwrap(), shown);
            let pasted = compile(&saved, &Options::default()).unwrap().blob;
            assert_eq!(pasted.scene().unwrap().lens(), compiled.lens());
        }
    }

    #[test]
    fn pasted_camera_of_a_scene_without_lights_has_the_light_and_the_background_of_the_view() {
        let scene = read(String::from(BALL));
        let notes = Notes {
            tracks: vec!["camera.orbit"],
            unstated: unstated(&scene),
        };
        let text = text(&CAMERA, None, &notes);
        assert!(
            text.contains("# Remove the scene's tracks of camera.orbit"),
            "{text}"
        );
        let is_value = |line: &&str| line.contains(" = [") && line.starts_with("# ");
        let values: Vec<_> = text.lines().filter(is_value).map(|it| &it[2..]).collect();
        let pasted = read(format!("{}\n{text}{BALL}", values.join("\n")));
        let (light, ambient) = notes.unstated.light.unwrap();
        assert_eq!(
            (&pasted.lights[..], pasted.ambient),
            (&[light][..], ambient)
        );
        assert_eq!(pasted.background, notes.unstated.background);
        assert_eq!(unstated(&pasted).light, None);
    }

    #[test]
    fn scene_that_states_all_has_no_comments() {
        let light = "[[light]]\nkind = 'point'\nposition = [0, 9, 0]\n";
        let camera = "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n";
        let scene = read(format!("{light}{camera}{BALL}"));
        let notes = Notes {
            tracks: Vec::new(),
            unstated: unstated(&scene),
        };
        let text = text(&CAMERA, None, &notes);
        assert_eq!(text.matches('#').count(), 1, "{text}");
    }

    #[test]
    fn cameras_go_to_new_files() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("camera-2.toml"), "mine").unwrap();
        let names = [1, 2, 3].map(|_| {
            let path = write_new("text", folder.path()).unwrap();
            path.file_name().unwrap().to_str().unwrap().to_owned()
        });
        assert_eq!(names, ["camera-1.toml", "camera-3.toml", "camera-4.toml"]);
        let mine = std::fs::read(folder.path().join("camera-2.toml")).unwrap();
        assert_eq!(mine, b"mine");
        assert!(write_new("text", &folder.path().join("nowhere")).is_err());
    }
}
