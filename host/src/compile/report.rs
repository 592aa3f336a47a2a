//! The compiler's report.

use super::candidates::lists::Figures;
use super::geometry::primitives::LeftOut;
use super::names::KeptNames;
use super::requirements::RequiringPart;
use super::shading::{EnvironmentFigures, Supplied, TextureFigures};
use std::time::Duration;

/// The compiler's report.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Report {
    /// Scene units of a lattice step.
    pub step: f64,
    /// The largest displacement of a surface by snapping, in scene units. No point of a given surface is farther from
    /// its snapped one, and the other way round. For instances it is counted from their rotations: a matrix of a scene
    /// file becomes the nearest one when it is read. For those that move it takes in the rounding of their motion to
    /// coordinate steps.
    pub largest_displacement: f64,
    /// The displacement of each primitive in scene-file order, in steps of the lattice, and of a part's before an
    /// instance scales it; 0 for those that are left out.
    #[serde(skip)]
    pub displacements: Vec<f32>,
    /// Primitives whose surface was moved by more than four steps of the lattice.
    pub far_moved: LeftOut,
    /// Primitives that collapse on the lattice; they keep their numbers.
    pub collapsed: LeftOut,
    /// Triangles that have no area in the scene file already; they keep their numbers, too.
    pub without_area: LeftOut,
    /// Cost of the hierarchy that structures share by the surface area heuristic, the root's area
    /// being 1; `None` where none is built.
    pub sah_cost: Option<f64>,
    /// Length of the blob.
    pub bytes: usize,
    /// Primitives of the longest list that a ray can be led to.
    pub longest_list: usize,
    /// Effects and the parts that require each.
    pub effects: Vec<(String, Vec<RequiringPart>)>,
    /// The storage of each texture image.
    pub textures: Vec<TextureFigures>,
    /// The storage of the environment.
    pub environment: Option<EnvironmentFigures>,
    /// Parts that the compiler supplied because the scene has none.
    pub supplied: Vec<Supplied>,
    /// The time that the structures took to build, from primitives on the lattice to records.
    #[serde(skip)]
    pub setup: Duration,
    /// Structures with tables of candidate lists.
    pub tables: Vec<TableStats>,
    /// A mesh whose vertices can move, and which glows: its lights stay.
    pub still_lights: Option<String>,
    /// True if meshes have morph targets and stay as they are at rest, because a structure cannot be refitted.
    pub keeps_rest: bool,
    /// Warnings about the scene itself, which [`warnings`](Self::warnings) repeats.
    #[serde(skip)]
    pub(super) scene_warnings: Vec<String>,
    /// The names in the blob; `None` if they are not requested, or there are none.
    pub names: Option<KeptNames>,
}

/// A structure with tables of candidate lists, and what they came to.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct TableStats {
    pub structure: &'static str,
    #[serde(flatten)]
    pub figures: Figures,
}

impl Report {
    /// Adds a part's report. Its primitives come after those before it.
    pub(super) fn add_part(&mut self, part: &Report) {
        let steps = (part.step / self.step) as f32;
        let displacements = part.displacements.iter().map(|it| it * steps);
        self.displacements.extend(displacements);
        for (all, of_part) in [
            (&mut self.far_moved, &part.far_moved),
            (&mut self.collapsed, &part.collapsed),
            (&mut self.without_area, &part.without_area),
        ] {
            all.add_all(of_part);
        }
        self.longest_list = self.longest_list.max(part.longest_list);
        self.setup += part.setup;
        self.tables.extend(part.tables.iter().copied());
    }
}
