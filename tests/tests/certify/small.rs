//! Small scenes with the features that the fixtures lack.

use gridel_host::scene::{Alpha, ImportOptions, Scene, read};
use gridel_tests::scenes;

/// Reads a scene as if it lay in the folder of fixtures, which has images.
pub fn scene(text: &str) -> Scene {
    let path = scenes::fixture_folder().join("small.toml");
    let imported = read(&path, text.into(), &ImportOptions::default());
    imported.expect("a scene").scene
}

/// The vertices and faces of an octahedron.
const OCTAHEDRON: &str = "\
    vertices = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]\n\
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]\n";

const CAMERA: &str =
    "[camera]\neye = [0.5, 2, 8]\ntarget = [0, 0, 0]\nfov = 40\n[render]\ndepth = 5\n";

const GROUND: &str = "[[object]]\nkind = 'box'\nmin = [-6, -1.5, -6]\nmax = [6, -1, 6]\nmaterial = 'ground'\n\
    [material.ground]\nchecker = { even = 0.8, odd = [0.5, 0.3, 0.2], size = 0.75 }\n";

/// All scenes by name.
pub fn all() -> Vec<(String, Scene)> {
    let mut all: Vec<(String, Scene)> = [
        ("smooth", smooth()),
        ("smooth under a sky", smooth_under_a_sky()),
        ("smooth near points", smooth_near_points()),
        ("spots", spots()),
        ("lamps", lamps()),
        ("rough glass", rough_glass()),
        ("lens", lens()),
        ("indirect through glass", indirect()),
        ("bumps", bumps(false)),
        ("bumps on balls", bumps(true)),
        ("bumps without shadows", without_shadows(&bumps(true))),
        ("within media", within_media()),
        ("levels", levels()),
    ]
    .map(|(name, text)| (String::from(name), scene(&text)))
    .into();
    all.push((String::from("blended"), blended()));
    all
}

/// Octahedra that are shaded as balls. One of glass lies on a mirror, and one is placed twice. A low light faces
/// normals where it does not face their triangles.
fn smooth() -> String {
    format!(
        "background = [0.3, 0.4, 0.6]\nambient = 0.1\n{CAMERA}\
         [[light]]\nkind = 'point'\nposition = [-6, 0.5, 3]\ncolor = 0.6\n\
         [[light]]\nkind = 'directional'\ndirection = [-3, -1, 0.5]\ncolor = 0.4\n\
         [material.glass]\ndiffuse = 0.1\ntransmit = 0.8\nior = 1.5\nhighlight = 0.3\n\
         [material.metal]\ndiffuse = 0.3\nmirror = 0.5\n\
         [[object]]\nkind = 'box'\nmin = [-4, -1.5, -4]\nmax = [4, -1.25, 4]\nmaterial = 'metal'\n\
         [[object]]\nkind = 'mesh'\nsmooth = 120\nmaterial = 'glass'\n{OCTAHEDRON}\
         [[part]]\nname = 'ball'\n\
         [[part.object]]\nkind = 'mesh'\nsmooth = 120\nmaterial = 'metal'\n{OCTAHEDRON}\
         [[instance]]\npart = 'ball'\ntranslate = [-2, 0, 0]\nrotate = [10, 20, 30]\n\
         [[instance]]\npart = 'ball'\ntranslate = [2, 0, -1]\nscale = 0.75\n"
    )
}

/// Returns a scene of such balls, diffuse and rough, under a map, a sun and an area light.
fn smooth_under_a_sky() -> String {
    format!(
        "{CAMERA}tone_mapping = 'reinhard'\n\
         [environment]\nzenith = [0.2, 0.4, 0.9]\nhorizon = [0.7, 0.8, 0.9]\nground = 0.1\nsize = 16\n\
         sun = {{ direction = [-3, -0.6, 0.5], color = 1.5, angle = 3 }}\n\
         [[light]]\nkind = 'sphere'\ncenter = [-6, 0.5, 3]\nradius = 0.5\nradiance = 20\n\
         [material.clay]\ndiffuse = [0.8, 0.7, 0.6]\n\
         [material.metal]\ndiffuse = 0.1\nmirror = 0.7\nroughness = 0.25\n\
         [material.dull]\ndiffuse = 0.1\nmirror = 0.7\nroughness = 0.6\n{GROUND}\
         [[object]]\nkind = 'mesh'\nsmooth = 120\nmaterial = 'clay'\n{OCTAHEDRON}\
         [[object]]\nkind = 'mesh'\nsmooth = 120\nmaterial = 'metal'\ntranslate = [-2, 0, 0]\n{OCTAHEDRON}\
         [[part]]\nname = 'ball'\n\
         [[part.object]]\nkind = 'mesh'\nsmooth = 120\nmaterial = 'dull'\n{OCTAHEDRON}\
         [[instance]]\npart = 'ball'\ntranslate = [2, 0, -1]\nrotate = [10, 20, 30]\nscale = 0.75\n"
    )
}

/// Returns a scene of such balls next to points that fall off, that end, or that are spots.
fn smooth_near_points() -> String {
    format!(
        "background = [0.1, 0.2, 0.3]\nambient = 0.02\n{CAMERA}\
         [[light]]\nkind = 'point'\nposition = [-3, 0.5, 1]\ncolor = [2, 1, 1]\nfalloff = 'square'\n\
         [[light]]\nkind = 'point'\nposition = [3, 1.5, 0.5]\ncolor = [0.2, 0.4, 0.8]\nrange = 4\n\
         [[light]]\nkind = 'spot'\nposition = [0, 2, 2]\ndirection = [0, -1, -1]\ncolor = [1, 3, 1]\nfalloff = 'square'\n\
         inner = 20\nouter = 50\n\
         [material.clay]\ndiffuse = [0.8, 0.7, 0.6]\n\
         [material.drink]\ndiffuse = 0.1\ntransmit = 0.8\nior = 1.33\nabsorption = [0.5, 0.2, 0.1]\n{GROUND}\
         [[object]]\nkind = 'mesh'\nsmooth = 120\nmaterial = 'clay'\n{OCTAHEDRON}\
         [[object]]\nkind = 'box'\nmin = [-2.75, 0, 0]\nmax = [-2.5, 1, 2]\nmaterial = 'drink'\n\
         [[part]]\nname = 'ball'\n\
         [[part.object]]\nkind = 'mesh'\nsmooth = 120\nmaterial = 'clay'\n{OCTAHEDRON}\
         [[instance]]\npart = 'ball'\ntranslate = [-1.5, 0, -1]\nrotate = [10, 20, 30]\n\
         [[instance]]\npart = 'ball'\ntranslate = [2, 0, -1]\nscale = 0.75\n"
    )
}

/// Points and spots that fall off, that end, or neither.
fn spots() -> String {
    format!(
        "{CAMERA}\
         [[light]]\nkind = 'spot'\nposition = [-3, 4, 2]\ndirection = [3, -4.5, -1]\ncolor = [20, 10, 5]\n\
         falloff = 'square'\nrange = 7\ninner = 10\nouter = 25\n\
         [[light]]\nkind = 'spot'\nposition = [4, 3, 3]\ndirection = [-4, -4, -2]\ncolor = [0.1, 0.3, 0.5]\nouter = 30\n\
         [[light]]\nkind = 'point'\nposition = [0, 2, -3]\ncolor = [2, 4, 2]\nfalloff = 'square'\n\
         [[light]]\nkind = 'point'\nposition = [3, 1, -2]\ncolor = 0.3\nrange = 4\n\
         [material.shiny]\ndiffuse = 0.5\nhighlight = 0.5\nshininess = 20\n{GROUND}\
         [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'shiny'\n\
         [[object]]\nkind = 'cylinder'\nbase = [2, -1, 1]\ntop = [2, 1, 1]\nradius = 0.25\n"
    )
}

/// A visible sphere, also seen in a mirror; a disc and a rectangle, of which one is visible. A triangle and a box that
/// glow, and an object that glows and is no light.
fn lamps() -> String {
    format!(
        "{CAMERA}\
         [[light]]\nkind = 'sphere'\ncenter = [-2, 1.5, 1]\nradius = 0.5\nradiance = [4, 3, 2]\nvisible = true\n\
         [[light]]\nkind = 'disc'\ncenter = [2, 3, 0]\nnormal = [-0.5, -1, 0]\nradius = 0.75\nradiance = 5\n\
         visible = true\n\
         [[light]]\nkind = 'rectangle'\ncorner = [3, 0, 3]\nedges = [[0, 1, 0], [1, 0, 1]]\nradiance = [1, 2, 6]\n\
         [material.glow]\ndiffuse = 0.2\nemission = [3, 4, 1]\n\
         [material.ember]\ndiffuse = 0.2\nemission = [0.6, 0.1, 0]\nlights = false\n\
         [material.chrome]\ndiffuse = 0.05\nmirror = 0.8\n\
         [material.dull]\ndiffuse = 0.1\nmirror = [0.9, 0.7, 0.4]\nroughness = 0.5\n\
         [material.satin]\ndiffuse = 0.1\nmirror = [0.9, 0.7, 0.4]\nroughness = 0.2\n{GROUND}\
         [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'chrome'\n\
         [[object]]\nkind = 'sphere'\ncenter = [2, -0.25, 0.5]\nradius = 0.75\nmaterial = 'dull'\n\
         [[object]]\nkind = 'sphere'\ncenter = [-2, -0.5, 0]\nradius = 0.5\nmaterial = 'satin'\n\
         [[object]]\nkind = 'triangle'\nvertices = [[-1, 3, 1], [1, 3, 1], [0, 3, 2]]\nmaterial = 'glow'\n\
         [[object]]\nkind = 'box'\nmin = [-1, -1, 2]\nmax = [-0.5, -0.75, 2.5]\nmaterial = 'glow'\n\
         [[object]]\nkind = 'sphere'\ncenter = [1, -0.75, 2.5]\nradius = 0.25\nmaterial = 'ember'\n"
    )
}

/// Rough glass alone, and overlapping media, one rough and one absorbing. Glass and a stone lie within.
fn rough_glass() -> String {
    format!(
        "background = [0.3, 0.5, 0.8]\nambient = 0.1\n{CAMERA}\
         [[light]]\nkind = 'sphere'\ncenter = [-2, 5, 3]\nradius = 1\nradiance = 12\n\
         [[light]]\nkind = 'point'\nposition = [4, 4, 4]\ncolor = 0.4\n\
         [material.frost]\ndiffuse = 0\ntransmit = 0.9\nroughness = 0.3\n\
         [material.ice]\ndiffuse = 0.05\ntransmit = 0.9\nior = 1.31\nroughness = 0.2\npriority = 3\n\
         [material.drink]\ndiffuse = 0\ntransmit = 1\nior = 1.33\nabsorption = [0.1, 0.5, 0.9]\npriority = 2\n\
         [material.hull]\ndiffuse = 0\ntransmit = 1\nior = 1.6\nabsorption = 0.1\npriority = 1\n\
         [material.bead]\ndiffuse = 0\ntransmit = 1\nior = 1.8\nabsorption = [0.9, 0.1, 0.1]\n{GROUND}\
         [[object]]\nkind = 'sphere'\ncenter = [-2.2, 0, 0]\nradius = 1\nmaterial = 'frost'\n\
         [[object]]\nkind = 'box'\nmin = [-1, -0.9, -1]\nmax = [1, 1, 1]\nmaterial = 'hull'\n\
         [[object]]\nkind = 'sphere'\ncenter = [0.25, 0, 0.25]\nradius = 0.9\nmaterial = 'drink'\n\
         [[object]]\nkind = 'box'\nmin = [-0.25, 0.25, -0.25]\nmax = [0.5, 1.25, 0.5]\nmaterial = 'ice'\n\
         [[object]]\nkind = 'sphere'\ncenter = [0.25, -0.4, 0.4]\nradius = 0.25\nmaterial = 'bead'\n\
         [[object]]\nkind = 'sphere'\ncenter = [-0.5, 0, 0.25]\nradius = 0.25\n\
         [[object]]\nkind = 'cylinder'\nbase = [2, -1, 0]\ntop = [2.5, 1, 0]\nradius = 0.5\nmaterial = 'drink'\n"
    )
}

/// A lens that is sharp at the second of three balls.
fn lens() -> String {
    format!(
        "background = [0.3, 0.5, 0.8]\n\
         [camera]\neye = [-3, 1.5, 6]\ntarget = [0, -0.25, 0]\nfov = 35\naperture = 0.5\nfocus = 6.5\n\
         [[light]]\nkind = 'directional'\ndirection = [1, -2, -1]\n\
         [material.glass]\ndiffuse = 0\ntransmit = 1\n{GROUND}\
         [[object]]\nkind = 'sphere'\ncenter = [-1.5, 0, 1.5]\nradius = 0.75\nmaterial = 'glass'\n\
         [[object]]\nkind = 'sphere'\ncenter = [0, -0.25, 0]\nradius = 0.75\n\
         [[object]]\nkind = 'torus'\ncenter = [1.5, 0, -2]\naxis = [1, 2, 1]\nmajor_radius = 0.75\nminor_radius = 0.25\n"
    )
}

/// Two bounces of diffuse light through smooth and rough glass, from a lamp that is a light and from the background.
fn indirect() -> String {
    format!(
        "background = [0.4, 0.6, 0.9]\n{CAMERA}bounces = 2\ncutoff = 0\n\
         [material.lamp]\ndiffuse = 0.5\nemission = [9, 7, 4]\n\
         [material.pane]\ndiffuse = 0\ntransmit = 0.9\nabsorption = [0.4, 0, 0.2]\n\
         [material.frost]\ndiffuse = 0\nmirror = 0.2\ntransmit = 0.8\nroughness = 0.6\n\
         [material.wall]\ndiffuse = [0.8, 0.3, 0.2]\n{GROUND}\
         [[object]]\nkind = 'box'\nmin = [-3, -1, -3]\nmax = [3, 3, -2.5]\nmaterial = 'wall'\n\
         [[object]]\nkind = 'box'\nmin = [-1, 2.5, -1]\nmax = [1, 2.75, 1]\nmaterial = 'lamp'\n\
         [[object]]\nkind = 'box'\nmin = [-2.5, -1, -1]\nmax = [2, 1, -0.75]\nmaterial = 'pane'\n\
         [[object]]\nkind = 'sphere'\ncenter = [1.5, -0.25, 1]\nradius = 0.75\nmaterial = 'frost'\n\
         [[object]]\nkind = 'sphere'\ncenter = [-1, -0.25, 0.5]\nradius = 0.75\n"
    )
}

fn without_shadows(text: &str) -> String {
    text.replace("depth = 5", "depth = 5\nshadows = false")
}

/// The eye within two media, which rays never entered, and a lamp within one of them.
fn within_media() -> String {
    String::from(
        "background = [0.3, 0.5, 0.8]\nambient = 0.1\n\
         [camera]\neye = [0.5, 0.25, 2]\ntarget = [0, 0, 0]\nfov = 60\n[render]\ndepth = 6\n\
         [[light]]\nkind = 'sphere'\ncenter = [0, 1.5, 0]\nradius = 0.25\nradiance = 9\nvisible = true\n\
         [material.drink]\ndiffuse = 0\ntransmit = 1\nior = 1.33\nabsorption = [0.1, 0.2, 0.3]\npriority = 2\n\
         [material.hull]\ndiffuse = 0.1\ntransmit = 0.9\nior = 1.6\nabsorption = [0.3, 0.1, 0.1]\npriority = 1\n\
         [[object]]\nkind = 'box'\nmin = [-2, -2, -2]\nmax = [2, 2.25, 3]\nmaterial = 'hull'\n\
         [[object]]\nkind = 'sphere'\ncenter = [0.5, 0, 1.5]\nradius = 1\nmaterial = 'drink'\n\
         [[object]]\nkind = 'cylinder'\nbase = [-1, -1.5, 0]\ntop = [0.5, 1, -1]\nradius = 0.5\nmaterial = 'drink'\n\
         [[object]]\nkind = 'sphere'\ncenter = [1, -0.5, -1]\nradius = 0.5\n\
         [[object]]\nkind = 'box'\nmin = [-6, -6, -9]\nmax = [6, 6, -8]\n",
    )
}

/// Normals of an image: on mirrors and glass, seen from both sides and mirrored, on flat meshes alone or on balls as
/// well.
fn bumps(has_balls: bool) -> String {
    let mapped =
        "coordinates = [[0, 0], [1, 0.25], [0.75, 1], [0, 0.75], [0.5, 0.25], [0.25, 0.5]]\n";
    let ball = |place: &str| {
        format!(
            "[[object]]\nkind = 'mesh'\nsmooth = 120\ntranslate = {place}\n{OCTAHEDRON}{mapped}material = 'bumpy"
        )
    };
    let balls = format!(
        "{}'\n{} metal'\n{} glass'\n",
        ball("[-2, 0, 0]"),
        ball("[0, 0, 0.5]"),
        ball("[2, 0, 0]")
    );
    let map = "normal_map = 'tiles.png'\nnormal_scale = 0.5\n";
    format!(
        "background = [0.3, 0.5, 0.8]\nambient = 0.1\n{CAMERA}\
         [[light]]\nkind = 'point'\nposition = [-6, 0.5, 3]\ncolor = 0.6\n\
         [[light]]\nkind = 'sphere'\ncenter = [3, 3, -2]\nradius = 0.5\nradiance = 20\n\
         [material.bumpy]\ndiffuse = 0.7\nhighlight = 0.3\n{map}\
         [material.'bumpy metal']\ndiffuse = 0.1\nmirror = 0.8\nroughness = 0.2\n{map}\
         [material.'bumpy glass']\ndiffuse = 0.1\ntransmit = 0.8\n{map}{GROUND}\
         [[object]]\nkind = 'mesh'\nmaterial = 'bumpy metal'\n\
         vertices = [[-5, -0.9, 3], [5, -0.9, 3], [5, -0.9, -3], [-5, -0.9, -3]]\nfaces = [[0, 1, 2, 3]]\n\
         coordinates = [[4, 1], [0, 1], [0, 0], [4, 0]]\n\
         [[object]]\nkind = 'mesh'\nmaterial = 'bumpy'\n\
         vertices = [[-5, -0.9, -3], [-5, 3, -4], [5, 3, -4], [5, -0.9, -3]]\nfaces = [[0, 1, 2, 3]]\n\
         coordinates = [[0, 1], [0, 0], [3, 0.25], [3, 1]]\n\
         [[part]]\nname = 'block'\n[[part.object]]\nkind = 'mesh'\nmaterial = 'bumpy glass'\n{OCTAHEDRON}{mapped}\
         [[instance]]\npart = 'block'\ntranslate = [1, 1.5, 1]\nrotate = [10, 20, 30]\nscale = 0.75\n{}",
        if has_balls { &balls } else { "" }
    )
}

/// Images with alpha, blended and cut out, under a lamp. They stand alone, within glass that has a priority, with
/// colors of vertices, and in a part.
fn blended() -> Scene {
    let quad = "vertices = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]\nfaces = [[0, 1, 2, 3]]\n\
        coordinates = [[-0.25, 1.5], [1.5, 1.25], [1.25, -0.5], [0, 0]]\n";
    let mut scene = scene(&format!(
        "background = [0.3, 0.5, 0.8]\nambient = 0.05\n{CAMERA}bounces = 1\n\
         [[light]]\nkind = 'sphere'\ncenter = [-2, 5, 6]\nradius = 0.5\nradiance = 60\n\
         [material.veil]\ntexture = {{ file = 'screen.png', wrap = 'clamp' }}\nalpha = 'blend'\n\
         [material.lattice]\ntexture = {{ file = 'screen.png', filter = 'nearest' }}\nalpha = 'cutout'\nmirror = 0.2\n\
         [material.tile]\ntexture = {{ file = 'tiles.png', wrap = 'mirror', scale = 2 }}\n\
         [material.drink]\ndiffuse = 0\ntransmit = 1\nior = 1.33\nabsorption = [0.1, 0.5, 0.9]\npriority = 1\n{GROUND}\
         [[object]]\nkind = 'mesh'\nmaterial = 'veil'\ntranslate = [-1.5, 0.25, 1]\n{quad}\
         colors = [[1, 0.2, 0.1], [1, 0.8, 0.1], [0.1, 0.5, 1], [0.2, 0.9, 0.3]]\n\
         [[object]]\nkind = 'box'\nmin = [-2.5, -0.9, -2]\nmax = [1, 1.25, 0.75]\nmaterial = 'drink'\n\
         [[object]]\nkind = 'mesh'\nmaterial = 'veil'\ntranslate = [-0.25, 0.1, -0.5]\nscale = 0.75\n{quad}\
         [[object]]\nkind = 'mesh'\nmaterial = 'tile'\ntranslate = [-0.5, 0, -3]\nscale = 2\n{quad}\
         [[part]]\nname = 'screen'\n[[part.object]]\nkind = 'mesh'\nmaterial = 'lattice'\n{quad}\
         colors = [[1, 0.2, 0.1], [1, 0.8, 0.1], [0.1, 0.5, 1], [0.2, 0.9, 0.3]]\n\
         [[instance]]\npart = 'screen'\ntranslate = [2, 0, 0]\nrotate = [10, -30, 20]\n"
    ));
    for material in &mut scene.materials {
        if let Some(Alpha::Blend(opacity)) = &mut material.alpha {
            *opacity = 0.75;
        }
    }
    scene
}

/// A floor to the horizon, and a tile that is placed twice, of an image with levels; a ball mirrors them.
fn levels() -> String {
    let corners = "coordinates = [[0, 9], [9, 9], [9, 0], [0, 0]]\nfaces = [[0, 1, 2, 3]]\n";
    format!(
        "background = [0.3, 0.4, 0.6]\nambient = 0.1\n{CAMERA}\
         [[light]]\nkind = 'point'\nposition = [-6, 5, 3]\ncolor = 0.6\n\
         [material.tile]\ntexture = {{ file = 'tiles.png', levels = true }}\n\
         [material.metal]\ndiffuse = 0.1\nmirror = 0.8\n\
         [[object]]\nkind = 'mesh'\nmaterial = 'tile'\n{corners}\
         vertices = [[-20, -1, 9], [20, -1, 9], [20, -1, -90], [-20, -1, -90]]\n\
         [[object]]\nkind = 'sphere'\nmaterial = 'metal'\ncenter = [0, 0, 0]\nradius = 1\n\
         [[part]]\nname = 'tile'\n[[part.object]]\nkind = 'mesh'\nmaterial = 'tile'\n{corners}\
         vertices = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]\n\
         [[instance]]\npart = 'tile'\ntranslate = [-2, 0, -1]\nrotate = [10, 40, 5]\n\
         [[instance]]\npart = 'tile'\ntranslate = [2, 0, 0]\nscale = 0.5\n"
    )
}
