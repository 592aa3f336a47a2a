//! The RAM of a board for parts, meshes that deform, and all that tracks change, besides workspace and call stack.

use super::programs::Programs;
use crate::measure::bytes::board_memory;
use crate::measure::deforming::Deforming;
use crate::table::counted;
use gridel_core::format::track::{Track, TrackTarget};
use gridel_core::{Format, Motion, Poses, Scene, Tracks};
use serde::Serialize;

/// RAM of a board that a program takes for a scene, besides workspace and call stack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct WorkingRow {
    /// A description of its content.
    pub what: String,
    /// `None` where no program with parts was measured.
    pub bytes: Option<u64>,
}

/// Returns the RAM of a 32-bit board for the parts of a scene, its meshes that deform, its instances that move, and its
/// lights and materials that change.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// use gridel_host::measure::board::working_rows;
///
/// // A scene without parts takes none.
/// assert!(working_rows(&blob.scene()?, blob.bytes()).is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn working_rows(scene: &Scene<'_>, blob: &[u8]) -> Vec<WorkingRow> {
    rows(&Programs::recorded(), scene, blob)
}

/// Returns all working memory of a 32-bit board for pictures of some ray depth: the workspace, and the
/// [rows](working_rows) of the scene. `None` if a row is not known.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// use gridel_core::Format;
/// use gridel_host::measure::board::working_bytes;
///
/// let scene = blob.scene()?;
/// assert_eq!(working_bytes(&scene, blob.bytes(), Format::F32, 0), Some(8));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn working_bytes(scene: &Scene<'_>, blob: &[u8], format: Format, depth: u8) -> Option<u64> {
    let workspace = board_memory(scene, format, depth).workspace as u64;
    let rows = working_rows(scene, blob);
    rows.iter()
        .try_fold(workspace, |sum, row| Some(sum + row.bytes?))
}

/// The rows with figures of some programs.
pub(super) fn rows(programs: &Programs, scene: &Scene<'_>, blob: &[u8]) -> Vec<WorkingRow> {
    let row = |what, bytes| WorkingRow { what, bytes };
    let mut rows = Vec::new();
    let parts = scene.parts().len();
    if parts > 0 {
        let required: Vec<&str> = scene.features().collect();
        let view = programs.part_view(&required);
        let bytes = view.map(|view| parts as u64 * view);
        rows.push(row(
            format!("views of {}, at most", counted(parts, "part")),
            bytes,
        ));
    }
    for mesh in Deforming::all(scene, blob) {
        let what = format!(
            "deforming mesh, {} vertices and {} pairs",
            mesh.vertices, mesh.pairs
        );
        rows.push(row(what, Some(mesh.bytes as u64)));
    }
    // They were checked with the scene.
    let targets = Tracks::from_bytes(blob).map_or(0, |tracks| tracks.weights_at_rest().len());
    if targets > 0 {
        let what = format!("weights of {}", counted(targets, "morph target"));
        rows.push(row(what, Some((targets * size_of::<i32>()) as u64)));
    }
    let moving = moving(scene, blob).into_iter().chain(changing(scene, blob));
    rows.extend(moving.map(|(what, bytes)| row(what, Some(bytes))));
    rows
}

/// Rows of the RAM in which a program changes all lights or materials of a scene where tracks change some.
fn changing(scene: &Scene<'_>, blob: &[u8]) -> impl Iterator<Item = (String, u64)> {
    // They were checked with the scene.
    let tracks = Tracks::from_bytes(blob).map_or(&[][..], |tracks| tracks.tracks());
    let changes = |is_of: fn(TrackTarget) -> bool| {
        let mut targets = tracks.iter().filter_map(Track::target);
        targets.any(is_of)
    };
    let lights = changes(TrackTarget::is_of_light).then(|| {
        let all = scene.lights();
        (counted(all.len(), "light"), size_of_val(all) as u64)
    });
    let materials = changes(TrackTarget::is_of_material).then(|| {
        let all = scene.materials();
        (counted(all.len(), "material"), size_of_val(all) as u64)
    });
    let rows = lights.into_iter().chain(materials);
    rows.map(|(all, bytes)| (format!("{all}, copied because tracks change them"), bytes))
}

/// Rows of the RAM in which a program moves the instances of a scene with joints; none without joints. A program that
/// leaves them at rest needs none of it.
fn moving(scene: &Scene<'_>, blob: &[u8]) -> Vec<(String, u64)> {
    // They were checked with the scene.
    let joints = Tracks::from_bytes(blob).map_or(0, |tracks| tracks.joints().len());
    if joints == 0 {
        return Vec::new();
    }
    let instances = scene.instances().len();
    // Records of 32 bits only, with the same size on boards.
    vec![
        (
            format!("moved instances ({})", counted(instances, "instance")),
            (instances * size_of::<Poses<1>>()) as u64,
        ),
        (
            format!("motions of {}", counted(joints, "joint")),
            (joints * size_of::<Motion>()) as u64,
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use gridel_core::format::record::{Light, Material};

    #[test]
    fn joints_take_ram_for_instances_and_motions() {
        let text = "ambient = 1\n[[part]]\nname = 'p'\n\
                    object = [{ kind = 'sphere', center = [0, 0, 0], radius = 1 }]\n\
                    [[joint]]\nname = 'a'\n[[joint]]\nname = 'b'\nparent = 'a'\n\
                    [[instance]]\npart = 'p'\njoint = 'a'\n[[instance]]\npart = 'p'\njoint = 'b'\n\
                    [[instance]]\npart = 'p'\n\
                    [[track]]\ntarget = 'joint.a.shift'\ntimes = [0, 1]\nvalues = [[0, 0, 0], [1, 0, 0]]\n";
        let imported = crate::scene::read("a.toml".as_ref(), text.into(), &Default::default());
        let compiled = compile(&imported.unwrap().scene, &Options::default()).unwrap();
        let scene = compiled.blob.scene().unwrap();
        let bytes = compiled.blob.bytes();
        let rows = moving(&scene, bytes);
        assert_eq!(
            rows.iter().map(|row| row.1).collect::<Vec<_>>(),
            [3 * 92, 2 * 64]
        );
        // With the view of the part, they count beside the workspace.
        let required: Vec<&str> = scene.features().collect();
        let view = Programs::recorded().part_view(&required).unwrap();
        let workspace = board_memory(&scene, Format::Fixed, 0).workspace as u64;
        assert_eq!(
            working_bytes(&scene, bytes, Format::Fixed, 0),
            Some(workspace + view + 3 * 92 + 2 * 64)
        );
        assert_eq!(
            working_rows(&scene, bytes)
                .iter()
                .map(|row| row.what.clone())
                .collect::<Vec<_>>(),
            [
                "views of 1 part, at most",
                "moved instances (3 instances)",
                "motions of 2 joints"
            ]
        );
    }

    #[test]
    fn tracks_of_lights_and_materials_take_ram_for_all_of_them() {
        let text = |tracks: &str| {
            format!(
                "[[light]]\nname = 'l'\nkind = 'point'\nposition = [0, 5, 0]\n\
                 [[light]]\nkind = 'point'\nposition = [5, 5, 0]\n\
                 [material.m]\n[material.n]\n\
                 [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n\
                 [[object]]\nkind = 'sphere'\ncenter = [3, 0, 0]\nradius = 1\nmaterial = 'n'\n{tracks}"
            )
        };
        let rows = |tracks: &str| {
            let text = text(tracks).into_bytes();
            let imported = crate::scene::read("a.toml".as_ref(), text, &Default::default());
            let compiled = compile(&imported.unwrap().scene, &Options::default()).unwrap();
            let scene = compiled.blob.scene().unwrap();
            let rows = working_rows(&scene, compiled.blob.bytes());
            rows.into_iter()
                .map(|row| row.bytes.unwrap())
                .collect::<Vec<_>>()
        };
        let light = "[[track]]\ntarget = 'light.l.color'\ntimes = [0, 1]\nvalues = [[0, 0, 0], [1, 1, 1]]\n";
        let material = "[[track]]\ntarget = 'material.m.diffuse'\ntimes = [0, 1]\n\
                        values = [[0, 0, 0], [1, 1, 1]]\n";
        let [lights, materials] = [
            2 * size_of::<Light>() as u64,
            2 * size_of::<Material>() as u64,
        ];
        assert_eq!(rows(""), [0; 0]);
        assert_eq!(rows(light), [lights]);
        assert_eq!(rows(material), [materials]);
        assert_eq!(rows(&format!("{light}{material}")), [lights, materials]);
    }
}
