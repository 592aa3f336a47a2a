//! The compiler's report.

use super::geometry::primitives::LeftOut;
use super::hierarchy::sah::sah_cost;
use super::instances::Role;
use super::names::KeptNames;
use super::requirements::RequiringPart;
use super::shading::{EnvironmentFigures, Supplied, TextureFigures, Unstated};
use super::structures::context::BuildContext;
use super::structures::layout::{Layout, TableStats};
use crate::scene::{Scene, Shape};
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
    /// Triangles that lie on a line at rest, and not at all times; left out at all times.
    #[serde(skip)]
    pub flat_at_rest: LeftOut,
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
    /// The values of some of these parts.
    #[serde(skip)]
    pub unstated: Unstated,
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

impl Report {
    /// Returns the report about structures that took a time to build. The blob is not written yet: its bytes and names
    /// are missing.
    pub(super) fn of(context: &BuildContext<'_>, layouts: &[Layout], setup: Duration) -> Self {
        let BuildContext {
            scene,
            lattice,
            primitives,
            shading,
            ..
        } = *context;
        let motion_off = match context.role {
            Role::Whole(parts) => parts.reach.off(shading.coordinates.step()),
            Role::Part { .. } => 0.0,
        };
        let displacements = primitives.displacements_in_steps(lattice);
        let most_steps = displacements.iter().copied().fold(0.0, f32::max);
        let longest_lists = layouts.iter().map(|layout| layout.longest_list);
        Self {
            step: lattice.step(),
            largest_displacement: (context.placed.displacement + motion_off)
                .max(f64::from(most_steps) * lattice.step()),
            displacements,
            far_moved: primitives.far_moved.clone(),
            collapsed: primitives.collapsed.clone(),
            without_area: primitives.without_area.clone(),
            flat_at_rest: primitives.flat_at_rest.clone(),
            sah_cost: context.root.map(sah_cost),
            bytes: 0,
            longest_list: longest_lists.max().unwrap_or(0),
            effects: shading.requirements.by_effect(),
            textures: shading.texture_figures().to_vec(),
            environment: shading.environment_figures(),
            supplied: shading.supplied.clone(),
            unstated: shading.unstated,
            setup,
            tables: layouts.iter().filter_map(Layout::table_stats).collect(),
            still_lights: still_lights(scene, context.options.room),
            keeps_rest: false,
            scene_warnings: Vec::new(),
            names: None,
        }
    }

    /// Adds a part's report. Its primitives come after those before it.
    pub(super) fn add_part(&mut self, part: &Report) {
        let steps = (part.step / self.step) as f32;
        let displacements = part.displacements.iter().map(|it| it * steps);
        self.displacements.extend(displacements);
        for (all, of_part) in [
            (&mut self.far_moved, &part.far_moved),
            (&mut self.collapsed, &part.collapsed),
            (&mut self.without_area, &part.without_area),
            (&mut self.flat_at_rest, &part.flat_at_rest),
        ] {
            all.add_all(of_part);
        }
        self.longest_list = self.longest_list.max(part.longest_list);
        self.setup += part.setup;
        self.tables.extend(part.tables.iter().copied());
    }
}

/// The first mesh with room for its vertices whose surface is a light as well.
fn still_lights(scene: &Scene, room: f64) -> Option<String> {
    let mut objects = scene.objects.iter();
    let found = objects.find(|it| {
        let moves = room > 0.0 || !it.attributes.displacements.is_empty();
        moves && matches!(it.shape, Shape::Mesh { .. }) && scene.materials[it.material].is_sampled
    });
    found.map(|it| it.name.clone())
}
