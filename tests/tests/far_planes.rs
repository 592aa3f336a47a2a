//! Infinite planes that are hit many times as far away as the scene's box is wide.

use crate::large_scenes::{blob, differing, picture};
use gridel_core::Format;

/// Rays leave planes from where they are hit, also beyond the lengths of `fixed`: mirrored rays, shadow rays and diffuse
/// ones. The eye is many times as far from the ball as that is wide.
#[test]
fn rays_leave_planes_at_any_distance() {
    const MIRROR: &str = "background = [0, 0, 0.3]
        [camera]
        eye = [0, 0.6, 12]
        target = [0, 0.4, 0]
        fov = 40
        [[light]]
        kind = 'directional'
        direction = [-0.2, -0.3, -1]
        [material.water]
        diffuse = 0.1
        mirror = 0.7
        [material.wall]
        checker = { even = [0.9, 0.2, 0.1], odd = 0.1, size = 1 }
        [[object]]
        kind = 'sphere'
        center = [0, 0.5, 0]
        radius = 0.5
        [[object]]
        kind = 'plane'
        point = [0, 0, 0]
        normal = [0, 1, 0]
        material = 'water'
        [[object]]
        kind = 'plane'
        point = [0, 0, -1.5]
        normal = [0, 0, 1]
        material = 'wall'";
    const SHADOW: &str = "[camera]
        eye = [0, 3, 60]
        target = [0, 0, 20]
        fov = 40
        [[light]]
        kind = 'directional'
        direction = [0, -0.05, 1]
        [[object]]
        kind = 'sphere'
        center = [0, 0.5, 0]
        radius = 0.5
        [[object]]
        kind = 'plane'
        point = [0, 0, 0]
        normal = [0, 1, 0.01]";
    let sky =
        format!("{SHADOW}\n[environment]\nhorizon = 0.2\nzenith = [0.1, 0.2, 0.9]\nground = 0.1");
    let sun = "kind = 'directional'\n        direction = [0, -0.05, 1]";
    assert!(SHADOW.contains(sun));
    let lit_by = |light: &str| SHADOW.replace(sun, light);
    let point = lit_by("kind = 'point'\nposition = [1, 4, -6]\ncolor = 800\nfalloff = 'square'");
    let area = lit_by("kind = 'sphere'\ncenter = [1, 6, -6]\nradius = 0.5\nradiance = 2000");
    for file in [MIRROR, SHADOW, &sky, &point, &area] {
        let imported =
            gridel_host::scene::read("far.toml".as_ref(), file.into(), &Default::default());
        let blob = blob(&imported.expect("a scene").scene);
        let size = [160, 120];
        let exact = picture(&blob, Format::F64, size);
        for format in [Format::Fixed, Format::F32] {
            let found = differing(&exact, &picture(&blob, format, size));
            assert!(found <= 8, "{file}\n{format:?}: {found} pixels");
        }
    }
}
