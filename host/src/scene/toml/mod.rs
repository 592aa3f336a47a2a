//! Gridel's own scene format: TOML that a person writes.
//!
//! Lengths are scene units in a right-handed space, angles are degrees. A *vector* is an array of
//! three numbers. A *colour* is an array of three linear numbers at or above 0 (1 being display
//! white), one number for grey, or an sRGB string `"#rrggbb"`. All numbers must be finite. A key
//! that is not listed here is an error. Keys without a default must be given.
//!
//! # The scene
//!
//! | key | type | default |
//! |---|---|---|
//! | `background` | colour that a ray sees which meets nothing | black, or light grey without a camera |
//! | `ambient` | colour of light that reaches every surface from everywhere | black |
//! | `camera`, `render` | tables, below | everything is seen along -z and takes 80 % of the picture; as below |
//! | `light`, `object` | arrays of tables, below | none |
//! | `material`, `group` | named tables, below | none |
//!
//! `[camera]`
//!
//! | key | type | range | default |
//! |---|---|---|---|
//! | `eye` | vector, where the camera is | | |
//! | `target` | vector, a point in the middle of the picture | not `eye` | |
//! | `up` | vector of any length | not along the view | `[0, 1, 0]` |
//! | `fov` | degrees, the full vertical angle of view | above 0, below 180 | 45 |
//!
//! `[render]`: defaults that the command line overrides
//!
//! | key | type | range | default |
//! |---|---|---|---|
//! | `width`, `height` | pixels | 1 to 65535, `width` at most 64 times `height` | 320, 240 |
//! | `samples` | samples a pixel | 1 to 256 | 1 |
//! | `depth` | how often a ray may be reflected or refracted | 0 to 16 | 5 |
//! | `cutoff` | rays that can change no channel by more than this are not traced | 0 to 1 | 1/512 |
//! | `shadows` | whether objects stand in each other's light | `true` or `false` | `true` |
//!
//! `[[light]]`
//!
//! | key | type | default |
//! |---|---|---|
//! | `kind` | `"point"` (no falloff) or `"directional"` | |
//! | `position` | vector; point lights only | |
//! | `direction` | vector of any length above 0, the way the light travels; directional lights only | |
//! | `color` | colour | 1 |
//!
//! `[material.NAME]`
//!
//! | key | type | range | default |
//! |---|---|---|---|
//! | `diffuse` | colour | | 0.8 |
//! | `checker` | instead of `diffuse`: `{ even, odd, size, origin }`, cubes of edge `size` in two colours, aligned with the axes of the world, with a corner at the vector `origin` | `size` above 0 | size 1, origin `[0, 0, 0]` |
//! | `highlight` | colour of the reflections of lights (Blinn-Phong) | | 0 |
//! | `shininess` | exponent of the highlight | 1 to 1024 | 32 |
//! | `mirror` | colour, the weight of the mirrored ray | | 0 |
//! | `transmit` | colour, the weight of what glass brings | | 0 |
//! | `ior` | index of refraction | 1 to 4 | 1.5 |
//! | `absorption` | three numbers or one: the coefficient of Beer's law per scene unit | at or above 0 | 0 |
//!
//! Materials belong to the world: transforms of objects neither move a checker nor thicken glass.
//! An object that gets no material has the one named `default`, which a scene may define.
//!
//! # Objects
//!
//! Every `[[object]]` has a `kind`, and may have a `name` (text), a `material` (the name of one)
//! and a transform. Without a name it is called after its kind and its number in its list, an
//! import after its file; inside groups and imports names are joined by slashes.
//!
//! | kind | keys |
//! |---|---|
//! | `"sphere"` | `center`, `radius` |
//! | `"box"` | `min`, `max`: opposite corners, vectors; equal on at most one axis (a flat box) |
//! | `"disc"` | `center`, `normal` (of any length above 0), `radius` |
//! | `"cylinder"` | `base`, `top`: vectors that differ; `radius` |
//! | `"cone"` | `base`, `apex`: vectors that differ; `radius` of the base |
//! | `"frustum"` | `base`, `top`: vectors that differ; `base_radius`, `top_radius` |
//! | `"triangle"` | `vertices`: three vectors, not on one line; counter-clockwise from the front |
//! | `"mesh"` | `vertices`: vectors; `faces`: arrays of 3 to 1024 indices into them, from 0, counter-clockwise from the front; polygons, also concave ones, are cut into triangles |
//! | `"group"` | `object`: objects that share the transform and the material |
//! | `"instance"` | `group`: the name of a `[group.NAME]` whose objects are placed here |
//! | `"import"` | `file`: a scene file of any format, its path relative to this file, in the folder of the outermost scene file or below, unless `--allow-outside` is given; for molecules `style` (`"space-filling"` or `"ball-and-stick"`), `model` (from 1) and `altloc` (one character), by default what the command line says |
//!
//! All radii are above 0. Cylinders, cones and frusta are closed by caps. `[group.NAME]` has the
//! key `object`, an array of objects like the scene's own: write `[[group.NAME.object]]` or
//! `object = [{ kind = ... }, ...]`. Groups may hold groups, instances and imports, but not
//! themselves; 64 groups and 16 files may be nested. An object's own material counts first, then
//! that of the innermost group or instance around it that has one. A scene may hold 16,777,216
//! primitives (a mesh's triangles count one by one), and take 3.8 GB of memory until it is compiled,
//! which is estimated before anything is placed: 512 bytes an object, 224 a triangle, and each
//! object's name twice.
//!
//! # Transforms
//!
//! An object is scaled first, then rotated, then translated, and after that follows the
//! transforms of the groups around it.
//!
//! | key | type | default |
//! |---|---|---|
//! | `scale` | a number, or a vector with one for each axis; not 0; negative ones mirror | 1 |
//! | `rotate` | `{ axis, degrees }`, or `[x, y, z]`: degrees about the x, then the y, then the z axis; counter-clockwise as seen from the axis' tip | none |
//! | `translate` | vector | `[0, 0, 0]` |
//!
//! Fronts stay fronts in a mirror. Spheres, discs, cylinders, cones and frusta must be scaled by
//! one size on all axes. A box that is turned by anything but multiples of 90 degrees becomes a
//! mesh of twelve triangles. Meshes take every transform.
//!
//! # Imports
//!
//! An import brings the objects and materials of another file; files that import each other in a
//! circle are refused. Its materials can be used by name in this file as well; one whose name is
//! taken by a different material is called `IMPORT/NAME`. A `material` on the import replaces the
//! materials of all its objects. A material of a group or instance around it does not.
//!
//! An import in the scene's own list, outside groups, also lends what this scene does not state,
//! after the transform of the import: the camera and the render settings (both of the first
//! import that has a camera), all lights if this scene has none, the first background, and the first
//! ambient light that is not black. With the lights of an NFF file comes that colours and
//! lights are display values, not linear ones.
//!
//! # Example
//!
//! ```toml
//! background = "#a0c0e0"
//! ambient = 0.1
//!
//! [camera]
//! eye = [0, 4, 12]
//! target = [0, 1, 0]
//! up = [0, 1, 0]
//! fov = 40
//!
//! [render]
//! width = 400
//! height = 300
//! samples = 4
//! depth = 6
//! cutoff = 0.002
//!
//! [[light]]
//! kind = "point"
//! position = [5, 8, 5]
//! color = [0.8, 0.8, 0.7]
//!
//! [[light]]
//! kind = "directional"
//! direction = [-1, -2, -1]
//! color = 0.3
//!
//! [material.floor]
//! checker = { even = 0.9, odd = "#404040", size = 2, origin = [0, 0.5, 0] }
//!
//! [material.glass]
//! diffuse = 0
//! transmit = 1
//! ior = 1.5
//! absorption = [0.3, 0.05, 0.1]
//! highlight = 0.5
//! shininess = 200
//!
//! [material.steel]
//! diffuse = 0.2
//! mirror = [0.6, 0.6, 0.65]
//!
//! [[object]]
//! name = "floor"
//! kind = "box"
//! min = [-10, -0.5, -10]
//! max = [10, 0, 10]
//! material = "floor"
//!
//! # A pillar with a ball on top, defined once ...
//! [group.pillar]
//! object = [
//!   { kind = "cylinder", base = [0, 0, 0], top = [0, 2, 0], radius = 0.3 },
//!   { kind = "sphere", center = [0, 2.5, 0], radius = 0.5, name = "ball", material = "glass" },
//! ]
//!
//! # ... and used twice.
//! [[object]]
//! name = "left"
//! kind = "instance"
//! group = "pillar"
//! translate = [-3, 0, 0]
//! material = "steel"
//!
//! [[object]]
//! name = "right"
//! kind = "instance"
//! group = "pillar"
//! scale = 1.2
//! rotate = { axis = [0, 0, 1], degrees = -5 }
//! translate = [3, 0, 0]
//!
//! [[object]]
//! name = "ring"
//! kind = "group"
//! rotate = [0, 30, 0]
//! material = "steel"
//!
//! [[object.object]]
//! kind = "cone"
//! base = [1, 0, 0]
//! apex = [1, 1, 0]
//! radius = 0.5
//!
//! [[object.object]]
//! kind = "frustum"
//! base = [-1, 0, 0]
//! top = [-1, 1, 0]
//! base_radius = 0.5
//! top_radius = 0.2
//!
//! [[object.object]]
//! kind = "disc"
//! center = [0, 0.01, 0]
//! normal = [0, 1, 0]
//! radius = 0.6
//!
//! [[object]]
//! kind = "triangle"
//! vertices = [[-1, 3, -2], [1, 3, -2], [0, 4, -2]]
//!
//! # An arrowhead: its face is concave.
//! [[object]]
//! kind = "mesh"
//! vertices = [[1, 0, 0], [0, 2, 0], [-1, 0, 0], [0, 0.5, 0]]
//! faces = [[0, 1, 2, 3]]
//! scale = [-1, 1, 1]
//! translate = [0, 4, -2]
//! ```

mod census;
mod document;
mod import;
mod material;
mod object;
mod place;
mod shape;
pub(crate) mod source;
mod transform;
pub(crate) mod value;
mod view;

#[cfg(test)]
mod tests;

use super::importer::{Importer, Input};
use super::{Imported, SceneError, Up};
use import::Imports;
pub(super) use transform::parallel;

pub(super) const IMPORTER: Importer = Importer {
    name: "TOML",
    about: "Gridel's own format, which a person writes",
    extensions: &["toml"],
    // The camera's `up` is y as well where it is not given.
    up: Up::Y,
    binary: false,
    example: "[[light]]\nkind = \"point\"\nposition = [2, 3, 4]\n\n[[object]]\nkind = \"sphere\"\n\
              center = [0, 0, 0]\nradius = 1\n",
    recognizes: |bytes| {
        let lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
        let mut lines = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
        // A heading, or a key and its value.
        lines.next().is_some_and(|line| {
            let key = line.split(|&byte| byte == b'=').next();
            let is_key = |key: &[u8]| {
                let key = key.trim_ascii();
                let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"_-.\"".contains(byte);
                !key.is_empty() && key.iter().all(plain)
            };
            line.starts_with(b"[") || line.contains(&b'=') && key.is_some_and(is_key)
        })
    },
    read,
};

/// Reads a scene file in this format, and the files it imports; molecules among these follow the
/// input's options where the file does not say otherwise.
///
/// # Errors
/// If a file that is imported cannot be read or a file's content is broken; the error shows file, line
/// and remedy.
fn read(input: Input<'_>) -> Result<Imported, SceneError> {
    let mut imports = Imports::new(input.access);
    let scene = imports.root(input)?;
    Ok(Imported {
        scene,
        warnings: imports.warnings,
        molecules: imports.molecules,
    })
}
