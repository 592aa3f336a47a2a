//! Indirect light: pictures have the values that analysis gives.

use gridel_core::{
    Effects, Fixed, Format, List, NoCount, Renderer, Settings, Structure, Workspace,
};
use gridel_host::blob::Blob;
use gridel_tests::effort::part_of;
use gridel_tests::measured::{SCRAMBLES_WIDE, blob, check, measured};

/// Returns a room around the origin, 20 wide, whose walls glow inwards. Each wall has four squares, the size of a
/// light.
fn room(albedo: f64, emission: f64, lights: bool, bounces: u8) -> Blob {
    blob(&room_text(albedo, emission, lights, bounces))
}

fn room_text(albedo: f64, emission: f64, lights: bool, bounces: u8) -> String {
    let mut text = format!(
        "[camera]\neye = [1, 2, 3]\ntarget = [4, 3, -9]\nfov = 0.2\n\
         [render]\n{SCRAMBLES_WIDE}samples = 1\nbounces = {bounces}\ncutoff = 0\n\
         [material.wall]\ndiffuse = {albedo}\nemission = {emission}\nlights = {lights}\n"
    );
    for (axis, side) in (0..3).flat_map(|axis| [(axis, -10), (axis, 10)]) {
        let mut corners = Vec::new();
        let mut faces = Vec::new();
        for (right, up) in [(-10, -10), (-10, 0), (0, -10), (0, 0)] {
            let first = corners.len();
            for (dx, dy) in [(0, 0), (10, 0), (10, 10), (0, 10)] {
                let mut at = [side; 3];
                (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (right + dx, up + dy);
                corners.push(format!("{at:?}"));
            }
            let mut face = [first, first + 1, first + 2, first + 3];
            // Counterclockwise from inside.
            if side > 0 {
                face.reverse();
            }
            faces.push(format!("{face:?}"));
        }
        text += &format!(
            "[[object]]\nkind = 'mesh'\nmaterial = 'wall'\nvertices = [{}]\nfaces = [{}]\n",
            corners.join(", "),
            faces.join(", ")
        );
    }
    text
}

/// Surfaces that light passes straight on take nothing away, and spend no bounces.
#[test]
fn light_that_passes_surfaces_spends_no_bounces() {
    let (albedo, emission) = (0.5, 0.1);
    let shells: String = [4, 6, 8]
        .map(|radius| {
            format!(
                "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = {radius}\nmaterial = 'clear'\n"
            )
        })
        .concat();
    for bounces in [1, 2] {
        let room = room_text(albedo, emission, false, bounces)
            .replace("[render]\n", "[render]\ndepth = 32\n");
        let clear = "[material.clear]\ndiffuse = 0\ntransmit = 1\nior = 1\n";
        let part = 1.0 - f64::powi(albedo, i32::from(bounces) + 1);
        let exact = part * emission / (1.0 - albedo);
        check("shells", &blob(&format!("{room}{clear}{shells}")), exact);
    }
}

/// A closed room whose walls glow has the radiance e / (1 - a) everywhere, less the light of bounces beyond the last
/// one.
#[test]
fn closed_furnace_has_the_analytic_radiance() {
    for (albedo, emission) in [(0.8, 0.1), (0.5, 0.1)] {
        let exact = emission / (1.0 - albedo);
        // The light of more than 32 bounces: 0.06 % of a radiance at an albedo of 0.8.
        let brought = exact * (1.0 - f64::powi(albedo, 33));
        assert!((brought / exact - 1.0).abs() < 0.002);
        check("furnace", &room(albedo, emission, false, 32), brought);
        for bounces in 1..4 {
            let part = 1.0 - f64::powi(albedo, i32::from(bounces) + 1);
            let blob = room(albedo, emission, false, bounces);
            check("few bounces", &blob, part * exact);
        }
    }
}

/// A furnace where each wall is a light as well: no light counts twice, and none is lost.
#[test]
fn light_of_lights_is_brought_once() {
    for format in Format::ALL {
        let blob = room(0.5, 0.05, true, 32);
        let effects = blob.scene().expect("a scene").effects();
        assert!(effects.contains(Effects::AREA_LIGHT.with(Effects::INDIRECT)));
        let (mean, error) = measured(&blob, format, part_of(256, 1024) as u16);
        let off = (mean - 0.1).abs();
        assert!(off <= 3.0 * error + 2e-4, "{format:?}: {mean} +- {error}");
    }
}

/// A disc above a floor: L r² / (r² + h²), by diffuse rays alone, by rays to a light alone, and by both.
#[test]
fn discs_light_a_floor_alike_in_each_way() {
    for (lights, bounces) in [(false, 1), (true, 0), (true, 1), (true, 3)] {
        let blob = blob(&format!(
            "[camera]\neye = [0, 10, 0]\ntarget = [0, 0, 0]\nup = [0.3, 0.2, 1]\nfov = 0.2\n\
             [render]\n{SCRAMBLES_WIDE}samples = 1\nbounces = {bounces}\ncutoff = 0\n\
             [material.white]\ndiffuse = 1\n\
             [material.lamp]\ndiffuse = 0\nemission = 0.9\nlights = {lights}\n\
             [[object]]\nkind = 'box'\nmin = [-900, -100, -900]\nmax = [900, 0, 900]\nmaterial = 'white'\n\
             [[object]]\nkind = 'disc'\ncenter = [0, 100, 0]\nnormal = [0, -1, 0]\nradius = 100\nmaterial = 'lamp'"
        ));
        check("disc", &blob, 0.45);
    }
}

/// If some objects of a material are lights, diffuse rays see the others.
#[test]
fn objects_without_light_of_a_shared_material_light_by_diffuse_rays() {
    let text = |lights: bool| {
        format!(
            "[camera]\neye = [0, 10, 0]\ntarget = [0, 0, 0]\nup = [0.3, 0.2, 1]\nfov = 0.2\n\
             [render]\n{SCRAMBLES_WIDE}samples = 1\nbounces = 1\ncutoff = 0\n\
             [material.white]\ndiffuse = 1\n\
             [material.lamp]\ndiffuse = 0\nemission = 0.6\nlights = {lights}\n\
             [[object]]\nkind = 'box'\nmin = [-900, -100, -900]\nmax = [900, 0, 900]\nmaterial = 'white'\n\
             [[object]]\nkind = 'torus'\ncenter = [0, 90, 0]\naxis = [0, 1, 0]\nmajor_radius = 120\nminor_radius = 30\nmaterial = 'lamp'\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 80, 0]\nradius = 40\nmaterial = 'lamp'"
        )
    };
    // The torus has no light of its own.
    let (seen, sampled) = (blob(&text(false)), blob(&text(true)));
    let lights = |blob: &Blob| blob.scene().expect("a scene").lights().len();
    assert_eq!([lights(&seen), lights(&sampled)], [0, 1]);
    for format in Format::ALL {
        let (expected, first) = measured(&seen, format, 1024);
        let (found, second) = measured(&sampled, format, 1024);
        let most = 3.0 * first.hypot(second) + 1e-4;
        assert!(
            (found - expected).abs() <= most,
            "{format:?}: {found}, {expected}"
        );
    }
}

/// Surfaces that mirror, transmit light and are diffuse cause three rays. The work list that the effects require is
/// long enough.
#[test]
fn work_lists_hold_all_rays_that_wait() {
    let blob = blob(
        "background = 0.5\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
         [render]\nwidth = 24\nheight = 24\nsamples = 2\ndepth = 3\nbounces = 3\ncutoff = 0\n\
         [material.all]\ndiffuse = 0.5\nmirror = 0.2\ntransmit = 0.5\n\
         [[object]]\nkind = 'sphere'\ncenter = [-1.1, 0, 0]\nradius = 1\nmaterial = 'all'\n\
         [[object]]\nkind = 'sphere'\ncenter = [1.1, 0, 0]\nradius = 1\nmaterial = 'all'\n\
         [[object]]\nkind = 'box'\nmin = [-3, -3, -3]\nmax = [3, -1, 2]\nmaterial = 'all'",
    );
    let scene = blob.scene().expect("a scene");
    const EFFECTS: u32 = Effects::ALL.0;
    assert_eq!(scene.effects().work_depth(3), 7);
    let settings = Settings::of(&scene);
    let renderer = Renderer::<Fixed, List, EFFECTS>::with_settings(&scene, settings);
    let renderer = renderer.expect("a renderer");
    let mut exact = Workspace::<Fixed, 64, 7>::new();
    let mut ample = Workspace::<Fixed, 64, 99>::new();
    let mut short = Workspace::<Fixed, 64, 4>::new();
    assert!(renderer.check_workspace(&exact.as_view()).is_ok());
    assert!(renderer.check_workspace(&short.as_view()).is_err());
    let mut losses = 0;
    for (x, y) in (0..24).flat_map(|y| (0..24).map(move |x| (x, y))) {
        let found = renderer.linear(x, y, &mut exact.as_view(), &mut NoCount);
        let expected = renderer.linear(x, y, &mut ample.as_view(), &mut NoCount);
        assert_eq!(found, expected, "{x}, {y}");
        losses += u32::from(renderer.linear(x, y, &mut short.as_view(), &mut NoCount) != expected);
    }
    assert!(losses > 20, "{losses}");
}

/// No bounces are as if there were no such key, and cost nothing.
#[test]
fn scenes_without_bounces_have_the_blob_that_they_had() {
    let text = |render: &str| {
        format!(
            "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n[render]\n{render}\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'"
        )
    };
    let (without, zero) = (blob(&text("")), blob(&text("bounces = 0")));
    assert_eq!(without.bytes(), zero.bytes());
    let effects = |blob: &Blob| blob.scene().expect("a scene").effects();
    assert!(!effects(&zero).contains(Effects::INDIRECT));
    let lit = blob(&text("bounces = 2"));
    assert!(effects(&lit).contains(Effects::INDIRECT));
    assert_eq!(lit.scene().expect("a scene").bounces(), 2);
    let structures = [Structure::List, Structure::DualSplit];
    assert!(
        structures
            .iter()
            .all(|&it| lit.scene().expect("a scene").holds(it))
    );
}
