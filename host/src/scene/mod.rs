//! The scene in memory: what every importer produces and the compiler reads.
//!
//! All coordinates are `f64` scene units in one right-handed world space. Importers bake the transforms of groups and
//! nodes into the geometry, so later stages need not know them. [Parts](Part) are the exception: they have coordinates
//! of their own, and [instances](Instance) place them. [`Scene::flattened`] makes objects of these. Colors are linear
//! RGB, 1.0 being full display white, unless [`Scene::display_values`] says otherwise.

mod access;
mod attributes;
mod emitters;
mod environment;
mod error;
mod excerpt;
mod exr_image;
mod files;
mod flatten;
mod gzip;
mod hdr_image;
mod image;
mod importer;
mod joint;
mod light_form;
mod model;
pub(crate) mod molecule;
mod morph;
mod normals;
mod options;
mod placement;
mod places;
mod polygon;
mod raised;
mod scale_range;
mod size;
mod source_span;
#[cfg(test)]
pub(crate) mod tests;
mod text;
mod texture;
mod track;
mod track_name;
mod without;
mod words;

pub use crate::shape::Shape;
pub use attributes::Attributes;
pub use emitters::MOST_FACES;
pub use environment::{Environment, Panorama, Sky, Sun};
pub(crate) use error::CauseAndRemedy;
pub use error::SceneError;
pub use files::Files;
pub use image::{IMAGE_EXTENSIONS, Image};
pub use importer::Importer;
pub(crate) use joint::JointTracks;
pub use joint::{LARGEST_SCALE, LEAST_SCALE};
pub use light_form::{LightForm, LightShape, Spot};
pub use model::{
    Alpha, BRIGHTEST, Camera, Color, Diffuse, Instance, Joint, Lens, Light, Material, MorphTarget,
    Object, Part, RenderSettings, Scene, ToneMapping,
};
pub use morph::{Displacements, LARGEST_WEIGHT, NormalChanges};
pub use normals::{Normals, NormalsChoice};
pub use options::{
    FileKinds, GltfOptions, ImportOptions, Imported, Instances, MoleculeOptions, MoleculeStyle,
    Posed,
};
pub use placement::Placement;
pub use places::Places;
pub(crate) use raised::Sends;
pub(crate) use scale_range::ScaleRange;
pub use size::MOST_INPUT;
pub use source_span::SourceSpan;
pub use texture::{NormalMap, Texture, Wrap};
pub use track::{Interpolation, Key, TICKS_PER_SECOND, Track, TrackTarget};
pub(crate) use track::{control_points, extremes, turning_points};
pub use without::{effect_named, leave_out, shown_without};

use crate::table::printable;
use access::Access;
use importer::{FileOptions, Importers};
use std::borrow::Cow;
use std::path::Path;

importer::formats! {
    pub mod toml;
    mod obj;
    mod gltf;
    mod stl;
    mod ply;
    mod off;
    mod nff;
    mod pdb;
    mod mmcif;
    mod xyz;
}

/// Returns the extensions of all scene formats in words.
///
/// ```
/// assert!(gridel_host::scene::extensions().contains(".toml"));
/// ```
pub fn extensions() -> String {
    Importers(IMPORTERS).extensions()
}

/// Reads a scene file; its extension says which format it is in, its content if it has none. It may
/// only name files in its own folder and below: see [`load_with`].
///
/// # Errors
/// If the file cannot be read, its format is unknown, or its content is broken.
///
/// ```
/// use gridel_host::scene::{MoleculeOptions, load};
///
/// let error = load("missing.toml".as_ref(), &MoleculeOptions::default()).unwrap_err();
/// assert!(error.to_string().contains("missing.toml"));
/// ```
pub fn load(path: &Path, molecule: &MoleculeOptions) -> Result<Imported, SceneError> {
    load_with(
        path,
        &ImportOptions {
            molecule: *molecule,
            ..ImportOptions::default()
        },
    )
}

/// Reads a scene file; its extension says which format it is in, its content if it has none. The file
/// may be gzipped.
///
/// # Errors
/// If the file cannot be read, its format is unknown, or its content is broken. Also if it names a file outside of its
/// folder without permission.
///
/// ```
/// use gridel_host::scene::{ImportOptions, load_with};
///
/// let folder = tempfile::tempdir()?;
/// let scene = folder.path().join("scenes/tree.toml");
/// std::fs::create_dir(folder.path().join("scenes"))?;
/// std::fs::write(folder.path().join("leaf.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
/// std::fs::write(&scene, "[[object]]\nkind = 'import'\nfile = '../leaf.obj'\n")?;
///
/// let mut options = ImportOptions::default();
/// assert!(load_with(&scene, &options).is_err());
/// options.allow_outside = true;
/// assert_eq!(load_with(&scene, &options)?.scene.objects.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn load_with(path: &Path, options: &ImportOptions) -> Result<Imported, SceneError> {
    let access = Access::of(path, options.allow_outside);
    let (importer, input) = Importers(IMPORTERS).open(path, FileOptions::of(options), &access)?;
    finish(importer.import(input)?, options, &access)
}

/// Shades and flattens the scene as the options require.
fn finish(
    mut imported: Imported,
    options: &ImportOptions,
    access: &Access,
) -> Result<Imported, SceneError> {
    imported.files = access.read_files().clone();
    let scene = &mut imported.scene;
    let in_parts = scene.parts.iter_mut().flat_map(|part| &mut part.objects);
    for object in scene.objects.iter_mut().chain(in_parts) {
        object.shade(options.normals);
    }
    if options.instances == Instances::Flatten {
        imported = with_copies(imported, options.time)?;
    }
    // Where light is reflected between surfaces, they light others by that.
    if imported.scene.render.bounces == 0 {
        let warning = dark_emitters(&imported.scene);
        imported.warnings.extend(warning);
    }
    if let Cow::Owned(scene) = imported.scene.with_emitters() {
        imported.scene = scene;
    }
    Ok(imported)
}

/// Copies instances to where they stand at a time, or at rest without one.
fn with_copies(mut imported: Imported, time: Option<f64>) -> Result<Imported, SceneError> {
    let scene = &mut imported.scene;
    let moving = scene.instances.iter().find(|it| it.joint.is_some());
    let has_joints = scene.tracks.iter().any(|track| track.target.is_of_joint());
    match (moving, time) {
        (None, Some(_)) if has_joints => imported.posed = Some(Posed::Always),
        (None, _) => {}
        (Some(_), Some(seconds)) => {
            scene.instances = scene.instances_at(seconds);
            imported.posed = Some(Posed::AtTime);
        }
        (Some(instance), None) => {
            imported.posed = Some(Posed::AtRest);
            imported.warnings.push(format!(
                "{}: instances are copied where they are at rest, and do not move",
                instance.place
            ));
        }
    }
    imported.copied = scene.instances.len();
    imported.scene = imported.scene.into_flattened()?;
    Ok(imported)
}

/// The warning of objects that glow and do not light others, if there are any.
fn dark_emitters(scene: &Scene) -> Option<String> {
    let mut objects = scene.emitters_without_light();
    let first = objects.next()?;
    let more = match objects.count() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Some(format!(
        "{}: object {}{more} glows, and does not light other objects: spheres, discs, boxes and meshes of up to \
         {MOST_FACES} triangles do that, outside of parts and without `alpha`; copy instances of parts with \
         `--instances flatten`, add a `[[light]]`, or set the material's `lights = false`",
        first.place,
        printable(&first.name)
    ))
}

/// Reads a scene from bytes as [`load_with`] reads a file of this name, which need not exist. Files that the scene
/// names lie in the same folder; for a name without a folder that is the current folder.
///
/// # Errors
/// As [`load_with`].
///
/// ```
/// use gridel_host::scene::{ImportOptions, Shape, read};
///
/// let file = "v 0 0 0\nv 1 0 0\nv 0 1 0\no leaf\nf 1 2 3\n";
/// let imported = read("leaf.obj".as_ref(), file.into(), &ImportOptions::default())?;
/// let object = &imported.scene.objects[0];
/// assert_eq!(object.name, "leaf");
/// assert!(matches!(&object.shape, Shape::Mesh { triangles, .. } if triangles.len() == 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(name: &Path, bytes: Vec<u8>, options: &ImportOptions) -> Result<Imported, SceneError> {
    let access = Access::of(name, options.allow_outside);
    let (importer, input) =
        Importers(IMPORTERS).input(name, bytes, FileOptions::of(options), &access)?;
    finish(importer.import(input)?, options, &access)
}

/// Reads a scene from files in memory; `name` is the scene's file. Files that the scene names are found by their paths.
/// A file is found by its name alone if no two files share it. Disks are not read.
///
/// # Errors
/// As [`load_with`], and if a file that the scene needs is not among them.
///
/// ```
/// use gridel_host::scene::{Files, ImportOptions, read_among};
///
/// let mut files = Files::new();
/// files.insert("leaf.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec());
/// files.insert("tree.toml", b"[[object]]\nkind = 'import'\nfile = 'leaf.obj'\n".to_vec());
/// let imported = read_among("tree.toml".as_ref(), &files, &ImportOptions::default())?;
/// assert_eq!(imported.scene.objects.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_among(
    name: &Path,
    files: &Files,
    options: &ImportOptions,
) -> Result<Imported, SceneError> {
    let access = Access::among(files);
    let (importer, input) = Importers(IMPORTERS).open(name, FileOptions::of(options), &access)?;
    finish(importer.import(input)?, options, &access)
}
