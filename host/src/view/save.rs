//! A camera as TOML, for a scene file; and as options for the command line.

use crate::scene::Camera;
use glam::DVec3;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Files with cameras are numbered up to this.
const MOST_FILES: u32 = 9999;

/// Returns the camera as a table of a scene file, with the equivalent options of `gridel render`.
pub fn saved(camera: &Camera) -> String {
    let Camera {
        eye,
        target,
        up,
        fov_degrees,
    } = camera;
    // As short as it can be read back to the bit.
    let joined =
        |vector: &DVec3, between| vector.to_array().map(|x| format!("{x:?}")).join(between);
    let [eye_option, target_option, up_option] = [eye, target, up].map(|it| joined(it, ","));
    let [eye, target, up] = [eye, target, up].map(|it| joined(it, ", "));
    format!(
        "# --eye={eye_option} --target={target_option} --up={up_option} --fov={fov_degrees:?}\n\
         [camera]\neye = [{eye}]\ntarget = [{target}]\nup = [{up}]\nfov = {fov_degrees:?}\n"
    )
}

/// Writes a camera to a new file, `camera-1.toml` or the next number that is free.
///
/// # Errors
/// If the file cannot be written.
pub fn save(camera: &Camera, folder: &Path) -> io::Result<PathBuf> {
    for number in 1..=MOST_FILES {
        let path = folder.join(format!("camera-{number}.toml"));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(mut file) => {
                let written = file.write_all(saved(camera).as_bytes());
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

    const CAMERA: Camera = Camera {
        eye: DVec3::new(1.0, -2.5e-300, 0.1),
        target: DVec3::new(1e21, 0.30000000000000004, -0.0),
        up: DVec3::Z,
        fov_degrees: 40.0,
    };

    #[test]
    fn camera_is_read_back_to_the_bit() {
        let text = format!(
            "{}[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n",
            saved(&CAMERA)
        );
        let read = crate::scene::read("a.toml".as_ref(), text.into(), &Default::default());
        assert_eq!(read.unwrap().scene.camera, Some(CAMERA));
    }

    #[test]
    fn cameras_go_to_new_files() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("camera-2.toml"), "mine").unwrap();
        let names = [1, 2, 3].map(|_| {
            let path = save(&CAMERA, folder.path()).unwrap();
            path.file_name().unwrap().to_str().unwrap().to_owned()
        });
        assert_eq!(names, ["camera-1.toml", "camera-3.toml", "camera-4.toml"]);
        let mine = std::fs::read(folder.path().join("camera-2.toml")).unwrap();
        assert_eq!(mine, b"mine");
        assert!(save(&CAMERA, &folder.path().join("nowhere")).is_err());
    }
}
